// Sets as arrays: lists that ascend and have each item once.
#pragma once

#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>
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

/// How the items of an array are called after some have gone and others have come; those that stay keep their order.
struct Reindexing {
  std::vector<Index> gone;  ///< by the places that they had, ascending
  std::vector<Index> come;  ///< by the places that they have afterwards, ascending

  bool is_gone(Index before) const { return std::ranges::binary_search(gone, before); }
  /// Of an item that stays.
  Index after(Index before) const { return before_gaps(come, after_gaps(gone, before)); }
  Index before(Index after) const { return before_gaps(gone, after_gaps(come, after)); }
  Index n_after(Index n_before) const {
    return n_before - static_cast<Index>(gone.size()) + static_cast<Index>(come.size());
  }
  /// Per item afterwards: where it was, -1 for those that have come.
  std::vector<Index> old_places(Index n_before) const {
    std::vector<Index> old(static_cast<std::size_t>(n_after(n_before)));
    Index from = 0;
    std::size_t i_gone = 0, i_come = 0;
    for (std::size_t i = 0; i < old.size(); ++i) {
      if (i_come < come.size() && static_cast<std::size_t>(come[i_come]) == i) {
        ++i_come;
        old[i] = -1;
        continue;
      }
      for (; i_gone < gone.size() && gone[i_gone] == from; ++i_gone) ++from;
      old[i] = from++;
    }
    return old;
  }
  /// The first item before from which on those that stay may be called otherwise.
  Index first_renamed() const {
    constexpr Index none = std::numeric_limits<Index>::max();
    return std::min(gone.empty() ? none : gone.front(), come.empty() ? none : come.front());
  }
};

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
