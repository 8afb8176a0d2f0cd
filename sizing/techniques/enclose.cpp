// Parallel hex sheet operations and the combination: around nodes, edges and faces.
#include <algorithm>
#include <utility>

#include "hextwist/base/text.h"
#include "hextwist/refine/templates/trisect.h"
#include "hextwist/sizing/targets.h"
#include "hextwist/sizing/techniques/techniques_internal.h"

namespace hextwist {
namespace {

/// A hex without a template may bring so many nodes along; where it would take more, nodes are enclosed one after the
/// other instead.
constexpr Index max_growth = 2;

class Enclose : public Technique {
 public:
  Enclose(State& state, Approach approach)
      : at_(approach == Approach::parallel ? EncloseAt::half : EncloseAt::third),
        n_left_(std::get<Cuts>(state.request.how).numsplit),
        round_(sub_element_target(state.input, state.request.target, state.report.notices), at_) {}

  explicit Enclose(CombinationTarget target) : at_(EncloseAt::third), n_left_(1), round_(std::move(target), at_) {}

  std::optional<Cut> next(State& state) override {
    for (;;) {
      if (auto cut = round_.next(state, done_, &state.mesh() != &state.input.mesh)) {
        cut->turn.round = n_rounds_;
        return cut;
      }
      ++n_rounds_;
      if (--n_left_ == 0) return std::nullopt;
      round_ = EncloseRound(round_.take_target(), at_);
    }
  }
  void follow(const Lineage& lineage, const Mesh&, const Mesh& after) override { round_.follow(lineage, after); }
  void finish(State& state) override { tell(done_, state); }

 private:
  EncloseAt at_;
  int n_left_, n_rounds_ = 0;
  EncloseRound round_;
  Enclosed done_;
};

}  // namespace

void tell(const Enclosed& done, State& state) {
  if (done.n_first > 0)
    state.note(counted(done.n_first, "node") + " where targets meet were refined before the others");
  if (done.n_added > 0) state.note(counted(done.n_added, "node") + " beside the target enclosed with it");
}

std::optional<Cut> EncloseRound::next(State& state, Enclosed& done, bool cuts_again) {
  const Mesh& mesh = state.mesh();
  if (!rest_.empty()) {
    state.begin("close");
    std::vector<std::uint8_t> marked(mesh.points.size(), 0);
    for (const Index n : rest_) marked[n] = 1;
    const Index n_added = close_enclosure_nearby(mesh, marked, max_growth);
    done.n_added += n_added;
    const std::vector<std::uint8_t> part = enclosable_part(mesh.hexes, marked);
    std::erase_if(rest_, [&](Index n) { return part[n] != 0; });
    if (!rest_.empty()) done.n_first += static_cast<Index>(std::ranges::count(part, 1));
    if (n_added > 0 || part != marked) state.report.by_whole = enclosed_together;
    const bool again = std::exchange(is_first_, false) && cuts_again;
    return Cut{enclose_table(at_), enclose_codes(mesh.hexes, part), again, {0, 0, n_parts_++}};
  }
  if (has_trisected_ || at_ == EncloseAt::half || uncut_.empty()) return std::nullopt;
  state.begin("close");
  has_trisected_ = true;
  return Cut{trisect_table(), combination_codes(mesh, target_, uncut_), false, {0, 1, 0}};
}

void EncloseRound::follow(const Lineage& lineage, const Mesh& after) {
  target_ = carried_target(target_, lineage, after);
  if (has_trisected_) return;
  std::erase_if(uncut_, [&](const Edge& edge) { return find_cut_edge(lineage, edge) != nullptr; });
}

std::unique_ptr<Technique> enclose_technique(State& state, Approach approach) {
  return std::make_unique<Enclose>(state, approach);
}
std::unique_ptr<Technique> enclose_technique(State&, CombinationTarget target) {
  return std::make_unique<Enclose>(std::move(target));
}

}  // namespace hextwist
