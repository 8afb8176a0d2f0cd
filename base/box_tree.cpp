#include "hextwist/base/box_tree.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <numeric>

namespace hextwist {

BoxTree::BoxTree(std::span<const Box> boxes) : items_(boxes.size()), boxes_(boxes.size()) {
  if (boxes.empty()) return;
  std::iota(items_.begin(), items_.end(), 0);
  std::size_t n_nodes = 1;
  for (std::size_t n = items_.size(); n > leaf_size; n = (n + 1) / 2) n_nodes = 2 * n_nodes + 1;
  nodes_.resize(n_nodes);
  std::vector<Vec3> centres(boxes.size());  // twice
  for (std::size_t i = 0; i < boxes.size(); ++i) centres[i] = boxes[i].min + boxes[i].max;
  build(boxes, centres, 0, 0, items_.size());
  for (std::size_t i = 0; i < items_.size(); ++i) boxes_[i] = boxes[items_[i]];
}

void BoxTree::build(std::span<const Box> boxes, std::span<const Vec3> centres, std::size_t node, std::size_t begin,
                    std::size_t end) {
  if (end - begin <= leaf_size) {
    for (std::size_t i = begin; i < end; ++i) nodes_[node].add(boxes[items_[i]]);
    return;
  }
  Box extent;
  for (std::size_t i = begin; i < end; ++i) extent.add(centres[items_[i]]);
  int axis = 0;
  (extent.max - extent.min).maxCoeff(&axis);
  const std::size_t half = middle(begin, end), low = 2 * node + 1, high = 2 * node + 2;
  std::nth_element(items_.begin() + begin, items_.begin() + half, items_.begin() + end,
                   [&](std::int32_t a, std::int32_t b) {
                     return centres[a][axis] != centres[b][axis] ? centres[a][axis] < centres[b][axis] : a < b;
                   });
  const auto build_low = [&] { build(boxes, centres, low, begin, half); };
  const auto build_high = [&] { build(boxes, centres, high, half, end); };
  constexpr std::size_t worth_threads = 4096;
  if (end - begin > worth_threads) {
    tbb::parallel_invoke(build_low, build_high);
  } else {
    build_low();
    build_high();
  }
  nodes_[node].add(nodes_[low]);
  nodes_[node].add(nodes_[high]);
}

}  // namespace hextwist
