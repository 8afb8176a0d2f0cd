// XDMF 3: the grid as XML, its numbers in an HDF5 file beside it.
//
// One grid, with blocks as its first attribute: other readers (meshio, DOLFINx) take no more. Sides have a grid of
// their own in a file of their own, as DOLFINx reads tags of facets. All groups whole are in the HDF5 file, below
// /FieldData.
#include <optional>

#include "hextwist/base/sorted.h"
#include "hextwist/io/hdf5/hdf5_internal.h"
#include "hextwist/io/xdmf/xml_internal.h"

namespace hextwist::io {
namespace {

/// What the place of a dataset, "part.h5:/CellData/block", can't have in its name.
constexpr const char* not_in_places = ":";

/// <Attribute> and dataset of each array.
class XdmfArrays {
 public:
  XdmfArrays(Output& xml, const Hdf5Writer& heavy, const std::string& heavy_name, const std::string& group,
             const char* centre)
      : xml_(xml), arrays_(heavy, group, not_in_places), heavy_name_(heavy_name), centre_(centre) {
    heavy.group(group);
  }
  template <class T>
  void add(const std::string& name, std::span<const T> values, int components) {
    arrays_.add(name, values, components);
    say<T>(name, values.size(), components);
  }
  template <class F>
  void add_each(const std::string& name, std::size_t n, int components, F value) {
    using Value = decltype(value(n));
    using T = typename VtkNumbers<Value>::Type;
    arrays_.add_each(name, n, components, value);
    say<T>(name, n * sizeof(Value) / sizeof(T), components);
  }

 private:
  template <class T>
  void say(const std::string& name, std::size_t n, int components) {
    const char* kind = components == 1   ? "Scalar"
                       : components == 3 ? "Vector"
                       : components == 6 ? "Tensor6"
                       : components == 9 ? "Tensor"
                                         : "Matrix";
    xml_ << "      <Attribute Name=\"" << escaped(name) << "\" AttributeType=\"" << kind << "\" Center=\"" << centre_
         << "\">\n        ";
    data_item<T>(xml_, n / static_cast<std::size_t>(components), components, heavy_name_, arrays_.path());
    xml_ << "      </Attribute>\n";
  }

 public:
  template <class T>
  static void data_item(Output& xml, std::size_t n, int components, const std::string& heavy_name,
                        const std::string& path) {
    xml << "<DataItem Dimensions=\"" << n;
    if (components > 1) xml << ' ' << components;
    xml << "\" NumberType=\"" << (std::is_floating_point_v<T> ? "Float" : "Int") << "\" Precision=\"" << sizeof(T)
        << "\" Format=\"HDF\">" << escaped(heavy_name + ":" + path) << "</DataItem>\n";
  }

 private:
  Output& xml_;
  Hdf5Writer::Arrays arrays_;
  const std::string& heavy_name_;
  const char* centre_;
};

constexpr const char* begin =
    "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n    <Grid Name=\"mesh\" GridType=\"Uniform\">\n";
constexpr const char* end = "    </Grid>\n  </Domain>\n</Xdmf>\n";

void topology(Output& xml, const char* kind, int n_nodes, std::size_t n, const std::string& heavy_name,
              const std::string& path) {
  xml << "      <Topology TopologyType=\"" << kind << "\" NumberOfElements=\"" << n << "\" NodesPerElement=\""
      << n_nodes << "\">\n        ";
  XdmfArrays::data_item<Index>(xml, n, n_nodes, heavy_name, path);
  xml << "      </Topology>\n";
}

}  // namespace

void write_xdmf(const std::filesystem::path& file, const Mesh& mesh, const Association& association,
                const WriteOptions& options, std::vector<std::string>& notices) {
  say_unwritable(mesh, false, notices);
  const SecondOrder* const second = options.second;
  const std::filesystem::path heavy_path = std::filesystem::path(file).replace_extension(".h5");
  // DOLFINx looks for data in the .h5 that is called as the .xdmf, whatever that says.
  const std::filesystem::path sides_path = file.parent_path() / (file.stem().string() + "_sidesets.xdmf"),
                              heavy_sides_path = std::filesystem::path(sides_path).replace_extension(".h5");
  const std::string heavy_name = heavy_path.filename().string();
  // Nobody has named these: they are not written where a link would lead.
  for (const auto& beside : {heavy_path, sides_path, heavy_sides_path}) {
    std::error_code error;
    if (std::filesystem::is_symlink(beside, error))
      throw Error(beside.string() + ": is a link, and data of " + file.filename().string() + " would be written there");
  }
  Replacement heavy_file(heavy_path, options.overwrite);
  if (heavy_file.direct()) heavy_file.fail("is not an ordinary file, as HDF5 needs");
  Output xml(file, options.overwrite);
  std::optional<Output> sides_xml;
  std::optional<Replacement> heavy_sides_file;
  if (!mesh.side_sets.empty()) {
    sides_xml.emplace(sides_path, options.overwrite);
    heavy_sides_file.emplace(heavy_sides_path, options.overwrite);
  }

  Hdf5Writer heavy(heavy_file);
  const VtkOutput output(mesh, association, options);
  const std::string points = "/Mesh/geometry", cells = "/Mesh/topology";
  heavy.group("/Mesh");
  heavy.array(points, coordinates(std::span(mesh.points)), 3);
  Hdf5Writer::Arrays of_mesh(heavy, "/Mesh");
  const int n_nodes = output.nodes_per_hex();
  output.connectivity(of_mesh, "topology", n_nodes);
  const auto geometry = [&](Output& to) {
    to << "      <Geometry GeometryType=\"XYZ\">\n        ";
    XdmfArrays::data_item<double>(to, mesh.points.size(), 3, heavy_name, points);
    to << "      </Geometry>\n";
  };
  xml << begin;
  topology(xml,
           n_nodes == 8    ? "Hexahedron"
           : n_nodes == 20 ? "Hexahedron_20"
                           : "Hexahedron_27",
           n_nodes, mesh.hexes.size(), heavy_name, cells);
  geometry(xml);
  // The first attribute is what DOLFINx takes for tags of cells.
  XdmfArrays of_cells(xml, heavy, heavy_name, "/CellData", "Cell");
  output.block_data(of_cells);
  XdmfArrays of_nodes(xml, heavy, heavy_name, "/NodeData", "Node");
  output.point_data(of_nodes);
  output.cell_data(of_cells, false);
  xml << end;
  heavy.group("/FieldData");
  Hdf5Writer::Arrays field_data(heavy, "/FieldData", not_in_places);
  output.field_data(field_data);

  if (sides_xml) {
    // Each face once, with the first of its sets.
    std::vector<Quad> faces;
    for (const SideSet& set : mesh.side_sets)
      for (const Side& side : set.sides) faces.push_back(ascending(face_nodes(mesh.hexes[side.hex], side.face)));
    sort_unique(faces);
    std::vector<char> written(faces.size(), 0);
    const int width = !second ? 4 : second->nodes_per_hex == 20 ? 8 : 9;
    std::vector<Index> quads;
    std::vector<std::int32_t> sets;
    for (const SideSet& set : mesh.side_sets)
      for (const Side& side : set.sides) {
        const Quad q = face_node_cycle(mesh.hexes[side.hex], side.face);
        if (std::exchange(written[static_cast<std::size_t>(position_in(faces, ascending(q)))], 1) != 0) continue;
        quads.insert(quads.end(), q.begin(), q.end());
        for (std::size_t c = 0; c < 4 && second; ++c) quads.push_back(second->middle_between(q[c], q[(c + 1) % 4]));
        if (width == 9) quads.push_back(second->middle_of(q));
        sets.push_back(set.id);
      }
    const std::string sides = "/Mesh/topology", name = heavy_sides_path.filename().string();
    Hdf5Writer heavy_sides(*heavy_sides_file);
    heavy_sides.group("/Mesh");
    heavy_sides.array(sides, std::span<const Index>(quads), static_cast<std::size_t>(width));
    *sides_xml << begin;
    topology(*sides_xml,
             width == 4   ? "Quadrilateral"
             : width == 8 ? "Quadrilateral_8"
                          : "Quadrilateral_9",
             width, sets.size(), name, sides);
    geometry(*sides_xml);
    XdmfArrays of_sides(*sides_xml, heavy_sides, name, "/CellData", "Cell");
    of_sides.add<std::int32_t>("sideset", sets, 1);
    *sides_xml << end;
    heavy_sides.close();
  }
  heavy.close();
  heavy_file.commit();
  if (sides_xml) heavy_sides_file->commit(), sides_xml->commit();
  xml.commit();
}

}  // namespace hextwist::io
