// One into eight: parallel hex sheet operations on whole hexes (Harris, Benzley, Owen, sections 5.1 to 5.3).
//
// Where a region of hexes is structured, three enclosing passes at a half cut every hex of it in eight: in each
// direction every second plane of nodes is enclosed. Where sheets diverge or cross (figure 12) there are no three
// directions. What must hold is less, though: a set of nodes is wanted for each pass such that each hex of the region
// has four marked nodes on one face, or all, or none, and each edge of the region has exactly one marked end in
// exactly one pass. So the decision is about sheets, those of the region by itself:
//
//  1. sheets that cross each other go into different passes, parallel neighbours into the same one where they can: this
//     gives three passes in a structured region and some more where sheets diverge (three at an interior edge with
//     three hexes around it, and the direction along it makes four);
//  2. the sheets of a pass are crossed one by one on the way from node to node, and each changes the mark; this has a
//     meaning when every closed way in the region crosses an even number of them. A ring of an odd number of layers has
//     one too many. Such a sheet, and one that crosses itself, is cut in three instead: trisecting takes any edges;
//  3. of the two markings that a pass can have (exchange marked and unmarked) it takes the one that touches fewer hexes
//     outside: with an even number of layers planes inside suffice, with an odd number one lies on a side of the
//     region, at the boundary of the mesh where there is one.
//
// The degree of structuredness is the share of hexes of a region (hexes connected by common nodes) that none of the
// sheets cut in three runs through. A region is refined one into eight when
//  - it is at least a half (1 for structured regions);
//  - marks outside of the region, needed where a hex there has no template, are at most half as many as its nodes;
//  - it cuts no edge outside more than three times (three passes never do that; regions near each other, enclosed one
//    after the other, may come to five together);
// else all of it is trisected, one into 27. A region with nothing around it, such as a whole mesh, needs no passes: all
// its edges are halved at once, structured or not.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "hextwist/refine/lineage.h"

namespace hextwist {

/// What was found out about a region and decided.
struct EightRegion {
  Index first_hex = 0;  ///< lowest
  Index n_hexes = 0;
  bool eight = false;           ///< else 27
  std::string reason;           ///< why not eight; empty if it is
  bool alone = false;           ///< no hex outside touches it
  Index n_irregular_edges = 0;  ///< edges inside it with another number of hexes around than four
  Index n_sheets = 0;           ///< of the region by itself
  Index n_self_crossing = 0;    ///< those that cross themselves in it
  Index n_in_three = 0;         ///< those cut in three: self-crossing, or one too many around a ring
  Index n_exact = 0;            ///< hexes that no such sheet runs through: these get exactly eight children
  int n_passes = 0;
  Index n_added_nodes = 0;  ///< marks outside where a template is missing, all passes together
};

struct EightPlan {
  std::vector<EightRegion> regions;  ///< by lowest hex
  /// Hexes of regions that are alone: code 1 of uniform_table(2). Ascending.
  std::vector<Index> alone;
  /// Marks of each enclosing pass at a half, one after the other, per node of the mesh.
  std::vector<std::vector<std::uint8_t>> passes;
  /// Edges to be cut in three after that, in regions one into eight. Ascending.
  std::vector<Edge> thirds;
  /// Hexes of regions that are trisected. Ascending.
  std::vector<Index> trisected;
};

/// Decides how the hexes (ascending) are refined. Depends on the mesh alone, and only on its connectivity.
///
/// Guarantees: when the passes are done in this order with carry_marks() in between, every hex has an enclosing
/// template in each of them; hexes of trisected regions are not touched by any.
EightPlan plan_eight(const Mesh& mesh, std::span<const Index> targets);

/// Marks after a pass: a new node is marked when all nodes of the edge, face or hex that it splits are.
void carry_marks(const Lineage& lineage, std::span<const Hex> old_hexes, Index n_nodes,
                 std::vector<std::uint8_t>& marked);

/// Codes of the trisecting pass that comes last: cut are edges with both ends marked, and those that `thirds` have
/// become, which is all edges that are in a sheet with them within `region` (hexes, ascending).
std::vector<std::uint16_t> thirds_codes(const Mesh& mesh, std::span<const Index> region, std::span<const Edge> thirds,
                                        std::span<const std::uint8_t> marked);

}  // namespace hextwist
