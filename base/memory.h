// How much memory there is, so that what cannot fit is refused instead of ending the program.
#pragma once

#include <cstddef>

#include "hextwist/base/types.h"

namespace hextwist {

/// A mesh that would be larger than memory or a limit allows.
struct TooLarge : Error {
  using Error::Error;
};

/// Built with a sanitizer: these have memory of their own, more than any limit, and keep what was freed.
inline constexpr bool is_sanitized =
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
    true;
#else
    false;
#endif
#else
    false;
#endif

/// Bytes still available: free memory, caches and swap, within the limit of the control group and that of
/// limit_memory(). The largest number when that is unknown.
std::size_t available_memory();

/// Largest memory of this process so far, in bytes; not that of the program which started it.
std::size_t peak_memory();

/// For a program that is alone in its process: what is freed is kept for the next array, and counts as available. The
/// system clears every page that it hands out, which was a third of the time of a large refinement.
void keep_freed_memory();
/// Gives back what is kept. When nothing is to be done for a while.
void return_freed_memory();

/// From now on the process may have no more data than this (0: as much as the machine has): what asks for more gets
/// std::bad_alloc, which ends a command with an error, where else the system would end the process.
void limit_memory(std::size_t bytes);
/// The most hexes that a mesh may have from now on, in all of the process; 0: as many as fit.
void limit_hexes(double n_hexes);
/// Throws TooLarge where that is fewer. how_many: "" or "at least ".
void check_hexes(double n_hexes, const char* how_many = "");
/// While it lives, limit_hexes() is nothing to this thread, which makes a mesh that there is already.
class WithoutHexLimit {
 public:
  WithoutHexLimit();
  ~WithoutHexLimit();
  WithoutHexLimit(const WithoutHexLimit&) = delete;
};

/// Throws TooLarge, with both amounts, when a mesh of this size takes more than `available` bytes while a pass makes
/// it. how_many: "" or "at least ".
void check_memory(double n_hexes, double n_nodes, std::size_t available, const char* how_many = "");

/// check_memory() against available_memory(), of which small meshes are not checked, and limit_hexes().
void check_memory(double n_hexes, double n_nodes, const char* how_many = "");

}  // namespace hextwist
