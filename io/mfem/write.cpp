// MFEM's mesh file: blocks and side sets as attributes, with names as v1.3 has them where there are any; all boundary
// faces, as MFEM wants them; hexes with 27 nodes as nodes of degree 2.
#include "hextwist/base/sorted.h"
#include "hextwist/io/mfem/mfem_internal.h"

namespace hextwist::io {
namespace {

struct Attributes {
  std::vector<int> of_class;
  std::vector<std::vector<int>> of_group;
};

/// Of classes of elements: a class that is a whole group has its id, others get new numbers, since each has to have
/// one.
template <class Group>
Attributes attributes(Output& out, const ReferenceKinds& kinds, const Classes& classes,
                      const std::vector<Group>& groups, std::vector<std::string>& notices) {
  Attributes result;
  result.of_group.resize(groups.size());
  std::vector<int> n_classes(groups.size(), 0);
  for (const auto& in : classes.groups)
    for (const int g : in) ++n_classes[g];
  int next = 1;
  for (const Group& group : groups) {
    if (group.id > std::numeric_limits<int>::max() / 2)
      throw Error("id " + std::to_string(group.id) + " of a " + kinds.group + " is too large for MFEM");
    next = std::max(next, group.id + 1);
  }
  std::vector<int> none;
  for (const auto& in : classes.groups) {
    const bool whole = in.size() == 1 && n_classes[in[0]] == 1 && groups[in[0]].id > 0;
    result.of_class.push_back(whole ? groups[in[0]].id : next++);
    for (const int g : in) result.of_group[g].push_back(result.of_class.back());
    if (in.empty()) none.push_back(result.of_class.back());
  }
  const auto comment = [&](const char* kind, int id, const std::vector<int>& all, const std::string& name) {
    out << "# hextwist " << kind << ' ' << id << ' ' << all.size();
    for (const int attribute : all) out << ' ' << attribute;
    out << ' ' << name << '\n';
  };
  std::vector<std::string> others;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const std::string name = one_line(groups[g].name);
    say_renamed(std::string(kinds.group) + " " + std::to_string(groups[g].id), groups[g].name, name, notices);
    comment(kinds.group, groups[g].id, result.of_group[g], name);
    if (result.of_group[g] != std::vector{groups[g].id})
      others.push_back(std::to_string(groups[g].id) + " is " +
                       (result.of_group[g].empty() ? "empty" : joined(result.of_group[g])));
  }
  if (!none.empty()) comment(kinds.entity, 0, none, "");
  if (!others.empty())
    notices.push_back(std::string("an element of MFEM has one attribute, so that a ") + kinds.group +
                      " has others: " + joined(others, "; "));
  return result;
}

template <class Group>
void named_sets(Output& out, const std::vector<Group>& groups, const Attributes& attributes) {
  std::vector<std::size_t> named;
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (!groups[g].name.empty()) named.push_back(g);
  out << named.size() << '\n';
  for (const std::size_t g : named) {
    out << '"';
    for (const char c : one_line(groups[g].name)) {
      if (c == '"' || c == '\\') out << '\\';
      out << c;
    }
    out << "\"\n" << attributes.of_group[g].size() << '\n';
    for (const int attribute : attributes.of_group[g]) out << attribute << ' ';
    out << '\n';
  }
}

}  // namespace

void write_mfem(Output& out, const Mesh& mesh, const Association&, const WriteOptions& options,
                std::vector<std::string>& notices) {
  const SecondOrder* const second = options.second;
  const auto n_corners = second ? static_cast<std::size_t>(second->n_corners) : mesh.points.size();
  if (!mesh.node_ids.empty()) notices.push_back("MFEM has no ids: nodes are counted from 0 in the file");
  if (!mesh.hex_ids.empty()) notices.push_back("MFEM has no ids: hexes are counted from 0 in the file");
  say_no_fields(mesh, "MFEM's mesh file", notices);
  for (const NodeSet& set : mesh.node_sets)
    notices.push_back("MFEM has no node sets: nodeset " + std::to_string(set.id) +
                      (set.name.empty() ? "" : " '" + set.name + "'") + " left out");

  // MFEM drops vertices of no element, and with them the order of nodes of degree 2.
  std::vector<char> used(n_corners, second ? 0 : 1);
  for (std::size_t h = 0; h < mesh.hexes.size() && second; ++h)
    for (const Index node : mesh.hexes[h]) used[static_cast<std::size_t>(node)] = 1;
  std::vector<Index> place(n_corners, -1);
  Index n_vertices = 0;
  for (std::size_t n = 0; n < n_corners; ++n)
    if (used[n]) place[n] = n_vertices++;
  if (n_vertices < static_cast<Index>(n_corners))
    notices.push_back(counted(static_cast<std::int64_t>(n_corners) - n_vertices, "node") + " of no hex left out");

  const bool names = std::ranges::any_of(mesh.blocks, [](const Block& block) { return !block.name.empty(); }) ||
                     std::ranges::any_of(mesh.side_sets, [](const SideSet& set) { return !set.name.empty(); });
  out << (names ? "MFEM mesh v1.3\n\n" : "MFEM mesh v1.0\n\n");
  out << "# hextwist mesh\n";
  std::vector<std::span<const Index>> members;
  for (const Block& block : mesh.blocks) members.emplace_back(block.hexes);
  const Classes hexes = classify(std::vector<int>(mesh.hexes.size(), 0), members);
  const Attributes of_hexes = attributes(out, mfem_blocks, hexes, mesh.blocks, notices);

  // Sides of sets, and all of the boundary that is in none.
  PlannedSides plan = plan_sides(mesh, {});
  const Faces all = faces(mesh);
  std::vector<Index> faces_in_sets;
  for (const Side& side : plan.sides) faces_in_sets.push_back(all.of_hex[side.hex][side.face]);
  sort_unique(faces_in_sets);
  for (const Side& side : boundary_sides(all))
    if (position_in(faces_in_sets, all.of_hex[side.hex][side.face]) < 0) plan.sides.push_back(side);
  members.assign(plan.members.begin(), plan.members.end());
  const Classes quads = classify(std::vector<int>(plan.sides.size(), 0), members);
  const Attributes of_quads = attributes(out, mfem_side_sets, quads, mesh.side_sets, notices);

  out << "\ndimension\n3\n\nelements\n" << mesh.hexes.size() << '\n';
  for (std::size_t h = 0; h < mesh.hexes.size(); ++h) {
    out << of_hexes.of_class[hexes.of_item[h]] << ' ' << mfem_cube;
    for (const Index node : in_file_order(mesh.hexes[h])) out << ' ' << place[node];
    out << '\n';
  }
  if (names) {
    out << "\nattribute_sets\n";
    named_sets(out, mesh.blocks, of_hexes);
  }
  out << "\nboundary\n" << plan.sides.size() << '\n';
  for (std::size_t i = 0; i < plan.sides.size(); ++i) {
    out << of_quads.of_class[quads.of_item[i]] << ' ' << mfem_square;
    for (const Index node : face_node_cycle(mesh.hexes[plan.sides[i].hex], plan.sides[i].face))
      out << ' ' << place[node];
    out << '\n';
  }
  if (names) {
    out << "\nbdr_attribute_sets\n";
    named_sets(out, mesh.side_sets, of_quads);
  }
  out << "\nvertices\n" << n_vertices << '\n';
  const auto point = [&](Index n) {
    const Vec3& p = mesh.points[n];
    out << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  };
  if (!second) {
    out << "3\n";
    for (Index n = 0; n < mesh.n_nodes(); ++n) point(n);
  } else {
    out << "\nnodes\nFiniteElementSpace\nFiniteElementCollection: H1_3D_P2\nVDim: 3\nOrdering: 1\n\n";
    for (std::size_t n = 0; n < n_corners; ++n)
      if (used[n]) point(static_cast<Index>(n));
    const auto in_order = [](const std::vector<Index>& number) {
      std::vector<Index> order(number.size());
      for (std::size_t i = 0; i < number.size(); ++i) order[number[i]] = static_cast<Index>(i);
      return order;
    };
    for (const Index edge : in_order(mfem_edges(second->edges))) point(second->edge_middle(edge));
    for (const Index face : in_order(mfem_faces(second->faces))) point(second->face_middle(face));
    for (Index h = 0; h < mesh.n_hexes(); ++h) point(second->hex_middle(h));
  }
  if (names) out << "\nmfem_mesh_end\n";
}

}  // namespace hextwist::io
