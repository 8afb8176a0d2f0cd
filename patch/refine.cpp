#include "hextwist/patch/refine_known.h"

#include <algorithm>

#include "hextwist/base/memory.h"
#include "hextwist/mesh/association/meant.h"
#include "hextwist/mesh/others.h"
#include "hextwist/patch/patch_refine.h"
#include "hextwist/sizing/levelling.h"

namespace hextwist {

RefineResult refine_whole(const MeshedModel& input, const Measured* known, const Request& request,
                          const Progress& progress) {
  Report report;
  if (known) report.scaled_jacobian_before = known->scaled_jacobian;
  RefineResult result;
  const Approach approach = plan(input, request).approach;
  {
    // Where sizes or distances are measured between passes, only the whole run tells what comes of it.
    Request done = request;
    done.finish.dry_run = request.finish.dry_run && !is_by_places(request);
    done.finish.fixed = with_nodes_of_others(input.mesh, std::move(done.finish.fixed));
    State state(input, done, report, progress);
    result = state.keep_if_met() ? state.take_result() : run_passes(state, approach);
    if (!done.finish.dry_run) {
      std::vector<Index> old_hex;
      OldPlaces old{result.old_node, {}};
      if (state.is_renumbered && !result.old_node.empty()) {
        const LevelOrigin& from = result.came_from;
        old_hex.resize(from.kind.size(), -1);
        for (std::size_t h = 0; h < old_hex.size(); ++h)
          if (from.kind[h] == HexOrigin::same) old_hex[h] = from.at[h];
        old.hex = old_hex;
      }
      verify(input, known, result.refined, state.is_renumbered ? &old : nullptr, report);
    }
  }
  report.hexes_before = input.mesh.n_hexes();
  report.nodes_before = input.mesh.n_nodes();
  report.hexes_after = result.refined.mesh.n_hexes();
  report.nodes_after = result.refined.mesh.n_nodes();
  report.peak_memory_bytes = peak_memory();
  if (request.finish.dry_run) {
    if (report.violations.empty()) result = {};
    report.sizes.reset();
  }
  result.levelling = levelling_after(request, result, result.refined);
  result.report = std::move(report);
  return result;
}

RefineResult refine(const MeshedModel& input, const Request& request, const Progress& progress) {
  const auto& sets = input.mesh.node_sets;
  if (input.association.empty() || std::ranges::all_of(sets, [](const NodeSet& set) { return !set.meant.empty(); }))
    return refine_whole(input, nullptr, request, progress);
  // A session has seen to that when it took the mesh.
  MeshedModel known = input;
  std::vector<std::string> notices;
  find_meant_entities(known.mesh, known.association, notices);
  RefineResult result = refine_whole(known, nullptr, request, progress);
  result.report.notices.insert(result.report.notices.begin(), notices.begin(), notices.end());
  return result;
}

RefineResult refine(const MeshedModel& input, const Measured& known, const Request& request, const Progress& progress) {
  std::optional<PatchResult> patch = refine_patch(input, known, request, progress);
  return patch ? whole_result(std::move(*patch), input, known, request)
               : refine_whole(input, &known, request, progress);
}

}  // namespace hextwist
