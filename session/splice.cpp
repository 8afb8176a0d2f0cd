// A session changes its mesh in place where a change is small and nobody else looks at the mesh: in time proportional
// to the change, but for moving what comes behind it in the arrays.

#include "hextwist/patch/patch_refine.h"
#include "hextwist/session/session_internal.h"

namespace hextwist {
namespace {

/// The neighbours of all nodes; made when first asked for.
Neighbours& neighbours(Session::Core& core) {
  if (!core.neighbours || core.neighbours_of.lock() != core.state.meshed) {
    core.neighbours = std::make_unique<Neighbours>(core.state.meshed->mesh);
    core.neighbours_of = core.state.meshed;
  }
  return *core.neighbours;
}

/// The neighbours after the mesh has changed; forgotten where that does not work.
void follow(Session::Core& core, std::span<const SpliceStep> steps) noexcept {
  try {
    bool can = core.neighbours != nullptr;
    for (const auto& [splice, forward] : steps) can = can && core.neighbours->apply(*splice, forward);
    if (!can) core.neighbours = nullptr;
    core.neighbours_of = core.state.meshed;
  } catch (...) {
    core.neighbours = nullptr;
  }
}

/// A mesh that splices change, and change back unless they are kept.
class InPlace {
 public:
  explicit InPlace(MeshedModel& meshed) : meshed_(meshed) {}
  InPlace(const InPlace&) = delete;
  ~InPlace() {
    // What was there before has room.
    for (; !done_.empty(); done_.pop_back()) done_.back().splice->apply(meshed_, !done_.back().forward);
  }
  void apply(const SpliceStep& step) {
    step.splice->make_room(meshed_, step.forward);
    done_.push_back(step);
    step.splice->apply(meshed_, step.forward);
  }
  void keep() noexcept { done_.clear(); }

 private:
  MeshedModel& meshed_;
  std::vector<SpliceStep> done_;
};

}  // namespace

std::optional<PatchResult> refine_in_patch(const Execution& run, const Measured& known, const Request& request) {
  return refine_patch(
      *run.state.meshed, known, request, run.core.callbacks.progress,
      [&](const Mesh& mesh, std::span<const Index> nodes, std::span<const Index>, int n_rings, std::size_t limit) {
        const Neighbours& known_neighbours = neighbours(run.core);
        return rings_around(mesh, nodes, n_rings, limit, [&](std::span<const Index> at, std::vector<Index>& hexes) {
          known_neighbours.hexes_at(at, hexes);
          return true;
        });
      });
}

void Execution::splice(std::span<const SpliceStep> steps, ModelState next, const std::vector<std::string>& lines) {
  stage("splice");
  core.topology_of = nullptr;
  core.topology = nullptr;
  if (core.neighbours_of.lock() != state.meshed) core.neighbours = nullptr;  // those of another mesh
  // One is the state's, one that of run_command(), which puts back what it holds when something throws.
  constexpr long ours = 2;
  const bool in_place = state.meshed.use_count() == ours;
  const auto meshed = in_place
                          ? std::const_pointer_cast<MeshedModel>(state.meshed)  // built as const by nobody
                          : std::make_shared<MeshedModel>(spliced(*state.meshed, *steps[0].splice, steps[0].forward));
  InPlace change(*meshed);
  for (const SpliceStep& each : steps.subspan(in_place ? 0 : 1)) change.apply(each);
  next.meshed = meshed;
  for (const std::string& line : lines) say(line);
  close_stage();
  // Nothing below throws.
  change.keep();
  static_cast<ModelState&>(state) = std::move(next);
  follow(core, steps);
}

}  // namespace hextwist
