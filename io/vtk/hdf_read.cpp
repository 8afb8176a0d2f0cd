// VTKHDF, versions 1 and 2: an unstructured grid of one piece, at the last of its times.
#include "hextwist/io/apart.h"
#include "hextwist/io/hdf5/hdf5_internal.h"
#include "hextwist/io/hdf5/outside_internal.h"

namespace hextwist::io {
namespace {

class VtkHdfReader {
 public:
  explicit VtkHdfReader(const std::filesystem::path& file) : name_(file.string()), in_(file, name_) {}

  MeshFile result() {
    if (!in_.is_group("/VTKHDF")) in_.fail("not a VTKHDF file: there is no group VTKHDF");
    const std::string type = in_.text("/VTKHDF", "Type");
    if (type != "UnstructuredGrid") in_.fail("a file of type " + shown(type) + "; only UnstructuredGrid is read");
    if (const std::int64_t version = in_.integer("/VTKHDF", "Version", -1); version < 1 || version > 2)
      in_.fail("version " + std::to_string(version) + " of VTKHDF is not read, but 1 and 2");
    steps();
    const std::size_t n_points = number("NumberOfPoints", part_), n_cells = number("NumberOfCells", part_),
                      n_ids = number("NumberOfConnectivityIds", part_);
    VtkContents contents;
    const std::size_t first_point = offset("PointOffsets"), first_cell = offset("CellOffsets"),
                      first_id = offset("ConnectivityIdOffsets");
    std::vector<std::size_t> sizes;
    VtkArray points = in_.array("/VTKHDF/Points", sizes);
    if (sizes.size() != 2 || sizes[1] != 3) in_.fail("Points have no three coordinates");
    slice(points, 3 * first_point, 3 * n_points, "Points");
    contents.points = vtk_points(points, cursor_);
    contents.connectivity = whole("Connectivity", first_id, n_ids);
    // One more than cells for each part before this one.
    contents.ends = whole("Offsets", first_cell + part_before_, n_cells + 1);
    if (n_cells + 1 > 0 && contents.ends.integer(0) != 0) in_.fail("Offsets do not begin with 0");
    contents.ends.drop_first();
    contents.types = whole("Types", first_cell, n_cells);
    data(contents, VtkArray::On::node, "PointData", first_point, n_points);
    data(contents, VtkArray::On::cell, "CellData", first_cell, n_cells);
    data(contents, VtkArray::On::file, "FieldData", 0, 0);
    MeshFile out = assemble_vtk(std::move(contents), cursor_);
    if (n_steps_ > 1) out.notices.push_back("has " + std::to_string(n_steps_) + " time steps: the last is read");
    return out;
  }

 private:
  /// Which part is the mesh.
  void steps() {
    VtkArray parts = in_.array("/VTKHDF/NumberOfPoints");
    n_steps_ = std::max<std::int64_t>(1, in_.integer("/VTKHDF/Steps", "NSteps", 1));
    std::int64_t n_parts = static_cast<std::int64_t>(parts.size());
    if (in_.is_group("/VTKHDF/Steps")) {
      n_parts = at_last_step("/VTKHDF/Steps/NumberOfParts", n_parts);
      part_ = static_cast<std::size_t>(at_last_step("/VTKHDF/Steps/PartOffsets", 0));
      timed_ = true;
    }
    if (n_parts != 1) in_.fail("has " + std::to_string(n_parts) + " pieces; only files of one piece are read");
    if (part_ >= parts.size()) in_.fail("a part of the grid is not there");
    // Parts before this one that are other meshes.
    if (timed_ && at_last_step("/VTKHDF/Steps/CellOffsets", 0) > 0) part_before_ = part_;
  }
  std::int64_t at_last_step(const std::string& path, std::int64_t none) const {
    if (!in_.is_numbers(path)) return none;
    const VtkArray values = in_.array(path);
    const auto step = static_cast<std::size_t>(n_steps_ - 1);
    if (step >= values.size()) in_.fail("dataset " + shown(path) + " has too few values");
    const std::int64_t value = values.integer(step);
    if (value < 0) in_.fail("dataset " + shown(path) + " has an impossible value");
    return value;
  }
  std::size_t offset(const std::string& name) const {
    return timed_ ? static_cast<std::size_t>(at_last_step("/VTKHDF/Steps/" + name, 0)) : 0;
  }

  std::size_t number(const std::string& name, std::size_t part) const {
    const VtkArray values = in_.array("/VTKHDF/" + name);
    if (part >= values.size()) in_.fail(name + " has too few values");
    const std::int64_t n = values.integer(part);
    if (n < 0 || n > std::numeric_limits<Index>::max()) in_.fail("impossible " + name + ": " + std::to_string(n));
    return static_cast<std::size_t>(n);
  }
  void slice(VtkArray& array, std::size_t first, std::size_t n, const std::string& what) const {
    if (first > array.size() || n > array.size() - first)
      in_.fail(what + " has " + std::to_string(array.size()) + " values where " + std::to_string(n) + " should be");
    const std::size_t bytes = vtk_size(array.type);
    array.bytes = array.bytes.substr(first * bytes, n * bytes);
  }
  VtkArray whole(const std::string& name, std::size_t first, std::size_t n) const {
    VtkArray array = in_.array("/VTKHDF/" + name);
    if (!array.is_integer()) in_.fail(name + " are not integers");
    slice(array, first, n, name);
    return array;
  }

  void data(VtkContents& contents, VtkArray::On on, const std::string& group, std::size_t first, std::size_t n) {
    const std::string from = "/VTKHDF/" + group;
    for (const std::string& link : in_.members(from)) {
      const std::string path = from + "/" + link;
      if (!in_.is_numbers(path)) {
        contents.notices.push_back("left out array '" + link + "', which is not of numbers");
        continue;
      }
      std::vector<std::size_t> sizes;
      VtkArray array = in_.array(path, sizes);
      if (const std::string name = in_.text(path, hdf5_name); !name.empty()) array.name = name;
      array.on = on;
      if (sizes.size() > 2 || (sizes.size() == 2 && (sizes[1] < 1 || sizes[1] > 1000)))
        in_.fail("array " + shown(array.name) + " has impossible sizes");
      array.components = sizes.size() == 2 ? static_cast<int>(sizes[1]) : 1;
      if (timed_ && on != VtkArray::On::file) {
        const std::size_t at = static_cast<std::size_t>(
            at_last_step("/VTKHDF/Steps/" + group + "Offsets/" + link, static_cast<std::int64_t>(first)));
        const auto width = static_cast<std::size_t>(array.components);
        if (at > array.size() / width) in_.fail("array " + shown(array.name) + " has too few values");
        slice(array, at * width, n * width, "array " + shown(array.name));
      }
      contents.arrays.push_back(std::move(array));
    }
  }

  const std::string name_;
  const Hdf5Reader in_;
  const Cursor cursor_{"", name_};
  std::int64_t n_steps_ = 1;
  bool timed_ = false;
  std::size_t part_ = 0, part_before_ = 0;
};

}  // namespace

MeshFile read_vtkhdf_here(const std::filesystem::path& file, const std::filesystem::path& folder) {
  refuse_links_outside(file, folder);
  return VtkHdfReader(file).result();
}

MeshFile read_vtkhdf(const std::filesystem::path& file, const Fence& fence) {
  return read_apart(fence, "vtkhdf", read_vtkhdf_here, file);
}

}  // namespace hextwist::io
