// How a mesh comes to several ranks, each with a part of it.
#pragma once

#include <filesystem>
#include <optional>

#include "hextwist/mesh/meshed_model.h"
#include "hextwist/parts/mpi/ranks.h"
#include "hextwist/parts/partition.h"

namespace hextwist {

/// A rank's part of a mesh, with its ids.
struct RankPart {
  MeshedModel own;
  bool has_cad = false;                                         ///< false: the model is the skin of the whole mesh
  std::int64_t n_hexes = 0, highest_node = 0, highest_hex = 0;  ///< of the whole, nodes of no hex too
  /// What the file said of the whole, the same on all ranks; null: nothing.
  std::shared_ptr<const FileResults> results;
};

/// Fills in what is said of the whole.
void count_whole(Ranks& ranks, RankPart& part);

/// Reads a mesh on its CAD, or on its own skin where there is none. Parts that were split are read by ranks side by
/// side, each its own, and stay where they are when there are as many as ranks and `by` is empty. So is a file that can
/// be read in slices (io/slice.h), but for SCOTCH. All else, and what lies on CAD, is read by the first rank and sent
/// out. say: called on all ranks. Throws Error on all ranks: "rank 3:
/// ...".
RankPart read_in_ranks(Ranks& ranks, const std::filesystem::path& mesh, const std::filesystem::path& cad,
                       std::optional<PartitionBy> by, const Say& say);

/// The same of parts that ranks have already, with their ids; they stay where they are.
RankPart take_in_ranks(Ranks& ranks, Mesh own, const std::filesystem::path& cad,
                       const std::function<void(const std::string&)>& say);

}  // namespace hextwist
