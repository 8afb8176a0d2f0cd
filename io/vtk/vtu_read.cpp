// VTK's XML unstructured grids, all at once.
#include "hextwist/io/vtk/vtu_internal.h"

namespace hextwist::io {

MeshFile read_vtu(const Bytes& bytes) {
  VtuFile file(bytes);
  Cursor& cursor = file.cursor();
  VtkContents out;
  out.notices = file.notices();
  out.old_lagrange = file.old_lagrange();
  VtkArray points;
  for (VtuArray& array : file.arrays()) {
    if (array.section == "Points")
      points = file.load(array);
    else if (array.section != "Cells")
      out.arrays.push_back(file.load(array));
  }
  if (points.size() != 3 * file.n_points())
    cursor.fail_at(cursor.end,
                   std::to_string(points.size()) + " coordinates for " + std::to_string(file.n_points()) + " points");
  out.points = vtk_points(points, cursor);
  const auto cells = [&](const char* name) {
    VtuArray* const array = file.find("Cells", name);
    VtkArray numbers = array ? file.load(*array) : VtkArray();
    if (!numbers.is_integer()) cursor.fail_at(cursor.end, std::string(name) + " are not integers");
    return numbers;
  };
  out.connectivity = cells("connectivity");
  out.ends = cells("offsets");
  out.types = cells("types");
  if (out.types.size() != file.n_cells() || out.ends.size() != file.n_cells())
    cursor.fail_at(cursor.end, "offsets or types do not fit " + std::to_string(file.n_cells()) + " cells");
  return assemble_vtk(std::move(out), cursor);
}

}  // namespace hextwist::io
