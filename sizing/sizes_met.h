// Sizes that are met already: nothing is to be cut, and so nothing made.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hextwist/sizing/report.h"
#include "hextwist/sizing/request.h"

namespace hextwist {

/// What is to be said of a request for sizes by which no hex of the input is too large, nor any edge along its target
/// too long. Nothing where there is something to cut, to make coarser or to number. Throws as the passes do.
std::optional<SizeReport> sizes_met(const MeshedModel& input, const Request& request,
                                    std::vector<std::string>& notices);

}  // namespace hextwist
