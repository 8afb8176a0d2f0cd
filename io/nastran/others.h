// Nastran's cards of elements beside the hexes (mesh/others.h): where their nodes stand.
#pragma once

#include "hextwist/io/nastran/nastran_internal.h"
#include "hextwist/mesh/others.h"

namespace hextwist::io {

/// A card whose fields are kept as they are but for its id and the nodes of its shape.
struct NastranOther {
  std::string_view name;
  OtherShape shape;
  std::size_t first;     ///< field of the first node, fields counted from 0 behind the name
  std::size_t property;  ///< field of the property, 0 none
  /// Nodes per element that it can have, the corners first; connectors: none, they keep all fields.
  std::array<std::size_t, 2> n_nodes;
};
/// Null for a card that is no such element.
const NastranOther* nastran_other(std::string_view name);

/// Node of the shape -> field behind the first node's: wedges have their middle nodes around and then upwards.
std::size_t nastran_place(const NastranOther& card, std::size_t n_nodes, std::size_t node);
/// Fields of connectors that name nodes, which are kept as they stand.
std::vector<std::size_t> nastran_node_fields(const NastranCard& card);
/// A card of which pieces would not have all that it says: pin flags, thicknesses that vary.
bool is_rigid_card(const NastranCard& card);

}  // namespace hextwist::io
