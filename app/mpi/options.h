// The command line of hextwist-mpi.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace hextwist::app {

struct MpiOptions {
  std::filesystem::path cad, mesh, output;
  std::vector<std::string> commands;
  std::string by;
  int threads = 1;
  int rings = 6;
  bool fixed = false;  ///< hexes stay where they are

  /// Not empty: nothing is read, but what could be is shown to this.
  std::function<void(const CLI::App&)> describe = {};
};

/// Status to end with, -1 to go on. Help, version and errors are printed by the first process alone.
int read_mpi_options(int argc, char** argv, bool is_first, MpiOptions& options);

}  // namespace hextwist::app
