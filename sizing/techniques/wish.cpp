#include <algorithm>
#include <cmath>
#include <numbers>

#include "hextwist/base/memory.h"
#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/refine/marks.h"
#include "hextwist/refine/templates/trisect.h"
#include "hextwist/sizing/among_parts.h"
#include "hextwist/sizing/fields/growing.h"
#include "hextwist/sizing/size_report.h"
#include "hextwist/sizing/sizes_of_all.h"
#include "hextwist/sizing/targets.h"
#include "hextwist/sizing/techniques/wish_internal.h"

namespace hextwist {
namespace {

/// An edge is cut while it is longer than this times the wish, so that its pieces are no shorter than one over this.
constexpr double most_too_long = std::numbers::sqrt3;

SizeFieldPtr wish_of(const MeshedModel& input, const Request& request) {
  const Sizes& sizes = std::get<Sizes>(request.how);
  std::vector<SizeFieldPtr> fields;
  if (sizes.size)
    fields.push_back(growing_size(
        *sizes.size, sizes.bias,
        sizes.bias == 1 ? nullptr : std::make_shared<TargetDistance>(input, request.target.kind, request.target.ids)));
  if (sizes.field) {
    fields.push_back(sizes.field);
    if (sizes.bias > 1) fields.push_back(limited_growth(input.mesh, sizes.field, sizes.bias));
  }
  return smallest_of(std::move(fields));
}

/// Eight for each hex.
std::vector<Vec3> corners_of(const Mesh& mesh, std::span<const Index> hexes) {
  std::vector<Vec3> corners;
  corners.reserve(hexes.size() * n_hex_corners);
  for (const Index h : hexes)
    for (const Index n : mesh.hexes[h]) corners.push_back(mesh.points[n]);
  return corners;
}

}  // namespace

SizeWish::SizeWish(const MeshedModel& input, const Request& request, double diagonal)
    : field_(wish_of(input, request)), dimension_(dimension(request.target.kind)) {
  const Sizes& sizes = std::get<Sizes>(request.how);
  const Target& target = request.target;
  is_everywhere_ = sizes.bias > 1 && !target.depth && !target.radius;
  is_constant_ = sizes.bias == 1 && !sizes.field;
  most_pieces_ = std::pow(3.0, sizes.max_passes);
  // Nodes or vertices for which a size was named: no edges lie on them, so the hexes that touch them are what is to
  // have that size.
  is_point_ = sizes.size && (target.kind == EntityKind::node || target.kind == EntityKind::vertex);
  close_ = 1e-6 * diagonal;
  if (sizes.size && !is_solid(target.kind)) distance_.emplace(input, target.kind, target.ids);
}

std::vector<std::uint8_t> SizeWish::zone(const Mesh& mesh, std::span<const Index> region) const {
  std::vector<std::uint8_t> in_zone(mesh.hexes.size(), is_everywhere_);
  for (const Index h : region) in_zone[h] = 1;
  return in_zone;
}

/// Per point: does it lie on the target? Nothing lies on hexes and volumes, nor where no size was named for it.
std::vector<std::uint8_t> SizeWish::at_target(std::span<const Vec3> points) const {
  std::vector<std::uint8_t> result(points.size(), 0);
  if (!distance_) return result;
  std::vector<double> far(points.size());
  distance_->evaluate(points, far);
  for (std::size_t i = 0; i < far.size(); ++i) result[i] = far[i] <= close_;
  return result;
}

std::vector<Index> SizeWish::too_large(const Mesh& mesh, std::span<const std::uint8_t> in_zone) const {
  // Most hexes are small enough, by the boxes around them, for the smallest wish that there could be at all, or near
  // them.
  constexpr double rounding = 1e-12;
  const auto is_above = [](double volume, double wished) {
    const double most = most_too_long * wished;
    return volume * (1 + rounding) > most * most * most;
  };
  const auto volume_of = [](const Box& around) { return (around.max - around.min).prod(); };
  const double least = field_->least();
  const std::vector<Index> asked = indices_where(mesh.n_hexes(), [&](Index h) {
    if (!in_zone[h]) return false;
    const Box around = box(mesh, h);
    const double volume = volume_of(around);
    if (!is_above(volume, least)) return false;
    const Vec3 centre = centroid(mesh, h);
    const bool may_touch_point = is_point_ && distance_->at_least(centre) <= around.diagonal();
    return may_touch_point || is_above(volume, field_->least_at(centre));
  });
  std::vector<double> wished = wished_sizes(mesh, asked, *field_);
  if (is_point_) {
    // A corner at the target wishes for all of the hex.
    const std::vector<Vec3> corners = corners_of(mesh, asked);
    const std::vector<std::uint8_t> on_it = at_target(corners);
    std::vector<double> there(corners.size());
    field_->evaluate(corners, there);
    for (std::size_t i = 0; i < there.size(); ++i)
      if (on_it[i]) wished[i / n_hex_corners] = std::min(wished[i / n_hex_corners], there[i]);
  }
  // No hex is larger than its box, and exact volumes cost more.
  const std::vector<Index> left = indices_where(
      static_cast<Index>(asked.size()), [&](Index i) { return is_above(volume_of(box(mesh, asked[i])), wished[i]); });
  const std::vector<double> size = actual_sizes(mesh, items_at(asked, left));
  std::vector<Index> result;
  for (std::size_t i = 0; i < left.size(); ++i)
    if (size[i] > most_too_long * wished[left[i]]) result.push_back(asked[left[i]]);
  return result;
}

std::vector<Index> SizeWish::nodes_too_far_apart(const Mesh& mesh, std::span<const std::uint8_t> in_zone) const {
  if (!distance_) return {};
  const std::vector<Index> nodes =
      indices_where(mesh.n_nodes(), [&](Index n) { return distance_->at_least(mesh.points[n]) <= close_; });
  std::vector<Vec3> points;
  for (const Index n : nodes) points.push_back(mesh.points[n]);
  const std::vector<std::uint8_t> on_it = at_target(points);
  std::vector<double> wished(nodes.size());
  field_->evaluate(points, wished);
  std::vector<Index> place(mesh.points.size(), -1);  // in `nodes`, of those on the target
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (on_it[i]) place[nodes[i]] = static_cast<Index>(i);
  const std::vector<Index> hexes = indices_where(mesh.n_hexes(), [&](Index h) {
    return in_zone[h] && std::ranges::count_if(mesh.hexes[h], [&](Index n) { return place[n] >= 0; }) > 1;
  });
  std::vector<Index> result;
  for (const Index h : hexes)
    for (int e = 0; e < n_hex_edges; ++e) {
      const Edge edge = {mesh.hexes[h][edge_corner(e, 0)], mesh.hexes[h][edge_corner(e, 1)]};
      const Index a = place[edge[0]], b = place[edge[1]];
      if (a < 0 || b < 0) continue;
      const double length = (mesh.points[edge[0]] - mesh.points[edge[1]]).norm();
      if (length > most_too_long * std::max(wished[a], wished[b]))
        result.insert(result.end(), edge.begin(), edge.end());
    }
  return result;
}

/// Those of the hexes that have a corner at the target, where that is points.
std::vector<Index> SizeWish::at_points(const Mesh& mesh, std::span<const Index> hexes) const {
  std::vector<Index> result;
  if (!is_point_) return result;
  const std::vector<std::uint8_t> on_it = at_target(corners_of(mesh, hexes));
  for (std::size_t i = 0; i < hexes.size(); ++i)
    if (std::ranges::count(std::span(on_it).subspan(i * n_hex_corners, n_hex_corners), 1) > 0)
      result.push_back(hexes[i]);
  return result;
}

double SizeWish::least_more(const Mesh& mesh, std::span<const Index> too_large, bool by_threes) const {
  // A hex becomes at least as many as stand along (a curve), on (a surface) or in the target; all of them have one wish
  // that is the same everywhere.
  const std::vector<double> size = actual_sizes(mesh, too_large), wished = wished_sizes(mesh, too_large, *field_);
  double n = 0;
  for (std::size_t i = 0; i < size.size(); ++i) {
    double along = std::clamp(size[i] / (most_too_long * wished[i]), 1.0, most_pieces_);
    if (by_threes && is_constant_) {
      constexpr double rounding = 1e-9;
      along = std::pow(3.0, std::ceil(std::log(along) / std::log(3.0) - rounding));
    }
    n += std::pow(along, is_constant_ ? 3 : dimension_) - 1;
  }
  return n;
}

void SizeWish::check_fits(const Mesh& mesh, std::span<const Index> too_large, Index n_outside, bool by_threes) const {
  const double n = static_cast<double>(mesh.n_hexes()) + n_outside + least_more(mesh, too_large, by_threes);
  check_memory(n, n, "at least ");
}

/// Marks the nodes of these hexes at which the wish is less than their size by more than the factor.
void SizeWish::mark_wishing_nodes(const Mesh& mesh, std::span<const Index> hexes,
                                  std::span<std::uint8_t> marked) const {
  const std::vector<double> size = actual_sizes(mesh, hexes);
  const std::vector<Vec3> corners = corners_of(mesh, hexes);
  std::vector<double> wished(corners.size());
  field_->evaluate(corners, wished);
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (size[i / n_hex_corners] > most_too_long * wished[i])
      marked[mesh.hexes[hexes[i / n_hex_corners]][i % n_hex_corners]] = 1;
}

/// The nodes of too large hexes at which the wish is smaller than the hex. Where the wish varies within a hex, only its
/// fine side is cut then, and the children lie between fine and coarse as the wish does; cutting all of it would put
/// the transition into its neighbours, which are small enough already. A hex in which nothing would be cut that way is
/// cut whole, and so are all where the wish is constant or jumps (size_field.h).
std::vector<std::uint8_t> SizeWish::marks(const Mesh& mesh, std::span<const Index> too_large,
                                          std::span<const Index> too_far_apart) const {
  if (too_large.empty() && too_far_apart.empty()) return {};
  std::vector<std::uint8_t> marked(mesh.points.size(), 0);
  for (const Index n : too_far_apart) marked[n] = 1;
  const auto missed = [&] {
    std::vector<Index> hexes;
    for (const Index h : too_large)
      if (edge_mask_of_corners(corner_mask(mesh.hexes[h], marked)) == 0) hexes.push_back(h);
    return hexes;
  };
  mark_nodes(mesh.hexes, at_points(mesh, too_large), marked);
  if (is_constant_ || field_->jumps()) mark_nodes(mesh.hexes, too_large, marked);
  mark_wishing_nodes(mesh, missed(), marked);
  mark_nodes(mesh.hexes, missed(), marked);
  return marked;
}

std::shared_ptr<const SizeWish> size_wish(const State& state) {
  if (state.among) return std::make_shared<const SizeWish>(state.input, state.request, state.among->diagonal);
  return state.part ? state.part->all.wish : std::make_shared<const SizeWish>(state.input, state.request);
}

std::vector<Index> size_region(State& state) {
  std::vector<std::string>& notices = state.report.notices;
  if (state.among) return state.among->region;
  if (!state.part) return region_target(state.input, state.request.target, notices);
  notices.insert(notices.end(), state.part->all.told.begin(), state.part->all.told.end());
  return state.part->region;
}

CombinationTarget size_target(State& state) {
  std::vector<std::string>& notices = state.report.notices;
  if (state.part) return state.part->target(notices);
  if (state.among && state.among->region.empty()) return {};  // others have it
  return sub_element_target(state.input, state.request.target, notices);
}

Index n_outside(const State& state) {
  return state.part ? state.part->n_outside : 0;
}

}  // namespace hextwist
