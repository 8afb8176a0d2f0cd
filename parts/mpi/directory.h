// Who has what, and sums over what all ranks have, by ids of the whole mesh.
//
// The rank that looks after an id (its home) follows from the id alone, in ascending order; so sums over all lower ids
// are sums over the ranks before and the ids at home.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hextwist/parts/halo.h"
#include "hextwist/parts/mpi/ranks.h"
#include "hextwist/parts/own_skin.h"

namespace hextwist {

/// Several lists at once. what: what keys are in messages ("node"), per list. Throws Error on all ranks where the runs
/// of two ranks contradict each other.
PassSums sums_of(Ranks& ranks, const RunLists& mine);

/// Which of these nodes of this rank's part (ids, ascending) others have too.
std::vector<NodeAtOthers> at_others(Ranks& ranks, const Mesh& part, std::span<const std::int64_t> ids);

/// Of the faces that one hex of each part has alone those on the skin or between volumes: of all ranks, everywhere.
std::vector<SkinFace> skin_of_all(Ranks& ranks, std::vector<SkinFace> open, std::vector<SkinFace> walls);

}  // namespace hextwist
