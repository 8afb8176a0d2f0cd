#include "hextwist/mesh/fill/facts_internal.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "hextwist/geom/periods.h"

namespace hextwist::fill {
namespace {

constexpr int n_samples = 128;  // along a curve

CurveFacts curve_facts(const Model& model, int id) {
  CurveFacts facts;
  const std::vector<int> vertices = model.adjacent({1, id}, 0);
  const CurveRange range = model.range(id);
  const double size = model.box().diagonal();
  facts.is_point = !(model.measure({1, id}) > 1e-12 * size);
  if (vertices.empty()) return facts;
  facts.first = facts.last = vertices.front();
  if (vertices.size() > 1) {
    const Vec3 start = model.point({1, id}, {range.first, 0});
    const auto away = [&](int vertex) { return (model.point({0, vertex}, {}) - start).squaredNorm(); };
    facts.last = vertices[1];
    if (away(facts.last) < away(facts.first)) std::swap(facts.first, facts.last);
  }
  Vec3 before = Vec3::Zero(), direction = Vec3::Zero();
  for (int i = 0; i <= n_samples; ++i) {
    const double t = range.first + (range.last - range.first) * i / n_samples;
    const Vec3 p = model.point({1, id}, {t, 0}), along = model.tangent(id, t);
    if (i > 0) {
      facts.length += (p - before).norm();
      if (along.norm() > 0 && direction.norm() > 0)
        facts.turning += std::acos(std::clamp(along.dot(direction), -1.0, 1.0));
    }
    facts.t.push_back(t);
    facts.s.push_back(facts.length);
    before = p;
    if (along.norm() > 0) direction = along;
  }
  return facts;
}

/// Closed walks along these curves; says what is odd where there are none.
std::vector<Chain> walks(const Facts& facts, std::vector<int> curves, std::string& odd) {
  std::vector<Chain> loops;
  while (!curves.empty()) {
    Chain chain{{curves.front(), true}};
    curves.erase(curves.begin());
    const int begin = facts.start(chain.front());
    for (int at = facts.end(chain.front()); at != begin; at = facts.end(chain.back())) {
      std::vector<Step> next;
      for (const int curve : curves) {
        const CurveFacts& own = facts.curves[curve - 1];
        if (own.first == at)
          next.push_back({curve, true});
        else if (own.last == at)
          next.push_back({curve, false});
      }
      if (next.size() != 1) {
        odd =
            "its rim " + std::string(next.empty() ? "is open" : "touches itself") + " at vertex " + std::to_string(at);
        return {};
      }
      chain.push_back(next.front());
      std::erase(curves, next.front().curve);
    }
    loops.push_back(std::move(chain));
  }
  const auto length = [&](const Chain& chain) {
    return std::accumulate(chain.begin(), chain.end(), 0.0,
                           [&](double sum, const Step& step) { return sum + facts.curves[step.curve - 1].length; });
  };
  std::ranges::stable_sort(loops, std::greater<>(), length);
  return loops;
}

/// The loop from that vertex on; empty where it does not come by.
Chain starting_at(const Facts& facts, Chain loop, int vertex) {
  const auto at = std::ranges::find_if(loop, [&](const Step& step) { return facts.start(step) == vertex; });
  if (at == loop.end()) return {};
  std::ranges::rotate(loop, at);
  return loop;
}

/// How the parameters change on the way round a loop of a tube.
Eigen::Vector2d winding(const Facts& facts, int surface, const Chain& loop) {
  std::vector<Vec3> points = facts.samples(loop, 16);
  points.push_back(points.front());
  const auto uv = unrolled(facts.model, surface, points, Eigen::Vector2d::Constant(std::nan("")));
  return uv.back() - uv.front();
}

/// A torus, or what is closed both ways like one.
void find_torus(const Facts& facts, SurfaceFacts& own) {
  if (own.seams.size() != 2 || own.has_poles || !own.loops.empty()) return;
  int a = own.seams[0], b = own.seams[1];
  const CurveFacts &first = facts.curves[a - 1], &second = facts.curves[b - 1];
  if (!first.is_closed() || !second.is_closed() || first.first != second.first) return;
  if (second.length < first.length) std::swap(a, b);
  own.is_torus = true;
  own.sides = {Chain{{a, true}}, Chain{{b, true}}, Chain{{a, false}}, Chain{{b, false}}};
}

void find_tube(const Facts& facts, int surface, SurfaceFacts& own) {
  if (own.loops.size() != 2 || own.has_poles) return;
  // From one rim along the seams to the other.
  Chain seam, first;
  std::vector<int> left = own.seams;
  int at = 0;
  for (std::size_t i = 0; i < left.size() && first.empty(); ++i)
    for (const bool forward : {true, false}) {
      first = starting_at(facts, own.loops[0], facts.start({left[i], forward}));
      if (first.empty()) continue;
      seam = {{left[i], forward}};
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
      break;
    }
  if (first.empty()) return;
  at = facts.end(seam.back());
  for (bool found = true; found && !left.empty();) {
    found = false;
    for (const int curve : left)
      for (const bool forward : {true, false})
        if (!found && facts.start({curve, forward}) == at) {
          seam.push_back({curve, forward});
          at = facts.end(seam.back());
          found = true;
        }
    if (found) std::erase(left, seam.back().curve);
  }
  Chain second = starting_at(facts, own.loops[1], at);
  if (second.empty() || !left.empty()) return;
  const Eigen::Vector2d a = winding(facts, surface, first), b = winding(facts, surface, second);
  if (a.dot(b) < 0) {
    second = reversed(second);
    second = starting_at(facts, second, at);
  }
  own.is_tube = true;
  own.sides = {first, seam, reversed(second), reversed(seam)};
}

/// Angle inside of the surface where the walk goes from one curve to the next; interior to the left: 1, else -1.
double inner_angle(const Facts& facts, int surface, const Step& in, const Step& out, double side) {
  const Model& model = facts.model;
  const auto direction = [&](const Step& step, bool at_end) {
    const CurveRange range = model.range(step.curve);
    const double t = step.forward == at_end ? range.last : range.first;
    return Vec3((step.forward ? 1 : -1) * model.tangent(step.curve, t));
  };
  const Vec3 a = direction(in, true), b = direction(out, false);
  const Vec3 at = model.point({0, facts.start(out)}, {});
  const Vec3 n = model.normal(surface, model.project({2, surface}, at).parameters);
  return std::numbers::pi - side * std::atan2(n.dot(a.cross(b)), a.dot(b));
}

/// 1 where the surface lies to the left of the walk seen against its normal, -1 to the right.
double side_of(const Facts& facts, int surface, const Chain& loop) {
  const Model& model = facts.model;
  const auto length = [&](const Step& step) { return facts.curves[step.curve - 1].length; };
  const Step step = *std::ranges::max_element(loop, {}, length);
  const double t = facts.parameter_at(step.curve, 0.37);  // no place that symmetry would choose
  const Vec3 p = model.point({1, step.curve}, {t, 0});
  const Vec3 n = model.normal(surface, model.project({2, surface}, p).parameters);
  const Vec3 left = n.cross((step.forward ? 1 : -1) * model.tangent(step.curve, t)) * (1e-3 * length(step));
  return model.project({2, surface}, p + left).distance < model.project({2, surface}, p - left).distance ? 1 : -1;
}

void find_corners(const Facts& facts, int surface, SurfaceFacts& own) {
  constexpr double degree = std::numbers::pi / 180;
  if (own.loops.size() != 1 || !own.seams.empty() || own.has_poles || own.loops[0].size() < 4) return;
  const Chain& loop = own.loops[0];
  const std::size_t n = loop.size();
  const double side = side_of(facts, surface, loop);
  std::vector<double> angles(n);
  for (std::size_t i = 0; i < n; ++i) angles[i] = inner_angle(facts, surface, loop[(i + n - 1) % n], loop[i], side);
  // Four vertices may be obtuse corners; of more, corners and places where the rim goes straight on differ clearly.
  const double most = n == 4 ? 160 * degree : 140 * degree;
  std::vector<std::size_t> corners;
  for (std::size_t i = 0; i < n; ++i) {
    if (angles[i] < 10 * degree || angles[i] > 215 * degree) return;
    if (angles[i] < most) corners.push_back(i);
  }
  if (corners.size() != 4) return;
  own.sides.emplace();
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t i = corners[k]; i != corners[(k + 1) % 4]; i = (i + 1) % n) (*own.sides)[k].push_back(loop[i]);
}

struct Circle {
  Vec3 center = Vec3::Zero();
  double radius = 0;  ///< 0: it is none
};
Circle circle(const Facts& facts, const Chain& loop) {
  if (std::ranges::any_of(loop, [&](const Step& step) { return facts.model.type({1, step.curve}) != "circle"; }))
    return {};
  // The mean over the whole length, whatever the curves that it is divided into.
  Circle result;
  double length = 0;
  for (const Step& step : loop) {
    constexpr int n = 32;
    const double own = facts.curves[step.curve - 1].length;
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < n; ++i) sum += facts.point_at(step.curve, (i + 0.5) / n);
    result.center += own / n * sum;
    length += own;
  }
  result.center /= length;
  const std::vector<Vec3> points = facts.samples(loop, 8);
  const double radius = (points.front() - result.center).norm();
  const bool round = std::ranges::all_of(
      points, [&](const Vec3& p) { return std::abs((p - result.center).norm() - radius) < 1e-4 * radius; });
  if (round) result.radius = radius;
  return result;
}

void find_circles(const Facts& facts, int surface, SurfaceFacts& own) {
  if (facts.model.type({2, surface}) != "plane" || own.loops.empty() || own.loops.size() > 2) return;
  const Circle outer = circle(facts, own.loops[0]);
  if (outer.radius == 0) return;
  if (own.loops.size() == 1) {
    own.is_disc = true;
    return;
  }
  const Circle inner = circle(facts, own.loops[1]);
  own.is_annulus = inner.radius > 0 && (inner.center - outer.center).norm() < 1e-4 * outer.radius &&
                   own.loops[0].size() == 1 && own.loops[1].size() == 1;
  own.is_ring =
      inner.radius > 0.25 * outer.radius && (inner.center - outer.center).norm() < 0.3 * (outer.radius - inner.radius);
}

SurfaceFacts surface_facts(const Facts& facts, int id) {
  SurfaceFacts own;
  const std::vector<int> volumes = facts.model.adjacent({2, id}, 3);
  std::vector<int> rim;
  for (const int curve : facts.model.adjacent({2, id}, 1)) {
    if (facts.curves[curve - 1].is_point) {
      own.has_poles = true;
      continue;
    }
    const std::vector<int> beside = facts.model.adjacent({1, curve}, 2);
    const bool is_seam = std::ranges::none_of(beside, [&](int other) {
      return other != id && std::ranges::binary_search(facts.model.adjacent({2, other}, 3), volumes.front());
    });
    (is_seam ? own.seams : rim).push_back(curve);
  }
  own.loops = walks(facts, rim, own.odd);
  if (!own.odd.empty()) return own;
  if (!own.seams.empty()) {
    find_tube(facts, id, own);
    find_torus(facts, own);
  } else if (!own.has_poles) {
    find_corners(facts, id, own);
    if (!own.sides) find_circles(facts, id, own);
  }
  return own;
}

}  // namespace

Chain reversed(const Chain& chain) {
  Chain result(chain.rbegin(), chain.rend());
  for (Step& step : result) step.forward = !step.forward;
  return result;
}

Facts::Facts(const Model& of, const std::vector<int>& volumes)
    : model(of), curves(static_cast<std::size_t>(of.count(1))), surfaces(static_cast<std::size_t>(of.count(2))) {
  std::vector<char> seen1(curves.size()), seen2(surfaces.size());
  for (const int volume : volumes)
    for (const int curve : model.adjacent({3, volume}, 1))
      if (!seen1[curve - 1]++) curves[curve - 1] = curve_facts(model, curve);
  for (const int volume : volumes)
    for (const int surface : model.adjacent({3, volume}, 2))
      if (!seen2[surface - 1]++) surfaces[surface - 1] = surface_facts(*this, surface);
}

double Facts::parameter_at(int curve, double part) const {
  const CurveFacts& own = curves[curve - 1];
  const double s = part * own.length;
  const auto above = std::ranges::upper_bound(own.s, s);
  if (above == own.s.end()) return own.t.back();
  if (above == own.s.begin()) return own.t.front();
  const auto i = above - own.s.begin();
  const double within = (s - own.s[i - 1]) / (own.s[i] - own.s[i - 1]);
  return own.t[i - 1] + within * (own.t[i] - own.t[i - 1]);
}

Vec3 Facts::point_at(int curve, double part) const {
  return model.point({1, curve}, {parameter_at(curve, part), 0});
}

std::vector<Vec3> Facts::samples(const Chain& chain, int per_curve) const {
  std::vector<Vec3> points;
  for (const Step& step : chain)
    for (int i = 0; i < per_curve; ++i) {
      const double part = static_cast<double>(i) / per_curve;
      points.push_back(point_at(step.curve, step.forward ? part : 1 - part));
    }
  return points;
}

std::vector<Eigen::Vector2d> unrolled(const Model& model, int surface, const std::vector<Vec3>& points,
                                      Eigen::Vector2d from) {
  std::vector<Projection> feet(points.size());
  model.project({2, surface}, points, {}, feet);
  const std::array<double, 2> periods = hextwist::periods(model, surface);
  std::vector<Eigen::Vector2d> result;
  for (const Projection& foot : feet) {
    Eigen::Vector2d at(foot.parameters.u, foot.parameters.v);
    for (int c = 0; c < 2; ++c)
      if (periods[c] > 0 && !std::isnan(from[c])) at[c] += periods[c] * std::round((from[c] - at[c]) / periods[c]);
    result.push_back(at);
    from = at;
  }
  return result;
}

}  // namespace hextwist::fill
