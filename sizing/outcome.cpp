#include "hextwist/sizing/outcome.h"

#include <algorithm>
#include <limits>

#include "hextwist/base/sorted.h"
#include "hextwist/mesh/neighbourhood.h"

namespace hextwist {
namespace {

constexpr double flat_part = 1e-3;     // of the worst hex around in the input
constexpr double poor_part = 0.2;      // of the worst hex of an input that is poorer than that
constexpr std::size_t max_worst = 5;   // ids that are told
constexpr double on_its_owner = 1e-7;  // of the model size

/// The smallest scaled Jacobian among the hexes around each of these hexes, themselves among them.
std::vector<double> smallest_around(const Mesh& mesh, std::span<const Index> hexes) {
  std::vector<std::uint8_t> marked(mesh.points.size(), 0);
  for (const Index h : hexes)
    for (const Index n : mesh.hexes[h]) marked[n] = 1;
  std::vector<double> at_node(mesh.points.size(), std::numeric_limits<double>::infinity());
  for (const Index h : touching_hexes(mesh.hexes, marked)) {
    const double value = quality(Metric::scaled_jacobian, mesh, h);
    for (const Index n : mesh.hexes[h]) at_node[n] = std::min(at_node[n], value);
  }
  std::vector<double> smallest;
  for (const Index h : hexes) {
    double least = std::numeric_limits<double>::infinity();
    for (const Index n : mesh.hexes[h]) least = std::min(least, at_node[n]);
    smallest.push_back(least);
  }
  return smallest;
}

}  // namespace

std::vector<Index> flattened_hexes(const Mesh& input, const Mesh& refined, std::span<const Index> origin,
                                   std::span<const Index> low) {
  std::vector<Index> flat, from;
  for (const Index h : low)
    if (!(quality(Metric::scaled_jacobian, refined, h) >= flat_part)) flat.push_back(h);
  if (flat.empty()) return flat;
  for (const Index h : flat) from.push_back(origin[h]);
  sort_unique(from);
  const std::vector<double> around = smallest_around(input, from);
  std::erase_if(flat, [&](Index h) {
    return quality(Metric::scaled_jacobian, refined, h) >= flat_part * around[position_in(from, origin[h])];
  });
  return flat;
}

PoorHexes poor_hexes(const Mesh& input, const Summary& before, const Mesh& refined, std::span<const Index> low) {
  PoorHexes poor{.limit = poor_quality};
  if (low.empty()) return poor;
  const double worst = before.count > 0 ? before.min : summarize(quality(Metric::scaled_jacobian, input)).min;
  if (worst < poor_quality) poor.limit = poor_part * worst;
  std::vector<std::pair<double, Index>> below;
  for (const Index h : low)
    if (const double value = quality(Metric::scaled_jacobian, refined, h); !(value >= poor.limit))
      below.emplace_back(value, h);
  poor.count = static_cast<Index>(below.size());
  std::ranges::sort(below);
  if (!below.empty()) poor.smallest = below.front().first;
  for (std::size_t i = 0; i < std::min(below.size(), max_worst); ++i) poor.worst.push_back(below[i].second);
  return poor;
}

std::vector<OffOwner> still_off(const MeshedModel& refined, std::span<const OffOwner> nodes) {
  std::vector<OffOwner> off;
  for (OffOwner row : nodes) {
    row.distance = refined.model->project(row.owner, refined.mesh.points[row.node]).distance;
    const double allowed =
        std::max(on_its_owner * refined.model->box().diagonal(), refined.model->tolerance(row.owner));
    if (!(row.distance <= allowed)) off.push_back(row);
  }
  std::ranges::sort(off, {}, &OffOwner::node);
  off.erase(std::ranges::unique(off, {}, &OffOwner::node).begin(), off.end());
  return off;
}

}  // namespace hextwist
