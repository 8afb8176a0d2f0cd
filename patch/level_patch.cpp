// Levels in a patch: the base hexes around the cells whose marks change, with all that has become of them, are a small
// forest of their own.
//
// Why the result is that of the whole: a mesh by levels is a function of base and marks, whose passes look at the hexes
// of a cell and those around. Numbers ascend alike in patch and whole, since both hand out first the base, then what
// has been there, then what is new, level by level. The marks are made for the whole, so that gradation sees all; where
// nodes were repaired, which reaches far, the patch is given up.
#include <algorithm>

#include "hextwist/base/memory.h"
#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/mesh/others.h"
#include "hextwist/patch/adapt.h"
#include "hextwist/patch/forest_patch_internal.h"
#include "hextwist/patch/patch_refine.h"
#include "hextwist/patch/size_patch_internal.h"
#include "hextwist/patch/verify_internal.h"
#include "hextwist/refine/marks.h"
#include "hextwist/refine/templates/trisect.h"
#include "hextwist/sizing/levelling.h"
#include "hextwist/sizing/loop.h"

namespace hextwist {
namespace {

/// The hexes of the base that are cut afterwards.
std::vector<Index> cut_after(const HandedHexes& before, std::span<const Index> roots, const HandedHexes& local) {
  return union_of(difference(before.cut, roots), items_at(std::vector<Index>(roots.begin(), roots.end()), local.cut));
}

/// Faces inside the mesh are sides of the hex that comes first, which may be outside of the patch; in the base it
/// may have been another one than in the mesh. Nothing changes in the outermost ring, so what was said there stays.
void keep_border_faces(const MeshedModel& before, std::span<const std::uint8_t> is_border,
                       std::span<const Index> old_hex, Association& association) {
  std::vector<Index> now_of(before.mesh.hexes.size(), -1);
  for (std::size_t h = 0; h < old_hex.size(); ++h)
    if (old_hex[h] >= 0) now_of[old_hex[h]] = static_cast<Index>(h);
  std::vector<std::pair<Side, int>> faces;
  const auto add = [&](Side side, int surface) { faces.emplace_back(side, surface); };
  for (std::size_t i = 0; i < association.surface_faces.size(); ++i) {
    const Side side = association.surface_faces[i];
    if (old_hex[side.hex] < 0 || !is_border[old_hex[side.hex]]) add(side, association.face_surface[i]);
  }
  for (std::size_t i = 0; i < before.association.surface_faces.size(); ++i) {
    const Side side = before.association.surface_faces[i];
    if (is_border[side.hex] && now_of[side.hex] >= 0)
      add({now_of[side.hex], side.face}, before.association.face_surface[i]);
  }
  set_surface_faces(association, std::move(faces));
}

/// Nodes that stay are of what they were of. Where a hex of the outermost ring is on a surface by an edge alone, the
/// face that says so is outside, and the nodes of that edge are made as if they were inside their volume.
void keep_owners(const Association& before, std::span<const Index> old_node, Association& association) {
  if (before.node_owner.empty()) return;
  for (std::size_t n = 0; n < old_node.size(); ++n) {
    const Index old = old_node[n];
    if (old < 0 || association.node_owner[n] == before.node_owner[old]) continue;
    association.node_owner[n] = before.node_owner[old];
    association.node_parameters[n] = before.node_parameters[old];
  }
}

/// Nodes that stay are in the node sets that they were in. Where a hex of the outermost ring has an edge of a surface
/// alone, hexes outside say whether the set goes on along it.
void keep_members(const std::vector<NodeSet>& before, std::span<const Index> old_node, std::vector<NodeSet>& now) {
  std::vector<std::uint8_t> is_in;
  for (std::size_t s = 0; s < std::min(before.size(), now.size()); ++s) {
    is_in.assign(old_node.size(), 0);
    for (const Index n : now[s].nodes) is_in[n] = 1;
    for (std::size_t n = 0; n < old_node.size(); ++n)
      if (old_node[n] >= 0) is_in[n] = std::ranges::binary_search(before[s].nodes, old_node[n]);
    now[s].nodes = indices_where(static_cast<Index>(is_in.size()), [&](Index n) { return is_in[n] != 0; });
  }
}

PatchNumbers numbers_of(const ForestPatch& made, const MeshedModel& input, const RefineResult& result,
                        std::span<const Index> roots, const std::vector<Index>& cut, const Mesh& base, bool is_bare) {
  const HandedHexes& local = result.levelling->forest.grown->hexes;
  const Mesh& mesh = result.refined.mesh;
  std::vector<Index> old_hex(mesh.hexes.size(), -1), place(mesh.hexes.size(), -1);
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    if (result.came_from.kind[h] == HexOrigin::same)
      old_hex[h] = result.came_from.at[h];
    else if (h < local.n_whole())
      place[h] = after_gaps(cut, roots[before_gaps(local.cut, h)]);
  PatchNumbers numbers(made.patch, input, result.old_node, std::move(old_hex), place);
  for (const Index n : numbers.come_nodes) numbers.node_ids.push_back(node_id(mesh, n));
  for (const Index h : numbers.come) numbers.hex_ids.push_back(hex_id(mesh, h));
  // As for the whole: nodes have no ids where these would be their places.
  const Index n_after = numbers.nodes.n_after(input.mesh.n_nodes());
  const bool last_is_new = !numbers.nodes.come.empty() && numbers.nodes.come.back() == n_after - 1;
  const std::int64_t last_id =
      last_is_new ? numbers.node_ids.back() : node_id(input.mesh, numbers.nodes.before(n_after - 1));
  numbers.has_node_ids = !base.node_ids.empty() || (!is_bare && last_id != n_after);
  numbers.has_hex_ids = !is_bare || !base.hex_ids.empty();
  return numbers;
}

/// Whether nothing has changed where the patch ends.
bool is_wide_enough(const Rings& rings, const HandedHexes& hexes, const ForestPatch& made, const PatchNumbers& numbers,
                    const Mesh& refined) {
  if (rings.is_all) return true;
  const auto ring = [&](Index local_hex) {
    return rings.ring[position_in(rings.hexes, hexes.root(made.patch.hexes[local_hex]))];
  };
  for (const Index h : numbers.local_gone)
    if (ring(h) + enough_rings > rings.n_rings) return false;
  const Mesh& before = made.patch.meshed.mesh;
  std::vector<std::uint8_t> has_moved(before.points.size(), 0);
  for (std::size_t n = 0; n < numbers.old_node.size(); ++n)
    if (const Index old = numbers.old_node[n]; old >= 0 && before.points[old] != refined.points[n]) has_moved[old] = 1;
  for (Index h = 0; h < before.n_hexes(); ++h)
    if (std::ranges::any_of(before.hexes[h], [&](Index n) { return has_moved[n] != 0; }) && ring(h) == rings.n_rings)
      return false;
  return true;
}

/// Whether the field of levels, which is made anew, says of hexes that stay what it said before: it may be a field that
/// somebody else has called so.
bool keeps_levels(const Mesh& before, const Mesh& after, const PatchNumbers& numbers) {
  const Field *was = level_field(before), *is = level_field(after);
  if (!was || !is) return true;
  for (std::size_t h = 0; h < numbers.old_hex.size(); ++h)
    if (const Index old = numbers.old_hex[h]; old >= 0 && was->values[old] != is->values[h]) return false;
  return true;
}

bool verify_step(const MeshedModel& input, const Measured& known, const ForestPatch& made, const PatchNumbers& numbers,
                 const MeshedModel& refined, Report& report) {
  const MeshedModel after = in_former_order(made.patch.meshed, refined, numbers.old_node, numbers.old_hex);
  ChangedPart change{input, made.patch.meshed, after};
  change.nodes = made.patch.nodes;
  change.hexes = made.patch.hexes;
  change.n_kept = after.mesh.n_hexes() - static_cast<Index>(numbers.come.size());
  change.gone = numbers.local_gone;
  find_moved(change);
  change.renamed_nodes = &numbers.nodes;
  change.renamed_hexes = &numbers.hexes;
  change.come_ids = numbers.hex_ids;
  return verify_change(change, known, report);
}

/// Nodes moved in the whole after the step.
Overlay overlay_after_step(const Overlay& whole, const ForestPatch& made, const PatchNumbers& numbers,
                           const RefineResult& result) {
  struct Moved {
    Index node;
    Vec3 point;
    Parameters parameters;
  };
  std::vector<Moved> all;
  for (std::size_t i = 0; i < whole.nodes.size(); ++i)
    if (made.patch.local_node(whole.nodes[i]) < 0)
      all.push_back({numbers.nodes.after(whole.nodes[i]), whole.points[i],
                     whole.parameters.empty() ? Parameters{} : whole.parameters[i]});
  const MeshedModel& refined = result.refined;
  const bool on_cad = !refined.association.empty();
  for (const Index n : union_of(result.levelling->overlay.nodes, result.smoothed))
    all.push_back(
        {numbers.node[n], refined.mesh.points[n], on_cad ? refined.association.node_parameters[n] : Parameters{}});
  std::ranges::sort(all, {}, &Moved::node);
  Overlay overlay;
  for (const Moved& one : all) {
    overlay.nodes.push_back(one.node);
    overlay.points.push_back(one.point);
    if (on_cad) overlay.parameters.push_back(one.parameters);
  }
  return overlay;
}

HandedHexes hexes_after(const HandedHexes& before, std::vector<Index> cut, const ForestPatch& made,
                        const PatchNumbers& numbers, const HandedHexes& local) {
  HandedHexes after;
  after.n_base = before.n_base;
  after.cut = std::move(cut);
  after.cell.reserve(before.cell.size() + numbers.come.size());
  after.origin.reserve(after.cell.capacity());
  // Runs of pieces between those that are gone.
  std::size_t from = 0;
  const auto keep_until = [&](std::size_t end) {
    const auto at = [](auto& array, std::size_t i) { return array.begin() + static_cast<std::ptrdiff_t>(i); };
    after.cell.insert(after.cell.end(), at(before.cell, from), at(before.cell, end));
    after.origin.insert(after.origin.end(), at(before.origin, from), at(before.origin, end));
    from = end + 1;
  };
  for (const Index h : numbers.hexes.gone)
    if (h >= before.n_whole()) keep_until(static_cast<std::size_t>(h - before.n_whole()));
  keep_until(before.cell.size());
  for (const Index h : numbers.come) {
    if (h < local.n_whole()) continue;
    const auto piece = static_cast<std::size_t>(h - local.n_whole());
    after.cell.push_back(made.cells.whole({local.block(piece) - 1, local.cell[piece]}));
    after.origin.push_back(local.origin[piece]);
  }
  return after;
}

}  // namespace

bool is_by_levels(const Request& request, const Plan& plan) {
  if (!request.levelling || !is_regular(request)) return false;
  return plan.approach == Approach::levels || (plan.approach == Approach::trisect && has_levels(request));
}

LevellingPtr planted(const PatchResult& made, const Request& request, const MeshedModel& base) {
  const LevellingPtr after = levelling_after(request, {}, base);
  if (!after || after->forest.wished.size() != 1) return after;
  const Mesh& before = made.patch.meshed.mesh;
  auto grown = std::make_shared<GrownForest>();
  grown->marks = after->forest.wished;
  HandedHexes& hexes = grown->hexes;
  hexes.n_base = base.mesh.n_hexes();
  hexes.cut = made.splice->hexes().gone;
  std::vector<std::uint8_t> marked(before.points.size(), 0);
  for (const CellNumber cell : grown->marks[0].cell)
    for (const Index n : before.hexes[position_in(made.patch.hexes, static_cast<Index>(cell))]) marked[n] = 1;
  const std::vector<std::uint16_t> codes = trisect_codes(before.hexes, marked);
  Index parent = -1;
  std::uint32_t place = 0;  // children of a hex follow each other
  for (const Index h : made.come) {
    place = made.result.origin[h] == parent ? place + 1 : 0;
    parent = made.result.origin[h];
    hexes.cell.push_back(made.patch.hexes[parent]);
    hexes.origin.push_back(std::uint32_t{1} << 28 | std::uint32_t{codes[parent]} << 16 | place);
  }
  grown->next_node_id = node_id(base.mesh, base.mesh.n_nodes() - 1) + 1 + std::ssize(made.splice->nodes().come);
  grown->next_hex_id = highest_element_id(base.mesh) + 1 + std::ssize(made.come);
  Levelling result = *after;
  result.forest.grown = std::move(grown);
  return std::make_shared<const Levelling>(std::move(result));
}

namespace {

/// given: what is wished for, where that is not the request itself.
std::optional<PatchResult> levels_patch(const MeshedModel& input, const Measured& known, const Request& request,
                                        const WishedBySizes* given, const Progress& progress, const RingsOf& rings_of) {
  const LevellingPtr before = request.levelling ? request.levelling : levelling_of({std::shared_ptr<void>(), &input});
  const Levelling& asked = *before;
  const bool is_base = asked.forest.is_bare();
  if (!is_base && !asked.forest.grown) return std::nullopt;
  // Nodes of the base keep their numbers; other elements that are pieces have others, which a splice would change.
  if (input.mesh.others && input.mesh.others != asked.forest.base->mesh.others) return std::nullopt;
  if (request.finish.level_field && !level_field(input.mesh)) return std::nullopt;
  Levelling whole = asked;
  if (!whole.forest.grown) whole.forest = bare_forest(std::move(whole.forest));
  Forest& forest = whole.forest;
  const GrownForest& grown = *forest.grown;
  const Mesh& base = forest.base->mesh;
  const std::size_t limit = input.mesh.hexes.size() / static_cast<std::size_t>(patch_rule.part);

  Report report = given ? given->report : Report{};
  report.scaled_jacobian_before = known.scaled_jacobian;
  Stages stages(report, progress);
  stages.begin("patch", 0);
  Forest next = forest;
  next.wished = given ? given->wished : wishes_of(forest, input, request, report.notices);
  KnownLevels levels;
  LevelMarks marks = with_gradation(next);
  levels.is_bare = next.is_bare();
  if (!given || !given->is_gradation_told)
    for (std::size_t k = 0; k < next.wished.size(); ++k) levels.n_forced += n_forced(marks[k], next.wished[k]);
  const std::vector<Index> changed = changed_roots(grown.marks, marks);
  if (changed.size() > limit) return std::nullopt;
  if (changed.empty() && given) return std::nullopt;  // there are hexes that ask, and nothing is to be had
  if (changed.empty() && !request.finish.smooth) {
    // Other wishes at most, and the same mesh.
    tell_forced(levels.n_forced, report);
    verify_unchanged(known, report);
    PatchResult same;
    same.patch = make_patch(input, {});
    PatchNumbers none(same.patch, input, {}, {}, {});
    none.has_node_ids = !input.mesh.node_ids.empty();
    none.has_hex_ids = !input.mesh.hex_ids.empty();
    same.splice = std::make_unique<const Splice>(input, none, same.patch.meshed);
    same.is_verified = true;
    same.result.levelling = std::make_shared<const Levelling>(Levelling{next, whole.overlay});
    report.hexes_before = report.hexes_after = input.mesh.n_hexes();
    report.nodes_before = report.nodes_after = input.mesh.n_nodes();
    same.result.report = std::move(report);
    return same;
  }

  const std::vector<Index> nodes = nodes_of_hexes(base, changed);
  constexpr int n_rings = 1 + enough_rings;  // cells that share a node with changed ones change too
  std::optional<Rings> rings;
  if (is_base) {
    rings = rings_of(base, nodes, changed, n_rings, limit);
  } else {
    rings = rings_in_base(forest, nodes, n_rings, limit);
    next.base_corners = forest.base_corners;
  }
  if (!rings) return std::nullopt;
  std::vector<Index> hexes = hexes_in(grown.hexes, rings->hexes);
  if (hexes.size() > limit || touch_others(input.mesh, hexes)) return std::nullopt;
  ForestPatch part(input, whole, *rings, std::move(hexes));
  if (levels.is_bare && part.levelling.overlay.nodes.size() < whole.overlay.nodes.size()) return std::nullopt;
  levels.wished = part.cells.local(next.wished);
  levels.graded = part.with_border(marks);

  Request local{.levelling = std::make_shared<const Levelling>(std::move(part.levelling)), .finish = request.finish};
  local.finish.fixed.clear();
  for (const Index n : request.finish.fixed)
    if (const Index there = part.patch.local_node(n); there >= 0) local.finish.fixed.push_back(there);
  stages.close();

  PatchResult made;
  {
    State run(part.patch.meshed, local, report, progress);
    std::optional<SizesInPart> sizes;
    if (given) run.part = &sizes.emplace(given->sizes, part.patch.nodes, part.patch.hexes);
    run_levels(run, levels);
    made.result = finish_passes(run);
    RefineResult& result = made.result;
    std::vector<Index> cut = cut_after(grown.hexes, rings->hexes, result.levelling->forest.grown->hexes);
    const PatchNumbers numbers = numbers_of(part, input, result, rings->hexes, cut, base, levels.is_bare);
    if (!rings->is_all) {
      std::vector<std::uint8_t> is_border;
      for (const Index h : part.patch.hexes)
        is_border.push_back(rings->ring[position_in(rings->hexes, grown.hexes.root(h))] == n_rings);
      keep_border_faces(part.patch.meshed, is_border, numbers.old_hex, result.refined.association);
      keep_owners(part.patch.meshed.association, numbers.old_node, result.refined.association);
      keep_members(part.patch.meshed.mesh.node_sets, numbers.old_node, result.refined.mesh.node_sets);
    }
    if (levels.is_repaired || !is_wide_enough(*rings, grown.hexes, part, numbers, result.refined.mesh) ||
        !keeps_levels(part.patch.meshed.mesh, result.refined.mesh, numbers))
      return std::nullopt;
    name_as_whole(report, numbers);
    if (given) {
      report.sizes = whole_sizes(*report.sizes, sizes->outside, numbers);
      report.sizes->n_passes = static_cast<int>(next.wished.size());
      // What asks and is not near what changes: it can't be had.
      std::vector<Index>& unmet = report.sizes->unmet;
      for (const Index h : difference(given->sizes.too_large, part.patch.hexes))
        unmet.push_back(numbers.hexes.after(h));
      sort_unique(unmet);
    }
    const Index n_whole_after = grown.hexes.n_base - static_cast<Index>(cut.size());
    if (!request.finish.dry_run) {
      made.is_verified = verify_step(input, known, part, numbers, result.refined, report);
      auto after = std::make_shared<GrownForest>();
      const GrownForest& of_part = *result.levelling->forest.grown;
      after->marks = std::move(marks);
      after->hexes = hexes_after(grown.hexes, std::move(cut), part, numbers, of_part.hexes);
      after->next_node_id = std::max(grown.next_node_id, of_part.next_node_id);
      after->next_hex_id = std::max(grown.next_hex_id, of_part.next_hex_id);
      next.grown = std::move(after);
      result.levelling =
          std::make_shared<const Levelling>(Levelling{next, overlay_after_step(whole.overlay, part, numbers, result)});
      result.smoothed.clear();
    }
    made.splice = std::make_unique<const Splice>(input, numbers, result.refined,
                                                 Splice::RenamedFrom{grown.hexes.n_whole(), n_whole_after});
    made.come = numbers.come;
  }
  count_patch(made, input, report);
  if (!request.levelling) made.result.levelling = nullptr;  // nobody asked for more than the mesh
  made.result.report = std::move(report);
  made.patch = std::move(part.patch);
  return made;
}

}  // namespace

std::optional<PatchResult> refine_levels_patch(const MeshedModel& input, const Measured& known, const Request& request,
                                               const Progress& progress, const RingsOf& rings_of) {
  return levels_patch(input, known, request, nullptr, progress, rings_of);
}

std::optional<PatchResult> refine_wished_levels(const MeshedModel& input, const Measured& known, const Request& request,
                                                const WishedBySizes& wished, const Progress& progress,
                                                const RingsOf& rings_of) {
  return levels_patch(input, known, request, &wished, progress, rings_of);
}

}  // namespace hextwist
