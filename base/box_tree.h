// A tree of boxes for "which of these is nearest to p", whatever "these" are.
//
// The tree knows boxes only; the caller says how far an item is. Immutable after construction, so any number of threads
// may ask; of items at the same distance the lowest number wins, so the answer does not depend on the tree's shape.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hextwist/base/types.h"

namespace hextwist {

/// Squared distance of a point from a box; 0 inside.
inline double distance2(const Box& box, const Vec3& p) {
  return (p - p.cwiseMax(box.min).cwiseMin(box.max)).squaredNorm();
}

struct NearItem {
  std::int32_t item = -1;  ///< -1: nothing within the bound
  double distance2 = std::numeric_limits<double>::infinity();
};

class BoxTree {
 public:
  BoxTree() = default;
  /// One box per item, none empty.
  explicit BoxTree(std::span<const Box> boxes);

  /// The item for which item_distance2(item), a squared distance no less than that of its box, is smallest and at most
  /// `bound2`.
  template <class ItemDistance2>
  NearItem nearest(const Vec3& p, ItemDistance2&& item_distance2,
                   double bound2 = std::numeric_limits<double>::infinity()) const {
    NearItem best{-1, bound2};
    if (nodes_.empty()) return best;
    std::int32_t stack[64];
    int depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
      const Node& node = nodes_[stack[--depth]];
      if (distance2(node.box, p) > best.distance2) continue;
      if (node.n_items > 0) {
        for (std::int32_t i = node.first; i < node.first + node.n_items; ++i) {
          if (distance2(boxes_[i], p) > best.distance2) continue;
          const double d = item_distance2(items_[i]);
          if (d < best.distance2 || (d == best.distance2 && (best.item < 0 || items_[i] < best.item)))
            best = {items_[i], d};
        }
        continue;
      }
      // The nearer child is looked at first.
      const std::int32_t left = node.first, right = node.first + 1;
      const bool left_first = distance2(nodes_[left].box, p) <= distance2(nodes_[right].box, p);
      stack[depth++] = left_first ? right : left;
      stack[depth++] = left_first ? left : right;
    }
    return best;
  }

 private:
  struct Node {
    Box box;
    std::int32_t first = 0;    // of its items, or its left child; the right one follows
    std::int32_t n_items = 0;  // 0: has children
  };
  void build(std::int32_t node, std::int32_t begin, std::int32_t end);

  std::vector<Node> nodes_;
  std::vector<std::int32_t> items_;
  std::vector<Box> boxes_;  // in the order of items_
};

}  // namespace hextwist
