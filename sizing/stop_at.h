// `stop_at other`: a target that keeps away from elements beside the hexes which are not cut.
#pragma once

#include <string>
#include <vector>

#include "hextwist/sizing/request.h"

namespace hextwist {

/// The request for what of its target lies at least so many layers of hexes away from edges that are not to be cut
/// (refine/others.h): 1, its hexes, faces, edges or nodes have no node of such an edge; 2, none of a hex that has one;
/// ... Says what was left out. Precondition: it has a target. Throws Error when nothing is left, and for the whole
/// model, which is cut evenly or not at all.
Request away_from_others(const MeshedModel& input, Request request, int layers, std::vector<std::string>& notices);

}  // namespace hextwist
