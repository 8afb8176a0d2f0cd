// VTK's unstructured grids, legacy and XML: cells and arrays before they become a mesh.
#pragma once

#include <optional>

#include "hextwist/io/middles.h"
#include "hextwist/mesh/others.h"

namespace hextwist::io {

/// Number types by their legacy ("unsigned_char") and XML ("UInt8") names.
enum class VtkType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };
/// Throws through the cursor for a type that is not known.
VtkType vtk_type(std::string_view name, const Cursor& cursor);
std::size_t vtk_size(VtkType type);

/// Numbers of a type in memory that need not be aligned.
template <class T>
struct Unaligned {
  const char* data;
  std::size_t n;
  std::size_t size() const { return n; }
  T operator[](std::size_t i) const {
    T value;
    std::memcpy(&value, data + i * sizeof(T), sizeof(T));
    return value;
  }
};

/// An array of numbers. They stay where the file has them, in its type; only what must be decoded (text, base64,
/// compressed, the other byte order) has memory of its own.
struct VtkArray {
  enum class On { node, cell, file } on = On::node;
  std::string name;
  int components = 1;
  bool global_ids = false;  ///< the file says that they are ids
  VtkType type = VtkType::int64;
  std::string_view bytes;          ///< of the numbers, in this machine's order
  std::vector<std::uint64_t> own;  ///< what `bytes` is in, where that is not the file

  VtkArray() = default;
  VtkArray(VtkArray&&) = default;
  VtkArray& operator=(VtkArray&&) = default;

  std::size_t size() const { return bytes.size() / vtk_size(type); }
  bool is_integer() const { return type != VtkType::float32 && type != VtkType::float64; }
  /// Calls f with the numbers in their own type.
  template <class F>
  auto visit(F&& f) const {
    const auto as = [&]<class T>(T) { return f(Unaligned<T>{bytes.data(), size()}); };
    switch (type) {
      case VtkType::int8:
        return as(std::int8_t{});
      case VtkType::uint8:
        return as(std::uint8_t{});
      case VtkType::int16:
        return as(std::int16_t{});
      case VtkType::uint16:
        return as(std::uint16_t{});
      case VtkType::int32:
        return as(std::int32_t{});
      case VtkType::uint32:
        return as(std::uint32_t{});
      case VtkType::int64:
        return as(std::int64_t{});
      case VtkType::uint64:
        return as(std::uint64_t{});
      case VtkType::float32:
        return as(float{});
      case VtkType::float64:
        break;
    }
    return as(double{});
  }
  /// One number; for many there is visit().
  double real(std::size_t i) const {
    return visit([&](auto numbers) { return static_cast<double>(numbers[i]); });
  }
  std::int64_t integer(std::size_t i) const {
    return visit([&](auto numbers) { return static_cast<std::int64_t>(numbers[i]); });
  }
  /// Numbers first, first + 1, ... as integers.
  void copy(std::size_t first, std::span<std::int64_t> to) const {
    visit([&](auto numbers) {
      for (std::size_t i = 0; i < to.size(); ++i) to[i] = static_cast<std::int64_t>(numbers[first + i]);
    });
  }
  /// Copies the numbers to memory of its own, if they have none.
  void keep();
  /// The same as indices, -1 for what is not in 0..n-1.
  void copy_indices(std::size_t first, std::span<Index> to, Index n) const {
    visit([&](auto numbers) {
      using T = decltype(numbers[0]);
      const T end = static_cast<T>(n);
      const bool all_less = static_cast<Index>(end) != n;  // n is more than T can say
      for (std::size_t i = 0; i < to.size(); ++i) {
        const T value = numbers[first + i];
        to[i] = value >= T{0} && (all_less || value < end) ? static_cast<Index>(value) : -1;
      }
    });
  }
  /// Takes the first number away.
  void drop_first() { bytes.remove_prefix(vtk_size(type)); }
};

/// Takes n numbers as this machine or (cursor.swapped) another one stores them. The file must outlive the array.
void read_vtk_values(Cursor& cursor, VtkType type, std::size_t n, VtkArray& to);
/// The same as text: n numbers, or all up to the end.
void read_vtk_text(Cursor& cursor, VtkType type, std::optional<std::size_t> n, VtkArray& to);
/// Numbers that are made by the reader.
void set_integers(VtkArray& to, const std::vector<std::int64_t>& numbers);

struct VtkContents {
  std::vector<Vec3> points;
  VtkArray connectivity;
  VtkArray ends;  ///< per cell: the end of its nodes in `connectivity`; integers, not checked
  VtkArray types;
  std::vector<VtkArray> arrays;
  std::vector<std::string> notices;  ///< on what was left out
  /// Files before XML 2.1 and legacy 5.1 have the last two middle nodes of edges of Lagrange hexes the other way round.
  bool old_lagrange = false;
};

/// Before the name of an array of ours, as often as a field is called like it: "hextwist_hex_id".
inline constexpr std::string_view made_prefix = "hextwist_";
/// Those of them that a file says it has, where this is the name that says so ("hextwist:made node_id hex_id"); else
/// none.
std::vector<std::string> made_names(VtkArray::On on, std::string_view name);
/// Whether an array of ours is the one that is usually called so.
bool is_made(std::string_view name, std::string_view usual);

/// Cell arrays of other programs that give blocks, the first that is there; and the block that a value means, 0: none.
inline constexpr std::string_view vtk_group_arrays[] = {"MaterialID",    "CellEntityIds",    "medit:ref",
                                                        "gmsh:physical", "gmsh:geometrical", "BlockId"};
inline int vtk_group(double value) {
  return value >= 1 && value < std::numeric_limits<int>::max() && value == std::floor(value) ? static_cast<int>(value)
                                                                                             : 0;
}

/// A cell type for other elements of a shape with so many nodes; 0: none.
int vtk_type_of(OtherShape shape, std::size_t n_nodes);
/// The other way round. Pixels are quads with their last two nodes exchanged.
std::optional<OtherType> vtk_other(std::int64_t type, std::size_t n_nodes);

/// Field data of others is of the whole file, which a mesh has no place for.
void say_file_arrays(std::span<const VtkArray> arrays, std::vector<std::string>& notices);

/// Points from their array. Throws at coordinates that are not finite.
std::vector<Vec3> vtk_points(const VtkArray& array, const Cursor& cursor);
MeshFile assemble_vtk(VtkContents&& contents, const Cursor& cursor);

}  // namespace hextwist::io
