// Quads on surfaces: grids by transfinite interpolation (Gordon and Hall 1973) between the parameters of the rim,
// O-grids on discs, circles on rings, and pavements that somebody else makes in the plane of the parameters, each of
// whose triangles becomes three quads and each of whose quads becomes four.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "hextwist/base/memory.h"
#include "hextwist/mesh/fill/builder_internal.h"

namespace hextwist::fill {
namespace {

using Flat = Eigen::Vector2d;

/// Parameters of nodes along chains, whose curves bend between the nodes: looked at in smaller steps.
std::vector<Flat> parameters_along(const Builder& builder, int surface, const Chain& chain, Flat from) {
  constexpr int finer = 4;
  std::vector<Vec3> points;
  for (const Step& step : chain) {
    const int n = builder.intervals[step.curve - 1] * finer;
    for (int i = 0; i < n; ++i) {
      const double part = static_cast<double>(i) / n;
      points.push_back(builder.facts.point_at(step.curve, step.forward ? part : 1 - part));
    }
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

/// Moves inner points of flat quads to the middle of their neighbours, where no worst corner gets worse for it.
void smooth_flat(std::vector<Flat>& points, const std::vector<Quad>& quads, std::size_t n_fixed) {
  std::vector<std::vector<Index>> around(points.size());
  std::vector<std::vector<Index>> beside(points.size());
  for (std::size_t q = 0; q < quads.size(); ++q)
    for (int k = 0; k < 4; ++k) {
      around[quads[q][k]].push_back(static_cast<Index>(q));
      beside[quads[q][k]].push_back(quads[q][(k + 1) % 4]);
      beside[quads[q][k]].push_back(quads[q][(k + 3) % 4]);
    }
  const auto worst = [&](Index n) {
    double result = 1;
    for (const Index q : around[n])
      for (int k = 0; k < 4; ++k) {
        const Flat& p = points[quads[q][k]];
        const Flat a = points[quads[q][(k + 1) % 4]] - p, b = points[quads[q][(k + 3) % 4]] - p;
        const double lengths = a.norm() * b.norm();
        result = std::min(result, lengths > 0 ? (a.x() * b.y() - a.y() * b.x()) / lengths : -1.0);
      }
    return result;
  };
  constexpr int sweeps = 40;
  constexpr double good = 0.7;
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (auto n = static_cast<Index>(n_fixed); n < static_cast<Index>(points.size()); ++n) {
      const Flat before = points[n];
      const double was = worst(n);
      Flat middle = Flat::Zero();
      for (const Index other : beside[n]) middle += points[other] / static_cast<double>(beside[n].size());
      // Half a step where a whole one is too much.
      for (const double step : {1.0, 0.5, 0.2}) {
        points[n] = before + step * (middle - before);
        if (worst(n) >= std::min(was, good)) break;
        points[n] = before;
      }
    }
}

double turned_area(const std::vector<Flat>& points, const Quad& quad) {
  const Flat a = points[quad[2]] - points[quad[0]], b = points[quad[3]] - points[quad[1]];
  return a.x() * b.y() - a.y() * b.x();
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
    disc(surface);
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
  Wrapped at{facts.model, surface, facts.model.periods(surface)};
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

void Builder::disc(int surface) {
  // A core of k by k cells, whose rim is joined to the circle. The core bulges, which opens the corners where three
  // blocks meet (mesh/primitives.cpp has the same numbers).
  constexpr double core = 0.5, bulge = 0.37;
  const Chain& loop = facts.surfaces[surface - 1].loops[0];
  std::vector<Index> rim = nodes(loop);
  rim.pop_back();
  const auto k = static_cast<int>(rim.size() / 4), layers = (k + 1) / 2;
  Vec3 center = Vec3::Zero();
  for (const Index n : rim) center += points[n] / static_cast<double>(rim.size());
  // The node of the core behind place i on the rim.
  const auto core_at = [&](int i) -> std::array<int, 2> {
    const int along = i % k;
    switch (i / k) {
      case 0:
        return {along, 0};
      case 1:
        return {k, along};
      case 2:
        return {k - along, k};
      default:
        return {0, k - along};
    }
  };
  std::vector<Vec3> core_point(static_cast<std::size_t>((k + 1) * (k + 1)));
  const auto place = [&](int i, int j) -> Vec3& { return core_point[static_cast<std::size_t>(i + (k + 1) * j)]; };
  // Each side of the core lies between its chord and the circle; inside as on any grid.
  for (int i = 0; i < 4 * k; ++i) {
    const int corner = i / k * k;
    const double part = static_cast<double>(i % k) / k;
    const Vec3 chord = (1 - part) * points[rim[corner]] + part * points[rim[(corner + k) % (4 * k)]];
    const auto [a, b] = core_at(i);
    place(a, b) = center + core * ((1 - bulge) * (chord - center) + bulge * (points[rim[i]] - center));
  }
  for (int j = 1; j < k; ++j)
    for (int i = 1; i < k; ++i) {
      const double x = static_cast<double>(i) / k, y = static_cast<double>(j) / k;
      place(i, j) = (1 - y) * place(i, 0) + y * place(i, k) + (1 - x) * place(0, j) + x * place(k, j) -
                    ((1 - x) * (1 - y) * place(0, 0) + x * (1 - y) * place(k, 0) + (1 - x) * y * place(0, k) +
                     x * y * place(k, k));
    }
  std::vector<Index> core_node;
  for (const Vec3& p : core_point) core_node.push_back(add(p, {2, surface}));
  std::vector<Quad>& own = surface_quads[surface - 1];
  const auto node = [&](int i, int j) { return core_node[static_cast<std::size_t>(i + (k + 1) * j)]; };
  for (int j = 0; j < k; ++j)
    for (int i = 0; i < k; ++i) own.push_back({node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)});
  std::vector<Index> inside;
  for (int i = 0; i < 4 * k; ++i) inside.push_back(node(core_at(i)[0], core_at(i)[1]));
  const std::vector<Index> first = inside;
  for (int layer = 1; layer <= layers; ++layer) {
    std::vector<Index> outside = rim;
    if (layer < layers)
      for (int i = 0; i < 4 * k; ++i) {
        const double out = static_cast<double>(layer) / layers;
        outside[i] = add((1 - out) * points[first[i]] + out * points[rim[i]], {2, surface});
      }
    for (int i = 0; i < 4 * k; ++i) {
      const int next = (i + 1) % (4 * k);
      own.push_back({inside[i], outside[i], outside[next], inside[next]});
    }
    inside = outside;
  }
}

void Builder::ring(int surface) {
  const auto& loops = facts.surfaces[surface - 1].loops;
  std::vector<Index> outer = nodes(loops[0]), inner = nodes(loops[1]);
  outer.pop_back();
  inner.pop_back();
  const auto n = static_cast<Index>(outer.size());
  const auto turning = [&](const std::vector<Index>& rim) {
    Vec3 area = Vec3::Zero();
    for (Index i = 0; i < n; ++i) area += points[rim[i]].cross(points[rim[(i + 1) % n]]);
    return area;
  };
  if (turning(outer).dot(turning(inner)) < 0) std::ranges::reverse(inner);
  Vec3 center = Vec3::Zero();
  for (const Index node : inner) center += points[node] / static_cast<double>(n);
  const Vec3 towards = (points[outer[0]] - center).normalized();
  const auto nearest =
      std::ranges::max_element(inner, {}, [&](Index node) { return (points[node] - center).dot(towards); });
  std::ranges::rotate(inner, nearest);
  double width = 0;
  for (Index i = 0; i < n; ++i) width += (points[outer[i]] - points[inner[i]]).norm() / static_cast<double>(n);
  const double edge = (average_edge(loops[0]) + average_edge(loops[1])) / 2;
  const int layers = std::max(1, static_cast<int>(std::round(width / (size > 0 ? std::min(edge, size) : edge))));
  std::vector<Index> last = inner;
  for (int layer = 1; layer <= layers; ++layer) {
    std::vector<Index> next = outer;
    if (layer < layers)
      for (Index i = 0; i < n; ++i) {
        const double out = static_cast<double>(layer) / layers;
        next[i] = add((1 - out) * points[inner[i]] + out * points[outer[i]], {2, surface});
      }
    for (Index i = 0; i < n; ++i)
      surface_quads[surface - 1].push_back({last[i], next[i], next[(i + 1) % n], last[(i + 1) % n]});
    last = next;
  }
}

void Builder::pave(int surface) {
  const SurfaceFacts& own = facts.surfaces[surface - 1];
  const std::string name = "surface " + std::to_string(surface);
  if (!own.odd.empty()) throw Error(name + " cannot be paved: " + own.odd);
  if (!own.seams.empty() || own.has_poles || own.loops.empty())
    throw Error(name + " cannot be paved: it closes on itself or has a pole");
  if (!quads) throw Error(name + " is to be paved with quads, by the program gmsh, which is not installed");
  // The plane of the parameters, stretched so that lengths are about right.
  const Model& model = facts.model;
  std::vector<std::vector<Index>> rims;
  std::vector<std::vector<Flat>> flat;
  Flat from = Flat::Constant(std::nan(""));
  for (const Chain& loop : own.loops) {
    rims.push_back(nodes(loop));
    flat.push_back(parameters_along(*this, surface, loop, from));
    if (std::isnan(from.x())) from = flat.back().front();
    rims.back().pop_back();
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
  std::vector<std::vector<Flat>> polygons;
  std::vector<Index> rim;  // all nodes on it, in the order of the polygons
  std::vector<Flat> plane;
  std::map<std::array<Index, 2>, Index> middle;  // of two corners in the paver's numbers: position in rim
  std::vector<Index> of_corner;
  Index n_corners = 0;
  for (std::size_t k = 0; k < rims.size(); ++k) {
    const auto n = static_cast<Index>(rims[k].size()), first = static_cast<Index>(rim.size()), half = n / 2;
    polygons.emplace_back();
    for (Index i = 0; i < n; ++i) {
      rim.push_back(rims[k][i]);
      plane.push_back(flat[k][i].cwiseProduct(stretch));
      if (i % 2 == 0) {
        polygons.back().push_back(plane.back());
        of_corner.push_back(first + i);
      } else {
        const Index a = n_corners + i / 2, b = n_corners + (i / 2 + 1) % half;
        middle[{std::min(a, b), std::max(a, b)}] = first + i;
      }
    }
    n_corners += half;
  }
  const double inside = size > 0 ? size : average_edge(own.loops[0]);
  check_memory(model.measure({2, surface}) / (inside * inside), 0);
  const FlatMesh coarse = quads(polygons, 2 * inside);
  const std::size_t n_fixed = plane.size(), n_rim = middle.size();
  for (auto i = static_cast<Index>(of_corner.size()); i < static_cast<Index>(coarse.points.size()); ++i) {
    of_corner.push_back(static_cast<Index>(plane.size()));
    plane.push_back(coarse.points[i]);
  }
  std::vector<Quad> cells;
  std::size_t n_met = 0;
  std::map<std::array<Index, 2>, int> met;
  for (const auto& element : coarse.elements) {
    const int n = element[3] < 0 ? 3 : 4;
    const auto center = static_cast<Index>(plane.size());
    plane.emplace_back(0, 0);
    std::array<Index, 4> halves{};
    for (int k = 0; k < n; ++k) {
      const Index a = element[k], b = element[(k + 1) % n];
      if (a < 0 || b < 0 || a >= std::ssize(of_corner) || b >= std::ssize(of_corner) || a == b)
        throw Error(name + " was not paved as asked: an element names a node that is not there");
      const auto [at, is_new] = middle.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<Index>(plane.size()));
      if (is_new) plane.push_back((plane[of_corner[a]] + plane[of_corner[b]]) / 2);
      halves[k] = at->second;
      if (++met[at->first] > 2) throw Error(name + " was not paved as asked: three elements meet at an edge");
      if (static_cast<std::size_t>(at->second) < n_fixed && met[at->first] == 1) ++n_met;
      plane[center] += plane[of_corner[a]] / n;
    }
    for (int k = 0; k < n; ++k) cells.push_back({of_corner[element[k]], halves[k], center, halves[(k + n - 1) % n]});
  }
  // Each side of the polygons stands once, all else twice.
  if (n_met != n_rim || std::ranges::any_of(met, [&](const auto& edge) {
        return (edge.second == 1) != (static_cast<std::size_t>(middle.at(edge.first)) < n_fixed);
      }))
    throw Error(name + " was not paved as asked: there are holes in the pavement, or sides of its rim were cut");
  for (Quad& cell : cells)
    if (turned_area(plane, cell) < 0) std::swap(cell[1], cell[3]);
  smooth_flat(plane, cells, n_fixed);
  std::vector<Index> node = rim;
  node.resize(plane.size(), -1);
  for (const Quad& cell : cells) {
    Quad& quad = surface_quads[surface - 1].emplace_back();
    for (int k = 0; k < 4; ++k) {
      Index& own_node = node[cell[k]];
      const Flat uv = plane[cell[k]].cwiseQuotient(stretch);
      if (own_node < 0) own_node = add(model.point({2, surface}, {uv.x(), uv.y()}), {2, surface});
      quad[k] = own_node;
    }
  }
}

}  // namespace hextwist::fill
