// A mesh that can be refined and coarsened again and again: a base mesh and the cells of it that are cut.
//
//   Forest forest = plant(base);                            // nothing cut: its mesh is the base
//   LevelStep step = change(forest, *base, wishes(forest, flags));
//   LevelStep next = change(step.forest, step.mesh, wishes(step.forest, more_flags));
//
// Everything is values: undo is keeping the forest and mesh of before; they share what they have in common.
#pragma once

#include <string>

#include "hextwist/refine/levels/handed.h"
#include "hextwist/refine/levels/match.h"
#include "hextwist/refine/levels/mirror.h"

namespace hextwist {

/// What was made of a forest's marks, and the order in which its mesh is handed out: ascending ids, while levelled
/// meshes stand level by level.
struct GrownForest {
  LevelMarks marks;                                ///< wished and forced
  HandedHexes hexes;                               ///< of the mesh that is handed out
  std::int64_t next_node_id = 0, next_hex_id = 0;  ///< ids that were never given

  /// Level by level; left out where the mesh came about in a patch (with_stack() makes it).
  bool has_stack = false;
  LevelStack stack;
  LevelPieces pieces;
  /// Per place of the mesh that is handed out: the place level by level. Empty: the same.
  std::vector<Index> node_order, hex_order;
};

/// The mesh of a forest is determined by base and wished marks but for ids and order, in which what was there before
/// comes before what is new.
struct Forest {
  std::shared_ptr<const MeshedModel> base;
  LevelMarks wished;  ///< closed: with a cell its parent is wished too. Forced cells are not among them
  std::shared_ptr<const GrownForest> grown;                ///< null where its mesh came about otherwise: see grown()
  std::shared_ptr<const CompressedRows> base_corners;      ///< node_corners() of the base; made when first needed
  std::shared_ptr<const std::vector<int>> inner_surfaces;  ///< inner_surfaces() of the base; made when first needed
  std::shared_ptr<const Mirror> mirror;  ///< marks go from one side of its pairs to the other; null: none

  bool is_bare() const { return wished.empty(); }
};
Forest plant(std::shared_ptr<const MeshedModel> base);
/// The forest in which these hexes of the base (ascending) and all that they become are cut `numsplit` times, for who
/// makes its mesh by a pass.
Forest plant(std::shared_ptr<const MeshedModel> base, std::span<const Index> hexes, int numsplit);
/// With what it grew to. Precondition where that was left out: no more than one step leads to its mesh from the base.
Forest grown(Forest forest, const std::vector<Index>& fixed = {});
/// With the stack too. Precondition: it is grown; mesh: what it handed out last.
Forest with_stack(Forest forest, const Mesh& mesh);
/// The same into `grown`; returns the mesh, level by level (ids and fields are to be set).
MeshedModel grown_mesh(Forest& forest, GrownForest& grown, const std::vector<Index>& fixed = {});
/// The forest's wishes and what gradation needs besides; keeps base_corners.
LevelMarks with_gradation(Forest& forest);
/// As for StackOptions.
std::span<const int> repeated_surfaces(const Forest& forest);
/// How often the cell that each hex of the mesh is, or is a piece of, has been cut out of others.
std::vector<std::uint8_t> levels_of(const Forest& forest);

/// Wished marks after each hex of the forest's mesh has been asked to become finer (> 0) or coarser (< 0) by so many
/// levels. change: one per hex, in the order of the mesh handed out. The rules:
///  1. finer: the regular cell that the hex is, or is a piece of, becomes 27, and these 27 each, and so on;
///  2. coarser: a wished cell is given up when no hex in it asks to stay finer than it (of pieces of one leaf the
///  finest
///     wish counts). Cells that only gradation has cut go by themselves once nobody needs them.
/// Throws Error when there is not one number per hex, or a cell would be cut more often than max_level().
LevelMarks wishes(const Forest& forest, std::span<const std::int8_t> change);
/// The same for a list of hexes, all by as many levels.
LevelMarks wishes(const Forest& forest, std::span<const Index> hexes, int change);
/// The level that each hex is to have instead, whatever was wished before: the result depends on these alone.
LevelMarks wishes_of_levels(const Forest& forest, std::span<const std::uint8_t> levels);

/// The hexes (ascending) and all others in the cells that theirs are cut out of, so many levels up.
std::vector<Index> with_siblings(const Forest& forest, std::span<const Index> hexes, int n_levels);
/// With all cells in which these lie.
LevelMarks closed(LevelMarks marks);
/// Values per hex of the mesh handed out, in the order level by level. Throws Error when there is not one per hex.
/// Precondition: it has its stack.
std::vector<std::uint8_t> by_level(const Forest& forest, std::span<const std::uint8_t> values);

struct LevelOptions {
  std::vector<std::string> extensive;  ///< hex fields that are shared out and summed up instead of copied and averaged
  std::vector<Index> fixed;            ///< nodes of the base that repairing must not move
  bool keep_meshes = false;            ///< StackOptions
  LevelStack reuse = {};               ///< a stack on the same base to begin from, instead of that of before
  SmoothProgress progress;
  std::vector<std::string> keep_jumps = {};  ///< hex fields whose jumps repairing leaves in place
  const LevelMarks* graded = nullptr;        ///< the wished marks with what gradation needs, where that is known
};

struct LevelStep {
  Forest forest;
  MeshedModel mesh;
  LevelOrigin origin;               ///< per hex of mesh: hexes of the mesh before
  std::vector<Index> old_node;      ///< per node of mesh: the same node before, -1
  Index n_forced = 0;               ///< cells that are cut for the sake of gradation alone
  bool is_repaired = false;         ///< inverted children were repaired
  std::vector<OffOwner> off_nodes;  ///< of mesh
};

/// The forest with other wishes, and its mesh. Precondition, here and above: it is grown. Guarantees:
///  1. nodes and hexes that are in both meshes keep their ids, and unless inverted children are repaired near them,
///     their bits; hexes of the base that come back have their old ids. New ones get the next ids, in the order of
///     levels;
///  2. without wishes the base comes back, array for array (fields as they are carried up);
///  3. one level on a bare forest: as one trisecting pass, ids too;
///  4. the same for any number of threads; but for ids and order the same for any way to these wishes.
/// current: the mesh that the forest handed out last, with its fields as they are now (places, groups and association
/// are not looked at; volumes are, for averages). wished: as wishes() makes them.
/// Throws as build_levels().
LevelStep change(const Forest& forest, const Mesh& current, LevelMarks wished, const LevelOptions& options = {});

}  // namespace hextwist
