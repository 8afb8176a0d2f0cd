#include "hextwist/patch/splice.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "hextwist/base/large_array.h"
#include "hextwist/base/parallel.h"
#include "hextwist/base/same_bits.h"
#include "hextwist/patch/splice_lists_internal.h"
#include "hextwist/refine/split.h"

namespace hextwist {
namespace {

/// Marks the nodes of a patch of which an array says something else afterwards.
struct MarkMoved {
  std::span<std::uint8_t> is_moved;

  template <class T>
  void operator()(const ArrayTag& tag, const std::vector<T>& was, const std::vector<T>& now) const {
    if (tag.per != Per::node || was.empty()) return;
    for (std::size_t i = 0; i < is_moved.size() * tag.width; ++i)
      if (!same_bits(was[i], now[i])) is_moved[i / tag.width] = 1;
  }
  void operator()(const ArrayTag&, const IsList auto&, const IsList auto&) const {}
};

/// Finds what goes and what comes in an array of all, when its patch becomes another.
struct FindChange {
  const PatchNumbers& numbers;
  std::span<const Index> moved;  // nodes of the patch

  template <class T>
  void operator()(const ArrayTag& tag, const std::vector<T>& all, const std::vector<T>& was, const std::vector<T>& now,
                  std::vector<T>& out, std::vector<T>& in) const {
    if (all.empty() || tag.fresh == Fresh::id) return;
    const bool on_nodes = tag.per == Per::node;
    out = items_at(was, on_nodes ? moved : numbers.local_gone, tag.width);
    if (on_nodes) in = items_at(now, moved, tag.width);
    const auto n_old = static_cast<std::size_t>(on_nodes ? numbers.n_patch_nodes() : numbers.n_kept) * tag.width;
    in.insert(in.end(), now.begin() + static_cast<std::ptrdiff_t>(n_old), now.end());
    if constexpr (std::same_as<T, Hex>)
      for (std::vector<Hex>* hexes : {&out, &in})
        for (Hex& hex : *hexes) rename(hex, [&](Index n) { return numbers.node(n); });
  }
  template <IsList Before, IsList After>
  void operator()(const ArrayTag& tag, const Before&, const Before& was, const Before& now, const After& out,
                  const After& in) const {
    const bool on_nodes = tag.per == Per::node;
    const auto renamed = [](auto list, const auto& number) {
      for (auto& item : list) rename(item, number);
      return list;
    };
    const auto before =
        renamed(was.items, [&](Index i) { return on_nodes ? numbers.node(i) : numbers.patch.hexes[i]; });
    const auto after = renamed(now.items, [&](Index i) { return on_nodes ? numbers.node(i) : numbers.refined_hex(i); });
    // What an item is called afterwards; nothing when it is gone.
    const auto carried = [&](auto item) {
      Index& hex = first_named(item);
      if (on_nodes) return std::optional(item);
      if (std::ranges::binary_search(numbers.gone, hex)) return std::optional<decltype(item)>();
      hex = after_gaps(numbers.gone, hex);
      return std::optional(item);
    };
    find_edit(Before{before, was.values}, Before{after, now.values}, carried, out, in);
  }
};

}  // namespace

PatchNumbers::PatchNumbers(const Patch& of, const MeshedModel& whole, const Mesh& refined_patch)
    : patch(of), n_nodes(whole.mesh.n_nodes()), n_hexes(whole.mesh.n_hexes()) {
  const Index n_before = patch.meshed.mesh.n_hexes();
  // The ids of a patch are its indices, and stay.
  Index next = 0;
  for (; n_kept < refined_patch.n_hexes() && hex_id(refined_patch, n_kept) <= n_before; ++n_kept) {
    const Index local = static_cast<Index>(hex_id(refined_patch, n_kept) - 1);
    for (; next < local; ++next) local_gone.push_back(next);
    ++next;
  }
  for (; next < n_before; ++next) local_gone.push_back(next);
  for (const Index local : local_gone) gone.push_back(patch.hexes[local]);
}

Index PatchNumbers::refined_hex(Index local) const {
  if (local >= n_kept) return local - n_kept + n_hexes - static_cast<Index>(gone.size());
  return after_gaps(gone, patch.hexes[before_gaps(local_gone, local)]);
}

Splice::Splice(const MeshedModel& whole, const PatchNumbers& numbers, const MeshedModel& refined)
    : n_nodes_(numbers.n_nodes), n_hexes_(numbers.n_hexes), gone_(numbers.gone) {
  const Patch& patch = numbers.patch;
  const Mesh &old_mesh = whole.mesh, &mesh = refined.mesh, &part = patch.meshed.mesh;
  const Index n_old = numbers.n_patch_nodes(), n_kept = numbers.n_kept;
  checked_count(std::int64_t{n_nodes_} + mesh.n_nodes() - n_old);
  checked_count(std::int64_t{n_hexes_} + mesh.n_hexes() - part.n_hexes());

  std::vector<std::uint8_t> is_moved(static_cast<std::size_t>(n_old));
  for_each_array(MarkMoved{is_moved}, patch.meshed, refined);
  const std::vector<Index> moved = indices_where(n_old, [&](Index n) { return is_moved[n] != 0; });
  moved_ = items_at(patch.nodes, moved);
  for (MeshedModel* side : {&before_, &after_}) copy_heads(part, side->mesh);
  for_each_array(FindChange{numbers, moved}, whole, patch.meshed, refined, before_, after_);

  // A patch does not know the ids of the whole.
  if (!old_mesh.node_ids.empty()) {
    before_.mesh.node_ids = after_.mesh.node_ids = items_at(old_mesh.node_ids, moved_);
    for (Index n = n_old; n < mesh.n_nodes(); ++n)
      after_.mesh.node_ids.push_back(old_mesh.node_ids.back() + 1 + n - n_old);
  }
  if (!gone_.empty()) {
    makes_hex_ids_ = old_mesh.hex_ids.empty();
    const std::int64_t last = hex_id(old_mesh, n_hexes_ - 1);
    for (Index h = n_kept; h < mesh.n_hexes(); ++h)
      after_.mesh.hex_ids.push_back(last + hex_id(mesh, h) - part.n_hexes());
    for (const Index h : gone_) before_.mesh.hex_ids.push_back(hex_id(old_mesh, h));
  }
}

namespace {

template <class T>
void reserve_more(std::vector<T>& array, std::size_t n) {
  if (array.capacity() < n) array.reserve(n + n / 16 + 1024);
}

/// Items of an array per node or hex on the larger side.
std::size_t room(const Splice& splice, const ArrayTag& tag) {
  const Index n = tag.per == Per::node ? splice.n_nodes(true) : std::max(splice.n_hexes(false), splice.n_hexes(true));
  return static_cast<std::size_t>(n) * tag.width;
}

struct MakeRoom {
  const Splice& splice;

  template <class T>
  void operator()(const ArrayTag& tag, std::vector<T>& array, const std::vector<T>& out, const std::vector<T>&) const {
    if (!array.empty() || !out.empty()) reserve_more(array, room(splice, tag));
  }
  void operator()(const ArrayTag&, const IsList auto& list, const IsList auto& out, const IsList auto& in) const {
    const std::size_t n = list.items.size() + std::max(in.items.size(), out.items.size());
    reserve_more(list.items, n);
    if (list.values) reserve_more(*list.values, n);
  }
};

/// Puts what comes in place of what goes.
struct Exchange {
  std::size_t n_nodes;  // before
  std::span<const Index> moved, gone;
  bool forward;

  template <class T>
  void operator()(const ArrayTag& tag, std::vector<T>& array, const std::vector<T>& out,
                  const std::vector<T>& in) const noexcept {
    if (array.empty()) return;
    const std::size_t width = tag.width;
    if (tag.per == Per::node) {
      for (std::size_t i = 0; i < moved.size(); ++i)
        std::copy_n(in.data() + i * width, width, array.data() + static_cast<std::size_t>(moved[i]) * width);
      if (forward)
        array.insert(array.end(), in.begin() + static_cast<std::ptrdiff_t>(moved.size() * width), in.end());
      else
        array.resize(n_nodes * width);
    } else if (forward) {
      take_out(array, gone, width);
      array.insert(array.end(), in.begin(), in.end());
    } else {
      array.resize(array.size() - out.size());
      put_in(array, gone, in, width);
    }
  }
  void operator()(const ArrayTag& tag, const IsList auto& list, const IsList auto& out,
                  const IsList auto& in) const noexcept {
    apply_edit(list, out, in, tag.per == Per::hex ? gone : std::span<const Index>(), forward);
  }
};

}  // namespace

void Splice::make_room(MeshedModel& whole, bool forward) const {
  for_each_array(MakeRoom{*this}, whole, forward ? before_ : after_, forward ? after_ : before_);
}

void Splice::apply(MeshedModel& whole, bool forward) const noexcept {
  std::vector<std::int64_t>& ids = whole.mesh.hex_ids;
  if (forward && makes_hex_ids_) {
    ids.resize(static_cast<std::size_t>(n_hexes_));
    std::iota(ids.begin(), ids.end(), std::int64_t{1});
  }
  for_each_array(Exchange{static_cast<std::size_t>(n_nodes_), moved_, gone_, forward}, whole,
                 forward ? before_ : after_, forward ? after_ : before_);
  if (!forward && makes_hex_ids_) ids.clear();  // it has room for coming back
}

std::size_t Splice::bytes() const {
  std::size_t sum = sizeof(Splice) + (moved_.capacity() + gone_.capacity()) * sizeof(Index);
  const auto add = [&](const ArrayTag&, const auto& array) {
    sum += sizeof array + array.capacity() * sizeof array[0];
  };
  for (const MeshedModel* side : {&before_, &after_}) for_each_array(lists_apart(add), *side);
  return sum;
}

namespace {

/// With room for all that a splice puts in.
struct CopyWithRoom {
  const Splice& splice;

  template <class T>
  void operator()(const ArrayTag& tag, std::vector<T>& to, const std::vector<T>& from) const {
    if (!from.empty()) to = copy_large(from, room(splice, tag));
  }
  void operator()(const ArrayTag&, const IsList auto& to, const IsList auto& from) const {
    to.items = from.items;
    if (to.values) *to.values = *from.values;
  }
};

}  // namespace

MeshedModel spliced(const MeshedModel& whole, const Splice& splice, bool forward) {
  MeshedModel result;
  result.model = whole.model;
  copy_heads(whole.mesh, result.mesh);
  for_each_array(CopyWithRoom{splice}, result, whole);
  splice.make_room(result, forward);
  splice.apply(result, forward);
  return result;
}

}  // namespace hextwist
