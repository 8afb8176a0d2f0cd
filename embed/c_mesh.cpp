// The arrays of a mesh for C. Vectors of small structs are flat arrays already: the asserts below say so.
#include <algorithm>
#include <memory>
#include <type_traits>

#include "hextwist/embed/c_internal.h"
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
