// One file of a mesh that is split into several: Exodus II with what Nemesis adds to it (name.e.N.i), or .msh as Gmsh
// splits meshes (name_1.msh, name_2.msh, ...), which says less: nodes of the same id are one node.
//
// Each part has its own hexes and all nodes of these; node and hex ids are those of the whole. Nodes and faces that
// parts share are listed in communication maps, one per neighbour, in the same order on both sides.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "hextwist/base/replacement.h"
#include "hextwist/io/extras.h"
#include "hextwist/mesh/mesh.h"

namespace hextwist {

/// How element blocks divide the hexes of a whole mesh: they may not overlap, as blocks do.
struct BlockCounts {
  std::vector<std::int64_t> hexes;  ///< per block
  std::vector<std::int64_t> own;    ///< those of them that are in its element block
  std::int64_t rest = 0;            ///< hexes in no block
};
/// sizes: of the blocks in the whole, where the mesh is a part of it; `own` and `rest` are then those here.
BlockCounts block_counts(const Mesh& mesh, std::span<const std::int64_t> sizes = {});

/// What a part has to say of the others.
struct FilePart {
  int number = 0, n_parts = 1;  ///< 0-based
  std::int64_t n_nodes = 0, n_hexes = 0, highest_id = 0;
  BlockCounts blocks;
  std::vector<std::int64_t> node_sets, side_sets;  ///< members in the whole
  /// Nodes (ascending) and sides that are another part's too; by ascending part. Sides: in the order of the ids of
  /// their nodes, the lowest first.
  struct SharedNodes {
    int part;
    std::vector<Index> nodes;
  };
  struct SharedSides {
    int part;
    std::vector<Side> sides;
  };
  std::vector<SharedNodes> nodes;
  std::vector<SharedSides> sides;
};

/// What parts have no place for of what a file says beyond its mesh, one line each.
std::vector<std::string> left_out_of_parts(const FileExtras& extras);

/// name.e.8.0: as many digits as the number of parts has. name_1.msh of name.msh and the number 0.
std::filesystem::path part_name(const std::filesystem::path& name, int n_parts, int number);

/// Writes a part as Exodus to the temporary file of `to`, which the caller commits. The mesh has all groups of the
/// whole, in the same order, with what the part has of them. Throws Error naming the file.
void write_part(const Replacement& to, const Mesh& mesh, const FilePart& part, std::vector<std::string>& notices);

/// What a file says about the whole that it is a part of. n_parts 0: it is none.
struct PartHead {
  int n_parts = 0;
  std::int64_t n_nodes = 0, n_hexes = 0;  ///< 0: that is not said
  auto operator<=>(const PartHead&) const = default;
};
/// Throws Error naming the file.
PartHead read_part_head(const std::filesystem::path& file);
/// Are parts of that name files of Gmsh? All others are Exodus.
bool is_gmsh_part(const std::filesystem::path& file);
/// Which part of how many a .msh file is. n_parts 0: Gmsh has not split it.
struct GmshPartHead {
  int n_parts = 0;
  int number = -1;  ///< from 0; -1: its hexes are in several
};
GmshPartHead read_gmsh_part_head(const std::filesystem::path& file);

}  // namespace hextwist
