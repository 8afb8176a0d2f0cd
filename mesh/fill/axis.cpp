// Solids that were turned all the way round an axis that they touch: shafts with steps, cones, domes, cups, shells of
// balls. Hexes have no place for a line at which all turn, so a round core around the axis is filled by itself, with
// squares in its middle, from end to end; what is left does not touch the axis, and is turned (turn.cpp).
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "hextwist/base/interrupt.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/fill/layers_internal.h"

namespace hextwist::fill {
namespace {

constexpr double core_part = 0.5;  // of the narrowest place
constexpr double full_turn = 2 * std::numbers::pi;

/// The seam of the end, from the pole on.
Step from_pole(const Facts& facts, const AxisEnd& end) {
  return {end.seam, facts.curves[end.seam - 1].first == end.pole};
}

/// Of the seam, by the part of its length between the pole and there.
Vec3 on_seam(const Facts& facts, const AxisEnd& end, double part) {
  const Step step = from_pole(facts, end);
  return facts.point_at(step.curve, step.forward ? part : 1 - part);
}

/// How far along the seam of the end that radius is.
double part_at_radius(const Facts& facts, const Axis& axis, const AxisEnd& end, double radius) {
  double low = 0, high = 1;
  constexpr int n = 256;
  for (int i = 1; i <= n && high == 1; ++i)
    if (axis.radius(on_seam(facts, end, static_cast<double>(i) / n)) >= radius) {
      low = (i - 1.0) / n;
      high = static_cast<double>(i) / n;
    }
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    (axis.radius(on_seam(facts, end, middle)) < radius ? low : high) = middle;
  }
  return (low + high) / 2;
}

/// How high above the axis' origin the end is at that radius.
double height_at(const Facts& facts, const Axis& axis, const AxisEnd& end, double radius) {
  if (end.seam == 0) return end.at;
  return axis.along(on_seam(facts, end, part_at_radius(facts, axis, end, radius)));
}

/// The radius up to which the end only gets wider.
double reach(const Facts& facts, const Axis& axis, const AxisEnd& end) {
  double most = 0;
  constexpr int n = 256;
  for (int i = 1; i <= n; ++i) {
    const double radius = axis.radius(on_seam(facts, end, static_cast<double>(i) / n));
    if (radius < most) break;
    most = radius;
  }
  return most;
}

/// Its ends and rims, not yet where they are; no ends where the volume has surfaces of another kind.
Axis ends_and_rims(const Facts& facts, int volume) {
  Axis axis;
  for (const int id : facts.model.adjacent({3, volume}, 2)) {
    const SurfaceFacts& surface = facts.surfaces[id - 1];
    const bool is_round = surface.odd.empty() && surface.seams.size() < 2 &&
                          std::ranges::all_of(surface.loops, [](const Chain& loop) { return loop.size() == 1; });
    const bool is_dome = surface.has_poles && surface.seams.size() == 1 && surface.loops.size() < 2;
    if (!is_round || !(is_dome || surface.is_disc || surface.is_annulus || surface.is_tube)) return {};
    for (const Chain& loop : surface.loops) axis.rims.push_back(loop[0].curve);
    if (surface.is_disc) axis.ends.push_back({.surface = id});
    if (!is_dome) continue;
    const CurveFacts& seam = facts.curves[surface.seams[0] - 1];
    for (const int vertex : {seam.first, seam.last})
      if (surface.loops.empty() || facts.start(surface.loops[0][0]) != vertex)
        axis.ends.push_back({.surface = id, .seam = surface.seams[0], .pole = vertex});
  }
  sort_unique(axis.rims, [](int rim) { return rim; });
  return axis;
}

/// The axis itself, and a half plane in which a part of it begins.
void place(const Facts& facts, Axis& axis) {
  const auto dome = std::ranges::find_if(axis.ends, [](const AxisEnd& end) { return end.seam > 0; });
  Vec3 begin = Vec3::Zero();
  if (dome != axis.ends.end()) begin = facts.point_at(dome->seam, 0.5);
  if (!axis.rims.empty()) {
    const std::vector<Vec3> points = facts.samples({{axis.rims[0], true}}, 12);
    for (const Vec3& p : points) axis.origin += p / static_cast<double>(points.size());
    axis.z = (points[0] - axis.origin).cross(points[3] - axis.origin).normalized();
    if (dome == axis.ends.end()) begin = points[0];
  } else {
    axis.origin = facts.model.point({0, axis.ends[0].pole}, {});
    axis.z = (facts.model.point({0, axis.ends[1].pole}, {}) - axis.origin).normalized();
  }
  axis.x = (begin - axis.origin - axis.along(begin) * axis.z).normalized();
  axis.y = axis.z.cross(axis.x);
}

/// Do all rims and seams, and the surfaces between them, lie round the axis? Sets how wide it is, and how narrow
/// (core). is_aligned: whether parts begin only where there are nodes: at eighths, or at quarters where the core meets
/// them.
bool is_round(const Facts& facts, int volume, double near_enough, Axis& axis, bool& is_aligned) {
  is_aligned = true;
  axis.core = std::numeric_limits<double>::infinity();
  const auto begins_at = [&](const Vec3& p, int parts) {
    const double step = full_turn / parts, angle = axis.angle(p);
    return axis.radius(p) * std::abs(angle - step * std::round(angle / step)) < near_enough;
  };
  for (const int rim : axis.rims) {
    const std::vector<Vec3> points = facts.samples({{rim, true}}, 12);
    const double height = axis.along(points[0]), radius = axis.radius(points[0]);
    for (const Vec3& p : points)
      if (std::abs(axis.along(p) - height) > near_enough || std::abs(axis.radius(p) - radius) > near_enough)
        return false;
    is_aligned = is_aligned && begins_at(points[0], 8);
    axis.core = std::min(axis.core, radius);
    axis.widest = std::max(axis.widest, radius);
  }
  for (const int id : facts.model.adjacent({3, volume}, 2)) {
    const SurfaceFacts& surface = facts.surfaces[id - 1];
    for (const int seam : surface.seams)
      for (const Vec3& p : facts.samples({{seam, true}}, 16)) {
        is_aligned = is_aligned && begins_at(p, surface.is_tube ? 8 : 4);
        axis.widest = std::max(axis.widest, axis.radius(p));
        if (surface.is_tube) axis.core = std::min(axis.core, axis.radius(p));
        for (const double by : {1.1, 2.7, 4.4}) {
          const Vec3 turned = axis.point(axis.radius(p), axis.angle(p) + by, axis.along(p));
          if (facts.model.project({2, id}, turned).distance > near_enough) return false;
        }
      }
  }
  return true;
}

}  // namespace

std::optional<Axis> find_axis(const Facts& facts, int volume, std::string& why) {
  const Model& model = facts.model;
  Axis axis = ends_and_rims(facts, volume);
  if (axis.ends.empty() || axis.ends.size() % 2) return std::nullopt;
  place(facts, axis);
  const double near_enough = 1e-5 * model.box({3, volume}).diagonal();
  bool is_aligned = true;
  if (!is_round(facts, volume, near_enough, axis, is_aligned)) return std::nullopt;
  if (!is_aligned) {
    why = "it is turned about an axis that it touches, but its surfaces begin at different angles around that";
    return std::nullopt;
  }
  for (AxisEnd& end : axis.ends) {
    if (end.seam == 0) {
      end.at = axis.along(facts.point_at(facts.surfaces[end.surface - 1].loops[0][0].curve, 0));
      continue;
    }
    end.at = axis.along(model.point({0, end.pole}, {}));
    end.angle = axis.angle(facts.point_at(end.seam, 0.5));
    axis.core = std::min(axis.core, reach(facts, axis, end));
  }
  std::ranges::sort(axis.ends, {}, &AxisEnd::at);
  axis.core *= core_part;
  // From end to end there must be nothing but this volume.
  for (std::size_t i = 0; i < axis.ends.size(); i += 2)
    for (const double part : {0.02, 0.3, 0.5, 0.7, 0.98})
      for (const double radius : {0.0, axis.core}) {
        const double low = height_at(facts, axis, axis.ends[i], radius),
                     high = height_at(facts, axis, axis.ends[i + 1], radius);
        if (high - low < near_enough || !model.contains(volume, axis.point(radius, 0.3, low + part * (high - low))))
          return std::nullopt;
      }
  return axis;
}

namespace {

/// The core of one volume, and the quads on the surfaces at its ends.
class Core {
 public:
  Core(Builder& builder, int volume, const Axis& axis)
      : builder_(builder), facts_(builder.facts), axis_(axis), volume_(volume) {
    n_ = axis.rims.empty() ? round_up(2 * builder.intervals[axis.ends[0].seam - 1], 8)
                           : static_cast<Index>(builder.rim_of({{axis.rims[0], true}}).size());
    edge_ = builder.size > 0 ? builder.size : full_turn * axis.widest / static_cast<double>(n_);
  }

  void fill(std::vector<std::vector<Index>>& pieces, std::vector<Quad>& sides) {
    pieces_ = &pieces;
    sides_ = &sides;
    for (std::size_t i = 0; i < axis_.ends.size(); i += 2) between(axis_.ends[i], axis_.ends[i + 1]);
    for (const AxisEnd& end : axis_.ends)
      if (!builder_.facts.surfaces[end.surface - 1].loops.empty())
        around(end, nullptr);
      else if (const AxisEnd* other = other_pole(end))
        around(end, other);
  }

 private:
  Builder& builder_;
  const Facts& facts_;
  const Axis& axis_;
  int volume_;
  Index n_ = 0;  // nodes all the way round
  double edge_;
  std::vector<std::vector<Index>>* pieces_ = nullptr;
  std::vector<Quad>* sides_ = nullptr;
  struct Cap {
    std::vector<Index> ring;  // around the core
    std::vector<Index> line;  // along the seam, from the pole to the ring
  };
  std::map<const AxisEnd*, Cap> caps_;

  static Index round_up(Index n, Index multiple) {
    return (std::max<Index>(n, 1) + multiple - 1) / multiple * multiple;
  }
  Index layers(double length) const {
    return round_up(static_cast<Index>(std::clamp(std::round(length / edge_), 1.0, 1e6)), 2);
  }
  double angle_of(Index place) const { return full_turn * static_cast<double>(place) / static_cast<double>(n_); }

  /// Of a sphere with two poles: the other one, once.
  const AxisEnd* other_pole(const AxisEnd& end) const {
    for (const AxisEnd& other : axis_.ends)
      if (other.surface == end.surface && other.pole != end.pole) return &end < &other ? &other : nullptr;
    return nullptr;
  }

  /// On the surface of the end, where it is turned from the seam by an angle.
  Index add_on(const AxisEnd& end, double radius, double angle, double height) {
    const bool is_on_seam = end.seam > 0 && std::abs(std::remainder(angle - end.angle, full_turn)) < 1e-4 * angle_of(1);
    const Owner owner = is_on_seam ? Owner{1, end.seam} : Owner{2, end.surface};
    return builder_.add(facts_.model.project(owner, axis_.point(radius, angle, height)).point, owner);
  }

  std::vector<Index> ring_on(const AxisEnd& end) {
    const double height = height_at(facts_, axis_, end, axis_.core);
    std::vector<Index> ring;
    for (Index j = 0; j < n_; ++j) ring.push_back(add_on(end, axis_.core, angle_of(j), height));
    return ring;
  }

  /// What a node of the pattern of the core becomes on an end.
  Index lifted(const AxisEnd& end, double radius, double angle) {
    if (radius < 1e-6 * axis_.core && end.seam) return builder_.at_vertex(end.pole);
    return add_on(end, radius, angle, height_at(facts_, axis_, end, radius));
  }

  void between(const AxisEnd& low, const AxisEnd& high) {
    const double h_low = height_at(facts_, axis_, low, axis_.core), h_high = height_at(facts_, axis_, high, axis_.core);
    const Index n_layers = layers(h_high - h_low);
    // Squares whose corners lie between the quarters, so that seams run straight to the middle.
    const Owner inside{3, volume_};
    std::vector<Index> flat;
    for (Index j = 0; j < n_; ++j)
      flat.push_back(builder_.add(axis_.point(axis_.core, angle_of(j - n_ / 8), 0), inside));
    const std::vector<Quad> pattern = builder_.o_grid(flat, inside);
    builder_.check_room(pattern.size(), static_cast<std::size_t>(n_layers));

    std::vector<std::map<Index, Index>> level(static_cast<std::size_t>(n_layers) + 1);
    std::vector<std::vector<Index>> rings(level.size());
    for (const AxisEnd* end : {&low, &high}) {
      const std::size_t k = end == &low ? 0 : level.size() - 1;
      rings[k] = ring_on(*end);
      Cap& cap = caps_[end];
      cap.ring = rings[k];
      for (Index j = 0; j < n_; ++j) level[k][flat[j]] = rings[k][(j - n_ / 8 + n_) % n_];
      for (const Quad& quad : pattern)
        for (const Index node : quad)
          if (!level[k].contains(node)) {
            const Vec3 p = builder_.points[node];
            level[k][node] = lifted(*end, axis_.radius(p), axis_.angle(p));
          }
      for (const auto& [node, own] : level[k])
        if (const Owner owner = builder_.owners[own];
            end->seam && (owner == Owner{1, end->seam} || owner == Owner{0, end->pole}))
          cap.line.push_back(own);
      std::ranges::sort(cap.line, {}, [&](Index node) { return axis_.radius(builder_.points[node]); });
      for (const Quad& quad : pattern) {
        Quad own;
        for (int c = 0; c < 4; ++c) own[c] = level[k].at(quad[c]);
        builder_.surface_quads[end->surface - 1].push_back(own);
      }
    }
    for (std::size_t k = 1; k + 1 < level.size(); ++k) {
      check_interrupt();
      const double t = static_cast<double>(k) / static_cast<double>(n_layers);
      for (const auto& [node, first] : level.front())
        level[k][node] =
            builder_.add((1 - t) * builder_.points[first] + t * builder_.points[level.back().at(node)], inside);
      for (Index j = 0; j < n_; ++j) rings[k].push_back(level[k].at(flat[(j + n_ / 8) % n_]));
    }
    builder_.add_layers(pattern, level, volume_);
    std::vector<Index> piece;
    for (std::size_t k = 0; k < rings.size(); ++k) {
      piece.push_back(rings[k][0]);
      if (k > 0) add_quads(rings[k - 1], rings[k], nullptr);
    }
    pieces_->push_back(piece);
  }

  void add_quads(const std::vector<Index>& a, const std::vector<Index>& b, std::vector<Quad>* of_surface) {
    for (Index j = 0; j < n_; ++j) {
      const Index next = (j + 1) % n_;
      const Quad quad{a[j], a[next], b[next], b[j]};
      sides_->push_back(quad);
      if (of_surface) of_surface->push_back(quad);
    }
  }

  /// The nodes of a rim by their angles.
  std::vector<Index> ring_of(int rim) const {
    std::vector<Index> ring(static_cast<std::size_t>(n_), -1);
    for (const Index node : builder_.rim_of({{rim, true}})) {
      const auto place = static_cast<Index>(std::lround(axis_.angle(builder_.points[node]) / angle_of(1)));
      ring[(place + n_) % n_] = node;
    }
    if (std::ranges::find(ring, -1) != ring.end())
      throw Error("volume " + std::to_string(volume_) + ": the nodes on curve " + std::to_string(rim) +
                  " are not alike all the way round");
    return ring;
  }

  /// Rows on the surface of the end, from the core to its rim or to its other pole.
  void around(const AxisEnd& end, const AxisEnd* other) {
    const SurfaceFacts& surface = facts_.surfaces[end.surface - 1];
    const std::vector<Index> outer = other ? caps_.at(other).ring : ring_of(surface.loops[0][0].curve);
    const double from = end.seam ? part_at_radius(facts_, axis_, end, axis_.core) : 0,
                 to = other ? 1 - part_at_radius(facts_, axis_, *other, axis_.core) : 1;
    const double width = axis_.radius(builder_.points[outer[0]]) - axis_.core;
    const Index n_rows = layers(end.seam ? (to - from) * facts_.curves[end.seam - 1].length : width);
    builder_.check_room(static_cast<std::size_t>(n_), static_cast<std::size_t>(n_rows));
    const Index seam = (static_cast<Index>(std::lround(end.angle / angle_of(1))) + n_) % n_;
    std::vector<Index> last = caps_.at(&end).ring, piece{last[0]}, line = caps_.at(&end).line;
    for (Index row = 1; row <= n_rows; ++row) {
      check_interrupt();
      const double part = static_cast<double>(row) / static_cast<double>(n_rows);
      std::vector<Index> next = outer;
      if (row < n_rows) {
        const Vec3 p = end.seam ? on_seam(facts_, end, from + part * (to - from))
                                : axis_.point(axis_.core + part * width, 0, end.at);
        for (Index j = 0; j < n_; ++j) next[j] = add_on(end, axis_.radius(p), angle_of(j), axis_.along(p));
      }
      add_quads(last, next, &builder_.surface_quads[end.surface - 1]);
      piece.push_back(next[0]);
      line.push_back(next[seam]);
      last = next;
    }
    if (end.seam) {
      if (other) {
        const std::vector<Index>& rest = caps_.at(other).line;
        line.insert(line.end(), rest.rbegin() + 1, rest.rend());
      }
      if (!from_pole(facts_, end).forward) std::ranges::reverse(line);
      builder_.curve_nodes[end.seam - 1] = line;
    }
    pieces_->push_back(std::move(piece));
  }
};

}  // namespace

std::vector<Index> Builder::meridian(const Axis& axis, int surface) const {
  // Of each rim all the way round there are as many nodes at equal angles, one of them at x.
  std::map<Index, std::set<Index>> beside;
  const auto& loops = facts.surfaces[surface - 1].loops;
  const double near_enough = full_turn / 4 / static_cast<double>(rim_of(loops[0]).size());
  const auto is_there = [&](Index node) { return std::abs(axis.angle(points[node])) < near_enough; };
  for (const Quad& quad : surface_quads[surface - 1])
    for (int k = 0; k < 4; ++k)
      if (const Index a = quad[k], b = quad[(k + 1) % 4]; is_there(a) && is_there(b)) {
        beside[a].insert(b);
        beside[b].insert(a);
      }
  const auto begin = std::ranges::find_if(beside, [](const auto& node) { return node.second.size() == 1; });
  std::vector<Index> line;
  for (Index at = begin == beside.end() ? -1 : begin->first, before = -1; at >= 0;) {
    line.push_back(at);
    Index next = -1;
    for (const Index other : beside.at(at))
      if (other != before) next = other;
    before = at;
    at = next;
  }
  return line;
}

void Builder::fill_core(const Sweep& sweep, std::vector<std::vector<Index>>& pieces, std::vector<Quad>& sides) {
  Core(*this, sweep.volume, *sweep.axis).fill(pieces, sides);
}

}  // namespace hextwist::fill
