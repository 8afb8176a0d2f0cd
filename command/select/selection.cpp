#include "hextwist/command/select/selection.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <span>

#include "hextwist/base/sorted.h"
#include "hextwist/base/text.h"
#include "hextwist/command/error_at.h"
#include "hextwist/command/reader.h"
#include "hextwist/command/select/nothing_left_internal.h"
#include "hextwist/command/select/shapes.h"
#include "hextwist/io/format.h"

namespace hextwist {
namespace {

using Flags = std::vector<char>;

/// The existing ids of a kind in ascending order: rank -> id, position.
class IdTable {
 public:
  IdTable(const Selector& selector, EntityKind kind) : n_(count(selector, kind)) {
    const Mesh& mesh = selector.meshed.mesh;
    if (kind == EntityKind::node) ids_ = mesh.node_ids;
    if (kind == EntityKind::hex) ids_ = mesh.hex_ids;
    if (kind == EntityKind::block || kind == EntityKind::nodeset || kind == EntityKind::sideset ||
        kind == EntityKind::group) {
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
    Flags chosen(count(selector_, kind), range.items.empty());
    items(kind, range.items, chosen);
    for (const RangeFilter& filter : range.filters) {
      const std::vector<Index> before = positions(chosen);
      switch (filter.kind) {
        case RangeFilter::Kind::in:
          in(kind, filter, chosen);
          break;
        case RangeFilter::Kind::common_to:
          common_to(kind, filter, chosen);
          break;
        case RangeFilter::Kind::with:
          with(kind, filter, chosen);
          break;
        case RangeFilter::Kind::field:
          field(kind, filter, chosen);
          break;
        case RangeFilter::Kind::adjacent:
          adjacent(kind, filter, chosen);
          break;
        case RangeFilter::Kind::parallel:
        case RangeFilter::Kind::perpendicular:
          aligned(kind, filter, chosen);
          break;
        case RangeFilter::Kind::loop:
          loop(filter, chosen);
          break;
        case RangeFilter::Kind::chain:
          chain(kind, filter, chosen);
          break;
        case RangeFilter::Kind::most:
          most(kind, filter, chosen);
          break;
        case RangeFilter::Kind::inside:
          inside(kind, filter, chosen);
          break;
        case RangeFilter::Kind::except:
          except(kind, filter, chosen);
      }
      if (!before.empty() && std::ranges::find(chosen, 1) == chosen.end())
        why = nothing_left(selector_, statement_, kind, filter, before);
    }
    return positions(chosen);
  }

  std::string why;  ///< nothing is left

 private:
  const Selector& selector_;
  const Statement& statement_;
  std::vector<std::string>& notices_;

  /// Those of chosen that are in a list of positions.
  static void keep(const std::vector<Index>& list, Flags& chosen) {
    Flags kept(chosen.size(), 0);
    for (const Index i : list) kept[i] = chosen[i];
    chosen = std::move(kept);
  }

  /// What all terms name, by kind.
  template <class F>
  void for_each_term(const RangeFilter& filter, F f) {
    for (const RangeTerm& term : filter.terms) for_each_kind(term, f);
  }

  void adjacent(EntityKind kind, const RangeFilter& filter, Flags& chosen) {
    Flags meet(chosen.size(), 0), own(chosen.size(), 0);
    for_each_term(filter, [&](EntityKind from, const std::vector<Index>& of) {
      const bool same = from == kind;
      for (const Index i : related(selector_, same ? meeting_kind(kind) : from,
                                   same ? related(selector_, kind, of, meeting_kind(kind)) : of, kind))
        meet[i] = 1;
      if (same)
        for (const Index i : of) own[i] = 1;
    });
    for (std::size_t i = 0; i < chosen.size(); ++i) chosen[i] = chosen[i] && meet[i] && !own[i];
  }

  void aligned(EntityKind kind, const RangeFilter& filter, Flags& chosen) {
    if (kind != EntityKind::curve && kind != EntityKind::surface)
      throw error_at(statement_, filter.token,
                     "curves and surfaces can be parallel, " + std::string(plural(kind)) + " can't");
    const Model& model = *selector_.meshed.model;
    std::vector<Direction> as;
    if (!filter.field.empty()) as.push_back({Vec3::Unit(filter.field[0] - 'x'), false});
    for_each_term(filter, [&](EntityKind from, const std::vector<Index>& of) {
      if (from != EntityKind::curve && from != EntityKind::surface)
        throw error_at(statement_, filter.token,
                       "curves and surfaces have directions, " + std::string(plural(from)) + " don't");
      for (const Index i : of)
        if (const auto found = direction(model, {dimension(from), i + 1})) as.push_back(*found);
    });
    const bool across = filter.kind == RangeFilter::Kind::perpendicular;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      if (!chosen[i]) continue;
      const auto own = direction(model, {dimension(kind), static_cast<int>(i) + 1});
      const bool circle = own && kind == EntityKind::curve && own->is_normal;  // it runs in no direction
      chosen[i] = own && std::ranges::any_of(as, [&](const Direction& other) {
                    return (!circle || other.is_normal) && is_aligned(*own, other, across);
                  });
    }
  }

  void loop(const RangeFilter& filter, Flags& chosen) {
    const RangeTerm& term = filter.terms[0];
    const Model& model = *selector_.meshed.model;
    std::vector<Index> curves;
    for (const Index surface : range(term.kind, term.range)) {
      const auto loops = surface_loops(model, surface + 1);
      if (loops.empty()) continue;
      std::size_t best = 0;
      if (!filter.numbers.empty()) {
        const Vec3 at(filter.numbers.data());
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < loops.size(); ++k)
          for (const int curve : loops[k])
            if (const double distance = model.project({1, curve}, at).distance; distance < nearest) {
              nearest = distance;
              best = k;
            }
      }
      for (const int curve : loops[best]) curves.push_back(curve - 1);
    }
    keep(curves, chosen);
  }

  void chain(EntityKind kind, const RangeFilter& filter, Flags& chosen) {
    if (kind != EntityKind::curve && kind != EntityKind::surface)
      throw error_at(statement_, filter.token,
                     "chains are of curves or of surfaces, not of " + std::string(plural(kind)));
    std::vector<int> ids;
    for_each_term(filter, [&](EntityKind from, const std::vector<Index>& of) {
      if (from != kind)
        throw error_at(statement_, filter.token,
                       "a chain of " + std::string(plural(kind)) + " begins at a " + std::string(name(kind)));
      for (const Index i : of) ids.push_back(i + 1);
    });
    std::vector<Index> found;
    for (const int id : smooth_chain(*selector_.meshed.model, dimension(kind), std::move(ids))) found.push_back(id - 1);
    keep(found, chosen);
  }

  void most(EntityKind kind, const RangeFilter& filter, Flags& chosen) {
    std::vector<Index> candidates = positions(chosen);
    const std::vector<double> values = values_of(selector_, statement_, kind, filter.criterion, candidates);
    std::vector<std::size_t> order(candidates.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const double sign = filter.test == RangeFilter::Test::top ? -1 : 1;
    std::ranges::stable_sort(order, {}, [&](std::size_t k) { return sign * values[k]; });
    order.resize(std::min(order.size(), static_cast<std::size_t>(filter.value)));
    std::ranges::fill(chosen, 0);
    for (const std::size_t k : order) chosen[candidates[k]] = 1;
  }

  void inside(EntityKind kind, const RangeFilter& filter, Flags& chosen) {
    const std::vector<double>& x = filter.numbers;
    const Vec3 a(x.data()), b(x.size() >= 6 ? x.data() + 3 : x.data());
    const Vec3 along = b - a;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      if (!chosen[i]) continue;
      const Vec3 p = middle(selector_, kind, static_cast<Index>(i));
      if (filter.field == "box") {
        chosen[i] = (p.array() >= a.cwiseMin(b).array()).all() && (p.array() <= a.cwiseMax(b).array()).all();
      } else if (filter.field == "sphere") {
        chosen[i] = (p - a).norm() <= x.back();
      } else {
        const double t = (p - a).dot(along) / std::max(along.squaredNorm(), 1e-300);
        chosen[i] = t >= 0 && t <= 1 && (p - a - t * along).norm() <= x.back();
      }
    }
  }

  static std::vector<Index> positions(const Flags& flags) {
    std::vector<Index> result;
    for (std::size_t i = 0; i < flags.size(); ++i)
      if (flags[i]) result.push_back(static_cast<Index>(i));
    return result;
  }

  void except(EntityKind kind, const RangeFilter& filter, Flags& chosen) {
    Flags dropped(chosen.size(), 0);
    for (const Index i : range(kind, filter.terms[0].range)) dropped[i] = 1;
    bool any = false;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      any |= chosen[i] && dropped[i];
      chosen[i] = chosen[i] && !dropped[i];
    }
    if (!any)
      notices_.push_back("'except' took nothing away: none of those " + std::string(plural(kind)) +
                         " was in the list before it");
  }

  /// Calls f(kind, positions) for what a term means; a bare name may mean entities of several kinds.
  template <class F>
  void for_each_kind(const RangeTerm& term, F f) {
    if (!term.any_kind) return f(term.kind, range(term.kind, term.range));
    const RangeItem& item = term.range.items.front();
    bool found = false;
    for (int k = 0; k < n_entity_kinds; ++k) {
      const auto kind = static_cast<EntityKind>(k);
      Flags chosen(has_names(kind) ? count(selector_, kind) : 0, 0);
      if (!find_named(kind, item.name, chosen)) continue;
      found = true;
      f(kind, positions(chosen));
    }
    if (found) return;
    std::vector<std::string> known;
    for (int k = 0; k < n_entity_kinds; ++k) append_names(static_cast<EntityKind>(k), known);
    throw error_at(statement_, item.token, "nothing is named '" + printable(item.name) + "'" + hint(item.name, known));
  }

  void in(EntityKind kind, const RangeFilter& filter, Flags& chosen) {
    Flags inside(chosen.size(), 0);
    for (const RangeTerm& term : filter.terms)
      for_each_kind(term, [&](EntityKind from, const std::vector<Index>& of) {
        for (const Index i : related(selector_, from, of, kind)) inside[i] = 1;
      });
    for (std::size_t i = 0; i < chosen.size(); ++i) chosen[i] = chosen[i] && inside[i];
  }

  /// Being related is mutual, so either side can be asked; the shorter list is.
  void common_to(EntityKind kind, const RangeFilter& filter, Flags& chosen) {
    for (const RangeTerm& term : filter.terms)
      for_each_kind(term, [&](EntityKind from, const std::vector<Index>& of) {
        std::vector<Index> candidates = positions(chosen);
        if (of.size() <= candidates.size()) {
          for (std::size_t i = 0; i < of.size() && !candidates.empty(); ++i)
            candidates = intersection(candidates, related(selector_, from, {of[i]}, kind));
        } else {
          std::erase_if(candidates,
                        [&](Index i) { return !std::ranges::includes(related(selector_, kind, {i}, from), of); });
        }
        std::ranges::fill(chosen, 0);
        for (const Index i : candidates) chosen[i] = 1;
      });
  }

  void with(EntityKind kind, const RangeFilter& filter, Flags& chosen) {
    const std::vector<Index> candidates = positions(chosen);
    const std::vector<char> good = meets(selector_, statement_, kind, filter.criterion, candidates);
    for (std::size_t i = 0; i < candidates.size(); ++i) chosen[candidates[i]] = good[i];
  }

  void field(EntityKind kind, const RangeFilter& filter, Flags& chosen) {
    if (kind != EntityKind::hex && kind != EntityKind::node)
      throw error_at(statement_, filter.token,
                     "fields have values at hexes and nodes, not at " + std::string(plural(kind)));
    std::vector<Index> candidates = positions(chosen);
    const std::vector<double> value = field_values(kind, filter);
    using Test = RangeFilter::Test;
    if (filter.test == Test::top || filter.test == Test::bottom) {
      // The largest (smallest) first; of equal ones those that come first.
      const double sign = filter.test == Test::top ? -1 : 1;
      std::ranges::stable_sort(candidates, {}, [&](Index i) { return sign * value[i]; });
      const double share = filter.value / 100 * static_cast<double>(candidates.size());
      candidates.resize(static_cast<std::size_t>(std::ceil(share * (1 - 1e-12))));
    } else {
      std::erase_if(candidates, [&](Index i) {
        return filter.test == Test::above ? !(value[i] > filter.value) : !(value[i] < filter.value);
      });
    }
    std::ranges::fill(chosen, 0);
    for (const Index i : candidates) chosen[i] = 1;
  }

  /// The component of a field that files call by this name: its own with _x, _y, _z, or _1, _2, ...; -1: none.
  static int component_called(const Field& field, const std::string& name) {
    for (int c = 0; field.components > 1 && c < field.components; ++c)
      if (name == io::component_name(field.name, c, field.components)) return c;
    return -1;
  }

  struct Named {
    const Field* field = nullptr;
    int component = -1;  ///< -1: all
  };
  /// A field, or the component of one, that nodes, or hexes, have by this name. Hexes have those of nodes too, where no
  /// field of their own is called so.
  Named field_called(EntityKind kind, const std::string& name) const {
    std::vector<Field::On> places = {Field::On::node};
    if (kind == EntityKind::hex) places = {Field::On::hex, Field::On::node};
    for (const bool whole : {true, false})
      for (const Field::On on : places)
        for (const Field& field : selector_.meshed.mesh.fields) {
          const int component = whole ? -1 : component_called(field, name);
          if (field.on == on && (whole ? field.name == name : component >= 0)) return {&field, component};
        }
    return {};
  }

  /// Of a hex: its value, or the average of its nodes. Of a node: its value. Of a vector: its length, but where one
  /// component is named.
  std::vector<double> field_values(EntityKind kind, const RangeFilter& filter) const {
    const Mesh& mesh = selector_.meshed.mesh;
    const auto [found, component] = field_called(kind, filter.field);
    if (!found) {
      std::string known;
      for (const Field& field : mesh.fields)
        if (kind == EntityKind::hex || field.on == Field::On::node) known += (known.empty() ? "" : ", ") + field.name;
      throw error_at(statement_, filter.token,
                     "there is no field '" + printable(filter.field) + "' of " + std::string(plural(kind)) +
                         (known.empty() ? "" : "; there are " + known));
    }
    const auto at = [&, of = found, only = component](Index i) {
      double sum = 0;
      for (int c = 0; c < of->components; ++c) {
        const double x = of->values[static_cast<std::size_t>(i) * static_cast<std::size_t>(of->components) +
                                    static_cast<std::size_t>(c)];
        if (of->components == 1 || c == only) return x;
        sum += x * x;
      }
      return std::sqrt(sum);
    };
    std::vector<double> values(static_cast<std::size_t>(count(selector_, kind)));
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (found->on == Field::On::hex || kind == EntityKind::node) {
        values[i] = at(static_cast<Index>(i));
        continue;
      }
      for (const Index n : mesh.hexes[i]) values[i] += at(n) / 8;
    }
    return values;
  }

  [[noreturn]] void refuse_nothing(EntityKind kind, const Token& token) const {
    if (kind == EntityKind::group) throw error_at(statement_, token, "there are no groups");
    if (is_cad(kind) && !selector_.meshed.model)
      throw error_at(statement_, token,
                     "there are no " + std::string(plural(kind)) + ": neither CAD nor mesh was read");
    if (!is_cad(kind) && selector_.meshed.mesh.n_hexes() == 0)
      throw error_at(statement_, token, "there are no " + std::string(plural(kind)) + ": no mesh was read");
    throw error_at(statement_, token, "there are no " + std::string(plural(kind)));
  }

  void items(EntityKind kind, const std::vector<RangeItem>& items, Flags& chosen) {
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
        case RangeItem::Kind::at:
          nearest(kind, item, chosen);
          break;
        case RangeItem::Kind::within: {
          const std::vector<double> distance = distances(selector_, kind, Vec3(item.point.data()));
          for (std::size_t i = 0; i < chosen.size(); ++i) chosen[i] |= distance[i] <= item.distance;
          if (std::ranges::find(chosen, 1) == chosen.end()) {
            const auto least = std::ranges::min_element(distance);
            why = "none of the " + std::to_string(chosen.size()) + " " + std::string(plural(kind)) + " is that near; " +
                  std::string(name(kind)) + " " +
                  std::to_string(id_of(selector_, kind, static_cast<Index>(least - distance.begin()))) +
                  " comes nearest with a distance of " + short_number(*least);
          }
          break;
        }
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

  void span(EntityKind kind, const IdTable& table, const RangeItem& item, Flags& chosen) {
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
    if (first_gap >= 0)
      notices_.push_back(std::to_string((last - item.first) / item.step + 1 - n_found) + " of the " +
                         std::string(plural(kind)) + " " + std::to_string(item.first) + " to " +
                         std::to_string(item.last) + " do not exist, the first is " + std::to_string(first_gap));
  }

  void nearest(EntityKind kind, const RangeItem& item, Flags& chosen) const {
    const std::vector<Index> order = by_distance(selector_, kind, Vec3(item.point.data()));
    if (item.first > static_cast<std::int64_t>(order.size()))
      throw error_at(statement_, item.token,
                     "there is no " + std::string(name(kind)) + " of ordinal " + std::to_string(item.first) +
                         ": there are " + std::to_string(order.size()));
    chosen[order[static_cast<std::size_t>(item.first - 1)]] = 1;
  }

  /// An exact name before one in other letters before a pattern.
  bool find_named(EntityKind kind, const std::string& wanted, Flags& chosen) const {
    if (wanted.empty()) return false;
    const bool pattern = wanted.find_first_of("*?") != std::string::npos;
    for (int looseness = 0; looseness < (pattern ? 3 : 2); ++looseness) {
      bool any = false;
      for (std::size_t i = 0; i < chosen.size(); ++i) {
        const std::string is = name_of(selector_, kind, static_cast<Index>(i));
        if (is.empty()) continue;
        if (looseness == 0 ? is == wanted : looseness == 1 ? same_word(is, wanted) : matches(is, wanted))
          chosen[i] = any = true;
      }
      if (any) return true;
    }
    return false;
  }

  void append_names(EntityKind kind, std::vector<std::string>& names) const {
    const Index n = has_names(kind) ? count(selector_, kind) : 0;
    for (Index i = 0; i < n; ++i)
      if (std::string is = name_of(selector_, kind, i); !is.empty()) names.push_back(std::move(is));
  }

  /// What may have been meant: the nearest name, or the names that there are.
  static std::string hint(const std::string& wanted, std::vector<std::string> known) {
    sort_unique(known);
    if (const std::string near = nearest_word(wanted, known); !near.empty())
      return " (did you mean '" + printable(near) + "'?)";
    constexpr std::size_t most = 8;
    if (known.empty()) return "";
    const bool cut = known.size() > most;
    if (cut) known.resize(most);
    std::string result = "; there are ";
    for (std::size_t i = 0; i < known.size(); ++i)
      result += std::string(i == 0 ? "'" : ", '") + printable(known[i]) + "'";
    return result + (cut ? ", ..." : "");
  }

  void named(EntityKind kind, const RangeItem& item, Flags& chosen) const {
    if (find_named(kind, item.name, chosen)) return;
    std::vector<std::string> known;
    append_names(kind, known);
    throw error_at(
        statement_, item.token,
        "no " + std::string(name(kind)) + " is named '" + printable(item.name) + "'" + hint(item.name, known));
  }
};

}  // namespace

bool matches(std::string_view name, std::string_view pattern) {
  // The last * is tried against longer and longer text; earlier ones need not be tried again.
  std::size_t n = 0, p = 0, star = std::string_view::npos, resume = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      resume = n;
    } else if (p < pattern.size() && (pattern[p] == '?' || same_word(name.substr(n, 1), pattern.substr(p, 1)))) {
      ++n;
      ++p;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      n = ++resume;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

std::vector<Index> select(const Selector& selector, const Statement& statement, EntityKind kind, const Range& range,
                          std::vector<std::string>& notices, std::string* why) {
  Evaluation evaluation(selector, statement, notices);
  std::vector<Index> result = evaluation.range(kind, range);
  if (why) *why = std::move(evaluation.why);
  return result;
}

}  // namespace hextwist
