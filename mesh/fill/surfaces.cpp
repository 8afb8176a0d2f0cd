// Quads on surfaces of the CAD: grids by transfinite interpolation (Gordon and Hall 1973) between the parameters of the
// rim, circles on rings, and what pavement.cpp makes of discs and of the plane of the parameters.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "hextwist/base/memory.h"
#include "hextwist/geom/periods.h"
#include "hextwist/mesh/fill/builder_internal.h"

namespace hextwist::fill {
namespace {

using Flat = Eigen::Vector2d;

/// Parameters of nodes along chains, whose curves bend between the nodes: looked at in smaller steps.
std::vector<Flat> parameters_along(const Builder& builder, int surface, const Chain& chain, Flat from) {
  constexpr int finer = 4;
  std::vector<Vec3> points;
  for (const Step& step : chain) {
    const std::vector<Vec3> own = builder.facts.samples({step}, builder.intervals[step.curve - 1] * finer);
    points.insert(points.end(), own.begin(), own.end());
  }
  const Step& last = chain.back();
  points.push_back(builder.facts.point_at(last.curve, last.forward ? 1 : 0));
  const std::vector<Flat> all = unrolled(builder.facts.model, surface, points, from);
  std::vector<Flat> result;
  for (std::size_t i = 0; i < all.size(); i += finer) result.push_back(all[i]);
  return result;
}

/// Parts of the whole length, 0 to 1.
std::vector<double> parts(const Builder& builder, const std::vector<Index>& nodes) {
  std::vector<double> result(nodes.size(), 0);
  for (std::size_t i = 1; i < nodes.size(); ++i)
    result[i] = result[i - 1] + (builder.points[nodes[i]] - builder.points[nodes[i - 1]]).norm();
  for (double& part : result) part /= result.back();
  return result;
}

/// Points within the face's own parameters again, where these were counted on beyond a seam.
struct Wrapped {
  const Model& model;
  int surface;
  std::array<double, 2> periods;
  Flat low = Flat::Constant(-std::numeric_limits<double>::infinity());

  Vec3 operator()(Flat at) const {
    for (int c = 0; c < 2; ++c)
      if (periods[c] > 0 && std::isfinite(low[c])) at[c] -= periods[c] * std::floor((at[c] - low[c]) / periods[c]);
    return model.point({2, surface}, {at.x(), at.y()});
  }
};

}  // namespace

void Builder::mesh_surface(int surface) {
  const SurfaceFacts& own = facts.surfaces[surface - 1];
  if (own.sides)
    grid(surface);
  else if (own.is_disc)
    surface_quads[surface - 1] = o_grid(rim_of(own.loops[0]), {2, surface});
  else if (own.is_ring)
    ring(surface);
  else
    pave(surface);
}

void Builder::grid(int surface) {
  const SurfaceFacts& own = facts.surfaces[surface - 1];
  const auto& sides = *own.sides;
  const std::vector<Index> bottom = nodes(sides[0]), right = nodes(sides[1]), top = nodes(reversed(sides[2])),
                           left = nodes(reversed(sides[3]));
  const std::size_t m = bottom.size() - 1, n = left.size() - 1;
  check_memory(static_cast<double>(m) * static_cast<double>(n), 0);
  // Round the rim without a jump; of a tube the second seam lies a period away from the first.
  const Flat nowhere = Flat::Constant(std::nan(""));
  const std::vector<Flat> b = parameters_along(*this, surface, sides[0], nowhere);
  const std::vector<Flat> r = parameters_along(*this, surface, sides[1], b.back());
  std::vector<Flat> t = parameters_along(*this, surface, sides[2], r.back());
  std::vector<Flat> l = parameters_along(*this, surface, sides[3], t.back());
  std::ranges::reverse(t);
  std::ranges::reverse(l);
  Wrapped at{facts.model, surface, hextwist::periods(facts.model, surface)};
  for (int c = 0; own.is_tube && c < 2; ++c) {
    // Round this way: the seam lies where the parameters of the whole surface begin, or end.
    if (!(at.periods[c] > 0) || std::abs(b.back()[c] - b.front()[c]) < at.periods[c] / 2) continue;
    const auto raw = [&](Index node) {
      const Parameters foot = facts.model.project({2, surface}, points[node]).parameters;
      return c == 0 ? foot.u : foot.v;
    };
    const double seam = raw(left[n / 2]);
    at.low[c] = seam > raw(bottom[m / 2]) ? seam - at.periods[c] : seam;
  }
  const std::vector<double> pb = parts(*this, bottom), pt = parts(*this, top), pl = parts(*this, left),
                            pr = parts(*this, right);
  std::vector<Index> at_node((m + 1) * (n + 1));
  for (std::size_t j = 0; j <= n; ++j)
    for (std::size_t i = 0; i <= m; ++i) {
      Index& node = at_node[i + j * (m + 1)];
      if (j == 0)
        node = bottom[i];
      else if (j == n)
        node = top[i];
      else if (i == 0)
        node = left[j];
      else if (i == m)
        node = right[j];
      else {
        // Where the lines between the places on opposite sides meet.
        const double dx = pt[i] - pb[i], dy = pr[j] - pl[j];
        const double x = (pb[i] + pl[j] * dx) / (1 - dx * dy), y = pl[j] + x * dy;
        const Flat uv = (1 - y) * b[i] + y * t[i] + (1 - x) * l[j] + x * r[j] -
                        ((1 - x) * (1 - y) * b[0] + x * (1 - y) * b[m] + (1 - x) * y * t[0] + x * y * t[m]);
        node = add(at(uv), {2, surface});
      }
    }
  std::vector<Quad>& own_quads = surface_quads[surface - 1];
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < m; ++i) {
      const std::size_t k = i + j * (m + 1);
      own_quads.push_back({at_node[k], at_node[k + 1], at_node[k + m + 2], at_node[k + m + 1]});
    }
}

double Builder::average_edge(const Chain& chain) const {
  double length = 0, n = 0;
  for (const Step& step : chain) {
    length += facts.curves[step.curve - 1].length;
    n += intervals[step.curve - 1];
  }
  return length / n;
}

void Builder::ring(int surface, bool even) {
  const auto& loops = facts.surfaces[surface - 1].loops;
  std::vector<Index> outer = rim_of(loops[0]), inner = rim_of(loops[1]);
  const auto n = static_cast<Index>(outer.size());
  if (vector_area(outer).dot(vector_area(inner)) < 0) std::ranges::reverse(inner);
  Vec3 center = Vec3::Zero();
  for (const Index node : inner) center += points[node] / static_cast<double>(n);
  const Vec3 towards = (points[outer[0]] - center).normalized();
  const auto nearest =
      std::ranges::max_element(inner, {}, [&](Index node) { return (points[node] - center).dot(towards); });
  std::ranges::rotate(inner, nearest);
  double width = 0;
  for (Index i = 0; i < n; ++i) width += (points[outer[i]] - points[inner[i]]).norm() / static_cast<double>(n);
  const double edge = (average_edge(loops[0]) + average_edge(loops[1])) / 2;
  int layers = static_cast<int>(std::clamp(std::round(width / (size > 0 ? std::min(edge, size) : edge)), 1.0, 1e6));
  if (even && layers % 2) ++layers;
  check_memory(static_cast<double>(n) * layers, 0);
  std::vector<Index> last = inner;
  std::vector<Index>& column = ring_columns_[surface];
  column.push_back(inner[0]);
  for (int layer = 1; layer <= layers; ++layer) {
    std::vector<Index> next = outer;
    if (layer < layers)
      for (Index i = 0; i < n; ++i) {
        const double out = static_cast<double>(layer) / layers;
        next[i] = add((1 - out) * points[inner[i]] + out * points[outer[i]], {2, surface});
      }
    for (Index i = 0; i < n; ++i)
      surface_quads[surface - 1].push_back({last[i], next[i], next[(i + 1) % n], last[(i + 1) % n]});
    column.push_back(next[0]);
    last = next;
  }
}

void Builder::pave(int surface) {
  const SurfaceFacts& own = facts.surfaces[surface - 1];
  const std::string name = "surface " + std::to_string(surface);
  if (!own.odd.empty()) throw Error(name + " cannot be paved: " + own.odd);
  if (!own.seams.empty() || own.has_poles || own.loops.empty())
    throw Error(name + " cannot be paved: it closes on itself or has a pole");
  // The plane of the parameters, stretched so that lengths are about right.
  const Model& model = facts.model;
  std::vector<std::vector<Index>> rims;
  std::vector<std::vector<Flat>> flat;
  Flat from = Flat::Constant(std::nan(""));
  for (const Chain& loop : own.loops) {
    rims.push_back(rim_of(loop));
    flat.push_back(parameters_along(*this, surface, loop, from));
    if (std::isnan(from.x())) from = flat.back().front();
    flat.back().pop_back();
  }
  Flat stretch(1, 1);
  if (model.type({2, surface}) != "plane") {
    Flat low = flat[0][0], high = flat[0][0];
    for (const Flat& p : flat[0]) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    const Flat step = 1e-4 * (high - low);
    Flat sum(0, 0);
    for (const Flat& p : flat[0]) {
      const Vec3 at = model.point({2, surface}, {p.x(), p.y()});
      sum.x() += (model.point({2, surface}, {p.x() + step.x(), p.y()}) - at).norm();
      sum.y() += (model.point({2, surface}, {p.x(), p.y() + step.y()}) - at).norm();
    }
    stretch = sum.cwiseQuotient(step) / static_cast<double>(flat[0].size());
    if (!(stretch.minCoeff() > 0)) throw Error(name + " cannot be paved: its parameters degenerate at its rim");
  }
  const double edge = size > 0 ? size : average_edge(own.loops[0]);
  check_memory(model.measure({2, surface}) / (edge * edge), 0);
  for (std::vector<Flat>& loop : flat)
    for (Flat& p : loop) p = p.cwiseProduct(stretch);
  surface_quads[surface - 1] = pavement(name, rims, flat, edge, [&](const Flat& p) {
    const Flat uv = p.cwiseQuotient(stretch);
    return add(model.point({2, surface}, {uv.x(), uv.y()}), {2, surface});
  });
}

}  // namespace hextwist::fill
