// What verify.h promises to say, updated by what a change has taken and added.
#include <algorithm>
#include <cmath>

#include "hextwist/base/sorted.h"
#include "hextwist/mesh/association/off_model.h"
#include "hextwist/mesh/others.h"
#include "hextwist/mesh/quality/measure.h"
#include "hextwist/patch/verify_internal.h"

namespace hextwist {
namespace {

/// What the whole had and has, where it changed, for summaries.
struct Difference {
  const ChangedPart& change;
  std::vector<Index> taken;                    ///< hexes of the part that were cut or have a node that moved, ascending
  std::vector<Index> added;                    ///< hexes of the changed part likewise, ascending
  std::vector<Index> whole_taken, whole_gone;  ///< in the whole
  std::vector<std::int64_t> taken_ids;         ///< ascending
  Index n_whole = 0;                           ///< hexes of the whole afterwards
  std::int64_t id_shift;                       ///< new ids follow the highest one, of the part and of the whole

  explicit Difference(const ChangedPart& part)
      : change(part),
        taken(part.gone),
        added(part.touched),
        whole_gone(part.whole_gone()),
        id_shift(highest_element_id(part.input.mesh) - highest_element_id(part.before.mesh)) {
    for (const Index h : part.touched) taken.push_back(before_gaps(part.gone, h));
    std::ranges::sort(taken);
    added.reserve(added.size() + static_cast<std::size_t>(part.after.mesh.n_hexes() - part.n_kept));
    for (Index h = part.n_kept; h < part.after.mesh.n_hexes(); ++h) added.push_back(h);
    for (const Index h : taken) whole_taken.push_back(part.whole_hex(h));
    for (const Index h : whole_taken) taken_ids.push_back(hex_id(part.input.mesh, h));
    std::ranges::sort(taken_ids);
    n_whole = part.input.mesh.n_hexes() + part.after.mesh.n_hexes() - part.before.mesh.n_hexes();
  }
  /// Of a hex of the whole that stays.
  Index after(Index whole) const {
    return change.renamed_hexes ? change.renamed_hexes->after(whole) : after_gaps(whole_gone, whole);
  }
  /// Of a hex of the changed part.
  Index whole_after(Index hex) const {
    if (hex < change.n_kept) return after(change.whole_hex(before_gaps(change.gone, hex)));
    if (change.renamed_hexes) return change.renamed_hexes->come[hex - change.n_kept];
    return hex - change.n_kept + change.input.mesh.n_hexes() - static_cast<Index>(change.gone.size());
  }
  std::int64_t id_after(Index hex) const {
    if (hex < change.n_kept) return hex_id(change.input.mesh, change.whole_hex(before_gaps(change.gone, hex)));
    if (!change.come_ids.empty()) return change.come_ids[hex - change.n_kept];
    return hex_id(change.after.mesh, hex) + id_shift;
  }
};

/// A hex with its value; the lowest hex of those with the best value.
struct Extreme {
  double value;
  Index hex;

  void offer(double other, Index at, bool largest) {
    const bool better = largest ? other > value : other < value;
    if (better || (other == value && at < hex) || hex < 0) *this = {other, at};
  }
};

/// Where the extremes of a metric that were known are all gone: the next of the input.
ExtremeList next_extremes(const Mesh& mesh, Metric metric, const ExtremeList& known, bool largest,
                          std::span<const Index> gone) {
  if (!known.empty()) {
    // In many meshes many hexes are the best, all alike: those with the value of the last one come next.
    const auto [value, id] = known.back();
    constexpr Index n_looked_at = 4096;
    const Index from = find_hex(mesh, id) + 1, to = std::min(mesh.n_hexes(), from + n_looked_at);
    ExtremeList next;
    for (Index h = from; h < to && from > 0; ++h)
      if (!std::ranges::binary_search(gone, h))
        if (const double of = quality(metric, mesh, h); (largest ? -of : of) == value)
          next.emplace_back(value, hex_id(mesh, h));
    if (!next.empty()) return next;
  }
  return extremes(mesh, quality(metric, mesh), largest, gone);
}

/// Summary after the `taken` hexes, which had these values, and the `added` ones, which have those; the extremes
/// (least, largest) change with them. Where these don't know the next one, all hexes are asked.
Summary updated(const Summary& before, Metric metric, std::span<const double> taken, std::span<const double> values,
                const Difference& difference, std::array<ExtremeList, 2>& lists) {
  const ChangedPart& change = difference.change;
  const Mesh& input = change.input.mesh;
  // Deviations from the old average keep sums small.
  double sum = 0, squares = before.std_dev * before.std_dev * before.count;
  for (const double value : taken) {
    sum -= value - before.average;
    squares -= (value - before.average) * (value - before.average);
  }
  for (const double value : values) {
    sum += value - before.average;
    squares += (value - before.average) * (value - before.average);
  }

  std::array<Extreme, 2> both{Extreme{before.min, before.min_hex}, Extreme{before.max, before.max_hex}};
  for (const bool largest : {false, true}) {
    ExtremeList& list = lists[largest];
    Extreme& extreme = both[largest];
    const bool is_gone = std::ranges::binary_search(difference.whole_taken, extreme.hex);
    ExtremeList kept = changed(list, difference.taken_ids, {});
    if (kept.empty() && is_gone) list = kept = next_extremes(input, metric, list, largest, difference.whole_taken);
    if (is_gone && !kept.empty())
      extreme = {largest ? -kept.front().first : kept.front().first, find_hex(input, kept.front().second)};
    extreme.hex = is_gone && kept.empty() ? -1 : difference.after(extreme.hex);
    for (std::size_t i = 0; i < values.size(); ++i)
      if (extreme.hex < 0 || values[i] == extreme.value || (values[i] > extreme.value) == largest)
        extreme.offer(values[i], difference.whole_after(difference.added[i]), largest);
    ExtremeList come;
    for (std::size_t i = 0; i < values.size() && !list.empty(); ++i)  // those that are better than the last of the list
      if (const double value = largest ? -values[i] : values[i]; value <= list.back().first)
        if (const std::pair item(value, difference.id_after(difference.added[i])); item < list.back())
          come.push_back(item);
    list = changed(list, difference.taken_ids, come);
  }
  const Index n = difference.n_whole;
  const double shift = sum / n;
  const bool is_same = taken.empty() && values.empty();  // to the bit: squaring a root is not exact
  return {.count = n,
          .average = before.average + shift,
          .std_dev = is_same ? before.std_dev : std::sqrt(std::max(0.0, squares / n - shift * shift)),
          .min = both[0].value,
          .max = both[1].value,
          .min_hex = both[0].hex,
          .max_hex = both[1].hex};
}

/// Ids of the changed part as they are in the whole.
std::shared_ptr<const Extremes> with_ids_of_the_whole(Extremes lists, const Difference& difference) {
  const Mesh& part = difference.change.after.mesh;
  for (auto* metric : {&lists.shape, &lists.scaled_jacobian})
    for (ExtremeList& list : *metric)
      for (auto& [value, id] : list) id = difference.id_after(find_hex(part, id));
  return std::make_shared<const Extremes>(std::move(lists));
}

OffModel off_after(const OffModel& before, const ChangedPart& change) {
  std::vector<Index> nodes = change.moved;
  for (Index n = change.before.mesh.n_nodes(); n < change.after.mesh.n_nodes(); ++n)
    if (change.after.association.node_owner[n].dim < 3) nodes.push_back(n);
  OffModel fresh = detail::off_model(change.after.mesh, change.after.association, *change.after.model, nodes);
  if (fresh.node < 0 || (before.node >= 0 && !(fresh.max > before.max))) {
    fresh = before;
    if (change.renamed_nodes && fresh.node >= 0) fresh.node = change.renamed_nodes->after(fresh.node);
  } else {
    fresh.node = change.whole_node_after(fresh.node);
  }
  return fresh;
}

bool is_broken(const Report& report) {
  return !report.flat_hexes.empty() || (!report.off_nodes.empty() && !report.off_nodes_allowed);
}

}  // namespace

bool verify_change(const ChangedPart& change, const Measured& known, Report& report) {
  // The boundary is known from the CAD.
  if (!change.after.model || change.before.association.empty() || change.after.association.empty()) return false;
  if (is_broken(report)) return false;
  if (std::ranges::any_of(change.moved, [&](Index n) { return change.whole_node(n) == known.off_cad.node; }))
    return false;
  if (change.renamed_nodes && change.renamed_nodes->is_gone(known.off_cad.node)) return false;
  if (!is_sound(change)) return false;  // first: measuring needs nodes that exist
  const Difference difference(change);
  const Measures added = measure(change.after.mesh, difference.added);
  if (!added.all_valid) return false;

  set_before(known, report);
  const bool is_all = difference.added.size() == static_cast<std::size_t>(difference.n_whole);
  if (is_all && !change.renamed_hexes) {
    Measured all = measured_without_cad(change.after.mesh, added);
    all.extremes = with_ids_of_the_whole(*all.extremes, difference);
    set_after(all, report);
  } else {
    const Measures taken = measure(change.before.mesh, difference.taken);
    auto lists = std::make_shared<Extremes>(known.extremes ? *known.extremes : Extremes());
    report.shape_after = updated(known.shape, Metric::shape, taken.shape, added.shape, difference, lists->shape);
    report.scaled_jacobian_after = updated(known.scaled_jacobian, Metric::scaled_jacobian, taken.scaled_jacobian,
                                           added.scaled_jacobian, difference, lists->scaled_jacobian);
    report.extremes = std::move(lists);
    report.volume_after = report.volume_before;
    for (const double v : taken.volume) report.volume_after -= v;
    for (const double v : added.volume) report.volume_after += v;
  }
  report.off_cad = off_after(known.off_cad, change);
  return true;
}

}  // namespace hextwist
