// Mesh files. Hexes only: a file with any other volume element is refused, naming the first one.
//
//   .msh        Gmsh 2.2 and 4.1, ASCII and binary; entity tags kept
//   .e .exo .g .gen   Exodus II; blocks, node sets, side sets, names, fields of the last time step
//   .vtk        VTK legacy, ASCII and binary (read only)
//   .vtu        VTK XML: fields, ids, owners, blocks, quality as point and cell data; all sets kept
//   .inp        Abaqus: C3D8*, *NSET, *ELSET, *SURFACE
//   .mesh       MEDIT (Medit/Mmg/Hexotic), ASCII
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hextwist/mesh/association.h"
#include "hextwist/mesh/mesh.h"

namespace hextwist {

/// What a mesh file says: the mesh, which entities its tags name as owners (partial, unchecked; empty() when the
/// format has none), and remarks, one line each ("dropped 40 quads that are no side of a hex", ...).
struct MeshFile {
  Mesh mesh;
  Association tags;
  std::vector<std::string> notices;
};

/// Reads by extension (case ignored). Node ids are those of the file where it has any, nodes sorted by id; hex ids
/// likewise, except for Gmsh, where elements of all kinds share one numbering: hexes are counted from 1.
/// Throws Error with file, line (text) or section, and id: missing, unreadable, truncated, not finite, other elements.
MeshFile read_mesh(const std::filesystem::path& file);

struct WriteOptions {
  bool binary = true;         ///< where the format has both
  int gmsh_version = 41;      ///< 22 or 41
  bool overwrite = true;      ///< false: throw Error if the file exists
  bool write_quality = true;  ///< .vtu: shape and scaled Jacobian as cell data
};

/// Writes by extension, to a temporary name in the same folder that is renamed when complete: the file is there whole
/// or as it was. association may be null. Throws Error naming the file and the reason.
void write_mesh(const std::filesystem::path& file, const Mesh& mesh, const Association* association,
                const WriteOptions& options = {});

/// Extensions that can be read or written, for messages: ".msh .e ...".
std::string readable_extensions();
std::string writable_extensions();

}  // namespace hextwist
