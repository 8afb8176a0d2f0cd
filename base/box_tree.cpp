#include "hextwist/base/box_tree.h"

#include <algorithm>
#include <numeric>

namespace hextwist {
namespace {

constexpr std::int32_t leaf_size = 4;

}  // namespace

BoxTree::BoxTree(std::span<const Box> boxes) : items_(boxes.size()), boxes_(boxes.begin(), boxes.end()) {
  if (boxes.empty()) return;
  std::iota(items_.begin(), items_.end(), 0);
  nodes_.reserve(boxes.size());
  nodes_.emplace_back();
  build(0, 0, static_cast<std::int32_t>(boxes.size()));
  for (std::size_t i = 0; i < items_.size(); ++i) boxes_[i] = boxes[items_[i]];
}

// Halves at the median of the longest axis, so that no path is longer than the logarithm of the number of items.
void BoxTree::build(std::int32_t node, std::int32_t begin, std::int32_t end) {
  Box box, centres;
  const auto centre = [&](std::int32_t item) -> Vec3 { return (boxes_[item].min + boxes_[item].max) / 2; };
  for (std::int32_t i = begin; i < end; ++i) {
    box.add(boxes_[items_[i]]);
    centres.add(centre(items_[i]));
  }
  nodes_[node].box = box;
  if (end - begin <= leaf_size) {
    nodes_[node].first = begin;
    nodes_[node].n_items = end - begin;
    return;
  }
  int axis = 0;
  (centres.max - centres.min).maxCoeff(&axis);
  const std::int32_t middle = begin + (end - begin) / 2;
  std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end,
                   [&](std::int32_t a, std::int32_t b) {
                     const double x = centre(a)[axis], y = centre(b)[axis];
                     return x != y ? x < y : a < b;
                   });
  const auto left = static_cast<std::int32_t>(nodes_.size());
  nodes_[node].first = left;
  nodes_.emplace_back();
  nodes_.emplace_back();
  build(left, begin, middle);
  build(left + 1, middle, end);
}

}  // namespace hextwist
