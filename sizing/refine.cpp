// The pipeline: targets, close, split, carry, place, repair, verify.
#include <sys/resource.h>

#include <algorithm>

#include "hextwist/mesh/smooth.h"
#include "hextwist/refine/carry.h"
#include "hextwist/refine/enclose.h"
#include "hextwist/refine/marks.h"
#include "hextwist/refine/trisect.h"
#include "hextwist/refine/uniform.h"
#include "hextwist/sizing/request.h"
#include "hextwist/sizing/targets.h"

namespace hextwist {
namespace {

constexpr int max_numsplit = 8;
constexpr int smooth_layers = 2;  // around the new hexes

/// Times stages, passes them to the progress callback and stops the run when that says so.
class Stages {
 public:
  Stages(Report& report, const Progress& progress) : report_(report), progress_(progress) {}
  ~Stages() { close(); }

  void begin(const char* stage, double fraction) {
    close();
    stage_ = stage;
    since_ = Clock::now();
    if (!report(stage, fraction)) throw Cancelled();
  }
  /// False: the run should stop. (Within a stage; begin() throws.)
  bool report(const char* stage, double fraction) const { return !progress_ || progress_(stage, fraction); }
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

/// The technique, with automatic decided. Throws Error for one that does not fit the target.
Method technique(const Request& request) {
  const bool solid = is_solid(request.kind);
  if (request.depth && *request.depth < 0) throw Error("depth must not be negative");
  const bool has_depth = request.depth.value_or(solid ? 0 : 1) > 0;
  switch (request.method) {
    case Method::single:
      if (!solid && !has_depth) throw Error("the single sheet technique refines whole hexes: it needs depth 1 or more");
      return Method::single;
    case Method::combination:
      if (solid)
        throw Error(std::string("the combination technique refines around nodes, edges and faces, not a ") +
                    name(request.kind));
      if (request.depth && has_depth) throw Error("the combination technique has depth 0");
      return Method::combination;
    case Method::parallel:
      if (solid) throw Error("one-into-eight refinement of hexes and volumes is not available yet");
      if (request.depth && has_depth) throw Error("parallel refinement around a target has depth 0");
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

/// The mesh on its way through the passes of a request.
class Run {
 public:
  Run(const MeshedModel& input, const Request& request, Report& report, const Progress& progress)
      : input_(input), current_(&input), request_(request), report_(report), stages_(report, progress) {}

  RefineResult all_passes() {
    stages_.begin("targets", 0);
    const Method method = technique(request_);
    if (is_whole_model(input_, request_) && method == Method::single) {
      const int pieces = request_.numsplit + 1;
      report_.notices.push_back("all volumes: uniform, every edge in " + std::to_string(pieces) + " equal pieces");
      pass(uniform_table(pieces), std::vector<std::uint16_t>(input_.mesh.hexes.size(), 1));
    } else if (method == Method::single) {
      trisect_passes();
    } else {
      sub_element_passes(method);
    }
    if (request_.smooth && !request_.dry_run) smooth_band();
    stages_.begin("verify", 0.9);
    return std::move(result_);
  }

 private:
  void trisect_passes() {
    std::vector<Index> targets;
    if (is_solid(request_.kind)) {
      targets = with_layers(input_.mesh, solid_target(input_, request_), request_.depth.value_or(0));
    } else {
      const CombinationTarget target = sub_element_target(input_, request_, report_.notices);
      targets = layers_around(input_.mesh, target.nodes, request_.depth.value_or(1));
    }
    for (int i = 0; i < request_.numsplit; ++i) {
      stages_.begin("close", fraction());
      const Mesh& mesh = current_->mesh;
      std::vector<std::uint8_t> marked(mesh.points.size(), 0);
      mark_nodes(mesh.hexes, targets, marked);
      if (request_.concave == Concave::fill) report_.filled_hexes += fill_concave(mesh, marked);
      pass(trisect_table(), trisect_codes(mesh.hexes, marked));
      targets = children_of(result_.lineage, targets);
    }
  }

  void sub_element_passes(Method method) {
    CombinationTarget target = sub_element_target(input_, request_, report_.notices);
    const EncloseAt at = method == Method::parallel ? EncloseAt::half : EncloseAt::third;
    for (int i = 0; i < request_.numsplit; ++i) {
      stages_.begin("close", fraction());
      std::vector<std::uint8_t> marked(current_->mesh.points.size(), 0);
      for (const Index n : target.nodes) marked[n] = 1;
      const Index n_added = close_enclosure(current_->mesh.hexes, marked);
      if (n_added > 0)
        report_.notices.push_back("enclosed " + std::to_string(n_added) +
                                  " nodes more than the target has, for want of a template");
      pass(enclose_table(at), enclose_codes(current_->mesh.hexes, marked));
      target = carried_target(target, result_.lineage, current_->mesh);
      if (method == Method::parallel || (target.edges.empty() && target.faces.empty())) continue;
      stages_.begin("close", fraction());
      pass(trisect_table(), combination_codes(current_->mesh, target));
      target = carried_target(target, result_.lineage, current_->mesh);
    }
  }

  /// Smooths the new hexes and a few layers around them.
  void smooth_band() {
    stages_.begin("smooth", fraction());
    Mesh& mesh = result_.refined.mesh;
    // Hexes that were there before have their old ids and come first.
    const std::int64_t last_old = hex_id(input_.mesh, input_.mesh.n_hexes() - 1);
    std::vector<Index> fresh;
    for (Index h = mesh.n_hexes() - 1; h >= 0 && hex_id(mesh, h) > last_old; --h) fresh.push_back(h);
    SmoothOptions options;
    options.nodes = nodes_inside(mesh, hex_band(mesh, fresh, smooth_layers));
    const SmoothReport smoothed = smooth(mesh, result_.refined.association, input_.model.get(), options,
                                         [&](const char* stage, double) { return stages_.report(stage, 0.9); });
    if (smoothed.stopped) throw Cancelled();
    report_.notices.push_back("smoothed " + std::to_string(smoothed.n_nodes) + " nodes in " +
                              std::to_string(smoothed.sweeps) + " sweeps");
  }

  /// One pass over the pipeline from split to improve; the result becomes the current mesh.
  void pass(std::shared_ptr<const SplitTable> table, std::span<const std::uint16_t> codes) {
    ++n_passes_;
    const MeshedModel& from = *current_;
    stages_.begin("split", fraction());
    Split parts = split(from.mesh.hexes, from.mesh.n_nodes(), std::move(table), codes);
    stages_.begin("carry", fraction());
    Carried carried = carry(from.mesh, from.association, parts);
    MeshedModel next{std::move(carried.mesh), from.model, std::move(carried.association)};
    if (!request_.dry_run) {
      stages_.begin("place", fraction());
      if (next.model && !next.association.empty())
        place(from.mesh, from.association, parts, *next.model, next.mesh, next.association);
      stages_.begin("improve", fraction());
      std::ranges::move(repair_children(from.mesh, parts, next.model.get(), next.mesh, next.association),
                        std::back_inserter(report_.off_nodes));
    }
    result_.lineage = std::move(parts.lineage);
    result_.refined = std::move(next);
    current_ = &result_.refined;
  }

  double fraction() const { return 0.9 * n_passes_ / (n_passes_ + 1); }

  const MeshedModel& input_;
  const MeshedModel* current_;
  const Request& request_;
  Report& report_;
  Stages stages_;
  RefineResult result_;
  int n_passes_ = 0;
};

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

const char* name(Method method) {
  constexpr const char* names[] = {"auto", "single", "parallel", "combination"};
  return names[static_cast<int>(method)];
}

RefineResult refine(const MeshedModel& input, const Request& request, const Progress& progress) {
  check(input, request);
  Report report;
  report.hexes_before = input.mesh.n_hexes();
  report.nodes_before = input.mesh.n_nodes();
  RefineResult result;
  {
    Run run(input, request, report, progress);
    result = run.all_passes();
    if (!request.dry_run) verify(input, result.refined, report);
  }
  report.hexes_after = result.refined.mesh.n_hexes();
  report.nodes_after = result.refined.mesh.n_nodes();
  report.peak_memory_bytes = peak_memory();
  if (request.dry_run) result = {};
  result.report = std::move(report);
  return result;
}

}  // namespace hextwist
