#include "hextwist/parts/mpi/share_out.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "hextwist/base/sorted.h"
#include "hextwist/base/text.h"
#include "hextwist/mesh/arrays.h"
#include "hextwist/parts/join.h"
#include "hextwist/parts/pack.h"
#include "hextwist/patch/patch.h"

namespace hextwist {
namespace {

__extension__ typedef unsigned __int128 Key;  // place, then id: no two hexes have the same

/// Numbers in the order of doubles.
std::uint64_t in_order(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value + 0.0);  // of -0 those of 0
  constexpr std::uint64_t sign = std::uint64_t{1} << 63;
  return bits & sign ? ~bits : bits | sign;
}
std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31);
}

/// Hexes that go to the ranks first .. last - 1.
struct Group {
  int first = 0, last = 1;
  std::vector<Index> hexes;
};

class Sharing {
 public:
  Sharing(Ranks& ranks, const Mesh& part, PartitionBy by, std::span<const std::int64_t> weights)
      : ranks_(ranks), part_(part), by_(by), weights_(weights), middle_(part.hexes.size()) {
    for (std::size_t h = 0; h < middle_.size(); ++h) {
      middle_[h] = Vec3::Zero();
      for (const Index n : part.hexes[h]) middle_[h] += part.points[n];
    }
    groups_.push_back({0, ranks.size(), std::vector<Index>(part.hexes.size())});
    std::iota(groups_[0].hexes.begin(), groups_[0].hexes.end(), 0);
    whole_axis_ = axes()[0];
  }
  std::vector<int> result() {
    while (std::ranges::any_of(groups_, [](const Group& g) { return g.last - g.first > 1; })) halve();
    std::vector<int> rank(part_.hexes.size(), 0);
    for (const Group& group : groups_)
      for (const Index h : group.hexes) rank[h] = group.first;
    return rank;
  }

 private:
  /// Per group the direction in which it is longest.
  std::vector<int> axes() {
    std::vector<double> bounds;  // largest of x and of -x, ...
    for (const Group& group : groups_) {
      std::array<double, 6> of;
      of.fill(-std::numeric_limits<double>::infinity());
      for (const Index h : group.hexes)
        for (int k = 0; k < 3; ++k) {
          of[2 * k] = std::max(of[2 * k], middle_[h][k]);
          of[2 * k + 1] = std::max(of[2 * k + 1], -middle_[h][k]);
        }
      bounds.insert(bounds.end(), of.begin(), of.end());
    }
    bounds = ranks_.largest(std::move(bounds));
    std::vector<int> axis;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      std::array<double, 3> length{};
      for (std::size_t k = 0; k < 3; ++k) length[k] = bounds[6 * g + 2 * k] + bounds[6 * g + 2 * k + 1];
      axis.push_back(static_cast<int>(std::ranges::max_element(length) - length.begin()));
    }
    return axis;
  }
  Key key(Index h, int axis) const {
    const auto id = static_cast<std::uint64_t>(hex_id(part_, h));
    if (by_ == PartitionBy::ids) return id;
    if (by_ == PartitionBy::random) return Key{mixed(id)} << 64 | id;
    return Key{in_order(middle_[h][axis])} << 64 | id;
  }
  std::int64_t weight(Index h) const { return weights_.empty() ? 1 : weights_[h]; }

  /// Every group of several ranks becomes two.
  void halve() {
    std::vector<int> axis(groups_.size(), whole_axis_);
    if (by_ == PartitionBy::boxes) axis = axes();
    struct Sorted {
      std::vector<std::pair<Key, Index>> hexes;
      std::vector<std::int64_t> before;  // weights
    };
    std::vector<Sorted> sorted(groups_.size());
    std::vector<std::int64_t> total;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      for (const Index h : groups_[g].hexes) sorted[g].hexes.emplace_back(key(h, axis[g]), h);
      std::ranges::sort(sorted[g].hexes);
      sorted[g].before.push_back(0);
      for (const auto& each : sorted[g].hexes)
        sorted[g].before.push_back(sorted[g].before.back() + weight(each.second));
      total.push_back(sorted[g].before.back());
    }
    total = ranks_.sum(std::move(total));
    // The lowest key below which there is as much as the first half of the ranks is to have, bit by bit.
    std::vector<Key> bound(groups_.size(), 0);
    const auto place = [&](std::size_t g, Key at) {
      return std::ranges::lower_bound(sorted[g].hexes, at, {}, &std::pair<Key, Index>::first) - sorted[g].hexes.begin();
    };
    for (int bit = 127; bit >= 0; --bit) {
      std::vector<std::int64_t> below;
      for (std::size_t g = 0; g < groups_.size(); ++g)
        below.push_back(sorted[g].before[place(g, bound[g] | Key{1} << bit)]);
      below = ranks_.sum(std::move(below));
      for (std::size_t g = 0; g < groups_.size(); ++g) {
        const auto n = groups_[g].last - groups_[g].first, half = n / 2;
        if (below[g] * n <= total[g] * half) bound[g] |= Key{1} << bit;
      }
    }
    std::vector<Group> next;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const Group& group = groups_[g];
      if (group.last - group.first == 1) {
        next.push_back(std::move(groups_[g]));
        continue;
      }
      const int middle = group.first + (group.last - group.first) / 2;
      Group low{group.first, middle, {}}, high{middle, group.last, {}};
      const auto at = static_cast<std::size_t>(place(g, bound[g]));
      for (std::size_t i = 0; i < sorted[g].hexes.size(); ++i)
        (i < at ? low : high).hexes.push_back(sorted[g].hexes[i].second);
      next.push_back(std::move(low));
      next.push_back(std::move(high));
    }
    groups_ = std::move(next);
  }

  Ranks& ranks_;
  const Mesh& part_;
  PartitionBy by_;
  std::span<const std::int64_t> weights_;
  std::vector<Vec3> middle_;
  std::vector<Group> groups_;
  int whole_axis_ = 0;
};

}  // namespace

std::vector<int> share_out(Ranks& ranks, const Mesh& part, PartitionBy by, std::span<const std::int64_t> weights) {
  const std::int64_t n_hexes = ranks.sum(part.n_hexes());
  if (n_hexes < ranks.size())
    throw Error("a mesh of " + counted(n_hexes, "hex", "hexes") + " has no " + std::to_string(ranks.size()) + " parts");
  std::vector<int> rank = Sharing(ranks, part, by, weights).result();
  std::vector<std::int64_t> n(static_cast<std::size_t>(ranks.size()), 0);
  for (const int r : rank) ++n[r];
  n = ranks.sum(std::move(n));
  if (std::ranges::find(n, 0) != n.end()) {
    if (!weights.empty()) return share_out(ranks, part, by);
    throw Error("the mesh can't be shared out among " + std::to_string(ranks.size()) + " ranks");
  }
  return rank;
}

MeshedModel moved(Ranks& ranks, MeshedModel part, std::span<const int> rank_of_hex) {
  std::vector<std::vector<std::byte>> to(static_cast<std::size_t>(ranks.size()));
  const auto model = part.model;
  ranks.together([&] {
    std::vector<std::vector<Index>> hexes(to.size());
    for (Index h = 0; h < part.mesh.n_hexes(); ++h) hexes[rank_of_hex[h]].push_back(h);
    for (std::size_t r = 0; r < to.size(); ++r) {
      if (hexes[r].empty()) continue;
      Patch patch = make_patch(part, std::move(hexes[r]));
      set_ids(part.mesh, patch, patch.meshed.mesh);
      to[r] = packed(patch.meshed);
    }
    MeshedModel heads;
    copy_heads(part.mesh, heads.mesh);
    part = std::move(heads);
  });
  std::vector<std::vector<std::byte>> from = ranks.exchange(to);
  to.clear();
  MeshedModel result;
  ranks.together([&] {
    std::vector<MeshedModel> pieces;
    for (std::vector<std::byte>& bytes : from) {
      if (!bytes.empty()) pieces.push_back(unpacked(bytes));
      bytes = {};
    }
    if (pieces.size() == 1) {
      result = std::move(pieces[0]);
    } else if (pieces.empty()) {
      result = std::move(part);
    } else {
      const std::vector<MeshedModel> all = std::move(pieces);
      result = join(all, [](std::size_t) { return std::string("the mesh"); });
    }
    result.model = model;
    Mesh& mesh = result.mesh;
    if (mesh.node_ids.empty())
      for (Index n = 0; n < mesh.n_nodes(); ++n) mesh.node_ids.push_back(n + 1);
    if (mesh.hex_ids.empty())
      for (Index h = 0; h < mesh.n_hexes(); ++h) mesh.hex_ids.push_back(h + 1);
  });
  return result;
}

namespace {

/// Room for the last node.
struct OneNodeMore {
  std::size_t n_nodes;
  template <class T>
  void operator()(const ArrayTag& tag, std::vector<T>& array) const {
    if (tag.per == Per::node && !array.empty()) array.resize(n_nodes * tag.width);
  }
  template <IsList List>
  void operator()(const ArrayTag&, const List&) const {}
};

}  // namespace

MeshedModel at_first(Ranks& ranks, MeshedModel part, std::vector<int>& home, std::int64_t highest_node) {
  std::vector<std::vector<std::int64_t>> ids(static_cast<std::size_t>(ranks.size()));
  ids[0] = part.mesh.hex_ids;
  ids = ranks.exchange(ids);
  const std::shared_ptr<const Model> model = part.model;
  const std::vector<int> to_first(part.mesh.hexes.size(), 0);
  MeshedModel whole = moved(ranks, std::move(part), to_first);
  if (!ranks.is_first()) return {{}, model, {}};
  home.resize(whole.mesh.hexes.size());
  for (std::size_t rank = 0; rank < ids.size(); ++rank)
    for (const std::int64_t id : ids[rank]) home[find_hex(whole.mesh, id)] = static_cast<int>(rank);
  if (!whole.mesh.node_ids.empty() && highest_node > whole.mesh.node_ids.back()) {
    const Vec3 place = middles_of(whole.mesh).front();  // near no other node
    for_each_array(OneNodeMore{whole.mesh.points.size() + 1}, whole);
    whole.mesh.points.back() = place;
    whole.mesh.node_ids.back() = highest_node;
  }
  return whole;
}

double load_of(Ranks& ranks, std::int64_t n, const Say& say) {
  const std::int64_t all = ranks.sum(n), largest = ranks.largest(n);
  const double load = static_cast<double>(largest) * ranks.size() / static_cast<double>(all);
  say("the largest part has " + short_number(load) + " times the average");
  return load;
}

void share_heads(Ranks& ranks, Mesh& part) {
  MeshedModel mine;
  copy_heads(part, mine.mesh);
  const auto all = ranks.everywhere(packed(mine));
  ranks.together([&] {
    std::vector<MeshedModel> pieces;
    for (const auto& bytes : all) pieces.push_back(unpacked(bytes));
    Mesh heads = join(pieces, [](std::size_t) { return std::string(); }).mesh;
    const auto fill = [&](auto& to, auto& own) {
      for (auto& group : to)
        for (auto& other : own)
          if constexpr (requires { group.id; }) {
            if (other.id == group.id) items_of(group) = std::move(items_of(other));
          } else if (other.on == group.on && other.name == group.name) {
            group.values = std::move(other.values);
          }
      own = std::move(to);
    };
    fill(heads.blocks, part.blocks);
    fill(heads.node_sets, part.node_sets);
    fill(heads.side_sets, part.side_sets);
    fill(heads.fields, part.fields);
    for (Field& field : part.fields) {
      const std::size_t n = (field.on == Field::On::node ? part.points.size() : part.hexes.size()) *
                            static_cast<std::size_t>(field.components);
      if (field.values.size() != n) field.values.assign(n, std::numeric_limits<double>::quiet_NaN());
    }
  });
}

}  // namespace hextwist
