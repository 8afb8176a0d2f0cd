// Volumes that were turned all the way round an axis which they do not touch (rings of any section, tori), or what lies
// around the core of those that do (axis.cpp). There is no surface where they begin, so the section is filled where
// seams and the beginnings of circles lie, and carried round.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "hextwist/base/interrupt.h"
#include "hextwist/mesh/fill/layers_internal.h"

namespace hextwist::fill {
namespace {

using Flat = Eigen::Vector2d;

/// The closed lines that pieces make, each node once.
std::vector<std::vector<Index>> closed_lines(std::vector<std::vector<Index>> pieces, const std::string& volume) {
  std::vector<std::vector<Index>> loops;
  while (!pieces.empty()) {
    std::vector<Index> line = pieces.back();
    pieces.pop_back();
    while (line.front() != line.back()) {
      const auto next = std::ranges::find_if(
          pieces, [&](const auto& piece) { return piece.front() == line.back() || piece.back() == line.back(); });
      if (next == pieces.end()) throw Error(volume + "its section at the seams is not closed");
      if (next->front() != line.back()) std::ranges::reverse(*next);
      line.insert(line.end(), next->begin() + 1, next->end());
      pieces.erase(next);
    }
    line.pop_back();
    loops.push_back(std::move(line));
  }
  return loops;
}

}  // namespace

void Builder::turn(const Sweep& sweep) {
  const std::string volume = "volume " + std::to_string(sweep.volume) + ": ";
  const bool is_torus = facts.surfaces[sweep.sides.front() - 1].is_torus;
  std::vector<std::vector<Index>> pieces;
  std::vector<Quad> sides;
  double edges = 0, n_edges = 0;
  for (const int id : sweep.sides) {
    const SurfaceFacts& surface = facts.surfaces[id - 1];
    if (sweep.axis && sweep.axis->has_end(id)) continue;
    if (sweep.axis)
      pieces.push_back(meridian(*sweep.axis, id));
    else if (surface.is_torus)
      pieces.push_back(nodes((*surface.sides)[0]));
    else if (surface.sides)
      pieces.push_back(nodes((*surface.sides)[1]));
    else
      pieces.push_back(ring_columns_.at(id));
    sides.insert(sides.end(), surface_quads[id - 1].begin(), surface_quads[id - 1].end());
  }
  if (sweep.axis) fill_core(sweep, pieces, sides);
  for (const std::vector<Index>& piece : pieces)
    for (std::size_t i = 1; i < piece.size(); ++i, ++n_edges) edges += (points[piece[i]] - points[piece[i - 1]]).norm();
  std::vector<std::vector<Index>> loops = closed_lines(std::move(pieces), volume);
  std::ranges::stable_sort(loops, std::greater<>(), [&](const auto& loop) { return vector_area(loop).norm(); });
  const Vec3 area = vector_area(loops[0]), normal = area.normalized(), x = normal.unitOrthogonal(), y = normal.cross(x);
  const Vec3 origin = points[loops[0][0]];
  std::vector<std::vector<Flat>> flat;
  const double width = std::sqrt(area.norm());
  for (const auto& loop : loops) {
    flat.emplace_back();
    for (const Index node : loop) {
      const Vec3 p = points[node] - origin;
      if (std::abs(p.dot(normal)) > 1e-3 * width) throw Error(volume + "its section at the seams is not flat");
      flat.back().emplace_back(p.dot(x), p.dot(y));
    }
  }
  const Owner owner{3, sweep.volume};
  std::vector<Quad> source = is_torus
                                 ? o_grid(loops[0], owner)
                                 : pavement(volume + "its section", loops, flat, size > 0 ? size : edges / n_edges,
                                            [&](const Flat& p) { return add(origin + p.x() * x + p.y() * y, owner); });
  orient_alike(source);
  const QuadsAtEdge at_source = quads_at_edges(source), at_side = quads_at_edges(sides);
  const std::vector<Edge> rim = rim_edges(source, at_source);
  const Inside inside(source, rim);
  std::vector<Vec3> here, inner_here;
  for (const Index node : inside.rim_nodes()) here.push_back(points[node]);
  for (const Index node : inside.inner()) inner_here.push_back(points[node]);
  const Vec3 ahead = inside.vector_area(here);

  // Round the side surfaces, edge by edge of the section, to where it begins.
  Columns column;
  std::size_t n_passed = 0;
  for (const auto& [first_a, first_b] : rim) {
    Index a = first_a, b = first_b, quad = -1;
    std::vector<Index> round_a, round_b;
    do {
      const auto found = at_side.find(edge_of(a, b));
      if (found == at_side.end() || found->second.size() != 2) throw Error(volume + "its sides do not fit together");
      const auto beyond = [&](Index q) {
        return Edge{other_neighbour(sides[q], a, b), other_neighbour(sides[q], b, a)};
      };
      Index next = found->second[0] == quad ? found->second[1] : found->second[0];
      if (quad < 0) {
        const auto leads = [&](Index q) {
          const Edge on = beyond(q);
          return (points[on[0]] + points[on[1]] - points[a] - points[b]).dot(ahead);
        };
        if (leads(found->second[1]) > leads(next)) next = found->second[1];
      }
      quad = next;
      round_a.push_back(a);
      round_b.push_back(b);
      const Edge on = beyond(quad);
      a = on[0];
      b = on[1];
      if (++n_passed > sides.size()) throw Error(volume + "its sides do not lead back to where they begin");
    } while (a != first_a || b != first_b);
    add_column(column, round_a, volume);
    add_column(column, round_b, volume);
  }
  const std::size_t n = height_of(column);
  if (n_passed != sides.size() || n == 0) throw Error(volume + "its sides have different numbers of layers");
  check_room(source.size(), n);

  std::vector<std::map<Index, Index>> level(n + 1);
  for (std::size_t k = 0; k < n; ++k) {
    check_interrupt();
    const std::vector<Vec3> rim_here = rim_of_level(inside, column, k, level[k]);
    const std::vector<Vec3> moved = k == 0 ? inner_here : inside.moved(here, inner_here, rim_here);
    for (std::size_t i = 0; i < moved.size(); ++i)
      level[k][inside.inner()[i]] = k == 0 ? inside.inner()[i] : add(moved[i], owner);
  }
  level[n] = level[0];
  add_layers(source, level, sweep.volume);
}

}  // namespace hextwist::fill
