// The command line of the program.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace hextwist::app {

struct Step {
  bool is_file = false;  ///< a journal, else commands
  std::string text;
};

struct Options {
  std::filesystem::path cad, mesh, output, json, before, levels;  ///< empty: not given
  std::vector<Step> steps;                                        ///< -c and journals, as they came
  bool keep_going = false;
  bool safe = false;                  ///< no command touches a file outside of the working folder
  bool check = false;                 ///< hextwist check MESH
  bool convert = false;               ///< hextwist convert MESH OUT
  int order = 0;                      ///< of OUT; 0: as MESH
  bool view = false;                  ///< hextwist view MESH: `output` is the page
  int split = 0;                      ///< hextwist split MESH N: `output` is the name before .N.i
  std::string split_by;               ///< "scotch", "boxes", "slabs", "ids"; empty: the first that is there
  bool join = false;                  ///< hextwist join PART
  int n_parts = 0;                    ///< with in_parts: a file of the whole is divided first
  bool in_parts = false;              ///< hextwist refine-in-parts PART: `output` is the name before .N.i
  int rings = 6;                      ///< of its halos
  bool serve = false;                 ///< hextwist serve
  std::string address = "127.0.0.1";  ///< that it listens on
  int port = 0;                       ///< 0: any that is free
  double most_seconds = 3600;         ///< that a command may take there, 0: no limit
  int threads = 0;                    ///< 0: all

  /// Not empty: nothing is read, but what could be is shown to this. For manual pages and completion.
  std::function<void(const CLI::App&)> describe = {};
};

/// Status to end with at once (help, version, wrong usage: the text has been printed), or -1 to go on.
int read_options(int argc, char** argv, Options& options);
/// The words that read_options() takes for another thing to do when they come first: "check", "convert", ...
std::vector<std::string> mode_words();

}  // namespace hextwist::app
