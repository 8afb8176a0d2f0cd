// Ids of what passes made, as passes over the whole mesh would have given them.
//
// Each part says what its own nodes and hexes bring, sums over all parts say where that begins, and the part gives out
// ids. How the sums are made (mpi/directory.h, on_disk.cpp) is not its business.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "hextwist/parts/pass_record.h"
#include "hextwist/parts/runs.h"

namespace hextwist {

/// Ids of the whole; -1 for nodes and hexes of others that were never asked for.
struct GlobalIds {
  std::vector<std::int64_t> node, hex;             ///< by local index
  std::int64_t highest_node = 0, highest_hex = 0;  ///< in the whole
};

/// The pass that a part makes at this turn. Null: it makes none.
const PassRecord* pass_at(std::span<const PassRecord> records, const Turn& turn);

/// What brings something: the lower nodes of edges, the lowest ones of faces, hexes.
inline constexpr std::size_t n_bringers = 3;
using RunLists = std::array<std::vector<Run>, n_bringers>;
struct PassSums {
  std::array<std::vector<Counts>, n_bringers> before;  ///< per run of the part
  std::array<Counts, n_bringers> total{};              ///< in the whole
};

/// What a pass brings at the part's own nodes and hexes, by ids.
RunLists brought_by(const PassRecord& record, const GlobalIds& ids);
/// Ids after the pass. record: null where the part has none in this turn.
void number_pass(const PassRecord* record, const RunLists& runs, const PassSums& sums, GlobalIds& ids);

/// After the passes of levels, where hexes that a later pass cuts never get an id: those that are there follow each
/// other. before: the highest id before the passes.
std::vector<Run> survivors(std::int64_t before, const GlobalIds& ids);
void number_survivors(std::int64_t before, std::span<const Run> runs, std::span<const Counts> starts,
                      std::int64_t n_in_whole, GlobalIds& ids);

}  // namespace hextwist
