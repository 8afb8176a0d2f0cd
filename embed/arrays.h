// A mesh from the arrays of a program that has one.
#pragma once

#include "hextwist/embed/c.h"
#include "hextwist/io/io.h"

namespace hextwist {

/// The mesh, what the arrays say about owners, and remarks (quads on surfaces that are no side of a hex, ...). All is
/// copied. Throws Error naming the array and position: negative counts, missing arrays, nodes and hexes that do not
/// exist, ids that do not ascend, members of sets that are no side, ...
MeshFile mesh_from_arrays(const hextwist_arrays& arrays);

}  // namespace hextwist
