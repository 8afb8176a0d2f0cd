// From entities to the parts of the mesh that are to be refined.
#pragma once

#include <string>
#include <vector>

#include "hextwist/refine/lineage.h"
#include "hextwist/refine/plans/combine.h"
#include "hextwist/sizing/request.h"

namespace hextwist {

/// Throws Error unless there are targets, all of which exist; names the first that does not.
void check_targets(const MeshedModel& input, const Target& target);

/// The average of the corners of a hex.
Vec3 centroid(const Mesh& mesh, Index hex);
std::vector<Vec3> centroids(const Mesh& mesh);
std::vector<Vec3> centroids(const Mesh& mesh, std::span<const Index> hexes);

/// True when the targets are all volumes of the model: which asks for uniform refinement.
bool is_whole_model(const MeshedModel& input, const Target& target);

/// Hexes of a solid target, ascending. Throws Error when there are none.
std::vector<Index> solid_target(const MeshedModel& input, const Target& target);

/// Hexes of any target together with its layers (Target::depth), ascending: a solid target's by itself when there is
/// no depth, the first layer around anything else. Throws Error when there are none.
std::vector<Index> region_target(const MeshedModel& input, const Target& target, std::vector<std::string>& notices);

/// Nodes, edges and faces of any other target: of a curve its mesh edges, of a surface its mesh faces, each with all
/// nodes on it. CAD entities that no node lies on are named in a notice. Throws Error when there is nothing at all.
CombinationTarget sub_element_target(const MeshedModel& input, const Target& target, std::vector<std::string>& notices);

/// What a sub-element target has become after a pass: children of its edges and faces, and all nodes on it.
CombinationTarget carried_target(const CombinationTarget& target, const Lineage& lineage, const Mesh& refined);

}  // namespace hextwist
