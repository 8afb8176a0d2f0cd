// The inputs of the benchmarks.
#pragma once

#include <filesystem>
#include <memory>

#include "hextwist/patch/refine_known.h"

namespace hextwist::bench {

/// A cube of n x n x n unit cells in one block, no CAD.
Mesh cube(int n);
/// The same on the brick that it fills: 6 surfaces.
MeshedModel cube_on_brick(int n);

/// Node marks: all nodes; those of one hex in the middle; those of a ball of a tenth of the volume of cube(n).
std::vector<std::uint8_t> mark_all(const Mesh& mesh);
std::vector<std::uint8_t> mark_one(const Mesh& mesh);
std::vector<std::uint8_t> mark_ball(const Mesh& mesh, int n);
Index middle_hex(int n);

/// A shipped model with its mesh refined uniformly, each edge in so many pieces, and complete association.
MeshedModel shipped(const char* name, int pieces);
/// The same cube as two bricks, one of them a single layer of hexes: four curves are one edge long.
MeshedModel layered_bricks(int n);
/// Eight bricks, glued to an assembly of 36 surfaces, filled by cube(n); n even.
MeshedModel glued_bricks(int n);

/// Bytes of all arrays.
std::size_t bytes(const Mesh& mesh);
std::size_t bytes(const Association& association);
/// A number that changes with any bit of points, hexes or lineage.
std::uint64_t fingerprint(const Mesh& mesh);

/// Empty where it does not exist.
std::filesystem::path data_file(const char* name);
std::filesystem::path output_file(const char* name);

}  // namespace hextwist::bench
