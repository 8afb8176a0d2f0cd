// How the enclosing templates come about: shared by the table and by the program that optimises node places.
#pragma once

#include <memory>

#include "hextwist/refine/templates/split_table.h"

namespace hextwist {

/// How far from the box of marked (or unmarked) corners the new nodes of a template lie, along each direction that
/// leaves it: nodes on edges, inside faces, inside the hex. 1 is the opposite side of the hex.
struct Reach {
  double edge, face, inside;
};

/// Seen from the marked side, and from the unmarked side (six or seven marked corners). Precondition: the two edge
/// numbers add up to 1, as neighbours share the edges.
struct EnclosePlaces {
  Reach marked, unmarked;
};

std::shared_ptr<const SplitTable> make_enclose_table(const EnclosePlaces& places);

}  // namespace hextwist
