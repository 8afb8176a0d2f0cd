// Gmsh's .msh 2.2 and 4.1 from a plan.
//
// Two sections of our own, which Gmsh and others skip, keep what its groups of whole entities cannot say:
//   $HextwistParts: entities that are parts of a CAD entity or of none (dimension tag parent's dimension and tag), and
//   members of physical groups beyond the one that an element of format 2.2 can name.
#include <limits>
#include <numeric>

#include "hextwist/mesh/io_gmsh_internal.h"
#include "hextwist/mesh/io_gmsh_plan_internal.h"

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

void write_nodes_4(const Writer& to, const Mesh& mesh, const Association& association, const GmshPlan& plan) {
  // Nodes by owner; those of nobody on an entity that says so.
  std::vector<std::pair<Owner, Index>> order(mesh.points.size());
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    const Owner at = owner(association, n);
    order[n] = {at ? at : Owner{3, plan.nobody}, n};
  }
  if (!std::ranges::is_sorted(order)) std::ranges::sort(order);
  std::vector<std::size_t> first;
  for (std::size_t i = 0; i < order.size(); ++i)
    if (i == 0 || order[i].first != order[i - 1].first) first.push_back(i);
  to.out << "$Nodes\n";
  to.large(first.size());
  to.large(order.size());
  to.id(mesh.points.empty() ? 0 : node_id(mesh, 0));
  to.id(mesh.points.empty() ? 0 : node_id(mesh, mesh.n_nodes() - 1));
  to.end_line();
  first.push_back(order.size());
  for (std::size_t block = 0; block + 1 < first.size(); ++block) {
    const auto nodes = std::span(order).subspan(first[block], first[block + 1] - first[block]);
    to.integer(nodes[0].first.dim);
    to.integer(nodes[0].first.id);
    to.integer(0);
    to.large(nodes.size());
    to.end_line();
    for (const auto& [at, n] : nodes) {
      to.id(node_id(mesh, n));
      to.end_line();
    }
    for (const auto& [at, n] : nodes) {
      for (const double x : mesh.points[n]) to.real(x);
      to.end_line();
    }
  }
  if (to.binary) to.out << '\n';
  to.out << "$EndNodes\n";
}

void write_elements_4(const Writer& to, const Mesh& mesh, const GmshPlan& plan) {
  std::size_t n_blocks = 0;
  std::int64_t low = std::numeric_limits<std::int64_t>::max(), high = 0;
  for (const auto& elements : plan.elements) {
    for (std::size_t i = 0; i < elements.entity.size(); ++i)
      n_blocks += i == 0 || elements.entity[i] != elements.entity[i - 1];
    for (const auto tag : elements.tags) low = std::min(low, tag), high = std::max(high, tag);
  }
  to.out << "$Elements\n";
  to.large(n_blocks);
  to.large(plan.n_elements());
  to.id(high == 0 ? 0 : low);
  to.id(high);
  to.end_line();
  for (int dim = 0; dim < 4; ++dim) {
    const PlannedElements& elements = plan.elements[dim];
    const auto n_nodes = static_cast<std::size_t>(gmsh_type(gmsh_kept[dim])->n_nodes);
    for (std::size_t i = 0; i < elements.tags.size();) {
      std::size_t end = i;
      while (end < elements.tags.size() && elements.entity[end] == elements.entity[i]) ++end;
      to.integer(dim);
      to.integer(elements.entity[i]);
      to.integer(gmsh_kept[dim]);
      to.large(end - i);
      to.end_line();
      for (; i < end; ++i) {
        to.id(elements.tags[i]);
        for (std::size_t k = 0; k < n_nodes; ++k) to.id(node_id(mesh, elements.nodes[n_nodes * i + k]));
        to.end_line();
      }
    }
  }
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

void write_elements_2(const Writer& to, const Mesh& mesh, const GmshPlan& plan) {
  to.out << "$Elements\n" << plan.n_elements() << '\n';
  for (int dim = 0; dim < 4; ++dim) {
    const PlannedElements& elements = plan.elements[dim];
    const auto n_nodes = static_cast<std::size_t>(gmsh_type(gmsh_kept[dim])->n_nodes);
    if (to.binary && !elements.tags.empty()) {
      to.integer(gmsh_kept[dim]);
      to.integer(static_cast<int>(elements.tags.size()));
      to.integer(2);
    }
    for (std::size_t i = 0; i < elements.tags.size(); ++i) {
      to.integer(static_cast<int>(elements.tags[i]));
      if (!to.binary) {
        to.integer(gmsh_kept[dim]);
        to.integer(2);
      }
      to.integer(elements.physical[i]);
      to.integer(elements.entity[i]);
      for (std::size_t k = 0; k < n_nodes; ++k)
        to.integer(static_cast<int>(node_id(mesh, elements.nodes[n_nodes * i + k])));
      to.end_line();
    }
  }
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

void write_gmsh(Output& out, const Mesh& mesh, const Association& association, const WriteOptions& options) {
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
    std::int64_t high = mesh.points.empty() ? 0 : node_id(mesh, mesh.n_nodes() - 1);
    for (const auto& elements : plan.elements)
      if (!elements.tags.empty()) high = std::max(high, std::ranges::max(elements.tags));
    check_int32(high, "version 2.2 of ");
    write_nodes_2(to, mesh);
    write_parts(out, plan);
    write_elements_2(to, mesh, plan);
  }
  write_fields(to, mesh);
}

}  // namespace hextwist::io
