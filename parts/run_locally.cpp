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
  for (const auto& pass : levelling.forest.grown->stack) {
    std::vector<std::uint16_t> codes(hexes.size(), 0);
    for (const CutHex& cut : pass->lineage.hexes) codes[cut.hex] = cut.code;
    Split again = split(hexes, n_nodes, pass->lineage.table, codes);
    recorder.record(again.lineage, hexes);
    hexes = std::move(again.hexes);
    n_nodes = again.n_nodes;
  }
}

/// Throws Error where a whole mesh would be refused, or the result depends on the whole.
void check_result(const LocalMesh& local, const MeshedModel& result, const Report& report,
                  std::span<const std::uint8_t> is_own) {
  if (report.has_smoothed)
    throw Error("new hexes came out so flat that they need smoothing, which goes across parts; run it with hextwist");
  const std::vector<Index> own = indices_where(result.mesh.n_hexes(), [&](Index h) { return is_own[h] != 0; });
  if (const std::vector<Index> wrong = inverted_hexes(result.mesh, own); !wrong.empty())
    throw Error(counted(std::ssize(wrong), "hex", "hexes") + " would be inverted in hex " +
                std::to_string(hex_id(local.meshed.mesh, wrong.front())));
  if (report.off_nodes.empty() || report.off_nodes_allowed) return;
  std::vector<std::uint8_t> is_own_node(result.mesh.points.size(), 0);
  for (const Index h : own)
    for (const Index n : result.mesh.hexes[h]) is_own_node[n] = 1;
  const auto n_off =
      std::ranges::count_if(report.off_nodes, [&](const OffOwner& row) { return is_own_node[row.node]; });
  if (n_off > 0) throw Error(counted(n_off, "node") + " could not be put on the CAD");
}

void add(std::uint64_t& digest, const void* bytes, std::size_t n) {
  const auto* at = static_cast<const unsigned char*>(bytes);
  for (std::size_t i = 0; i + 8 <= n; i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, at + i, 8);
    digest = (digest ^ word) * 0x9E3779B97F4A7C15ULL;
    digest ^= digest >> 29;
  }
}

/// Of all that each base hex has become: where its hexes are, in their order, and who owns their nodes.
std::vector<std::uint64_t> digests(const LocalMesh& local) {
  std::vector<std::uint64_t> digest(local.base.hex.size(), 0);
  const Mesh& mesh = local.meshed.mesh;
  const auto& owners = local.meshed.association.node_owner;
  for (std::size_t h = 0; h < mesh.hexes.size(); ++h) {
    std::uint64_t& of = digest[local.base_of[h]];
    for (const Index n : mesh.hexes[h]) {
      add(of, mesh.points[n].data(), sizeof(Vec3));
      const std::uint64_t owner =
          owners.empty() ? 0
                         : static_cast<std::uint64_t>(owners[n].dim) << 32 | static_cast<std::uint32_t>(owners[n].id);
      add(of, &owner, sizeof owner);
    }
  }
  return digest;
}

}  // namespace

LocalRun run_locally(LocalMesh& local, const Asked& asked) {
  std::vector<std::uint8_t> is_own(local.base_of.size());
  for (std::size_t h = 0; h < is_own.size(); ++h) is_own[h] = local.base.ring[local.base_of[h]] == 0;
  LocalRun run;
  run.by_levels = asked.approach == Approach::levels;
  if (asked.is_here) {
    PassRecorder recorder(is_own);
    Report report;
    const Progress none;
    State state(local.meshed, asked.request, report, none);
    state.watch = [&](const Lineage& lineage, const Mesh& before) {
      if (!run.by_levels) recorder.record(lineage, before.hexes);
    };
    RefineResult result = run_passes(state, asked.approach);
    if (run.by_levels) record_levels(*result.levelling, local.meshed.mesh, recorder);
    check_result(local, result.refined, report, recorder.is_own());
    run.records = std::move(recorder.records);
    std::vector<Index> base_of(result.origin.size());
    for (std::size_t h = 0; h < base_of.size(); ++h) base_of[h] = local.base_of[result.origin[h]];
    local.base_of = std::move(base_of);
    MeshedModel refined = std::move(result.refined);
    refined.mesh.node_ids.clear();
    refined.mesh.hex_ids.clear();
    local.meshed = std::move(refined);
  }
  run.digest = digests(local);
  return run;
}

}  // namespace hextwist
