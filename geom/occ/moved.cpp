#include <BRepBuilderAPI_Transform.hxx>
#include <Standard_Failure.hxx>
#include <gp_Trsf.hxx>

#include "hextwist/geom/occ/model_internal.h"
#include "hextwist/geom/renumbered_model.h"
#include "hextwist/geom/similarity.h"

namespace hextwist {
namespace {

gp_Trsf transformation(const Similarity& similarity) {
  const Eigen::Matrix3d m = similarity.factor * similarity.turn;
  const Vec3& t = similarity.shift;
  gp_Trsf result;
  result.SetValues(m(0, 0), m(0, 1), m(0, 2), t.x(), m(1, 0), m(1, 1), m(1, 2), t.y(), m(2, 0), m(2, 1), m(2, 2),
                   t.z());
  return result;
}

}  // namespace

std::shared_ptr<const Model> moved(const Model& model, const Similarity& similarity) {
  if (const auto of = renumbering_of(model)) return renumbered(moved(*of->model, similarity), of->renumbering);
  const auto* cad = dynamic_cast<const occ::OccModel*>(&model);
  if (!cad) throw Error("this model is no CAD of OpenCASCADE: it cannot be moved");
  try {
    BRepBuilderAPI_Transform transform(cad->shape(), transformation(similarity));
    const TopoDS_Shape shape = transform.Shape();
    const occ::ShapeMaps before = occ::entity_maps(cad->shape()), after = occ::entity_maps(shape);
    for (int dim = 0; dim <= 3; ++dim) {
      const auto d = static_cast<std::size_t>(dim);
      bool same = before[d].Extent() == after[d].Extent();
      for (int id = 1; same && id <= before[d].Extent(); ++id)
        same = after[d].FindIndex(transform.ModifiedShape(before[d](id))) == id;
      if (!same) throw Error(std::string("OpenCASCADE has lost a ") + dimension_name(dim) + " of the CAD in moving it");
    }
    return std::make_shared<occ::OccModel>(shape, cad->names());
  } catch (const Standard_Failure& failure) {
    throw Error(std::string("OpenCASCADE cannot move this CAD: ") + failure.GetMessageString());
  }
}

}  // namespace hextwist
