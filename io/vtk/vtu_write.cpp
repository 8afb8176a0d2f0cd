// VTK's XML unstructured grid, .vtu: hexes with node and hex ids, owners, blocks, quality and all fields as point and
// cell data; raw appended arrays (binary) or text.
//
// What VTK has no place for is kept as field data, named "hextwist:...": groups with their members (0-based), edges
// on curves, faces on surfaces. "hextwist:made <names>" lists the arrays that are made here and are no fields.
#include <functional>
#include <span>

#include "hextwist/io/middles.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/quality/quality.h"

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

/// Numbers of one value of an array: itself, or those of a std::array.
template <class T>
struct VtkNumbers {
  using Type = T;
  static std::span<const T> of(const T& value) { return {&value, 1}; }
};
template <class T, std::size_t n>
struct VtkNumbers<std::array<T, n>> {
  using Type = T;
  static std::span<const T> of(const std::array<T, n>& value) { return value; }
};

/// Arrays of a file: text is written where they are declared, binary data after all declarations. What an array is
/// made of must live until finish().
class Arrays {
 public:
  Arrays(Output& out, bool binary) : out_(out), binary_(binary) {}

  /// Numbers as they lie in memory. `more`: attributes.
  template <class T>
  void add(const std::string& name, std::span<const T> values, int components, const std::string& more = "") {
    declare<T>(name, values.size(), components, more);
    if (binary_)
      appended_.emplace_back([this, values] { out_.put_all(values); });
    else
      text([&](auto&& put) {
        for (const T value : values) put(value);
      });
  }
  /// value(0) .. value(n - 1), made when they are written; a number or a std::array of them each.
  template <class F>
  void add_each(const std::string& name, std::size_t n, int components, F value, const std::string& more = "") {
    using Value = decltype(value(n));
    using T = typename VtkNumbers<Value>::Type;
    declare<T>(name, n * sizeof(Value) / sizeof(T), components, more);
    if (binary_)
      appended_.emplace_back([this, n, value] { out_.put_each(n, value); });
    else
      text([&](auto&& put) {
        for (std::size_t i = 0; i < n; ++i) {
          const Value one = value(i);
          for (const T number : VtkNumbers<Value>::of(one)) put(number);
        }
      });
  }

  void finish() {
    if (!binary_) return;
    out_ << "<AppendedData encoding=\"raw\">\n_";
    for (const auto& write : appended_) write();
    out_ << "\n</AppendedData>\n";
  }

 private:
  template <class T>
  void declare(const std::string& name, std::size_t n_numbers, int components, const std::string& more) {
    out_ << "<DataArray type=\"" << vtk_type<T>() << "\" Name=\"" << escaped(name) << "\" NumberOfComponents=\""
         << components << "\"" << more << (binary_ ? " format=\"appended\"" : " format=\"ascii\">\n");
    if (!binary_) return;
    out_ << " offset=\"" << offset_ << "\"/>\n";
    const std::uint64_t n_bytes = n_numbers * sizeof(T);
    offset_ += sizeof n_bytes + n_bytes;
    appended_.emplace_back([this, n_bytes] { out_.put(n_bytes); });
  }
  template <class Each>
  void text(Each&& each) {
    std::size_t n = 0;
    each([&](auto number) {
      if constexpr (std::is_integral_v<decltype(number)>)
        out_ << static_cast<std::int64_t>(number);
      else
        out_ << number;
      out_ << (++n % 12 == 0 ? '\n' : ' ');
    });
    out_ << "\n</DataArray>\n";
  }

  Output& out_;
  bool binary_;
  std::uint64_t offset_ = 0;
  std::vector<std::function<void()>> appended_;
};

/// Attributes of field data.
std::string tuples(std::size_t n) {
  return " NumberOfTuples=\"" + std::to_string(n) + "\"";
}

template <std::size_t n>
std::array<Index, n> cell_nodes(const Mesh& mesh, const SecondOrder& second, std::size_t hex) {
  const FileHex nodes = file_hex(mesh, &second, static_cast<Index>(hex), vtk_middles);
  std::array<Index, n> result;
  std::ranges::copy_n(nodes.nodes.begin(), n, result.begin());
  return result;
}

/// What VTK has no place for.
void add_field_data(Arrays& arrays, const std::string& made_names, const Mesh& mesh, const Association& association) {
  const auto name = [](const char* kind, const auto& group) {
    return "hextwist:" + std::string(kind) + " " + std::to_string(group.id) + " " + group.name;
  };
  arrays.add_each(
      "hextwist:made" + made_names, 1, 1, [](std::size_t) { return std::int32_t{1}; }, tuples(1));
  for (const Block& block : mesh.blocks)
    arrays.add<Index>(name("block", block), block.hexes, 1, tuples(block.hexes.size()));
  for (const NodeSet& set : mesh.node_sets)
    arrays.add<Index>(name("nodeset", set), set.nodes, 1, tuples(set.nodes.size()));
  for (const SideSet& set : mesh.side_sets)
    arrays.add_each(
        name("sideset", set), set.sides.size(), 2,
        [&](std::size_t i) {
          return std::array{set.sides[i].hex, set.sides[i].face};
        },
        tuples(set.sides.size()));
  if (const auto& edges = association.curve_edges; !edges.empty())
    arrays.add_each(
        "hextwist:curve_edges", edges.size(), 3,
        [&](std::size_t i) {
          return std::array{edges[i][0], edges[i][1], association.edge_curve[i]};
        },
        tuples(edges.size()));
  if (const auto& faces = association.surface_faces; !faces.empty())
    arrays.add_each(
        "hextwist:surface_faces", faces.size(), 3,
        [&](std::size_t i) {
          return std::array{faces[i].hex, faces[i].face, association.face_surface[i]};
        },
        tuples(faces.size()));
}

}  // namespace

void write_vtu(Output& out, const Mesh& mesh, const Association& association, const WriteOptions& options,
               std::vector<std::string>&) {
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
  add_field_data(arrays, names, mesh, association);
  out << "</FieldData>\n<Piece NumberOfPoints=\"" << n_nodes << "\" NumberOfCells=\"" << n_hexes
      << "\">\n<PointData>\n";
  if (node_ids)
    arrays.add_each("node_id", n_nodes, 1, [&](std::size_t i) { return id_of(mesh.node_ids, static_cast<Index>(i)); });
  if (owners) {
    arrays.add_each("owner_dim", n_nodes, 1, [&](std::size_t i) { return association.node_owner[i].dim; });
    arrays.add_each("owner_id", n_nodes, 1, [&](std::size_t i) { return association.node_owner[i].id; });
  }
  const auto add_fields = [&](Field::On on) {
    for (const Field& field : mesh.fields)
      if (field.on == on && field.integer)
        arrays.add_each(field.name, field.values.size(), field.components,
                        [&values = field.values](std::size_t i) { return static_cast<std::int64_t>(values[i]); });
      else if (field.on == on)
        arrays.add<double>(field.name, field.values, field.components);
  };
  add_fields(Field::On::node);
  out << "</PointData>\n<CellData>\n";
  if (hex_ids)
    arrays.add_each("hex_id", n_hexes, 1, [&](std::size_t i) { return id_of(mesh.hex_ids, static_cast<Index>(i)); });
  if (volumes) arrays.add<int>("volume", association.hex_volume, 1);
  std::vector<int> block_of_hex(block_ids ? n_hexes : 0, 0);
  if (block_ids) {
    for (const Block& block : mesh.blocks)
      for (const Index h : block.hexes)
        if (block_of_hex[h] == 0) block_of_hex[h] = block.id;
    arrays.add<int>("block", block_of_hex, 1);
  }
  std::vector<double> shapes, jacobians;
  if (shape) {
    shapes = quality(Metric::shape, mesh);
    arrays.add<double>("shape", shapes, 1);
  }
  if (jacobian) {
    jacobians = quality(Metric::scaled_jacobian, mesh);
    arrays.add<double>("scaled_jacobian", jacobians, 1);
  }
  add_fields(Field::On::hex);
  out << "</CellData>\n<Points>\n";
  arrays.add<double>("Points", coordinates(mesh.points), 3);
  out << "</Points>\n<Cells>\n";
  const SecondOrder* const second = options.second;
  const int nodes_per_hex = second ? second->nodes_per_hex : 8;
  if (!second)
    arrays.add_each("connectivity", n_hexes, 1, [&](std::size_t h) { return in_file_order(mesh.hexes[h]); });
  else if (nodes_per_hex == 20)
    arrays.add_each("connectivity", n_hexes, 1, [&](std::size_t h) { return cell_nodes<20>(mesh, *second, h); });
  else
    arrays.add_each("connectivity", n_hexes, 1, [&](std::size_t h) { return cell_nodes<27>(mesh, *second, h); });
  arrays.add_each("offsets", n_hexes, 1,
                  [=](std::size_t h) { return nodes_per_hex * (static_cast<std::int64_t>(h) + 1); });
  const std::uint8_t type = nodes_per_hex == 8 ? 12 : nodes_per_hex == 20 ? 25 : 29;
  arrays.add_each("types", n_hexes, 1, [=](std::size_t) { return type; });
  out << "</Cells>\n</Piece>\n</UnstructuredGrid>\n";
  arrays.finish();
  out << "</VTKFile>\n";
}

}  // namespace hextwist::io
