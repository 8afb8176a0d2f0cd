#include "hextwist/patch/verify.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <ranges>

#include "hextwist/base/parallel.h"
#include "hextwist/base/same_bits.h"
#include "hextwist/base/sorted.h"
#include "hextwist/base/text.h"
#include "hextwist/mesh/association/off_model.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/mesh/others.h"
#include "hextwist/mesh/quality/measure.h"
#include "hextwist/mesh/topology.h"
#include "hextwist/mesh/validate/validate_parts.h"
#include "hextwist/patch/verify_internal.h"

namespace hextwist {
namespace {

/// Index in the input of a refined hex that was kept: ids tell.
Index old_index(const Mesh& input, const Mesh& refined, Index kept) {
  return find_hex(input, hex_id(refined, kept));
}

/// Input hexes that were cut. Kept hexes follow each other as before with gaps where hexes are gone; each gap is found
/// by bisection.
std::vector<Index> find_gone(const Mesh& input, const Mesh& refined, Index n_kept) {
  std::vector<Index> gone;
  for (Index i = 0, n_gone = 0; i < n_kept || n_gone < input.n_hexes() - n_kept;) {
    const auto rest = std::views::iota(i, n_kept);
    const auto next =
        std::ranges::partition_point(rest, [&](Index k) { return old_index(input, refined, k) - k == n_gone; });
    i += static_cast<Index>(next - rest.begin());
    const Index gap_end = i < n_kept ? old_index(input, refined, i) : input.n_hexes();
    for (Index h = i + n_gone; h < gap_end; ++h) gone.push_back(h);
    n_gone = gap_end - i;
  }
  return gone;
}

/// The whole mesh as the part that changed.
ChangedPart find_change(const MeshedModel& input, const MeshedModel& refined) {
  ChangedPart change{input, input, refined};
  const std::int64_t last_old = hex_id(input.mesh, input.mesh.n_hexes() - 1);
  const auto all = std::views::iota(Index{0}, refined.mesh.n_hexes());
  change.n_kept = static_cast<Index>(
      std::ranges::partition_point(all, [&](Index h) { return hex_id(refined.mesh, h) <= last_old; }) - all.begin());
  change.gone = find_gone(input.mesh, refined.mesh, change.n_kept);
  find_moved(change);
  return change;
}

std::vector<Index> moved_nodes(const Mesh& before, const Mesh& after) {
  constexpr Index size = 4096;
  std::vector<std::vector<Index>> of_chunk(n_chunks(before.n_nodes(), size));
  parallel_chunks(before.n_nodes(), size, [&](Index chunk, Index begin, Index end) {
    const Vec3 *was = before.points.data(), *is = after.points.data();
    if (std::memcmp(was + begin, is + begin, static_cast<std::size_t>(end - begin) * sizeof(Vec3)) == 0) return;
    for (Index n = begin; n < end; ++n)
      if (was[n] != is[n]) of_chunk[chunk].push_back(n);
  });
  std::vector<Index> moved;
  for (const auto& list : of_chunk) moved.insert(moved.end(), list.begin(), list.end());
  return moved;
}

/// What the whole had and has, where it changed, for summaries.
struct Difference {
  const ChangedPart& change;
  std::vector<Index> taken;                    ///< hexes of the part that were cut or have a node that moved, ascending
  std::vector<Index> added;                    ///< hexes of the changed part likewise, ascending
  std::vector<Index> whole_taken, whole_gone;  ///< in the whole
  Index n_whole = 0;                           ///< hexes of the whole afterwards

  explicit Difference(const ChangedPart& part) : change(part), taken(part.gone), added(part.touched) {
    for (const Index h : part.touched) taken.push_back(before_gaps(part.gone, h));
    std::ranges::sort(taken);
    for (Index h = part.n_kept; h < part.after.mesh.n_hexes(); ++h) added.push_back(h);
    for (const Index h : taken) whole_taken.push_back(part.whole_hex(h));
    for (const Index h : part.gone) whole_gone.push_back(part.whole_hex(h));
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
    const Mesh &input = change.input.mesh, &before = change.before.mesh;
    if (hex < change.n_kept) return hex_id(input, change.whole_hex(before_gaps(change.gone, hex)));
    if (!change.come_ids.empty()) return change.come_ids[hex - change.n_kept];
    // New ids follow the highest one.
    return hex_id(change.after.mesh, hex) - highest_element_id(before) + highest_element_id(input);
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

/// Summary after some hexes were taken away and others added; the extremes (least, largest) change with them. Where
/// these don't know the next one, all hexes are asked.
Summary updated(const Summary& before, Metric metric, const Difference& difference, std::array<ExtremeList, 2>& lists) {
  const ChangedPart& change = difference.change;
  const Mesh& input = change.input.mesh;
  // Deviations from the old average keep sums small.
  double sum = 0, squares = before.std_dev * before.std_dev * before.count;
  for (const double value : quality(metric, change.before.mesh, difference.taken)) {
    sum -= value - before.average;
    squares -= (value - before.average) * (value - before.average);
  }
  const std::vector<double> values = quality(metric, change.after.mesh, difference.added);
  for (const double value : values) {
    sum += value - before.average;
    squares += (value - before.average) * (value - before.average);
  }
  std::vector<std::int64_t> gone;
  gone.reserve(difference.whole_taken.size());
  for (const Index h : difference.whole_taken) gone.push_back(hex_id(input, h));

  std::array<Extreme, 2> both{Extreme{before.min, before.min_hex}, Extreme{before.max, before.max_hex}};
  for (const bool largest : {false, true}) {
    ExtremeList& list = lists[largest];
    Extreme& extreme = both[largest];
    const bool is_gone = std::ranges::binary_search(difference.whole_taken, extreme.hex);
    ExtremeList kept = changed(list, gone, {});
    if (kept.empty() && is_gone) list = kept = extremes(input, quality(metric, input), largest, difference.whole_taken);
    if (is_gone && !kept.empty())
      extreme = {largest ? -kept.front().first : kept.front().first, find_hex(input, kept.front().second)};
    extreme.hex = is_gone && kept.empty() ? -1 : difference.after(extreme.hex);
    for (std::size_t i = 0; i < values.size(); ++i)
      if (extreme.hex < 0 || values[i] == extreme.value || (values[i] > extreme.value) == largest)
        extreme.offer(values[i], difference.whole_after(difference.added[i]), largest);
    ExtremeList come;
    for (std::size_t i = 0; i < values.size(); ++i)  // those that are better than the last of the list
      if (const double value = largest ? -values[i] : values[i]; !list.empty() && value <= list.back().first)
        come.emplace_back(value, difference.id_after(difference.added[i]));
    list = changed(list, gone, come);
  }
  const Index n = difference.n_whole;
  const double shift = sum / n;
  return {.count = n,
          .average = before.average + shift,
          .std_dev = std::sqrt(std::max(0.0, squares / n - shift * shift)),
          .min = both[0].value,
          .max = both[1].value,
          .min_hex = both[0].hex,
          .max_hex = both[1].hex};
}

Box box_of(const Mesh& mesh, const Quad& nodes) {
  Box box;
  for (const Index n : nodes) box.add(mesh.points[n]);
  return box;
}

/// Changed hexes of the part, and all that share a node with them; ascending.
std::vector<Index> hexes_around(const ChangedPart& change) {
  const Mesh& mesh = change.after.mesh;
  std::vector<std::uint8_t> near(mesh.points.size(), 0);
  mark_nodes(mesh.hexes, change.touched, near);
  for (Index h = change.n_kept; h < mesh.n_hexes(); ++h)
    for (const Index n : mesh.hexes[h]) near[n] = 1;
  std::vector<Index> around = touching_hexes(std::span(mesh.hexes).first(change.n_kept), near);
  for (Index h = change.n_kept; h < mesh.n_hexes(); ++h) around.push_back(h);
  return around;
}

/// Hexes of the input that were kept and have a side on the CAD near new ones, wherever in the mesh; ascending.
std::vector<Index> hexes_near_new_boundary(const ChangedPart& change) {
  Box fresh;
  double longest = 0;
  for (const Side side : change.after.association.surface_faces)
    if (side.hex >= change.n_kept) {
      const Box face = box_of(change.after.mesh, face_nodes(change.after.mesh.hexes[side.hex], side.face));
      longest = std::max(longest, face.diagonal());
      fresh.add(face);
    }
  std::vector<Index> near;
  if (fresh.empty()) return near;
  fresh.min.array() -= longest;
  fresh.max.array() += longest;
  const Mesh& mesh = change.input.mesh;
  // All boundary faces are asked: most lie beyond one side of the box, which their coordinates in one direction tell.
  const auto apart = [&](const std::array<Index, 4>& nodes, int axis) {
    const auto at = [&](int k) { return mesh.points[nodes[k]][axis]; };
    const double low = fresh.min[axis], high = fresh.max[axis];
    return (at(0) < low && at(1) < low && at(2) < low && at(3) < low) ||
           (at(0) > high && at(1) > high && at(2) > high && at(3) > high);
  };
  for (const Side side : change.input.association.surface_faces) {
    const auto nodes = face_nodes(mesh.hexes[side.hex], side.face);
    if (!apart(nodes, 0) && !apart(nodes, 1) && !apart(nodes, 2)) near.push_back(side.hex);
  }
  near.erase(std::ranges::unique(near).begin(), near.end());
  std::erase_if(near, [gone = Difference(change).whole_gone](Index h) { return std::ranges::binary_search(gone, h); });
  return near;
}

/// The hexes that are validated as a mesh of their own: those of the part, then others of the input.
Mesh mesh_to_validate(const ChangedPart& change, std::span<const Index> of_part, std::span<const Index> others) {
  const Mesh &part = change.after.mesh, &input = change.input.mesh;
  Mesh mesh;
  mesh.hexes.reserve(of_part.size() + others.size());
  std::vector<Index> number(part.points.size(), -1);  // per node of the part
  const auto of_part_node = [&](Index n) {
    if (number[n] < 0) {
      number[n] = mesh.n_nodes();
      mesh.points.push_back(part.points[n]);
    }
    return number[n];
  };
  for (const Index h : of_part)
    for (Index& n : mesh.hexes.emplace_back(part.hexes[h])) n = of_part_node(n);
  // Other hexes may have nodes of the part, and of their own.
  std::vector<Index> own;
  const auto in_part = [&](Index n) { return change.nodes.empty() ? n : position_in(change.nodes, n); };
  for (const Index h : others)
    for (const Index n : input.hexes[h])
      if (in_part(n) < 0) own.push_back(n);
  sort_unique(own);
  const Index first_own = mesh.n_nodes();
  for (const Index n : own) mesh.points.push_back(input.points[n]);
  for (const Index h : others)
    for (Index& n : mesh.hexes.emplace_back(input.hexes[h])) {
      const Index there = in_part(n);
      n = there >= 0 ? of_part_node(there) : first_own + position_in(own, n);
    }
  return mesh;
}

bool is_sound(const ChangedPart& change) {
  const std::vector<Index> of_part = hexes_around(change);
  std::vector<Index> known;  // of these, the kept ones in numbers of the input
  for (const Index h : of_part)
    if (h < change.n_kept) known.push_back(change.whole_hex(before_gaps(change.gone, h)));
  const std::vector<Index> others = difference(hexes_near_new_boundary(change), known);
  const Mesh mesh = mesh_to_validate(change, of_part, others);
  std::vector<Side> open;
  if (!is_sound_without_skin(mesh, open)) return false;
  // Sides with nothing behind: those on the CAD are boundary, the others of kept hexes have a neighbour that is not
  // here.
  const auto is_on_cad = [](const Association& association, Side side) {
    return std::ranges::binary_search(association.surface_faces, side);
  };
  std::vector<Side> skin;
  for (const Side side : open) {
    const bool of_others = side.hex >= static_cast<Index>(of_part.size());
    const Index hex = of_others ? others[side.hex - of_part.size()] : of_part[side.hex];
    if (is_on_cad(of_others ? change.input.association : change.after.association, {hex, side.face}))
      skin.push_back(side);
    else if (!of_others && hex >= change.n_kept)
      return false;
  }
  return !has_joined_nodes(mesh, skin);
}

OffModel off_after(const OffModel& before, const ChangedPart& change) {
  std::vector<Index> nodes = change.moved;
  for (Index n = change.before.mesh.n_nodes(); n < change.after.mesh.n_nodes(); ++n) nodes.push_back(n);
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

/// What the passes know to be no good, as violations.
void add_broken(const Mesh& refined, Report& report) {
  for (const Index h : report.flat_hexes)
    report.violations.push_back({ViolationKind::flattened,
                                 {h},
                                 {},
                                 "hex " + std::to_string(hex_id(refined, h)) +
                                     " is flat compared with the hexes that were there: its scaled Jacobian is " +
                                     short_number(quality(Metric::scaled_jacobian, refined, h), 6)});
  if (report.off_nodes_allowed) return;
  for (const OffOwner& row : report.off_nodes)
    report.violations.push_back({ViolationKind::off_model,
                                 {},
                                 {row.node},
                                 "node " + std::to_string(node_id(refined, row.node)) + " could not be put on " +
                                     to_string(row.owner) + ", it is " + short_number(row.distance, 6) +
                                     " off ('allow off_cad' would leave it there)"});
}

Measured measured_without_cad(const Mesh& mesh, const Measures& of_hexes) {
  Measured result;
  auto lists = std::make_shared<Extremes>();
  const auto summary = [&](const std::vector<double>& values, std::array<ExtremeList, 2>& of) {
    of = {extremes(mesh, values, false), extremes(mesh, values, true)};
    return summarize(values);
  };
  result.shape = summary(of_hexes.shape, lists->shape);
  result.scaled_jacobian = summary(of_hexes.scaled_jacobian, lists->scaled_jacobian);
  for (const double of_hex : of_hexes.volume) result.volume += of_hex;
  result.extremes = std::move(lists);
  return result;
}

Measured measured(const MeshedModel& meshed, const Measures& of_hexes) {
  Measured result = measured_without_cad(meshed.mesh, of_hexes);
  if (meshed.model && !meshed.association.empty())
    result.off_cad = off_model(meshed.mesh, meshed.association, *meshed.model);
  return result;
}

/// Nothing was cut and nothing moved.
bool is_unchanged(const MeshedModel& input, const MeshedModel& refined) {
  return same_bits(input.mesh.points, refined.mesh.points) && input.mesh.hexes == refined.mesh.hexes &&
         same_bits(input.association.node_parameters, refined.association.node_parameters);
}

void set_before(const Measured& of, Report& report) {
  report.shape_before = of.shape;
  report.scaled_jacobian_before = of.scaled_jacobian;
  report.volume_before = of.volume;
}
/// As measured_after() reads it.
void set_after(const Measured& of, Report& report) {
  report.shape_after = of.shape;
  report.scaled_jacobian_after = of.scaled_jacobian;
  report.volume_after = of.volume;
  report.off_cad = of.off_cad;
  report.extremes = of.extremes;
}

}  // namespace

Measured measured(const MeshedModel& meshed) {
  return measured(meshed, measure(meshed.mesh));
}

Measured measured_after(const Report& report) {
  return {report.shape_after, report.scaled_jacobian_after, report.volume_after, report.off_cad, report.extremes};
}

Index ChangedPart::whole_node_after(Index node) const {
  const Index n_part = before.mesh.n_nodes();
  if (!renamed_nodes) return node < n_part ? whole_node(node) : node - n_part + input.mesh.n_nodes();
  return node < n_part ? renamed_nodes->after(whole_node(node)) : renamed_nodes->come[node - n_part];
}

void find_moved(ChangedPart& change) {
  const Mesh& after = change.after.mesh;
  change.moved = moved_nodes(change.before.mesh, after);
  if (change.moved.empty()) return;
  std::vector<std::uint8_t> has_moved(after.points.size(), 0);
  for (const Index n : change.moved) has_moved[n] = 1;
  change.touched = touching_hexes(std::span(after.hexes).first(change.n_kept), has_moved);
}

MeshedModel in_former_order(const MeshedModel& before, const MeshedModel& after, std::span<const Index> old_node,
                            std::span<const Index> old_hex) {
  MeshedModel result;
  result.model = after.model;
  const auto places = [](std::span<const Index> old, Index n_before) {
    std::vector<Index> place(old.begin(), old.end());
    for (Index& p : place)
      if (p < 0) p = n_before++;
    return place;
  };
  const std::vector<Index> node = places(old_node, before.mesh.n_nodes());
  const auto put_nodes = [&](auto& to, const auto& was, const auto& from) {
    to = was;
    if (from.empty()) return;
    to.resize(std::max(to.size(), static_cast<std::size_t>(before.mesh.n_nodes()) +
                                      static_cast<std::size_t>(std::ranges::count(old_node, -1))));
    parallel_each(node.size(), [&](std::size_t n) { to[node[n]] = from[n]; });
  };
  put_nodes(result.mesh.points, before.mesh.points, after.mesh.points);
  put_nodes(result.association.node_owner, before.association.node_owner, after.association.node_owner);
  put_nodes(result.association.node_parameters, before.association.node_parameters, after.association.node_parameters);
  std::vector<Index> order = indices_where(after.mesh.n_hexes(), [&](Index h) { return old_hex[h] >= 0; });
  for (Index h = 0; h < after.mesh.n_hexes(); ++h)
    if (old_hex[h] < 0) order.push_back(h);
  std::vector<Index> hex(order.size());
  result.mesh.hexes.resize(order.size());
  parallel_each(order.size(), [&](std::size_t i) {
    hex[order[i]] = static_cast<Index>(i);
    result.mesh.hexes[i] = after.mesh.hexes[order[i]];
    for (Index& n : result.mesh.hexes[i]) n = node[n];
  });
  if (!after.association.hex_volume.empty())
    result.association.hex_volume = items_at(after.association.hex_volume, order);
  result.association.surface_faces = after.association.surface_faces;
  for (Side& side : result.association.surface_faces) side.hex = hex[side.hex];
  std::ranges::sort(result.association.surface_faces);
  return result;
}

bool verify_change(const ChangedPart& change, const Measured& known, Report& report) {
  if (!change.after.model || change.after.association.empty()) return false;  // the boundary is known from it
  if (is_broken(report)) return false;
  const Index n_new = change.after.mesh.n_hexes() - change.n_kept;
  const Difference difference(change);
  constexpr Index small_part = 8;
  if ((n_new + std::ssize(change.gone) + std::ssize(change.touched)) > difference.n_whole / small_part) return false;
  if (std::ranges::any_of(change.moved, [&](Index n) { return change.whole_node(n) == known.off_cad.node; }))
    return false;
  if (change.renamed_nodes && change.renamed_nodes->is_gone(known.off_cad.node)) return false;
  if (!is_sound(change)) return false;

  set_before(known, report);
  auto lists = std::make_shared<Extremes>(known.extremes ? *known.extremes : Extremes());
  report.shape_after = updated(known.shape, Metric::shape, difference, lists->shape);
  report.scaled_jacobian_after =
      updated(known.scaled_jacobian, Metric::scaled_jacobian, difference, lists->scaled_jacobian);
  report.extremes = std::move(lists);
  report.volume_after = report.volume_before;
  for (const double v : quality(Metric::volume, change.before.mesh, difference.taken)) report.volume_after -= v;
  for (const double v : quality(Metric::volume, change.after.mesh, difference.added)) report.volume_after += v;
  report.off_cad = off_after(known.off_cad, change);
  return true;
}

void verify_unchanged(const Measured& known, Report& report) {
  set_before(known, report);
  set_after(known, report);
}

void verify_all(const MeshedModel& refined, const Measured& before, Report& report) {
  set_before(before, report);
  bool all_valid = false;
  {
    const Measures of_hexes = measure(refined.mesh);
    all_valid = of_hexes.all_valid;
    set_after(measured(refined, of_hexes), report);
  }
  add_broken(refined.mesh, report);
  if (all_valid && has_only_warnings(refined.mesh, true)) return;
  for (Violation& violation : validate(refined.mesh))
    if (!is_warning(violation.kind)) report.violations.push_back(std::move(violation));
}

namespace {

bool verify_renumbered(const MeshedModel& input, const Measured& known, const MeshedModel& refined,
                       const OldPlaces& old, Report& report) {
  if (!refined.model || refined.association.empty()) return false;
  const auto changes = [](std::span<const Index> places, Index n_before) {
    Reindexing all;
    std::vector<std::uint8_t> stays(static_cast<std::size_t>(n_before), 0);
    for (std::size_t i = 0; i < places.size(); ++i)
      if (places[i] >= 0)
        stays[places[i]] = 1;
      else
        all.come.push_back(static_cast<Index>(i));
    all.gone = indices_where(n_before, [&](Index i) { return stays[i] == 0; });
    return all;
  };
  const Reindexing nodes = changes(old.node, input.mesh.n_nodes()), hexes = changes(old.hex, input.mesh.n_hexes());
  const MeshedModel after = in_former_order(input, refined, old.node, old.hex);
  std::vector<std::int64_t> ids;
  for (const Index h : hexes.come) ids.push_back(hex_id(refined.mesh, h));
  ChangedPart change{input, input, after};
  change.n_kept = after.mesh.n_hexes() - static_cast<Index>(hexes.come.size());
  change.gone = hexes.gone;
  find_moved(change);
  change.renamed_nodes = &nodes;
  change.renamed_hexes = &hexes;
  change.come_ids = ids;
  return verify_change(change, known, report);
}

}  // namespace

void verify(const MeshedModel& input, const Measured* known, const MeshedModel& refined, const OldPlaces* old,
            Report& report) {
  if (known && is_unchanged(input, refined)) return verify_unchanged(*known, report);
  if (known && !old && verify_change(find_change(input, refined), *known, report)) return;
  if (known && old && !old->node.empty() && verify_renumbered(input, *known, refined, *old, report)) return;
  verify_all(refined, known ? *known : measured_without_cad(input.mesh, measure(input.mesh)), report);
}

}  // namespace hextwist
