// The Python module. One source, since what is expensive to compile is pybind11 itself.
#include <pybind11/stl/filesystem.h>

#include "hextwist/embed/python/gmsh_internal.h"
#include "hextwist/embed/python/mesh_internal.h"
#include "hextwist/embed/python/records_internal.h"
#include "hextwist/embed/python/session_internal.h"
#include "hextwist/embed/python/values_internal.h"
#include "hextwist/mesh/arrays.h"
#include "hextwist/mesh/quality/quality.h"

namespace hextwist::python {
namespace {

using namespace py::literals;
using View = std::shared_ptr<MeshView>;

/// self as what it is in Python, to be kept by arrays.
const MeshView& of(const py::object& self) {
  return *self.cast<View>();
}

template <class Groups, class F>
py::dict groups(const Groups& list, F members) {
  py::dict result;
  for (std::size_t i = 0; i < list.size(); ++i)
    result[py::int_(list[i].id)] = PyGroup{list[i].id, text(list[i].name), members(i), py::none()};
  return result;
}

/// Calls use(tag, function that shows it) for every array of a mesh.
template <class Use>
void for_each_view(const py::object& self, const Use& use) {
  const auto array = [&]<class T>(const ArrayTag& tag, const std::vector<T>& values) {
    using S = std::conditional_t<std::is_same_v<T, std::int64_t>, T,
                                 std::conditional_t<alignof(T) == alignof(double), double, std::int32_t>>;
    use(tag, [&] {
      const std::size_t width = sizeof(T) / sizeof(S) * tag.width;
      return view(reinterpret_cast<const S*>(values.data()), values.size() / tag.width, width == 1 ? 0 : width, self);
    });
  };
  for_each_array(lists_apart(array), of(self).meshed());
}

py::dict arrays(const py::object& self) {
  py::dict result;
  for_each_view(self, [&](const ArrayTag& tag, const auto& shown) { result[text(tag.full_name())] = shown(); });
  return result;
}

py::dict fields(const py::object& self, std::string_view kind) {
  py::dict result;
  for_each_view(self, [&](const ArrayTag& tag, const auto& shown) {
    if (tag.name == kind) result[text(std::string(tag.field))] = shown();
  });
  return result;
}

py::dict entity(const MeshView& mesh, const std::string& kind, int id) {
  const Owner owner = entity_of(mesh, kind, id);
  const Model& model = model_of(mesh);
  const Box box = model.box(owner);
  py::dict result("kind"_a = kind, "id"_a = id, "name"_a = text(model.name(owner)), "type"_a = model.type(owner),
                  "measure"_a = model.measure(owner));
  result["box"] = py::make_tuple(py::make_tuple(box.min.x(), box.min.y(), box.min.z()),
                                 py::make_tuple(box.max.x(), box.max.y(), box.max.z()));
  py::dict adjacent;
  for (int dim = 0; dim < 4; ++dim)
    if (dim != owner.dim) adjacent[dimension_name(dim)] = model.adjacent(owner, dim);
  result["adjacent"] = adjacent;
  return result;
}

py::tuple closest(const MeshView& mesh, const std::string& kind, int id, const py::object& given) {
  const Owner owner = entity_of(mesh, kind, id);
  if (owner.dim == 3) throw py::value_error("closest points are those of vertices, curves and surfaces");
  const std::vector<double> flat = doubles(given, "points", 3);
  std::vector<Vec3> points(flat.size() / 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = Vec3(flat.data() + 3 * i);
    if (!points[i].allFinite()) throw py::value_error("points[" + std::to_string(i) + "]: a coordinate is not finite");
  }
  std::vector<Projection> found(points.size());
  {
    const py::gil_scoped_release release;
    model_of(mesh).project(owner, points, {}, found);
  }
  const auto n = static_cast<py::ssize_t>(points.size());
  py::array_t<double> at({n, py::ssize_t{3}}), parameters({n, py::ssize_t{2}}), distances(n);
  for (py::ssize_t i = 0; i < n; ++i) {
    const Projection& one = found[static_cast<std::size_t>(i)];
    for (int k = 0; k < 3; ++k) at.mutable_at(i, k) = one.point[k];
    parameters.mutable_at(i, 0) = one.parameters.u;
    parameters.mutable_at(i, 1) = one.parameters.v;
    distances.mutable_at(i) = one.distance;
  }
  return py::make_tuple(at, parameters, distances);
}

/// Objects of the class come out of others only: without this, Class.__new__(Class) would be one of random memory.
py::custom_type_setup without_new() {
  return py::custom_type_setup([](PyHeapTypeObject* heap) {
    heap->ht_type.tp_new = [](PyTypeObject* type, PyObject*, PyObject*) -> PyObject* {
      PyErr_Format(PyExc_TypeError, "%s is made by others, not by itself", type->tp_name);
      return nullptr;
    };
  });
}

void bind_mesh(py::module_& m) {
  py::class_<PyGroup>(m, "Group", without_new(),
                      "A block, node set or side set of a Mesh, out of Mesh.blocks, Mesh.node_sets or Mesh.side_sets. "
                      "It keeps the mesh alive.")
      .def_readonly("id", &PyGroup::id, "int: the number by which commands know it; each once per kind of group.")
      .def_readonly("name", &PyGroup::name, "str: '' where it has none. Names need not be unique.")
      .def_readonly(
          "members", &PyGroup::members,
          "Positions from 0, read-only int32: hexes of a block, (n,), ascending; nodes of a node set, (n,), ascending; "
          "nodes of the sides of a side set, (n, 4), counter-clockwise seen from outside of the hex.")
      .def_readonly("sides", &PyGroup::sides,
                    "Of a side set, read-only (n, 2) int32: the hex of each of its members, and which face of it (2 * "
                    "axis + side, in bit_hexes). None of other groups.")
      .def("__repr__", [](const PyGroup& group) {
        return "<hextwist.Group " + std::to_string(group.id) + ", " + std::to_string(py::len(group.members)) +
               " members>";
      });

  py::class_<MeshView, View> mesh(
      m, "Mesh", without_new(),
      "The mesh of a session at one moment, as read-only numpy arrays. It stays as it is whatever the session does; "
      "arrays keep it alive. Positions in arrays count from 0, ids are those of commands. Lengths are in the units of "
      "the CAD (STEP and IGES: millimetres).");
  // Arrays as the mesh has them, by their names in arrays.h.
  for (const auto& [name, doc] :
       {std::pair{"points", "(n_nodes, 3) float64, model units."},
        std::pair{
            "bit_hexes",
            "(n_hexes, 8) int32: nodes of each hex as in hexes, but corner c at (c & 1, c >> 1 & 1, c >> 2 & 1) of the "
            "unit cube."},
        std::pair{"node_owners",
                  "(n_nodes, 2) int32: dimension (0 vertex .. 3 volume; -1 nobody: the node is in no hex) and id of "
                  "the entity of the CAD, or of the skin of the mesh, that each node lies on."},
        std::pair{"node_parameters",
                  "(n_nodes, 2) float64: where each node lies on its owner: (u, v) on a surface, (t, nan) on a curve, "
                  "else nan."},
        std::pair{"hex_volumes", "(n_hexes,) int32: id of the volume that each hex is in."},
        std::pair{"curve_edges", "(n, 2) int32: nodes of the mesh edges that lie on curves, the lower first."},
        std::pair{"edge_curves", "(n,) int32: id of the curve of each row of curve_edges."},
        std::pair{"surface_sides",
                  "(n, 2) int32: the hex of each row of surface_quads, and which face of it (2 * axis + side, in "
                  "bit_hexes)."},
        std::pair{"quad_surfaces", "(n,) int32: id of the surface of each row of surface_quads."}}) {
    mesh.def_property_readonly(
        name,
        [name = name](const py::object& self) {
          py::object result;
          for_each_view(self, [&](const ArrayTag& tag, const auto& shown) {
            if (tag.name == name) result = shown();
          });
          return result;
        },
        doc);
  }
  const auto array = [&](const char* name, auto get, const char* doc) {
    mesh.def_property_readonly(
        name, [get](const py::object& self) { return get(of(self), self); }, doc);
  };
  array(
      "hexes", [](const MeshView& v, const py::object& self) { return rows<Index>(v.file_hexes(), self); },
      "(n_hexes, 8) int32: nodes of each hex, in the order of VTK, Exodus, Abaqus and Gmsh. Made when first asked "
      "for.");
  array(
      "node_ids", [](const MeshView& v, const py::object& self) { return rows<std::int64_t>(v.node_ids(), self); },
      "(n_nodes,) int64: ids as commands know them, ascending.");
  array(
      "hex_ids", [](const MeshView& v, const py::object& self) { return rows<std::int64_t>(v.hex_ids(), self); },
      "(n_hexes,) int64: ids as commands know them, ascending.");
  array(
      "surface_quads", [](const MeshView& v, const py::object& self) { return rows<Index>(v.surface_quads(), self); },
      "(n, 4) int32: nodes of the sides that lie on surfaces, counter-clockwise seen from outside of their hex; a side "
      "between two volumes once. Made when first asked for.");
  mesh.def_property_readonly(
          "n_nodes", [](const MeshView& v) { return v.mesh().n_nodes(); },
          "int: how many nodes there are, those of no hex too.")
      .def_property_readonly(
          "n_hexes", [](const MeshView& v) { return v.mesh().n_hexes(); },
          "int: how many hexes there are; 0: the session has no mesh.")
      .def_property_readonly(
          "blocks",
          [](const py::object& self) {
            const auto& list = of(self).mesh().blocks;
            return groups(list, [&](std::size_t i) { return rows<Index>(list[i].hexes, self); });
          },
          "{id: Group} of hexes, ascending by id. A hex may be in several blocks or in none.")
      .def_property_readonly(
          "node_sets",
          [](const py::object& self) {
            const auto& list = of(self).mesh().node_sets;
            return groups(list, [&](std::size_t i) { return rows<Index>(list[i].nodes, self); });
          },
          "{id: Group} of nodes, ascending by id. A node may be in several sets or in none.")
      .def_property_readonly(
          "side_sets",
          [](const py::object& self) {
            const auto& list = of(self).mesh().side_sets;
            py::dict sets = groups(list, [&](std::size_t i) { return rows<Index>(of(self).set_quads(i), self); });
            for (const SideSet& set : list)
              py::object(sets[py::int_(set.id)]).cast<PyGroup&>().sides = rows<std::int32_t>(set.sides, self);
            return sets;
          },
          "{id: Group} of sides of hexes, as quads and as (hex, face), ascending by id.")
      .def_property_readonly("arrays", &arrays,
                             "{name: array} of all arrays as the mesh has them: those above that are not made when "
                             "first asked for (ids are empty where they are 1, 2, ...), members as 'blocks/3', fields "
                             "as 'node_fields/temperature'. np.savez(file, **mesh.arrays) keeps them.")
      .def_property_readonly(
          "node_fields", [](const py::object& self) { return fields(self, "node_fields"); },
          "{name: (n_nodes,) or (n_nodes, components) float64}: values at the nodes.")
      .def_property_readonly(
          "hex_fields", [](const py::object& self) { return fields(self, "hex_fields"); },
          "{name: (n_hexes,) or (n_hexes, components) float64}: values of the hexes.")
      .def(
          "quality",
          [](const MeshView& v, const std::string& name) {
            const Metric which = metric(name);
            std::vector<double> values;
            {
              const py::gil_scoped_release release;
              values = quality(which, v.mesh());
            }
            return array_of(std::move(values));
          },
          "metric"_a = "shape",
          "(n_hexes,) float64: a quality metric by its usual name: 'shape', 'scaled jacobian', 'volume' (model units, "
          "cubed), ...; docs/commands.md has all. Raises Error, listing them, for another name.")
      .def(
          "n_entities",
          [](const MeshView& v, const std::string& kind) {
            const int dim = dimension_of(kind);
            return v.meshed().model ? v.meshed().model->count(dim) : 0;
          },
          "kind"_a,
          "How many entities of a kind ('vertex', 'curve', 'surface', 'volume') the CAD, or the skin of the mesh, has; "
          "0 where there is neither. Their ids are 1 .. n. Raises ValueError for another kind.")
      .def(
          "entity", &entity, "kind"_a, "id"_a,
          "An entity of the CAD, or of the skin of the mesh, as a dictionary: kind, id, name ('': none), type ('line', "
          "'circle', 'plane', 'cylinder', ...), measure (length, area or volume in model units, 0 of a vertex), box "
          "(lowest and highest corner), adjacent ({kind: ids of what it bounds and what bounds it}). Raises ValueError "
          "for a kind that is not 'vertex', 'curve', 'surface' or 'volume', Error where it does not exist.")
      .def("closest", &closest, "kind"_a, "id"_a, "points"_a,
           "Closest points on a vertex, curve or surface to (n, 3) points, in model units: (n, 3) points, (n, 2) "
           "parameters (as in node_parameters), (n,) distances, all float64. Raises ValueError for a volume, another "
           "shape or a coordinate that is not finite, Error where the entity does not exist.")
      .def("__repr__",
           [](const MeshView& v) { return "<hextwist.Mesh of " + std::to_string(v.mesh().n_hexes()) + " hexes>"; });
  bind_values(mesh);
}

py::array_t<Index> adapt(PySession& session, const py::object& flags, const py::object& sizes, bool gradation,
                         double bias, const std::string& concave, bool smooth, const std::string& by,
                         const std::vector<std::string>& extensive) {
  if (flags.is_none() == sizes.is_none()) throw py::value_error("give flags or sizes");
  if (concave != "template" && concave != "fill") throw py::value_error("concave is 'template' or 'fill'");
  const std::array<Method, 3> methods = {Method::automatic, Method::single, Method::parallel};
  const auto method = std::ranges::find_if(methods, [&](Method each) { return by == name(each); });
  if (method == methods.end()) throw py::value_error("method is 'auto', 'single' or 'parallel'");
  if (flags.is_none() && *method != Method::automatic)
    throw py::value_error("a method goes with flags, not with sizes");
  const AdaptOptions options{.keep_gradation = gradation,
                             .bias = bias,
                             .method = *method,
                             .concave = concave == "fill" ? Concave::fill : Concave::templates,
                             .smooth = smooth,
                             .extensive = extensive};
  if (flags.is_none()) {
    const std::vector<double> values = doubles(sizes, "sizes", 0);
    return array_of(session.run([&](Session& s) { return s.adapt(values, options).origin; }));
  }
  const std::vector<std::int64_t> given = integers<std::int64_t>(flags, "flags", 0);
  std::vector<std::uint8_t> values;
  for (const std::int64_t flag : given) values.push_back(flag != 0);
  return array_of(session.run([&](Session& s) { return s.adapt(values, options).origin; }));
}

py::tuple adapt_levels(PySession& session, const py::object& changes, bool smooth,
                       const std::vector<std::string>& extensive) {
  std::vector<std::int8_t> by;
  for (const std::int64_t change : integers<std::int64_t>(changes, "changes", 0))
    by.push_back(static_cast<std::int8_t>(std::clamp<std::int64_t>(change, -100, 100)));
  const AdaptOptions options{.smooth = smooth, .extensive = extensive};
  const LevelOrigin origin = session.run([&](Session& s) { return s.adapt(by, options).came_from; });
  std::vector<std::int8_t> kinds;
  for (const HexOrigin kind : origin.kind) kinds.push_back(static_cast<std::int8_t>(kind));
  CompressedRows rows = rows_of(origin);
  return py::make_tuple(array_of(std::move(kinds)), array_of(std::move(rows.first)), array_of(std::move(rows.items)));
}

void take(PySession& session, const py::object& points, const py::object& hexes, const py::object& node_ids,
          const py::object& hex_ids, const py::dict& blocks, const py::dict& node_sets, const py::dict& side_sets,
          const py::dict& node_fields, const py::dict& hex_fields, const py::object& node_owners,
          const py::object& hex_volumes, const py::object& curve_edges, const py::object& edge_curves,
          const py::object& surface_quads, const py::object& quad_surfaces) {
  PyArrays in;
  in.mesh(points, hexes);
  in.ids(node_ids, hex_ids);
  in.groups(blocks, node_sets, side_sets);
  in.fields(node_fields, hex_fields);
  in.owners(node_owners, hex_volumes, curve_edges, edge_curves, surface_quads, quad_surfaces);
  session.run([&](Session& s) {
    MeshFile file = mesh_from_arrays(in.arrays);
    s.take_mesh(std::move(file.mesh), file.tags.empty() ? nullptr : &file.tags);
    return true;
  });
}

py::array_t<std::int64_t> ids(PySession& session, const std::string& kind, const std::string& range) {
  return array_of(session.run([&](Session& s) { return s.ids(kind, range); }));
}

/// The session of an object, null while it is being made.
PySession* session_in(PyObject* object) {
  const auto place = reinterpret_cast<py::detail::instance*>(object)->get_value_and_holder();
  return place.holder_constructed() ? place.value_ptr<PySession>() : nullptr;
}
int visit_session(PyObject* object, visitproc visit, void* arg) {
  Py_VISIT(Py_TYPE(object));
  if (PySession* session = session_in(object))
    for (const py::object* callback : session->callbacks()) Py_VISIT(callback->ptr());
  return 0;
}
int clear_session(PyObject* object) {
  if (PySession* session = session_in(object))
    for (py::object* callback : session->callbacks()) *callback = py::none();
  return 0;
}

void bind_session(py::module_& m) {
  const py::custom_type_setup collected([](PyHeapTypeObject* heap) {
    heap->ht_type.tp_flags |= Py_TPFLAGS_HAVE_GC;
    heap->ht_type.tp_traverse = visit_session;
    heap->ht_type.tp_clear = clear_session;
  });
  py::class_<PySession>(
      m, "Session", collected,
      "A mesh on its model, changed by commands. Callbacks (any may be None): output(line) what commands print, "
      "notice(line) remarks, progress(stage, fraction) now and then, fraction 0 .. 1; returning False cancels, and the "
      "call raises Cancelled. Ctrl-C cancels too. What a callback raises comes out of the call. One call at a time: "
      "another one meanwhile, from a callback or a thread, raises Error; other Python threads run. A call that raises "
      "leaves the session as it was, but for what commands before the one that failed have done.")
      .def(py::init<py::object, py::object, py::object>(), "output"_a = py::none(), "notice"_a = py::none(),
           "progress"_a = py::none(),
           "An empty session, without CAD and mesh. Lines come without their line end; None: nobody is told.")
      .def(
          "cmd",
          [](PySession& session, const std::string& commands) {
            return session.run([&](Session& s) { return s.run(commands) == 0; });
          },
          "commands"_a,
          "Runs commands (docs/commands.md), one per line or separated by ';', up to the first that fails. True, or "
          "raises Error with the place of the wrong word, Cancelled where progress stopped it, KeyboardInterrupt at "
          "Ctrl-C; a command that fails leaves the session as it was, those before it stay done.")
      .def(
          "import_cad",
          [](PySession& session, const std::filesystem::path& file) {
            return session.run([&](Session& s) { return s.import_cad(file), true; });
          },
          "file"_a,
          "Reads CAD (.step .stp .brep .iges .igs, a name or a Path), as 'import geometry' does. A mesh that is there "
          "is put on it. True, or raises Error, the session as it was.")
      .def(
          "import_mesh",
          [](PySession& session, const std::filesystem::path& file) {
            return session.run([&](Session& s) { return s.import_mesh(file), true; });
          },
          "file"_a,
          "Reads a mesh (a name or a Path; format by its extension), as 'import mesh' does, in place "
          "of the one that is there: on the CAD of the session, or on its own skin where there is none. True, or "
          "raises Error, the session as it was: not hexes only, inverted beyond repair, not on the CAD, ...")
      .def(
          "export_mesh",
          [](PySession& session, const std::filesystem::path& file) {
            return session.run([&](Session& s) { return s.export_mesh(file), true; });
          },
          "file"_a,
          "Writes the mesh in the format of the extension (those that import_mesh() reads, but for .vtk), over a file "
          "that is there; the file is whole or as it was. True, or raises Error. Notices say what the format cannot "
          "keep.")
      .def(
          "playback",
          [](PySession& session, const std::filesystem::path& file) {
            return session.run([&](Session& s) { return s.playback(file) == 0; });
          },
          "file"_a,
          "Runs the commands of a journal up to the first that fails. True, or raises as cmd() does; what was done "
          "before that stays done.")
      .def("take", &take, "points"_a, "hexes"_a, py::kw_only(), "node_ids"_a = py::none(), "hex_ids"_a = py::none(),
           "blocks"_a = py::dict(), "node_sets"_a = py::dict(), "side_sets"_a = py::dict(),
           "node_fields"_a = py::dict(), "hex_fields"_a = py::dict(), "node_owners"_a = py::none(),
           "hex_volumes"_a = py::none(), "curve_edges"_a = py::none(), "edge_curves"_a = py::none(),
           "surface_quads"_a = py::none(), "quad_surfaces"_a = py::none(),
           "Makes copies of these arrays (shapes as in Mesh) the mesh of the session, on its CAD if it has some, else "
           "on its own skin. hexes: corners in the order of VTK. node_ids, hex_ids: positive, ascending; None: 1, 2, "
           "... Groups: {id: members}, {id: (name, members)} or {id: Group}, ids from 1. Fields: {name: (n,) or (n, "
           "components)}; those of integers stay integers: never interpolated. What the arrays say of owners may be "
           "partial (-1, 0: unknown) and is checked against the CAD; curve_edges go with edge_curves, surface_quads "
           "with quad_surfaces. Raises ValueError or TypeError, naming the array, for a wrong shape or type, Error for "
           "arrays that do not make a sound mesh on the CAD; the session is then as it was.")
      .def(
          "adapt", &adapt, "flags"_a = py::none(), py::kw_only(), "sizes"_a = py::none(), "gradation"_a = true,
          "bias"_a = 1.0, "concave"_a = "template", "smooth"_a = false, "method"_a = "auto",
          "extensive"_a = std::vector<std::string>(),
          "Cuts the hexes with a flag, (n_hexes,) bools or integers, into 27 each, or all until they have their sizes, "
          "(n_hexes,) positive, in model units, inf: no wish. gradation: by levels, so that shapes do not get worse "
          "from call to call; sizes may then become coarser too. bias: growth of sizes from element to element, 1: not "
          "limited. concave: 'template', or 'fill' as the paper does. smooth: the new hexes and two layers around "
          "them. method, of flags: 'single' (as 'auto') cuts into 27, 'parallel' into 8 where the sheets of the mesh "
          "allow it. extensive: fields of hexes whose sum stays. Returns (n_hexes now,) int32: the old hex that each "
          "new one lies in, or the first "
          "of those that its cell was before; adapt_levels() names all. Raises "
          "ValueError unless there are either flags or sizes and for another word for concave or method, TypeError for "
          "flags "
          "that are not integers, Error for another number than one per hex or a size that is not positive, Cancelled; "
          "the session is then as it was.")
      .def("adapt_levels", &adapt_levels, "changes"_a, py::kw_only(), "smooth"_a = false,
           "extensive"_a = std::vector<std::string>(),
           "By how many levels each hex becomes finer (> 0) or coarser (< 0), (n_hexes,) integers; 27 become one again "
           "where none of them stays. Returns (kind, first, hexes), int8, int32, int32: new hex h lies in, or was made "
           "of, the old hexes[first[h]:first[h + 1]]; kind 0: the same hex, 1: in a larger one, 2: made of several. "
           "Fields of hexes are copied down and averaged by volume upwards (those named in extensive: shared out and "
           "summed), those of nodes interpolated and injected. smooth: the new hexes and two layers around them. "
           "Raises TypeError for changes that are not integers, Error for another number than one per hex, Cancelled; "
           "the session is then as it was.")
      .def(
          "set_field", &set_field, "name"_a, "values"_a, py::kw_only(), "on"_a = "nodes",
          "Gives the mesh this field on 'nodes' or 'hexes', (n,) or (n, components), in place of the one of that name; "
          "integers stay integers. Meshes that were handed out stay as they are; undone by 'undo'. Raises ValueError "
          "or "
          "TypeError for another shape or type, Error for another number of values, and for the hex field 'level', "
          "which is the session's own.")
      .def("ids", &ids, "kind"_a, "range"_a = "all",
           "(n,) int64, ascending: ids of the entities of a kind (as in commands: 'node', 'hex', 'curve', 'block', "
           "...) that a range means: ids('hex', 'in volume 2'). Raises Error for a kind or range that is wrong or "
           "names what does not exist.")
      .def(
          "nodes_of",
          [](PySession& session, const std::string& kind, std::int64_t id) {
            return ids(session, "node", "in " + kind + " " + std::to_string(id));
          },
          "kind"_a, "id"_a,
          "(n,) int64, ascending: ids of the nodes of an entity of any kind that 'in' takes, those on its rim too. "
          "Raises Error where it does not exist.")
      .def_property_readonly(
          "mesh",
          [](PySession& session) {
            return session.look([](Session& s) { return std::make_shared<MeshView>(s.share()); });
          },
          "Mesh: the mesh as it is now, empty where there is none. Costs nothing; it stays as it is whatever the "
          "session does.")
      .def_property_readonly(
          "has_cad", [](PySession& session) { return session.look([](Session& s) { return s.has_cad(); }); },
          "bool: the mesh lies on CAD. False: the model is the skin of the mesh, or there is none.")
      .def_property_readonly(
          "finished", [](PySession& session) { return session.look([](Session& s) { return s.finished(); }); },
          "bool: was 'quit' run? Commands behind it are not.")
      .def_property_readonly(
          "records",
          [](PySession& session) {
            return session.look([](Session& s) {
              py::list result;
              for (const CommandRecord& record : s.records()) result.append(record_dict(record));
              return result;
            });
          },
          "list: what each command did, the failed ones too, in order, as dictionaries by the names of the program's "
          "JSON report (docs/commands.md). Made anew at each look.")
      .def_property_readonly(
          "record",
          [](PySession& session) {
            return session.look(
                [](Session& s) { return s.records().empty() ? py::none() : record_dict(s.records().back()); });
          },
          "dict: what the last command did, as in records; None before the first.");
}

void bind_gmsh(py::module_& m) {
  py::class_<GmshLink>(m, "GmshLink", without_new(), "What hextwist.gmsh has to know to bring a mesh back. Opaque.")
      .def_readonly("on_cad", &GmshLink::on_cad, "bool: False: the session is on the skin of the mesh.")
      .def_property_readonly(
          "tags",
          [](const GmshLink& link) {
            py::dict result;
            for (int dim = 0; dim < 4; ++dim) result[dimension_name(dim)] = link.tag_of[dim];
            return result;
          },
          "{kind: list}: the tag in Gmsh of the entity of each id, from id 1; 0: Gmsh has none.");
  m.def(
      "take_gmsh",
      [](PySession& session, const py::list& entities, const py::list& physical, const std::filesystem::path& brep) {
        const GmshModel model = gmsh_model_of(entities, physical);
        return session.run([&](Session& s) { return take_gmsh(s, model, brep); });
      },
      "session"_a, "entities"_a, "groups"_a, "brep"_a,
      "Inside of hextwist.gmsh.take(): entities as (dim, tag, node tags, coordinates, parameters, element types, "
      "[tags], [nodes]), groups as (dim, tag, name, [tags of entities]), brep: a file with the CAD, '' for none.");
  m.def(
      "put_gmsh",
      [](PySession& session, const GmshLink& link) {
        py::list result;
        for (GmshEntity& entity : session.run([&](Session& s) { return put_gmsh(s, link); }))
          result.append(tuple_of_entity(std::move(entity)));
        return result;
      },
      "session"_a, "link"_a,
      "Inside of hextwist.gmsh.put(): entities as take_gmsh() takes them, with the mesh of the session.");
}

/// hextwist.Error, and hextwist.Cancelled of it.
void bind_errors(py::module_& m) {
  static py::handle error, cancelled;
  const auto made = [&](const char* name, const py::handle& base, const char* doc) {
    const std::string whole = std::string("hextwist.") + name;
    PyObject* type = PyErr_NewExceptionWithDoc(whole.c_str(), doc, base.ptr(), nullptr);
    if (!type) throw py::error_already_set();
    m.add_object(name, type);
    return py::handle(type);
  };
  error =
      made("Error", PyExc_Exception,
           "What is wrong, as the program prints it. message (str): one line, without the place; line, column (int): "
           "of the wrong word in the commands, from 1, 0: none.");
  cancelled = made("Cancelled", error, "The progress callback returned False; the session is as it was.");
  py::register_exception_translator([](std::exception_ptr pointer) {
    const auto raise = [](py::handle type, const std::string& whole, const std::string& message, int line, int column) {
      const py::object value = type(text(whole));
      value.attr("message") = text(message);
      value.attr("line") = line;
      value.attr("column") = column;
      PyErr_SetObject(type.ptr(), value.ptr());
    };
    try {
      if (pointer) std::rethrow_exception(pointer);
    } catch (const CommandError& e) {
      const bool stopped = e.message() == Cancelled().what();
      raise(stopped ? cancelled : error, e.what(), e.message(), e.line(), e.column());
    } catch (const Error& e) {
      raise(error, e.what(), e.what(), 0, 0);
    }
  });
}

}  // namespace
}  // namespace hextwist::python

PYBIND11_MODULE(_core, m) {
  m.doc() = "The compiled half of hextwist: use it through hextwist and hextwist.gmsh.";
  m.attr("__version__") = HEXTWIST_VERSION;
  hextwist::python::bind_errors(m);
  hextwist::python::bind_mesh(m);
  hextwist::python::bind_session(m);
  hextwist::python::bind_gmsh(m);
}
