// A tree of boxes: which item is nearest to a point, which ones may meet something. What items are, only the caller
// knows.
//
// Immutable after construction, so any number of threads may ask; of items at the same distance the lowest number wins,
// so the answer does not depend on the tree's shape.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hextwist/base/types.h"

namespace hextwist {

struct NearItem {
  std::int32_t item = -1;  ///< -1: nothing within the bound
  double distance2 = std::numeric_limits<double>::infinity();
};

class BoxTree {
 public:
  BoxTree() = default;
  /// One box per item, none empty. Built on all threads.
  explicit BoxTree(std::span<const Box> boxes);

  /// The item for which item_distance2(item), a squared distance no less than that of its box, is smallest and at most
  /// `bound2`.
  template <class ItemDistance2>
  NearItem nearest(const Vec3& p, const ItemDistance2& item_distance2,
                   double bound2 = std::numeric_limits<double>::infinity()) const {
    NearItem best{-1, bound2};
    if (!items_.empty() && distance2(nodes_[0], p) <= bound2) search(p, item_distance2, best, 0, 0, items_.size());
    return best;
  }

  /// Calls found(item) for all items in leaves to which overlap(box) leads from the root; their own boxes are not
  /// asked.
  template <class Overlap, class Found>
  void visit(const Overlap& overlap, const Found& found) const {
    if (!items_.empty()) visit(overlap, found, 0, 0, items_.size());
  }

 private:
  // Node i has items begin .. end - 1; its halves are 2 i + 1 and 2 i + 2, so that no path is longer than the logarithm
  // of the number of items.
  static constexpr std::size_t leaf_size = 8;
  static std::size_t middle(std::size_t begin, std::size_t end) { return begin + (end - begin) / 2; }

  void build(std::span<const Box> boxes, std::span<const Vec3> centres, std::size_t node, std::size_t begin,
             std::size_t end);

  template <class ItemDistance2>
  void search(const Vec3& p, const ItemDistance2& item_distance2, NearItem& best, std::size_t node, std::size_t begin,
              std::size_t end) const {
    if (end - begin <= leaf_size) {
      for (std::size_t i = begin; i < end; ++i) {
        if (distance2(boxes_[i], p) > best.distance2) continue;
        const double d = item_distance2(items_[i]);
        if (d < best.distance2 || (d == best.distance2 && (best.item < 0 || items_[i] < best.item)))
          best = {items_[i], d};
      }
      return;
    }
    const double to_low = distance2(nodes_[2 * node + 1], p), to_high = distance2(nodes_[2 * node + 2], p);
    const auto low = [&] {
      if (to_low <= best.distance2) search(p, item_distance2, best, 2 * node + 1, begin, middle(begin, end));
    };
    const auto high = [&] {
      if (to_high <= best.distance2) search(p, item_distance2, best, 2 * node + 2, middle(begin, end), end);
    };
    if (to_high < to_low) high();
    low();
    if (!(to_high < to_low)) high();
  }

  template <class Overlap, class Found>
  void visit(const Overlap& overlap, const Found& found, std::size_t node, std::size_t begin, std::size_t end) const {
    if (!overlap(nodes_[node])) return;
    if (end - begin <= leaf_size) {
      for (std::size_t i = begin; i < end; ++i) found(items_[i]);
      return;
    }
    visit(overlap, found, 2 * node + 1, begin, middle(begin, end));
    visit(overlap, found, 2 * node + 2, middle(begin, end), end);
  }

  std::vector<Box> nodes_;
  std::vector<std::int32_t> items_;
  std::vector<Box> boxes_;  // in the order of items_
};

}  // namespace hextwist
