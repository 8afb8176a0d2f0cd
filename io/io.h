// Mesh files. Hexes of first or second order; other elements (mesh/others.h) come along where the format says so here
// (.inp .e .vtk .vtu .msh), else a file with any other volume element is refused, naming the first one.
//
//   .msh        Gmsh 2.2 and 4.1, text and binary (1.0 is read as well)
//               Entity tags are owners. Physical groups: 3D are blocks, 2D side sets, 1D and 0D node sets; a node set
//               is written as a group of curves if it is exactly their nodes, else of points. Where a set takes part of
//               an entity, the part becomes an entity of its own; the section $HextwistParts behind the elements, which
//               others skip, says of what. $Periodic is carried through refinement. Version 2.2 says owners by elements
//               only: nodes on an entity without elements lose theirs.
//   .e .exo .g .gen   Exodus II; blocks, node sets, side sets, names, ids; all variables at all times (the fields are
//               those of the last), distribution factors, attributes, properties, records (results.h)
//               Blocks that overlap or leave hexes out: the smallest block of a hex is its element block, blocks that
//               lost hexes that way are written whole as element sets. No owners.
//   .vtk        VTK legacy, text and binary (read only)
//   .vtu        VTK XML: ids, owners, blocks, quality and fields as point and cell data, sets as field data
//   .inp        Abaqus and CalculiX: elements with eight corners, whose types are kept by blocks, *NSET, *ELSET,
//   *SURFACE;
//               parts and instances are read, their sets are named instance.set. All other cards (sections, materials,
//               steps, ...) are kept, with the sets that they name (FileExtras). No owners, no fields
//   .med        MED (SALOME, code_aster): groups, fields; needs libmedc
//   .cgns       CGNS: zones joined where the file says so, sections, boundary conditions, solutions; needs libcgns
//   .mfem       MFEM's mesh, also as .mesh: attributes and their sets. No ids, no node sets, no fields
//   .xdmf       XDMF with numbers in an HDF5 file beside it; needs libhdf5
//   .vtkhdf     VTKHDF: what .vtu has; needs libhdf5
//   .bdf .nas   Nastran bulk data: properties are blocks, SET1 node sets, PLOAD4 side sets; other cards are left out
//   .unv        I-deas universal: groups
//   .foam       OpenFOAM: constant/polyMesh beside it, text; patches and zones
//   .k .key     LS-DYNA: parts and sets of solids are blocks, sets of nodes and segments
//   .cdb        ANSYS archives: materials and components are blocks, components node sets, those of SURF154 side sets
//   .re2        Nek5000, NekRS, binary: groups are blocks, conditions on sides side sets. Nodes are merged by place
//   .specfem    SPECFEM3D: mesh_file and the others beside it; materials are blocks, files of sides side sets
//   .mesh       MEDIT (Medit, Mmg, Hexotic), text; references are blocks, side sets and node sets. No ids, no fields
//
// What a format has no room for (names in Abaqus, overlapping groups in MEDIT) stands in comments that other programs
// skip, so that a file of ours comes back as it was. Coordinates and fields come back bit for bit in every mode, but
// for .inp: CalculiX reads 20 characters of a number, so small coordinates are rounded in the 14th digit or later, and
// those below 1e-99 are 0. Where a format has no other elements, quads, lines and points are sides, edges and members
// of sets; those that are not, and triangles, are dropped with a notice.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "hextwist/base/fence.h"
#include "hextwist/io/extras.h"
#include "hextwist/mesh/association/association.h"
#include "hextwist/mesh/mesh.h"
#include "hextwist/mesh/second_order/middle_nodes.h"
#include "hextwist/mesh/second_order/second_order.h"

namespace HEXTWIST_API hextwist {

/// What a mesh file says: the mesh, which entities its tags name as owners (partial, unchecked; empty() when the
/// format has none), and remarks, one line each ("dropped 40 quads that are no side of a hex", ...).
struct MeshFile {
  Mesh mesh;                         ///< as the file has it, but sorted by id
  Association tags;                  ///< ids are those of the file: associate() checks them against a model
  std::vector<std::string> notices;  ///< empty: there is nothing to remark
  FileExtras extras;                 ///< for WriteOptions::extras
  /// Of a file of second order: the mesh has the corners only, and this says where the other nodes were.
  MiddleNodes middles;
};

/// Reads by extension (case ignored). Node and hex ids are those of the file where it has any (in .msh the tags of
/// elements, which count other elements too), nodes and hexes sorted by id; a notice says where they are not.
/// Groups are sorted by id. The hexes are as the file has them: an inside-out mesh stays so (repair_orientation()).
/// Throws Error with file, line (text) or byte, and id: missing, unreadable, truncated, not finite, other elements.
/// format: "gmsh", "exodus", "genesis", "abaqus", "medit", "vtk", "med", "nastran", "unv", "openfoam", "lsdyna",
/// "ansys", "nek", "specfem", "cgns", "mfem", "xdmf" or "vtkhdf", whatever the file's name is. Default: by extension,
/// and where that is none of those below by content, which tells Exodus (out.e-s002, mesh.e.4.0). fence: where files in
/// the form of HDF5 are read, by a library that damaged files can crash. Default: in this process.
MeshFile read_mesh(const std::filesystem::path& file, std::string_view format = {}, const Fence& fence = {});

struct FilePart;

/// How a file is written; what its format does not have is ignored.
struct WriteOptions {
  bool binary = true;                  ///< where the format has both
  int gmsh_version = 41;               ///< 22 or 41
  bool overwrite = true;               ///< false: throw Error if the file exists
  bool write_quality = true;           ///< .vtu: shape and scaled Jacobian as cell data
  bool groups_only = false;            ///< .msh: only elements in physical groups, as Gmsh writes them by default
  const Model* model = nullptr;        ///< .msh: the CAD of the association; lines then run as its curves do
  const FileExtras* extras = nullptr;  ///< of the file that the mesh, or what it was refined from, was read from
  std::string format = {};             ///< as read_mesh() takes it; empty: by extension
  /// 2: with middle nodes, placed on `model` (second_order.h); formats without them refuse. 0: as `extras` say of the
  /// blocks, which formats without middle nodes tell of.
  int order = 0;
  int nodes_per_hex = 0;  ///< of order 2: 20 or 27; 0: as `extras` say, else what the format has, 20 where it has both
  const Model* skin = nullptr;          ///< what the mesh lies on where `model` is null: for middle nodes
  const SecondOrder* second = nullptr;  ///< made by write_mesh() itself
  const FilePart* part = nullptr;       ///< .msh 4.1: one of the files that a mesh is split into (file_part.h)
};

/// Writes by extension, to a temporary name in the same folder that is renamed when complete: the file is there whole
/// or as it was. association may be null. Returns what the format could not keep, one line each. Throws Error naming
/// the file and the reason.
std::vector<std::string> write_mesh(const std::filesystem::path& file, const Mesh& mesh, const Association* association,
                                    const WriteOptions& options = {});

/// Extensions that can be read, for messages: ".msh .e ...".
std::string readable_extensions();
/// Extensions that can be written, likewise.
std::string writable_extensions();

}  // namespace hextwist
