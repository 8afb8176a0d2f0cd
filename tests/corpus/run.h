// Sessions on one mesh: read, refine twice, smooth, coarsen, write and read back, undo; after each command the checkers
// have the word, which share no code with the library.
#pragma once

#include <functional>
#include <string>

#include "corpus/inputs.h"

namespace hextwist::corpus {

enum class Outcome {
  ok,
  refused,  ///< with a reason, and the mesh as it was
  dropped,  ///< refused because the result would not have kept the promises
  limited,  ///< refused for the limits of hexes, memory and time
  broken,
};
const char* name(Outcome outcome);

/// What became of one command.
struct Row {
  int run = 0;       ///< 0: reading
  int request = -1;  ///< which kind of refinement (requests.h), -1: another command
  std::string command;
  Outcome outcome = Outcome::ok;
  std::int64_t hexes = 0;
  double scaled_jacobian = 0, shape = 0,
         seconds = 0;                ///< the smallest of the mesh afterwards; time of the command alone
  double first_scaled_jacobian = 0;  ///< the smallest of the mesh that was read
  std::string said;                  ///< the reason, or what is broken
};

struct Plan {
  unsigned seed = 1;
  int first_run = 1, n_runs = 1;
  std::int64_t max_hexes = 20000;  ///< of a result; at least twice those of the file
  double seconds = 30;             ///< for a command
  std::filesystem::path folder;    ///< for files that are written
};

/// begin is told of each command before it is run, end of each afterwards.
void run(const Input& input, const Plan& plan, const std::function<void(const Row&)>& begin,
         const std::function<void(const Row&)>& end);

}  // namespace hextwist::corpus
