// What node sets are meant to hold. A file gives a set as nodes alone, and where a part is one hex thick these say less
// than who made the set meant: the nodes of both faces of a plate are all nodes of the plate.
//
// Entity E is a curve, a surface or a volume all of whose nodes (those on its rim too) are in the set.
//  1. E has nodes of its own, which no entity of lower dimension owns: it is meant.
//  2. E has none. A volume is not meant where surfaces that are meant by 1 have all its nodes: they are the two faces
//  of
//     a plate. A surface is not meant where such surfaces have all its nodes, or where it is part of a ring of such
//     surfaces with two rims: these are meant. A curve is not meant where such curves or surfaces have its ends, or it
//     leads across such a ring. Else E is meant.
//  3. A set that is made of entities by name is meant to hold those.
// What a refinement does with it: refine/node_sets.h.
#pragma once

#include <string>
#include <vector>

#include "hextwist/mesh/association/association.h"

namespace hextwist {

/// The curves, surfaces and volumes that a set is meant to hold by 1 and 2, ascending. left_out: volumes and rings that
/// are not meant by 2 although all their nodes are there.
std::vector<Owner> meant_entities(const Mesh& mesh, const Association& association, const std::vector<Index>& nodes,
                                  std::vector<Owner>* left_out = nullptr);

/// Those of some entities (ascending) all of whose nodes are in the list.
std::vector<Owner> held_entities(const Mesh& mesh, const Association& association, const std::vector<Index>& nodes,
                                 const std::vector<Owner>& entities);

/// Tells of those.
std::string left_out_text(const NodeSet& set, const std::vector<Owner>& meant, const std::vector<Owner>& left_out);

/// Fills in NodeSet::meant where it is empty. Says of each set what was left out.
void find_meant_entities(Mesh& mesh, const Association& association, std::vector<std::string>& notices);

}  // namespace hextwist
