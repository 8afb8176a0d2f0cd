// What the mesh formats share: ids, groups, sides, fields; and the functions of each format.
//
// A reader collects items in the order of the file, puts nodes and hexes in ascending order of id, and turns quads,
// lines and points into sides, edges and node sets.
#pragma once

#include <algorithm>
#include <bit>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "hextwist/base/fence.h"
#include "hextwist/base/large_array.h"
#include "hextwist/base/sorted.h"
#include "hextwist/io/io.h"
#include "hextwist/io/text.h"
#include "hextwist/mesh/corners.h"

namespace hextwist::io {

MeshFile read_gmsh(const Bytes& bytes);
void write_gmsh(Output& out, const Mesh& mesh, const Association& association, const WriteOptions& options,
                std::vector<std::string>& notices);
MeshFile read_abaqus(const std::filesystem::path& file, const Fence& fence);
void write_abaqus(Output& out, const Mesh& mesh, const Association& association, const WriteOptions& options,
                  std::vector<std::string>& notices);
MeshFile read_medit(const Bytes& bytes);
void write_medit(Output& out, const Mesh& mesh, const Association& association, const WriteOptions& options,
                 std::vector<std::string>& notices);
MeshFile read_vtk(const Bytes& bytes);
MeshFile read_vtu(const Bytes& bytes);
void write_vtu(Output& out, const Mesh& mesh, const Association& association, const WriteOptions& options,
               std::vector<std::string>& notices);

MeshFile read_nastran(const Bytes& bytes);
void write_nastran(Output& out, const Mesh& mesh, const Association& association, const WriteOptions& options,
                   std::vector<std::string>& notices);
MeshFile read_unv(const Bytes& bytes);
void write_unv(Output& out, const Mesh& mesh, const Association& association, const WriteOptions& options,
               std::vector<std::string>& notices);
MeshFile read_lsdyna(const Bytes& bytes);
void write_lsdyna(Output& out, const Mesh& mesh, const Association& association, const WriteOptions& options,
                  std::vector<std::string>& notices);
MeshFile read_ansys(const Bytes& bytes);
void write_ansys(Output& out, const Mesh& mesh, const Association& association, const WriteOptions& options,
                 std::vector<std::string>& notices);
MeshFile read_nek(const Bytes& bytes);
void write_nek(Output& out, const Mesh& mesh, const Association& association, const WriteOptions& options,
               std::vector<std::string>& notices);
/// file: any.specfem, beside mesh_file and the others.
MeshFile read_specfem(const std::filesystem::path& file, const Fence& fence);
void write_specfem(const std::filesystem::path& file, const Mesh& mesh, const WriteOptions& options,
                   std::vector<std::string>& notices);
/// file: case.foam, beside constant/polyMesh.
MeshFile read_openfoam(const std::filesystem::path& file, const Fence& fence);
void write_openfoam(const std::filesystem::path& file, const Mesh& mesh, const WriteOptions& options,
                    std::vector<std::string>& notices);
MeshFile read_mfem(const Bytes& bytes);
void write_mfem(Output& out, const Mesh& mesh, const Association& association, const WriteOptions& options,
                std::vector<std::string>& notices);
/// Those that have a library of their own (HEXTWIST_HAS_CGNS, HEXTWIST_HAS_HDF5, HEXTWIST_HAS_MED). read_..._here is
/// what the program behind a fence calls (apart.h).
MeshFile read_cgns(const std::filesystem::path& file, const Fence& fence);
MeshFile read_cgns_here(const std::filesystem::path& file, const std::filesystem::path& folder);
void write_cgns(const std::filesystem::path& file, const Mesh& mesh, const WriteOptions& options,
                std::vector<std::string>& notices);
MeshFile read_vtkhdf(const std::filesystem::path& file, const Fence& fence);
MeshFile read_vtkhdf_here(const std::filesystem::path& file, const std::filesystem::path& folder);
void write_vtkhdf(const std::filesystem::path& file, const Mesh& mesh, const Association& association,
                  const WriteOptions& options, std::vector<std::string>& notices);
/// With its data in a file beside it, .h5.
MeshFile read_xdmf(const std::filesystem::path& file, const Fence& fence);
MeshFile read_xdmf_here(const std::filesystem::path& file, const std::filesystem::path& folder);
void write_xdmf(const std::filesystem::path& file, const Mesh& mesh, const Association& association,
                const WriteOptions& options, std::vector<std::string>& notices);
MeshFile read_med(const std::filesystem::path& file, const Fence& fence);
MeshFile read_med_here(const std::filesystem::path& file, const std::filesystem::path& folder);
void write_med(const std::filesystem::path& file, const Mesh& mesh, const WriteOptions& options,
               std::vector<std::string>& notices);

MeshFile read_exodus(const std::filesystem::path& file, const Fence& fence);
/// Of the reader of HDF5 files: it writes them as classic NetCDF.
inline constexpr const char* fenced_hdf5 = "hdf5";
void write_exodus(const std::filesystem::path& file, const Mesh& mesh, const WriteOptions& options,
                  std::vector<std::string>& notices);

// ---- ids ----

/// Where items of a text file stand, for messages: item first + k begins k lines after `at` (binary: at `at`).
struct Run {
  std::size_t first;
  const char* at;
};
/// Throws Error for an item, naming its line.
[[noreturn]] void fail_at_item(const Cursor& cursor, std::span<const Run> runs, std::size_t item,
                               const std::string& what);

/// No file may have ids above this, so that refinements can count on for ever.
inline constexpr std::int64_t highest_readable_id = std::int64_t{1} << 62;

/// The numbering of nodes or hexes: ids in file order are sorted, and looked up.
class Ids {
 public:
  Ids() = default;
  /// `kind` is "node", "element". At an id that occurs twice, is not positive or too large calls fail(position in file
  /// order, message), which throws.
  using Fail = std::function<void(std::size_t item, const std::string& what)>;
  Ids(std::vector<std::int64_t> in_file_order, const char* kind, const Fail& fail);
  Ids(std::vector<std::int64_t> in_file_order, const char* kind, const Cursor& cursor, std::span<const Run> runs)
      : Ids(std::move(in_file_order), kind,
            [&](std::size_t item, const std::string& what) { fail_at_item(cursor, runs, item, what); }) {}

  Index size() const { return static_cast<Index>(ids_.size()); }
  /// Index of an id in ascending order, -1 when there is none.
  Index find(std::int64_t id) const {
    if (contiguous_) return id >= low_ && id - low_ < size() ? static_cast<Index>(id - low_) : -1;
    if (!table_.empty())
      return id >= low_ && id - low_ < static_cast<std::int64_t>(table_.size()) ? table_[id - low_] : -1;
    return find_sorted(id);
  }
  /// Per item in file order its index; empty when the file's order is ascending already.
  const std::vector<Index>& place() const { return place_; }
  /// For Mesh::node_ids and hex_ids: empty when they are 1..n.
  std::vector<std::int64_t> stored() const;
  /// Puts values that are in file order, `n` per item, into ascending order of id.
  template <class T>
  void sort(std::vector<T>& values, std::size_t n = 1) const {
    if (place_.empty()) return;
    std::vector<T> sorted;
    resize_for_overwrite(sorted, values.size());
    for (std::size_t i = 0; i < place_.size(); ++i)
      for (std::size_t k = 0; k < n; ++k) sorted[place_[i] * n + k] = std::move(values[i * n + k]);
    values = std::move(sorted);
  }

 private:
  Index find_sorted(std::int64_t id) const;
  std::vector<std::int64_t> ids_;  // ascending
  std::vector<Index> place_;
  std::vector<Index> table_;  // per id - low_: index, where that is not much larger than ids_
  std::int64_t low_ = 1;
  bool contiguous_ = true;
};

// ---- groups ----

/// Items split by the groups they are in and by a key of their own; classes are numbered by their first item.
struct Classes {
  std::vector<int> of_item;
  std::vector<std::vector<int>> groups;  ///< per class: positions of its groups, ascending
  std::vector<int> key;                  ///< per class
  std::vector<Index> count;              ///< per class: items
};
Classes classify(const std::vector<int>& key_of_item, std::span<const std::span<const Index>> groups);

/// The group of an id, made if there is none; keeps groups sorted by id.
template <class Group>
Group& group_of_id(std::vector<Group>& groups, int id);

/// An id that no group of this kind has.
template <class Group>
int free_id(const std::vector<Group>& groups);

// ---- sides and edges ----

/// The side that each quad (a cycle of nodes) is. Where a quad lies between two hexes, the one from which its cycle
/// turns outwards, else the one with the lower index. hex -1 where no hex has such a face. `lower`: the one with the
/// lower index in any case.
std::vector<Side> oriented_sides(const Mesh& mesh, std::span<const Quad> cycles, std::vector<Side>* lower = nullptr);
/// The same face as a side of the hex with the lower index.
std::vector<Side> lower_sides(const Mesh& mesh, std::span<const Side> sides);
/// Sides to write as quads: those of all side sets, and the faces on surfaces unless a set has the same face from
/// either hex. Ascending.
struct PlannedSides {
  std::vector<Side> sides;
  std::vector<int> surface;                 ///< per side, 0 none
  std::vector<std::vector<Index>> members;  ///< per side set: its sides
};
PlannedSides plan_sides(const Mesh& mesh, const Association& association);
/// Per pair of nodes: is it an edge of a hex?
std::vector<char> are_edges(const Mesh& mesh, std::span<const Edge> pairs);

/// The face that holds these corners (1..8 in the order of the files) of a hex.
constexpr int face_of_file_corners(const std::array<int, 4>& corners) {
  int ones = 7, zeros = 7;  // axes along which all corners are at 1, at 0
  for (const int corner : corners) {
    ones &= file_corner[corner - 1];
    zeros &= ~file_corner[corner - 1];
  }
  for (int axis = 0; axis < 3; ++axis)
    if ((ones | zeros) >> axis & 1) return 2 * axis + (ones >> axis & 1);
  return -1;
}

// ---- points and hexes ----

/// node_id() and hex_id() for loops over everything.
inline std::int64_t id_of(std::span<const std::int64_t> ids, Index index) {
  return ids.empty() ? std::int64_t{index} + 1 : ids[index];
}
/// Ids as a file has them: those of the mesh, or counted from 1 (empty, and a notice) where they are too large.
/// highest, limit: the largest that fits, and that in words. many: "nodes".
std::span<const std::int64_t> ids_in_file(const std::vector<std::int64_t>& ids, const char* kind, const char* many,
                                          std::int64_t highest, const char* limit, std::vector<std::string>& notices);
/// A name without line ends and the like.
std::string one_line(std::string name);
/// Where a name can't be written as it is. what: "block 3", "field".
void say_renamed(const std::string& what, const std::string& name, const std::string& written,
                 std::vector<std::string>& notices);
/// For formats without fields.
void say_no_fields(const Mesh& mesh, const char* format, std::vector<std::string>& notices);
/// x y z of all points, in their memory.
inline std::span<const double> coordinates(std::span<const Vec3> points) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  return {reinterpret_cast<const double*>(points.data()), 3 * points.size()};
}
inline std::span<double> coordinates(std::span<Vec3> points) {
  return {reinterpret_cast<double*>(points.data()), 3 * points.size()};
}
/// Corners in the order of the files, and back: the same permutation.
constexpr Hex in_file_order(const Hex& hex) {
  return {hex[0], hex[1], hex[3], hex[2], hex[4], hex[5], hex[7], hex[6]};
}
static_assert(in_file_order({0, 1, 2, 3, 4, 5, 6, 7}) == file_corner);

// ---- fields ----

/// What component c of n is called where scalars stand for it.
std::string component_name(const std::string& name, int c, int n);
/// Fields for formats that know scalars only: a vector's components become name_x name_y name_z, any other number of
/// components name_1 .. name_n, which is told of the latter. merge_components() puts neighbours with such names
/// together again.
std::vector<Field> split_components(const std::vector<Field>& fields, const std::function<bool(int)>& keep,
                                    std::vector<std::string>& notices);
std::vector<Field> merge_components(std::vector<Field> scalars);

/// Fields are doubles: is a whole number the same as one?
template <class T>
constexpr bool is_exact_double(T value) {
  if constexpr (sizeof(T) < 8 || std::is_floating_point_v<T>) return true;
  auto size = static_cast<std::uint64_t>(value);
  if (std::is_signed_v<T> && value < 0) size = 0 - size;
  return size == 0 || size >> std::countr_zero(size) <= std::uint64_t{1} << 53;
}
/// Where n values of a field were not. name: of the field.
void say_rounded(const std::string& name, std::int64_t n, std::vector<std::string>& notices);
/// Is a field to be written as integers of 64 bits? One of integers, unless a value is none of these.
bool is_whole(const Field& field);

// ---- associations ----

/// Owner of a node, none where the association does not say.
inline Owner owner(const Association& association, Index node) {
  return association.node_owner.empty() ? Owner{} : association.node_owner[node];
}
/// Volume of a hex, 0 where the association does not say.
inline int volume_of(const Association& association, Index hex) {
  return association.hex_volume.empty() ? 0 : association.hex_volume[hex];
}
/// Owners of nodes from elements of one dimension on entities `ids` (0 none), highest dimension first: a node belongs
/// to the entity of its elements of lowest dimension, if that is only one.
void derive_owners(std::vector<Owner>& owners, int dim, std::span<const Index> element_nodes, std::span<const int> ids);
/// Sorts curve edges and surface faces, removes repetitions; makes the association empty when it says nothing.
void tidy(Association& tags);

// ---- inline parts ----

template <class Group>
Group& group_of_id(std::vector<Group>& groups, int id) {
  const auto at = std::ranges::lower_bound(groups, id, {}, &Group::id);
  if (at != groups.end() && at->id == id) return *at;
  Group group;
  group.id = id;
  return *groups.insert(at, std::move(group));
}

template <class Group>
int free_id(const std::vector<Group>& groups) {
  const auto taken = [&](int id) { return std::ranges::find(groups, id, &Group::id) != groups.end(); };
  const int highest = groups.empty() ? 0 : std::ranges::max(groups, {}, &Group::id).id;
  if (highest < std::numeric_limits<int>::max()) return highest + 1;
  int id = 1;
  while (taken(id)) ++id;
  return id;
}

}  // namespace hextwist::io
