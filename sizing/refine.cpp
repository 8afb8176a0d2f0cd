// The pipeline: targets, close, split, carry, place, repair, verify.
#include <sys/resource.h>

#include <algorithm>

#include "hextwist/refine/carry.h"
#include "hextwist/refine/marks.h"
#include "hextwist/refine/trisect.h"
#include "hextwist/refine/uniform.h"
#include "hextwist/sizing/request.h"
#include "hextwist/sizing/targets.h"

namespace hextwist {
namespace {

constexpr int max_numsplit = 8;

/// Times stages, passes them to the progress callback and stops the run when that says so.
class Stages {
 public:
  Stages(Report& report, const Progress& progress) : report_(report), progress_(progress) {}
  ~Stages() { close(); }

  void begin(const char* stage, double fraction) {
    close();
    stage_ = stage;
    since_ = Clock::now();
    if (progress_ && !progress_(stage, fraction)) throw Cancelled();
  }
  void close() {
    if (!stage_) return;
    const double seconds = std::chrono::duration<double>(Clock::now() - since_).count();
    const auto found = std::ranges::find(report_.seconds, stage_, &StageTime::stage);
    if (found == report_.seconds.end())
      report_.seconds.push_back({stage_, seconds});
    else
      found->seconds += seconds;  // passes of one request add up
    report_.total_seconds += seconds;
    stage_ = nullptr;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Report& report_;
  const Progress& progress_;
  const char* stage_ = nullptr;
  Clock::time_point since_;
};

std::size_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

/// Children of the target hexes: the targets of the next pass.
std::vector<Index> children_of(const Lineage& lineage, std::span<const Index> hexes) {
  std::vector<Index> result;
  for (std::size_t h = 0; h < lineage.parent.size(); ++h)
    if (std::ranges::binary_search(hexes, lineage.parent[h])) result.push_back(static_cast<Index>(h));
  return result;
}

void check(const MeshedModel& input, const Request& request) {
  if (input.mesh.hexes.empty()) throw Error("there is no mesh to refine");
  if (request.numsplit < 1) throw Error("numsplit must be at least 1");
  const int limit = is_whole_model(input, request) ? max_uniform_pieces - 1 : max_numsplit;
  if (request.numsplit > limit) throw Error("numsplit must be at most " + std::to_string(limit) + " here");
}

/// One pass over the whole pipeline but verifying.
RefineResult run_pass(const MeshedModel& input, std::shared_ptr<const SplitTable> table,
                      std::span<const std::uint16_t> codes, bool dry_run, Stages& stages, double fraction) {
  stages.begin("split", fraction);
  Split parts = split(input.mesh.hexes, input.mesh.n_nodes(), std::move(table), codes);
  stages.begin("carry", fraction);
  RefineResult result;
  Carried carried = carry(input.mesh, input.association, parts);
  result.refined = {std::move(carried.mesh), input.model, std::move(carried.association)};
  if (dry_run) {
    result.lineage = std::move(parts.lineage);
    return result;
  }
  stages.begin("place", fraction);
  if (input.model && !input.association.empty())
    place(input.mesh, input.association, parts, *input.model, result.refined.mesh, result.refined.association);
  stages.begin("improve", fraction);
  result.report.off_nodes =
      repair_children(input.mesh, parts, input.model.get(), result.refined.mesh, result.refined.association);
  result.lineage = std::move(parts.lineage);
  return result;
}

void verify(const MeshedModel& input, MeshedModel& refined, Report& report) {
  const auto summary = [](Metric metric, const Mesh& mesh) { return summarize(quality(metric, mesh)); };
  report.shape_before = summary(Metric::shape, input.mesh);
  report.shape_after = summary(Metric::shape, refined.mesh);
  report.scaled_jacobian_before = summary(Metric::scaled_jacobian, input.mesh);
  report.scaled_jacobian_after = summary(Metric::scaled_jacobian, refined.mesh);
  report.volume_before = volume(input.mesh);
  report.volume_after = volume(refined.mesh);
  if (refined.model && !refined.association.empty())
    report.off_cad = off_model(refined.mesh, refined.association, *refined.model);
  for (Violation& violation : validate(refined.mesh))
    if (!is_warning(violation.kind)) report.violations.push_back(std::move(violation));
}

}  // namespace

const char* name(TargetKind kind) {
  constexpr const char* names[] = {"node", "edge", "face", "hex", "vertex", "curve", "surface", "volume"};
  return names[static_cast<int>(kind)];
}

RefineResult refine(const MeshedModel& input, const Request& request, const Progress& progress) {
  check(input, request);
  RefineResult result;
  Report report;
  report.hexes_before = input.mesh.n_hexes();
  report.nodes_before = input.mesh.n_nodes();
  {
    Stages stages(report, progress);
    stages.begin("targets", 0);
    std::vector<Index> targets = target_hexes(input, request);
    const bool uniform = is_whole_model(input, request);
    if (uniform)
      report.notices.push_back("all volumes: uniform, every edge in " + std::to_string(request.numsplit + 1));
    const int n_passes = uniform ? 1 : request.numsplit;
    const MeshedModel* current = &input;
    MeshedModel previous;
    for (int pass = 0; pass < n_passes; ++pass) {
      const double fraction = static_cast<double>(pass) / n_passes;
      stages.begin("close", fraction);
      std::vector<std::uint16_t> codes;
      if (uniform) {
        codes.assign(current->mesh.hexes.size(), 1);
      } else {
        std::vector<std::uint8_t> marked(current->mesh.points.size(), 0);
        mark_nodes(current->mesh.hexes, targets, marked);
        if (request.concave == Concave::fill) report.filled_hexes += fill_concave(current->mesh, marked);
        codes = trisect_codes(current->mesh.hexes, marked);
      }
      RefineResult next = run_pass(*current, uniform ? uniform_table(request.numsplit + 1) : trisect_table(), codes,
                                   request.dry_run, stages, fraction);
      std::ranges::move(next.report.off_nodes, std::back_inserter(report.off_nodes));
      if (pass + 1 < n_passes) {
        targets = children_of(next.lineage, targets);
        previous = std::move(next.refined);
        current = &previous;
      } else {
        result = std::move(next);
      }
    }
    if (!request.dry_run) {
      stages.begin("verify", 0.9);
      verify(input, result.refined, report);
    }
  }
  report.hexes_after = result.refined.mesh.n_hexes();
  report.nodes_after = result.refined.mesh.n_nodes();
  report.peak_memory_bytes = peak_memory();
  if (request.dry_run) result = {};
  result.report = std::move(report);
  return result;
}

}  // namespace hextwist
