// Ids of what passes made, as passes over the whole mesh would have given them.
#pragma once

#include <span>
#include <vector>

#include "hextwist/parts/mpi/directory.h"
#include "hextwist/parts/pass_record.h"

namespace hextwist {

/// Ids of the whole; -1 for nodes and hexes of others that were never asked for.
struct GlobalIds {
  std::vector<std::int64_t> node, hex;             ///< by local index
  std::int64_t highest_node = 0, highest_hex = 0;  ///< in the whole
};

/// Follows the passes of one request. All ranks take part, also those that did not cut. by_levels: the passes are those
/// of levels, where hexes that a later pass cuts never get an id. Throws Error where parts disagree, or their passes
/// can't be brought into one order.
void number(Ranks& ranks, const std::vector<PassRecord>& records, bool by_levels, GlobalIds& ids);

}  // namespace hextwist
