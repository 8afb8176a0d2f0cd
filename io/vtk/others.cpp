// Cell types of VTK for elements beside the hexes.
#include "hextwist/io/vtk/vtk_internal.h"

namespace hextwist::io {
namespace {

struct VtkCellType {
  int type;
  OtherShape shape;
  int n_nodes;
};
constexpr VtkCellType vtk_cell_types[] = {
    {1, OtherShape::point, 1},     {3, OtherShape::line, 2},      {5, OtherShape::triangle, 3},
    {9, OtherShape::quad, 4},      {8, OtherShape::quad, 4},      {10, OtherShape::tetrahedron, 4},
    {13, OtherShape::wedge, 6},    {14, OtherShape::pyramid, 5},  {21, OtherShape::line, 3},
    {22, OtherShape::triangle, 6}, {34, OtherShape::triangle, 7}, {23, OtherShape::quad, 8},
    {28, OtherShape::quad, 9},     {70, OtherShape::quad, 9},     {24, OtherShape::tetrahedron, 10},
    {26, OtherShape::wedge, 15},   {32, OtherShape::wedge, 18},   {27, OtherShape::pyramid, 13},
};

}  // namespace

int vtk_type_of(OtherShape shape, std::size_t n_nodes) {
  if (shape == OtherShape::connector) return n_nodes == 1 ? 1 : n_nodes == 2 ? 3 : 2;  // many points
  for (const VtkCellType& type : vtk_cell_types)
    if (type.shape == shape && type.n_nodes == static_cast<int>(n_nodes)) return type.type;
  return 0;
}

std::optional<OtherType> vtk_other(std::int64_t type, std::size_t n_nodes) {
  for (const VtkCellType& known : vtk_cell_types)
    if (known.type == type && known.n_nodes == static_cast<int>(n_nodes))
      return OtherType{known.shape, known.n_nodes, ""};
  return std::nullopt;
}

}  // namespace hextwist::io
