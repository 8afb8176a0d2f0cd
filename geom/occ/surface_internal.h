// One face of an OpenCASCADE shape, ready for evaluation and closest points. Included by geom/occ/*.cpp only.
#pragma once

#include <GeomAbs_SurfaceType.hxx>
#include <Geom_Surface.hxx>
#include <TopoDS_Face.hxx>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "hextwist/geom/facets.h"
#include "hextwist/geom/occ/curve_internal.h"
#include "hextwist/geom/occ/trim_internal.h"
#include "hextwist/geom/triangle_tree_internal.h"

namespace hextwist::occ {

/// Integrals over a face whose normal is that of its surface: area, vector area, and a third of the flux of
/// (x - origin), which summed over the faces of a solid is its volume.
struct FaceIntegrals {
  Vec3 origin = Vec3::Zero();
  Vec3 vector_area = Vec3::Zero();
  double area = 0;
  double cone_volume = 0;
};

struct SurfaceFoot {
  double u = 0;
  double v = 0;
  Vec3 point = Vec3::Zero();
  double distance = std::numeric_limits<double>::infinity();
  bool singular = false;  // on a side of the parameter rectangle that is a single point
  bool at_bound = false;  // would go on, but for the end of the parameters
};

class Surface {
 public:
  /// boundaries: of the face oriented forward, in the order of its wires; edges: all edges of the model.
  Surface(const TopoDS_Face& face, std::vector<Boundary> boundaries, const std::vector<std::unique_ptr<Curve>>& edges);

  const char* type() const;
  double tolerance() const { return tolerance_; }
  Vec3 point(double u, double v) const { return from_occ(surface_->Value(u, v)); }
  /// Unit vector along dS/du x dS/dv; its limit where that vanishes; zero where there is no limit (tip of a cone).
  Vec3 normal(double u, double v) const;

  /// As KnowsPeriods::periods().
  std::array<double, 2> periods() const {
    return {wraps_u_ ? natural_u_.max - natural_u_.min : 0, wraps_v_ ? natural_v_.max - natural_v_.min : 0};
  }

  /// The larger principal curvature; 0 where there is none.
  double curvature(double u, double v) const;

  Box box() const;
  const FaceIntegrals& integrals() const;
  /// These are its integrals; before anybody has asked for them.
  void set_integrals(const FaceIntegrals& known) const {
    std::call_once(integrated_, [&] { integrals_ = known; });
  }

  /// seeds as in Model::project.
  void project(std::span<const Vec3> points, std::span<const Parameters> seeds, std::span<Projection> out) const;
  /// Feet are global up to this distance (0 for closed forms).
  double slack() const;
  SurfaceFacets facets() const;

 private:
  struct Tessellation {
    std::vector<Vec3> points;
    std::vector<std::array<double, 2>> uv;
    std::vector<std::array<int, 3>> triangles;
    std::unique_ptr<TriangleTree> tree;
    double deflection = 0;  // no point of the face is farther from its triangle
  };

  bool has_closed_form() const;
  const Tessellation& tessellation() const;
  Tessellation tessellate() const;
  FaceIntegrals integrate() const;
  void into_range(double& u, double& v) const;
  SurfaceFoot at(double u, double v, const Vec3& p) const;
  int closed_form(const Vec3& p, SurfaceFoot (&feet)[2]) const;
  SurfaceFoot closest_on_boundary(const Vec3& p) const;
  SurfaceFoot find_closed_form(const Vec3& p) const;
  template <class Evaluator>
  SurfaceFoot descend(const Evaluator& evaluator, const Vec3& p, double u, double v) const;
  template <class Evaluator>
  SurfaceFoot find(const Evaluator& evaluator, const Vec3& p, const Parameters& seed) const;

  TopoDS_Face face_;              // oriented forward
  Handle(Geom_Surface) surface_;  // basis surface with the face's location applied
  GeomAbs_SurfaceType kind_ = GeomAbs_OtherSurface;
  std::string type_;
  const std::vector<std::unique_ptr<Curve>>& edges_;
  double tolerance_ = 0;
  double scale_ = 0;
  Range natural_u_, natural_v_;             // of the whole surface
  bool wraps_u_ = false, wraps_v_ = false;  // closed, periodic or not
  bool periodic_u_ = false, periodic_v_ = false;
  std::unique_ptr<Trim> trim_;

  mutable std::once_flag tessellated_;
  mutable Tessellation tessellation_;
  mutable std::once_flag boundary_boxed_;
  mutable std::vector<Box> boundary_boxes_;
  mutable std::once_flag integrated_;
  mutable FaceIntegrals integrals_;
};

}  // namespace hextwist::occ
