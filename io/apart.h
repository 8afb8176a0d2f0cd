// Mesh files that libraries of others read (CGNS, MED, all of HDF5), in the program hextwist_read_mesh where there is a
// fence (base/fence.h).
//
// The program does all of the reading and hands over a MeshFile; what comes back is checked, since a damaged file may
// have led it astray.
#pragma once

#include <iosfwd>

#include "hextwist/base/fenced.h"
#include "hextwist/io/format.h"

namespace hextwist::io {

/// A reader of such files. folder: Fence::folder.
using ReadHere = MeshFile (*)(const std::filesystem::path& file, const std::filesystem::path& folder);

/// Reads by `here`, or by the program, which knows it as `word`. more_bytes: of files that it names itself, which
/// count for the limits.
MeshFile read_apart(const Fence& fence, const std::string& word, ReadHere here, const std::filesystem::path& file,
                    std::uintmax_t more_bytes = 0);

/// The program's part.
void serve_mesh(const FencedJob& job);

/// All of a mesh file but for results and what only Abaqus, Gmsh and OpenFOAM have.
void put_mesh_file(std::ostream& out, const MeshFile& file);
/// Throws Error where it is cut short, or names what is not there.
MeshFile take_mesh_file(const Bytes& bytes);

}  // namespace hextwist::io
