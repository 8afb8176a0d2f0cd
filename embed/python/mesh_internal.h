// A mesh as Python sees it, and a mesh from numpy arrays.
#pragma once

#include <deque>

#include "hextwist/embed/arrays.h"
#include "hextwist/embed/mesh_view.h"
#include "hextwist/embed/python/convert_internal.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/entity.h"

namespace hextwist::python {

/// A block, node set or side set.
struct PyGroup {
  int id;
  py::str name;
  py::array members;
  py::object sides = py::none();  ///< of a side set
};

/// 0 .. 3 for "vertex" .. "volume".
inline int dimension_of(const std::string& kind) {
  for (int dim = 0; dim < 4; ++dim)
    if (kind == dimension_name(dim)) return dim;
  throw py::value_error("'" + kind + "' is not a kind of CAD entity: vertex, curve, surface, volume");
}

inline const Model& model_of(const MeshView& view) {
  if (!view.meshed().model) throw Error("there is neither CAD nor mesh");
  return *view.meshed().model;
}
inline Owner entity_of(const MeshView& view, const std::string& kind, int id) {
  const Owner owner{dimension_of(kind), id};
  const int n = model_of(view).count(owner.dim);
  if (id < 1 || id > n) throw Error(to_string(owner) + " does not exist; there are " + std::to_string(n));
  return owner;
}

/// Everything that arrays for hextwist_arrays have to stand on.
class PyArrays {
 public:
  hextwist_arrays arrays{};

  void mesh(const py::object& points, const py::object& hexes) {
    arrays.points = keep(doubles_, doubles(points, "points", 3), 3, arrays.n_nodes);
    arrays.hexes = keep(integers_, integers<std::int32_t>(hexes, "hexes", 8), 8, arrays.n_hexes);
  }
  void ids(const py::object& node_ids, const py::object& hex_ids) {
    arrays.node_ids = optional(ids_, node_ids, "node_ids", 0, arrays.n_nodes);
    arrays.hex_ids = optional(ids_, hex_ids, "hex_ids", 0, arrays.n_hexes);
  }
  void owners(const py::object& node_owners, const py::object& hex_volumes, const py::object& curve_edges,
              const py::object& edge_curves, const py::object& surface_quads, const py::object& quad_surfaces) {
    arrays.node_owners = optional(integers_, node_owners, "node_owners", 2, arrays.n_nodes);
    arrays.hex_volumes = optional(integers_, hex_volumes, "hex_volumes", 0, arrays.n_hexes);
    if (curve_edges.is_none() != edge_curves.is_none() || surface_quads.is_none() != quad_surfaces.is_none())
      throw py::value_error("curve_edges and edge_curves go together, and surface_quads and quad_surfaces");
    if (!curve_edges.is_none()) {
      arrays.curve_edges =
          keep(integers_, integers<std::int32_t>(curve_edges, "curve_edges", 2), 2, arrays.n_curve_edges);
      arrays.edge_curves = optional(integers_, edge_curves, "edge_curves", 0, arrays.n_curve_edges);
    }
    if (!surface_quads.is_none()) {
      arrays.surface_quads =
          keep(integers_, integers<std::int32_t>(surface_quads, "surface_quads", 4), 4, arrays.n_surface_quads);
      arrays.quad_surfaces = optional(integers_, quad_surfaces, "quad_surfaces", 0, arrays.n_surface_quads);
    }
  }
  void groups(const py::dict& blocks, const py::dict& node_sets, const py::dict& side_sets) {
    arrays.blocks = kept_groups(blocks, "blocks", 0, arrays.n_blocks);
    arrays.node_sets = kept_groups(node_sets, "node_sets", 0, arrays.n_node_sets);
    arrays.side_sets = kept_groups(side_sets, "side_sets", 4, arrays.n_side_sets);
  }
  void fields(const py::dict& on_nodes, const py::dict& on_hexes) {
    for (const bool hexes : {false, true})
      for (const auto& [key, value] : hexes ? on_hexes : on_nodes) {
        if (!py::isinstance<py::str>(key)) throw py::type_error("names of fields are texts");
        names_.push_back(py::cast<std::string>(key));
        const py::array array = numbers(py::reinterpret_borrow<py::object>(value), names_.back().c_str());
        const std::int64_t n = hexes ? arrays.n_hexes : arrays.n_nodes;
        if (array.ndim() < 1 || array.ndim() > 2 || array.shape(0) != n)
          throw py::value_error("field '" + names_.back() + "': an array of shape (" + std::to_string(n) + ",) or (" +
                                std::to_string(n) + ", components) is wanted");
        const py::ssize_t width = array.ndim() == 1 ? 0 : array.shape(1);
        if (array.ndim() == 2 && width == 0) throw py::value_error("field '" + names_.back() + "' has no component");
        std::int64_t rows = 0;
        const double* values =
            keep(doubles_, doubles(array, names_.back().c_str(), width), std::max<py::ssize_t>(1, width), rows);
        fields_.push_back({names_.back().c_str(), hexes, static_cast<std::int32_t>(std::max<py::ssize_t>(1, width)),
                           values, std::string_view("biu").find(array.dtype().kind()) != std::string_view::npos});
      }
    arrays.fields = fields_.data();
    arrays.n_fields = static_cast<std::int64_t>(fields_.size());
  }

 private:
  template <class T>
  using Kept = std::deque<std::vector<T>>;
  Kept<double> doubles_;
  Kept<std::int32_t> integers_;
  Kept<std::int64_t> ids_;
  std::deque<std::string> names_;
  std::vector<hextwist_field> fields_;
  std::deque<std::vector<hextwist_group>> groups_;

  template <class T>
  static const T* keep(Kept<T>& where, std::vector<T> values, py::ssize_t width, std::int64_t& n) {
    where.push_back(std::move(values));
    n = static_cast<std::int64_t>(where.back().size()) / width;
    static const T none{};
    return where.back().empty() ? &none : where.back().data();
  }
  template <class T>
  static const T* optional(Kept<T>& where, const py::object& given, const char* name, py::ssize_t width,
                           std::int64_t wanted) {
    if (given.is_none()) return nullptr;
    std::int64_t n = 0;
    const T* values = keep(where, integers<T>(given, name, width), std::max<py::ssize_t>(1, width), n);
    if (n != wanted)
      throw py::value_error(std::string(name) + ": " + std::to_string(wanted) + " rows are wanted, not " +
                            std::to_string(n));
    return values;
  }
  /// Nodes of the sides (hex, face) of the hexes that were given.
  std::vector<std::int32_t> quads_of_sides(const std::vector<std::int32_t>& sides, const char* name) const {
    std::vector<std::int32_t> quads;
    for (std::size_t i = 0; i + 1 < sides.size(); i += 2) {
      const std::int32_t hex = sides[i], face = sides[i + 1];
      if (hex < 0 || hex >= arrays.n_hexes || face < 0 || face >= n_hex_faces)
        throw py::value_error(std::string(name) + ": there is no face " + std::to_string(face) + " of hex " +
                              std::to_string(hex));
      Hex corners;
      for (int c = 0; c < n_hex_corners; ++c) corners[c] = arrays.hexes[8 * std::int64_t{hex} + file_corner[c]];
      for (const Index node : face_node_cycle(corners, face)) quads.push_back(node);
    }
    return quads;
  }
  static int id_of(const py::handle& key, const char* name) {
    // As numpy's integers can be; numbers with a fraction cannot.
    const auto index = py::reinterpret_steal<py::object>(PyNumber_Index(key.ptr()));
    if (!index) PyErr_Clear();
    const long long id = index ? PyLong_AsLongLong(index.ptr()) : -1;
    if (PyErr_Occurred()) PyErr_Clear();
    if (id < 1 || id > std::numeric_limits<int>::max())
      throw py::value_error(std::string(name) + ": ids are integers from 1 to " +
                            std::to_string(std::numeric_limits<int>::max()) + ", not " + std::string(py::repr(key)));
    return static_cast<int>(id);
  }
  /// {id: members}, {id: (name, members)} or {id: Group}.
  const hextwist_group* kept_groups(const py::dict& given, const char* name, py::ssize_t width, std::int64_t& n) {
    std::vector<hextwist_group>& groups = groups_.emplace_back();
    for (const auto& [key, value] : given) {
      py::object members = py::reinterpret_borrow<py::object>(value);
      names_.emplace_back();
      if (py::isinstance<PyGroup>(value)) {
        const auto& group = value.cast<const PyGroup&>();
        names_.back() = std::string(group.name);
        members = group.members;
      } else if (py::isinstance<py::tuple>(value) && py::len(value) == 2 &&
                 py::isinstance<py::str>(value[py::int_(0)])) {
        names_.back() = value[py::int_(0)].cast<std::string>();
        members = value[py::int_(1)];
      }
      if (names_.back().find('\0') != std::string::npos)
        throw py::value_error(std::string(name) + ": the name of " + std::string(py::repr(key)) + " has a zero byte");
      if (const py::array array = numbers(members, name); array.size() > 0 && array.dtype().kind() == 'b')
        throw py::type_error(std::string(name) + ": members are indices; those of a mask are numpy.flatnonzero(mask)");
      hextwist_group group{id_of(key, name), names_.back().c_str(), 0, nullptr};
      if (const py::array array = width == 4 ? numbers(members, name) : py::array();
          array && array.ndim() == 2 && array.shape(1) == 2 && array.size() > 0) {
        group.members = keep(integers_, quads_of_sides(integers<std::int32_t>(members, name, 2), name), 4, group.n);
        groups.push_back(group);
        continue;
      }
      group.members =
          keep(integers_, integers<std::int32_t>(members, name, width), std::max<py::ssize_t>(1, width), group.n);
      groups.push_back(group);
    }
    n = static_cast<std::int64_t>(groups.size());
    return groups.data();
  }
};

}  // namespace hextwist::python
