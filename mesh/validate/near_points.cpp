// Nearly coincident points by hashing them to cells much wider than the tolerance: nearly every point has only its own
// cell to look at, the few next to a cell wall also the cell behind it. Most points are alone in their cells, which a
// bit for every hash tells; only the others are compared.
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <tuple>

#include "hextwist/base/parallel.h"
#include "hextwist/base/union_find.h"
#include "hextwist/mesh/validate/validate_parts.h"

namespace hextwist {
namespace {

using Cell = std::array<std::int64_t, 3>;

std::uint64_t hash(const Cell& cell) {
  std::uint64_t h = 0;
  for (const std::int64_t i : cell) {  // collisions only cost time
    h = (h ^ static_cast<std::uint64_t>(i)) * 0x9e3779b97f4a7c15;
    h ^= h >> 32;
  }
  return h;
}

struct HashedPoint {
  std::uint64_t hash;
  Index point;
};

struct Cells {
  Vec3 origin;
  double tolerance;
  // A width that round coordinates are no multiples of.
  double width = 1000.7310585786 * tolerance;

  Vec3 place(const Vec3& p) const { return (p - origin) / width; }
  Cell cell(const Vec3& p) const {
    const Vec3 at = place(p);
    return {static_cast<std::int64_t>(std::floor(at.x())), static_cast<std::int64_t>(std::floor(at.y())),
            static_cast<std::int64_t>(std::floor(at.z()))};
  }
};

/// Calls f(cell) for the cells other than its own that come within tolerance of p.
template <class F>
void for_near_cells(const Cells& cells, const Vec3& p, F f) {
  const Cell own = cells.cell(p);
  const Vec3 at = cells.place(p);
  const double margin = 1.001 * cells.tolerance / cells.width;
  std::array<int, 3> low{}, high{};
  for (int axis = 0; axis < 3; ++axis) {
    const double fraction = at[axis] - std::floor(at[axis]);
    low[axis] = fraction <= margin ? -1 : 0;
    high[axis] = 1 - fraction <= margin ? 1 : 0;
  }
  for (int i = low[0]; i <= high[0]; ++i)
    for (int j = low[1]; j <= high[1]; ++j)
      for (int k = low[2]; k <= high[2]; ++k)
        if (i || j || k) f(Cell{own[0] + i, own[1] + j, own[2] + k});
}

/// Points that may share a cell with another one, or lie within tolerance of its wall: those with a hash that some
/// other hash is like in its lowest bits. Ascending; all that are near another point are among them.
std::vector<Index> not_alone(const Cells& cells, std::span<const Vec3> points) {
  constexpr std::size_t slots_of_point = 16;
  const std::size_t n_slots = std::bit_ceil(slots_of_point * points.size() + 64);
  std::vector<std::uint64_t> once(n_slots / 64), twice(n_slots / 64);
  const auto place = [&](std::uint64_t h) { return h & (n_slots - 1); };
  const auto bit = [](std::size_t slot) { return std::uint64_t{1} << (slot & 63); };
  const auto set = [&](const Cell& cell) {
    const std::size_t slot = place(hash(cell));
    const auto order = std::memory_order_relaxed;
    if (std::atomic_ref(once[slot >> 6]).fetch_or(bit(slot), order) & bit(slot))
      std::atomic_ref(twice[slot >> 6]).fetch_or(bit(slot), order);
  };
  const auto n = static_cast<Index>(points.size());
  parallel_ranges(n, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      if (!points[i].allFinite()) continue;
      set(cells.cell(points[i]));
      for_near_cells(cells, points[i], set);
    }
  });
  return indices_where(n, [&](Index i) {
    if (!points[i].allFinite()) return false;
    bool any = false;
    const auto ask = [&](const Cell& cell) {
      const std::size_t slot = place(hash(cell));
      any |= (twice[slot >> 6] & bit(slot)) != 0;
    };
    ask(cells.cell(points[i]));
    for_near_cells(cells, points[i], ask);
    return any;
  });
}

}  // namespace

std::vector<std::vector<Index>> near_points(std::span<const Vec3> points, double tolerance) {
  const auto n = static_cast<Index>(points.size());
  Box box;
  for (const Vec3& p : points)
    if (p.allFinite()) box.add(p);
  const double size = box.diagonal();
  if (!(tolerance >= 0) || !std::isfinite(size)) return {};
  // Coordinates are exact to about 1e-16 of the size: a smaller tolerance means equal, and cells must be fewer
  // than an integer can count.
  tolerance = std::max(tolerance, 1e-16 * size);
  const Cells cells = {box.min - Vec3::Constant(0.3 * tolerance), tolerance > 0 ? tolerance : 1};

  const std::vector<Index> candidates = not_alone(cells, points);
  std::vector<HashedPoint> entries(candidates.size());
  parallel_each(candidates.size(), [&](std::size_t i) {
    entries[i] = {hash(cells.cell(points[candidates[i]])), candidates[i]};
  });
  const auto key = [&](const HashedPoint& e) {
    const Vec3& p = points[e.point];
    return std::make_tuple(e.hash, p.x(), p.y(), p.z(), e.point);
  };
  tbb::parallel_sort(entries.begin(), entries.end(), [&](const HashedPoint& a, const HashedPoint& b) {
    return a.hash != b.hash ? a.hash < b.hash : key(a) < key(b);
  });

  std::vector<Index> parent = singletons(n);
  const auto same_place = [&](const HashedPoint& a, const HashedPoint& b) {
    return points[a.point] == points[b.point];
  };
  const auto near = [&](const HashedPoint& a, const HashedPoint& b) {
    return (points[a.point] - points[b.point]).squaredNorm() <= tolerance * tolerance;
  };
  parallel_ranges(static_cast<Index>(entries.size()), [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      const HashedPoint& e = entries[i];
      // Points at exactly the same place are joined to the first of them, which alone looks further.
      if (i > 0 && entries[i - 1].hash == e.hash && same_place(entries[i - 1], e)) {
        join(parent, entries[i - 1].point, e.point);
        continue;
      }
      for (std::size_t j = i + 1; j < entries.size() && entries[j].hash == e.hash &&
                                  points[entries[j].point].x() - points[e.point].x() <= tolerance;
           ++j)
        if (near(e, entries[j])) join(parent, e.point, entries[j].point);
      for_near_cells(cells, points[e.point], [&](const Cell& cell) {
        const std::uint64_t wanted = hash(cell);
        for (auto other = std::ranges::lower_bound(entries, wanted, {}, &HashedPoint::hash);
             other != entries.end() && other->hash == wanted; ++other)
          if (near(e, *other)) join(parent, e.point, other->point);
      });
    }
  });

  std::vector<std::vector<Index>> groups;
  std::vector<Index> group_of(n, -1);
  for (Index i = 0; i < n; ++i) {
    const Index root = find_root(parent, i);
    if (root == i) continue;  // the first of its group, or alone
    if (group_of[root] < 0) {
      group_of[root] = static_cast<Index>(groups.size());
      groups.push_back({root});
    }
    groups[group_of[root]].push_back(i);
  }
  std::ranges::sort(groups, {}, [](const auto& group) { return group[0]; });
  return groups;
}

}  // namespace hextwist
