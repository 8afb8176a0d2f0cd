// Sets as arrays: lists that ascend and have each item once.
#pragma once

#include <algorithm>
#include <functional>
#include <iterator>
#include <span>
#include <vector>

#include "hextwist/base/types.h"

namespace hextwist {

/// Makes a list ascending by key, each key once: of items with the same key the first stays.
template <class List, class Key = std::identity>
void sort_unique(List& list, Key key = {}) {
  if (std::ranges::adjacent_find(list, std::ranges::greater_equal{}, key) == list.end()) return;
  if constexpr (std::is_same_v<Key, std::identity>)
    std::ranges::sort(list);
  else
    std::ranges::stable_sort(list, {}, key);
  list.erase(std::ranges::unique(list, {}, key).begin(), list.end());
}
template <class T>
std::vector<T> sorted_unique(std::vector<T> list) {
  sort_unique(list);
  return list;
}

/// Where an ascending list has an item (or one with this key), -1 where it has none.
template <class List, class Item, class Key = std::identity>
Index position_in(const List& list, const Item& item, Key key = {}) {
  const auto at = std::ranges::lower_bound(list, item, {}, key);
  return at != std::ranges::end(list) && std::invoke(key, *at) == item
             ? static_cast<Index>(at - std::ranges::begin(list))
             : -1;
}

/// The value beside an item of an ascending list, zero where the list has no such item.
template <class List, class Values, class Item>
auto value_of(const List& list, const Values& values, const Item& item) {
  const Index at = position_in(list, item);
  return at < 0 ? std::ranges::range_value_t<Values>{} : values[at];
}

/// Items of two ascending lists: those in both, in either, in the first alone.
template <class A, class B>
auto intersection(const A& a, const B& b) {
  std::vector<std::ranges::range_value_t<A>> result;
  std::ranges::set_intersection(a, b, std::back_inserter(result));
  return result;
}
template <class A, class B>
auto union_of(const A& a, const B& b) {
  std::vector<std::ranges::range_value_t<A>> result;
  std::ranges::set_union(a, b, std::back_inserter(result));
  return result;
}
template <class A, class B>
auto difference(const A& a, const B& b) {
  std::vector<std::ranges::range_value_t<A>> result;
  std::ranges::set_difference(a, b, std::back_inserter(result));
  return result;
}

/// When the items of an ascending list `gone` are taken out of an array, those behind move up: the new index of one
/// that stays, by its old one.
inline Index after_gaps(std::span<const Index> gone, Index before) {
  return before - static_cast<Index>(std::ranges::lower_bound(gone, before) - gone.begin());
}
/// The old index, by the new one.
inline Index before_gaps(std::span<const Index> gone, Index after) {
  std::size_t low = 0, high = gone.size();
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (gone[middle] - static_cast<Index>(middle) <= after)
      low = middle + 1;
    else
      high = middle;
  }
  return after + static_cast<Index>(low);
}

/// Some items of an array with `width` values for each.
template <class T>
std::vector<T> items_at(const std::vector<T>& array, std::span<const Index> places, std::size_t width = 1) {
  std::vector<T> items;
  items.reserve(places.size() * width);
  for (const Index i : places)
    for (std::size_t c = 0; c < width; ++c) items.push_back(array[static_cast<std::size_t>(i) * width + c]);
  return items;
}

}  // namespace hextwist
