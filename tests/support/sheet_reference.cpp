#include "support/sheet_reference.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <stdexcept>

#include "hextwist/mesh/corners.h"

namespace hextwist::test {
namespace {

using EdgeKey = std::array<Index, 2>;

EdgeKey key(Index a, Index b) {
  return {std::min(a, b), std::max(a, b)};
}

/// Sheet of every edge: flood over opposite edges of quads.
std::map<EdgeKey, int> sheets_of(const Mesh& mesh) {
  std::map<EdgeKey, std::vector<EdgeKey>> across;
  for (const Hex& hex : mesh.hexes)
    for (int axis = 0; axis < 3; ++axis)
      for (int k = 0; k < 3; ++k) {  // chaining the four parallel edges is enough
        const auto edge = [&](int i) {
          return key(hex[edge_corner(4 * axis + i, 0)], hex[edge_corner(4 * axis + i, 1)]);
        };
        across[edge(k)].push_back(edge(k + 1));
        across[edge(k + 1)].push_back(edge(k));
      }
  std::map<EdgeKey, int> sheet;
  int n_sheets = 0;
  for (const auto& [start, ignored] : across) {
    if (sheet.contains(start)) continue;
    std::vector<EdgeKey> stack = {start};
    sheet[start] = n_sheets;
    while (!stack.empty()) {
      const EdgeKey edge = stack.back();
      stack.pop_back();
      for (const EdgeKey& next : across[edge])
        if (sheet.try_emplace(next, n_sheets).second) stack.push_back(next);
    }
    ++n_sheets;
  }
  return sheet;
}

/// The evolving mesh.
struct Evolving {
  Mesh mesh;
  std::vector<char> marked, on_skeleton;
  std::map<EdgeKey, int> sheet;  // of edges not yet cut in their own direction
  std::map<EdgeKey, char> edge_on_skeleton;
  std::map<std::array<Index, 4>, char> face_on_skeleton;
  double depth;

  Index add(const Vec3& p, bool mark, bool skeleton) {
    mesh.points.push_back(p);
    marked.push_back(mark);
    on_skeleton.push_back(skeleton);
    return mesh.n_nodes() - 1;
  }
};

std::array<Index, 4> face_key(std::array<Index, 4> nodes) {
  std::ranges::sort(nodes);
  return nodes;
}

/// Cuts all hexes of one sheet.
void insert_sheet(Evolving& now, int sheet) {
  std::map<EdgeKey, std::array<Index, 2>> on_edge;  // new nodes, nearer to the lower end first
  std::map<std::pair<std::array<Index, 4>, EdgeKey>, std::array<Index, 2>> on_face;  // one cut edge of a face
  const auto old_sheet = now.sheet;
  const auto is_cut = [&](Index a, Index b) {
    const auto found = old_sheet.find(key(a, b));
    return found != old_sheet.end() && found->second == sheet && now.marked[a] && now.marked[b];
  };
  const std::vector<char> marked_before = now.marked;
  std::vector<Hex> next;
  for (const Hex hex : now.mesh.hexes) {
    // The direction in which the sheet runs through this hex.
    int axis = -1;
    for (int a = 0; a < 3; ++a) {
      const auto found = old_sheet.find(key(hex[edge_corner(4 * a, 0)], hex[edge_corner(4 * a, 1)]));
      if (found != old_sheet.end() && found->second == sheet) axis = a;
    }
    int cuts = 0;
    if (axis >= 0)
      for (int k = 0; k < 4; ++k)
        cuts |= is_cut(hex[edge_corner(4 * axis + k, 0)], hex[edge_corner(4 * axis + k, 1)]) << k;
    if (cuts == 0) {
      next.push_back(hex);
      continue;
    }
    const auto point = [&](int corner) { return now.mesh.points[hex[corner]]; };
    const std::array<int, 2> other = {axis == 0 ? 1 : 0, axis == 2 ? 1 : 2};

    // Which template: where is the uncut side? far[b]: bit of other axis b at which nothing is cut, -1: none.
    std::array<int, 2> far = {-1, -1};
    for (int b = 0; b < 2; ++b)
      for (int side = 0; side < 2; ++side) {
        bool any = false;
        for (int k = 0; k < 4; ++k) any |= (cuts >> k & 1) && (k >> b & 1) == side;
        if (!any) far[b] = side;
      }
    int expected = 0;
    for (int k = 0; k < 4; ++k) {
      const bool cut = (far[0] < 0 || (k & 1) != far[0]) && (far[1] < 0 || (k >> 1) != far[1]);
      expected |= cut << k;
    }
    if (expected != cuts) throw std::logic_error("a concave place in the sheet");

    // New nodes on each of the four lines: on a cut edge, inside a face or inside the hex.
    std::array<std::array<Index, 2>, 4> line;  // [k][third]
    for (int k = 0; k < 4; ++k) {
      const bool far0 = far[0] >= 0 && (k & 1) == far[0], far1 = far[1] >= 0 && (k >> 1) == far[1];
      const auto place = [&](int third) {
        Vec3 at;
        at[axis] = third / 3.0;
        for (int b = 0; b < 2; ++b) {
          const bool turned = b == 0 ? far0 : far1;
          const double end = k >> b & 1;
          at[other[b]] = turned ? (end == 1 ? now.depth : 1 - now.depth) : end;
        }
        Vec3 sum = Vec3::Zero();
        for (int c = 0; c < 8; ++c) {
          double weight = 1;
          for (int i = 0; i < 3; ++i) weight *= c >> i & 1 ? at[i] : 1 - at[i];
          if (weight != 0) sum += weight * point(c);
        }
        return sum;
      };
      const int near_k = (far0 ? k ^ 1 : k) & 3;
      const int cut_k = far1 ? near_k ^ 2 : near_k;  // the cut edge that this line belongs to
      const Index a = hex[edge_corner(4 * axis + cut_k, 0)], b = hex[edge_corner(4 * axis + cut_k, 1)];
      const auto make = [&](bool mark, bool skeleton) {
        std::array<Index, 2> made;  // nearer to the lower node first
        for (int i = 0; i < 2; ++i) {
          const int third = (a < b) == (i == 0) ? 1 : 2;
          made[i] = now.add(place(third), mark, skeleton);
        }
        return made;
      };
      std::array<Index, 2> nodes;
      if (!far0 && !far1) {
        auto found = on_edge.find(key(a, b));
        if (found == on_edge.end())
          found = on_edge.emplace(key(a, b), make(true, now.edge_on_skeleton.contains(key(a, b)))).first;
        nodes = found->second;
      } else if (far0 != far1) {
        // The face that holds the cut edge and this line.
        const int across = far0 ? 0 : 1;
        const int face = 2 * other[1 - across] + (k >> (1 - across) & 1);
        const auto id = std::pair{face_key(face_nodes(hex, face)), key(a, b)};
        auto found = on_face.find(id);
        if (found == on_face.end())
          found = on_face.emplace(id, make(false, now.face_on_skeleton.contains(id.first))).first;
        nodes = found->second;
      } else {
        nodes = make(false, false);
      }
      line[k] = a < b ? nodes : std::array{nodes[1], nodes[0]};
    }

    // Children: three along the axis, one more across each turned side.
    const auto node = [&](int step, int k) {
      return step == 0   ? hex[edge_corner(4 * axis + k, 0)]
             : step == 3 ? hex[edge_corner(4 * axis + k, 1)]
                         : line[k][step - 1];
    };
    std::vector<Hex> children;
    for (int step = 0; step < 3; ++step) {
      Hex child;
      for (int c = 0; c < 8; ++c) child[c] = node(step + (c >> axis & 1), gather_bits(axis, c));
      children.push_back(child);
    }
    for (int b = 0; b < 2; ++b) {
      if (far[b] < 0) continue;
      Hex child;
      for (int c = 0; c < 8; ++c) {
        const int k = gather_bits(axis, c), along = c >> axis & 1;
        child[c] = (k >> b & 1) == far[b] ? node(3 * along, k) : node(1 + along, (k & ~(1 << b)) | far[b] << b);
      }
      children.push_back(child);
    }
    // The first three children have the other two directions of the parent.
    for (int i = 0; i < 3; ++i)
      for (const int direction : other)
        for (int k = 0; k < 4; ++k) {
          const Index a = hex[edge_corner(4 * direction, 0)], b = hex[edge_corner(4 * direction, 1)];
          const auto parent = old_sheet.find(key(a, b));
          if (parent != old_sheet.end())
            now.sheet.try_emplace(
                key(children[i][edge_corner(4 * direction + k, 0)], children[i][edge_corner(4 * direction + k, 1)]),
                parent->second);
        }
    // Edges and faces of the children inside a parent's face that is on the original skeleton are on it too.
    for (int f = 0; f < n_hex_faces; ++f) {
      if (!now.face_on_skeleton.contains(face_key(face_nodes(hex, f)))) continue;
      std::set<Index> on_face_nodes;
      for (const Index n : face_nodes(hex, f)) on_face_nodes.insert(n);
      for (int b = 0; b < 2; ++b)
        if (f >> 1 == other[b] && far[b] != (f & 1))
          for (int k = 0; k < 4; ++k)
            if ((k >> b & 1) == (f & 1)) on_face_nodes.insert(line[k].begin(), line[k].end());
      for (const Hex& child : children)
        for (int g = 0; g < n_hex_faces; ++g) {
          const auto quad = face_nodes(child, g);
          if (!std::ranges::all_of(quad, [&](Index n) { return on_face_nodes.contains(n); })) continue;
          now.face_on_skeleton[face_key(quad)] = 1;
          for (int j = 0; j < 4; ++j)
            now.edge_on_skeleton[key(child[edge_corner(face_edge(g, j), 0)], child[edge_corner(face_edge(g, j), 1)])] =
                1;
        }
    }
    next.insert(next.end(), children.begin(), children.end());
  }
  for (const auto& [edge, nodes] : on_edge) now.sheet.erase(edge);
  now.mesh.hexes = std::move(next);
}

}  // namespace

SheetReference insert_sheet_by_sheet(const Mesh& mesh, std::vector<char> marked, double depth, std::mt19937& random) {
  Evolving now;
  now.mesh.points = mesh.points;
  now.mesh.hexes = mesh.hexes;
  now.marked = std::move(marked);
  now.on_skeleton.assign(mesh.points.size(), 1);
  now.sheet = sheets_of(mesh);
  now.depth = depth;
  for (const Hex& hex : mesh.hexes) {
    for (int e = 0; e < n_hex_edges; ++e) now.edge_on_skeleton[key(hex[edge_corner(e, 0)], hex[edge_corner(e, 1)])] = 1;
    for (int f = 0; f < n_hex_faces; ++f) now.face_on_skeleton[face_key(face_nodes(hex, f))] = 1;
  }
  int n_sheets = 0;
  for (const auto& [edge, sheet] : now.sheet) n_sheets = std::max(n_sheets, sheet + 1);
  std::vector<int> order(n_sheets);
  std::iota(order.begin(), order.end(), 0);
  std::ranges::shuffle(order, random);
  for (const int sheet : order) insert_sheet(now, sheet);
  return {std::move(now.mesh), std::move(now.on_skeleton)};
}

}  // namespace hextwist::test
