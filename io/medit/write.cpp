// MEDIT's .mesh, text: groups and owners as references, explained by comments where one number does not say it.
// Of second order are HexahedraQ2, QuadrilateralsQ2 and EdgesP2, each with a section that says in which order its nodes
// are. Node and hex ids become 1..n (the format has none), fields are left out (they would be a .sol file).
#include "hextwist/io/medit/references_internal.h"

namespace hextwist::io {
namespace {

template <class Group>
std::vector<NamedGroup> names(const std::vector<Group>& groups) {
  std::vector<NamedGroup> result;
  for (const Group& group : groups) result.push_back({group.id, group.name});
  return result;
}

/// Where each node of an element is, on axes from 0 to 2: what libMeshb calls Bezier indices.
void orderings(Output& out) {
  out << "EdgesP2Ordering\n3\n0\n2\n1\nQuadrilateralsQ2Ordering\n9\n0 0\n2 0\n2 2\n0 2\n1 0\n2 1\n1 2\n0 1\n1 1\n"
         "HexahedraQ2Ordering\n27\n";
  const auto put = [&](std::initializer_list<int> corners) {  // in the middle of them
    for (int axis = 0; axis < 3; ++axis) {
      int sum = 0;
      for (const int c : corners) sum += c >> axis & 1;
      out << 2 * sum / static_cast<int>(corners.size()) << (axis < 2 ? ' ' : '\n');
    }
  };
  for (const int c : file_corner) put({c});
  for (const int middle : medit_middles)
    if (middle < 12)
      put({edge_corner(middle, 0), edge_corner(middle, 1)});
    else if (middle < 18)
      put({face_corner(middle - 12, 0), face_corner(middle - 12, 3)});
    else
      put({0, 7});
}

}  // namespace

void write_medit(Output& out, const Mesh& mesh, const Association& association, const WriteOptions& options,
                 std::vector<std::string>& notices) {
  if (!mesh.node_ids.empty()) notices.push_back("MEDIT has no ids: nodes are counted from 1 in the file");
  if (!mesh.hex_ids.empty()) notices.push_back("MEDIT has no ids: hexes are counted from 1 in the file");
  say_no_fields(mesh, "MEDIT", notices);
  const SecondOrder* const second = options.second;
  out << "MeshVersionFormatted 2\nDimension 3\n# hextwist mesh\n";
  if (second) orderings(out);

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
    out << (second ? "EdgesP2\n" : "Edges\n") << association.curve_edges.size() << '\n';
    for (std::size_t i = 0; i < association.curve_edges.size(); ++i) {
      const auto [a, b] = association.curve_edges[i];
      out << a + 1 << ' ' << b + 1 << ' ';
      if (second) out << second->middle_between(a, b) + 1 << ' ';
      out << edge_reference[edges.of_item[i]] << '\n';
    }
    // Ridges count the straight edges.
    if (!second) out << "Ridges\n" << association.curve_edges.size() << '\n';
    for (std::size_t i = 1; !second && i <= association.curve_edges.size(); ++i) out << i << '\n';
  }
  if (!sides.sides.empty()) {
    out << (second ? "QuadrilateralsQ2\n" : "Quadrilaterals\n") << sides.sides.size() << '\n';
    for (std::size_t i = 0; i < sides.sides.size(); ++i) {
      const Quad q = face_node_cycle(mesh.hexes[sides.sides[i].hex], sides.sides[i].face);
      for (const Index n : q) out << n + 1 << ' ';
      for (std::size_t c = 0; second && c < 4; ++c) out << second->middle_between(q[c], q[(c + 1) % 4]) + 1 << ' ';
      if (second) out << second->middle_of(q) + 1 << ' ';
      out << quad_reference[quads.of_item[i]] << '\n';
    }
  }
  out << (second ? "HexahedraQ2\n" : "Hexahedra\n") << mesh.hexes.size() << '\n';
  for (std::size_t h = 0; h < mesh.hexes.size(); ++h) {
    const FileHex hex = file_hex(mesh, second, static_cast<Index>(h), medit_middles);
    for (const Index n : hex.all()) out << n + 1 << ' ';
    out << hex_reference[hexes.of_item[h]] << '\n';
  }
  out << "End\n";
}

}  // namespace hextwist::io
