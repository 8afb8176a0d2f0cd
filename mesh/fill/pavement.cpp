// Quads within given rims: O-grids, and pavements that somebody else begins, each of whose triangles becomes three
// quads and each of whose quads becomes four.
#include <algorithm>
#include <cmath>
#include <map>

#include "hextwist/base/memory.h"
#include "hextwist/mesh/fill/builder_internal.h"

namespace hextwist::fill {
namespace {

using Flat = Eigen::Vector2d;

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
      for (int k = 0; k < 4; ++k)
        result = std::min(
            result, corner_sine(points[quads[q][(k + 3) % 4]], points[quads[q][k]], points[quads[q][(k + 1) % 4]]));
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

}  // namespace

std::vector<Quad> Builder::o_grid(const std::vector<Index>& rim, Owner owner) {
  // A core of k by k cells, whose rim is joined to the circle. The core bulges, which opens the corners where three
  // blocks meet (mesh/primitives.cpp has the same numbers).
  constexpr double core = 0.5, bulge = 0.37;
  const auto k = static_cast<int>(rim.size() / 4), layers = (k + 1) / 2;
  check_memory(3.0 * k * k, 0);
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
  for (const Vec3& p : core_point) core_node.push_back(add(p, owner));
  std::vector<Quad> own;
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
        outside[i] = add((1 - out) * points[first[i]] + out * points[rim[i]], owner);
      }
    for (int i = 0; i < 4 * k; ++i) {
      const int next = (i + 1) % (4 * k);
      own.push_back({inside[i], outside[i], outside[next], inside[next]});
    }
    inside = outside;
  }
  return own;
}

std::vector<Quad> Builder::pavement(const std::string& name, const std::vector<std::vector<Index>>& rims,
                                    const std::vector<std::vector<Flat>>& flat, double edge,
                                    const std::function<Index(const Flat&)>& add_at) {
  if (!quads) throw Error(name + " is to be paved with quads, by the program gmsh, which is not installed");
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
      plane.push_back(flat[k][i]);
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
  const FlatMesh coarse = quads(polygons, 2 * edge);
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
  if (n_met != n_rim || std::ranges::any_of(met, [&](const auto& side) {
        return (side.second == 1) != (static_cast<std::size_t>(middle.at(side.first)) < n_fixed);
      }))
    throw Error(name + " was not paved as asked: there are holes in the pavement, or sides of its rim were cut");
  for (Quad& cell : cells)
    if (turned_area(plane, cell) < 0) std::swap(cell[1], cell[3]);
  smooth_flat(plane, cells, n_fixed);
  std::vector<Index> node = rim;
  node.resize(plane.size(), -1);
  std::vector<Quad> result;
  for (const Quad& cell : cells) {
    Quad& quad = result.emplace_back();
    for (int k = 0; k < 4; ++k) {
      Index& own_node = node[cell[k]];
      if (own_node < 0) own_node = add_at(plane[cell[k]]);
      quad[k] = own_node;
    }
  }
  return result;
}

}  // namespace hextwist::fill
