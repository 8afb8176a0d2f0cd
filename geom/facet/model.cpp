#include "hextwist/geom/facet/model.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Simple_cartesian.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/property_map/property_map.hpp>
#include <cassert>
#include <cmath>
#include <mutex>

#include "hextwist/base/parallel.h"
#include "hextwist/geom/curvature.h"
#include "hextwist/geom/facet/bilinear.h"
#include "hextwist/geom/facet/curvature_internal.h"
#include "hextwist/geom/facet/quadratic.h"
#include "hextwist/geom/facet/skin.h"
#include "hextwist/geom/facet/source_internal.h"
#include "hextwist/geom/incidence.h"
#include "hextwist/geom/segment.h"

namespace hextwist {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Segment = std::array<Vec3, 2>;

constexpr double contains_slack = 1e-12;  // of the model size

/// Where the closest point of a tree is: which item, and at (s, t) of it.
struct Foot {
  std::int32_t item = -1;
  double s = 0;
  double t = 0;
  double distance2 = std::numeric_limits<double>::infinity();
};

Foot foot_on(const BilinearPatch& patch, const Vec3& p) {
  const PatchFoot foot = closest(patch, p);
  return {-1, foot.s, foot.t, foot.distance2};
}
Foot foot_on(const Segment& segment, const Vec3& p) {
  const double s = closest_fraction(segment[0], segment[1], p);
  return {-1, s, 0, ((1 - s) * segment[0] + s * segment[1] - p).squaredNorm()};
}
Foot foot_on(const QuadraticPatch& patch, const Vec3& p) {
  const PatchFoot foot = closest(patch, p);
  return {-1, foot.s, foot.t, foot.distance2};
}
Foot foot_on(const QuadraticSegment& segment, const Vec3& p) {
  const PatchFoot foot = closest(segment, p);
  return {-1, foot.s, 0, foot.distance2};
}

// What a straight segment and patch have in common with a curved one.
using hextwist::corners, hextwist::length, hextwist::slope;
Vec3 point_of(const Segment& segment, double s) {
  return (1 - s) * segment[0] + s * segment[1];
}
Vec3 point_of(const QuadraticSegment& segment, double s) {
  return point(segment, s);
}
Vec3 slope(const Segment& segment, double) {
  return segment[1] - segment[0];
}
double length(const Segment& segment) {
  return (segment[1] - segment[0]).norm();
}
const BilinearPatch& corners(const BilinearPatch& patch) {
  return patch;
}

/// A skin of straight pieces.
struct Straight {
  using Patch = BilinearPatch;
  using Segment = std::array<Vec3, 2>;
  static constexpr std::array<const char*, 4> types = {"vertex", "polyline", "facets", "volume"};

  std::span<const Vec3> points;
  const SkinFeatures& skin;

  Segment segment(std::int32_t a, std::int32_t b) const { return {points[a], points[b]}; }
  Patch patch(std::size_t q) const {
    const auto& quad = skin.quads[q];
    return {points[quad[0]], points[quad[1]], points[quad[2]], points[quad[3]]};
  }
};
/// One of quadratic pieces.
struct Curved {
  using Patch = QuadraticPatch;
  using Segment = QuadraticSegment;
  static constexpr std::array<const char*, 4> types = {"vertex", "quadratic curve", "quadratic facets", "volume"};

  std::span<const Vec3> points;
  const SkinFeatures& skin;
  const FacetMiddles& middles;

  Segment segment(std::int32_t a, std::int32_t b) const {
    return segment_through(points[a], middles.middle(points, a, b), points[b]);
  }
  const Patch& patch(std::size_t q) const { return skin.patches[q]; }
};

double distance2(const CGAL::Bbox_3& box, const Vec3& p) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double gap = std::max({box.min(axis) - p[axis], 0.0, p[axis] - box.max(axis)});
    sum += gap * gap;
  }
  return sum;
}

/// The same for the box of an item's corners.
template <std::size_t n>
double box_distance2(const std::array<Vec3, n>& item, const Vec3& p) {
  Box box{item[0], item[0]};
  for (std::size_t i = 1; i < n; ++i) box.add(item[i]);
  return distance2(box, p);
}

/// The box of an item, for CGAL: a property map from its number.
template <class Item>
struct ItemBox {
  using key_type = std::int32_t;
  using value_type = CGAL::Bbox_3;
  using reference = CGAL::Bbox_3;
  using category = boost::readable_property_map_tag;
  const Item* items = nullptr;

  friend CGAL::Bbox_3 get(const ItemBox& map, std::int32_t id) {
    Box box;
    for (const Vec3& p : map.items[id]) box.add(p);
    return {box.min.x(), box.min.y(), box.min.z(), box.max.x(), box.max.y(), box.max.z()};
  }
};

struct ItemPrimitive {
  using Id = std::int32_t;
  using Point = Kernel::Point_3;
  using Datum = Kernel::Point_3;
  Id item = -1;
  Point centre;
  ItemPrimitive() = default;
  ItemPrimitive(Id id, const Vec3& at) : item(id), centre(at.x(), at.y(), at.z()) {}
  explicit ItemPrimitive(const ItemPrimitive* made) : ItemPrimitive(*made) {}  // as the tree's insert() wants it
  Id id() const { return item; }
  const Point& datum() const { return centre; }
  const Point& reference_point() const { return centre; }
};

/// CGAL's tree of boxes around patches or segments, asked with our own closest point and ray: its traversals are open
/// to any query. It is built at once and not changed, so that all queries are free of locks.
template <class Item>
class ItemTree {
 public:
  /// The items must outlive the tree and stay where they are.
  explicit ItemTree(std::span<const Item> items) : items_(items), tree_(Traits(ItemBox<Item>{items.data()})) {
    std::vector<ItemPrimitive> primitives(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) {
      Vec3 centre = Vec3::Zero();
      for (const Vec3& p : items[i]) centre += p / static_cast<double>(items[i].size());
      primitives[i] = {static_cast<std::int32_t>(i), centre};
    }
    tree_.insert(primitives.data(), primitives.data() + primitives.size());
    tree_.build();
  }

  /// The closest point that is strictly nearer than the root of `bound2`; item -1 if there is none. `start`: item to
  /// try first; it is taken at once if it is nearer than the root of `near2`.
  Foot closest(const Vec3& p, double bound2 = std::numeric_limits<double>::infinity(), std::int32_t start = -1,
               double near2 = 0) const {
    Closest query{items_, {}};
    query.best.distance2 = bound2;
    if (start >= 0) query.try_item(p, start);
    if (query.best.distance2 > near2) tree_.traversal_with_priority(p, query);
    return query.best;
  }

  /// Calls visit(item) for each item whose box the ray meets.
  template <class Visit>
  void along_ray(const Vec3& origin, const Vec3& direction, double slack, Visit visit) const {
    RayBoxes<Visit> query{origin, direction, slack, visit};
    tree_.traversal(origin, query);
  }

 private:
  using Traits = CGAL::AABB_traits<Kernel, ItemPrimitive, ItemBox<Item>>;
  using Tree = CGAL::AABB_tree<Traits>;
  using Node = CGAL::AABB_node<Traits>;

  struct Closest {
    using Priority = double;
    std::span<const Item> items;
    Foot best;

    void try_item(const Vec3& p, std::int32_t item) {
      // CGAL asks about both items of a leaf; most are done with their box.
      if (box_distance2(items[item], p) >= best.distance2) return;
      Foot foot = foot_on(items[item], p);
      foot.item = item;
      if (foot.distance2 < best.distance2) best = foot;
    }
    bool go_further() const { return best.distance2 > 0; }
    void intersection(const Vec3& p, const ItemPrimitive& primitive) { try_item(p, primitive.id()); }
    bool do_intersect(const Vec3& p, const Node& node) const { return distance2(node.bbox(), p) < best.distance2; }
    std::pair<bool, Priority> do_intersect_with_priority(const Vec3& p, const Node& node) const {
      const double gap2 = distance2(node.bbox(), p);
      return {gap2 < best.distance2, -gap2};
    }
  };

  template <class Visit>
  struct RayBoxes {
    const Vec3& origin;
    const Vec3& direction;  ///< no component may be 0
    double slack;
    Visit& visit;

    bool go_further() const { return true; }
    void intersection(const Vec3&, const ItemPrimitive& primitive) { visit(primitive.id()); }
    bool do_intersect(const Vec3&, const Node& node) const {
      double enter = 0, leave = std::numeric_limits<double>::infinity();
      for (int axis = 0; axis < 3; ++axis) {
        const double low = (node.bbox().min(axis) - slack - origin[axis]) / direction[axis];
        const double high = (node.bbox().max(axis) + slack - origin[axis]) / direction[axis];
        enter = std::max(enter, std::min(low, high));
        leave = std::min(leave, std::max(low, high));
      }
      return enter <= leave;
    }
  };

  std::span<const Item> items_;
  Tree tree_;
};

template <class Patch>
struct FacetSurface {
  std::vector<Patch> patches;
  std::vector<FacetNodes> quads;  ///< the nodes of the patches
  std::unique_ptr<const ItemTree<Patch>> tree;
  std::array<int, 2> volumes;
  Box box;
  double area = 0;
};

template <class Segment>
struct FacetCurve {
  std::vector<Segment> segments;
  std::vector<double> start;  ///< per segment: arc length where it starts; one more at the end
  std::unique_ptr<const ItemTree<Segment>> tree;
  bool closed = false;
  Box box;

  double length() const { return start.back(); }
  /// Segment and fraction at an arc length; a closed curve goes round.
  std::pair<std::int32_t, double> locate(double t) const {
    if (closed && (t < 0 || t >= length())) t -= length() * std::floor(t / length());
    const auto after = std::upper_bound(start.begin() + 1, start.end() - 1, t);
    const auto segment = static_cast<std::int32_t>(after - start.begin()) - 1;
    const double width = start[segment + 1] - start[segment];
    return {segment, width > 0 ? std::clamp((t - start[segment]) / width, 0.0, 1.0) : 0};
  }
  Vec3 point(double t) const {
    const auto [segment, s] = locate(t);
    return point_of(segments[segment], s);
  }
};

/// Kind: Straight or Curved.
template <class Kind>
class FacetModel final : public Model, public KnowsCurvature, public KnowsSource {
  using Patch = typename Kind::Patch;
  using Segment = typename Kind::Segment;

 public:
  FacetModel(std::span<const Vec3> points, const SkinFeatures& skin, const Kind& kind);
  using Model::project;

  int count(int dim) const override { return incidence_.count(dim); }
  std::string name(Owner) const override { return ""; }
  std::string type(Owner entity) const override { return Kind::types[entity.dim]; }
  double tolerance(Owner) const override { return 0; }
  std::vector<int> adjacent(Owner entity, int dim) const override { return incidence_.adjacent(entity, dim); }
  Box box() const override { return box_; }
  Box box(Owner entity) const override;
  double measure(Owner entity) const override;

  CurveRange range(int curve) const override {
    const FacetCurve<Segment>& c = curves_[curve - 1];
    return {0, c.length(), c.closed ? c.length() : 0};
  }
  Vec3 point(Owner entity, Parameters at) const override;
  Vec3 tangent(int curve, double t) const override {
    const auto [segment, s] = curves_[curve - 1].locate(t);
    return slope(curves_[curve - 1].segments[segment], s).stableNormalized();
  }
  Vec3 normal(int surface, Parameters at) const override {
    const Vec3 vector = area_vector(surfaces_[surface - 1].patches[facet_of(surface, at)], s_of(at), at.v);
    const double length = vector.stableNorm();
    return length > 0 ? Vec3(vector / length) : Vec3::Zero();
  }

  void project(Owner entity, std::span<const Vec3> points, std::span<const Parameters> seeds,
               std::span<Projection> out) const override;
  bool contains(int volume, const Vec3& p) const override;
  double curvature(Owner entity, Parameters at) const override;
  bool in_pieces() const override { return true; }
  std::vector<Bend> bends(Owner entity) const override;
  std::vector<int> near(int dim, const Vec3& p, double distance) const override;

 private:
  /// Surface parameters: u = 2 * facet + s leaves a gap between facets, so that s = 1 is not the next facet's 0.
  std::int32_t facet_of(int surface, Parameters at) const {
    const auto n = static_cast<double>(surfaces_[surface - 1].patches.size());
    return static_cast<std::int32_t>(std::clamp(std::floor(at.u / 2), 0.0, n - 1));
  }
  static double s_of(Parameters at) { return std::clamp(at.u - 2 * std::floor(at.u / 2), 0.0, 1.0); }

  Parameters closest_on_curve(const FacetCurve<Segment>& curve, const Vec3& p, Parameters seed) const;
  Parameters closest_on_surface(int surface, const Vec3& p, Parameters seed) const;

  /// Estimated when first asked for: most sessions never do.
  const std::vector<double>& curvatures(Owner entity) const;

  std::vector<Vec3> vertices_;
  std::vector<FacetCurve<Segment>> curves_;
  std::vector<FacetSurface<Patch>> surfaces_;
  std::vector<double> volumes_;  ///< measures
  Incidence incidence_;
  Box box_;
  std::vector<FacetEdge> features_;  ///< ascending
  mutable std::once_flag curvatures_known_;
  mutable std::array<std::vector<std::vector<double>>, 3> curvatures_;  ///< [dim][id - 1], per segment or facet
  double on_it2_ = 0;  ///< squared distance below which a point is on the seed's facet or segment: rounding only
};

template <class Kind>
FacetModel<Kind>::FacetModel(std::span<const Vec3> points, const SkinFeatures& skin, const Kind& kind)
    : curves_(skin.curve_nodes.size()),
      surfaces_(skin.n_surfaces),
      volumes_(skin.n_volumes, 0),
      incidence_({static_cast<int>(skin.classification.vertex_nodes.size()), static_cast<int>(skin.curve_nodes.size()),
                  skin.n_surfaces, skin.n_volumes}),
      features_(skin.classification.edges) {
  std::vector<int> vertex_at(points.size(), 0);
  for (const std::int32_t node : skin.classification.vertex_nodes) {
    vertices_.push_back(points[node]);
    vertex_at[node] = static_cast<int>(vertices_.size());
  }

  for (std::size_t c = 0; c < curves_.size(); ++c) {
    FacetCurve<Segment>& curve = curves_[c];
    const auto& nodes = skin.curve_nodes[c];
    const Owner owner{1, static_cast<int>(c) + 1};
    curve.closed = nodes.front() == nodes.back();
    curve.start.push_back(0);
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
      curve.segments.push_back(kind.segment(nodes[i], nodes[i + 1]));
      curve.start.push_back(curve.start.back() + length(curve.segments.back()));
    }
    for (const Segment& segment : curve.segments)
      for (const Vec3& p : segment) curve.box.add(p);
    for (const std::int32_t end : {nodes.front(), nodes.back()})
      if (vertex_at[end]) incidence_.add(owner, {0, vertex_at[end]});
    curve.tree = std::make_unique<ItemTree<Segment>>(std::span<const Segment>(curve.segments));
  }

  for (std::size_t q = 0; q < skin.quads.size(); ++q) {
    const int id = skin.classification.quad_surface[q];
    FacetSurface<Patch>& surface = surfaces_[id - 1];
    for (const std::int32_t node : skin.quads[q])
      if (vertex_at[node]) incidence_.add({2, id}, {0, vertex_at[node]});
    surface.patches.push_back(kind.patch(q));
    for (const Vec3& p : surface.patches.back()) surface.box.add(p);
    surface.quads.push_back(skin.quads[q]);
  }
  for (const auto& [surface, curve] : skin.surface_curves) incidence_.add({2, surface}, {1, curve});
  for (const FacetSurface<Patch>& surface : surfaces_) box_.add(surface.box);
  on_it2_ = 1e-30 * (box_.max - box_.min).squaredNorm();
  const Vec3 centre = (box_.min + box_.max) / 2;
  for (int s = 0; s < skin.n_surfaces; ++s) {
    FacetSurface<Patch>& surface = surfaces_[s];
    surface.volumes = skin.surface_volumes[s];
    double cones = 0;
    for (const Patch& patch : surface.patches) {
      surface.area += area(patch);
      cones += cone_volume(patch, centre);
    }
    const auto [behind, front] = surface.volumes;
    volumes_[behind - 1] += cones;
    if (front) volumes_[front - 1] -= cones;
    for (const int volume : {behind, front})
      if (volume) incidence_.add({3, volume}, {2, s + 1});
  }
  const auto make_tree = [&](std::size_t s) {
    surfaces_[s].tree = std::make_unique<ItemTree<Patch>>(std::span<const Patch>(surfaces_[s].patches));
  };
  parallel_each(surfaces_.size(), make_tree, 1);
  incidence_.close();
}

template <class Kind>
Box FacetModel<Kind>::box(Owner entity) const {
  Box result;
  switch (entity.dim) {
    case 0:
      result.add(vertices_[entity.id - 1]);
      break;
    case 1:
      result = curves_[entity.id - 1].box;
      break;
    case 2:
      result = surfaces_[entity.id - 1].box;
      break;
    default:
      for (const int surface : incidence_.adjacent(entity, 2)) result.add(surfaces_[surface - 1].box);
  }
  return result;
}

template <class Kind>
double FacetModel<Kind>::measure(Owner entity) const {
  switch (entity.dim) {
    case 0:
      return 0;
    case 1:
      return curves_[entity.id - 1].length();
    case 2:
      return surfaces_[entity.id - 1].area;
    default:
      return volumes_[entity.id - 1];
  }
}

template <class Kind>
Vec3 FacetModel<Kind>::point(Owner entity, Parameters at) const {
  if (entity.dim == 0) return vertices_[entity.id - 1];
  if (entity.dim == 1) return curves_[entity.id - 1].point(at.u);
  return hextwist::point(surfaces_[entity.id - 1].patches[facet_of(entity.id, at)], s_of(at), at.v);
}

template <class Kind>
Parameters FacetModel<Kind>::closest_on_curve(const FacetCurve<Segment>& curve, const Vec3& p, Parameters seed) const {
  const std::int32_t start = std::isfinite(seed.u) ? curve.locate(seed.u).first : -1;
  const Foot foot = curve.tree->closest(p, std::numeric_limits<double>::infinity(), start, on_it2_);
  const double from = curve.start[foot.item], to = curve.start[foot.item + 1];
  const double t = foot.s < 1 ? std::min(from + foot.s * (to - from), to) : to;
  return {curve.closed && t >= curve.length() ? 0 : t, std::numeric_limits<double>::quiet_NaN()};
}

template <class Kind>
Parameters FacetModel<Kind>::closest_on_surface(int surface, const Vec3& p, Parameters seed) const {
  const std::int32_t start = std::isfinite(seed.u) ? facet_of(surface, seed) : -1;
  const Foot foot = surfaces_[surface - 1].tree->closest(p, std::numeric_limits<double>::infinity(), start, on_it2_);
  return {2.0 * foot.item + foot.s, foot.t};
}

template <class Kind>
void FacetModel<Kind>::project(Owner entity, std::span<const Vec3> points, std::span<const Parameters> seeds,
                               std::span<Projection> out) const {
  assert(entity.dim >= 0 && entity.dim <= 2 && entity.id >= 1 && entity.id <= count(entity.dim));
  assert(out.size() == points.size() && (seeds.empty() || seeds.size() == points.size()));
  const auto one = [&](std::size_t i) {
    const Parameters seed = seeds.empty() ? Parameters{} : seeds[i];
    if (entity.dim == 0) out[i].parameters = {};
    if (entity.dim == 1) out[i].parameters = closest_on_curve(curves_[entity.id - 1], points[i], seed);
    if (entity.dim == 2) out[i].parameters = closest_on_surface(entity.id, points[i], seed);
    out[i].point = point(entity, out[i].parameters);
    out[i].distance = (points[i] - out[i].point).norm();
  };
  constexpr std::size_t worth_threads = 512;
  if (points.size() < worth_threads) {
    for (std::size_t i = 0; i < points.size(); ++i) one(i);
  } else {
    parallel_each(points.size(), one, 1);
  }
}

template <class Kind>
const std::vector<double>& FacetModel<Kind>::curvatures(Owner entity) const {
  // Without threads: one that waits in here could be given other work that needs this result.
  std::call_once(curvatures_known_, [&] {
    for (std::size_t c = 0; c < curves_.size(); ++c) {
      const FacetCurve<Segment>& curve = curves_[c];
      const bool corner = !incidence_.adjacent({1, static_cast<int>(c) + 1}, 0).empty();  // where a closed one starts
      std::vector<Vec3> points;
      for (const Segment& segment : curve.segments) points.push_back(segment[0]);
      points.push_back(curve.segments.back().back());
      curvatures_[1].push_back(segment_curvatures(points, curve.closed && !corner));
    }
    for (const FacetSurface<Patch>& surface : surfaces_) {
      std::vector<BilinearPatch> flat;
      for (const Patch& patch : surface.patches) flat.push_back(corners(patch));
      curvatures_[2].push_back(facet_curvatures(flat, surface.quads, features_));
    }
  });
  return curvatures_[entity.dim][entity.id - 1];
}

template <class Kind>
double FacetModel<Kind>::curvature(Owner entity, Parameters at) const {
  if (entity.dim == 1) return curvatures(entity)[curves_[entity.id - 1].locate(at.u).first];
  return entity.dim == 2 ? curvatures(entity)[facet_of(entity.id, at)] : 0;
}

template <class Kind>
std::vector<Bend> FacetModel<Kind>::bends(Owner entity) const {
  std::vector<Bend> result;
  if (entity.dim != 1 && entity.dim != 2) return result;
  const std::vector<double>& known = curvatures(entity);
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (known[i] == 0) continue;
    if (entity.dim == 2) {
      result.push_back({corners(surfaces_[entity.id - 1].patches[i]), known[i]});
    } else {
      const Segment& segment = curves_[entity.id - 1].segments[i];
      const Vec3 &from = segment.front(), &to = segment.back();
      result.push_back({{from, to, to, from}, known[i]});
    }
  }
  return result;
}

template <class Kind>
std::vector<int> FacetModel<Kind>::near(int dim, const Vec3& p, double distance) const {
  // A little more than asked for, since distances carry rounding.
  const double reach = distance * (1 + 1e-12) + 1e-14 * (box_.diagonal() + p.norm());
  const double reach2 = reach * reach;
  std::vector<int> ids;
  for (int id = 1; id <= count(dim); ++id) {
    const auto close = [&] {
      if (distance2(box({dim, id}), p) > reach2) return false;
      if (dim == 1) return curves_[id - 1].tree->closest(p, reach2).item >= 0;
      if (dim == 2) return surfaces_[id - 1].tree->closest(p, reach2).item >= 0;
      return true;
    };
    if (close()) ids.push_back(id);
  }
  return ids;
}

template <class Kind>
bool FacetModel<Kind>::contains(int volume, const Vec3& p) const {
  const auto& boundary = incidence_.adjacent({3, volume}, 2);
  const double slack = contains_slack * box_.diagonal();
  const auto is_near = [&](const Box& box) { return !(std::sqrt(distance2(box, p)) > slack); };
  if (!is_near(box({3, volume}))) return false;
  for (const int surface : boundary) {
    if (!is_near(surfaces_[surface - 1].box)) continue;
    if (surfaces_[surface - 1].tree->closest(p, slack * slack).item >= 0) return true;
  }
  // A ray from an inner point leaves the volume once more than it enters. Where a ray meets an edge or grazes a
  // facet, another direction decides; directions are fixed, so that answers repeat. If none of them were clear (a skin
  // of slivers), the last one's count stands.
  int count = 0;
  for (int attempt = 0; attempt < 20; ++attempt) {
    const double turn = 1 + 2.399963229728653 * attempt;  // golden angle
    const double height = 0.05 + 0.9 * std::fmod(0.6180339887498949 * (attempt + 1), 1.0);
    const double flat = std::sqrt(1 - height * height);
    const Vec3 direction(flat * std::cos(turn), flat * std::sin(turn), height);
    bool unsure = false;
    count = 0;
    for (const int surface : boundary) {
      const FacetSurface<Patch>& s = surfaces_[surface - 1];
      const int sign = s.volumes[0] == volume ? 1 : -1;
      s.tree->along_ray(p, direction, slack, [&](std::int32_t facet) {
        const Crossing crossing = pierce(s.patches[facet], p, direction);
        count += sign * crossing.count;
        unsure = unsure || crossing.unsure;
      });
    }
    if (!unsure) break;
  }
  return count > 0;
}

}  // namespace

FacetImport facet_model(std::span<const Vec3> points, std::span<const std::array<std::int32_t, 4>> quads,
                        std::span<const std::array<int, 2>> quad_volumes, const FacetModelOptions& options) {
  SkinFeatures skin =
      find_skin_features(points, quads, quad_volumes, options.feature_angle, options.labels, options.middles);
  FacetImport result;
  const auto keep_source = [&](auto model) {
    model->source = std::make_shared<const FacetSource>(source_of(points, quads, quad_volumes, options));
    result.model = std::move(model);
  };
  if (options.middles)
    keep_source(std::make_shared<FacetModel<Curved>>(points, skin, Curved{points, skin, *options.middles}));
  else
    keep_source(std::make_shared<FacetModel<Straight>>(points, skin, Straight{points, skin}));
  result.classification = std::move(skin.classification);
  return result;
}

}  // namespace hextwist
