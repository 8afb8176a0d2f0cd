// What came of hexes, and how, in a number: parts that have made the same have the same.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hextwist/parts/local_mesh.h"
#include "hextwist/sizing/levelling.h"

namespace hextwist {

/// Of all that each base hex has become: which passes made its hexes, how, and in which order; where these are, who
/// owns their nodes, and the values of fields. base_of, history: per hex.
std::vector<std::uint64_t> digests(const MeshedModel& made, std::span<const Index> base_of,
                                   std::span<const std::uint64_t> history, std::size_t n_base);

/// The passes that made the result of levels: their lineages are kept without parents.
void record_levels(const Levelling& levelling, const Mesh& input, PassRecorder& recorder);

}  // namespace hextwist
