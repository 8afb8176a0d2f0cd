// What reading and writing of OpenFOAM's polyMesh share.
#pragma once

#include "hextwist/io/listing.h"

namespace hextwist::io {

/// The patch of boundary faces in no side set.
inline constexpr const char* default_patch = "defaultFaces";
/// Entries of a patch that is nothing special.
inline constexpr const char* plain_patch = "type patch;";

struct FoamFace {
  Quad cycle;  ///< turns out of its owner
  Index owner, neighbour = -1;
  Side side;
};

struct FoamPatch {
  std::string own_name;  ///< as entries of others call it
  std::string name;      ///< in the file
  std::string entries;   ///< but for those that say which faces it has
  std::vector<FoamFace> faces;
};

/// Puts the faces of cyclic patches in the order that OpenFOAM wants: of each pair those of the first are in order,
/// those of the other follow. Pairs of which one does not repeat the other become ordinary patches, which is told.
void order_cyclic_patches(const Mesh& mesh, std::vector<FoamPatch>& patches, std::vector<std::string>& notices);

/// constant/polyMesh beside case.foam.
std::filesystem::path poly_mesh_of(const std::filesystem::path& file);

}  // namespace hextwist::io
