// What can be said on the command lines of the programs, as data: for manual pages and for the completion of shells.
#pragma once

#include <string>
#include <vector>

namespace hextwist::app {

struct DescribedOption {
  std::vector<std::string> names;  ///< "-o", "--output"; of what stands by itself its one name, such as "MESH"
  std::string value;               ///< what follows, "FILE", "INT in [0 - 1024]"; empty: nothing does
  std::string help;                ///< one sentence
  std::vector<std::string> words;  ///< that the value has to be one of; empty: anything
  bool is_file = false;            ///< is the value the name of a file?
  bool is_positional = false, is_required = false, is_many = false;
};

struct DescribedMode {
  std::string word;  ///< that comes first: "check"; empty: the usual way
  std::string help;
  std::vector<DescribedOption> options;
};

/// Of hextwist: the usual way first.
std::vector<DescribedMode> describe_program();
/// Of hextwist-mpi.
DescribedMode describe_mpi();

}  // namespace hextwist::app
