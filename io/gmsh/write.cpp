// Gmsh's .msh 2.2 and 4.1 from a plan.
//
// A section of our own behind the elements, which Gmsh and others skip, keeps what its groups of whole entities cannot
// say:
//   $HextwistParts: entities that are parts of a CAD entity or of none (dimension tag parent's dimension and tag), and
//   members of physical groups beyond the one that an element of format 2.2 can name.
#include <limits>
#include <numeric>

#include "hextwist/base/large_array.h"
#include "hextwist/io/field_names.h"
#include "hextwist/io/gmsh/gmsh.h"
#include "hextwist/io/gmsh/others.h"
#include "hextwist/io/gmsh/plan_internal.h"

namespace hextwist::io {
namespace {

/// Numbers as text with a blank between them, or as the machine stores them.
struct Writer {
  Output& out;
  bool binary;

  template <class T>
  void value(T x) const {
    if (binary)
      out.put(x);
    else
      out << x << ' ';
  }
  /// row(0) .. row(n - 1), a std::array each: a line of text.
  template <class Row>
  void rows(std::size_t n, Row&& row) const {
    if (binary) return out.put_each(n, row);
    for (std::size_t i = 0; i < n; ++i) {
      for (const auto x : row(i)) value(x);
      end_line();
    }
  }
  void integer(int x) const { value(std::int32_t{x}); }
  void large(std::size_t x) const { value(static_cast<std::int64_t>(x)); }
  void id(std::int64_t x) const { value(x); }
  void real(double x) const { value(x); }
  void end_line() const {
    if (!binary) out << '\n';
  }
};

/// Gmsh has no way to write a quote or a line end in a name.
std::string plain(std::string name) {
  for (char& c : name)
    if (c == '"')
      c = '\'';
    else if (static_cast<unsigned char>(c) < ' ')
      c = ' ';
  return name;
}

void check_int32(std::int64_t id, const std::string& what) {
  if (id > std::numeric_limits<std::int32_t>::max())
    throw Error("id " + std::to_string(id) + " is too large for " + what + "Gmsh's format");
}

void write_names(Output& out, const GmshPlan& plan) {
  std::vector<const PlannedGroup*> named;
  for (const PlannedGroup& group : plan.groups)
    if (!group.name.empty() || group.empty) named.push_back(&group);
  if (named.empty()) return;
  std::ranges::stable_sort(named, {}, [](const PlannedGroup* group) { return group->group.dim; });
  out << "$PhysicalNames\n" << named.size() << '\n';
  for (const PlannedGroup* group : named)
    out << group->group.dim << ' ' << group->group.id << " \"" << plain(group->name) << "\"\n";
  out << "$EndPhysicalNames\n";
}

void write_parts(Output& out, const GmshPlan& plan) {
  std::size_t n_parts = 0, n_groups = 0;
  for (const auto& entities : plan.entities)
    for (const auto& entity : entities) n_parts += entity.is_part;
  for (const auto& group : plan.groups) n_groups += !group.more.empty();
  if (n_parts + n_groups == 0) return;
  out << "$HextwistParts\n" << n_parts << '\n';
  for (int dim = 0; dim < 4; ++dim)
    for (const auto& entity : plan.entities[dim])
      if (entity.is_part)
        out << dim << ' ' << entity.tag << ' ' << entity.parent.dim << ' ' << entity.parent.id << '\n';
  out << n_groups << '\n';
  for (const auto& group : plan.groups) {
    if (group.more.empty()) continue;
    out << group.group.dim << ' ' << group.group.id << ' ' << group.more.size() << '\n';
    for (const auto tag : group.more) out << tag << '\n';
  }
  out << "$EndHextwistParts\n";
}

/// partitioned: what a part has of them.
void write_entities_4(const Writer& to, const GmshPlan& plan, bool partitioned) {
  const char* const name = partitioned ? "PartitionedEntities\n" : "Entities\n";
  const auto tag_of = [&](int tag) { return partitioned ? plan.file_tag(tag) : tag; };
  to.out << '$' << name;
  if (partitioned) {
    to.large(static_cast<std::size_t>(plan.n_parts));
    to.end_line();
    to.large(0);  // no hexes of others
    to.end_line();
  }
  for (const auto& entities : plan.entities) to.large(entities.size());
  to.end_line();
  for (int dim = 0; dim < 4; ++dim)
    for (const PlannedEntity& entity : plan.entities[dim]) {
      to.integer(tag_of(entity.tag));
      if (partitioned) {
        to.integer(dim);
        to.integer(entity.tag);
        to.large(1);
        to.integer(plan.part + 1);
      }
      const Box box = entity.box.empty() ? Box{Vec3::Zero(), Vec3::Zero()} : entity.box;
      for (const double x : box.min) to.real(x);
      if (dim > 0)
        for (const double x : box.max) to.real(x);
      to.large(entity.physicals.size());
      for (const int id : entity.physicals) to.integer(id);
      if (dim > 0) {
        to.large(entity.boundary.size());
        for (const int tag : entity.boundary) to.integer(tag < 0 ? -tag_of(-tag) : tag_of(tag));
      }
      to.end_line();
    }
  if (to.binary) to.out << '\n';
  to.out << "$End" << name;
}

/// The nodes and hexes of the file, ascending.
struct Selection {
  bool all = true;
  std::vector<Index> nodes, hexes;  ///< else

  std::size_t n_nodes(const Mesh& mesh) const { return all ? mesh.points.size() : nodes.size(); }
  std::size_t n_hexes(const Mesh& mesh) const { return all ? mesh.hexes.size() : hexes.size(); }
  Index node(std::size_t i) const { return all ? static_cast<Index>(i) : nodes[i]; }
  Index hex(std::size_t i) const { return all ? static_cast<Index>(i) : hexes[i]; }
};

/// Nodes by owner, those without one on an entity of their own; and where each owner's nodes begin.
struct NodeOrder {
  struct Run {
    Owner owner;
    std::size_t first = 0, n = 0;
  };
  std::vector<Run> runs;
  std::vector<Index> nodes;  ///< empty: 0, 1, 2, ...
};
NodeOrder nodes_by_owner(const Mesh& mesh, const Association& association, const GmshPlan& plan,
                         const Selection& selection) {
  NodeOrder order;
  std::array<std::size_t, 4> start{};  // of each dimension's entities among all
  for (int dim = 0; dim < 4; ++dim) {
    start[dim] = order.runs.size();
    for (const PlannedEntity& entity : plan.entities[dim]) order.runs.push_back({{dim, entity.tag}, 0, 0});
  }
  std::vector<int> run_of_node;
  const std::size_t n_nodes = selection.n_nodes(mesh);
  resize_for_overwrite(run_of_node, n_nodes);
  std::size_t run = 0;
  for (std::size_t i = 0; i < n_nodes; ++i) {
    const Owner at = owner(association, selection.node(i)), of = at ? at : Owner{3, plan.nobody};
    if (i == 0 || of != order.runs[run].owner) {
      const auto& entities = plan.entities[of.dim];
      run = start[of.dim] + static_cast<std::size_t>(
                                std::ranges::lower_bound(entities, of.id, {}, &PlannedEntity::tag) - entities.begin());
    }
    run_of_node[i] = static_cast<int>(run);
    ++order.runs[run].n;
  }
  std::vector<std::size_t> next;
  std::size_t sum = 0;
  for (auto& one : order.runs) {
    one.first = sum;
    next.push_back(sum);
    sum += one.n;
  }
  std::erase_if(order.runs, [](const auto& one) { return one.n == 0; });
  if (order.runs.size() < 2 && selection.all) return order;
  resize_for_overwrite(order.nodes, n_nodes);
  for (std::size_t i = 0; i < n_nodes; ++i) order.nodes[next[run_of_node[i]]++] = selection.node(i);
  return order;
}

void write_nodes_4(const Writer& to, const Mesh& mesh, const Association& association, const GmshPlan& plan,
                   const Selection& selection) {
  const NodeOrder order = nodes_by_owner(mesh, association, plan, selection);
  const std::size_t n = selection.n_nodes(mesh);
  to.out << "$Nodes\n";
  to.large(order.runs.size());
  to.large(n);
  to.id(n == 0 ? 0 : node_id(mesh, selection.node(0)));
  to.id(n == 0 ? 0 : node_id(mesh, selection.node(n - 1)));
  to.end_line();
  for (const auto& run : order.runs) {
    to.integer(run.owner.dim);
    to.integer(plan.file_tag(run.owner.id));
    to.integer(0);
    to.large(run.n);
    to.end_line();
    const auto node = [&](std::size_t i) {
      return order.nodes.empty() ? static_cast<Index>(i) : order.nodes[run.first + i];
    };
    to.rows(run.n, [&](std::size_t i) { return std::array{id_of(mesh.node_ids, node(i))}; });
    to.rows(run.n, [&](std::size_t i) {
      const Vec3& p = mesh.points[node(i)];
      return std::array{p.x(), p.y(), p.z()};
    });
  }
  if (to.binary) to.out << '\n';
  to.out << "$EndNodes\n";
}

/// Type of the elements of a dimension, 0 points, of hexes with 8, 20 or 27 nodes; and how many nodes they have.
constexpr int element_type(int dim, int nodes_per_hex) {
  if (nodes_per_hex == 8 || dim == 0) return gmsh_kept[dim];
  return dim == 1 ? 8 : dim == 2 ? (nodes_per_hex == 20 ? 16 : 10) : nodes_per_hex == 20 ? 17 : 12;
}
constexpr std::size_t element_size(int dim, int nodes_per_hex) {
  constexpr std::array<std::array<std::size_t, 3>, 4> sizes = {{{1, 1, 1}, {2, 3, 3}, {4, 8, 9}, {8, 20, 27}}};
  return sizes[dim][nodes_per_hex == 8 ? 0 : nodes_per_hex == 20 ? 1 : 2];
}

/// Ids of the nodes of element k, in Gmsh's order.
template <int dim, int nodes_per_hex>
auto element_node_ids(const Mesh& mesh, const PlannedElements& elements, std::size_t k, const SecondOrder* second) {
  constexpr std::size_t n = element_size(dim, nodes_per_hex);
  std::array<std::int64_t, n> ids;
  if constexpr (nodes_per_hex > 8) {
    const FileHex nodes = gmsh_nodes(mesh, elements, dim, k, second);
    for (std::size_t c = 0; c < n; ++c) ids[c] = id_of(mesh.node_ids, nodes.nodes[c]);
    return ids;
  }
  std::array<Index, n> nodes;
  if constexpr (dim == 3 && nodes_per_hex == 8)
    nodes = in_file_order(mesh.hexes[elements.item(k)]);
  else
    std::ranges::copy_n(&elements.nodes[n * k], n, nodes.begin());
  for (std::size_t c = 0; c < n; ++c) ids[c] = id_of(mesh.node_ids, nodes[c]);
  return ids;
}

template <int dim, int nodes_per_hex>
void write_elements_4(const Writer& to, const Mesh& mesh, const GmshPlan& plan, const SecondOrder* second) {
  const PlannedElements& elements = plan.elements[dim];
  for (const auto& run : elements.runs) {
    to.integer(dim);
    to.integer(plan.file_tag(run.entity));
    to.integer(element_type(dim, nodes_per_hex));
    to.large(run.n);
    to.end_line();
    to.rows(run.n, [&](std::size_t i) {
      const std::size_t k = run.first + i;
      const auto ids = element_node_ids<dim, nodes_per_hex>(mesh, elements, k, second);
      std::array<std::int64_t, ids.size() + 1> row;
      row[0] = plan.tag(mesh, dim, k);
      std::ranges::copy(ids, row.begin() + 1);
      return row;
    });
  }
}

/// Lowest and highest tag of an element, 0 where there are none. Tags ascend along the items.
std::pair<std::int64_t, std::int64_t> element_tags(const Mesh& mesh, const GmshPlan& plan) {
  std::int64_t low = std::numeric_limits<std::int64_t>::max(), high = 0;
  const auto add = [&](std::int64_t first, std::int64_t last) {
    low = std::min(low, first), high = std::max(high, last);
  };
  if (plan.elements[3].size == mesh.hexes.size() && !mesh.hexes.empty()) {
    add(hex_id(mesh, 0), hex_id(mesh, mesh.n_hexes() - 1));
  } else {
    for (const Index h : plan.elements[3].items) add(hex_id(mesh, h), hex_id(mesh, h));
  }
  for (int dim = 0; dim < 3; ++dim)
    if (const std::size_t n = plan.elements[dim].size; n > 0) add(plan.tag(mesh, dim, 0), plan.tag(mesh, dim, n - 1));
  for (const PlannedOthers& others : plan.others) add(std::ranges::min(others.tags), std::ranges::max(others.tags));
  return {high == 0 ? 0 : low, high};
}

/// Elements beside the hexes; head(run, k): what stands between the tag of element k and its nodes.
template <class Id, class Head>
void write_gmsh_others(const Writer& to, const Mesh& mesh, const PlannedOthers& others, const Head& head) {
  const std::size_t width = others.nodes.size() / others.tags.size();
  for (std::size_t k = 0; k < others.tags.size(); ++k) {
    to.value(static_cast<Id>(others.tags[k]));
    head();
    for (std::size_t c = 0; c < width; ++c)
      to.value(static_cast<Id>(id_of(mesh.node_ids, others.nodes[width * k + c])));
    to.end_line();
  }
}

template <int nodes_per_hex>
void write_elements_4(const Writer& to, const Mesh& mesh, const GmshPlan& plan, const SecondOrder* second) {
  std::size_t n_blocks = 0;
  for (const auto& elements : plan.elements) n_blocks += elements.runs.size();
  n_blocks += plan.others.size();
  const auto [low, high] = element_tags(mesh, plan);
  to.out << "$Elements\n";
  to.large(n_blocks);
  to.large(plan.n_elements());
  to.id(low);
  to.id(high);
  to.end_line();
  write_elements_4<0, nodes_per_hex>(to, mesh, plan, second);
  write_elements_4<1, nodes_per_hex>(to, mesh, plan, second);
  write_elements_4<2, nodes_per_hex>(to, mesh, plan, second);
  write_elements_4<3, nodes_per_hex>(to, mesh, plan, second);
  for (const PlannedOthers& others : plan.others) {
    for (const int x : {others.dim, others.entity, others.type}) to.integer(x);
    to.large(others.tags.size());
    to.end_line();
    write_gmsh_others<std::int64_t>(to, mesh, others, [] {});
  }
  if (to.binary) to.out << '\n';
  to.out << "$EndElements\n";
}

void write_nodes_2(const Writer& to, const Mesh& mesh, const Selection& selection) {
  to.out << "$Nodes\n" << selection.n_nodes(mesh) << '\n';
  for (std::size_t i = 0; i < selection.n_nodes(mesh); ++i) {
    const Index n = selection.node(i);
    to.integer(static_cast<int>(node_id(mesh, n)));
    for (const double x : mesh.points[n]) to.real(x);
    to.end_line();
  }
  if (to.binary) to.out << '\n';
  to.out << "$EndNodes\n";
}

template <int dim, int nodes_per_hex>
void write_elements_2(const Writer& to, const Mesh& mesh, const GmshPlan& plan, const SecondOrder* second) {
  const PlannedElements& elements = plan.elements[dim];
  if (to.binary && elements.size > 0) {
    to.integer(element_type(dim, nodes_per_hex));
    to.integer(static_cast<int>(elements.size));
    to.integer(2);
  }
  for (const auto& run : elements.runs) {
    const auto row = [&]<std::size_t n_head>(std::size_t k, const std::array<int, n_head>& head) {
      const auto ids = element_node_ids<dim, nodes_per_hex>(mesh, elements, k, second);
      std::array<std::int32_t, n_head + ids.size()> result;
      std::ranges::copy(head, result.begin());
      for (std::size_t c = 0; c < ids.size(); ++c) result[n_head + c] = static_cast<int>(ids[c]);
      return result;
    };
    const auto tag = [&](std::size_t k) { return static_cast<int>(plan.tag(mesh, dim, k)); };
    if (to.binary)
      to.rows(run.n, [&](std::size_t i) {
        return row(run.first + i, std::array{tag(run.first + i), run.physical, run.entity});
      });
    else
      to.rows(run.n, [&](std::size_t i) {
        return row(run.first + i,
                   std::array{tag(run.first + i), element_type(dim, nodes_per_hex), 2, run.physical, run.entity});
      });
  }
}

template <int nodes_per_hex>
void write_elements_2(const Writer& to, const Mesh& mesh, const GmshPlan& plan, const SecondOrder* second) {
  to.out << "$Elements\n" << plan.n_elements() << '\n';
  write_elements_2<0, nodes_per_hex>(to, mesh, plan, second);
  write_elements_2<1, nodes_per_hex>(to, mesh, plan, second);
  write_elements_2<2, nodes_per_hex>(to, mesh, plan, second);
  write_elements_2<3, nodes_per_hex>(to, mesh, plan, second);
  for (const PlannedOthers& others : plan.others) {
    if (to.binary)
      for (const int x : {others.type, static_cast<int>(others.tags.size()), 2}) to.integer(x);
    write_gmsh_others<std::int32_t>(to, mesh, others, [&] {
      if (!to.binary)
        for (const int x : {others.type, 2}) to.integer(x);
      for (const int x : {others.physical, others.entity}) to.integer(x);
    });
  }
  if (to.binary) to.out << '\n';
  to.out << "$EndElements\n";
}

/// Gmsh's views have 1, 3 or 9 components.
void write_fields(const Writer& to, const Mesh& mesh, const Selection& selection, std::vector<std::string>& notices) {
  if (!mesh.fields.empty() && !mesh.hexes.empty())
    check_int32(std::max(node_id(mesh, mesh.n_nodes() - 1), hex_id(mesh, mesh.n_hexes() - 1)), "fields in ");
  for (const Field& field : split_components(
           mesh.fields, [](int n) { return n == 3 || n == 9; }, notices)) {
    const bool node = field.on == Field::On::node;
    const std::size_t n = node ? selection.n_nodes(mesh) : selection.n_hexes(mesh);
    to.out << (node ? "$NodeData\n" : "$ElementData\n") << "1\n\"" << plain(field.name) << "\"\n1\n0\n3\n0\n"
           << field.components << '\n'
           << n << '\n';
    const auto width = static_cast<std::size_t>(field.components);
    for (std::size_t k = 0; k < n; ++k) {
      const Index i = node ? selection.node(k) : selection.hex(k);
      to.integer(static_cast<int>(node ? node_id(mesh, i) : hex_id(mesh, i)));
      for (std::size_t c = 0; c < width; ++c) to.real(field.values[i * width + c]);
      to.end_line();
    }
    if (to.binary) to.out << '\n';
    to.out << (node ? "$EndNodeData\n" : "$EndElementData\n");
  }
}

void write_periodic(const Writer& to, const Mesh& mesh, const std::vector<PlannedPeriodic>& links, bool v4) {
  if (links.empty()) return;
  to.out << "$Periodic\n";
  // Text in every file of version 2.2.
  const Writer at{to.out, to.binary && v4};
  v4 ? at.large(links.size()) : at.integer(static_cast<int>(links.size()));
  at.end_line();
  for (const PlannedPeriodic& link : links) {
    for (const int tag : {link.dim, link.entity, link.of}) at.integer(tag);
    at.end_line();
    if (v4)
      at.large(link.affine.size());
    else
      to.out << "Affine ";
    for (const double x : link.affine) at.real(x);
    at.end_line();
    at.large(link.nodes.size());
    at.end_line();
    at.rows(link.nodes.size(), [&](std::size_t i) {
      return std::array{id_of(mesh.node_ids, link.nodes[i][0]), id_of(mesh.node_ids, link.nodes[i][1])};
    });
  }
  if (at.binary) to.out << '\n';
  to.out << "$EndPeriodic\n";
}

/// Leaves physical groups and what they need.
Selection groups_only(GmshPlan& plan, const Mesh& mesh, bool v4, const SecondOrder* second,
                      std::vector<std::string>& notices) {
  Selection result{false, keep_groups_only(plan, mesh, v4, second), plan.elements[3].items};
  std::ranges::sort(result.hexes);
  if (result.hexes.empty()) throw Error("there is no hex in a block, so there is nothing of groups only to write");
  if (const auto n = mesh.hexes.size() - result.hexes.size())
    notices.push_back(counted(static_cast<std::int64_t>(n), "hex", "hexes") + " in no block left out");
  return result;
}

}  // namespace

FileHex gmsh_nodes(const Mesh& mesh, const PlannedElements& elements, int dim, std::size_t k,
                   const SecondOrder* second) {
  if (dim == 3) return file_hex(mesh, second, elements.item(k), gmsh_middles);
  FileHex result;
  result.n = 1 << dim;
  std::ranges::copy_n(&elements.nodes[static_cast<std::size_t>(result.n) * k], result.n, result.nodes.begin());
  if (!second || dim == 0) return result;
  const auto& n = result.nodes;
  const int n_corners = result.n;
  for (int c = 0; c < (dim == 1 ? 1 : 4); ++c)
    result.nodes[result.n++] = second->middle_between(n[c], n[(c + 1) % n_corners]);
  if (dim == 2 && second->nodes_per_hex == 27) result.nodes[result.n++] = second->middle_of({n[0], n[1], n[2], n[3]});
  return result;
}

void write_gmsh(Output& out, const Mesh& mesh, const Association& association, const WriteOptions& options,
                std::vector<std::string>& notices) {
  if (options.gmsh_version != 22 && options.gmsh_version != 41)
    throw Error("Gmsh version " + std::to_string(options.gmsh_version) + " is neither 22 nor 41");
  const bool v4 = options.gmsh_version == 41;
  const SecondOrder* const second = options.second;
  const int nodes_per_hex = second ? second->nodes_per_hex : 8;
  GmshPlan plan =
      plan_gmsh(mesh, association, v4, options.model, options.extras, second ? second->n_corners : mesh.n_nodes());
  if (options.part) take_part(plan, *options.part);
  if (mesh.others && !options.groups_only) plan_gmsh_others(mesh, v4, plan, notices);
  if (mesh.others && options.groups_only)
    notices.push_back("files of groups only have no other elements here: left out " + others_text(mesh));
  const Selection selection = options.groups_only ? groups_only(plan, mesh, v4, second, notices) : Selection{};
  if (!v4 && std::ranges::any_of(plan.groups, [](const PlannedGroup& group) { return !group.more.empty(); }))
    notices.emplace_back(
        "groups overlap, and version 2.2 says one group of each element: other programs see the first");
  const Writer to{out, options.binary};
  out << "$MeshFormat\n" << (v4 ? "4.1 " : "2.2 ") << (options.binary ? "1 8\n" : "0 8\n");
  if (options.binary) {
    out.put(std::int32_t{1});
    out << '\n';
  }
  out << "$EndMeshFormat\n";
  const auto say_zero = [&](const char* kind, const auto& groups) {
    for (const auto& group : groups)
      if (group.id == 0)
        notices.push_back(std::string(kind) + " 0 is physical group " + std::to_string(group_tag(groups, group)) +
                          " in the file: 0 is no group there");
  };
  say_zero("block", mesh.blocks);
  say_zero("side set", mesh.side_sets);
  say_zero("node set", mesh.node_sets);
  for (const PlannedGroup& group : plan.groups)
    say_renamed("physical group " + std::to_string(group.group.id), group.name, plain(group.name), notices);
  for (const Field& field : mesh.fields) say_renamed("field", field.name, plain(field.name), notices);
  write_names(out, plan);
  if (v4) {
    write_entities_4(to, plan, false);
    if (options.part) write_entities_4(to, plan, true);
    write_nodes_4(to, mesh, association, plan, selection);
    const auto write = nodes_per_hex == 8    ? write_elements_4<8>
                       : nodes_per_hex == 20 ? write_elements_4<20>
                                             : write_elements_4<27>;
    write(to, mesh, plan, second);
  } else {
    check_int32(mesh.points.empty() ? 0 : node_id(mesh, mesh.n_nodes() - 1), "version 2.2 of ");
    check_int32(element_tags(mesh, plan).second, "version 2.2 of ");
    write_nodes_2(to, mesh, selection);
    const auto write = nodes_per_hex == 8    ? write_elements_2<8>
                       : nodes_per_hex == 20 ? write_elements_2<20>
                                             : write_elements_2<27>;
    write(to, mesh, plan, second);
  }
  // Behind the elements: some readers want nothing else before them (PETSc).
  if (options.extras && !options.groups_only)
    write_periodic(to, mesh, plan_periodic(mesh, association, options.extras->periodic, notices), v4);
  write_parts(out, plan);
  say_values_of_others(mesh, "Gmsh", notices);
  say_whole_numbers(mesh, "Gmsh", notices);
  write_fields(to, mesh, selection, notices);
}

}  // namespace hextwist::io
