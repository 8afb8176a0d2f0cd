// What hexes are called before and after some of them are gone: those that are kept move together, in their order.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "hextwist/mesh/mesh.h"

namespace hextwist {

/// Some items of an array with so many values for each.
template <class T>
std::vector<T> items_at(const std::vector<T>& array, std::span<const Index> places, std::size_t width = 1) {
  std::vector<T> items;
  items.reserve(places.size() * width);
  for (const Index i : places)
    for (std::size_t c = 0; c < width; ++c) items.push_back(array[static_cast<std::size_t>(i) * width + c]);
  return items;
}

/// New index of a hex that is kept. gone: ascending, in old indices.
inline Index after_gaps(std::span<const Index> gone, Index hex) {
  return hex - static_cast<Index>(std::ranges::lower_bound(gone, hex) - gone.begin());
}

/// Old index of the kept hex with this new one.
inline Index before_gaps(std::span<const Index> gone, Index kept) {
  std::size_t low = 0, high = gone.size();
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (gone[middle] - static_cast<Index>(middle) <= kept)
      low = middle + 1;
    else
      high = middle;
  }
  return kept + static_cast<Index>(low);
}

}  // namespace hextwist
