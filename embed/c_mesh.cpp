// The arrays of a mesh for C. Vectors of small structs are flat arrays already: the asserts below say so.
#include <algorithm>
#include <cstring>
#include <memory>
#include <type_traits>

#include "hextwist/embed/c_internal.h"
#include "hextwist/mesh/interpolation.h"
#include "hextwist/mesh/quality/quality.h"

using namespace hextwist;
using namespace hextwist::embed;

namespace {

/// The array behind a list of T, each made of a fixed number of S.
template <class S, class List>
const S* flat(const List& list) {
  using T = std::remove_cvref_t<decltype(list[0])>;
  static_assert(sizeof(T) % sizeof(S) == 0 && alignof(T) >= alignof(S) && std::is_standard_layout_v<T>);
  return list.empty() ? nullptr : reinterpret_cast<const S*>(list.data());
}

static_assert(sizeof(Owner) == 2 * sizeof(std::int32_t) && sizeof(Side) == 2 * sizeof(std::int32_t));
static_assert(sizeof(Parameters) == 2 * sizeof(double) && sizeof(Vec3) == 3 * sizeof(double));
static_assert(sizeof(int) == sizeof(std::int32_t));

/// Makes a lazy array; null when there is no memory for it.
template <class S, class F>
const S* made(F make) {
  const S* array = nullptr;
  guarded([&] { array = flat<S>(make()); });
  return array;
}

std::int64_t count(const auto& list) {
  return static_cast<std::int64_t>(list.size());
}
bool within(std::int64_t i, const auto& list) {
  return i >= 0 && i < count(list);
}

/// An empty mesh in place of none: hextwist_mesh_of() may have failed.
const MeshView& view(const hextwist_mesh* mesh) {
  static const MeshView nothing(std::make_shared<const MeshedModel>());
  return mesh ? mesh->view : nothing;
}

const Association& association(const hextwist_mesh* mesh) {
  return view(mesh).meshed().association;
}

}  // namespace

std::int64_t hextwist_n_nodes(const hextwist_mesh* mesh) {
  return view(mesh).mesh().n_nodes();
}
std::int64_t hextwist_n_hexes(const hextwist_mesh* mesh) {
  return view(mesh).mesh().n_hexes();
}
const double* hextwist_points(const hextwist_mesh* mesh) {
  const auto& points = view(mesh).mesh().points;
  return points.empty() ? nullptr : points.front().data();
}
const std::int32_t* hextwist_hexes(const hextwist_mesh* mesh) {
  return made<std::int32_t>([&] { return view(mesh).file_hexes(); });
}
const std::int32_t* hextwist_bit_hexes(const hextwist_mesh* mesh) {
  return flat<std::int32_t>(view(mesh).mesh().hexes);
}
const std::int64_t* hextwist_node_ids(const hextwist_mesh* mesh) {
  return made<std::int64_t>([&] { return view(mesh).node_ids(); });
}
const std::int64_t* hextwist_hex_ids(const hextwist_mesh* mesh) {
  return made<std::int64_t>([&] { return view(mesh).hex_ids(); });
}

const std::int32_t* hextwist_node_owners(const hextwist_mesh* mesh) {
  return flat<std::int32_t>(association(mesh).node_owner);
}
const double* hextwist_node_parameters(const hextwist_mesh* mesh) {
  return flat<double>(association(mesh).node_parameters);
}
const std::int32_t* hextwist_hex_volumes(const hextwist_mesh* mesh) {
  return flat<std::int32_t>(association(mesh).hex_volume);
}
std::int64_t hextwist_n_curve_edges(const hextwist_mesh* mesh) {
  return count(association(mesh).curve_edges);
}
const std::int32_t* hextwist_curve_edges(const hextwist_mesh* mesh) {
  return flat<std::int32_t>(association(mesh).curve_edges);
}
const std::int32_t* hextwist_edge_curves(const hextwist_mesh* mesh) {
  return flat<std::int32_t>(association(mesh).edge_curve);
}
std::int64_t hextwist_n_surface_quads(const hextwist_mesh* mesh) {
  return count(association(mesh).surface_faces);
}
const std::int32_t* hextwist_surface_quads(const hextwist_mesh* mesh) {
  return made<std::int32_t>([&] { return view(mesh).surface_quads(); });
}
const std::int32_t* hextwist_surface_sides(const hextwist_mesh* mesh) {
  return flat<std::int32_t>(association(mesh).surface_faces);
}
const std::int32_t* hextwist_quad_surfaces(const hextwist_mesh* mesh) {
  return flat<std::int32_t>(association(mesh).face_surface);
}

std::int64_t hextwist_n_entities(const hextwist_mesh* mesh, int dim) {
  const auto& model = view(mesh).meshed().model;
  return model && dim >= 0 && dim <= 3 ? model->count(dim) : 0;
}
double hextwist_entity_measure(const hextwist_mesh* mesh, int dim, int id) {
  double measure = 0;
  if (id >= 1 && id <= hextwist_n_entities(mesh, dim))
    guarded([&] { measure = view(mesh).meshed().model->measure({dim, id}); });
  return measure;
}

std::int64_t hextwist_n_groups(const hextwist_mesh* mesh, hextwist_group_kind kind) {
  const Mesh& m = view(mesh).mesh();
  return kind == HEXTWIST_BLOCK      ? count(m.blocks)
         : kind == HEXTWIST_NODE_SET ? count(m.node_sets)
         : kind == HEXTWIST_SIDE_SET ? count(m.side_sets)
                                     : 0;
}
hextwist_group hextwist_group_at(const hextwist_mesh* mesh, hextwist_group_kind kind, std::int64_t i) {
  if (i < 0 || i >= hextwist_n_groups(mesh, kind)) return {};
  const auto at = static_cast<std::size_t>(i);
  const Mesh& m = view(mesh).mesh();
  const auto group = [](const auto& of, const auto& members) {
    return hextwist_group{of.id, of.name.c_str(), count(members), flat<std::int32_t>(members)};
  };
  if (kind == HEXTWIST_BLOCK) return group(m.blocks[at], m.blocks[at].hexes);
  if (kind == HEXTWIST_NODE_SET) return group(m.node_sets[at], m.node_sets[at].nodes);
  hextwist_group result{};
  guarded([&] { result = group(m.side_sets[at], view(mesh).set_quads(at)); });
  return result;
}

hextwist_group hextwist_group_named(const hextwist_mesh* mesh, hextwist_group_kind kind, const char* name) {
  if (name)
    for (std::int64_t i = 0; i < hextwist_n_groups(mesh, kind); ++i)
      if (const hextwist_group group = hextwist_group_at(mesh, kind, i);
          group.name && std::strcmp(group.name, name) == 0)
        return group;
  return {};
}
const std::int32_t* hextwist_side_set_sides(const hextwist_mesh* mesh, std::int64_t i) {
  const auto& sets = view(mesh).mesh().side_sets;
  return within(i, sets) ? flat<std::int32_t>(sets[static_cast<std::size_t>(i)].sides) : nullptr;
}
hextwist_status hextwist_surfaces_of(const hextwist_mesh* mesh, const std::int32_t* quads, std::int64_t n,
                                     std::int32_t* surfaces) {
  return guarded([&] {
    if (!mesh) throw Error("there is no mesh: the pointer is null");
    if (n < 0 || (n > 0 && (!quads || !surfaces))) throw Error("quads and an array for the ids of surfaces are needed");
    std::vector<Quad> wanted(static_cast<std::size_t>(n));
    for (std::size_t i = 0; i < wanted.size(); ++i) std::copy_n(quads + 4 * i, 4, wanted[i].begin());
    std::ranges::copy(view(mesh).surfaces_of(wanted), surfaces);
  });
}

std::int64_t hextwist_n_fields(const hextwist_mesh* mesh) {
  return count(view(mesh).mesh().fields);
}
hextwist_field hextwist_field_at(const hextwist_mesh* mesh, std::int64_t i) {
  const auto& fields = view(mesh).mesh().fields;
  if (!within(i, fields)) return {};
  const Field& field = fields[static_cast<std::size_t>(i)];
  return {field.name.c_str(), field.on == Field::On::hex, field.components, field.values.data(), field.integer};
}

hextwist_status hextwist_quality(const hextwist_mesh* mesh, const char* metric, double* values) {
  return guarded([&] {
    if (!mesh) throw Error("there is no mesh: the pointer is null");
    if (!metric || !values) throw Error("the name of a metric and an array for its values are needed");
    std::ranges::copy(quality(hextwist::metric(metric), view(mesh).mesh()), values);
  });
}

namespace {

std::vector<Vec3> points_of(const hextwist_mesh* mesh, const double* points, std::int64_t n) {
  if (!mesh) throw Error("there is no mesh: the pointer is null");
  if (n < 0 || (n > 0 && !points)) throw Error("the array of points is missing");
  std::vector<Vec3> list(static_cast<std::size_t>(n));
  for (std::size_t i = 0; i < list.size(); ++i) list[i] = Vec3(points + 3 * i);
  return list;
}

void give_rows(const SparseRows& rows, std::int64_t** first, std::int32_t** columns, double** values) {
  if (!first || !columns || !values) throw Error("first, columns and values are needed");
  const auto hold = [](auto* array) { return std::unique_ptr<void, decltype(&std::free)>(array, &std::free); };
  auto a = hold(given_away(rows.first)), b = hold(given_away(rows.columns)), c = hold(given_away(rows.values));
  *first = static_cast<std::int64_t*>(a.release());
  *columns = static_cast<std::int32_t*>(b.release());
  *values = static_cast<double*>(c.release());
}

}  // namespace

hextwist_status hextwist_locate(const hextwist_mesh* mesh, const double* points, std::int64_t n, std::int32_t* hexes,
                                double* distances) {
  return guarded([&] {
    const Interpolation at = interpolation_at(view(mesh).mesh(), points_of(mesh, points, n));
    if (hexes) std::ranges::copy(at.hexes, hexes);
    if (distances) std::ranges::copy(at.distances, distances);
  });
}
hextwist_status hextwist_field_at_points(const hextwist_mesh* mesh, std::int64_t i, const double* points,
                                         std::int64_t n, double* values) {
  return guarded([&] {
    const std::vector<Vec3> wanted = points_of(mesh, points, n);
    const Mesh& of = view(mesh).mesh();
    if (!within(i, of.fields)) throw Error("there is no field " + std::to_string(i));
    if (n > 0 && !values) throw Error("an array for the values is needed");
    std::ranges::copy(values_at(of, of.fields[static_cast<std::size_t>(i)], interpolation_at(of, wanted)), values);
  });
}
hextwist_status hextwist_interpolation(const hextwist_mesh* mesh, const double* points, std::int64_t n,
                                       std::int64_t** first, std::int32_t** columns, double** values) {
  return guarded([&] {
    const std::vector<Vec3> wanted = points_of(mesh, points, n);
    const Mesh& of = view(mesh).mesh();
    give_rows(sparse_rows(of, interpolation_at(of, wanted)), first, columns, values);
  });
}
hextwist_status hextwist_prolongation(const hextwist_mesh* before, const hextwist_mesh* after,
                                      const std::int32_t* origin, std::int64_t** first, std::int32_t** columns,
                                      double** values) {
  return guarded([&] {
    if (!before || !after) throw Error("there is no mesh: the pointer is null");
    const Mesh &from = view(before).mesh(), &to = view(after).mesh();
    const std::span<const Index> origins(origin, origin ? to.hexes.size() : 0);
    give_rows(sparse_rows(from, prolongation(from, to, origins)), first, columns, values);
  });
}
