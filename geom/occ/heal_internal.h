// What is done to a shape between reading and use. Included by geom/occ/*.cpp only.
#pragma once

#include <TopoDS_Shape.hxx>
#include <string>
#include <unordered_map>
#include <vector>

namespace hextwist::occ {

/// Names by the shape that is shared by all its instances.
using ShapeNames = std::unordered_map<const TopoDS_TShape*, std::string>;

/// A shape on its way to becoming a model.
struct Part {
  TopoDS_Shape shape;
  ShapeNames names;
  std::vector<std::string> notices;
};

int count_solids(const TopoDS_Shape& shape);

/// Sews loose faces and closes their shells to solids; shells inside others become cavities. Leaves the shape as it
/// is, without solids, when no shell closes.
void make_solids(Part& part);

/// Makes touching solids share faces, edges and vertices. tolerance 0: that of the shape. Solids keep their order.
void glue_solids(Part& part, double tolerance);

/// Merges edges shorter than that into those beside them, and takes out faces narrower than that. Leaves the shape as
/// it is where solids would go, change by more, or be broken.
void merge_slivers(Part& part, double length);

}  // namespace hextwist::occ
