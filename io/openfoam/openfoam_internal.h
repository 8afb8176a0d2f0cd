// What reading and writing of OpenFOAM's polyMesh share.
#pragma once

#include "hextwist/io/listing.h"

namespace hextwist::io {

/// The patch of boundary faces in no side set.
inline constexpr const char* default_patch = "defaultFaces";

/// constant/polyMesh beside case.foam.
std::filesystem::path poly_mesh_of(const std::filesystem::path& file);

}  // namespace hextwist::io
