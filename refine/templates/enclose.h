// The enclosing pass: parallel hex sheet operations of Harris, Benzley and Owen, sections 5.1 to 5.3.
//
// A twist plane that wraps a set of marked nodes cuts every edge with exactly one marked end. A code of this pass is
// a mask of 8 bits, one for each corner of a hex: bit set, node marked. Templates exist for
//
//   1 node (c) 4 hexes    2 nodes on an edge (b) 3 hexes    4 nodes on a face (a) 2 hexes    8 or 0: 1 hex
//   7 nodes, 6 nodes all but those of an edge: (c) and (b) seen from the unmarked side, so that concave places of a
//   region need no filling
//
// All else has to grow first (close_enclosure()), or to be enclosed in parts, one after the other (enclosable_part()).
#pragma once

#include <memory>
#include <span>

#include "hextwist/mesh/topology.h"
#include "hextwist/refine/templates/split_table.h"

namespace hextwist {

/// Where a cut edge is cut: half-way (figure 10), or at a third of its length from the marked node (figure 13, the
/// first step of the combination).
enum class EncloseAt { half, third };

std::shared_ptr<const SplitTable> enclose_table(EncloseAt at);

/// Cut edges at any fraction of their length from the marked node, 0.01 .. 0.99: layers of a chosen thickness.
std::shared_ptr<const SplitTable> enclose_table(double from_marked);

/// Corners that make a box (1, 2, 4 or all 8), or none. When a hex is split by one such marking, carried marks of
/// another make such markings again on all its children (a test tries all), which plan_eight() relies on. This
/// does not hold for the complements, 6 or 7 corners.
bool is_box_marking(int corner_mask);

/// A marking of the corners that has a template: a box, or all but a box.
bool has_enclosing_template(int corner_mask);

/// Codes from node marks. Hexes with all or no corner marked get 0.
std::vector<std::uint16_t> enclose_codes(std::span<const Hex> hexes, std::span<const std::uint8_t> marked);

/// Adds marks until every hex has a template: in each round every hex without one takes its smallest superset that
/// has (of several the one whose unmarked nodes have the highest numbers), all hexes at once, so the result depends on
/// the mesh alone. Returns the number of nodes added. Growth may run along whole faces of a part.
Index close_enclosure(std::span<const Hex> hexes, std::span<std::uint8_t> marked);

/// The same hex by hex, but where that takes more than `limit` nodes the marks stay as they were.
Index close_enclosure_nearby(const Mesh& mesh, std::span<std::uint8_t> marked, Index limit);

/// The part of a marking to enclose first: all of it where every hex has a template. Elsewhere (where curves meet, say:
/// three or four marked corners of a hex that are no face) the nodes in which most of its marked edges meet; of
/// disconnected pieces the one with the lowest node. Once these are enclosed the rest is in different hexes, and
/// can follow. Nothing marked is enclosed twice, nothing else is enclosed at all, and an edge between two parts gets a
/// node from each side. Never empty unless `marked` is; the result depends on the mesh alone.
std::vector<std::uint8_t> enclosable_part(std::span<const Hex> hexes, std::span<const std::uint8_t> marked);

}  // namespace hextwist
