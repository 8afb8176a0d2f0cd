#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "hextwist/base/parallel.h"
#include "hextwist/io/exodus/exodus_internal.h"
#include "hextwist/io/results.h"

namespace hextwist {
namespace {

/// A corner of a side in the order of files.
const Vec3& corner(const Mesh& mesh, const Side& side, std::size_t k) {
  return mesh.points[mesh.hexes[side.hex][io::exodus_cycle(side.face)[k]]];
}
Vec3 centre(const Mesh& mesh, const Side& side) {
  return (corner(mesh, side, 0) + corner(mesh, side, 1) + corner(mesh, side, 2) + corner(mesh, side, 3)) / 4;
}
/// Outwards, as long as the side is large.
Vec3 area(const Mesh& mesh, const Side& side) {
  return (corner(mesh, side, 2) - corner(mesh, side, 0)).cross(corner(mesh, side, 3) - corner(mesh, side, 1)) / 2;
}

/// A side before, as its place in the set, and what part of a side now it was.
struct SideThen {
  std::size_t side;
  double part;
};

class ResultsOn {
 public:
  explicit ResultsOn(const ResultsTo& to)
      : to_(to), results_(*to.before.results), then_(to.before, results_), now_(to.now, results_) {}

  std::shared_ptr<FileResults> made() {
    auto result = std::make_shared<FileResults>(results_);
    for (TimedValues& values : result->on_nodes)
      each(values, [&](const std::vector<double>& of_file) { return now_.on_nodes(of_file); });
    for (auto* list : {&result->on_hexes, &result->attributes})
      for (TimedValues& values : *list)
        each(values,
             [&](const std::vector<double>& of_file) { return to_.on_hexes(values.name, then_.on_hexes(of_file)); });
    for (SetExtras& set : result->node_sets) carry_nodes(set);
    for (SetExtras& set : result->side_sets) carry_sides(set);
    return result;
  }

 private:
  template <class F>
  static void each(TimedValues& values, F&& f) {
    for (auto& at : values.at)
      if (at) at = std::make_shared<const std::vector<double>>(f(*at));
  }

  void carry_nodes(SetExtras& set) {
    const auto found = std::ranges::find(to_.now.node_sets, set.id, &NodeSet::id);
    if (set.nodes.empty() || found == to_.now.node_sets.end()) return;
    const SetExtras then = set;
    set.nodes = found->nodes;
    for (TimedValues& values : set.variables)
      each(values, [&](const std::vector<double>& of) { return now_.in_set(set.nodes, then, of, 0); });
    if (set.factors.size() > 1) set.factors = now_.in_set(set.nodes, then, then.factors, 1);
  }

  void carry_sides(SetExtras& set) {
    const auto was = std::ranges::find(to_.before.side_sets, set.id, &SideSet::id);
    const auto found = std::ranges::find(to_.now.side_sets, set.id, &SideSet::id);
    if (set.sides.empty() || was == to_.before.side_sets.end() || found == to_.now.side_sets.end()) return;
    const SetExtras then = set;
    set.sides = found->sides;
    std::vector<std::vector<SideThen>> from(set.sides.size());
    parallel_each(from.size(), [&](std::size_t i) { from[i] = sides_then(set.sides[i], was->sides); });
    for (TimedValues& values : set.variables)
      each(values, [&](const std::vector<double>& of) {
        const std::vector<double> value = then_.in_set(was->sides, then, of, 0);
        std::vector<double> result(from.size(), 0);
        for (std::size_t i = 0; i < from.size(); ++i)
          for (const SideThen& side : from[i]) result[i] += side.part * value[side.side];
        return result;
      });
    if (set.factors.size() < 2) return;
    // Between the corners of one hex; of several, what their corners had.
    std::vector<double> all = now_.factors(set.sides, then);
    const std::vector<double> at_corners = factors(then_.factors(was->sides, then), was->sides, set.sides, from);
    for (std::size_t i = 0; i < from.size(); ++i)
      if (to_.hexes_before(set.sides[i].hex).size() > 1) std::copy_n(&at_corners[4 * i], 4, &all[4 * i]);
    set.factors = std::move(all);
  }

  /// Of the hexes before: the sides of the set that face where this one does, else the nearest.
  std::vector<SideThen> sides_then(const Side& side, std::span<const Side> then) const {
    const Vec3 outwards = area(to_.now, side), middle = centre(to_.now, side);
    std::vector<SideThen> result;
    SideThen nearest{0, 0};
    double total = 0, least = std::numeric_limits<double>::infinity();
    for (const Index hex : to_.hexes_before(side.hex)) {
      const auto of_hex = std::ranges::equal_range(then, hex, {}, &Side::hex);
      for (auto each = of_hex.begin(); each != of_hex.end(); ++each) {
        const Vec3 there = area(to_.before, *each);
        const auto place = static_cast<std::size_t>(each - then.begin());
        if (there.dot(outwards) > 0.5 * there.norm() * outwards.norm()) {
          result.push_back({place, there.norm()});
          total += there.norm();
        }
        if (const double distance = (centre(to_.before, *each) - middle).norm(); distance < least) {
          least = distance;
          nearest = {place, 1};
        }
      }
    }
    for (SideThen& each : result) each.part /= total;
    if (result.empty() && nearest.part > 0) result.push_back(nearest);
    return result;
  }

  /// Four per side: of the corner before that is nearest, which for a coarser hex is the same.
  std::vector<double> factors(const std::vector<double>& known, std::span<const Side> before, std::span<const Side> now,
                              const std::vector<std::vector<SideThen>>& from) const {
    std::vector<double> result(4 * now.size(), 1);
    parallel_each(now.size(), [&](std::size_t i) {
      for (std::size_t k = 0; k < 4; ++k) {
        double least = std::numeric_limits<double>::infinity();
        for (const SideThen& each : from[i])
          for (std::size_t j = 0; j < 4; ++j) {
            const double distance = (corner(to_.before, before[each.side], j) - corner(to_.now, now[i], k)).norm();
            if (distance >= least) continue;
            least = distance;
            result[4 * i + k] = known[4 * each.side + j];
          }
      }
    });
    return result;
  }

  const ResultsTo& to_;
  const FileResults& results_;
  ExtrasNow then_, now_;
};

}  // namespace

std::shared_ptr<FileResults> results_on(const ResultsTo& to) {
  return ResultsOn(to).made();
}

}  // namespace hextwist
