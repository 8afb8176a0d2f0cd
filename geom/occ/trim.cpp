#include "hextwist/geom/occ/trim_internal.h"

#include <BRepClass_FaceClassifier.hxx>
#include <BRepTools.hxx>
#include <algorithm>
#include <cmath>

namespace hextwist::occ {
namespace {

// Distance of (u, v) from segment ab, and where on it.
struct Near {
  double distance;
  double fraction;
};
Near distance_to_segment(double u, double v, double au, double av, double bu, double bv) {
  const double du = bu - au, dv = bv - av;
  const double length2 = du * du + dv * dv;
  const double f = length2 > 0 ? std::clamp(((u - au) * du + (v - av) * dv) / length2, 0.0, 1.0) : 0.0;
  return {std::hypot(au + f * du - u, av + f * dv - v), f};
}

}  // namespace

Trim::Trim(const TopoDS_Face& face, const Handle(Geom_Surface) & surface, std::vector<Boundary> boundaries,
           double tolerance)
    : face_(face), surface_(surface), boundaries_(std::move(boundaries)), tolerance_(tolerance) {
  BRepTools::UVBounds(face, u_.min, u_.max, v_.min, v_.max);
  if (u_.max > u_.min) scale_u_ = 1 / (u_.max - u_.min);
  if (v_.max > v_.min) scale_v_ = 1 / (v_.max - v_.min);
  std::vector<std::size_t> starts;
  for (int i = 0; i < static_cast<int>(boundaries_.size()); ++i) {
    starts.push_back(segments_.size());
    sample(i);
  }
  starts.push_back(segments_.size());
  if (!segments_.empty()) {
    Range u{segments_[0].au, segments_[0].au}, v{segments_[0].av, segments_[0].av};
    for (const Segment& s : segments_) {
      u = {std::min({u.min, s.au, s.bu}), std::max({u.max, s.au, s.bu})};
      v = {std::min({v.min, s.av, s.bv}), std::max({v.max, s.av, s.bv})};
    }
    u_ = {u.min / scale_u_, u.max / scale_u_};
    v_ = {v.min / scale_v_, v.max / scale_v_};
  }
  close_gaps(starts);
  rectangle_ = find_rectangle();
  sort_into_slabs();
}

void Trim::sample(int boundary) {
  const Boundary& b = boundaries_[static_cast<std::size_t>(boundary)];
  const int n = 8;
  double t = b.reversed ? b.last : b.first;
  gp_Pnt2d p = scaled(b.curve->Value(t));
  for (int i = 1; i <= n; ++i) {
    const double s = static_cast<double>(b.reversed ? n - i : i) / n;
    const double next = s == 1 ? b.last : b.first + s * (b.last - b.first);
    const gp_Pnt2d q = scaled(b.curve->Value(next));
    sample(boundary, t, p, next, q, 0);
    t = next;
    p = q;
  }
}

void Trim::sample(int boundary, double ta, const gp_Pnt2d& a, double tb, const gp_Pnt2d& b, int depth) {
  const Boundary& line = boundaries_[static_cast<std::size_t>(boundary)];
  double stray = 0;
  for (const double s : {0.25, 0.5, 0.75}) {
    const gp_Pnt2d q = scaled(line.curve->Value(ta + s * (tb - ta)));
    stray = std::max(stray, distance_to_segment(q.X(), q.Y(), a.X(), a.Y(), b.X(), b.Y()).distance);
  }
  if (depth < 6 && stray > 1e-4) {
    const double tm = (ta + tb) / 2;
    const gp_Pnt2d m = scaled(line.curve->Value(tm));
    sample(boundary, ta, a, tm, m, depth + 1);
    sample(boundary, tm, m, tb, b, depth + 1);
    return;
  }
  segments_.push_back({a.X(), a.Y(), b.X(), b.Y(), ta, tb, 2 * stray + 1e-9, boundary});
}

// Boundaries meet at vertices up to a tolerance only; crossings are counted exactly when their polygons are closed.
void Trim::close_gaps(const std::vector<std::size_t>& starts) {
  std::size_t loop = 0;  // first segment of the loop that is being walked
  for (std::size_t i = 0; i + 1 < starts.size(); ++i) {
    Segment& last = segments_[starts[i + 1] - 1];
    const bool same_wire = i + 2 < starts.size() && boundaries_[i].wire == boundaries_[i + 1].wire;
    const std::size_t next = same_wire ? starts[i + 1] : loop;
    const double gap = std::hypot(segments_[next].au - last.bu, segments_[next].av - last.bv);
    if (gap > 1e-3) ordered_ = false;
    last.bu = segments_[next].au;
    last.bv = segments_[next].av;
    last.slack += gap;
    if (next == loop) loop = starts[i + 1];
  }
}

bool Trim::find_rectangle() const {
  if (segments_.empty()) return true;
  if (!ordered_) return false;
  const Range u{u_.min * scale_u_, u_.max * scale_u_}, v{v_.min * scale_v_, v_.max * scale_v_};
  double length = 0;
  for (const Segment& s : segments_) {
    const auto both = [](double a, double b, double side) {
      return std::abs(a - side) <= 1e-9 && std::abs(b - side) <= 1e-9;
    };
    const bool on_u = both(s.au, s.bu, u.min) || both(s.au, s.bu, u.max);
    const bool on_v = both(s.av, s.bv, v.min) || both(s.av, s.bv, v.max);
    if (!on_u && !on_v) return false;
    length += std::abs(s.bu - s.au) + std::abs(s.bv - s.av);
  }
  const double around = 2 * (u.max - u.min + v.max - v.min);
  return std::abs(length - around) <= 1e-6 * around;
}

std::size_t Trim::slab(double v) const {
  const double n = static_cast<double>(slab_start_.size() - 1);
  const double x = (v - v_.min * scale_v_) * n;
  return static_cast<std::size_t>(std::clamp(std::floor(x), 0.0, n - 1));
}

void Trim::sort_into_slabs() {
  const std::size_t n = std::clamp<std::size_t>(segments_.size(), 1, 512);
  slab_start_.assign(n + 1, 0);
  const auto first = [&](const Segment& s) { return slab(std::min(s.av, s.bv) - s.slack); };
  const auto last = [&](const Segment& s) { return slab(std::max(s.av, s.bv) + s.slack); };
  for (const Segment& s : segments_) {
    for (std::size_t k = first(s); k <= last(s); ++k) ++slab_start_[k + 1];
  }
  for (std::size_t k = 0; k < n; ++k) slab_start_[k + 1] += slab_start_[k];
  slab_segment_.resize(static_cast<std::size_t>(slab_start_[n]));
  std::vector<int> next(slab_start_.begin(), slab_start_.end() - 1);
  for (int i = 0; i < static_cast<int>(segments_.size()); ++i) {
    const Segment& s = segments_[static_cast<std::size_t>(i)];
    for (std::size_t k = first(s); k <= last(s); ++k) slab_segment_[static_cast<std::size_t>(next[k]++)] = i;
  }
}

bool Trim::inside_rectangle(double u, double v) const {
  const double cu = std::clamp(u, u_.min, u_.max), cv = std::clamp(v, v_.min, v_.max);
  if (cu == u && cv == v) return true;
  return surface_->Value(u, v).Distance(surface_->Value(cu, cv)) <= tolerance_;
}

// Which side of the boundary curve itself.
bool Trim::near_boundary_inside(double u, double v, const Segment& segment) const {
  const Boundary& b = boundaries_[static_cast<std::size_t>(segment.boundary)];
  const gp_Pnt2d at = scaled({u, v});
  const double f = distance_to_segment(at.X(), at.Y(), segment.au, segment.av, segment.bu, segment.bv).fraction;
  double t = std::clamp(segment.ta + f * (segment.tb - segment.ta), b.first, b.last);
  gp_Pnt2d q;
  gp_Vec2d d1, d2;
  for (int iteration = 0; iteration < 20; ++iteration) {
    b.curve->D2(t, q, d1, d2);
    const gp_Vec2d r(u - q.X(), v - q.Y());
    const double speed2 = d1.SquareMagnitude();
    const double curvature = speed2 - r.Dot(d2);
    if (!(speed2 > 0)) break;
    const double next = std::clamp(t + r.Dot(d1) / (curvature > 0.1 * speed2 ? curvature : speed2), b.first, b.last);
    if (std::abs(next - t) <= 1e-14 * (std::abs(t) + b.last - b.first)) break;
    t = next;
  }
  b.curve->D1(t, q, d1);
  if (surface_->Value(u, v).Distance(surface_->Value(q.X(), q.Y())) <= std::max(tolerance_, b.tolerance)) return true;
  const double end = 1e-9 * (b.last - b.first);
  if (t > b.first + end && t < b.last - end) {
    // Material is on the left of a boundary in its own sense.
    return ((d1.X() * (v - q.Y()) - d1.Y() * (u - q.X())) > 0) != b.reversed;
  }
  BRepClass_FaceClassifier classifier(face_, gp_Pnt2d(u, v), 1e-12);
  return classifier.State() == TopAbs_IN || classifier.State() == TopAbs_ON;
}

bool Trim::inside(double u, double v) const {
  if (rectangle_) return inside_rectangle(u, v);
  if (!ordered_) {
    BRepClass_FaceClassifier classifier(face_, gp_Pnt2d(u, v), 1e-9);
    return classifier.State() == TopAbs_IN || classifier.State() == TopAbs_ON;
  }
  const gp_Pnt2d at = scaled({u, v});
  const std::size_t k = slab(at.Y());
  bool odd = false;
  const Segment* nearest = nullptr;
  double nearest_distance = std::numeric_limits<double>::infinity();
  for (int i = slab_start_[k]; i < slab_start_[k + 1]; ++i) {
    const Segment& s = segments_[static_cast<std::size_t>(slab_segment_[static_cast<std::size_t>(i)])];
    if (at.X() < std::max(s.au, s.bu) + s.slack && at.X() > std::min(s.au, s.bu) - s.slack) {
      const double d = distance_to_segment(at.X(), at.Y(), s.au, s.av, s.bu, s.bv).distance;
      if (d <= s.slack && d < nearest_distance) {
        nearest = &s;
        nearest_distance = d;
      }
    }
    if ((s.av <= at.Y()) != (s.bv <= at.Y())) {
      if (s.au + (at.Y() - s.av) / (s.bv - s.av) * (s.bu - s.au) > at.X()) odd = !odd;
    }
  }
  return nearest ? near_boundary_inside(u, v, *nearest) : odd;
}

}  // namespace hextwist::occ
