// Closest points on faces. Planes, cylinders, cones, spheres and tori have closed forms; elsewhere the tessellation
// finds the place and Newton finishes. A foot outside the face's boundary gives way to the closest point of the
// boundary or to another foot.
#include <BRepBuilderAPI_Copy.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <ElSLib.hxx>
#include <GeomAdaptor_Surface.hxx>
#include <GeomLProp_SLProps.hxx>
#include <Geom_Circle.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Plane.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <Poly_Triangulation.hxx>
#include <Standard_Failure.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <cmath>

#include "hextwist/geom/occ/surface_internal.h"

namespace hextwist::occ {
namespace {

constexpr double surface_rounding = std::numeric_limits<double>::epsilon();

const char* type_name(GeomAbs_SurfaceType kind) {
  switch (kind) {
    case GeomAbs_Plane:
      return "plane";
    case GeomAbs_Cylinder:
      return "cylinder";
    case GeomAbs_Cone:
      return "cone";
    case GeomAbs_Sphere:
      return "sphere";
    case GeomAbs_Torus:
      return "torus";
    case GeomAbs_BezierSurface:
      return "bezier surface";
    case GeomAbs_BSplineSurface:
      return "bspline surface";
    case GeomAbs_SurfaceOfRevolution:
      return "surface of revolution";
    case GeomAbs_SurfaceOfExtrusion:
      return "surface of extrusion";
    case GeomAbs_OffsetSurface:
      return "offset surface";
    default:
      return "other surface";
  }
}

// A circle extruded along its axis is a cylinder with the same parameters; exporters write it often.
Handle(Geom_Surface) simplified(Handle(Geom_Surface) surface) {
  while (const auto trimmed = Handle(Geom_RectangularTrimmedSurface)::DownCast(surface)) {
    surface = trimmed->BasisSurface();
  }
  if (const auto extrusion = Handle(Geom_SurfaceOfLinearExtrusion)::DownCast(surface)) {
    if (const auto circle = Handle(Geom_Circle)::DownCast(occ::simplified(extrusion->BasisCurve()))) {
      const gp_Ax2 axes = circle->Position();
      if (extrusion->Direction().IsParallel(axes.Direction(), 1e-12)) {
        gp_Ax3 frame(axes);
        if (extrusion->Direction().Dot(axes.Direction()) < 0) frame.ZReverse();
        return new Geom_CylindricalSurface(frame, circle->Radius());
      }
    }
  }
  return surface;
}

}  // namespace

Surface::Surface(const TopoDS_Face& face, std::vector<Boundary> boundaries,
                 const std::vector<std::unique_ptr<Curve>>& edges)
    : face_(TopoDS::Face(face.Oriented(TopAbs_FORWARD))), edges_(edges), tolerance_(BRep_Tool::Tolerance(face)) {
  const Handle(Geom_Surface) original = BRep_Tool::Surface(face_);
  if (original.IsNull()) throw Error("a face of the CAD has no surface");
  surface_ = simplified(original);
  kind_ = GeomAdaptor_Surface(surface_).GetType();
  type_ = type_name(kind_);
  surface_->Bounds(natural_u_.min, natural_u_.max, natural_v_.min, natural_v_.max);
  periodic_u_ = surface_->IsUPeriodic();
  periodic_v_ = surface_->IsVPeriodic();
  wraps_u_ = periodic_u_ || surface_->IsUClosed();
  wraps_v_ = periodic_v_ || surface_->IsVClosed();

  scale_ = 0;
  double boundary_tolerance = tolerance_;
  for (const Boundary& b : boundaries) {
    boundary_tolerance = std::max(boundary_tolerance, b.tolerance);
    for (const double t : {b.first, (b.first + b.last) / 2, b.last}) {
      const gp_Pnt2d uv = b.curve->Value(t);
      scale_ = std::max(scale_, point(uv.X(), uv.Y()).cwiseAbs().maxCoeff());
    }
  }
  if (boundaries.empty() && natural_u_.max - natural_u_.min < 1e100 && natural_v_.max - natural_v_.min < 1e100) {
    for (const double s : {0.1, 0.4, 0.8}) {
      scale_ = std::max(scale_, point(natural_u_.min + s * (natural_u_.max - natural_u_.min),
                                      natural_v_.min + s * (natural_v_.max - natural_v_.min))
                                    .cwiseAbs()
                                    .maxCoeff());
    }
  }
  trim_ = std::make_unique<Trim>(face_, surface_, std::move(boundaries), std::min(boundary_tolerance, 1e-6 * scale_));
}

const char* Surface::type() const {
  return type_.c_str();
}

bool Surface::has_closed_form() const {
  return kind_ <= GeomAbs_Torus;
}

double Surface::curvature(double u, double v) const {
  if (kind_ == GeomAbs_Plane) return 0;
  // In closed form also at poles, where the parameters have no effect.
  if (kind_ == GeomAbs_Cylinder)
    return 1 / static_cast<const Geom_CylindricalSurface*>(surface_.get())->Cylinder().Radius();
  if (kind_ == GeomAbs_Sphere) return 1 / static_cast<const Geom_SphericalSurface*>(surface_.get())->Sphere().Radius();
  GeomLProp_SLProps properties(surface_, u, v, 2, 1e-12);
  if (!properties.IsCurvatureDefined()) return 0;
  return std::max(std::abs(properties.MaxCurvature()), std::abs(properties.MinCurvature()));
}

Vec3 Surface::normal(double u, double v) const {
  gp_Pnt p;
  gp_Vec su, sv;
  const auto cross = [&](double a, double b) -> Vec3 {
    surface_->D1(a, b, p, su, sv);
    const Vec3 n = from_occ(su.Crossed(sv));
    const double size = n.norm();
    // Where a whole side shrinks to a point one derivative is rounding only.
    if (!(size > 1e-9 * (su.SquareMagnitude() + sv.SquareMagnitude()) * 1e-3)) return Vec3::Zero();
    return n / size;
  };
  const Vec3 n = cross(u, v);
  if (n != Vec3::Zero()) return n;
  if (kind_ == GeomAbs_Cone) return n;
  // Limit from inside along the other parameter, if it is the same from two sides.
  const Range ru = trim_->u(), rv = trim_->v();
  const auto inwards = [](double x, const Range& r) {
    return x + 1e-6 * (r.max - r.min) * (x > (r.min + r.max) / 2 ? -1 : 1);
  };
  const double v2 = inwards(v, rv), u2 = inwards(u, ru);
  for (const auto& [a, b, c, d] : {std::array{u, v2, ru.min + 0.3 * (ru.max - ru.min), v2},
                                   std::array{u2, v, u2, rv.min + 0.3 * (rv.max - rv.min)}}) {
    const Vec3 one = cross(a, b), other = cross(c, d);
    if (one != Vec3::Zero() && one.dot(other) > 1 - 1e-6) return (one + other).normalized();
  }
  return Vec3::Zero();
}

void Surface::into_range(double& u, double& v) const {
  const auto wrap = [](double& x, bool wraps, bool periodic, const Range& natural, const Range& face) {
    const double period = natural.max - natural.min;
    if (!periodic) {  // closed or not, it ends there
      if (wraps && !(x >= natural.min && x <= natural.max)) x -= period * std::floor((x - natural.min) / period);
      x = std::clamp(x, natural.min, natural.max);
      return;
    }
    const double low = face.min - 1e-9 * period;
    if (x < low || x > face.max) x -= period * std::floor((x - low) / period);
    // Beyond the face either end may be the closer one.
    if (x > face.max && x - face.max > face.min - (x - period)) x -= period;
  };
  wrap(u, wraps_u_, periodic_u_, natural_u_, trim_->u());
  wrap(v, wraps_v_, periodic_v_, natural_v_, trim_->v());
}

SurfaceFoot Surface::at(double u, double v, const Vec3& p) const {
  into_range(u, v);
  SurfaceFoot foot{u, v, point(u, v), 0};
  foot.distance = (foot.point - p).norm();
  return foot;
}

// All feet that can be a closest point: one, or two on a cone or spindle torus, whose halves meet on the axis.
int Surface::closed_form(const Vec3& p, SurfaceFoot (&feet)[2]) const {
  const gp_Pnt q = to_occ(p);
  double u = 0, v = 0;
  switch (kind_) {
    case GeomAbs_Plane: {
      ElSLib::Parameters(static_cast<const Geom_Plane*>(surface_.get())->Pln(), q, u, v);
      break;
    }
    case GeomAbs_Cylinder: {
      ElSLib::Parameters(static_cast<const Geom_CylindricalSurface*>(surface_.get())->Cylinder(), q, u, v);
      break;
    }
    case GeomAbs_Sphere: {
      const gp_Sphere sphere = static_cast<const Geom_SphericalSurface*>(surface_.get())->Sphere();
      ElSLib::Parameters(sphere, q, u, v);
      break;
    }
    case GeomAbs_Torus: {
      const gp_Torus torus = static_cast<const Geom_ToroidalSurface*>(surface_.get())->Torus();
      const gp_Ax3& frame = torus.Position();
      const gp_Vec r(frame.Location(), q);
      const double x = r.Dot(gp_Vec(frame.XDirection())), y = r.Dot(gp_Vec(frame.YDirection()));
      const double rho = std::hypot(x, y), z = r.Dot(gp_Vec(frame.Direction()));
      u = std::atan2(y, x);
      v = std::atan2(z, rho - torus.MajorRadius());
      if (torus.MinorRadius() <= torus.MajorRadius()) break;
      // A spindle torus (lemon or apple: the heads of screws) crosses its axis, so the circle behind that comes near
      // too.
      feet[0] = at(u, v, p);
      feet[1] = at(u + M_PI, std::atan2(z, -rho - torus.MajorRadius()), p);
      if (feet[1].distance < feet[0].distance) std::swap(feet[0], feet[1]);
      return 2;
    }
    default: {
      const gp_Cone cone = static_cast<const Geom_ConicalSurface*>(surface_.get())->Cone();
      const gp_Ax3& frame = cone.Position();
      const gp_Vec r(frame.Location(), q);
      const double x = r.Dot(gp_Vec(frame.XDirection())), y = r.Dot(gp_Vec(frame.YDirection()));
      const double z = r.Dot(gp_Vec(frame.Direction()));
      const double rho = std::hypot(x, y), s = std::sin(cone.SemiAngle()), c = std::cos(cone.SemiAngle());
      u = x == 0 && y == 0 ? 0 : std::atan2(y, x);
      // The generator is (R + v s, v c) in the half-plane of the point, and in the opposite one.
      feet[0] = at(u, (rho - cone.RefRadius()) * s + z * c, p);
      feet[1] = at(u + M_PI, (-rho - cone.RefRadius()) * s + z * c, p);
      if (feet[1].distance < feet[0].distance) std::swap(feet[0], feet[1]);
      return 2;
    }
  }
  feet[0] = at(u, v, p);
  return 1;
}

SurfaceFoot Surface::closest_on_boundary(const Vec3& p) const {
  std::call_once(boundary_boxed_, [this] {
    for (const Boundary& b : trim_->boundaries()) {
      boundary_boxes_.push_back(edges_[static_cast<std::size_t>(b.edge)]->box());
    }
  });
  SurfaceFoot best;
  for (std::size_t i = 0; i < boundary_boxes_.size(); ++i) {
    const Boundary& b = trim_->boundaries()[i];
    const Box& box = boundary_boxes_[i];
    const Vec3 outside = (box.min - p).cwiseMax(p - box.max).cwiseMax(0.0);
    if (outside.norm() >= best.distance + b.tolerance) continue;
    const Curve& edge = *edges_[static_cast<std::size_t>(b.edge)];
    const CurveFoot foot = edge.closest(p, std::numeric_limits<double>::quiet_NaN());
    if (!(foot.distance < best.distance)) continue;
    const double t = edge.degenerate() ? (b.first + b.last) / 2 : std::clamp(foot.t, b.first, b.last);
    const gp_Pnt2d uv = b.curve->Value(t);
    best = {uv.X(), uv.Y(), point(uv.X(), uv.Y()), 0};
    best.distance = (best.point - p).norm();
  }
  return best;
}

SurfaceFoot Surface::find_closed_form(const Vec3& p) const {
  SurfaceFoot feet[2];
  const int n = closed_form(p, feet);
  if (trim_->inside(feet[0].u, feet[0].v)) return feet[0];
  SurfaceFoot best = closest_on_boundary(p);
  if (n == 2 && feet[1].distance < best.distance && trim_->inside(feet[1].u, feet[1].v)) best = feet[1];
  return best;
}

Surface::Tessellation Surface::tessellate() const {
  // A copy, since the triangles are stored in the face and the face may be the caller's.
  Tessellation result;
  const Range u = trim_->u(), v = trim_->v();
  double size = 0;
  const Vec3 corner = point(u.min, v.min);
  for (const auto& [a, b] : {std::array{0.5, 0.5}, std::array{1.0, 0.0}, std::array{0.0, 1.0}, std::array{1.0, 1.0},
                             std::array{0.25, 0.75}}) {
    size = std::max(size, (point(u.min + a * (u.max - u.min), v.min + b * (v.max - v.min)) - corner).norm());
  }
  Handle(Poly_Triangulation) mesh;
  try {
    const TopoDS_Face copy = TopoDS::Face(BRepBuilderAPI_Copy(face_, false, false).Shape());
    BRepMesh_IncrementalMesh(copy, 2e-3 * size, false, 0.3, false);
    TopLoc_Location location;
    mesh = BRep_Tool::Triangulation(copy, location);
  } catch (const Standard_Failure&) {
    mesh.Nullify();  // the grid below does
  }
  if (!mesh.IsNull() && mesh->HasUVNodes()) {
    for (int i = 1; i <= mesh->NbNodes(); ++i) {
      const gp_Pnt2d uv = mesh->UVNode(i);
      result.uv.push_back({uv.X(), uv.Y()});
    }
    for (int i = 1; i <= mesh->NbTriangles(); ++i) {
      int a = 0, b = 0, c = 0;
      mesh->Triangle(i).Get(a, b, c);
      result.triangles.push_back({a - 1, b - 1, c - 1});
    }
  }
  if (result.triangles.empty()) {
    // The mesher fails on this face: a grid over its parameter box is good enough for finding places.
    constexpr int n = 40;
    result.uv.clear();
    for (int j = 0; j <= n; ++j) {
      for (int i = 0; i <= n; ++i) {
        result.uv.push_back({u.min + (u.max - u.min) * i / n, v.min + (v.max - v.min) * j / n});
      }
    }
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const int a = i + (n + 1) * j;
        result.triangles.push_back({a, a + 1, a + n + 2});
        result.triangles.push_back({a, a + n + 2, a + n + 1});
      }
    }
  }
  for (const auto& [a, b] : result.uv) result.points.push_back(point(a, b));
  for (const auto& [a, b, c] : result.triangles) {
    const auto ia = static_cast<std::size_t>(a), ib = static_cast<std::size_t>(b), ic = static_cast<std::size_t>(c);
    for (const Vec3& w : {Vec3(1. / 3, 1. / 3, 1. / 3), Vec3(0.5, 0.5, 0), Vec3(0, 0.5, 0.5), Vec3(0.5, 0, 0.5)}) {
      const Vec3 flat = w[0] * result.points[ia] + w[1] * result.points[ib] + w[2] * result.points[ic];
      const Vec3 exact = point(w[0] * result.uv[ia][0] + w[1] * result.uv[ib][0] + w[2] * result.uv[ic][0],
                               w[0] * result.uv[ia][1] + w[1] * result.uv[ib][1] + w[2] * result.uv[ic][1]);
      const Vec3 foot = closest_weights(exact, result.points[ia], result.points[ib], result.points[ic]);
      const Vec3 nearest = foot[0] * result.points[ia] + foot[1] * result.points[ib] + foot[2] * result.points[ic];
      result.deflection = std::max(result.deflection, 1.5 * std::min((exact - flat).norm(), (exact - nearest).norm()));
    }
  }
  result.tree = std::make_unique<TriangleTree>(result.points, result.triangles);
  return result;
}

const Surface::Tessellation& Surface::tessellation() const {
  std::call_once(tessellated_, [this] { tessellation_ = tessellate(); });
  return tessellation_;
}

SurfaceFacets Surface::facets() const {
  SurfaceFacets result;
  for (const auto& [u, v] : tessellation().uv) result.points.push_back({u, v});
  for (const auto& [a, b, c] : tessellation().triangles) result.triangles.push_back({a, b, c});
  return result;
}

double Surface::slack() const {
  return has_closed_form() ? 0 : tessellation().deflection;
}

// Minimises |S(u, v) - p|^2 / 2 like Curve::descend. A parameter at its bound stays there while it is pushed out.
template <class Evaluator>
SurfaceFoot Surface::descend(const Evaluator& evaluator, const Vec3& p, double u, double v) const {
  struct State {
    double u, v, value;
    Vec3 r, su, sv, suu, suv, svv;
    double gu, gv;
  };
  const auto evaluate = [&](double a, double b) {
    State s;
    gp_Pnt c;
    gp_Vec su, sv, suu, svv, suv;
    evaluator.D2(a, b, c, su, sv, suu, svv, suv);
    s.u = a, s.v = b;
    s.r = from_occ(c) - p;
    s.su = from_occ(su), s.sv = from_occ(sv);
    s.suu = from_occ(suu), s.suv = from_occ(suv), s.svv = from_occ(svv);
    s.value = s.r.squaredNorm();
    s.gu = s.su.dot(s.r), s.gv = s.sv.dot(s.r);
    return s;
  };
  into_range(u, v);
  State s = evaluate(u, v);
  const double resolution = surface_rounding * (scale_ + p.cwiseAbs().maxCoeff());
  const auto stuck = [&] {
    return std::pair{!wraps_u_ && ((s.u <= natural_u_.min && s.gu > 0) || (s.u >= natural_u_.max && s.gu < 0)),
                     !wraps_v_ && ((s.v <= natural_v_.min && s.gv > 0) || (s.v >= natural_v_.max && s.gv < 0))};
  };
  for (int iteration = 0; iteration < 60; ++iteration) {
    const double a0 = s.su.squaredNorm(), b0 = s.su.dot(s.sv), c0 = s.sv.squaredNorm();
    const auto [stuck_u, stuck_v] = stuck();
    const bool free_u = !stuck_u && a0 > 0, free_v = !stuck_v && c0 > 0;
    if (!free_u && !free_v) break;
    double a = a0 + s.suu.dot(s.r), b = b0 + s.suv.dot(s.r), c = c0 + s.svv.dot(s.r);
    bool convex = (!free_u || a > 1e-2 * a0) && (!free_v || c > 1e-2 * c0);
    if (free_u && free_v) convex = convex && a * c - b * b > 1e-4 * a * c;
    if (!convex) {
      a = a0, b = b0, c = c0;
      if (free_u && free_v && a * c - b * b < 1e-4 * a * c) b = 0;  // nearly parallel derivatives: scaled descent
    }
    double du = 0, dv = 0;
    if (free_u && free_v) {
      const double det = a * c - b * b;
      du = -(c * s.gu - b * s.gv) / det;
      dv = -(a * s.gv - b * s.gu) / det;
    } else if (free_u) {
      du = -s.gu / a;
    } else {
      dv = -s.gv / c;
    }
    const double gradient =
        std::max(s.gu * s.gu / (a0 > 0 ? a0 : 1) * free_u, s.gv * s.gv / (c0 > 0 ? c0 : 1) * free_v);
    const double noise = 8 * resolution * (std::sqrt(s.value) + resolution);  // of the value
    bool moved = false;
    for (int halving = 0; halving < 40 && !moved; ++halving, du /= 2, dv /= 2) {
      if (du * du * a0 + dv * dv * c0 <= 4 * resolution * resolution) break;
      double next_u = s.u + du, next_v = s.v + dv;
      into_range(next_u, next_v);
      if (next_u == s.u && next_v == s.v) break;
      const State next = evaluate(next_u, next_v);
      const bool falls = next.value < s.value;
      const double next_gradient =
          std::max(next.gu * next.gu / (a0 > 0 ? a0 : 1) * free_u, next.gv * next.gv / (c0 > 0 ? c0 : 1) * free_v);
      const bool flattens = convex && next.value <= s.value + noise && next_gradient < 0.25 * gradient;
      if (!falls && !flattens) continue;
      s = next;
      moved = true;
    }
    if (!moved) break;
  }
  SurfaceFoot foot{s.u, s.v, s.r + p, std::sqrt(s.value)};
  const auto [stuck_u, stuck_v] = stuck();
  foot.at_bound = (stuck_u || stuck_v) && foot.distance > 16 * resolution;
  const Range ru = trim_->u(), rv = trim_->v();
  const double a = s.su.norm() * (ru.max - ru.min), b = s.sv.norm() * (rv.max - rv.min);
  foot.singular = std::min(a, b) <= 1e-6 * std::max(a, b);
  return foot;
}

template <class Evaluator>
SurfaceFoot Surface::find(const Evaluator& evaluator, const Vec3& p, const Parameters& seed) const {
  if (std::isfinite(seed.u) && std::isfinite(seed.v)) {
    const SurfaceFoot foot = descend(evaluator, p, seed.u, seed.v);
    // One that ended at a bound may have started at the wrong side of a surface that closes on itself.
    if (trim_->inside(foot.u, foot.v) && !foot.singular && !foot.at_bound) return foot;
  }
  const Tessellation& tess = tessellation();
  thread_local std::vector<NearTriangle> near;
  tess.tree->closest(p, 2 * tess.deflection, near);
  const auto start = [&](const NearTriangle& t, const Vec3& w) {
    const auto& corners = tess.triangles[static_cast<std::size_t>(t.triangle)];
    std::array<double, 2> uv{};
    for (int i = 0; i < 3; ++i) {
      const auto& node = tess.uv[static_cast<std::size_t>(corners[static_cast<std::size_t>(i)])];
      uv[0] += w[i] * node[0];
      uv[1] += w[i] * node[1];
    }
    return uv;
  };
  SurfaceFoot best;
  bool outside = false;
  const auto consider = [&](const SurfaceFoot& foot) {
    if (!trim_->inside(foot.u, foot.v)) {
      outside = true;
    } else if (foot.distance < best.distance) {
      best = foot;
    }
  };
  // One descent per patch of neighbouring candidates, from its closest triangle.
  thread_local std::vector<char> used;
  used.assign(near.size(), 0);
  thread_local std::vector<std::size_t> patch;
  for (std::size_t i = 0; i < near.size(); ++i) {
    if (used[i]) continue;
    if (near[i].distance > best.distance + tess.deflection) break;
    patch.assign(1, i);
    used[i] = 1;
    for (std::size_t k = 0; k < patch.size() && near.size() <= 256; ++k) {
      const auto& corners = tess.triangles[static_cast<std::size_t>(near[patch[k]].triangle)];
      for (std::size_t j = i + 1; j < near.size(); ++j) {
        if (used[j]) continue;
        const auto& others = tess.triangles[static_cast<std::size_t>(near[j].triangle)];
        const bool touch = std::any_of(others.begin(), others.end(), [&](int n) {
          return std::find(corners.begin(), corners.end(), n) != corners.end();
        });
        if (!touch) continue;
        used[j] = 1;
        patch.push_back(j);
      }
    }
    auto uv = start(near[i], near[i].weights);
    SurfaceFoot foot = descend(evaluator, p, uv[0], uv[1]);
    if (foot.singular) {
      // All directions leave from here, but only one was tried.
      for (std::size_t k = 0; k < patch.size() && k < 64; ++k) {
        uv = start(near[patch[k]], Vec3(1, 1, 1) / 3);
        const SurfaceFoot other = descend(evaluator, p, uv[0], uv[1]);
        if (other.distance < foot.distance) foot = other;
      }
    }
    consider(foot);
    if (near.size() > 256) break;  // a centre of curvature: everything is equally close
  }
  if (outside || !std::isfinite(best.distance)) {
    const SurfaceFoot foot = closest_on_boundary(p);
    if (foot.distance < best.distance) best = foot;
  }
  best.point = point(best.u, best.v);  // the same digits as Model::point
  return best;
}

void Surface::project(std::span<const Vec3> points, std::span<const Parameters> seeds,
                      std::span<Projection> out) const {
  const auto store = [&](std::size_t i, const SurfaceFoot& foot) {
    out[i].point = foot.point;
    out[i].parameters = {foot.u, foot.v};
    out[i].distance = foot.distance;
  };
  if (has_closed_form()) {
    for (std::size_t i = 0; i < points.size(); ++i) store(i, find_closed_form(points[i]));
    return;
  }
  const auto seed = [&](std::size_t i) { return seeds.empty() ? Parameters{} : seeds[i]; };
  if (points.size() < 4) {
    for (std::size_t i = 0; i < points.size(); ++i) store(i, find(*surface_, points[i], seed(i)));
    return;
  }
  const GeomAdaptor_Surface adaptor(surface_);  // caches spline patches, so it is no member: one per call
  for (std::size_t i = 0; i < points.size(); ++i) store(i, find(adaptor, points[i], seed(i)));
}

}  // namespace hextwist::occ
