// Flat surfaces paved with quads by the program gmsh.
#pragma once

#include <filesystem>

#include "hextwist/mesh/fill/fill.h"

namespace hextwist {

/// Where the program gmsh is; empty: it is not installed.
std::filesystem::path find_gmsh();

/// Paves by running that program, within limits of time and memory, in a process of its own: a crash there is an Error
/// here. It is told of nothing but the polygons, so it reads no file of the user. Null where the path is empty.
QuadMesher paver_by_gmsh(std::filesystem::path program);

}  // namespace hextwist
