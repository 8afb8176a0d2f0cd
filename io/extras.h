// What a mesh file says beyond a mesh and its owners, kept for files of the same format.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "hextwist/base/export.h"

namespace HEXTWIST_API hextwist {

/// A card of an Abaqus file that is no mesh (a section, a material, a step, a boundary condition), with the lines that
/// belong to it, and what of the mesh it names. Its text stays as it was but for those names.
struct AbaqusCard {
  /// A name or number in the text that means a part of the mesh; it is written as that part is then called.
  struct Reference {
    /// What it means.
    enum Kind {
      block,     ///< by name, an element set
      node_set,  ///< by name
      side_set,  ///< by name, a surface
      node,      ///< by number
      hex,       ///< by number
      faces      ///< an element set and the label of a face ("A, P2"): a side set, written by faces of elements
    };
    Kind kind;          ///< what `id` is an id of
    std::int64_t id;    ///< as the mesh has it
    std::size_t begin;  ///< where it stands in the text, 0-based
    std::size_t end;    ///< behind its last character
    bool by_keyword;    ///< named in the keyword's line: the whole card is about it, else the line is
  };
  std::string text;                   ///< all its lines, with their line ends
  std::vector<Reference> references;  ///< ascending
  std::string where;                  ///< file and line
};

/// Nodes of one entity of a Gmsh file, each with its image on another: a periodic boundary.
struct PeriodicPairs {
  int dim = 0;                                     ///< of both entities: 0 point, 1 curve, 2 surface
  int entity = 0;                                  ///< its tag in the file
  int of = 0;                                      ///< tag of the entity that it repeats
  std::vector<double> affine;                      ///< 4 x 4, row by row: takes `of` to `entity`; may be empty
  std::vector<std::array<std::int64_t, 2>> nodes;  ///< ids, on the entity and on `of`
};

/// write_mesh() writes them again, in the file's own format and as far as they still fit the mesh; a notice says what
/// does not.
struct FileExtras {
  /// Abaqus: the type of the hexes of a block, by its id; at 0 that of all others, C3D8 where there is none.
  std::map<int, std::string> element_types;
  /// Nodes of the hexes of a block, by its id: 8, 20 or 27; at 0 those of all others, 8 where there is none.
  std::map<int, int> nodes_per_hex;
  std::map<int, std::string> patches;  ///< OpenFOAM: entries of a patch ("type wall;"), by its side set
  /// SPECFEM3D: what a material is, by its block: its line of nummaterial_velocity_file but for the number.
  std::map<int, std::string> materials;
  /// CGNS: kinds of boundary conditions ("BCWall"), by side set.
  std::map<int, std::string> boundary_types;
  std::string heading;                  ///< Abaqus: lines below *HEADING
  std::vector<AbaqusCard> cards;        ///< Abaqus: those that are no mesh, in the order of the file
  std::vector<int> node_surfaces;       ///< Abaqus: node sets that are *SURFACE, TYPE=NODE, ascending
  std::vector<PeriodicPairs> periodic;  ///< Gmsh: boundaries that repeat others
  /// Gmsh: node sets that are physical groups of curves, and their tags there.
  std::map<int, int> curve_groups;

  /// Does the file say nothing beyond its mesh?
  bool empty() const {
    return element_types.empty() && nodes_per_hex.empty() && patches.empty() && materials.empty() &&
           boundary_types.empty() && heading.empty() && cards.empty() && node_surfaces.empty() && periodic.empty() &&
           curve_groups.empty();
  }
};

}  // namespace hextwist
