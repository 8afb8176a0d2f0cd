// Tight boxes. OpenCASCADE's are padded, and its optimal ones miss parts of some closed splines.
//
// A coordinate is extreme over a curve at an end or where its derivative vanishes, over a face on its boundary or where
// its gradient vanishes inside. Samples find the places, Newton finishes.
#include <GeomAdaptor_Curve.hxx>
#include <GeomAdaptor_Surface.hxx>
#include <Geom_SphericalSurface.hxx>
#include <algorithm>
#include <cmath>

#include "hextwist/geom/occ/surface_internal.h"

namespace hextwist::occ {

Box Curve::box() const {
  Box box;
  if (degenerate()) {
    box.add(vertex_);
    return box;
  }
  box.add(point(range_.first));
  box.add(point(range_.last));
  if (kind_ == GeomAbs_Line) return box;
  const Polyline& line = polyline();
  const GeomAdaptor_Curve adaptor(curve_);
  // The derivative changes its sign between the neighbours of the best sample: Newton, bisection where it would leave.
  const auto climb = [&](int axis, double sign, double t, double low, double high) {
    for (int iteration = 0; iteration < 60 && high - low > 1e-15 * (std::abs(t) + high - low); ++iteration) {
      gp_Pnt p;
      gp_Vec d1, d2;
      adaptor.D2(t, p, d1, d2);
      const double slope = sign * from_occ(d1)[axis], bend = sign * from_occ(d2)[axis];
      if (slope == 0) break;
      (slope > 0 ? low : high) = t;
      const double newton = bend < 0 ? t - slope / bend : low - 1;
      const double next = newton > low && newton < high ? newton : (low + high) / 2;
      if (next == t) break;
      t = next;
    }
    box.add(point(t));
  };
  const std::size_t last = line.t.size() - 1;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      std::size_t best = 0;
      for (std::size_t i = 1; i <= last; ++i) {
        if (sign * line.p[i][axis] > sign * line.p[best][axis]) best = i;
      }
      box.add(line.p[best]);
      climb(axis, sign, line.t[best], line.t[best > 0 ? best - 1 : 0], line.t[std::min(best + 1, last)]);
      if (range_.period > 0 && best == 0) climb(axis, sign, line.t[last], line.t[last - 1], line.t[last]);
      if (range_.period > 0 && best == last) climb(axis, sign, line.t[0], line.t[0], line.t[1]);
    }
  }
  return box;
}

Box Surface::box() const {
  Box box;
  for (const Boundary& b : trim_->boundaries()) box.add(edges_[static_cast<std::size_t>(b.edge)]->box());
  // On ruled surfaces every point lies on a straight line between points of the boundary.
  if (kind_ == GeomAbs_Plane || kind_ == GeomAbs_Cylinder || kind_ == GeomAbs_Cone ||
      kind_ == GeomAbs_SurfaceOfExtrusion) {
    return box;
  }
  const auto add = [&](double u, double v) {
    into_range(u, v);
    if (trim_->inside(u, v)) box.add(point(u, v));
  };
  if (kind_ == GeomAbs_Sphere) {
    const gp_Sphere sphere = static_cast<const Geom_SphericalSurface*>(surface_.get())->Sphere();
    const Vec3 centre = from_occ(sphere.Location());
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {-1.0, 1.0}) {
        SurfaceFoot feet[2];
        closed_form(centre + sign * 2 * sphere.Radius() * Vec3::Unit(axis), feet);
        if (trim_->inside(feet[0].u, feet[0].v)) box.add(feet[0].point);
      }
    }
    return box;
  }
  constexpr int n = 32;
  const Range ru = trim_->u(), rv = trim_->v();
  const GeomAdaptor_Surface adaptor(surface_);
  struct Sample {
    double u, v;
    Vec3 p;
  };
  std::vector<Sample> samples;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const double u = ru.min + (ru.max - ru.min) * i / n, v = rv.min + (rv.max - rv.min) * j / n;
      if (trim_->inside(u, v)) samples.push_back({u, v, from_occ(adaptor.Value(u, v))});
    }
  }
  for (int axis = 0; axis < 3 && !samples.empty(); ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      const auto best = std::max_element(samples.begin(), samples.end(), [&](const Sample& a, const Sample& b) {
        return sign * a.p[axis] < sign * b.p[axis];
      });
      box.add(best->p);
      double u = best->u, v = best->v, value = sign * best->p[axis];
      for (int iteration = 0; iteration < 40; ++iteration) {
        gp_Pnt p;
        gp_Vec su, sv, suu, svv, suv;
        adaptor.D2(u, v, p, su, sv, suu, svv, suv);
        const double gu = sign * from_occ(su)[axis], gv = sign * from_occ(sv)[axis];
        const double a = sign * from_occ(suu)[axis], b = sign * from_occ(suv)[axis], c = sign * from_occ(svv)[axis];
        const double det = a * c - b * b;
        if (!(a < 0 && det > 0)) break;  // not a maximum: it lies on the boundary
        double du = -(c * gu - b * gv) / det, dv = -(a * gv - b * gu) / det;
        du = std::clamp(du, -(ru.max - ru.min) / n, (ru.max - ru.min) / n);
        dv = std::clamp(dv, -(rv.max - rv.min) / n, (rv.max - rv.min) / n);
        double next_u = u + du, next_v = v + dv;
        into_range(next_u, next_v);
        const double next = sign * from_occ(adaptor.Value(next_u, next_v))[axis];
        if (!(next > value)) break;
        u = next_u, v = next_v, value = next;
      }
      add(u, v);
    }
  }
  return box;
}

}  // namespace hextwist::occ
