#include "hextwist/session/refining.h"

#include <algorithm>
#include <utility>

#include "hextwist/base/sorted.h"
#include "hextwist/patch/adapt.h"
#include "hextwist/patch/refine_known.h"
#include "hextwist/session/load.h"
#include "hextwist/sizing/levelling.h"

namespace hextwist {

bool Refining::changes_nothing() const {
  if (patch) return patch->splice->gone_hexes().empty();
  const std::vector<HexOrigin>& kind = whole.came_from.kind;
  return !kind.empty() && std::ranges::all_of(kind, [](HexOrigin k) { return k == HexOrigin::same; });
}

Refining prepare_refining(Transaction& run, Request request) {
  Refining refining;
  if (!request.levelling) request.levelling = run.state.levelling;
  if (!request.levelling) request.levelling = levelling_of(run.meshed.lend());
  request.finish.periodic = run.state.periodic;
  const Progress& progress = run.core.callbacks.progress;
  const Measured& known = run.state.measured;
  // The session knows who is whose neighbour.
  const RingsOf rings = [&](const Mesh& mesh, std::span<const Index> nodes, std::span<const Index>, int n_rings,
                            std::size_t limit) {
    std::unique_ptr<Neighbours>& neighbours = run.core.neighbours;
    if (!neighbours) neighbours = std::make_unique<Neighbours>(mesh);
    return rings_around(mesh, nodes, n_rings, limit, [&](std::span<const Index> at, std::vector<Index>& hexes) {
      neighbours->hexes_at(at, hexes);
      return true;
    });
  };
  // Images may be anywhere: no patch has both sides.
  if (!run.state.periodic) refining.patch = refine_patch(*run.meshed, known, request, progress, rings);
  if (refining.patch && !refining.patch->is_verified && !request.finish.dry_run)
    refining.whole = whole_result(*std::exchange(refining.patch, std::nullopt), *run.meshed, known, request);
  else if (!refining.patch)
    refining.whole = refine_whole(*run.meshed, &known, request, progress);
  refining.request = std::move(request);
  return refining;
}

std::vector<Index> origin_of(const Refining& refining, const MeshedModel& before) {
  return refining.patch ? whole_origin(*refining.patch, before) : refining.whole.origin;
}

LevelOrigin came_from(const Refining& refining, const MeshedModel& before) {
  return refining.patch ? whole_came_from(*refining.patch, before) : came_from(before.mesh, refining.whole);
}

void accept_refining(Transaction& run, Refining refining) {
  if (!refining.patch) return accept_refined(run, std::move(refining.whole));
  PatchResult& patch = *refining.patch;
  if (patch.splice->hexes().come.empty() && patch.splice->hexes().gone.empty()) {
    run.leave_mesh();
    take_measured(run, patch.result.report);
    // What was cut for the sake of others may be wished for now, or no longer.
    if (patch.result.levelling) take_levelling(run, patch.result.levelling);
    return;
  }
  const Report report = std::move(patch.result.report);
  const Reindexing nodes = patch.splice->nodes();
  run.stage("splice");
  const std::vector<Index> smoothed = std::exchange(patch.result.smoothed, {});
  LevellingPtr levelling =
      patch.result.levelling ? patch.result.levelling : planted(patch, refining.request, *run.meshed);
  patch.result.levelling = nullptr;
  refining.request.levelling = nullptr;  // a mesh that is the base of nothing is changed in place
  run.splice({std::move(patch.splice)});
  run.close_stage();
  take_measured(run, report);
  take_levelling(run, smoothed.empty() ? levelling : levelling_after_move(levelling, smoothed, *run.meshed));
  if (nodes.gone.empty() || !run.state.fixed_nodes) return;
  std::vector<Index> still;
  for (const Index n : *run.state.fixed_nodes)
    if (!nodes.is_gone(n)) still.push_back(nodes.after(n));
  take_fixed(run, std::move(still));
}

}  // namespace hextwist
