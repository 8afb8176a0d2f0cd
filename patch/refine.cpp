// The pipeline: targets, close, split, carry, place, repair, verify.
#include "hextwist/patch/refine.h"

#include "hextwist/base/memory.h"
#include "hextwist/patch/patch_refine.h"
#include "hextwist/patch/verify_internal.h"
#include "hextwist/sizing/pipeline.h"
#include "hextwist/sizing/targets.h"

namespace hextwist {
namespace {

/// The result of a patch put into a copy of the mesh.
RefineResult whole_result(PatchResult made, const MeshedModel& input, const Measured& known, const Request& request) {
  Report report = std::move(made.result.report);
  RefineResult result;
  if (!request.dry_run) {
    const Progress none;
    Stages stages(report, none);
    stages.begin("splice", 0.9);
    result.refined = spliced(input, *made.splice);
    result.lineage = whole_lineage(made, input);
    result.origin = whole_origin(made, input);
    stages.begin("verify", 0.9);
    if (!made.is_verified) verify_all(result.refined, known, report);
  }
  report.peak_memory_bytes = peak_memory();
  result.report = std::move(report);
  return result;
}

/// The passes over the whole mesh.
RefineResult refine_whole(const MeshedModel& input, const Measured* known, const Request& request,
                          const Progress& progress) {
  Report report;
  RefineResult result;
  {
    Pipeline run(input, request, report, progress);
    result = run_passes(run);
    if (!request.dry_run) verify(input, known, result.refined, report);
  }
  report.hexes_before = input.mesh.n_hexes();
  report.nodes_before = input.mesh.n_nodes();
  report.hexes_after = result.refined.mesh.n_hexes();
  report.nodes_after = result.refined.mesh.n_nodes();
  report.peak_memory_bytes = peak_memory();
  if (request.dry_run) {
    result = {};
    report.sizes.reset();
  }
  result.report = std::move(report);
  return result;
}

}  // namespace

RefineResult refine(const MeshedModel& input, const Request& request, const Progress& progress) {
  check(input, request);
  return refine_whole(input, nullptr, request, progress);
}

RefineResult refine(const MeshedModel& input, const Measured& known, const Request& request, const Progress& progress) {
  return finish(try_patch(input, known, request, progress), input, known, request, progress);
}

std::optional<PatchResult> try_patch(const MeshedModel& input, const Measured& known, const Request& request,
                                     const Progress& progress, const RingsOf& rings_of) {
  check(input, request);
  return refine_patch(input, known, request, progress, rings_of);
}

RefineResult finish(std::optional<PatchResult> made, const MeshedModel& input, const Measured& known,
                    const Request& request, const Progress& progress) {
  return made ? whole_result(std::move(*made), input, known, request) : refine_whole(input, &known, request, progress);
}

}  // namespace hextwist
