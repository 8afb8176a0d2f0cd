// Splicing ascending lists: of nodes, hexes, sides, edges.
#pragma once

#include <cassert>
#include <cstring>

#include "hextwist/base/sorted.h"
#include "hextwist/patch/splice.h"

namespace hextwist {

/// Which items of a list of the patch go and come. before, after: the list in numbers of the whole; carried(item): what
/// an item of `before` is called afterwards, or nothing when it is gone. Values: beside each item, or empty.
template <class Item, class Carried>
ListEdit<Item> list_edit(const std::vector<Item>& before, const std::vector<int>& before_values,
                         const std::vector<Item>& after, const std::vector<int>& after_values, const Carried& carried) {
  ListEdit<Item> edit;
  std::size_t j = 0;
  const auto comes = [&] {
    edit.in.push_back(after[j]);
    if (!after_values.empty()) edit.in_values.push_back(after_values[j]);
    ++j;
  };
  for (std::size_t i = 0; i < before.size(); ++i) {
    const std::optional<Item> wanted = carried(before[i]);
    while (wanted && j < after.size() && after[j] < *wanted) comes();
    if (wanted && j < after.size() && after[j] == *wanted &&
        (before_values.empty() || before_values[i] == after_values[j])) {
      ++j;
      continue;
    }
    edit.out.push_back(before[i]);
    if (!before_values.empty()) edit.out_values.push_back(before_values[i]);
  }
  while (j < after.size()) comes();
  return edit;
}

/// Takes the items at these places (ascending) out of an array with `width` values for each.
template <class T>
void take_out(std::vector<T>& array, std::span<const Index> places, std::size_t width = 1) {
  if (places.empty()) return;
  T* const data = array.data();
  std::size_t to = static_cast<std::size_t>(places[0]) * width;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t begin = (static_cast<std::size_t>(places[i]) + 1) * width;
    const std::size_t end = i + 1 < places.size() ? static_cast<std::size_t>(places[i + 1]) * width : array.size();
    std::memmove(static_cast<void*>(data + to), static_cast<const void*>(data + begin), (end - begin) * sizeof(T));
    to += end - begin;
  }
  array.resize(to);
}

/// Puts items in, so that they are at these places (ascending) afterwards. The array has room.
template <class T>
void put_in(std::vector<T>& array, std::span<const Index> places, const std::vector<T>& items, std::size_t width = 1) {
  std::size_t from = array.size();
  array.resize(from + items.size());
  T* const data = array.data();
  std::size_t end = array.size();
  for (std::size_t i = places.size(); i-- > 0;) {
    const std::size_t at = static_cast<std::size_t>(places[i]) * width, n = end - (at + width);
    std::memmove(static_cast<void*>(data + at + width), static_cast<const void*>(data + from - n), n * sizeof(T));
    from -= n;
    std::copy_n(items.data() + i * width, width, data + at);
    end = at;
  }
}

inline Index& hex_of(Index& item) {
  return item;
}
inline Index& hex_of(Side& item) {
  return item.hex;
}

/// Renames the hexes of an ascending list none of which are gone.
template <class Item>
void rename_hexes(std::vector<Item>& list, std::span<const Index> gone, bool forward) {
  auto end = list.end();
  for (std::size_t i = gone.size(); i-- > 0;) {
    const Index boundary = forward ? gone[i] : gone[i] - static_cast<Index>(i);
    const auto begin = std::partition_point(list.begin(), end, [&](Item item) { return hex_of(item) < boundary; });
    const Index shift = static_cast<Index>(i) + 1;
    for (auto at = begin; at != end; ++at) hex_of(*at) += forward ? -shift : shift;
    end = begin;
  }
}

/// Puts one list of an edit in place of the other. gone: null where the items are not named by hexes. The lists have
/// room.
template <class Item>
void apply_edit(std::vector<Item>& list, std::vector<int>* values, const ListEdit<Item>& edit,
                const std::vector<Index>* gone, bool forward) {
  const std::vector<Item>& out = forward ? edit.out : edit.in;
  const std::vector<Item>& in = forward ? edit.in : edit.out;
  const std::vector<int>& in_values = forward ? edit.in_values : edit.out_values;
  // Out, from the back: each run behind an item that goes moves down when all before it are known.
  auto to = list.begin(), from = list.begin();
  const auto move_until = [&](auto end) {
    if (to != from) {
      if (values)
        std::copy(values->begin() + (from - list.begin()), values->begin() + (end - list.begin()),
                  values->begin() + (to - list.begin()));
      std::copy(from, end, to);
    }
    to += end - from;
    from = end;
  };
  for (const Item& item : out) {
    move_until(std::lower_bound(from, list.end(), item));
    assert(from != list.end() && *from == item);
    ++from;
  }
  move_until(list.end());
  list.resize(static_cast<std::size_t>(to - list.begin()));
  if constexpr (!std::is_same_v<Item, Edge>)
    if (gone) rename_hexes(list, *gone, forward);
  // In, from the back.
  std::size_t i = list.size(), end = list.size() + in.size();
  list.resize(end);
  if (values) values->resize(end);
  for (std::size_t j = in.size(); j > 0;) {
    --end;
    if (i > 0 && in[j - 1] < list[i - 1]) {
      --i;
      list[end] = list[i];
      if (values) (*values)[end] = (*values)[i];
    } else {
      --j;
      list[end] = in[j];
      if (values) (*values)[end] = in_values[j];
    }
  }
}

}  // namespace hextwist
