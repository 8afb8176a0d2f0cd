// MEDIT's .mesh, text: groups and owners as references, explained by comments where one number does not say it.
// Node and hex ids become 1..n (the format has none), fields are left out (they would be a .sol file).
#include "hextwist/io/medit/references_internal.h"

namespace hextwist::io {
namespace {

template <class Group>
std::vector<NamedGroup> names(const std::vector<Group>& groups) {
  std::vector<NamedGroup> result;
  for (const Group& group : groups) result.push_back({group.id, group.name});
  return result;
}

}  // namespace

void write_medit(Output& out, const Mesh& mesh, const Association& association, const WriteOptions&,
                 std::vector<std::string>& notices) {
  if (!mesh.node_ids.empty()) notices.push_back("MEDIT has no ids: nodes are counted from 1 in the file");
  if (!mesh.hex_ids.empty()) notices.push_back("MEDIT has no ids: hexes are counted from 1 in the file");
  say_no_fields(mesh, "MEDIT", notices);
  out << "MeshVersionFormatted 2\nDimension 3\n# hextwist mesh\n";

  std::vector<int> volume(mesh.hexes.size());
  for (Index h = 0; h < mesh.n_hexes(); ++h) volume[h] = volume_of(association, h);
  std::vector<std::span<const Index>> members;
  for (const Block& block : mesh.blocks) members.push_back(block.hexes);
  const Classes hexes = classify(volume, members);
  const auto hex_reference = write_references(out, {"block", "volume"}, hexes, names(mesh.blocks), notices);

  const PlannedSides sides = plan_sides(mesh, association);
  members.assign(sides.members.begin(), sides.members.end());
  const Classes quads = classify(sides.surface, members);
  const auto quad_reference = write_references(out, {"sideset", "surface"}, quads, names(mesh.side_sets), notices);

  const Classes edges = classify(association.edge_curve, {});
  const auto edge_reference = write_references(out, {"edgeset", "curve"}, edges, {}, notices);

  std::vector<int> vertex(mesh.points.size(), 0);
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    if (const Owner at = owner(association, n); at.dim == 0) vertex[n] = at.id;
  members.clear();
  for (const NodeSet& set : mesh.node_sets) members.push_back(set.nodes);
  const Classes nodes = classify(vertex, members);
  const auto node_reference = write_references(out, {"nodeset", "vertex"}, nodes, names(mesh.node_sets), notices);

  out << "Vertices\n" << mesh.points.size() << '\n';
  for (std::size_t n = 0; n < mesh.points.size(); ++n) {
    for (const double x : mesh.points[n]) out << x << ' ';
    out << node_reference[nodes.of_item[n]] << '\n';
  }
  std::vector<Index> corners;
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    if (vertex[n] > 0) corners.push_back(n);
  if (!corners.empty()) {
    out << "Corners\n" << corners.size() << '\n';
    for (const Index n : corners) out << n + 1 << '\n';
  }
  if (!association.curve_edges.empty()) {
    out << "Edges\n" << association.curve_edges.size() << '\n';
    for (std::size_t i = 0; i < association.curve_edges.size(); ++i)
      out << association.curve_edges[i][0] + 1 << ' ' << association.curve_edges[i][1] + 1 << ' '
          << edge_reference[edges.of_item[i]] << '\n';
    out << "Ridges\n" << association.curve_edges.size() << '\n';
    for (std::size_t i = 1; i <= association.curve_edges.size(); ++i) out << i << '\n';
  }
  if (!sides.sides.empty()) {
    out << "Quadrilaterals\n" << sides.sides.size() << '\n';
    for (std::size_t i = 0; i < sides.sides.size(); ++i) {
      for (const Index n : face_node_cycle(mesh.hexes[sides.sides[i].hex], sides.sides[i].face)) out << n + 1 << ' ';
      out << quad_reference[quads.of_item[i]] << '\n';
    }
  }
  out << "Hexahedra\n" << mesh.hexes.size() << '\n';
  for (std::size_t h = 0; h < mesh.hexes.size(); ++h) {
    for (const int c : file_corner) out << mesh.hexes[h][c] + 1 << ' ';
    out << hex_reference[hexes.of_item[h]] << '\n';
  }
  out << "End\n";
}

}  // namespace hextwist::io
