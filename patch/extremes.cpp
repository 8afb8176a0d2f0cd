#include "hextwist/patch/extremes.h"

#include <algorithm>
#include <iterator>

namespace hextwist {
namespace {

constexpr std::size_t max_outliers = 2000;

}  // namespace

ExtremeList extremes(const Mesh& mesh, std::span<const double> values, bool largest, std::span<const Index> without) {
  ExtremeList heap;  // the last of the list on top
  auto next = without.begin();
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    if (next != without.end() && *next == h) {
      ++next;
      continue;
    }
    const double value = largest ? -values[h] : values[h];
    if (heap.size() == max_outliers) {
      if (!(value < heap.front().first)) continue;  // ids ascend
      std::ranges::pop_heap(heap);
      heap.pop_back();
    }
    heap.emplace_back(value, hex_id(mesh, h));
    std::ranges::push_heap(heap);
  }
  std::ranges::sort_heap(heap);
  return heap;
}

ExtremeList changed(const ExtremeList& list, std::span<const std::int64_t> gone, const ExtremeList& come) {
  ExtremeList kept, result;
  for (const auto& item : list)
    if (!std::ranges::binary_search(gone, item.second)) kept.push_back(item);
  if (kept.empty()) return kept;
  ExtremeList fresh;
  for (const auto& item : come)
    if (item < kept.back()) fresh.push_back(item);
  if (fresh.size() > max_outliers) {
    std::ranges::nth_element(fresh, fresh.begin() + max_outliers);
    fresh.resize(max_outliers);
  }
  std::ranges::sort(fresh);
  std::ranges::merge(kept, fresh, std::back_inserter(result));
  if (result.size() > max_outliers) result.resize(max_outliers);
  return result;
}

}  // namespace hextwist
