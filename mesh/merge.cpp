#include "hextwist/mesh/merge.h"

#include <algorithm>

#include "hextwist/base/sorted.h"
#include "hextwist/base/text.h"
#include "hextwist/mesh/loose_topology.h"
#include "hextwist/mesh/others.h"
#include "hextwist/mesh/validate/validate_parts.h"

namespace hextwist {
namespace {

/// Two places of a list that name the same node now, and did not before; {-1, -1}: none.
std::array<Index, 2> collapsed(std::span<const Index> nodes, std::span<const Index> node_now) {
  for (std::size_t a = 0; a < nodes.size(); ++a)
    for (std::size_t b = a + 1; b < nodes.size(); ++b)
      if (nodes[a] != nodes[b] && node_now[nodes[a]] == node_now[nodes[b]]) return {nodes[a], nodes[b]};
  return {-1, -1};
}

/// Throws where a face has more than two hexes. Returns the number of faces on the skin.
Index checked_skin(const Mesh& before, const Mesh& now) {
  const LooseFaces loose = loose_faces(now);
  if (loose.more.empty()) return static_cast<Index>(boundary_sides(loose.faces).size());
  const Index face = loose.more.front().first;
  std::vector<std::int64_t> hexes;
  for (const Side& side : loose.faces.sides[face]) hexes.push_back(hex_id(before, side.hex));
  for (const auto& [other, side] : loose.more)
    if (other == face) hexes.push_back(hex_id(before, side.hex));
  std::string text = "hexes";
  for (std::size_t k = 0; k < hexes.size() && k < 4; ++k)
    text += (k == 0 ? " " : k + 1 == hexes.size() ? " and " : ", ") + std::to_string(hexes[k]);
  text += " would share one face (nodes";
  Quad nodes = loose.faces.nodes[face];
  std::ranges::sort(nodes);
  for (const Index n : nodes) text += " " + std::to_string(node_id(now, n));
  throw Error(text + "): merge fewer nodes, or with a smaller tolerance");
}

/// Throws where two hexes have the same nodes.
void check_doubles(const Mesh& before, const Mesh& now) {
  std::vector<std::pair<Hex, Index>> hexes;
  for (Index h = 0; h < now.n_hexes(); ++h) {
    hexes.emplace_back(now.hexes[h], h);
    std::ranges::sort(hexes.back().first);
  }
  std::ranges::sort(hexes);
  const auto found = std::ranges::adjacent_find(hexes, {}, [](const auto& each) { return each.first; });
  if (found != hexes.end())
    throw Error("hexes " + std::to_string(hex_id(before, found->second)) + " and " +
                std::to_string(hex_id(before, std::next(found)->second)) +
                " would have the same nodes: they lie in the same place");
}

}  // namespace

MergeResult merge_nodes(const Mesh& mesh, double tolerance, std::span<const std::uint8_t> wanted) {
  MergeResult result;
  const Index n = mesh.n_nodes();
  std::vector<Vec3> places;
  std::vector<Index> candidates;
  for (Index i = 0; i < n; ++i)
    if (wanted.empty() || wanted[i]) {
      candidates.push_back(i);
      places.push_back(mesh.points[i]);
    }
  std::vector<Index> stays(mesh.points.size());
  for (Index i = 0; i < n; ++i) stays[i] = i;
  for (const std::vector<Index>& group : near_points(places, tolerance))
    for (const Index member : group) stays[candidates[member]] = candidates[group.front()];

  for (Index h = 0; h < mesh.n_hexes(); ++h)
    if (const auto [a, b] = collapsed(mesh.hexes[h], stays); a >= 0)
      throw Error("nodes " + std::to_string(node_id(mesh, a)) + " and " + std::to_string(node_id(mesh, b)) +
                  " of hex " + std::to_string(hex_id(mesh, h)) + " would become one: the tolerance (" +
                  short_number(tolerance) + ") is too large for it");
  if (mesh.others)
    for (Index e = 0; e < mesh.others->size(); ++e)
      if (const auto [a, b] = collapsed(mesh.others->nodes_of(e), stays); a >= 0)
        throw Error("nodes " + std::to_string(node_id(mesh, a)) + " and " + std::to_string(node_id(mesh, b)) + " of " +
                    other_text(mesh, e) + " would become one");

  std::vector<Index> kept;
  result.node_now.assign(mesh.points.size(), -1);
  for (Index i = 0; i < n; ++i)
    if (stays[i] == i) {
      result.node_now[i] = static_cast<Index>(kept.size());
      kept.push_back(i);
    }
  for (Index i = 0; i < n; ++i) result.node_now[i] = result.node_now[stays[i]];
  result.n_gone = n - static_cast<Index>(kept.size());
  if (result.n_gone == 0) {
    result.mesh = mesh;
    return result;
  }
  Mesh& out = result.mesh;
  out = mesh;
  out.points = items_at(mesh.points, kept);
  // Ids stay: from now on they have gaps.
  out.node_ids.clear();
  for (const Index i : kept) out.node_ids.push_back(node_id(mesh, i));
  for (Hex& hex : out.hexes)
    for (Index& node : hex) node = result.node_now[node];
  for (NodeSet& set : out.node_sets) {
    for (Index& node : set.nodes) node = result.node_now[node];
    sort_unique(set.nodes);
  }
  out.others = renumbered(mesh.others, result.node_now);
  for (Field& field : out.fields) {
    if (field.on != Field::On::node) continue;
    const auto width = static_cast<std::size_t>(field.components);
    Index n_differ = 0;
    for (Index i = 0; i < n; ++i) {
      if (stays[i] == i) continue;
      for (std::size_t c = 0; c < width; ++c) {
        const double own = field.values[i * width + c], other = field.values[stays[i] * width + c];
        if (own == other || (own != own && other != other)) continue;
        ++n_differ;
        break;
      }
    }
    if (n_differ > 0)
      result.notices.push_back("field \"" + field.name + "\" had other values at " + std::to_string(n_differ) +
                               (n_differ == 1 ? " node" : " nodes") +
                               " that became others: those of the lower ids are kept");
    field.values = items_at(field.values, kept, width);
  }
  const Index after = checked_skin(mesh, out);
  check_doubles(mesh, out);
  result.n_faces = (static_cast<Index>(boundary_sides(faces(mesh)).size()) - after) / 2;
  return result;
}

}  // namespace hextwist
