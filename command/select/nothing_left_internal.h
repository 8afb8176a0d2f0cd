// Why a range is empty.
#pragma once

#include <string>
#include <vector>

#include "hextwist/command/select/selection.h"

namespace hextwist {

/// What a filter asked of entities (before), none of which is left, and which of them comes nearest.
std::string nothing_left(const Selector& selector, const Statement& statement, EntityKind kind,
                         const RangeFilter& filter, const std::vector<Index>& before);

}  // namespace hextwist
