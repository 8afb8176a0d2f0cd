// One into eight: parallel hex sheet operations on whole hexes and layers of them, and what is decided for each region.
#include <algorithm>

#include "hextwist/refine/marks.h"
#include "hextwist/refine/plans/eight.h"
#include "hextwist/refine/templates/enclose.h"
#include "hextwist/refine/templates/trisect.h"
#include "hextwist/refine/templates/uniform.h"
#include "hextwist/sizing/pipeline.h"
#include "hextwist/sizing/targets.h"

namespace hextwist {
namespace {

constexpr std::size_t max_told_regions = 10;

std::string counted(Index n, const std::string& what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : what.ends_with('x') ? "es" : "s");
}

std::string describe(const EightRegion& region, const Mesh& mesh) {
  std::string line = counted(region.n_hexes, "hex") + " around hex " + std::to_string(hex_id(mesh, region.first_hex));
  line += region.eight ? ": one into eight" : ": one into 27";
  if (region.alone) return line + ", nothing is around it, so all edges are halved";
  line += " (" + counted(region.n_irregular_edges, "irregular edge") + " inside, " +
          std::to_string(region.n_self_crossing) + " of " + counted(region.n_sheets, "sheet") +
          (region.n_self_crossing == 1 ? " crosses itself)" : " cross themselves)");
  if (!region.eight) return line + ": " + region.reason;
  line += ", in " + std::to_string(region.n_passes) + " passes";
  if (region.n_in_three > 0)
    line += ", " + counted(region.n_in_three, "sheet") + " cut in three: " + std::to_string(region.n_exact) +
            " hexes get exactly eight";
  if (region.n_added_nodes > 0)
    line += ", " + counted(region.n_added_nodes, "node") + " outside enclosed too, for want of a template";
  return line;
}

void tell(const EightPlan& plan, const Mesh& mesh, int round, std::vector<std::string>& notices) {
  std::size_t n_told = 0;
  Index n_eight = 0, n_trisected = 0;
  for (const EightRegion& region : plan.regions) {
    if (round > 0 && region.eight && region.n_in_three == 0) continue;  // as was to be expected
    if (n_told++ < max_told_regions)
      notices.push_back((round > 0 ? "round " + std::to_string(round + 1) + ": " : "") + describe(region, mesh));
    else
      ++(region.eight ? n_eight : n_trisected);
  }
  if (n_eight + n_trisected > 0)
    notices.push_back("and " + counted(n_eight + n_trisected, "region") + " more: " + std::to_string(n_eight) +
                      " one into eight, " + std::to_string(n_trisected) + " one into 27");
}

/// What is still to be done after a pass, in the numbers of the new mesh.
struct Remaining {
  EightPlan plan;
  std::vector<Index> targets;  ///< ascending
  std::size_t next_pass = 0;
};

void pass(Pipeline& run, Remaining& rest, std::shared_ptr<const SplitTable> table, std::span<const std::uint16_t> codes,
          const std::function<void()>& after_pass) {
  if (std::ranges::all_of(codes, [](std::uint16_t code) { return code == 0; })) return;
  const std::vector<Hex> old_hexes = run.current().mesh.hexes;  // the pass replaces the mesh
  run.pass(std::move(table), codes);
  rest.targets = children_of(run.lineage(), rest.targets);
  rest.plan.trisected = children_of(run.lineage(), rest.plan.trisected);
  for (std::size_t p = rest.next_pass; p < rest.plan.passes.size(); ++p)
    carry_marks(run.lineage(), old_hexes, run.current().mesh.n_nodes(), rest.plan.passes[p]);
  if (after_pass) after_pass();
}

}  // namespace

std::vector<Index> eight_round(Pipeline& run, EightPlan plan, std::vector<Index> targets,
                               const std::function<void()>& after_pass) {
  Remaining rest{std::move(plan), std::move(targets)};
  if (!rest.plan.alone.empty()) {
    std::vector<std::uint16_t> codes(run.current().mesh.hexes.size(), 0);
    for (const Index h : rest.plan.alone) codes[h] = 1;
    pass(run, rest, uniform_table(2), codes, after_pass);
  }
  while (rest.next_pass < rest.plan.passes.size()) {
    const std::vector<std::uint8_t> marked = std::move(rest.plan.passes[rest.next_pass++]);
    pass(run, rest, enclose_table(EncloseAt::half), enclose_codes(run.current().mesh.hexes, marked), after_pass);
  }
  if (rest.plan.trisected.empty() && rest.plan.thirds.empty()) return std::move(rest.targets);
  const Mesh& mesh = run.current().mesh;
  std::vector<std::uint8_t> marked(mesh.points.size(), 0);
  mark_nodes(mesh.hexes, rest.plan.trisected, marked);
  if (run.request().concave == Concave::fill) run.report().filled_hexes += fill_concave(mesh, marked);
  std::vector<Index> halved;
  std::ranges::set_difference(rest.targets, rest.plan.trisected, std::back_inserter(halved));
  pass(run, rest, trisect_table(), thirds_codes(mesh, halved, rest.plan.thirds, marked), after_pass);
  return std::move(rest.targets);
}

void eight_passes(Pipeline& run) {
  std::vector<Index> targets = region_target(run.input(), run.request(), run.report().notices);
  for (int round = 0; round < run.request().numsplit; ++round) {
    run.stages().begin("close", run.fraction());
    EightPlan plan = plan_eight(run.current().mesh, targets);
    tell(plan, run.current().mesh, round, run.report().notices);
    targets = eight_round(run, std::move(plan), std::move(targets), {});
  }
}

}  // namespace hextwist
