// How much memory there is, so that what cannot fit is refused instead of ending the program.
#pragma once

#include <cstddef>

namespace hextwist {

/// Bytes still available: free memory, caches and swap, within the limit of the control group. The largest number when
/// that is unknown.
std::size_t available_memory();

/// Peak memory of the process so far, in bytes.
std::size_t peak_memory();

/// Throws Error, with both amounts, when the arrays that every mesh of this size has take more than `available` bytes:
/// such a mesh could never be held. (CAD, ids and the pass itself take about as much again.)
/// how_many: "" or "at least ".
void check_memory(double n_hexes, double n_nodes, std::size_t available, const char* how_many = "");

/// check_memory() against available_memory(); small meshes are not checked.
void check_memory(double n_hexes, double n_nodes, const char* how_many = "");

}  // namespace hextwist
