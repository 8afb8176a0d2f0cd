#include "hextwist/refine/levels/mirror.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "hextwist/base/sorted.h"

namespace hextwist {
namespace {

/// A node of some level on the corner, edge or face of a base hex that it lies in: the nodes there, and what each
/// weighs in its place (they sum up to n, n squared on a face).
struct OnFeature {
  std::array<Index, 4> nodes{};
  std::array<std::int64_t, 4> weights{};
  int count = 0;
};

/// Nothing: it lies inside the hex.
std::optional<OnFeature> feature_of(const Hex& hex, const std::array<Index, 3>& at, Index n) {
  int corner = 0;
  std::array<int, 3> along{};
  int n_along = 0;
  for (int axis = 0; axis < 3; ++axis)
    if (at[axis] > 0 && at[axis] < n)
      along[n_along++] = axis;
    else
      corner |= (at[axis] > 0) << axis;
  if (n_along == 3) return std::nullopt;
  OnFeature result;
  result.count = 1 << n_along;
  for (int i = 0; i < result.count; ++i) {
    int c = corner;
    std::int64_t weight = 1;
    for (int k = 0; k < n_along; ++k) {
      const bool far = (i >> k & 1) != 0;
      if (far) c |= 1 << along[k];
      weight *= far ? at[along[k]] : n - at[along[k]];
    }
    result.nodes[i] = hex[c];
    result.weights[i] = weight;
  }
  return result;
}

/// A cell that has the node, and which corner of it that is.
std::optional<std::pair<CellNumber, std::uint8_t>> cell_at(const OnFeature& feature, Index n,
                                                           std::span<const Hex> hexes, const CompressedRows& corners) {
  for (const Index candidate : corners[feature.nodes[0]]) {
    const Index root = candidate >> 3;
    std::int64_t sum = 0;
    std::array<std::int64_t, 3> moment{};
    int found = 0;
    for (int i = 0; i < feature.count; ++i)
      for (int c = 0; c < 8; ++c) {
        if (hexes[root][c] != feature.nodes[i]) continue;
        ++found;
        sum += feature.weights[i];
        for (int axis = 0; axis < 3; ++axis) moment[axis] += (c >> axis & 1) * feature.weights[i];
        break;
      }
    if (found != feature.count) continue;
    CellPlace place{root, {}};
    std::uint8_t corner = 0;
    bool exact = true;
    for (int axis = 0; axis < 3; ++axis) {
      exact = exact && moment[axis] * n % sum == 0;
      const auto at = static_cast<Index>(moment[axis] * n / sum);
      place.at[axis] = std::min(at, n - 1);
      corner |= static_cast<std::uint8_t>((at - place.at[axis]) << axis);
    }
    if (exact) return std::pair(number_of(place, n), static_cast<std::uint8_t>(1u << corner));
  }
  return std::nullopt;
}

}  // namespace

std::shared_ptr<const Mirror> mirror_of(const MeshedModel& base, std::span<const PeriodicPair> pairs) {
  auto mirror = std::make_shared<Mirror>();
  mirror->surfaces = periodic_surfaces(pairs);
  for (const PeriodicPair& pair : pairs) {
    std::vector<NodePair> there = node_pairs(base.mesh, base.association, pair), back;
    for (const auto& [of, image] : there) back.push_back({image, of});
    std::ranges::sort(back);
    mirror->images.push_back(std::move(there));
    mirror->images.push_back(std::move(back));
  }
  return mirror;
}

void mark_images(CellMarks& marks, std::size_t level, std::span<const Hex> base_hexes,
                 const CompressedRows& base_corners, const Mirror& mirror) {
  Index n = 1;
  for (std::size_t k = 0; k < level; ++k) n *= 3;
  for (CellMarks fresh = marks; !fresh.empty();) {
    CellMarks found;
    for (std::size_t i = 0; i < fresh.size(); ++i) {
      const CellPlace place = place_of(fresh.cell[i], level);
      for (int c = 0; c < 8; ++c) {
        if (!(fresh.corners[i] >> c & 1)) continue;
        std::array<Index, 3> at = place.at;
        for (int axis = 0; axis < 3; ++axis) at[axis] += c >> axis & 1;
        const std::optional<OnFeature> feature = feature_of(base_hexes[place.root], at, n);
        if (!feature) continue;
        for (const std::vector<NodePair>& images : mirror.images) {
          OnFeature there = *feature;
          bool all = true;
          for (int k = 0; k < there.count && all; ++k) {
            const Index known = position_in(images, there.nodes[k], [](const NodePair& pair) { return pair[0]; });
            all = known >= 0;
            if (all) there.nodes[k] = images[known][1];
          }
          if (!all) continue;
          if (const auto cell = cell_at(there, n, base_hexes, base_corners)) found.add(cell->first, cell->second);
        }
      }
    }
    normalize(found);
    // What was not marked yet goes on.
    fresh = {};
    for (std::size_t i = 0; i < found.size(); ++i) {
      const Index known = position_in(marks.cell, found.cell[i]);
      const auto more = static_cast<std::uint8_t>(found.corners[i] & (known < 0 ? 0xff : ~marks.corners[known]));
      if (more != 0) fresh.add(found.cell[i], more);
    }
    marks = united(marks, fresh);
  }
}

}  // namespace hextwist
