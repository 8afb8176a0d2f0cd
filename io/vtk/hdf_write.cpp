// VTKHDF, version 1.0, an unstructured grid of one piece: what .vtu has, in HDF5.
#include "hextwist/io/hdf5/hdf5_internal.h"

namespace hextwist::io {

void write_vtkhdf(const std::filesystem::path& file, const Mesh& mesh, const Association& association,
                  const WriteOptions& options, std::vector<std::string>&) {
  Replacement replacement(file, options.overwrite);
  if (replacement.direct()) replacement.fail("is not an ordinary file, as HDF5 needs");
  Hdf5Writer out(replacement);
  const std::string root = "/VTKHDF";
  out.group(root);
  out.integers(root, "Version", {1, 0});
  out.text(root, "Type", "UnstructuredGrid");
  const VtkOutput output(mesh, association, options);
  const auto n_hexes = static_cast<std::int64_t>(mesh.hexes.size());
  const auto number = [&](const char* name, std::int64_t n) {
    out.array(root + "/" + name, std::span<const std::int64_t>(&n, 1));
  };
  number("NumberOfPoints", std::ssize(mesh.points));
  number("NumberOfCells", n_hexes);
  number("NumberOfConnectivityIds", n_hexes * output.nodes_per_hex());
  out.array(root + "/Points", coordinates(std::span(mesh.points)), 3);
  Hdf5Writer::Arrays cells(out, root);
  output.connectivity<std::int64_t>(cells, "Connectivity", 1);  // VTK wants both of one type
  cells.add_each("Offsets", mesh.hexes.size() + 1, 1,
                 [n = output.nodes_per_hex()](std::size_t h) { return n * static_cast<std::int64_t>(h); });
  const std::uint8_t type = output.nodes_per_hex() == 8 ? 12 : output.nodes_per_hex() == 20 ? 25 : 29;
  cells.add_each("Types", mesh.hexes.size(), 1, [=](std::size_t) { return type; });
  const auto section = [&](const char* name, auto&& write) {
    out.group(root + "/" + name);
    Hdf5Writer::Arrays arrays(out, root + "/" + name);
    write(arrays);
  };
  section("PointData", [&](auto& arrays) { output.point_data(arrays); });
  section("CellData", [&](auto& arrays) { output.cell_data(arrays); });
  section("FieldData", [&](auto& arrays) { output.field_data(arrays); });
  out.close();
  replacement.commit();
}

}  // namespace hextwist::io
