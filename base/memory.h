// How much memory there is, so that what cannot fit is refused instead of ending the program.
#pragma once

#include <cstddef>

namespace hextwist {

/// Bytes that the system could still give: free ones, caches and swap, and no more than the limit of the control group.
/// The largest number where that is not known.
std::size_t available_memory();

/// Most bytes that the process has held so far.
std::size_t peak_memory();

/// Throws Error, with both amounts, when the arrays that every mesh of this size has take more than `available` bytes:
/// then nobody could hold it. (With CAD, ids and what a pass itself needs it is twice as much.)
/// how_many: "" or "at least ".
void check_memory(double n_hexes, double n_nodes, std::size_t available, const char* how_many = "");

/// check_memory() with what there is; not asked where the mesh is small.
void check_memory(double n_hexes, double n_nodes, const char* how_many = "");

}  // namespace hextwist
