// Splicing ascending lists: of nodes, hexes, sides, edges.
#pragma once

#include <cassert>
#include <cstring>

#include "hextwist/base/sorted.h"
#include "hextwist/mesh/arrays.h"

namespace hextwist {

/// Which items of a list go and come. carried(item): what an item of `before` is called afterwards, or nothing when it
/// is gone.
template <IsList List, class Carried, IsList Found>
void find_edit(const List& before, const List& after, const Carried& carried, const Found& out, const Found& in) {
  const auto put = [](const List& from, std::size_t i, const Found& to) {
    to.items.push_back(from.items[i]);
    if (from.values) to.values->push_back((*from.values)[i]);
  };
  std::size_t j = 0;
  for (std::size_t i = 0; i < before.items.size(); ++i) {
    const auto wanted = carried(before.items[i]);
    while (wanted && j < after.items.size() && after.items[j] < *wanted) put(after, j++, in);
    if (wanted && j < after.items.size() && after.items[j] == *wanted &&
        (!before.values || (*before.values)[i] == (*after.values)[j]))
      ++j;
    else
      put(before, i, out);
  }
  while (j < after.items.size()) put(after, j++, in);
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
void put_in(std::vector<T>& array, std::span<const Index> places, std::span<const T> items, std::size_t width = 1) {
  if (places.empty()) return;
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

/// Renames the hexes of an ascending list none of which are gone.
template <class Item>
void rename_hexes(std::vector<Item>& list, std::span<const Index> gone, std::span<const Index> come) {
  // Item i of `places` pushes all from `boundary(i)` on by one; the last ones first, so that each is moved once.
  const auto push = [&](std::span<const Index> places, const auto& boundary, Index by) {
    if (list.empty()) return;
    const Index last = first_named(list.back());
    std::size_t n = 0;  // of places that are not behind all items
    for (std::size_t end = places.size(); n < end;) {
      const std::size_t middle = (n + end) / 2;
      if (boundary(middle) <= last)
        n = middle + 1;
      else
        end = middle;
    }
    auto end = list.end();
    for (std::size_t i = n; i-- > 0;) {
      const Index from = boundary(i), shift = by * (static_cast<Index>(i) + 1);
      const auto begin =
          std::partition_point(list.begin(), end, [&](const Item& item) { return first_named(item) < from; });
      for (auto at = begin; at != end; ++at) first_named(*at) += shift;
      end = begin;
    }
  };
  push(
      gone, [&](std::size_t i) { return gone[i]; }, -1);
  push(
      come, [&](std::size_t i) { return come[i] - static_cast<Index>(i); }, 1);
}

/// Takes items out of a list and puts others in. rename_rest: gives those in between the names that they have
/// afterwards. The list has room.
template <IsList List, IsList Edit, class RenameRest>
void apply_edit(const List& of, const Edit& out, const Edit& in, const RenameRest& rename_rest) {
  auto& list = of.items;
  auto* const values = of.values;
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
  for (const auto& item : out.items) {
    move_until(std::lower_bound(from, list.end(), item));
    assert(from != list.end() && *from == item);
    ++from;
  }
  move_until(list.end());
  list.resize(static_cast<std::size_t>(to - list.begin()));
  rename_rest(list);
  // In, from the back.
  std::size_t i = list.size(), end = list.size() + in.items.size();
  list.resize(end);
  if (values) values->resize(end);
  for (std::size_t j = in.items.size(); j > 0;) {
    --end;
    if (i > 0 && in.items[j - 1] < list[i - 1]) {
      --i;
      list[end] = list[i];
      if (values) (*values)[end] = (*values)[i];
    } else {
      --j;
      list[end] = in.items[j];
      if (values) (*values)[end] = (*in.values)[j];
    }
  }
}

}  // namespace hextwist
