// One into eight: parallel hex sheet operations on whole hexes and layers of them, and what is decided for each region.
#include <algorithm>

#include "hextwist/base/sorted.h"
#include "hextwist/base/text.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/refine/marks.h"
#include "hextwist/refine/templates/trisect.h"
#include "hextwist/refine/templates/uniform.h"
#include "hextwist/sizing/targets.h"
#include "hextwist/sizing/techniques/techniques_internal.h"

namespace hextwist {
namespace {

constexpr std::size_t max_told_regions = 10;

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

class Eight : public Technique {
 public:
  explicit Eight(State& state)
      : targets_(region_target(state.input, state.request.target, state.report.notices)),
        n_rounds_(std::get<Cuts>(state.request.how).numsplit) {}

  std::optional<Cut> next(State& state) override {
    for (;;) {
      if (round_) {
        if (auto cut = round_->next(state)) return cut;
        round_.reset();
      }
      if (n_done_ == n_rounds_) return std::nullopt;
      state.begin("close");
      // Levels: the transition of each round but the last lies one hex further out, where no later round cuts.
      const bool grows = is_regular(state.request) && n_done_ + 1 < n_rounds_;
      const std::vector<Index> around = grows ? with_layers(state.mesh(), targets_, 1) : targets_;
      EightStart start = plan_eight_around(state.mesh(), targets_, around);
      tell(start.plan, state.mesh(), n_done_++, state.report.notices);
      round_.emplace(std::move(start.plan), std::move(start.region));
    }
  }
  void follow(const Lineage& lineage, const Mesh& before, const Mesh& after) override {
    targets_ = children_of(lineage, targets_);
    round_->follow(lineage, before, after);
  }

 private:
  std::vector<Index> targets_;
  int n_rounds_, n_done_ = 0;
  std::optional<EightRound> round_;
};

}  // namespace

EightStart plan_eight_around(const Mesh& mesh, const std::vector<Index>& targets, const std::vector<Index>& around) {
  EightStart start{{}, union_of(targets, around)};
  start.plan = plan_eight(mesh, start.region);
  if (start.region.size() == targets.size()) return start;
  const auto n_trisected = [&](const EightPlan& plan) {
    return targets.size() - difference(targets, plan.trisected).size();
  };
  const std::size_t lost = n_trisected(start.plan);
  if (lost == 0) return start;
  EightPlan alone = plan_eight(mesh, targets);
  return n_trisected(alone) < lost ? EightStart{std::move(alone), targets} : start;
}

std::optional<Cut> EightRound::next(State& state) {
  const Mesh& mesh = state.mesh();
  const auto cuts = [](const Cut& cut) { return std::ranges::any_of(cut.codes, [](int code) { return code != 0; }); };
  if (!plan_.alone.empty()) {
    Cut cut{uniform_table(2), std::vector<std::uint16_t>(mesh.hexes.size(), 0)};
    for (const Index h : plan_.alone) cut.codes[h] = 1;
    plan_.alone.clear();
    return cut;
  }
  while (next_pass_ < plan_.passes.size()) {
    const std::vector<std::uint8_t> marked = std::move(plan_.passes[next_pass_++]);
    if (Cut cut{enclose_table(EncloseAt::half), enclose_codes(mesh.hexes, marked)}; cuts(cut)) return cut;
  }
  if (plan_.trisected.empty() && plan_.thirds.empty()) return std::nullopt;
  std::vector<std::uint8_t> marked(mesh.points.size(), 0);
  mark_nodes(mesh.hexes, plan_.trisected, marked);
  if (state.request.concave == Concave::fill) state.report.filled_hexes += fill_concave(mesh, marked);
  const std::vector<Index> halved = difference(region_, plan_.trisected);
  Cut cut{trisect_table(), thirds_codes(mesh, halved, plan_.thirds, marked)};
  plan_.trisected.clear();
  plan_.thirds.clear();
  return cuts(cut) ? std::optional(std::move(cut)) : std::nullopt;
}

void EightRound::follow(const Lineage& lineage, const Mesh& before, const Mesh& after) {
  region_ = children_of(lineage, region_);
  plan_.trisected = children_of(lineage, plan_.trisected);
  for (std::size_t p = next_pass_; p < plan_.passes.size(); ++p)
    carry_marks(lineage, before.hexes, after.n_nodes(), plan_.passes[p]);
}

std::unique_ptr<Technique> eight_technique(State& state) {
  return std::make_unique<Eight>(state);
}

}  // namespace hextwist
