// VTK's XML unstructured grid, .vtu: hexes with node and hex ids, owners, blocks, quality and all fields as point and
// cell data; raw appended arrays (binary) or text.
//
// What VTK has no place for is kept as field data, named "hextwist:...": groups with their members (0-based), edges
// on curves, faces on surfaces. "hextwist:made <names>" lists the arrays that are made here and are no fields.
#include <functional>
#include <span>

#include "hextwist/io/vtk/output_internal.h"
#include "hextwist/io/vtk/tags_internal.h"

namespace hextwist::io {
namespace {

template <class T>
constexpr const char* vtk_type() {
  if constexpr (std::is_same_v<T, double>) return "Float64";
  if constexpr (std::is_same_v<T, std::int64_t>) return "Int64";
  if constexpr (std::is_same_v<T, std::int32_t>) return "Int32";
  if constexpr (std::is_same_v<T, std::uint8_t>) return "UInt8";
}

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

}  // namespace

void write_vtu(Output& out, const Mesh& mesh, const Association& association, const WriteOptions& options,
               std::vector<std::string>& notices) {
  say_unwritable(mesh, true, notices);
  const auto n_nodes = mesh.points.size(), n_hexes = mesh.hexes.size();
  Arrays arrays(out, options.binary);

  const OtherCells others(mesh, notices);
  const std::size_t n_cells = n_hexes + others.types.size();
  const VtkOutput output(mesh, association, options, &others);
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\""
      << (std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian")
      << "\" header_type=\"UInt64\">\n<UnstructuredGrid>\n<FieldData>\n";
  output.field_data(arrays);
  out << "</FieldData>\n<Piece NumberOfPoints=\"" << n_nodes << "\" NumberOfCells=\"" << n_cells
      << "\">\n<PointData>\n";
  output.point_data(arrays);
  out << "</PointData>\n<CellData>\n";
  output.cell_data(arrays);
  out << "</CellData>\n<Points>\n";
  arrays.add<double>("Points", coordinates(mesh.points), 3);
  out << "</Points>\n<Cells>\n";
  const auto per_hex = static_cast<std::size_t>(output.nodes_per_hex());
  if (others.types.empty())
    output.connectivity(arrays, "connectivity", 1);
  else
    arrays.add_each("connectivity", n_hexes * per_hex + others.nodes.size(), 1,
                    [&mesh, &others, second = options.second, per_hex, n = n_hexes * per_hex](std::size_t i) {
                      if (i >= n) return others.nodes[i - n];
                      return file_hex(mesh, second, static_cast<Index>(i / per_hex), vtk_middles).nodes[i % per_hex];
                    });
  arrays.add_each("offsets", n_cells, 1, [=, &others](std::size_t c) {
    return c < n_hexes ? static_cast<std::int64_t>(per_hex * (c + 1))
                       : static_cast<std::int64_t>(per_hex * n_hexes) + others.ends[c - n_hexes];
  });
  const std::uint8_t type = per_hex == 8 ? 12 : per_hex == 20 ? 25 : 29;
  arrays.add_each("types", n_cells, 1,
                  [=, &others](std::size_t c) { return c < n_hexes ? type : others.types[c - n_hexes]; });
  out << "</Cells>\n</Piece>\n</UnstructuredGrid>\n";
  arrays.finish();
  out << "</VTKFile>\n";
}

}  // namespace hextwist::io
