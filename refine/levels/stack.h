// A levelled refinement from its marks: one trisecting pass per level, each of regular cells of the level before alone.
//
// The result stands level by level: first the hexes of the base that were not cut, then what pass 1 made and pass 2
// left, and so on; nodes likewise. Within a level, hexes are in the order of their cells. So meshes of the same base
// can be compared by merging lists (match.h), and nothing needs to be looked up by coordinates.
#pragma once

#include <memory>
#include <utility>

#include "hextwist/mesh/meshed_model.h"
#include "hextwist/refine/levels/cells.h"
#include "hextwist/refine/lineage.h"
#include "hextwist/refine/place.h"

namespace hextwist {

/// What one pass did: enough to know its nodes and hexes again, and to interpolate.
struct LevelPass {
  CellMarks marks;                          ///< that it was made from
  Lineage lineage;                          ///< from the mesh before to that after; without `parent`
  std::vector<CellNumber> cell;             ///< per cut hex (lineage.hexes): the cell that it was; ascending
  std::vector<Hex> corners;                 ///< per cut hex: its nodes
  Index n_kept = 0;                         ///< hexes of the mesh after it that are no children: these come first
  Index n_hexes = 0;                        ///< of the mesh after it
  Index n_nodes = 0;                        ///< likewise
  std::vector<OffOwner> off_nodes;          ///< what repair_children() had to leave off its curve or surface
  bool is_repaired = false;                 ///< it had something to do
  std::shared_ptr<const MeshedModel> mesh;  ///< after it, without fields; null where nobody asked to keep it
};
/// Shared by all states that have the same marks up to there.
using LevelStack = std::vector<std::shared_ptr<const LevelPass>>;

struct StackOptions {
  /// Keep the mesh after every pass, the last one too: a later stack whose marks are the same up to some level begins
  /// there instead of at the base.
  bool keep_meshes = false;
  /// Nodes of the base that repairing inverted children must not move.
  std::span<const Index> fixed = {};
  SmoothProgress progress = {};  ///< as in repair_children()
  std::span<const std::string> keep_jumps = {};
  std::span<const int> repeated_surfaces = {};  ///< likewise
  bool topology_only = false;                   ///< nothing is placed or repaired
};

struct LevelledMesh {
  MeshedModel mesh;  ///< ids and groups as carry() makes them; no fields
  LevelStack stack;
};

/// Guarantees:
///  1. mesh and stack depend on base and marks alone, to the bit, not on `previous` or the number of threads;
///  2. no hex but a regular cell is ever cut, so a hex has at most one closure among its ancestors: its parent;
///  3. one level: connectivity, places and ids of the trisecting pass of these marks;
///  4. nodes of cells that two sets of marks have in common are at the same places, bit for bit, unless repairing
///     inverted children moved them.
/// marks: graded (gradation.h). previous: an earlier stack on the same base, may be empty.
/// Throws Error when there are too many nodes or hexes or too little memory; what check_interrupt() throws.
LevelledMesh build_levels(const MeshedModel& base, const LevelMarks& marks, const LevelStack& previous = {},
                          const StackOptions& options = {});

/// What every hex of a levelled mesh is.
struct LevelPieces {
  std::vector<Index> first;       ///< hexes that pass k made are first[k] .. first[k + 1] - 1, those of the base [0]
  std::vector<CellNumber> cell;   ///< per hex: the cell, of level k - 1, that pass k cut; of the base: itself
  std::vector<std::uint32_t> at;  ///< per hex: code << 16 | place among the children of that code; of the base: 0

  Index n_hexes() const { return static_cast<Index>(cell.size()); }
  Index n_levels() const { return static_cast<Index>(first.size()) - 1; }  ///< passes and 1
  /// The leaf that a hex of level-block k is or is a piece of: level and number.
  struct Leaf {
    int level;
    CellNumber cell;
    auto operator<=>(const Leaf&) const = default;
  };
  Leaf leaf(int block, Index hex) const;
};
LevelPieces level_pieces(const LevelStack& stack, Index n_base_hexes);

}  // namespace hextwist
