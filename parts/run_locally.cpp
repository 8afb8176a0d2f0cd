#include <algorithm>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/base/text.h"
#include "hextwist/mesh/entity.h"
#include "hextwist/mesh/quality/validity.h"
#include "hextwist/parts/digest.h"
#include "hextwist/parts/size_tries.h"
#include "hextwist/sizing/size_report.h"

namespace hextwist {
namespace {

/// Why the part's own hexes are no good, as a whole mesh would be refused; empty: they are.
std::string faults_of(const LocalMesh& local, const RefineResult& made, const Report& report,
                      std::span<const std::uint8_t> ring) {
  const Mesh& mesh = made.refined.mesh;
  const std::vector<Index> own = indices_where(mesh.n_hexes(), [&](Index h) { return ring[h] == 0; });
  if (const std::vector<Index> wrong = inverted_hexes(mesh, own); !wrong.empty())
    return counted(std::ssize(wrong), "hex", "hexes") + " would be inverted in hex " +
           std::to_string(local.base.hex[local.base_of[made.origin[wrong.front()]]]) + " of the input";
  if (report.off_nodes.empty() || report.off_nodes_allowed) return {};
  std::vector<std::uint8_t> is_own_node(mesh.points.size(), 0);
  for (const Index h : own)
    for (const Index n : mesh.hexes[h]) is_own_node[n] = 1;
  const auto n_off =
      std::ranges::count_if(report.off_nodes, [&](const OffOwner& row) { return is_own_node[row.node]; });
  return n_off > 0 ? counted(n_off, "node") + " could not be put on the CAD" : "";
}

/// Asks all parts as often as each of them does.
class Asking {
 public:
  explicit Asking(const LeastOfAll& least_of_all) : least_of_all_(least_of_all) {}
  Bounds operator()(int freedom, const Bounds& mine) {
    while (next_ < freedom) least_of_all_(next_++, no_bounds);
    return least_of_all_(next_++, mine);
  }
  void finish() {
    while (next_ < n_freedoms) least_of_all_(next_++, no_bounds);
  }

 private:
  const LeastOfAll& least_of_all_;
  int next_ = 0;
};

SizeCounts counts_of(const SizeReport& sizes, const LocalMesh& local, std::span<const Index> origin) {
  SizeCounts counts;
  for (std::size_t i = 0; i < sizes.hexes.size(); ++i) {
    if (!local.is_own(origin[sizes.hexes[i]])) continue;
    ++counts.met.n_hexes;
    counts.met.n_coarser += is_coarser(sizes.ratio[i]);
    counts.met.n_finer += is_finer(sizes.ratio[i]);
    counts.met.n_much_finer += sizes.ratio[i] < 1.0 / 3;
  }
  counts.unmet = std::ranges::count_if(sizes.unmet, [&](Index h) { return local.is_own(origin[h]); });
  return counts;
}

LocalRun run_passes_locally(LocalMesh& local, const Asked& asked, SizeTries& tries, Asking& asking) {
  PassRecorder recorder(items_at(local.base.ring, local.base_of));
  LocalRun run;
  if (asked.is_here) {
    Report report;
    const Progress none;
    State state(local.meshed, asked.request, report, none);
    state.watch = [&](const Lineage& lineage, const Mesh& before, const Cut& cut) {
      recorder.record(cut.turn, lineage, before.hexes, cut.filled);
    };
    state.bounds_of_all = [&](int freedom, const Mesh& mesh, std::span<const Index> hexes,
                              std::span<const Index> origin, double wanted) {
      std::vector<Index> own;
      for (const Index h : hexes)
        if (local.is_own(origin[h])) own.push_back(h);
      return asking(freedom, own.empty() ? no_bounds : bounds_of(mesh, own, wanted));
    };
    if (tries.is_for_sizes()) state.among = &tries;
    make_passes(state, asked.approach);
    tries.finish();
    RefineResult result = finish_passes(state);
    if (tries.have_any()) recorder = tries.take_recorder();
    run.by_levels = result.levelling != nullptr;
    if (run.by_levels && !tries.have_any()) record_levels(*result.levelling, local.meshed.mesh, recorder);
    run.wrong = faults_of(local, result, report, recorder.ring());
    run.records = std::move(recorder.records);
    run.by_whole = report.has_smoothed ? smoothed_together : std::move(report.by_whole);
    if (!tries.by_whole.empty()) run.by_whole = tries.by_whole;
    if (report.sizes) run.sizes = counts_of(*report.sizes, local, result.origin);
    std::vector<Index> base_of(result.origin.size());
    for (std::size_t h = 0; h < base_of.size(); ++h) base_of[h] = local.base_of[result.origin[h]];
    local.base_of = std::move(base_of);
    MeshedModel refined = std::move(result.refined);
    refined.mesh.node_ids.clear();
    refined.mesh.hex_ids.clear();
    local.meshed = std::move(refined);
  }
  run.digest = digests(local.meshed, local.base_of, recorder.history(), local.base.hex.size());
  tries.mix_into(run.digest);
  return run;
}

}  // namespace

LocalRun run_locally(LocalMesh& local, const Asked& asked, const OfWhole& whole, const OfAll& of_all) {
  Asking asking(of_all.least);
  SizeTries tries(local, asked, whole, of_all.numbers);
  try {
    LocalRun run = run_passes_locally(local, asked, tries, asking);
    asking.finish();
    return run;
  } catch (const OthersFailed&) {
    asking.finish();
    return {};
  } catch (...) {  // the others go on
    tries.fail();
    asking.finish();
    throw;
  }
}

}  // namespace hextwist
