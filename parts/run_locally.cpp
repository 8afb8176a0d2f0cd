#include <algorithm>
#include <cstring>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/base/text.h"
#include "hextwist/mesh/entity.h"
#include "hextwist/mesh/quality/validity.h"
#include "hextwist/parts/local_mesh.h"
#include "hextwist/refine/split.h"
#include "hextwist/sizing/levelling.h"
#include "hextwist/sizing/loop.h"

namespace hextwist {
namespace {

/// The passes that made the result of levels: their lineages are kept without parents.
void record_levels(const Levelling& levelling, const Mesh& input, PassRecorder& recorder) {
  std::vector<Hex> hexes = input.hexes;
  Index n_nodes = input.n_nodes();
  int level = 0;
  for (const auto& pass : levelling.forest.grown->stack) {
    std::vector<std::uint16_t> codes(hexes.size(), 0);
    for (const CutHex& cut : pass->lineage.hexes) codes[cut.hex] = cut.code;
    Split again = split(hexes, n_nodes, pass->lineage.table, codes);
    recorder.record({level++, 0, 0}, again.lineage, hexes, {});
    hexes = std::move(again.hexes);
    n_nodes = again.n_nodes;
  }
}

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

void mix_bytes(std::uint64_t& digest, const void* bytes, std::size_t n) {
  const auto* at = static_cast<const unsigned char*>(bytes);
  for (std::size_t i = 0; i + 8 <= n; i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, at + i, 8);
    mix(digest, word);
  }
}

/// Of all that each base hex has become: which passes made its hexes, how, and in which order; where these are, who
/// owns their nodes, and the values of fields.
std::vector<std::uint64_t> digests(const LocalMesh& local, std::span<const std::uint64_t> history) {
  std::vector<std::uint64_t> digest(local.base.hex.size(), 0);
  const Mesh& mesh = local.meshed.mesh;
  const Association& association = local.meshed.association;
  const auto mix_values = [&](std::uint64_t& of, const Field& field, Index i) {
    const auto n = static_cast<std::size_t>(field.components);
    if (field.values.size() >= (static_cast<std::size_t>(i) + 1) * n)
      mix_bytes(of, &field.values[static_cast<std::size_t>(i) * n], n * sizeof(double));
  };
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    std::uint64_t& of = digest[local.base_of[h]];
    mix(of, history[h]);
    for (const Index n : mesh.hexes[h]) {
      mix_bytes(of, mesh.points[n].data(), sizeof(Vec3));
      if (!association.node_owner.empty()) {
        const Owner owner = association.node_owner[n];
        mix(of, static_cast<std::uint64_t>(owner.dim) << 32 | static_cast<std::uint32_t>(owner.id));
      }
      if (!association.node_parameters.empty()) mix_bytes(of, &association.node_parameters[n], sizeof(Parameters));
    }
    for (const Field& field : mesh.fields) {
      if (field.on == Field::On::hex)
        mix_values(of, field, h);
      else
        for (const Index n : mesh.hexes[h]) mix_values(of, field, n);
    }
  }
  return digest;
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

LocalRun run_passes_locally(LocalMesh& local, const Asked& asked, Asking& asking) {
  PassRecorder recorder(items_at(local.base.ring, local.base_of));
  LocalRun run;
  run.by_levels = asked.approach == Approach::levels;
  if (asked.is_here) {
    Report report;
    const Progress none;
    State state(local.meshed, asked.request, report, none);
    state.watch = [&](const Lineage& lineage, const Mesh& before, const Cut& cut) {
      if (!run.by_levels) recorder.record(cut.turn, lineage, before.hexes, cut.filled);
    };
    state.bounds_of_all = [&](int freedom, const Mesh& mesh, std::span<const Index> hexes,
                              std::span<const Index> origin, double wanted) {
      std::vector<Index> own;
      for (const Index h : hexes)
        if (local.is_own(origin[h])) own.push_back(h);
      return asking(freedom, own.empty() ? no_bounds : bounds_of(mesh, own, wanted));
    };
    RefineResult result = run_passes(state, asked.approach);
    if (run.by_levels) record_levels(*result.levelling, local.meshed.mesh, recorder);
    run.wrong = faults_of(local, result, report, recorder.ring());
    run.records = std::move(recorder.records);
    run.by_whole = report.has_smoothed ? "flat hexes are smoothed together" : std::move(report.by_whole);
    std::vector<Index> base_of(result.origin.size());
    for (std::size_t h = 0; h < base_of.size(); ++h) base_of[h] = local.base_of[result.origin[h]];
    local.base_of = std::move(base_of);
    MeshedModel refined = std::move(result.refined);
    refined.mesh.node_ids.clear();
    refined.mesh.hex_ids.clear();
    local.meshed = std::move(refined);
  }
  run.digest = digests(local, recorder.history());
  return run;
}

}  // namespace

LocalRun run_locally(LocalMesh& local, const Asked& asked, const LeastOfAll& least_of_all) {
  Asking asking(least_of_all);
  try {
    LocalRun run = run_passes_locally(local, asked, asking);
    asking.finish();
    return run;
  } catch (...) {  // the others go on
    asking.finish();
    throw;
  }
}

}  // namespace hextwist
