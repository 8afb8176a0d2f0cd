#include "support/checkers.h"

#include <algorithm>
#include <map>
#include <set>

#include "hextwist/mesh/corners.h"

namespace hextwist::test {
namespace {

testing::AssertionResult no(const std::string& what) {
  return testing::AssertionFailure() << what;
}

/// Whether p lies on a bilinear quad (a cycle): quarters whose boxes miss p are dropped until they are small.
bool on_quad(const std::array<Vec3, 4>& x, const Vec3& p, double eps) {
  const Vec3 low = x[0].cwiseMin(x[1]).cwiseMin(x[2]).cwiseMin(x[3]);
  const Vec3 high = x[0].cwiseMax(x[1]).cwiseMax(x[2]).cwiseMax(x[3]);
  if (((p - low).array() < -eps).any() || ((p - high).array() > eps).any()) return false;
  if ((high - low).maxCoeff() < eps) return true;
  const std::array<Vec3, 4> middle = {(x[0] + x[1]) / 2, (x[1] + x[2]) / 2, (x[2] + x[3]) / 2, (x[3] + x[0]) / 2};
  const Vec3 centre = (x[0] + x[1] + x[2] + x[3]) / 4;
  return on_quad({x[0], middle[0], centre, middle[3]}, p, eps) ||
         on_quad({middle[0], x[1], middle[1], centre}, p, eps) ||
         on_quad({centre, middle[1], x[2], middle[2]}, p, eps) || on_quad({middle[3], centre, middle[2], x[3]}, p, eps);
}

}  // namespace

testing::AssertionResult conformal(const Mesh& mesh, UnusedNodes unused, HangingNodes hanging) {
  struct Seen {
    Index hex;
    std::array<Index, 4> cycle;
    int count;
  };
  std::map<std::array<Index, 4>, Seen> quads;
  std::set<Hex> hexes;
  std::vector<char> used(mesh.points.size(), 0);
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    Hex sorted = mesh.hexes[h];
    std::ranges::sort(sorted);
    if (sorted[0] < 0 || sorted[7] >= mesh.n_nodes()) return no("hex " + std::to_string(h) + " has a node that is not");
    if (std::ranges::adjacent_find(sorted) != sorted.end()) return no("hex " + std::to_string(h) + " repeats a node");
    if (!hexes.insert(sorted).second) return no("hex " + std::to_string(h) + " is there twice");
    for (const Index n : sorted) used[n] = 1;
    for (int f = 0; f < n_hex_faces; ++f) {
      const auto cycle = face_node_cycle(mesh.hexes[h], f);
      auto key = cycle;
      std::ranges::sort(key);
      const auto [at, fresh] = quads.try_emplace(key, Seen{h, cycle, 1});
      if (fresh) continue;
      if (++at->second.count > 2) return no("three hexes at a face of hex " + std::to_string(h));
      // The neighbour must see the same cycle backwards.
      auto reversed = cycle;
      std::ranges::reverse(reversed);
      std::ranges::rotate(reversed, std::ranges::find(reversed, at->second.cycle[0]));
      if (reversed != at->second.cycle)
        return no("hexes " + std::to_string(at->second.hex) + " and " + std::to_string(h) + " disagree on their face");
    }
  }
  for (std::size_t n = 0; n < used.size(); ++n)
    if (!used[n] && unused == UnusedNodes::refused) return no("node " + std::to_string(n) + " is unused");
  if (hanging == HangingNodes::allowed) return testing::AssertionSuccess();
  // Nodes of the skin against quads of the skin: by x, then by box, then exactly.
  std::vector<Index> skin;
  Box box;
  for (const auto& [key, seen] : quads)
    if (seen.count == 1) skin.insert(skin.end(), key.begin(), key.end());
  for (const Index n : skin) box.add(mesh.points[n]);
  std::ranges::sort(skin, {}, [&](Index n) { return std::pair(mesh.points[n].x(), n); });
  skin.erase(std::unique(skin.begin(), skin.end()), skin.end());
  for (const auto& [key, seen] : quads) {
    if (seen.count != 1) continue;
    std::array<Vec3, 4> x;
    Box around;
    for (int i = 0; i < 4; ++i) around.add(x[i] = mesh.points[seen.cycle[i]]);
    const double eps = 1e-7 * (x[2] - x[0]).norm() + 1e-12 * box.diagonal();
    const auto by_x = [&](Index n) { return mesh.points[n].x(); };
    const auto end = std::ranges::upper_bound(skin, around.max.x() + eps, {}, by_x);
    for (auto at = std::ranges::lower_bound(skin, around.min.x() - eps, {}, by_x); at < end; ++at)
      if (std::ranges::find(mesh.hexes[seen.hex], *at) == mesh.hexes[seen.hex].end() &&
          on_quad(x, mesh.points[*at], eps) &&
          std::ranges::none_of(x, [&](const Vec3& corner) { return (corner - mesh.points[*at]).norm() <= 2 * eps; }))
        return no("node " + std::to_string(*at) + " hangs in a face of hex " + std::to_string(seen.hex));
  }
  return testing::AssertionSuccess();
}

testing::AssertionResult uninverted(const Mesh& mesh) {
  constexpr int n = 4;
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    for (int i = 0; i < (n + 1) * (n + 1) * (n + 1); ++i) {
      const Vec3 at = Vec3(i % (n + 1), i / (n + 1) % (n + 1), i / (n + 1) / (n + 1)) / n;
      Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
      for (int c = 0; c < 8; ++c)
        for (int axis = 0; axis < 3; ++axis) {
          double weight = c >> axis & 1 ? 1 : -1;
          for (int other = 0; other < 3; ++other)
            if (other != axis) weight *= c >> other & 1 ? at[other] : 1 - at[other];
          a.col(axis) += weight * mesh.points[mesh.hexes[h][c]];
        }
      const double det = a(0, 0) * (a(1, 1) * a(2, 2) - a(1, 2) * a(2, 1)) -
                         a(0, 1) * (a(1, 0) * a(2, 2) - a(1, 2) * a(2, 0)) +
                         a(0, 2) * (a(1, 0) * a(2, 1) - a(1, 1) * a(2, 0));
      if (!(det > 0))
        return no("hex " + std::to_string(h) + " is inverted at (" + std::to_string(at.x()) + ", " +
                  std::to_string(at.y()) + ", " + std::to_string(at.z()) + ")");
    }
  return testing::AssertionSuccess();
}

testing::AssertionResult sets_valid(const Mesh& mesh) {
  const auto ascending = [](const auto& items) {
    return std::ranges::adjacent_find(items, std::ranges::greater_equal{}) == items.end();
  };
  for (const Block& block : mesh.blocks) {
    if (!ascending(block.hexes)) return no("block " + std::to_string(block.id) + " is not ascending");
    if (!block.hexes.empty() && (block.hexes.front() < 0 || block.hexes.back() >= mesh.n_hexes()))
      return no("block " + std::to_string(block.id) + " has a hex that is not");
  }
  for (const NodeSet& set : mesh.node_sets) {
    if (!ascending(set.nodes)) return no("node set " + std::to_string(set.id) + " is not ascending");
    if (!set.nodes.empty() && (set.nodes.front() < 0 || set.nodes.back() >= mesh.n_nodes()))
      return no("node set " + std::to_string(set.id) + " has a node that is not");
  }
  for (const SideSet& set : mesh.side_sets) {
    if (!ascending(set.sides)) return no("side set " + std::to_string(set.id) + " is not ascending");
    for (const Side& side : set.sides)
      if (side.hex < 0 || side.hex >= mesh.n_hexes() || side.face < 0 || side.face > 5)
        return no("side set " + std::to_string(set.id) + " has a side that is not");
  }
  for (const Field& field : mesh.fields) {
    const std::size_t n = field.on == Field::On::node ? mesh.points.size() : mesh.hexes.size();
    if (field.values.size() != n * field.components) return no("field " + field.name + " has the wrong length");
  }
  return testing::AssertionSuccess();
}

}  // namespace hextwist::test
