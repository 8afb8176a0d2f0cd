#include "hextwist/patch/splice.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "hextwist/base/large_array.h"
#include "hextwist/base/parallel.h"
#include "hextwist/base/same_bits.h"
#include "hextwist/mesh/others.h"
#include "hextwist/patch/splice_lists_internal.h"
#include "hextwist/refine/split.h"

namespace hextwist {
namespace {

/// Per item before: its place afterwards, -1 where it is gone.
std::vector<Index> inverse(std::span<const Index> old, Index n_before) {
  std::vector<Index> now(static_cast<std::size_t>(n_before), -1);
  for (std::size_t i = 0; i < old.size(); ++i)
    if (old[i] >= 0) now[old[i]] = static_cast<Index>(i);
  return now;
}

/// Marks the nodes of a patch of which an array says something else afterwards.
struct MarkMoved {
  std::span<const Index> now_of;  // per node before; -1: gone
  std::span<std::uint8_t> is_moved;

  template <class T>
  void operator()(const ArrayTag& tag, const std::vector<T>& was, const std::vector<T>& now) const {
    if (tag.per != Per::node || tag.fresh == Fresh::id || was.empty()) return;
    for (std::size_t i = 0; i < now_of.size(); ++i)
      for (std::size_t c = 0; now_of[i] >= 0 && c < tag.width; ++c)
        if (!same_bits(was[i * tag.width + c], now[static_cast<std::size_t>(now_of[i]) * tag.width + c]))
          is_moved[i] = 1;
  }
  void operator()(const ArrayTag&, const IsList auto&, const IsList auto&) const {}
};

/// Finds what goes and what comes in an array of all, when its patch becomes another.
struct FindChange {
  const PatchNumbers& numbers;
  std::span<const Index> moved, moved_now;  // nodes of the patch, before and after

  template <class T>
  void operator()(const ArrayTag& tag, const std::vector<T>& all, const std::vector<T>& was, const std::vector<T>& now,
                  std::vector<T>& out, std::vector<T>& in) const {
    if (all.empty() || tag.fresh == Fresh::id) return;
    const auto add = [&](std::vector<T>& to, const std::vector<T>& from, std::span<const Index> places) {
      const std::vector<T> items = items_at(from, places, tag.width);
      to.insert(to.end(), items.begin(), items.end());
    };
    const bool on_nodes = tag.per == Per::node;
    if (on_nodes) {
      add(out, was, moved);
      add(in, now, moved_now);
    }
    add(out, was, on_nodes ? numbers.local_gone_nodes : numbers.local_gone);
    add(in, now, on_nodes ? numbers.come_nodes : numbers.come);
    if constexpr (std::same_as<T, Hex>) {
      for (Hex& hex : out) rename(hex, [&](Index n) { return numbers.patch.nodes[n]; });
      for (Hex& hex : in) rename(hex, [&](Index n) { return numbers.node[n]; });
    }
  }
  template <IsList Before, IsList After>
  void operator()(const ArrayTag& tag, const Before&, const Before& was, const Before& now, const After& out,
                  const After& in) const {
    const bool on_nodes = tag.per == Per::node;
    const auto renamed = [](auto list, std::span<const Index> names) {
      for (auto& item : list) rename(item, [&](Index i) { return names[i]; });
      return list;
    };
    const auto before = renamed(was.items, on_nodes ? numbers.patch.nodes : numbers.patch.hexes);
    const auto after = renamed(now.items, on_nodes ? numbers.node : numbers.hex);
    const Reindexing& all = on_nodes ? numbers.nodes : numbers.hexes;
    // What an item is called afterwards; nothing when it is gone.
    const auto carried = [&](auto item) {
      bool gone = false;
      rename(item, [&](Index i) {
        gone |= all.is_gone(i);
        return gone ? i : all.after(i);
      });
      return gone ? std::nullopt : std::optional(item);
    };
    find_edit(Before{before, was.values}, Before{after, now.values}, carried, out, in);
  }
};

/// Ids of some nodes or hexes of the whole: an array, or none where they are the places.
std::vector<std::int64_t> ids_at(const std::vector<std::int64_t>& ids, std::span<const Index> places) {
  std::vector<std::int64_t> result;
  for (const Index i : places) result.push_back(ids.empty() ? i + std::int64_t{1} : ids[i]);
  return result;
}

}  // namespace

PatchNumbers::PatchNumbers(const Patch& of, const MeshedModel& whole, std::vector<Index> same_node,
                           std::vector<Index> same_hex, std::span<const Index> whole_place)
    : patch(of), old_node(std::move(same_node)), old_hex(std::move(same_hex)) {
  const auto find_gone = [](std::span<const Index> old, const std::vector<Index>& all, std::vector<Index>& local,
                            std::vector<Index>& gone) {
    const std::vector<Index> now = inverse(old, static_cast<Index>(all.size()));
    local = indices_where(static_cast<Index>(all.size()), [&](Index i) { return now[i] < 0; });
    gone = items_at(all, local);
  };
  find_gone(old_node, patch.nodes, local_gone_nodes, nodes.gone);
  find_gone(old_hex, patch.hexes, local_gone, hexes.gone);
  // Those between others first: their places are known.
  std::vector<std::pair<Index, Index>> placed;
  for (std::size_t h = 0; h < old_hex.size(); ++h)
    if (old_hex[h] < 0 && !whole_place.empty() && whole_place[h] >= 0)
      placed.emplace_back(whole_place[h], static_cast<Index>(h));
  std::ranges::sort(placed);
  for (const auto& [place, h] : placed) {
    hexes.come.push_back(place);
    come.push_back(h);
  }
  const auto append = [](std::span<const Index> old, Index n_before, Reindexing& all, std::vector<Index>& locals,
                         const auto& has_place) {
    Index next = all.n_after(n_before);
    for (std::size_t i = 0; i < old.size(); ++i) {
      if (old[i] >= 0 || has_place(i)) continue;
      all.come.push_back(next++);
      locals.push_back(static_cast<Index>(i));
    }
  };
  append(old_node, whole.mesh.n_nodes(), nodes, come_nodes, [](std::size_t) { return false; });
  append(old_hex, whole.mesh.n_hexes(), hexes, come,
         [&](std::size_t h) { return !whole_place.empty() && whole_place[h] >= 0; });

  const auto name = [](std::span<const Index> old, const std::vector<Index>& all, const Reindexing& numbers,
                       std::span<const Index> locals) {
    std::vector<Index> names(old.size());
    for (std::size_t i = 0; i < old.size(); ++i)
      if (old[i] >= 0) names[i] = numbers.after(all[old[i]]);
    for (std::size_t i = 0; i < locals.size(); ++i) names[locals[i]] = numbers.come[i];
    return names;
  };
  node = name(old_node, patch.nodes, nodes, come_nodes);
  hex = name(old_hex, patch.hexes, hexes, come);
}

namespace {

/// Of a patch refined by passes: its ids are its indices, and stay.
std::vector<Index> kept_hexes(const Mesh& patch, const Mesh& refined) {
  std::vector<Index> old(refined.hexes.size(), -1);
  for (Index h = 0; h < refined.n_hexes(); ++h)
    if (const std::int64_t id = hex_id(refined, h); id <= patch.n_hexes()) old[h] = static_cast<Index>(id - 1);
  return old;
}
std::vector<Index> kept_nodes(const Mesh& patch, const Mesh& refined) {
  std::vector<Index> old(refined.points.size(), -1);
  std::iota(old.begin(), old.begin() + patch.n_nodes(), 0);
  return old;
}

}  // namespace

PatchNumbers::PatchNumbers(const Patch& of, const MeshedModel& whole, const Mesh& refined)
    : PatchNumbers(of, whole, kept_nodes(of.meshed.mesh, refined), kept_hexes(of.meshed.mesh, refined), {}) {
  const Mesh& mesh = whole.mesh;
  has_node_ids = !mesh.node_ids.empty();
  has_hex_ids = !mesh.hex_ids.empty() || !hexes.gone.empty();
  for (std::size_t i = 0; has_node_ids && i < come_nodes.size(); ++i)
    node_ids.push_back(mesh.node_ids.back() + 1 + static_cast<std::int64_t>(i));
  const std::int64_t last = highest_element_id(mesh);
  for (std::size_t i = 0; has_hex_ids && i < come.size(); ++i)
    hex_ids.push_back(last + hex_id(refined, come[i]) - patch.meshed.mesh.n_hexes());
}

Splice::Splice(const MeshedModel& whole, const PatchNumbers& numbers, const MeshedModel& refined,
               RenamedFrom first_renamed)
    : n_nodes_(whole.mesh.n_nodes()),
      n_hexes_(whole.mesh.n_hexes()),
      nodes_(numbers.nodes),
      hexes_(numbers.hexes),
      first_renamed_(first_renamed),
      node_ids_{!whole.mesh.node_ids.empty(), numbers.has_node_ids},
      hex_ids_{!whole.mesh.hex_ids.empty(), numbers.has_hex_ids} {
  const Patch& patch = numbers.patch;
  checked_count(std::int64_t{n_nodes_} - std::ssize(nodes_.gone) + std::ssize(nodes_.come));
  checked_count(std::int64_t{n_hexes_} - std::ssize(hexes_.gone) + std::ssize(hexes_.come));

  const auto n_old = static_cast<Index>(patch.nodes.size());
  const std::vector<Index> now_of = inverse(numbers.old_node, n_old);
  std::vector<std::uint8_t> is_moved(static_cast<std::size_t>(n_old));
  for_each_array(MarkMoved{now_of, is_moved}, patch.meshed, refined);
  const std::vector<Index> moved = indices_where(n_old, [&](Index n) { return is_moved[n] != 0; });
  moved_ = items_at(patch.nodes, moved);
  for (MeshedModel* side : {&before_, &after_}) copy_heads(patch.meshed.mesh, side->mesh);
  for_each_array(FindChange{numbers, moved, items_at(now_of, moved)}, whole, patch.meshed, refined, before_, after_);

  // A patch does not know the ids of the whole. Those of moved nodes stand here too.
  const auto set_ids = [](Ids has, const std::vector<std::int64_t>& ids, std::span<const Index> stay,
                          std::span<const Index> gone, const std::vector<std::int64_t>& come,
                          std::vector<std::int64_t>& before, std::vector<std::int64_t>& after) {
    if (!has.before && !has.after) return;
    before = after = ids_at(ids, stay);
    const std::vector<std::int64_t> of_gone = ids_at(ids, gone);
    before.insert(before.end(), of_gone.begin(), of_gone.end());
    after.insert(after.end(), come.begin(), come.end());
  };
  set_ids(node_ids_, whole.mesh.node_ids, moved_, nodes_.gone, numbers.node_ids, before_.mesh.node_ids,
          after_.mesh.node_ids);
  set_ids(hex_ids_, whole.mesh.hex_ids, {}, hexes_.gone, numbers.hex_ids, before_.mesh.hex_ids, after_.mesh.hex_ids);
}

namespace {

template <class T>
void reserve_more(std::vector<T>& array, std::size_t n) {
  if (array.capacity() < n) array.reserve(n + n / 16 + 1024);
}

/// Items of an array per node or hex while it is changed: at most as many as on the larger side.
std::size_t room(const Splice& splice, const ArrayTag& tag) {
  const bool on_nodes = tag.per == Per::node;
  const auto n = [&](bool after) { return on_nodes ? splice.n_nodes(after) : splice.n_hexes(after); };
  return static_cast<std::size_t>(std::max(n(false), n(true))) * tag.width;
}

struct MakeRoom {
  const Splice& splice;

  template <class T>
  void operator()(const ArrayTag& tag, std::vector<T>& array, const std::vector<T>& out,
                  const std::vector<T>& in) const {
    if (!array.empty() || !out.empty() || (tag.fresh == Fresh::id && !in.empty()))
      reserve_more(array, room(splice, tag));
  }
  void operator()(const ArrayTag&, const IsList auto& list, const IsList auto& out, const IsList auto& in) const {
    const std::size_t n = list.items.size() + std::max(in.items.size(), out.items.size());
    reserve_more(list.items, n);
    if (list.values) reserve_more(*list.values, n);
  }
};

/// One way of changing: what goes, by the places before, what comes, by the places afterwards.
struct Way {
  std::span<const Index> gone, come;
};

/// Puts what comes in place of what goes.
struct Exchange {
  Way nodes, hexes;
  std::span<const Index> moved;  // by their numbers before the splice
  bool forward;
  std::span<const Index> names;  // of nodes
  Index first_renamed_node, first_renamed_hex;

  template <class T>
  void operator()(const ArrayTag& tag, std::vector<T>& array, const std::vector<T>& out,
                  const std::vector<T>& in) const noexcept {
    static_cast<void>(out);
    if (array.empty()) return;
    const std::size_t width = tag.width;
    const bool on_nodes = tag.per == Per::node;
    const Way& way = on_nodes ? nodes : hexes;
    const std::size_t n_moved = on_nodes ? moved.size() : 0;
    const auto set_moved = [&] {
      for (std::size_t i = 0; i < n_moved; ++i)
        std::copy_n(in.data() + i * width, width, array.data() + static_cast<std::size_t>(moved[i]) * width);
    };
    if (forward) set_moved();
    take_out(array, way.gone, width);
    if constexpr (std::same_as<T, Hex>) rename_nodes(array);
    put_in(array, way.come, std::span<const T>(in).subspan(n_moved * width), width);
    if (!forward) set_moved();
  }
  void operator()(const ArrayTag& tag, const IsList auto& list, const IsList auto& out,
                  const IsList auto& in) const noexcept {
    const bool on_nodes = tag.per == Per::node;
    const Way& way = on_nodes ? nodes : hexes;
    apply_edit(list, out, in, [&](auto& items) {
      if (on_nodes)
        for (auto& item : items) rename(item, [&](Index n) { return name(n); });
      else
        rename_hexes(items, way.gone, way.come);
    });
  }

 private:
  Index name(Index n) const { return n < first_renamed_node ? n : names[n - first_renamed_node]; }
  /// Of hexes that stay.
  void rename_nodes(std::vector<Hex>& array) const noexcept {
    if (names.empty()) return;
    const std::ptrdiff_t n_gone = std::ranges::lower_bound(hexes.gone, first_renamed_hex) - hexes.gone.begin();
    for (std::size_t h = static_cast<std::size_t>(first_renamed_hex - n_gone); h < array.size(); ++h)
      for (Index& n : array[h]) n = name(n);
  }
};

}  // namespace

void Splice::make_room(MeshedModel& whole, bool forward) const {
  for_each_array(MakeRoom{*this}, whole, forward ? before_ : after_, forward ? after_ : before_);
  // Nodes that stay, where they are called otherwise.
  names_.clear();
  const Index n = n_nodes(!forward), first = nodes_.first_renamed();
  if (first >= n) return;
  const Reindexing way = forward ? nodes_ : Reindexing{nodes_.come, nodes_.gone};
  if (way.gone.empty() && way.come.front() >= n) return;  // all that is new comes last
  if (way.come.empty() && way.gone.front() == n - std::ssize(way.gone)) return;
  resize_for_overwrite(names_, static_cast<std::size_t>(n - first));
  std::size_t gone = 0, come = 0;
  for (Index i = first, next = first; i < n; ++i) {
    if (gone < way.gone.size() && way.gone[gone] == i) {
      ++gone;
      names_[i - first] = -1;
      continue;
    }
    for (; come < way.come.size() && way.come[come] == next; ++come) ++next;
    names_[i - first] = next++;
  }
}

void Splice::apply(MeshedModel& whole, bool forward) const noexcept {
  const auto begin_ids = [&](std::vector<std::int64_t>& ids, Ids has, Index n) {
    if ((forward ? has.before : has.after) || !(forward ? has.after : has.before)) return;
    ids.resize(static_cast<std::size_t>(n));
    std::iota(ids.begin(), ids.end(), std::int64_t{1});
  };
  Mesh& mesh = whole.mesh;
  begin_ids(mesh.node_ids, node_ids_, n_nodes(!forward));
  begin_ids(mesh.hex_ids, hex_ids_, n_hexes(!forward));
  const Way nodes{nodes_.gone, nodes_.come}, hexes{hexes_.gone, hexes_.come};
  const auto turned = [&](Way way) { return forward ? way : Way{way.come, way.gone}; };
  for_each_array(Exchange{turned(nodes), turned(hexes), moved_, forward, names_, nodes_.first_renamed(),
                          forward ? first_renamed_.before : first_renamed_.after},
                 whole, forward ? before_ : after_, forward ? after_ : before_);
  if (!(forward ? node_ids_.after : node_ids_.before)) mesh.node_ids.clear();  // it has room for coming back
  if (!(forward ? hex_ids_.after : hex_ids_.before)) mesh.hex_ids.clear();
  names_.clear();
}

std::size_t Splice::bytes() const {
  std::size_t sum = sizeof(Splice) + moved_.capacity() * sizeof(Index);
  for (const Reindexing* all : {&nodes_, &hexes_}) sum += (all->gone.capacity() + all->come.capacity()) * sizeof(Index);
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
