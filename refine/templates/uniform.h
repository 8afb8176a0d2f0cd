// Uniform refinement: every edge in the same number of equal pieces, every hex in pieces^3.
#pragma once

#include <memory>

#include "hextwist/refine/templates/split_table.h"

namespace hextwist {

/// Most pieces per edge: a template's nodes are numbered in 16 bits.
inline constexpr int max_uniform_pieces = 30;

/// Table with the codes 0 (leave alone; only conformal if all hexes have it) and 1 (cut). 2 <= pieces <= 30.
std::shared_ptr<const SplitTable> uniform_table(int pieces);

}  // namespace hextwist
