// Gmsh's .msh 2.2 and 4.1 from a plan.
//
// Two sections of our own, which Gmsh and others skip, keep what its groups of whole entities cannot say:
//   $HextwistParts: entities that are parts of a CAD entity or of none (dimension tag parent's dimension and tag), and
//   members of physical groups beyond the one that an element of format 2.2 can name.
#include <limits>
#include <numeric>

#include "hextwist/base/large_array.h"
#include "hextwist/io/gmsh/gmsh.h"
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

void write_entities_4(const Writer& to, const GmshPlan& plan) {
  to.out << "$Entities\n";
  for (const auto& entities : plan.entities) to.large(entities.size());
  to.end_line();
  for (int dim = 0; dim < 4; ++dim)
    for (const PlannedEntity& entity : plan.entities[dim]) {
      to.integer(entity.tag);
      const Box box = entity.box.empty() ? Box{Vec3::Zero(), Vec3::Zero()} : entity.box;
      for (const double x : box.min) to.real(x);
      if (dim > 0)
        for (const double x : box.max) to.real(x);
      to.large(entity.physicals.size());
      for (const int id : entity.physicals) to.integer(id);
      if (dim > 0) {
        to.large(entity.boundary.size());
        for (const int tag : entity.boundary) to.integer(tag);
      }
      to.end_line();
    }
  if (to.binary) to.out << '\n';
  to.out << "$EndEntities\n";
}

/// Nodes by owner, those without one on an entity of their own; and where each owner's nodes begin.
struct NodeOrder {
  struct Run {
    Owner owner;
    std::size_t first = 0, n = 0;
  };
  std::vector<Run> runs;
  std::vector<Index> nodes;  ///< empty: 0, 1, 2, ...
};
NodeOrder nodes_by_owner(const Mesh& mesh, const Association& association, const GmshPlan& plan) {
  NodeOrder order;
  std::array<std::size_t, 4> start{};  // of each dimension's entities among all
  for (int dim = 0; dim < 4; ++dim) {
    start[dim] = order.runs.size();
    for (const PlannedEntity& entity : plan.entities[dim]) order.runs.push_back({{dim, entity.tag}, 0, 0});
  }
  std::vector<int> run_of_node;
  resize_for_overwrite(run_of_node, mesh.points.size());
  std::size_t run = 0;
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    const Owner at = owner(association, n), of = at ? at : Owner{3, plan.nobody};
    if (n == 0 || of != order.runs[run].owner) {
      const auto& entities = plan.entities[of.dim];
      run = start[of.dim] + static_cast<std::size_t>(
                                std::ranges::lower_bound(entities, of.id, {}, &PlannedEntity::tag) - entities.begin());
    }
    run_of_node[n] = static_cast<int>(run);
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
  if (order.runs.size() < 2) return order;
  resize_for_overwrite(order.nodes, mesh.points.size());
  for (Index n = 0; n < mesh.n_nodes(); ++n) order.nodes[next[run_of_node[n]]++] = n;
  return order;
}

void write_nodes_4(const Writer& to, const Mesh& mesh, const Association& association, const GmshPlan& plan) {
  const NodeOrder order = nodes_by_owner(mesh, association, plan);
  to.out << "$Nodes\n";
  to.large(order.runs.size());
  to.large(mesh.points.size());
  to.id(mesh.points.empty() ? 0 : node_id(mesh, 0));
  to.id(mesh.points.empty() ? 0 : node_id(mesh, mesh.n_nodes() - 1));
  to.end_line();
  for (const auto& run : order.runs) {
    to.integer(run.owner.dim);
    to.integer(run.owner.id);
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

/// Ids of the nodes of element k, in Gmsh's order.
template <int dim>
auto element_node_ids(const Mesh& mesh, const PlannedElements& elements, std::size_t k) {
  constexpr std::size_t n = dim == 3 ? 8 : dim == 2 ? 4 : dim + 1;
  std::array<Index, n> nodes;
  if constexpr (dim == 3)
    nodes = in_file_order(mesh.hexes[elements.item(k)]);
  else
    std::ranges::copy_n(&elements.nodes[n * k], n, nodes.begin());
  std::array<std::int64_t, n> ids;
  for (std::size_t c = 0; c < n; ++c) ids[c] = id_of(mesh.node_ids, nodes[c]);
  return ids;
}

template <int dim>
void write_elements_4(const Writer& to, const Mesh& mesh, const GmshPlan& plan) {
  const PlannedElements& elements = plan.elements[dim];
  for (const auto& run : elements.runs) {
    to.integer(dim);
    to.integer(run.entity);
    to.integer(gmsh_kept[dim]);
    to.large(run.n);
    to.end_line();
    to.rows(run.n, [&](std::size_t i) {
      const std::size_t k = run.first + i;
      const auto ids = element_node_ids<dim>(mesh, elements, k);
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
  if (!mesh.hexes.empty()) add(hex_id(mesh, 0), hex_id(mesh, mesh.n_hexes() - 1));
  for (int dim = 0; dim < 3; ++dim)
    if (const std::size_t n = plan.elements[dim].size; n > 0) add(plan.tag(mesh, dim, 0), plan.tag(mesh, dim, n - 1));
  return {high == 0 ? 0 : low, high};
}

void write_elements_4(const Writer& to, const Mesh& mesh, const GmshPlan& plan) {
  std::size_t n_blocks = 0;
  for (const auto& elements : plan.elements) n_blocks += elements.runs.size();
  const auto [low, high] = element_tags(mesh, plan);
  to.out << "$Elements\n";
  to.large(n_blocks);
  to.large(plan.n_elements());
  to.id(low);
  to.id(high);
  to.end_line();
  write_elements_4<0>(to, mesh, plan);
  write_elements_4<1>(to, mesh, plan);
  write_elements_4<2>(to, mesh, plan);
  write_elements_4<3>(to, mesh, plan);
  if (to.binary) to.out << '\n';
  to.out << "$EndElements\n";
}

void write_nodes_2(const Writer& to, const Mesh& mesh) {
  to.out << "$Nodes\n" << mesh.points.size() << '\n';
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    to.integer(static_cast<int>(node_id(mesh, n)));
    for (const double x : mesh.points[n]) to.real(x);
    to.end_line();
  }
  if (to.binary) to.out << '\n';
  to.out << "$EndNodes\n";
}

template <int dim>
void write_elements_2(const Writer& to, const Mesh& mesh, const GmshPlan& plan) {
  const PlannedElements& elements = plan.elements[dim];
  if (to.binary && elements.size > 0) {
    to.integer(gmsh_kept[dim]);
    to.integer(static_cast<int>(elements.size));
    to.integer(2);
  }
  for (const auto& run : elements.runs) {
    const auto row = [&]<std::size_t n_head>(std::size_t k, const std::array<int, n_head>& head) {
      const auto ids = element_node_ids<dim>(mesh, elements, k);
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
        return row(run.first + i, std::array{tag(run.first + i), gmsh_kept[dim], 2, run.physical, run.entity});
      });
  }
}

void write_elements_2(const Writer& to, const Mesh& mesh, const GmshPlan& plan) {
  to.out << "$Elements\n" << plan.n_elements() << '\n';
  write_elements_2<0>(to, mesh, plan);
  write_elements_2<1>(to, mesh, plan);
  write_elements_2<2>(to, mesh, plan);
  write_elements_2<3>(to, mesh, plan);
  if (to.binary) to.out << '\n';
  to.out << "$EndElements\n";
}

/// Gmsh's views have 1, 3 or 9 components.
void write_fields(const Writer& to, const Mesh& mesh) {
  if (!mesh.fields.empty() && !mesh.hexes.empty())
    check_int32(std::max(node_id(mesh, mesh.n_nodes() - 1), hex_id(mesh, mesh.n_hexes() - 1)), "fields in ");
  for (const Field& field : split_components(mesh.fields, [](int n) { return n == 3 || n == 9; })) {
    const bool node = field.on == Field::On::node;
    const Index n = node ? mesh.n_nodes() : mesh.n_hexes();
    to.out << (node ? "$NodeData\n" : "$ElementData\n") << "1\n\"" << plain(field.name) << "\"\n1\n0\n3\n0\n"
           << field.components << '\n'
           << n << '\n';
    const auto width = static_cast<std::size_t>(field.components);
    for (Index i = 0; i < n; ++i) {
      to.integer(static_cast<int>(node ? node_id(mesh, i) : hex_id(mesh, i)));
      for (std::size_t c = 0; c < width; ++c) to.real(field.values[i * width + c]);
      to.end_line();
    }
    if (to.binary) to.out << '\n';
    to.out << (node ? "$EndNodeData\n" : "$EndElementData\n");
  }
}

}  // namespace

void write_gmsh(Output& out, const Mesh& mesh, const Association& association, const WriteOptions& options,
                std::vector<std::string>&) {
  if (options.gmsh_version != 22 && options.gmsh_version != 41)
    throw Error("Gmsh version " + std::to_string(options.gmsh_version) + " is neither 22 nor 41");
  const bool v4 = options.gmsh_version == 41;
  const GmshPlan plan = plan_gmsh(mesh, association, v4);
  const Writer to{out, options.binary};
  out << "$MeshFormat\n" << (v4 ? "4.1 " : "2.2 ") << (options.binary ? "1 8\n" : "0 8\n");
  if (options.binary) {
    out.put(std::int32_t{1});
    out << '\n';
  }
  out << "$EndMeshFormat\n";
  write_names(out, plan);
  if (v4) {
    write_entities_4(to, plan);
    write_nodes_4(to, mesh, association, plan);
    write_parts(out, plan);
    write_elements_4(to, mesh, plan);
  } else {
    check_int32(mesh.points.empty() ? 0 : node_id(mesh, mesh.n_nodes() - 1), "version 2.2 of ");
    check_int32(element_tags(mesh, plan).second, "version 2.2 of ");
    write_nodes_2(to, mesh);
    write_parts(out, plan);
    write_elements_2(to, mesh, plan);
  }
  write_fields(to, mesh);
}

}  // namespace hextwist::io
