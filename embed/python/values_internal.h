// Values anywhere and from mesh to mesh, groups and surfaces looked up, as Python sees them.
#pragma once

#include <algorithm>
#include <map>
#include <optional>

#include "hextwist/embed/python/mesh_internal.h"
#include "hextwist/embed/python/session_internal.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/interpolation.h"

namespace hextwist::python {

inline std::vector<Vec3> points_of(const py::object& given) {
  const std::vector<double> flat = doubles(given, "points", 3);
  std::vector<Vec3> points(flat.size() / 3);
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = Vec3(flat.data() + 3 * i);
  return points;
}

/// Nodes of faces that are given by their nodes, (n, 4), or as (hex, face), (n, 2).
inline std::vector<Quad> quads_of(const Mesh& mesh, const py::object& faces) {
  const py::array array = numbers(faces, "faces");
  if (array.size() == 0) return {};
  const bool sides = array.ndim() == 2 && array.shape(1) == 2;
  const std::vector<std::int32_t> flat = integers<std::int32_t>(faces, "faces", sides ? 2 : 4);
  std::vector<Quad> quads(flat.size() / (sides ? 2 : 4));
  for (std::size_t i = 0; i < quads.size(); ++i) {
    if (!sides) {
      std::copy_n(flat.begin() + static_cast<std::ptrdiff_t>(4 * i), 4, quads[i].begin());
      continue;
    }
    const std::int32_t hex = flat[2 * i], face = flat[2 * i + 1];
    if (hex < 0 || hex >= mesh.n_hexes() || face < 0 || face >= n_hex_faces)
      throw py::value_error("faces[" + std::to_string(i) + "]: there is no face " + std::to_string(face) + " of hex " +
                            std::to_string(hex));
    quads[i] = face_nodes(mesh.hexes[hex], face);
  }
  return quads;
}

inline PyGroup group_named(const py::object& self, const std::string& kind, const std::string& name) {
  const std::map<std::string, const char*> lists = {
      {"block", "blocks"}, {"nodeset", "node_sets"}, {"sideset", "side_sets"}};
  const auto list = lists.find(kind);
  if (list == lists.end()) throw py::value_error("'" + kind + "' is not a kind of group: block, nodeset, sideset");
  std::optional<PyGroup> found;
  for (const auto& item : self.attr(list->second).cast<py::dict>()) {
    const auto& group = item.second.cast<const PyGroup&>();
    if (std::string(group.name) != name) continue;
    if (found)
      throw Error(kind + "s " + std::to_string(found->id) + " and " + std::to_string(group.id) + " have the name '" +
                  name + "'");
    found = group;
  }
  if (!found) throw Error("there is no " + kind + " of the name '" + name + "'");
  return *found;
}

/// Runs f without Python's lock.
template <class F>
auto unlocked(F f) {
  const py::gil_scoped_release release;
  return f();
}

inline py::tuple tuple_of(SparseRows rows) {
  return py::make_tuple(array_of(std::move(rows.values)), array_of(std::move(rows.columns)),
                        array_of(std::move(rows.first)));
}

inline Field::On on_of(const std::string& on) {
  if (on != "nodes" && on != "hexes") throw py::value_error("on is 'nodes' or 'hexes'");
  return on == "hexes" ? Field::On::hex : Field::On::node;
}

inline py::array field_at(const MeshView& view, const std::string& name, const py::object& points,
                          const std::string& on) {
  const std::vector<Vec3> wanted = points_of(points);
  const Field::On place = on_of(on);
  for (const Field& field : view.mesh().fields) {
    if (field.name != name || field.on != place) continue;
    const auto values = unlocked([&] { return values_at(view.mesh(), field, interpolation_at(view.mesh(), wanted)); });
    const py::array flat = array_of(values);
    if (field.components == 1) return flat;
    return flat.attr("reshape")(wanted.size(), field.components);
  }
  throw Error("there is no field '" + name + "' on " + on);
}

inline void set_field(PySession& session, const std::string& name, const py::object& given, const std::string& on) {
  const py::array array = numbers(given, "values");
  if (array.ndim() < 1 || array.ndim() > 2) throw py::value_error("values: (n,) or (n, components) is wanted");
  const py::ssize_t width = array.ndim() == 1 ? 0 : array.shape(1);
  if (array.ndim() == 2 && width == 0) throw py::value_error("values: there is no component");
  const bool whole = std::string_view("biu").find(array.dtype().kind()) != std::string_view::npos;
  Field field{name, on_of(on), static_cast<int>(std::max<py::ssize_t>(1, width)), doubles(array, "values", width),
              whole};
  session.run([&](Session& s) {
    s.set_field(std::move(field));
    return true;
  });
}

template <class Class>
void bind_values(Class& mesh) {
  using namespace py::literals;
  mesh.def(
          "group", &group_named, "kind"_a, "name"_a,
          "Group: the 'block', 'nodeset' or 'sideset' of that name. Raises Error where there is none or more than one, "
          "ValueError for another kind.")
      .def(
          "surfaces_of",
          [](const MeshView& v, const py::object& faces) { return array_of(v.surfaces_of(quads_of(v.mesh(), faces))); },
          "faces"_a,
          "(n,) int32: ids of the surfaces that faces lie on, 0: on none. faces: (n, 4) nodes, in any order, or (n, 2) "
          "(hex, face) as in surface_sides. Raises ValueError for another shape and for a face that does not exist.")
      .def(
          "locate",
          [](const MeshView& v, const py::object& points) {
            const std::vector<Vec3> wanted = points_of(points);
            Interpolation at = unlocked([&] { return interpolation_at(v.mesh(), wanted); });
            return py::make_tuple(array_of(std::move(at.hexes)), array_of(std::move(at.distances)));
          },
          "points"_a,
          "Where (n, 3) points are: (n,) int32 the hex that holds each, of several the first, outside of the mesh the "
          "nearest; (n,) float64 how far the point is from it, 0 inside. Ask for many at once. Raises ValueError for "
          "another shape, Error for an empty mesh or a coordinate that is not finite.")
      .def(
          "field_at", &field_at, "name"_a, "points"_a, py::kw_only(), "on"_a = "nodes",
          "(n,) or (n, components) float64: values of a field on 'nodes' or 'hexes' at (n, 3) points: trilinear in the "
          "hex, or that of the hex; of whole numbers that of the nearest node. Outside of the mesh the nearest place "
          "counts: locate() says how far it is. Raises Error where there is no such field, and as locate() does.")
      .def(
          "interpolation",
          [](const MeshView& v, const py::object& points) {
            const std::vector<Vec3> wanted = points_of(points);
            return tuple_of(unlocked([&] { return sparse_rows(v.mesh(), interpolation_at(v.mesh(), wanted)); }));
          },
          "points"_a,
          "(data, columns, first), float64, int32, int64: the matrix by rows that takes values at the nodes to (n, 3) "
          "points as field_at() does: scipy.sparse.csr_matrix((data, columns, first), shape=(n, n_nodes)). Raises as "
          "locate() does.")
      .def(
          "prolongation",
          [](const MeshView& v, const MeshView& after, const py::object& origin) {
            const std::vector<Index> from =
                origin.is_none() ? std::vector<Index>() : integers<Index>(origin, "origin", 0);
            if (!origin.is_none() && from.size() != after.mesh().hexes.size())
              throw py::value_error("origin: one hex per hex of the mesh after is wanted");
            return tuple_of(
                unlocked([&] { return sparse_rows(v.mesh(), prolongation(v.mesh(), after.mesh(), from)); }));
          },
          "after"_a, "origin"_a = py::none(),
          "(data, columns, first) as of interpolation(), to the nodes of a mesh that this one was refined or coarsened "
          "to: new values = matrix @ old values, exact for what is linear, on a curved boundary too; a node that was "
          "there counts itself alone. origin: per hex of `after` one of this mesh that it comes from, as adapt() "
          "returns "
          "it (of adapt_levels() hexes[first[:-1]]), which keeps apart what is apart; None: by place alone. Raises "
          "ValueError for another number of them, Error for hexes that do not exist.");
}

}  // namespace hextwist::python
