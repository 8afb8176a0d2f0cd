// Closest points on edges: closed forms for lines and circles, else a polyline finds the place and Newton finishes.
#include <BRepLib.hxx>
#include <BRep_Tool.hxx>
#include <Eigen/Geometry>
#include <ElCLib.hxx>
#include <GeomAdaptor_Curve.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_Circle.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_Line.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <TopExp.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <cmath>

#include "hextwist/geom/occ/curve_internal.h"
#include "hextwist/geom/segment.h"

namespace hextwist::occ {
namespace {

constexpr double rounding = std::numeric_limits<double>::epsilon();

}  // namespace

Handle(Geom_Curve) simplified(Handle(Geom_Curve) curve) {
  while (const auto trimmed = Handle(Geom_TrimmedCurve)::DownCast(curve)) curve = trimmed->BasisCurve();
  if (const auto ellipse = Handle(Geom_Ellipse)::DownCast(curve)) {
    const double a = ellipse->MajorRadius(), b = ellipse->MinorRadius();
    if (a - b <= 1e-14 * a) return new Geom_Circle(ellipse->Position(), a);
  }
  return curve;
}

Curve::Curve(const TopoDS_Edge& edge) : tolerance_(BRep_Tool::Tolerance(edge)) {
  TopoDS_Vertex first_vertex, last_vertex;
  TopExp::Vertices(edge, first_vertex, last_vertex);
  double first = 0, last = 1;
  if (!BRep_Tool::Degenerated(edge)) {
    curve_ = BRep_Tool::Curve(edge, first, last);
    if (curve_.IsNull() && BRepLib::BuildCurve3d(edge)) curve_ = BRep_Tool::Curve(edge, first, last);
  }
  if (curve_.IsNull()) {
    if (!first_vertex.IsNull()) vertex_ = from_occ(BRep_Tool::Pnt(first_vertex));
    return;
  }
  curve_ = simplified(curve_);
  kind_ = GeomAdaptor_Curve(curve_).GetType();
  range_ = {first, last, 0};
  const Vec3 start = point(first), end = point(last);
  scale_ = std::max({start.cwiseAbs().maxCoeff(), end.cwiseAbs().maxCoeff(), (end - start).norm()});
  const bool same_vertex = first_vertex.IsNull() || first_vertex.IsSame(last_vertex);
  if (same_vertex && (end - start).norm() <= std::max(tolerance_, 1e-12 * scale_) && kind_ != GeomAbs_Line) {
    range_.period = last - first;
  }
}

const char* Curve::type() const {
  if (degenerate()) return "degenerate";
  switch (kind_) {
    case GeomAbs_Line:
      return "line";
    case GeomAbs_Circle:
      return "circle";
    case GeomAbs_Ellipse:
      return "ellipse";
    case GeomAbs_Hyperbola:
      return "hyperbola";
    case GeomAbs_Parabola:
      return "parabola";
    case GeomAbs_BezierCurve:
      return "bezier curve";
    case GeomAbs_BSplineCurve:
      return "bspline curve";
    case GeomAbs_OffsetCurve:
      return "offset curve";
    default:
      return "other curve";
  }
}

Vec3 Curve::point(double t) const {
  return degenerate() ? vertex_ : from_occ(curve_->Value(t));
}

Vec3 Curve::derivative(double t) const {
  return degenerate() ? Vec3::Zero() : from_occ(curve_->DN(t, 1));
}

double Curve::curvature(double t) const {
  if (degenerate() || kind_ == GeomAbs_Line) return 0;
  const Vec3 d1 = from_occ(curve_->DN(t, 1)), d2 = from_occ(curve_->DN(t, 2));
  const double speed = d1.norm();
  return speed > 0 ? d1.cross(d2).norm() / (speed * speed * speed) : 0;
}

double Curve::into_range(double t) const {
  if (range_.period > 0 && !(t >= range_.first && t < range_.last)) {
    t -= range_.period * std::floor((t - range_.first) / range_.period);
    if (!(t < range_.last)) t = range_.first;
  }
  return std::clamp(t, range_.first, range_.last);
}

CurveFoot Curve::closed_form(const Vec3& p) const {
  double t = 0;
  if (kind_ == GeomAbs_Line) {
    t = ElCLib::Parameter(static_cast<const Geom_Line*>(curve_.get())->Lin(), to_occ(p));
  } else {
    // Beyond the ends of an arc the closer end is the one that is closer in angle.
    t = ElCLib::Parameter(static_cast<const Geom_Circle*>(curve_.get())->Circ(), to_occ(p));
    const double turn = 2 * M_PI;
    t -= turn * std::floor((t - range_.first) / turn);
    if (t > range_.last && t - range_.last > range_.first + turn - t) t = range_.first;
  }
  CurveFoot foot;
  foot.t = into_range(t);
  foot.point = point(foot.t);
  foot.distance = (foot.point - p).norm();
  return foot;
}

Curve::Polyline Curve::make_polyline() const {
  Polyline line;
  int n = 24;
  std::vector<double> breaks{range_.first, range_.last};
  if (const auto spline = Handle(Geom_BSplineCurve)::DownCast(curve_)) {
    for (int i = 1; i <= spline->NbKnots(); ++i) {
      const double knot = spline->Knot(i);
      if (knot > range_.first && knot < range_.last) breaks.push_back(knot);
    }
    std::sort(breaks.begin(), breaks.end());
    n = std::max(4, std::min(2 * spline->Degree(), 96 / static_cast<int>(breaks.size() - 1) + 2));
  }
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    for (int k = 0; k < n; ++k) line.t.push_back(breaks[i] + (breaks[i + 1] - breaks[i]) * k / n);
  }
  line.t.push_back(range_.last);
  line.p.reserve(line.t.size());
  for (const double t : line.t) line.p.push_back(point(t));
  // The sagitta is sampled between the nodes; half as much again covers what the samples missed.
  for (std::size_t i = 0; i + 1 < line.t.size(); ++i) {
    for (const double s : {0.25, 0.5, 0.75}) {
      const Vec3 q = point(line.t[i] + s * (line.t[i + 1] - line.t[i]));
      const double f = closest_fraction(line.p[i], line.p[i + 1], q);
      line.sagitta = std::max(line.sagitta, 1.5 * (line.p[i] + f * (line.p[i + 1] - line.p[i]) - q).norm());
    }
  }
  return line;
}

const Curve::Polyline& Curve::polyline() const {
  std::call_once(polyline_made_, [this] { polyline_ = make_polyline(); });
  return polyline_;
}

double Curve::slack() const {
  return degenerate() || kind_ == GeomAbs_Line || kind_ == GeomAbs_Circle ? 0 : polyline().sagitta;
}

// Minimises |C(t) - p|^2 / 2 by Newton's method, Gauss-Newton where the function is not convex, halved until the
// function or (near the end, where its digits are used up) its derivative falls.
template <class Evaluator>
CurveFoot Curve::descend(const Evaluator& evaluator, const Vec3& p, double t) const {
  gp_Pnt c;
  gp_Vec d1, d2;
  t = into_range(t);
  evaluator.D2(t, c, d1, d2);
  Vec3 r = from_occ(c) - p, tangent = from_occ(d1);
  const double resolution = rounding * (scale_ + p.cwiseAbs().maxCoeff());
  for (int iteration = 0; iteration < 40; ++iteration) {
    const double speed2 = tangent.squaredNorm();
    const double gradient = tangent.dot(r), value = r.squaredNorm();
    if (!(speed2 > 0) || gradient == 0) break;
    const double full = speed2 + from_occ(d2).dot(r);
    const bool convex = full > 0.1 * speed2;
    double step = -gradient / (convex ? full : speed2);
    const double noise = 8 * resolution * (std::sqrt(value) + resolution);  // of the value
    bool moved = false;
    for (int halving = 0; halving < 40 && !moved; ++halving, step /= 2) {
      if (std::abs(step) * std::sqrt(speed2) <= resolution) break;
      const double next = into_range(t + step);
      if (next == t) break;
      gp_Pnt next_c;
      gp_Vec next_d1, next_d2;
      evaluator.D2(next, next_c, next_d1, next_d2);
      const Vec3 next_r = from_occ(next_c) - p, next_tangent = from_occ(next_d1);
      const bool falls = next_r.squaredNorm() < value;
      const bool flattens = convex && next_r.squaredNorm() <= value + noise &&
                            std::abs(next_tangent.dot(next_r)) < 0.5 * std::abs(gradient);
      if (!falls && !flattens) continue;
      t = next;
      c = next_c, d2 = next_d2;
      r = next_r, tangent = next_tangent;
      moved = true;
    }
    if (!moved) break;
  }
  return {t, from_occ(c), r.norm()};
}

template <class Evaluator>
CurveFoot Curve::find(const Evaluator& evaluator, const Vec3& p, double seed) const {
  if (kind_ == GeomAbs_Line || kind_ == GeomAbs_Circle) return closed_form(p);
  if (std::isfinite(seed)) return descend(evaluator, p, seed);
  const Polyline& line = polyline();
  const std::size_t n = line.t.size() - 1;
  thread_local std::vector<double> distance;
  distance.resize(n);
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < n; ++i) {
    const double f = closest_fraction(line.p[i], line.p[i + 1], p);
    distance[i] = (line.p[i] + f * (line.p[i + 1] - line.p[i]) - p).squaredNorm();
    best = std::min(best, distance[i]);
  }
  // Every run of segments that may hold the closest point is descended from its closest segment.
  const double limit = std::sqrt(best) * (1 + 1e-12) + 2 * line.sagitta + rounding * scale_;
  CurveFoot foot;
  for (std::size_t i = 0; i < n;) {
    if (distance[i] > limit * limit) {
      ++i;
      continue;
    }
    std::size_t closest = i, end = i;
    for (; end < n && distance[end] <= limit * limit; ++end) {
      if (distance[end] < distance[closest]) closest = end;
    }
    i = end;
    const double f = closest_fraction(line.p[closest], line.p[closest + 1], p);
    const CurveFoot found = descend(evaluator, p, line.t[closest] + f * (line.t[closest + 1] - line.t[closest]));
    if (found.distance < foot.distance) foot = found;
    // A kink at a knot, or the end of the range, is a minimum without zero derivative.
    for (const std::size_t k : {closest, closest + 1}) {
      const double d = (line.p[k] - p).norm();
      if (d < foot.distance) foot = {into_range(line.t[k]), line.p[k], d};
    }
  }
  foot.point = point(foot.t);  // the same digits as Model::point
  return foot;
}

CurveFoot Curve::closest(const Vec3& p, double seed) const {
  if (degenerate()) return {0, vertex_, (vertex_ - p).norm()};
  return find(*curve_, p, seed);
}

void Curve::project(std::span<const Vec3> points, std::span<const Parameters> seeds, std::span<Projection> out) const {
  const auto store = [&](std::size_t i, const CurveFoot& foot) {
    out[i].point = foot.point;
    out[i].parameters = {foot.t, std::numeric_limits<double>::quiet_NaN()};
    out[i].distance = foot.distance;
  };
  const auto seed = [&](std::size_t i) {
    return seeds.empty() ? std::numeric_limits<double>::quiet_NaN() : seeds[i].u;
  };
  if (degenerate() || points.size() < 8) {
    for (std::size_t i = 0; i < points.size(); ++i) store(i, closest(points[i], seed(i)));
    return;
  }
  const GeomAdaptor_Curve adaptor(curve_);  // caches spline spans, so it is no member: one per call
  for (std::size_t i = 0; i < points.size(); ++i) store(i, find(adaptor, points[i], seed(i)));
}

}  // namespace hextwist::occ
