// The call for programs that have their mesh in parts, one per process: a part in, a part and who shares its nodes out.
//
// Hexes, nodes, ids, groups and fields are those that a single process would have made of the whole mesh, whatever the
// parts were. Link hextwist::in_ranks. docs/distributed.md, "From a program".
#pragma once

#include <mpi.h>

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "hextwist/mesh/association/association.h"
#include "hextwist/mesh/mesh.h"

namespace hextwist {

/// A node that other processes have too. Those with the same (rank, there) are the same node; that rank, the lowest
/// that has it, is the root of the star.
struct SharedNode {
  Index node = -1;   ///< of this part
  int rank = 0;      ///< the lowest rank that has it; below the own one
  Index there = -1;  ///< its number in the part of that rank
};

/// One process' part of a mesh.
struct MeshPart {
  Mesh mesh;                       ///< its own hexes and all nodes of these; ids are those of the whole
  Association association;         ///< of its nodes, edges and faces; given parts need none
  std::vector<SharedNode> shared;  ///< ascending by node; given parts need none
};

struct PartsOptions {
  std::filesystem::path cad;  ///< read by every rank; empty: the skin of the whole mesh is the model
  int n_rings = 6;            ///< of others' hexes that each part begins with
  bool rebalance = true;      ///< hexes move to other ranks where the largest part ends above 1.2 times the average
  std::function<void(const std::string&)> say;  ///< lines about what was done, on rank 0
};

/// Arrays of another program as the mesh of a part. points: 3 per node; hexes: 8 per hex, positions among the points,
/// in the order of VTK, Exodus and Gmsh; ids: those of the whole mesh, from 1, in any order, each once. Nodes and hexes
/// of the result ascend by id. Throws Error where sizes do not fit, a node is not there or an id occurs twice.
Mesh mesh_of_arrays(std::span<const double> points, std::span<const Index> hexes,
                    std::span<const std::int64_t> node_ids, std::span<const std::int64_t> hex_ids);

/// Refines the mesh whose parts the ranks of a communicator have, by commands like "refine hex 7 8" (ids of the whole).
/// Called by all ranks, with the same commands and options; a rank may have no hexes. On CAD the first rank needs
/// memory for the whole input. Throws Error on all ranks: "rank 3: ...".
MeshPart refine_parts(MPI_Comm communicator, MeshPart part, std::span<const std::string> commands,
                      const PartsOptions& options = {});

}  // namespace hextwist
