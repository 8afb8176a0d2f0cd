// Which rank each hex of a mesh in parts goes to, and how it gets there.
#pragma once

#include <span>
#include <vector>

#include "hextwist/mesh/meshed_model.h"
#include "hextwist/parts/mpi/ranks.h"
#include "hextwist/parts/partition.h"

namespace hextwist {

/// Per hex of this rank's part, which has its ids. weights: per hex, what it counts for; empty: 1. Throws Error on all
/// ranks when there are fewer hexes than ranks. Not by SCOTCH.
std::vector<int> share_out(Ranks& ranks, const Mesh& part, PartitionBy by, std::span<const std::int64_t> weights = {});

/// Sends hexes to their ranks, with all that is known of them. The parts of all ranks have the same groups and fields.
MeshedModel moved(Ranks& ranks, MeshedModel part, std::span<const int> rank_of_hex);

/// Sends all hexes to the first rank. home: there, per hex the rank that had it. The other ranks are left with nothing,
/// not even groups and fields, which may have gone when they get hexes again. highest_node: id, of the whole; where no
/// hex has that node one of no hex stands for it, so that new nodes come behind.
MeshedModel at_first(Ranks& ranks, MeshedModel part, std::vector<int>& home, std::int64_t highest_node = 0);

/// Says how many times the average the largest part has, and returns it. n: hexes of this rank's.
double load_of(Ranks& ranks, std::int64_t n, const Say& say);
/// More than this is shared out again.
inline constexpr double fair = 1.2;

/// Gives the parts of all ranks the groups and fields that any of them has.
void share_heads(Ranks& ranks, Mesh& part);

}  // namespace hextwist
