// What a pass does to elements beside the hexes (mesh/others.h): quads that are faces of cut hexes and lines that are
// their edges are cut along; an element of any other kind keeps its edges, and so do the hexes that share them.
#pragma once

#include <cstdint>
#include <span>

#include "hextwist/mesh/association/association.h"
#include "hextwist/mesh/others.h"
#include "hextwist/refine/split.h"

namespace hextwist {

/// A cut that another element stands in the way of.
class BlockedByOther : public Error {
 public:
  using Error::Error;
};

/// Edges that no pass may cut: those of tetrahedra, pyramids, wedges, triangles, elements with middle nodes, and of
/// quads that are no face of a hex. Points and connectors have none.
struct RigidEdges {
  std::vector<Edge> edges;     ///< ascending, each once
  std::vector<Index> element;  ///< per edge: the first that has it
};
RigidEdges rigid_edges(const Mesh& mesh);

/// Throws BlockedByOther where the codes of a pass (split.h) cut an edge that is to stay: names the hex, the edge's
/// nodes, and the element with its kind, id and block.
void check_others(const Mesh& mesh, const SplitTable& table, std::span<const std::uint16_t> codes);

/// The other elements after a pass: those of before, with the pieces of quads and lines where these were. Pieces lie as
/// the whole did: quads turn the same way, lines go on from their first node to their last. Precondition:
/// check_others(). points, hexes: of the mesh after the pass.
OtherElementsPtr carried_others(const Mesh& before, const Split& split, std::span<const Vec3> points,
                                std::span<const Hex> hexes);

/// These nodes (in any order) and those of quads and lines in the mesh that lie inside volumes, ascending: moving them
/// would bend what was flat. Those on curves and surfaces may slide.
std::vector<Index> with_inner_nodes(const Mesh& mesh, const Association& association, std::vector<Index> nodes);

}  // namespace hextwist
