#include "hextwist/command/selection.h"

#include <algorithm>
#include <numeric>
#include <span>

#include "hextwist/command/command_error.h"
#include "hextwist/command/reader.h"

namespace hextwist {
namespace {

/// The existing ids of a kind in ascending order: rank -> id, position.
class IdTable {
 public:
  IdTable(const Selector& selector, EntityKind kind) : n_(count(selector, kind)) {
    const Mesh& mesh = selector.meshed.mesh;
    if (kind == EntityKind::node) ids_ = mesh.node_ids;
    if (kind == EntityKind::hex) ids_ = mesh.hex_ids;
    if (kind == EntityKind::block || kind == EntityKind::nodeset || kind == EntityKind::sideset) {
      positions_.resize(n_);
      std::iota(positions_.begin(), positions_.end(), Index{0});
      std::ranges::sort(positions_, {}, [&](Index i) { return id_of(selector, kind, i); });
      for (const Index i : positions_) own_.push_back(id_of(selector, kind, i));
      ids_ = own_;
    }
  }
  IdTable(const IdTable&) = delete;

  Index size() const { return n_; }
  std::int64_t id(Index rank) const { return ids_.empty() ? std::int64_t{rank} + 1 : ids_[rank]; }
  Index position(Index rank) const { return positions_.empty() ? rank : positions_[rank]; }
  /// Rank of the first id that is at least this.
  Index lower(std::int64_t wanted) const {
    if (ids_.empty()) return static_cast<Index>(std::clamp<std::int64_t>(wanted - 1, 0, n_));
    return static_cast<Index>(std::ranges::lower_bound(ids_, wanted) - ids_.begin());
  }

 private:
  Index n_;
  std::span<const std::int64_t> ids_;  // empty: 1 .. n
  std::vector<std::int64_t> own_;
  std::vector<Index> positions_;
};

std::string one(EntityKind kind, std::int64_t id) {
  return std::string(name(kind)) + " " + std::to_string(id);
}

class Evaluation {
 public:
  Evaluation(const Selector& selector, const Statement& statement, std::vector<std::string>& notices)
      : selector_(selector), statement_(statement), notices_(notices) {}

  std::vector<Index> range(EntityKind kind, const Range& range) {
    if (count(selector_, kind) == 0) refuse_nothing(kind, range.token);
    std::vector<char> chosen(count(selector_, kind), range.items.empty());
    items(kind, range.items, chosen);
    if (!range.except.empty()) {
      std::vector<char> dropped(chosen.size(), 0);
      items(kind, range.except, dropped);
      bool any = false;
      for (std::size_t i = 0; i < chosen.size(); ++i) {
        any |= chosen[i] && dropped[i];
        chosen[i] = chosen[i] && !dropped[i];
      }
      if (!any)
        notices_.push_back("'except' took nothing away: none of those " + std::string(plural(kind)) +
                           " was in the list before it");
    }
    if (!range.in.empty()) {
      std::vector<char> inside(chosen.size(), 0);
      for (const RangeTerm& term : range.in)
        for (const Index i : related(selector_, term.kind, this->range(term.kind, term.range), kind)) inside[i] = 1;
      for (std::size_t i = 0; i < chosen.size(); ++i) chosen[i] = chosen[i] && inside[i];
    }
    std::vector<Index> result;
    for (std::size_t i = 0; i < chosen.size(); ++i)
      if (chosen[i]) result.push_back(static_cast<Index>(i));
    return result;
  }

 private:
  const Selector& selector_;
  const Statement& statement_;
  std::vector<std::string>& notices_;

  [[noreturn]] void refuse_nothing(EntityKind kind, const Token& token) const {
    if (is_cad(kind) && !selector_.meshed.model)
      throw error_at(statement_, token, "there are no " + std::string(plural(kind)) + ": no CAD and no mesh was read");
    if (!is_cad(kind) && selector_.meshed.mesh.n_hexes() == 0)
      throw error_at(statement_, token, "there are no " + std::string(plural(kind)) + ": no mesh was read");
    throw error_at(statement_, token, "there are no " + std::string(plural(kind)));
  }

  void items(EntityKind kind, const std::vector<RangeItem>& items, std::vector<char>& chosen) {
    if (items.empty()) return;
    const IdTable table(selector_, kind);
    for (const RangeItem& item : items) {
      switch (item.kind) {
        case RangeItem::Kind::all:
          std::ranges::fill(chosen, 1);
          break;
        case RangeItem::Kind::name:
          named(kind, item, chosen);
          break;
        case RangeItem::Kind::id: {
          const Index rank = table.lower(item.first);
          if (rank == table.size() || table.id(rank) != item.first) missing(kind, table, item.token, item.first);
          chosen[table.position(rank)] = 1;
          break;
        }
        case RangeItem::Kind::span:
          span(kind, table, item, chosen);
      }
    }
  }

  [[noreturn]] void missing(EntityKind kind, const IdTable& table, const Token& token, std::int64_t id) const {
    const std::int64_t low = table.id(0), high = table.id(table.size() - 1);
    throw error_at(
        statement_, token,
        one(kind, id) + " does not exist; " +
            (low == high ? "the only one is " + std::to_string(low)
                         : std::string(plural(kind)) + " are " + std::to_string(low) + " to " + std::to_string(high)));
  }

  void span(EntityKind kind, const IdTable& table, const RangeItem& item, std::vector<char>& chosen) {
    const std::int64_t high = table.id(table.size() - 1);
    if (item.first < table.id(0)) missing(kind, table, item.token, item.first);
    if (item.first > high) missing(kind, table, item.token, item.first);
    const std::int64_t last = item.first + (item.last - item.first) / item.step * item.step;
    if (last > high)
      missing(kind, table, item.last_token, item.first + ((high - item.first) / item.step + 1) * item.step);
    std::int64_t n_found = 0, first_gap = -1, wanted = item.first;
    for (Index rank = table.lower(item.first); rank < table.size() && table.id(rank) <= last; ++rank) {
      if ((table.id(rank) - item.first) % item.step) continue;
      if (first_gap < 0 && table.id(rank) != wanted) first_gap = wanted;
      wanted += item.step;
      chosen[table.position(rank)] = 1;
      ++n_found;
    }
    if (first_gap < 0 && n_found < (last - item.first) / item.step + 1) first_gap = wanted;
    if (n_found == 0) missing(kind, table, item.token, item.first);
    if (first_gap > 0)
      notices_.push_back(std::to_string((last - item.first) / item.step + 1 - n_found) + " of the " +
                         std::string(plural(kind)) + " " + std::to_string(item.first) + " to " +
                         std::to_string(item.last) + " do not exist, the first is " + std::to_string(first_gap));
  }

  void named(EntityKind kind, const RangeItem& item, std::vector<char>& chosen) const {
    for (const bool exact : {true, false}) {
      bool any = false;
      for (std::size_t i = 0; i < chosen.size() && !item.name.empty(); ++i) {
        const std::string is = name_of(selector_, kind, static_cast<Index>(i));
        if (exact ? is == item.name : same_word(is, item.name)) chosen[i] = any = true;
      }
      if (any) return;
    }
    throw error_at(statement_, item.token,
                   "no " + std::string(name(kind)) + " is named '" + printable(item.name) + "'");
  }
};

}  // namespace

const Edges& DerivedTopology::edges() {
  if (!edges_) edges_ = hextwist::edges(mesh_);
  return *edges_;
}
const Faces& DerivedTopology::faces() {
  if (!faces_) faces_ = hextwist::faces(mesh_);
  return *faces_;
}
const Sheets& DerivedTopology::sheets() {
  if (!sheets_) sheets_ = hextwist::sheets(mesh_, edges());
  return *sheets_;
}

Index count(const Selector& selector, EntityKind kind) {
  const auto& [meshed, topology] = selector;
  if (is_cad(kind)) return meshed.model ? meshed.model->count(dimension(kind)) : 0;
  if (meshed.mesh.n_hexes() == 0) return 0;
  switch (kind) {
    case EntityKind::node:
      return meshed.mesh.n_nodes();
    case EntityKind::edge:
      return static_cast<Index>(topology.edges().nodes.size());
    case EntityKind::face:
      return static_cast<Index>(topology.faces().nodes.size());
    case EntityKind::hex:
      return meshed.mesh.n_hexes();
    case EntityKind::block:
      return static_cast<Index>(meshed.mesh.blocks.size());
    case EntityKind::nodeset:
      return static_cast<Index>(meshed.mesh.node_sets.size());
    case EntityKind::sideset:
      return static_cast<Index>(meshed.mesh.side_sets.size());
    default:
      return topology.sheets().edges.size();
  }
}

std::int64_t id_of(const Selector& selector, EntityKind kind, Index position) {
  const Mesh& mesh = selector.meshed.mesh;
  switch (kind) {
    case EntityKind::node:
      return node_id(mesh, position);
    case EntityKind::hex:
      return hex_id(mesh, position);
    case EntityKind::block:
      return mesh.blocks[position].id;
    case EntityKind::nodeset:
      return mesh.node_sets[position].id;
    case EntityKind::sideset:
      return mesh.side_sets[position].id;
    default:
      return std::int64_t{position} + 1;
  }
}

std::string name_of(const Selector& selector, EntityKind kind, Index position) {
  const Mesh& mesh = selector.meshed.mesh;
  if (is_cad(kind)) return selector.meshed.model->name({dimension(kind), position + 1});
  switch (kind) {
    case EntityKind::block:
      return mesh.blocks[position].name;
    case EntityKind::nodeset:
      return mesh.node_sets[position].name;
    case EntityKind::sideset:
      return mesh.side_sets[position].name;
    default:
      return "";
  }
}

std::vector<Index> select(const Selector& selector, const Statement& statement, EntityKind kind, const Range& range,
                          std::vector<std::string>& notices) {
  return Evaluation(selector, statement, notices).range(kind, range);
}

}  // namespace hextwist
