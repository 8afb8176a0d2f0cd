#include "hextwist/patch/verify.h"

#include <algorithm>
#include <cstring>
#include <ranges>

#include "hextwist/base/parallel.h"
#include "hextwist/base/same_bits.h"
#include "hextwist/base/sorted.h"
#include "hextwist/base/text.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/mesh/quality/measure.h"
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

}  // namespace

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

Measured measured(const MeshedModel& meshed) {
  return measured(meshed, measure(meshed.mesh));
}

Measured measured_after(const Report& report) {
  return {report.shape_after, report.scaled_jacobian_after, report.volume_after, report.off_cad, report.extremes};
}

std::vector<Index> ChangedPart::whole_gone() const {
  std::vector<Index> whole;
  for (const Index h : gone) whole.push_back(whole_hex(h));
  return whole;
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
