#include "hextwist/session/history.h"

#include <utility>

#include "hextwist/sizing/levelling.h"

namespace hextwist {
namespace {

// What a step and the difference of two meshes take when they hold nothing: about, and everywhere the same.
constexpr std::size_t step_bytes = 408, delta_bytes = 760;

std::size_t bytes_of_extremes(const std::shared_ptr<const Extremes>& extremes) {
  if (!extremes) return 0;
  std::size_t bytes = sizeof *extremes;
  for (const auto* lists : {&extremes->shape, &extremes->scaled_jacobian})
    for (const ExtremeList& list : *lists) bytes += bytes_of(list);
  return bytes;
}

struct ChangeBytes {
  std::size_t operator()(const SameMesh&) const { return 0; }
  std::size_t operator()(const WholeMesh& whole) const { return whole.bytes; }
  std::size_t operator()(const ArraysChange& change) const { return change.arrays->bytes() + delta_bytes; }
  std::size_t operator()(const SetsChange& change) const { return bytes_of(change.sets) + delta_bytes; }
  std::size_t operator()(const SpliceChange& change) const { return change.splice->bytes(); }
};

struct Changed {
  const MeshedModel& from;
  MeshedModel operator()(const SameMesh&) const { return from; }
  MeshedModel operator()(const WholeMesh& whole) const { return *whole.meshed; }
  MeshedModel operator()(const ArraysChange& change) const { return change.arrays->apply(from); }
  MeshedModel operator()(const SetsChange& change) const {
    Mesh lists = sets_after(change.sets, from.mesh);
    MeshedModel result = from;
    swap_sets(result.mesh, lists);
    return result;
  }
  MeshedModel operator()(const SpliceChange& change) const { return spliced(from, *change.splice, change.forward); }
};

}  // namespace

MeshChange difference(const MeshedModel& from, const MeshedModel& to) {
  const std::size_t whole = bytes_of(to);
  if (from.mesh.hexes.empty() || to.mesh.hexes.empty()) return WholeMesh{whole};
  auto arrays = std::make_unique<const MeshedDelta>(MeshedDelta::between(from, to));
  if (arrays->bytes() + delta_bytes > whole / 2) return WholeMesh{whole};
  return ArraysChange{std::move(arrays)};
}

MeshedModel changed(const MeshedModel& from, const MeshChange& change) {
  return std::visit(Changed{from}, change);
}

void swap_sets(Mesh& mesh, Mesh& lists) noexcept {
  mesh.blocks.swap(lists.blocks);
  mesh.node_sets.swap(lists.node_sets);
  mesh.side_sets.swap(lists.side_sets);
}

Step::Step(std::string said, const ModelState& from, const ModelState& to, MeshChange change)
    : command(std::move(said)), state(to), mesh(std::move(change)) {
  bytes = step_bytes + command.capacity() + std::visit(ChangeBytes(), mesh);
  if (to.tags && from.tags != to.tags) bytes += bytes_of(*to.tags);
  if (to.fixed_nodes && from.fixed_nodes != to.fixed_nodes) bytes += bytes_of(*to.fixed_nodes);
  if (to.schemes && from.schemes != to.schemes) bytes += bytes_of(*to.schemes);
  if (to.levelling && from.levelling != to.levelling) {
    state.levelling = without_stack(to.levelling);
    bytes += bytes_of(*state.levelling);
  }
  if (std::holds_alternative<WholeMesh>(mesh) || std::holds_alternative<ArraysChange>(mesh))
    state.measured.extremes = nullptr;  // not worth the memory
  else if (std::holds_alternative<SpliceChange>(mesh))
    bytes += extreme_bytes = bytes_of_extremes(state.measured.extremes);
}

void Step::forget_extremes() noexcept {
  bytes -= std::exchange(extreme_bytes, 0);
  state.measured.extremes = nullptr;
}

std::size_t History::bytes() const {
  std::size_t sum = 0;
  for (const auto* steps : {&undo, &redo})
    for (const Step& step : *steps) sum += step.bytes;
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
    while (n < steps->size() && sum > limit) sum -= (*steps)[n++].bytes;
    steps->erase(steps->begin(), steps->begin() + static_cast<std::ptrdiff_t>(n));
  }
}

}  // namespace hextwist
