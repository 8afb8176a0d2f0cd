// One edge of an OpenCASCADE shape, ready for evaluation and closest points. Included by geom/occ/*.cpp only.
#pragma once

#include <GeomAbs_CurveType.hxx>
#include <Geom_Curve.hxx>
#include <TopoDS_Edge.hxx>
#include <mutex>
#include <span>
#include <vector>

#include "hextwist/geom/model.h"

namespace hextwist::occ {

inline gp_Pnt to_occ(const Vec3& p) {
  return {p.x(), p.y(), p.z()};
}
inline Vec3 from_occ(const gp_Pnt& p) {
  return {p.X(), p.Y(), p.Z()};
}
inline Vec3 from_occ(const gp_Vec& p) {
  return {p.X(), p.Y(), p.Z()};
}

/// The curve without trimming, an ellipse of equal radii as a circle: same parameters, simpler type.
Handle(Geom_Curve) simplified(Handle(Geom_Curve) curve);

/// A place on a curve and its distance from the point that was asked about.
struct CurveFoot {
  double t = 0;
  Vec3 point = Vec3::Zero();
  double distance = std::numeric_limits<double>::infinity();
};

/// The parameter is that of the edge's 3D curve, whatever the edge's orientation. A degenerate edge (no 3D curve) is
/// its vertex: range 0..1, the same point everywhere.
class Curve {
 public:
  explicit Curve(const TopoDS_Edge& edge);

  bool degenerate() const { return curve_.IsNull(); }
  const char* type() const;
  CurveRange range() const { return range_; }
  double tolerance() const { return tolerance_; }
  Vec3 point(double t) const;
  /// First derivative, zero on a degenerate edge.
  Vec3 derivative(double t) const;
  /// One over the radius; 0 where straight, on a degenerate edge and where the derivative vanishes.
  double curvature(double t) const;
  double length() const;
  Box box() const;

  /// seeds as in Model::project.
  void project(std::span<const Vec3> points, std::span<const Parameters> seeds, std::span<Projection> out) const;
  /// For one point; seed NaN: global.
  CurveFoot closest(const Vec3& p, double seed) const;
  /// Feet are global up to this distance (the sagitta of the polyline that finds the place; 0 for closed forms).
  double slack() const;

 private:
  struct Polyline {
    std::vector<double> t;
    std::vector<Vec3> p;
    double sagitta = 0;  // no point of the curve is farther from its segment
  };

  const Polyline& polyline() const;
  Polyline make_polyline() const;
  double into_range(double t) const;
  CurveFoot closed_form(const Vec3& p) const;
  template <class Evaluator>
  CurveFoot descend(const Evaluator& evaluator, const Vec3& p, double t) const;
  template <class Evaluator>
  CurveFoot find(const Evaluator& evaluator, const Vec3& p, double seed) const;

  Handle(Geom_Curve) curve_;  // basis curve, never a trimmed one; null when degenerate
  GeomAbs_CurveType kind_ = GeomAbs_OtherCurve;
  CurveRange range_;
  double tolerance_ = 0;
  double scale_ = 0;  // rounding of coordinates here
  Vec3 vertex_ = Vec3::Zero();

  mutable std::once_flag polyline_made_;
  mutable Polyline polyline_;
};

}  // namespace hextwist::occ
