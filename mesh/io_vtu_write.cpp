// VTK's XML unstructured grid, .vtu: hexes with node and hex ids, owners, blocks, quality and all fields as point and
// cell data; raw appended arrays (binary) or text.
//
// What VTK has no place for is kept as field data, named "hextwist:...": groups with their members (0-based), edges
// on curves, faces on surfaces. "hextwist:made <names>" lists the arrays that are made here and are no fields.
#include <functional>

#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/io_internal.h"
#include "hextwist/mesh/quality.h"

namespace hextwist::io {
namespace {

template <class T>
constexpr const char* vtk_type() {
  if constexpr (std::is_same_v<T, double>) return "Float64";
  if constexpr (std::is_same_v<T, std::int64_t>) return "Int64";
  if constexpr (std::is_same_v<T, std::int32_t>) return "Int32";
  if constexpr (std::is_same_v<T, std::uint8_t>) return "UInt8";
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    }
  return result;
}

/// Arrays of a file: text is written where they are declared, binary data after all declarations.
class Arrays {
 public:
  Arrays(Output& out, bool binary) : out_(out), binary_(binary) {}

  /// value(i) for i = 0 .. n * components - 1. What `value` refers to must live until finish().
  template <class T, class F>
  void add(const std::string& name, std::size_t n, int components, F value, const std::string& more = "") {
    out_ << "<DataArray type=\"" << vtk_type<T>() << "\" Name=\"" << escaped(name) << "\" NumberOfComponents=\""
         << components << "\"" << more;
    const std::size_t total = n * static_cast<std::size_t>(components);
    if (binary_) {
      out_ << " format=\"appended\" offset=\"" << offset_ << "\"/>\n";
      offset_ += sizeof(std::uint64_t) + total * sizeof(T);
      appended_.emplace_back([this, total, value] {
        out_.put(static_cast<std::uint64_t>(total * sizeof(T)));
        for (std::size_t i = 0; i < total; ++i) out_.put(static_cast<T>(value(i)));
      });
      return;
    }
    out_ << " format=\"ascii\">\n";
    for (std::size_t i = 0; i < total; ++i) {
      if constexpr (std::is_same_v<T, double>)
        out_ << static_cast<double>(value(i));
      else
        out_ << static_cast<std::int64_t>(value(i));
      out_ << ((i + 1) % 12 == 0 ? '\n' : ' ');
    }
    out_ << "\n</DataArray>\n";
  }

  void finish() {
    if (!binary_) return;
    out_ << "<AppendedData encoding=\"raw\">\n_";
    for (const auto& write : appended_) write();
    out_ << "\n</AppendedData>\n";
  }

 private:
  Output& out_;
  bool binary_;
  std::uint64_t offset_ = 0;
  std::vector<std::function<void()>> appended_;
};

/// Field data: a list of rows of integers.
void add_rows(Arrays& arrays, const std::string& name, std::vector<std::int32_t> rows, int columns) {
  const std::size_t n = rows.size() / static_cast<std::size_t>(columns);
  arrays.add<std::int32_t>(
      "hextwist:" + name, n, columns, [rows = std::move(rows)](std::size_t i) { return rows[i]; },
      " NumberOfTuples=\"" + std::to_string(n) + "\"");
}

}  // namespace

void write_vtu(Output& out, const Mesh& mesh, const Association& association, const WriteOptions& options) {
  const auto n_nodes = mesh.points.size(), n_hexes = mesh.hexes.size();
  Arrays arrays(out, options.binary);

  // Arrays that we make ourselves give way to fields of the same name.
  const auto made = [&](const char* name, Field::On on) {
    return std::ranges::none_of(mesh.fields, [&](const Field& f) { return f.name == name && f.on == on; });
  };
  const auto node_ids = made("node_id", Field::On::node);
  const auto owners =
      !association.node_owner.empty() && made("owner_dim", Field::On::node) && made("owner_id", Field::On::node);
  const auto hex_ids = made("hex_id", Field::On::hex);
  const auto volumes = !association.hex_volume.empty() && made("volume", Field::On::hex);
  const auto block_ids = !mesh.blocks.empty() && made("block", Field::On::hex);
  const auto shape = options.write_quality && made("shape", Field::On::hex);
  const auto jacobian = options.write_quality && made("scaled_jacobian", Field::On::hex);
  std::string names;
  for (const auto& [name, there] :
       {std::pair("node_id", node_ids), std::pair("owner_dim", owners), std::pair("owner_id", owners),
        std::pair("hex_id", hex_ids), std::pair("volume", volumes), std::pair("block", block_ids),
        std::pair("shape", shape), std::pair("scaled_jacobian", jacobian)})
    if (there) names += std::string(" ") + name;

  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\""
      << (std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian")
      << "\" header_type=\"UInt64\">\n<UnstructuredGrid>\n<FieldData>\n";
  add_rows(arrays, "made" + names, {1}, 1);
  for (const Block& block : mesh.blocks)
    add_rows(arrays, "block " + std::to_string(block.id) + " " + block.name, block.hexes, 1);
  for (const NodeSet& set : mesh.node_sets)
    add_rows(arrays, "nodeset " + std::to_string(set.id) + " " + set.name, set.nodes, 1);
  for (const SideSet& set : mesh.side_sets) {
    std::vector<std::int32_t> rows;
    for (const Side& side : set.sides) rows.insert(rows.end(), {side.hex, side.face});
    add_rows(arrays, "sideset " + std::to_string(set.id) + " " + set.name, std::move(rows), 2);
  }
  std::vector<std::int32_t> rows;
  for (std::size_t i = 0; i < association.curve_edges.size(); ++i)
    rows.insert(rows.end(), {association.curve_edges[i][0], association.curve_edges[i][1], association.edge_curve[i]});
  if (!rows.empty()) add_rows(arrays, "curve_edges", std::move(rows), 3);
  rows.clear();
  for (std::size_t i = 0; i < association.surface_faces.size(); ++i)
    rows.insert(rows.end(),
                {association.surface_faces[i].hex, association.surface_faces[i].face, association.face_surface[i]});
  if (!rows.empty()) add_rows(arrays, "surface_faces", std::move(rows), 3);

  out << "</FieldData>\n<Piece NumberOfPoints=\"" << n_nodes << "\" NumberOfCells=\"" << n_hexes
      << "\">\n<PointData>\n";
  if (node_ids)
    arrays.add<std::int64_t>("node_id", n_nodes, 1,
                             [&](std::size_t i) { return node_id(mesh, static_cast<Index>(i)); });
  if (owners) {
    arrays.add<std::int32_t>("owner_dim", n_nodes, 1, [&](std::size_t i) { return association.node_owner[i].dim; });
    arrays.add<std::int32_t>("owner_id", n_nodes, 1, [&](std::size_t i) { return association.node_owner[i].id; });
  }
  const auto add_fields = [&](Field::On on, std::size_t n) {
    for (const Field& field : mesh.fields)
      if (field.on == on)
        arrays.add<double>(field.name, n, field.components, [&field](std::size_t i) { return field.values[i]; });
  };
  add_fields(Field::On::node, n_nodes);
  out << "</PointData>\n<CellData>\n";
  if (hex_ids)
    arrays.add<std::int64_t>("hex_id", n_hexes, 1, [&](std::size_t i) { return hex_id(mesh, static_cast<Index>(i)); });
  if (volumes) arrays.add<std::int32_t>("volume", n_hexes, 1, [&](std::size_t i) { return association.hex_volume[i]; });
  std::vector<std::int32_t> block_of_hex(block_ids ? n_hexes : 0, 0);
  if (block_ids) {
    for (const Block& block : mesh.blocks)
      for (const Index h : block.hexes)
        if (block_of_hex[h] == 0) block_of_hex[h] = block.id;
    arrays.add<std::int32_t>("block", n_hexes, 1, [&](std::size_t i) { return block_of_hex[i]; });
  }
  std::vector<double> shapes, jacobians;
  if (shape) {
    shapes = quality(Metric::shape, mesh);
    arrays.add<double>("shape", n_hexes, 1, [&](std::size_t i) { return shapes[i]; });
  }
  if (jacobian) {
    jacobians = quality(Metric::scaled_jacobian, mesh);
    arrays.add<double>("scaled_jacobian", n_hexes, 1, [&](std::size_t i) { return jacobians[i]; });
  }
  add_fields(Field::On::hex, n_hexes);
  out << "</CellData>\n<Points>\n";
  arrays.add<double>("Points", n_nodes, 3, [&](std::size_t i) { return mesh.points[i / 3][static_cast<int>(i % 3)]; });
  out << "</Points>\n<Cells>\n";
  arrays.add<std::int32_t>("connectivity", 8 * n_hexes, 1,
                           [&](std::size_t i) { return mesh.hexes[i >> 3][file_corner[i & 7]]; });
  arrays.add<std::int64_t>("offsets", n_hexes, 1, [](std::size_t i) { return 8 * (static_cast<std::int64_t>(i) + 1); });
  arrays.add<std::uint8_t>("types", n_hexes, 1, [](std::size_t) { return 12; });
  out << "</Cells>\n</Piece>\n</UnstructuredGrid>\n";
  arrays.finish();
  out << "</VTKFile>\n";
}

}  // namespace hextwist::io
