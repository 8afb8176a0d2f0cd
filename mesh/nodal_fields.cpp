#include "hextwist/mesh/nodal_fields.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/mesh/topology.h"

namespace hextwist {
namespace {

constexpr double face_slack = 1e-9;  // of the unit cube: so near to a face it does not matter which side counts
constexpr int max_steps = 100;       // from hex to hex
constexpr std::size_t most_seen = 3000;

Vec3 clamped(const Vec3& at) {
  return at.cwiseMax(0.0).cwiseMin(1.0);
}

HexPlace place_in(const Mesh& mesh, Index hex, const Vec3& p) {
  const std::array<Vec3, 8> corners = corners_of(mesh, hex);
  HexPlace place;
  if (find_natural_coordinates(corners, p, place.at)) {
    const Vec3 nearest = clamped(place.at);
    if ((place.at - nearest).cwiseAbs().maxCoeff() > face_slack)
      place.distance = (p - trilinear_point(corners, nearest)).norm();
  } else {
    place = closest_place(corners, p);
  }
  place.hex = hex;
  return place;
}

/// The hexes around some hexes, to step from one to the next.
class Around {
 public:
  Around(const Mesh& mesh, std::span<const Index> hexes) : mesh_(mesh), nodes_(nodes_of_hexes(mesh, hexes)) {
    std::vector<std::uint8_t> marked(mesh.points.size(), 0);
    for (const Index n : nodes_) marked[n] = 1;
    const std::vector<Index> near = touching_hexes(mesh.hexes, marked);
    of_node_.first.assign(nodes_.size() + 1, 0);
    const auto for_each_use = [&](const auto& use) {
      for (const Index h : near)
        for (const Index n : mesh.hexes[h])
          if (marked[n]) use(position_in(nodes_, n), h);
    };
    for_each_use([&](Index i, Index) { ++of_node_.first[i + 1]; });
    std::partial_sum(of_node_.first.begin(), of_node_.first.end(), of_node_.first.begin());
    of_node_.items.resize(static_cast<std::size_t>(of_node_.first.back()));
    std::vector<Index> next(of_node_.first.begin(), of_node_.first.end() - 1);
    for_each_use([&](Index i, Index h) { of_node_.items[next[i]++] = h; });
  }
  /// The hex behind a face of one of the hexes; -1 where there is none.
  Index across(Index hex, int face) const {
    const Quad quad = face_nodes(mesh_.hexes[hex], face);
    for (const Index other : of_node_[position_in(nodes_, quad[0])])
      if (other != hex && std::ranges::all_of(quad, [&](Index n) {
            return std::ranges::find(mesh_.hexes[other], n) != mesh_.hexes[other].end();
          }))
        return other;
    return -1;
  }

 private:
  const Mesh& mesh_;
  std::vector<Index> nodes_;
  CompressedRows of_node_;
};

HexPlace step_towards(const Mesh& mesh, const Around& around, const HexPlace& from, const Vec3& p) {
  HexPlace best = from;
  for (int face = 0; face < n_hex_faces; ++face) {
    const double along = from.at[face >> 1];
    if (face & 1 ? along < 1 : along > 0) continue;
    const Index next = around.across(from.hex, face);
    if (next < 0) continue;
    const HexPlace there = place_in(mesh, next, p);
    if (there.distance < best.distance) best = there;
  }
  return best;
}

double distance_to_box(const Mesh& mesh, Index hex, const Vec3& p) {
  const Box around = box(mesh, hex);
  return (p - p.cwiseMax(around.min).cwiseMin(around.max)).norm();
}

/// A point that no step from its place brings nearer. Pieces of transitions are skew, so it may be inside of the mesh
/// all the same. The straight way to it lies in the ball around it: hexes that reach into that are looked at, across
/// faces, ring by ring.
struct Stuck {
  Index point;
  std::vector<Index> seen, ring;

  void look_around(const Mesh& mesh, const Around& around, const Vec3& p, HexPlace& best) {
    constexpr double rounding = 1 + 1e-9;
    std::vector<Index> next_ring;
    for (const Index hex : ring)
      for (int face = 0; face < n_hex_faces; ++face) {
        const Index next = around.across(hex, face);
        if (next < 0 || std::ranges::find(seen, next) != seen.end()) continue;
        seen.push_back(next);
        if (distance_to_box(mesh, next, p) > rounding * best.distance) continue;
        next_ring.push_back(next);
        if (const HexPlace there = place_in(mesh, next, p); there.distance < best.distance) best = there;
        if (best.distance == 0) return ring.clear();
      }
    ring = std::move(next_ring);
    if (seen.size() > most_seen) ring.clear();
  }
};

void look_further(const Mesh& mesh, std::span<const Vec3> points, std::span<const Index> open,
                  std::vector<HexPlace>& places) {
  std::vector<Stuck> stuck;
  for (const Index i : open) stuck.push_back({i, {places[i].hex}, {places[i].hex}});
  while (!stuck.empty()) {
    std::vector<Index> hexes;
    for (const Stuck& one : stuck) hexes.insert(hexes.end(), one.ring.begin(), one.ring.end());
    const Around around(mesh, sorted_unique(std::move(hexes)));
    parallel_each(
        stuck.size(),
        [&](std::size_t k) { stuck[k].look_around(mesh, around, points[stuck[k].point], places[stuck[k].point]); }, 64);
    std::erase_if(stuck, [](const Stuck& one) { return one.ring.empty(); });
  }
}

}  // namespace

bool has_nodal_fields(const Mesh& mesh) {
  return std::ranges::any_of(mesh.fields, [](const Field& field) { return field.on == Field::On::node; });
}

std::vector<Index> hexes_to_begin_with(const Mesh& after, std::span<const Index> nodes, std::span<const Index> origin) {
  constexpr Index none = std::numeric_limits<Index>::max();
  std::vector<Index> lowest(after.points.size(), none);
  std::vector<std::uint8_t> is_asked(after.points.size(), 0);
  for (const Index n : nodes) is_asked[n] = 1;
  parallel_each(after.hexes.size(), [&](std::size_t h) {
    for (const Index n : after.hexes[h])
      if (is_asked[n]) atomic_min(lowest[n], origin.empty() ? static_cast<Index>(h) : origin[h]);
  });
  return items_at(lowest, nodes);
}

std::vector<HexPlace> find_places(const Mesh& mesh, std::span<const Vec3> points, std::span<const Index> begin) {
  std::vector<HexPlace> places(points.size());
  parallel_each(points.size(), [&](std::size_t i) { places[i] = place_in(mesh, begin[i], points[i]); });
  std::vector<Index> open =
      indices_where(static_cast<Index>(places.size()), [&](Index i) { return places[i].distance > 0; });
  std::vector<Index> stuck;
  for (int step = 0; step < max_steps && !open.empty(); ++step) {
    std::vector<Index> hexes;
    for (const Index i : open) hexes.push_back(places[i].hex);
    const Around around(mesh, sorted_unique(std::move(hexes)));
    std::vector<std::uint8_t> goes_on(open.size());
    parallel_each(
        open.size(),
        [&](std::size_t k) {
          HexPlace& place = places[open[k]];
          const HexPlace next = step_towards(mesh, around, place, points[open[k]]);
          goes_on[k] = next.hex != place.hex && next.distance > 0;
          place = next;
        },
        64);
    std::size_t n = 0;
    for (std::size_t k = 0; k < open.size(); ++k)
      if (goes_on[k])
        open[n++] = open[k];
      else if (places[open[k]].distance > 0)
        stuck.push_back(open[k]);
    open.resize(n);
  }
  look_further(mesh, points, stuck, places);
  return places;
}

std::array<double, 8> weights_at(std::span<const Vec3, 8> corners, const Vec3& at, const Vec3& p) {
  const Vec3 inside = clamped(at);
  const auto along = [&](int axis, int c) { return c >> axis & 1 ? inside[axis] : 1 - inside[axis]; };
  std::array<double, 8> weight;
  for (int c = 0; c < n_hex_corners; ++c) weight[c] = along(0, c) * along(1, c) * along(2, c);
  const Vec3 rest = p - trilinear_point(corners, inside);
  if (rest.squaredNorm() <= 1e-30 * (corners[7] - corners[0]).squaredNorm()) return weight;
  Eigen::Matrix3d jacobian;
  const auto columns = trilinear_derivatives(corners, inside);
  for (int axis = 0; axis < 3; ++axis) jacobian.col(axis) = columns[axis];
  // Of a flat hex: the slopes that it has.
  const Vec3 further = jacobian.completeOrthogonalDecomposition().solve(rest);
  for (int c = 0; c < n_hex_corners; ++c)
    for (int axis = 0; axis < 3; ++axis)
      weight[c] += (c >> axis & 1 ? 1 : -1) * along((axis + 1) % 3, c) * along((axis + 2) % 3, c) * further[axis];
  return weight;
}

void evaluate_nodal_fields(const Mesh& before, const Mesh& after, std::span<const Index> nodes,
                           std::span<const Index> origin, std::span<Field> fields) {
  if (nodes.empty() || !has_nodal_fields(before)) return;
  const std::vector<Vec3> points = items_at(after.points, nodes);
  const std::vector<HexPlace> places = find_places(before, points, hexes_to_begin_with(after, nodes, origin));
  parallel_each(nodes.size(), [&](std::size_t i) {
    const Hex& hex = before.hexes[places[i].hex];
    const std::array<double, 8> weight = weights_at(corners_of(before, places[i].hex), places[i].at, points[i]);
    const auto nearest = static_cast<std::size_t>(std::ranges::max_element(weight) - weight.begin());
    for (std::size_t f = 0; f < before.fields.size(); ++f) {
      const Field& from = before.fields[f];
      if (from.on != Field::On::node) continue;
      const auto width = static_cast<std::size_t>(from.components);
      double* const to = fields[f].values.data() + static_cast<std::size_t>(nodes[i]) * width;
      const auto value = [&](std::size_t c, std::size_t k) {
        return from.values[static_cast<std::size_t>(hex[c]) * width + k];
      };
      for (std::size_t k = 0; k < width; ++k) {
        if (from.integer) {
          to[k] = value(nearest, k);
          continue;
        }
        double sum = 0;
        for (std::size_t c = 0; c < weight.size(); ++c)
          if (weight[c] != 0) sum += weight[c] * value(c, k);
        if (std::isfinite(sum)) to[k] = sum;
      }
    }
  });
}

void evaluate_where_moved(const Mesh& before, Mesh& after) {
  if (!has_nodal_fields(before)) return;
  const auto moved = indices_where(before.n_nodes(), [&](Index n) { return before.points[n] != after.points[n]; });
  evaluate_nodal_fields(before, after, moved, {}, after.fields);
}

void copy_nodal_values(const Mesh& from, Index node, Mesh& to, Index at) {
  for (std::size_t f = 0; f < from.fields.size(); ++f) {
    if (from.fields[f].on != Field::On::node) continue;
    const auto width = static_cast<std::size_t>(from.fields[f].components);
    std::copy_n(from.fields[f].values.data() + static_cast<std::size_t>(node) * width, width,
                to.fields[f].values.data() + static_cast<std::size_t>(at) * width);
  }
}

}  // namespace hextwist
