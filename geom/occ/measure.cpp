// Lengths, areas and volumes to about twelve digits; OpenCASCADE's own stop at seven on splines.
//
// An integral over a face is taken around its boundary in the parameter plane (Green's theorem):
//   double integral of f du dv = integral around the boundary of F dv,  F(u, v) = integral of f from u_min to u,
// by Gauss's rule along u between the knots and adaptively along the boundary.
#include <BRepGProp.hxx>
#include <GProp_GProps.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_Line.hxx>
#include <GeomAdaptor_Curve.hxx>
#include <GeomAdaptor_Surface.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <algorithm>
#include <cmath>
#include <math.hxx>
#include <math_Vector.hxx>

#include "hextwist/geom/occ/surface_internal.h"

namespace hextwist::occ {
namespace {

using Sum = Eigen::Matrix<double, 5, 1>;  // area, vector area, cone volume

constexpr int n_gauss = 16;

struct GaussRule {
  std::array<double, n_gauss> x{}, w{};  // on 0..1
};

const GaussRule& gauss() {
  static const GaussRule rule = [] {
    math_Vector x(1, n_gauss), w(1, n_gauss);
    math::GaussPoints(n_gauss, x);
    math::GaussWeights(n_gauss, w);
    GaussRule r;
    for (int i = 0; i < n_gauss; ++i) {
      r.x[static_cast<std::size_t>(i)] = 0.5 + 0.5 * x(i + 1);
      r.w[static_cast<std::size_t>(i)] = 0.5 * w(i + 1);
    }
    return r;
  }();
  return rule;
}

template <class Function>
auto integrate_smooth(double a, double b, const Function& f) {
  const GaussRule& rule = gauss();
  auto sum = (rule.w[0] * f(a + rule.x[0] * (b - a))).eval();
  for (std::size_t i = 1; i < n_gauss; ++i) sum += rule.w[i] * f(a + rule.x[i] * (b - a));
  return ((b - a) * sum).eval();
}

template <class Value, class Function>
Value integrate_adaptively(double a, double b, const Value& whole, const Value& tolerance, int depth,
                           const Function& f) {
  const double m = (a + b) / 2;
  const Value left = integrate_smooth(a, m, f), right = integrate_smooth(m, b, f);
  if (depth == 0 || ((left + right - whole).cwiseAbs().array() <= tolerance.array()).all()) return left + right;
  return integrate_adaptively(a, m, left, tolerance, depth - 1, f) +
         integrate_adaptively(m, b, right, tolerance, depth - 1, f);
}

// The ends of smooth pieces, none longer than `longest`, between min and max.
std::vector<double> pieces(const TColStd_Array1OfReal& knots, const Range& range, double longest) {
  std::vector<double> ends{range.min, range.max};
  for (const double knot : knots) {
    if (knot > range.min && knot < range.max) ends.push_back(knot);
  }
  std::sort(ends.begin(), ends.end());
  std::vector<double> result{ends[0]};
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const int n = std::max(1, static_cast<int>(std::ceil((ends[i + 1] - ends[i]) / longest - 1e-9)));
    for (int k = 1; k <= n; ++k) result.push_back(ends[i] + (ends[i + 1] - ends[i]) * k / n);
  }
  return result;
}

}  // namespace

double Curve::length() const {
  if (degenerate()) return 0;
  const GeomAdaptor_Curve adaptor(curve_, range_.first, range_.last);
  TColStd_Array1OfReal knots(1, adaptor.NbIntervals(GeomAbs_CN) + 1);
  adaptor.Intervals(knots, GeomAbs_CN);
  using One = Eigen::Matrix<double, 1, 1>;
  const auto speed = [&](double t) { return One(adaptor.DN(t, 1).Magnitude()); };
  const std::vector<double> ends = pieces(knots, {range_.first, range_.last}, (range_.last - range_.first) / 4);
  double sum = 0;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const One whole = integrate_smooth(ends[i], ends[i + 1], speed);
    sum += integrate_adaptively(ends[i], ends[i + 1], whole, One(1e-13 * scale_), 12, speed)[0];
  }
  return sum;
}

const FaceIntegrals& Surface::integrals() const {
  std::call_once(integrated_, [this] { integrals_ = integrate(); });
  return integrals_;
}

FaceIntegrals Surface::integrate() const {
  FaceIntegrals result;
  const Range u = trim_->u(), v = trim_->v();
  result.origin = point(u.min, v.min);
  if (!trim_->closed()) {
    // No closed way around: OpenCASCADE's sums, the vector area from how the volume depends on the origin.
    const auto volume = [&](const Vec3& origin) {
      GProp_GProps properties(to_occ(origin));
      BRepGProp::VolumeProperties(face_, properties, 1e-9);
      return properties.Mass();
    };
    GProp_GProps properties;
    BRepGProp::SurfaceProperties(face_, properties, 1e-9);
    result.area = std::abs(properties.Mass());
    result.cone_volume = volume(result.origin);
    for (int axis = 0; axis < 3; ++axis) {
      result.vector_area[axis] = 3 * (result.cone_volume - volume(result.origin + scale_ * Vec3::Unit(axis))) / scale_;
    }
    return result;
  }
  const GeomAdaptor_Surface adaptor(surface_);
  TColStd_Array1OfReal u_knots(1, adaptor.NbUIntervals(GeomAbs_CN) + 1);
  adaptor.UIntervals(u_knots, GeomAbs_CN);
  const bool turns = kind_ == GeomAbs_Cylinder || kind_ == GeomAbs_Cone || kind_ == GeomAbs_Sphere ||
                     kind_ == GeomAbs_Torus || kind_ == GeomAbs_SurfaceOfRevolution;
  const double longest = turns ? M_PI / 2 : u.max - u.min;
  const std::vector<double> u_ends = pieces(u_knots, u, longest > 0 ? longest : 1);
  double size = 0;

  const auto density = [&](double a, double b) {
    gp_Pnt p;
    gp_Vec su, sv;
    adaptor.D1(a, b, p, su, sv);
    const Vec3 n = from_occ(su.Crossed(sv)), r = from_occ(p) - result.origin;
    size = std::max(size, r.cwiseAbs().maxCoeff());
    Sum s;
    s << n.norm(), n, r.dot(n) / 3;
    return s;
  };
  const auto up_to = [&](double a, double b) {  // F
    Sum sum = Sum::Zero();
    for (std::size_t i = 0; i + 1 < u_ends.size(); ++i) {
      const double end = i + 2 < u_ends.size() ? std::min(a, u_ends[i + 1]) : a;
      if (i > 0 && end <= u_ends[i]) break;
      sum += integrate_smooth(u_ends[i], end, [&](double x) { return density(x, b); });
    }
    return sum;
  };
  TColStd_Array1OfReal v_knots(1, adaptor.NbVIntervals(GeomAbs_CN) + 1);
  adaptor.VIntervals(v_knots, GeomAbs_CN);

  Sum total = Sum::Zero();
  const auto add = [&](const std::vector<double>& ends, const auto& f, double sign) {
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
      const Sum whole = integrate_smooth(ends[i], ends[i + 1], f);
      const double area = size * size;
      Sum tolerance;
      tolerance << area, area, area, area, area * size;
      total += sign * integrate_adaptively(ends[i], ends[i + 1], whole, Sum(1e-13 * tolerance), 10, f);
    }
  };
  if (trim_->boundaries().empty()) {
    add(
        pieces(v_knots, v, (v.max - v.min) / 2), [&](double b) { return up_to(u.max, b); }, 1);
  }
  for (const Boundary& b : trim_->boundaries()) {
    const auto line = Handle(Geom2d_Line)::DownCast(b.curve);
    if (!line.IsNull() && std::abs(line->Direction().Y()) <= 1e-15) continue;  // dv = 0
    std::vector<double> knots;
    if (!line.IsNull()) {
      for (const double knot : v_knots) knots.push_back((knot - line->Location().Y()) / line->Direction().Y());
    } else if (const auto spline = Handle(Geom2d_BSplineCurve)::DownCast(b.curve)) {
      for (int i = 1; i <= spline->NbKnots(); ++i) knots.push_back(spline->Knot(i));
    } else {
      knots.push_back(b.first);
    }
    const TColStd_Array1OfReal array(knots[0], 1, static_cast<int>(knots.size()));
    const double quarter = (b.last - b.first) / 4;
    add(
        pieces(array, {b.first, b.last}, turns || line.IsNull() ? quarter : b.last - b.first),
        [&](double t) {
          gp_Pnt2d p;
          gp_Vec2d d;
          b.curve->D1(t, p, d);
          return (d.Y() * up_to(p.X(), p.Y())).eval();
        },
        b.reversed ? -1 : 1);
  }
  result.area = std::abs(total[0]);
  result.vector_area = total.segment<3>(1);
  result.cone_volume = total[4];
  return result;
}

}  // namespace hextwist::occ
