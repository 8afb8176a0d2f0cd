// The pipeline: targets, close, split, carry, place, repair, verify.
#include <sys/resource.h>

#include "hextwist/refine/uniform.h"
#include "hextwist/sizing/pipeline_internal.h"
#include "hextwist/sizing/targets.h"
#include "hextwist/sizing/verify.h"

namespace hextwist {
namespace {

constexpr int max_numsplit = 8;

std::size_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

/// The technique, with automatic decided. Throws Error for one that does not fit the target.
Method technique(const Request& request) {
  const bool solid = is_solid(request.kind);
  if (request.depth && *request.depth < 0) throw Error("depth must not be negative");
  const bool has_depth = request.depth.value_or(0) > 0;
  switch (request.method) {
    case Method::single:
      if (!solid && request.depth && !has_depth)
        throw Error("the single sheet technique refines whole hexes: it needs depth 1 or more");
      return Method::single;
    case Method::combination:
      if (solid)
        throw Error(std::string("the combination technique refines around nodes, edges and faces, not a ") +
                    name(request.kind));
      if (request.depth && has_depth) throw Error("the combination technique has depth 0");
      return Method::combination;
    case Method::parallel:
      return Method::parallel;
    case Method::automatic:
      break;
  }
  return solid || has_depth ? Method::single : Method::combination;
}

void check(const MeshedModel& input, const Request& request) {
  if (input.mesh.hexes.empty()) throw Error("there is no mesh to refine");
  check_targets(input, request);
  if (request.numsplit < 1) throw Error("numsplit must be at least 1");
  const int limit = is_whole_model(input, request) ? max_uniform_pieces - 1 : max_numsplit;
  if (request.numsplit > limit) throw Error("numsplit must be at most " + std::to_string(limit) + " here");
}

/// Everything but the last check.
RefineResult run_passes(Pipeline& run) {
  run.stages().begin("targets", 0);
  const Request& request = run.request();
  const Method method = technique(request);
  if (is_whole_model(run.input(), request) && method == Method::single) {
    const int pieces = request.numsplit + 1;
    run.report().notices.push_back("all volumes: uniform, every edge in " + std::to_string(pieces) + " equal pieces");
    run.pass(uniform_table(pieces), std::vector<std::uint16_t>(run.input().mesh.hexes.size(), 1));
  } else if (method == Method::single) {
    trisect_passes(run);
  } else if (method == Method::parallel && (is_solid(request.kind) || request.depth.value_or(0) > 0)) {
    eight_passes(run);
  } else {
    sub_element_passes(run, method);
  }
  if (request.smooth && !request.dry_run) run.smooth_band();
  run.stages().begin("verify", 0.9);
  return run.take_result();
}

RefineResult run_request(const MeshedModel& input, const Measured* known, const Request& request,
                         const Progress& progress) {
  check(input, request);
  Report report;
  report.hexes_before = input.mesh.n_hexes();
  report.nodes_before = input.mesh.n_nodes();
  RefineResult result;
  {
    Pipeline run(input, request, report, progress);
    result = run_passes(run);
    if (!request.dry_run) verify(input, known, result.refined, report);
  }
  report.hexes_after = result.refined.mesh.n_hexes();
  report.nodes_after = result.refined.mesh.n_nodes();
  report.peak_memory_bytes = peak_memory();
  if (request.dry_run) result = {};
  result.report = std::move(report);
  return result;
}

}  // namespace

const char* name(TargetKind kind) {
  constexpr const char* names[] = {"node", "edge", "face", "hex", "vertex", "curve", "surface", "volume"};
  return names[static_cast<int>(kind)];
}

const char* name(Method method) {
  constexpr const char* names[] = {"auto", "single", "parallel", "combination"};
  return names[static_cast<int>(method)];
}

RefineResult refine(const MeshedModel& input, const Request& request, const Progress& progress) {
  return run_request(input, nullptr, request, progress);
}

RefineResult refine(const MeshedModel& input, const Measured& known, const Request& request, const Progress& progress) {
  return run_request(input, &known, request, progress);
}

}  // namespace hextwist
