// VTK's unstructured grids, legacy and XML: cells and arrays before they become a mesh.
#pragma once

#include "hextwist/mesh/io_internal.h"

namespace hextwist::io {

/// An array of numbers; integer types keep their integers.
struct VtkArray {
  enum class On { node, cell, file } on = On::node;
  std::string name;
  int components = 1;
  bool integer = false;
  std::vector<double> reals;
  std::vector<std::int64_t> integers;

  std::size_t size() const { return integer ? integers.size() : reals.size(); }
  double real(std::size_t i) const { return integer ? static_cast<double>(integers[i]) : reals[i]; }
};

struct VtkContents {
  std::vector<Vec3> points;
  std::vector<std::int64_t> connectivity;
  std::vector<std::int64_t> offsets;  ///< n_cells + 1
  std::vector<int> types;
  std::vector<VtkArray> arrays;
};

/// Number types by their legacy ("unsigned_char") and XML ("UInt8") names.
enum class VtkType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };
/// Throws through the cursor for a type that is not known.
VtkType vtk_type(std::string_view name, const Cursor& cursor);
std::size_t vtk_size(VtkType type);
/// Reads n values as the machine (or, swapped, another one) stores them.
void read_vtk_values(Cursor& cursor, VtkType type, std::size_t n, VtkArray& to);
/// The same as text.
void read_vtk_text(Cursor& cursor, VtkType type, std::size_t n, VtkArray& to);

/// Points from their array. Throws at coordinates that are not finite.
std::vector<Vec3> vtk_points(const VtkArray& array, const Cursor& cursor);
MeshFile assemble_vtk(VtkContents&& contents, const Cursor& cursor);

}  // namespace hextwist::io
