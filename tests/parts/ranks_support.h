// Runs the program of several processes.
#pragma once

#include <string>

namespace hextwist::test {

struct Outcome {
  int status = -1;
  std::string out, err;
};

/// n processes; arguments as a shell sees them.
Outcome run_ranks(int n, const std::string& arguments);
/// The same of another program.
Outcome run_program_in_ranks(int n, const std::string& program, const std::string& arguments);

/// The path of a file of models/.
std::string model(const std::string& name);

}  // namespace hextwist::test
