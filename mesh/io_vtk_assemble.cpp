// Cells and arrays of VTK become a mesh.
//
// Hexes and voxels are hexes. Arrays are fields, but those that write_vtu() makes itself ("hextwist:made") turn back
// into ids, owners and groups. In other people's files, an integer cell array of a well-known name gives blocks
// (positive values on hexes) and side sets (on quads).
#include <limits>
#include <map>

#include "hextwist/mesh/io_vtk_internal.h"

namespace hextwist::io {

namespace {

struct NamedType {
  std::string_view name;
  VtkType type;
};
constexpr NamedType vtk_types[] = {{"Int8", VtkType::int8},
                                   {"UInt8", VtkType::uint8},
                                   {"Int16", VtkType::int16},
                                   {"UInt16", VtkType::uint16},
                                   {"Int32", VtkType::int32},
                                   {"UInt32", VtkType::uint32},
                                   {"Int64", VtkType::int64},
                                   {"UInt64", VtkType::uint64},
                                   {"Float32", VtkType::float32},
                                   {"Float64", VtkType::float64},
                                   {"char", VtkType::int8},
                                   {"signed_char", VtkType::int8},
                                   {"unsigned_char", VtkType::uint8},
                                   {"short", VtkType::int16},
                                   {"unsigned_short", VtkType::uint16},
                                   {"int", VtkType::int32},
                                   {"unsigned_int", VtkType::uint32},
                                   {"long", VtkType::int64},
                                   {"unsigned_long", VtkType::uint64},
                                   {"vtkIdType", VtkType::int32},
                                   {"vtktypeint64", VtkType::int64},
                                   {"vtktypeuint64", VtkType::uint64},
                                   {"float", VtkType::float32},
                                   {"double", VtkType::float64}};

bool is_integer(VtkType type) {
  return type != VtkType::float32 && type != VtkType::float64;
}

/// Cell types below dimension 3; everything else but hexes and voxels is refused.
constexpr int lower_types[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 21, 22, 23, 28, 30, 34, 35, 36, 68, 69, 70, 75, 76, 77};
constexpr int vtk_pixel = 8, vtk_quad = 9, vtk_voxel = 11, vtk_hex = 12;

std::string type_name(int type) {
  constexpr std::pair<int, const char*> names[] = {
      {10, "tetrahedron"},   {13, "wedge"},           {14, "pyramid"},           {24, "quadratic tetrahedron"},
      {25, "quadratic hex"}, {26, "quadratic wedge"}, {27, "quadratic pyramid"}, {29, "triquadratic hex"},
      {42, "polyhedron"},    {72, "Lagrange hex"}};
  for (const auto& [number, name] : names)
    if (number == type) return name;
  return "cell of type " + std::to_string(type);
}

constexpr std::string_view group_arrays[] = {"MaterialID",    "CellEntityIds",    "medit:ref",
                                             "gmsh:physical", "gmsh:geometrical", "BlockId"};

class Assembly {
 public:
  Assembly(VtkContents&& contents, const Cursor& cursor) : in_(std::move(contents)), cursor_(cursor) {}

  MeshFile result() {
    cells();
    ours();
    if (made_.empty()) groups();
    fields();
    return std::move(out_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw Error(std::string(cursor_.name) + ": " + what); }

  void cells() {
    Mesh& mesh = out_.mesh;
    mesh.points = std::move(in_.points);
    std::map<int, std::int64_t> dropped;
    for (std::size_t i = 0; i < in_.types.size(); ++i) {
      const int type = in_.types[i];
      const auto n = in_.offsets[i + 1] - in_.offsets[i];
      const bool hex = type == vtk_hex || type == vtk_voxel, quad = type == vtk_quad || type == vtk_pixel;
      if (!hex && std::ranges::find(lower_types, type) == std::end(lower_types))
        fail("cell " + std::to_string(i + 1) + " is a " + type_name(type) + "; only 8-node hexes are accepted");
      if ((hex && n != 8) || (quad && n != 4))
        fail("cell " + std::to_string(i + 1) + " has " + std::to_string(n) + " nodes instead of " + (hex ? "8" : "4"));
      if (!hex && !quad) {
        ++dropped[type];
        continue;
      }
      std::array<Index, 8> nodes{};
      for (std::int64_t c = 0; c < n; ++c) {
        const auto node = in_.connectivity[in_.offsets[i] + c];
        if (node < 0 || node >= mesh.n_nodes())
          fail("cell " + std::to_string(i + 1) + " names point " + std::to_string(node) + " of " +
               std::to_string(mesh.n_nodes()) + " (counted from 0)");
        nodes[c] = static_cast<Index>(node);
      }
      if (hex) {
        Hex& to = mesh.hexes.emplace_back();
        for (int c = 0; c < 8; ++c) to[type == vtk_voxel ? c : file_corner[c]] = nodes[c];
        hex_cells_.push_back(i);
      } else {
        if (type == vtk_pixel) std::swap(nodes[2], nodes[3]);
        quads_.push_back({nodes[0], nodes[1], nodes[2], nodes[3]});
        quad_cells_.push_back(i);
      }
    }
    if (mesh.hexes.empty()) cursor_.fail_at(cursor_.end, "there is no hex in the file");
    for (const auto& [type, n] : dropped)
      out_.notices.push_back("dropped " + std::to_string(n) + " cells of type " + std::to_string(type) +
                             ", which are no hexes or quads");
  }

  const VtkArray* find(VtkArray::On on, std::string_view name) const {
    for (const VtkArray& array : in_.arrays)
      if (array.on == on && array.name == name) return &array;
    return nullptr;
  }
  bool is_made(std::string_view name) const { return std::ranges::find(made_, name) != made_.end(); }

  /// What write_vtu() says beyond fields. Such arrays may have been edited by other programs: all is checked.
  void ours() {
    Mesh& mesh = out_.mesh;
    Association& tags = out_.tags;
    for (const VtkArray& array : in_.arrays)
      if (array.on == VtkArray::On::file && array.name.starts_with("hextwist:made")) {
        std::string_view rest = std::string_view(array.name).substr(13);
        while (!(rest = trimmed(rest)).empty()) {
          const auto end = std::min(rest.find(' '), rest.size());
          made_.emplace_back(rest.substr(0, end));
          rest.remove_prefix(end);
        }
      }
    if (made_.empty()) return;
    const auto n_nodes = mesh.points.size(), n_hexes = mesh.hexes.size();
    if (hex_cells_.size() != in_.types.size()) fail("groups cannot be kept: there are cells other than hexes");
    const auto column = [&](VtkArray::On on, const char* name, std::size_t n) {
      const VtkArray* array = is_made(name) ? find(on, name) : nullptr;
      return array && array->integer && array->size() == n ? array : nullptr;
    };
    const auto ids = [&](const VtkArray* array, const char* kind) {
      if (!array) return std::vector<std::int64_t>{};
      if (!array->integers.empty() && array->integers[0] < 1) fail(std::string(kind) + " ids are not positive");
      if (std::ranges::adjacent_find(array->integers, std::ranges::greater_equal{}) != array->integers.end())
        fail(std::string(kind) + " ids are not ascending");
      const bool plain = array->integers.empty() || array->integers.back() == std::ssize(array->integers);
      return plain ? std::vector<std::int64_t>{} : array->integers;
    };
    mesh.node_ids = ids(column(VtkArray::On::node, "node_id", n_nodes), "node");
    mesh.hex_ids = ids(column(VtkArray::On::cell, "hex_id", n_hexes), "hex");
    tags.node_owner.resize(n_nodes);
    tags.node_parameters.resize(n_nodes);
    tags.hex_volume.resize(n_hexes);
    const VtkArray* dim = column(VtkArray::On::node, "owner_dim", n_nodes);
    const VtkArray* id = column(VtkArray::On::node, "owner_id", n_nodes);
    for (std::size_t i = 0; dim && id && i < n_nodes; ++i)
      if (dim->integers[i] >= 0 && dim->integers[i] <= 3)
        tags.node_owner[i] = {static_cast<int>(dim->integers[i]), static_cast<int>(id->integers[i])};
    if (const VtkArray* volume = column(VtkArray::On::cell, "volume", n_hexes))
      for (std::size_t i = 0; i < n_hexes; ++i) tags.hex_volume[i] = static_cast<int>(volume->integers[i]);
    for (const VtkArray& array : in_.arrays)
      if (array.on == VtkArray::On::file && array.name.starts_with("hextwist:") && array.integer)
        group(array, std::string_view(array.name).substr(9));
    const auto by_id = [](auto& groups) {
      std::ranges::stable_sort(groups, {}, [](const auto& g) { return g.id; });
      groups.erase(std::ranges::unique(groups, {}, [](const auto& g) { return g.id; }).begin(), groups.end());
    };
    by_id(mesh.blocks), by_id(mesh.node_sets), by_id(mesh.side_sets);
    tidy(tags);
  }

  void group(const VtkArray& array, std::string_view what) {
    const auto row = [&](std::size_t i, std::size_t columns, std::size_t c, std::int64_t bound) {
      const std::int64_t value = array.integers[i * columns + c];
      if (value < 0 || value >= bound) fail("'" + array.name + "' has an entry " + std::to_string(value));
      return static_cast<Index>(value);
    };
    Mesh& mesh = out_.mesh;
    const auto n = [&](std::size_t columns) { return array.integers.size() / columns; };
    constexpr std::int64_t any = std::numeric_limits<int>::max();
    if (what == "curve_edges") {
      for (std::size_t i = 0; i < n(3); ++i) {
        out_.tags.curve_edges.push_back({row(i, 3, 0, mesh.n_nodes()), row(i, 3, 1, mesh.n_nodes())});
        out_.tags.edge_curve.push_back(row(i, 3, 2, any));
      }
      return;
    }
    if (what == "surface_faces") {
      for (std::size_t i = 0; i < n(3); ++i) {
        out_.tags.surface_faces.push_back({row(i, 3, 0, mesh.n_hexes()), row(i, 3, 1, 6)});
        out_.tags.face_surface.push_back(row(i, 3, 2, any));
      }
      return;
    }
    // "block 3 name"
    const auto blank = std::min(what.find(' '), what.size());
    const std::string_view kind = what.substr(0, blank);
    std::string_view rest = what.substr(std::min(blank + 1, what.size()));
    int id = 0;
    const auto [stop, error] = std::from_chars(rest.data(), rest.data() + rest.size(), id);
    if (error != std::errc{} || id < 1) return;
    rest.remove_prefix(static_cast<std::size_t>(stop - rest.data()));
    const std::string name(rest.substr(std::min<std::size_t>(1, rest.size())));
    if (kind == "block" || kind == "nodeset") {
      std::vector<Index> items;
      for (std::size_t i = 0; i < n(1); ++i)
        items.push_back(row(i, 1, 0, kind == "block" ? mesh.n_hexes() : mesh.n_nodes()));
      make_set(items);
      if (kind == "block")
        mesh.blocks.push_back({id, name, std::move(items)});
      else
        mesh.node_sets.push_back({id, name, std::move(items)});
    } else if (kind == "sideset") {
      std::vector<Side> items;
      for (std::size_t i = 0; i < n(2); ++i) items.push_back({row(i, 2, 0, mesh.n_hexes()), row(i, 2, 1, 6)});
      make_set(items);
      mesh.side_sets.push_back({id, name, std::move(items)});
    }
  }

  void groups() {
    const auto sides = oriented_sides(out_.mesh, quads_);
    if (const auto lost = std::ranges::count(sides, -1, &Side::hex))
      out_.notices.push_back("dropped " + std::to_string(lost) + " quads that are no side of a hex");
    for (const std::string_view name : group_arrays) {
      const VtkArray* array = find(VtkArray::On::cell, name);
      if (!array || array->components != 1 || array->size() != in_.types.size()) continue;
      const auto value = [&](std::size_t cell) {
        const double x = array->real(cell);
        return x >= 1 && x < std::numeric_limits<int>::max() && x == std::floor(x) ? static_cast<int>(x) : 0;
      };
      std::map<int, std::vector<Index>> blocks;
      std::map<int, std::vector<Side>> sets;
      for (std::size_t h = 0; h < hex_cells_.size(); ++h)
        if (const int id = value(hex_cells_[h])) blocks[id].push_back(static_cast<Index>(h));
      for (std::size_t q = 0; q < quad_cells_.size(); ++q)
        if (const int id = value(quad_cells_[q]); id && sides[q].hex >= 0) sets[id].push_back(sides[q]);
      for (auto& [id, items] : blocks) out_.mesh.blocks.push_back({id, "", std::move(items)});
      for (auto& [id, items] : sets) {
        make_set(items);
        out_.mesh.side_sets.push_back({id, "", std::move(items)});
      }
      break;
    }
  }

  void fields() {
    for (const VtkArray& array : in_.arrays) {
      if (array.on == VtkArray::On::file || is_made(array.name)) continue;
      const bool node = array.on == VtkArray::On::node;
      const auto width = static_cast<std::size_t>(array.components);
      const std::size_t n = node ? out_.mesh.points.size() : in_.types.size();
      if (array.size() != n * width) {
        out_.notices.push_back("dropped array '" + array.name + "', which has " + std::to_string(array.size()) +
                               " values instead of " + std::to_string(n * width));
        continue;
      }
      Field field{array.name, node ? Field::On::node : Field::On::hex, array.components, {}};
      for (std::size_t i = 0; i < (node ? n : hex_cells_.size()); ++i)
        for (std::size_t c = 0; c < width; ++c)
          field.values.push_back(array.real((node ? i : hex_cells_[i]) * width + c));
      out_.mesh.fields.push_back(std::move(field));
    }
  }

  VtkContents in_;
  const Cursor& cursor_;
  MeshFile out_;
  std::vector<std::size_t> hex_cells_, quad_cells_;
  std::vector<Quad> quads_;
  std::vector<std::string> made_;
};

}  // namespace

VtkType vtk_type(std::string_view name, const Cursor& cursor) {
  for (const auto& [known, type] : vtk_types)
    if (same_word(known, name)) return type;
  cursor.fail("numbers of type " + shown(name) + " are not known");
}

std::size_t vtk_size(VtkType type) {
  constexpr std::array<std::size_t, 10> sizes = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

void read_vtk_values(Cursor& cursor, VtkType type, std::size_t n, VtkArray& to) {
  to.integer = is_integer(type);
  if (n > cursor.left() / vtk_size(type)) cursor.fail_truncated("the values of " + shown(to.name));
  const auto all = [&]<class T>(T) {
    for (std::size_t i = 0; i < n; ++i) {
      const T value = cursor.raw<T>("a value");
      if constexpr (std::is_integral_v<T>)
        to.integers.push_back(static_cast<std::int64_t>(value));
      else
        to.reals.push_back(value);
    }
  };
  to.integer ? to.integers.reserve(n) : to.reals.reserve(n);
  switch (type) {
    case VtkType::int8:
      return all(std::int8_t{});
    case VtkType::uint8:
      return all(std::uint8_t{});
    case VtkType::int16:
      return all(std::int16_t{});
    case VtkType::uint16:
      return all(std::uint16_t{});
    case VtkType::int32:
      return all(std::int32_t{});
    case VtkType::uint32:
      return all(std::uint32_t{});
    case VtkType::int64:
      return all(std::int64_t{});
    case VtkType::uint64:
      return all(std::uint64_t{});
    case VtkType::float32:
      return all(float{});
    case VtkType::float64:
      return all(double{});
  }
}

void read_vtk_text(Cursor& cursor, VtkType type, std::size_t n, VtkArray& to) {
  to.integer = is_integer(type);
  if (n > cursor.left() / 2 + 1) cursor.fail_truncated("the values of " + shown(to.name));
  for (std::size_t i = 0; i < n; ++i)
    if (to.integer)
      to.integers.push_back(cursor.integer("a value"));
    else
      to.reals.push_back(cursor.real("a value"));
}

std::vector<Vec3> vtk_points(const VtkArray& array, const Cursor& cursor) {
  std::vector<Vec3> points(array.size() / 3);
  for (std::size_t i = 0; i < 3 * points.size(); ++i) {
    points[i / 3][static_cast<int>(i % 3)] = array.real(i);
    if (!std::isfinite(array.real(i)))
      throw Error(std::string(cursor.name) + ": a coordinate of point " + std::to_string(i / 3) +
                  " (counted from 0) is not finite");
  }
  return points;
}

MeshFile assemble_vtk(VtkContents&& contents, const Cursor& cursor) {
  return Assembly(std::move(contents), cursor).result();
}

}  // namespace hextwist::io
