#include "hextwist/session/history_internal.h"

#include <algorithm>
#include <utility>

#include "hextwist/patch/extremes.h"

namespace hextwist {
namespace {

std::size_t bytes_of_extremes(const std::shared_ptr<const Extremes>& extremes) {
  if (!extremes) return 0;
  std::size_t bytes = sizeof *extremes;
  for (const auto* lists : {&extremes->shape, &extremes->scaled_jacobian})
    for (const ExtremeList& list : *lists) bytes += bytes_of(list);
  return bytes;
}

}  // namespace

Step::Step(std::string command, const ModelState& from, const ModelState& to)
    : command_(std::move(command)), state_(to), bytes_(sizeof(Step) + command_.capacity()) {
  state_.extremes = nullptr;  // not worth the memory
  if (to.tags && from.tags != to.tags) bytes_ += bytes_of(*to.tags);
  if (to.fixed_nodes && from.fixed_nodes != to.fixed_nodes) bytes_ += bytes_of(*to.fixed_nodes);
  if (to.schemes && from.schemes != to.schemes) bytes_ += bytes_of(*to.schemes);
  if (from.meshed == to.meshed) {
    state_.meshed = nullptr;  // not kept alive by this
    return;
  }
  const std::size_t whole = bytes_of(*to.meshed);
  // A mesh that has nothing in common with the other is kept as it is rather than told piece by piece.
  if (from.meshed->mesh.hexes.empty() || to.meshed->mesh.hexes.empty()) {
    bytes_ += whole;
    return;
  }
  MeshedDelta arrays = MeshedDelta::between(*from.meshed, *to.meshed);
  const std::size_t parts = arrays.bytes() + sizeof(MeshedDelta);
  if (parts > whole / 2) {
    bytes_ += whole;
    return;
  }
  arrays_ = std::make_shared<const MeshedDelta>(std::move(arrays));
  state_.meshed = nullptr;
  bytes_ += parts;
}

Step::Step(std::string command, const ModelState& state, SetsDelta sets)
    : command_(std::move(command)), state_(state), only_sets_(true), bytes_(sizeof(Step) + command_.capacity()) {
  MeshedDelta arrays;
  arrays.sets = std::move(sets);
  arrays.model = state.meshed->model;
  bytes_ += sizeof(MeshedDelta) + bytes_of(arrays.sets);  // extremes: those of the state beside it
  arrays_ = std::make_shared<const MeshedDelta>(std::move(arrays));
  state_.meshed = nullptr;
}

Step::Step(std::string command, const ModelState& to, std::shared_ptr<const Splice> splice, bool forward)
    : command_(std::move(command)),
      state_(to),
      splice_(std::move(splice)),
      forward_(forward),
      bytes_(sizeof(Step) + command_.capacity() + splice_->bytes()) {
  if (to.tags) bytes_ += bytes_of(*to.tags);
  extreme_bytes_ = bytes_of_extremes(state_.extremes);
  bytes_ += extreme_bytes_;
  state_.meshed = nullptr;
}

void Step::forget_extremes() noexcept {
  bytes_ -= std::exchange(extreme_bytes_, 0);
  state_.extremes = nullptr;
}

const SetsDelta& Step::sets() const {
  return arrays_->sets;
}

ModelState Step::apply(const ModelState& from) const {
  ModelState result = state_;
  if (!result.meshed) result.meshed = from.meshed;
  if (splice_) result.meshed = std::make_shared<MeshedModel>(spliced(*from.meshed, *splice_, forward_));
  if (arrays_) result.meshed = std::make_shared<MeshedModel>(arrays_->apply(*from.meshed));
  return result;
}

std::size_t History::bytes() const {
  std::size_t sum = 0;
  for (const auto* steps : {&undo, &redo})
    for (const Step& step : *steps) sum += step.bytes();
  return sum;
}

void History::add(Step step) noexcept {
  redo.clear();
  undo.push_back(std::move(step));
  // Who goes back one step may go on from there at once; farther back they can be looked for again.
  constexpr std::size_t n_with_extremes = 8;
  if (undo.size() > n_with_extremes) undo[undo.size() - 1 - n_with_extremes].forget_extremes();
  drop_oldest();
}

void History::drop_oldest() noexcept {
  std::size_t sum = bytes();
  for (auto* steps : {&redo, &undo}) {
    std::size_t n = 0;
    while (n < steps->size() && sum > limit) sum -= (*steps)[n++].bytes();
    steps->erase(steps->begin(), steps->begin() + static_cast<std::ptrdiff_t>(n));
  }
}

}  // namespace hextwist
