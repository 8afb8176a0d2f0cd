#include "hextwist/patch/patch_refine.h"

#include <algorithm>
#include <cstring>

#include "hextwist/base/memory.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/mesh/topology.h"
#include "hextwist/patch/size_patch_internal.h"
#include "hextwist/patch/verify_internal.h"
#include "hextwist/refine/levels/transfer.h"
#include "hextwist/sizing/levelling.h"
#include "hextwist/sizing/stages.h"
#include "hextwist/sizing/targets.h"

namespace hextwist {
namespace {

/// The target in the whole mesh: what the patch grows around.
struct Around {
  std::vector<Index> nodes;  ///< ascending
  std::vector<Index> hexes;  ///< of a solid target
  CombinationTarget target;  ///< of any other
};

Around around_target(const MeshedModel& input, const Target& target) {
  Around around;
  if (is_solid(target.kind)) {
    around.hexes = solid_target(input, target);
    around.nodes = nodes_of_hexes(input.mesh, around.hexes);
  } else {
    std::vector<std::string> told_again;  // by the passes in the patch
    around.target = sub_element_target(input, target, told_again);
    around.nodes = around.target.nodes;
  }
  return around;
}

bool verify_patch(const MeshedModel& input, const Measured& known, const PatchResult& made, const PatchNumbers& numbers,
                  Report& report) {
  const Mesh& after = made.result.refined.mesh;
  ChangedPart change{input, made.patch.meshed, made.result.refined};
  change.nodes = made.patch.nodes;
  change.hexes = made.patch.hexes;
  change.n_kept = after.n_hexes() - static_cast<Index>(numbers.come.size());
  change.gone = numbers.local_gone;
  find_moved(change);
  return verify_change(change, known, report);
}

/// Arrays as long as they should be: what a session holds, but perhaps not a caller.
bool is_complete(const MeshedModel& input, const Request& request) {
  const Mesh& mesh = input.mesh;
  const Association& association = input.association;
  return (association.empty() || (association.node_owner.size() == mesh.points.size() &&
                                  association.node_parameters.size() == mesh.points.size() &&
                                  association.hex_volume.size() == mesh.hexes.size())) &&
         std::ranges::all_of(request.finish.fixed, [&](Index n) { return n >= 0 && n < mesh.n_nodes(); });
}

}  // namespace

PatchResult nothing_done(const MeshedModel& input, const Measured& known, const Request& request, Report report) {
  PatchResult made;
  made.patch = make_patch(input, {});
  made.result.refined = made.patch.meshed;
  made.result.levelling = request.levelling;
  const PatchNumbers numbers(made.patch, input, made.result.refined.mesh);
  made.splice = std::make_unique<const Splice>(input, numbers, made.result.refined);
  verify_unchanged(known, report);
  report.hexes_before = report.hexes_after = input.mesh.n_hexes();
  report.nodes_before = report.nodes_after = input.mesh.n_nodes();
  report.peak_memory_bytes = peak_memory();
  made.is_verified = true;
  made.result.report = std::move(report);
  return made;
}

void name_as_whole(Report& report, const PatchNumbers& numbers) {
  for (OffOwner& row : report.off_nodes) row.node = numbers.node[row.node];
  for (std::vector<Index>* list : {&report.flat_hexes, &report.poor.worst})
    for (Index& h : *list) h = numbers.hex[h];
}

void finish_patch(PatchResult& made, const MeshedModel& input, const Measured& known, const Request& request,
                  const PatchNumbers& numbers, Report& report) {
  name_as_whole(report, numbers);
  for (Index& node : made.result.smoothed) node = numbers.node[node];
  if (!request.finish.dry_run) made.is_verified = verify_patch(input, known, made, numbers, report);
  made.splice = std::make_unique<const Splice>(input, numbers, made.result.refined);
  made.come = numbers.come;
}

void count_patch(const PatchResult& made, const MeshedModel& input, Report& report) {
  report.hexes_before = input.mesh.n_hexes();
  report.nodes_before = input.mesh.n_nodes();
  report.hexes_after = made.splice->n_hexes(true);
  report.nodes_after = made.splice->n_nodes(true);
  if (report.hexes_after > report.hexes_before) check_hexes(static_cast<double>(report.hexes_after));
  report.peak_memory_bytes = peak_memory();
}

Request request_in_part(const Request& request, const Mesh& part, std::span<const Index> nodes,
                        std::span<const Index> hexes, std::span<const Edge> target_edges,
                        std::span<const Quad> target_faces) {
  Request local = request;
  local.levelling = nullptr;
  const auto node = [&](Index n) { return position_in(nodes, n); };
  local.finish.fixed.clear();
  for (const Index n : request.finish.fixed)
    if (const Index there = node(n); there >= 0) local.finish.fixed.push_back(there);
  const auto renumber = [&](const auto& items, const auto& number) {
    local.target.ids.clear();
    for (const auto& item : items)
      if (const Index there = number(item); there >= 0) local.target.ids.push_back(there);
    std::ranges::sort(local.target.ids);
  };
  if (request.target.kind == EntityKind::node) renumber(request.target.ids, node);
  if (request.target.kind == EntityKind::hex)
    renumber(request.target.ids, [&](Index h) { return position_in(hexes, h); });
  if (request.target.kind == EntityKind::edge) {
    const Edges all = edges(part);
    renumber(target_edges, [&](const Edge& e) { return find_edge(all, node(e[0]), node(e[1])); });
  }
  if (request.target.kind == EntityKind::face) {
    const Faces all = faces(part);
    renumber(target_faces, [&](const Quad& q) {
      return find_face(all, {node(q[0]), node(q[1]), node(q[2]), node(q[3])});
    });
  }
  return local;
}

bool is_by_places(const Request& request) {
  return std::holds_alternative<Sizes>(request.how) || request.target.radius;
}

std::optional<PatchResult> refine_patch(const MeshedModel& input, const Measured& known, const Request& request,
                                        const Progress& progress, const RingsOf& rings_of) {
  const Mesh& mesh = input.mesh;
  if (request.finish.dry_run && is_by_places(request)) return std::nullopt;
  const Plan plan = hextwist::plan(input, request);
  if (mesh.n_hexes() < patch_rule.least_mesh || !is_complete(input, request)) return std::nullopt;
  const Mesh* const base = request.levelling ? &request.levelling->forest.base->mesh : nullptr;
  if (results_take_all(mesh, base, request.finish.extensive)) return std::nullopt;
  if (std::holds_alternative<Sizes>(request.how))
    return refine_sizes_patch(input, known, request, plan.approach, progress, rings_of);
  if (is_by_levels(request, plan)) return refine_levels_patch(input, known, request, progress, rings_of);
  if (!plan.reach) return std::nullopt;
  const std::size_t limit = mesh.hexes.size() / static_cast<std::size_t>(patch_rule.part);
  Request asked = request;
  Report before;
  before.scaled_jacobian_before = known.scaled_jacobian;
  if (request.target.radius) {  // chooses hexes by where they are, so it must see all of them
    asked.target = {EntityKind::hex, region_target(input, request.target, before.notices)};
    asked.method = Method::single;
  }
  const Around around = around_target(input, asked.target);
  if (around.hexes.size() > limit || around.nodes.size() > 8 * limit) return std::nullopt;
  int n_rings = *plan.reach + enough_rings;
  constexpr int max_rings = 100;
  for (; n_rings <= max_rings; n_rings *= 2) {
    Report report = before;
    Stages stages(report, progress);
    stages.begin("patch", 0);
    std::optional<Rings> rings = rings_of(mesh, around.nodes, around.hexes, n_rings, limit);
    if (!rings || touch_others(mesh, rings->hexes)) return std::nullopt;
    PatchResult made;
    made.patch = make_patch(input, std::move(rings->hexes));
    const Request local = request_in_part(asked, made.patch.meshed.mesh, made.patch.nodes, made.patch.hexes,
                                          around.target.edges, around.target.faces);
    stages.close();
    {
      State run(made.patch.meshed, local, report, progress);
      made.result = run_passes(run, plan.approach);
      made.result.levelling = nullptr;  // of the patch
      made.result.came_from = {};
      made.result.old_node = {};
      const PatchNumbers numbers(made.patch, input, made.result.refined.mesh);
      const bool is_enough = rings->is_all || std::ranges::all_of(numbers.local_gone, [&](Index h) {
                               return rings->ring[h] + enough_rings <= n_rings;
                             });
      if (!is_enough) continue;
      finish_patch(made, input, known, request, numbers, report);
    }
    count_patch(made, input, report);
    made.result.report = std::move(report);
    return made;
  }
  return std::nullopt;
}

std::vector<Index> whole_origin(const PatchResult& result, const MeshedModel& input) {
  const Reindexing& hexes = result.splice->hexes();
  std::vector<Index> origin = hexes.old_places(input.mesh.n_hexes());
  for (std::size_t i = 0; i < hexes.come.size(); ++i)
    origin[hexes.come[i]] = result.patch.hexes[result.result.origin[result.come[i]]];
  return origin;
}

LevelOrigin whole_came_from(const PatchResult& result, const MeshedModel& input) {
  const Reindexing& hexes = result.splice->hexes();
  const LevelOrigin& local = result.result.came_from;
  LevelOrigin origin;
  origin.at = hexes.old_places(input.mesh.n_hexes());
  origin.kind.assign(origin.at.size(), HexOrigin::same);
  origin.several = local.kind.empty() ? CompressedRows{{0}, {}} : local.several;
  for (Index& h : origin.several.items) h = result.patch.hexes[h];
  for (std::size_t i = 0; i < hexes.come.size(); ++i) {
    const Index h = result.come[i];
    HexOrigin& kind = origin.kind[hexes.come[i]];
    kind = local.kind.empty() ? HexOrigin::finer : local.kind[h];
    origin.at[hexes.come[i]] = kind == HexOrigin::coarser ? local.at[h] : result.patch.hexes[result.result.origin[h]];
  }
  return origin;
}

RefineResult whole_result(PatchResult made, const MeshedModel& input, const Measured& known, const Request& request) {
  Report report = std::move(made.result.report);
  RefineResult result;
  if (!request.finish.dry_run) {
    const Progress none;
    Stages stages(report, none);
    stages.begin("splice", 0.9);
    result.refined = spliced(input, *made.splice);
    result.origin = whole_origin(made, input);
    if (made.result.levelling) {
      result.levelling = made.result.levelling;
      result.came_from = whole_came_from(made, input);
      result.old_node = made.splice->nodes().old_places(input.mesh.n_nodes());
    } else {
      result.smoothed = std::move(made.result.smoothed);
      result.levelling = planted(made, request, input);
      if (!result.smoothed.empty())
        result.levelling = levelling_after_move(result.levelling, result.smoothed, result.refined);
    }
    stages.begin("verify", 0.9);
    if (!made.is_verified) verify_all(result.refined, known, report);
  }
  report.peak_memory_bytes = peak_memory();
  result.report = std::move(report);
  return result;
}

}  // namespace hextwist
