// The project's own files and other programs, as the tests of the project see them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hextwist::test {

/// Layers from the bottom up: a file may include files of its own layer and of those before it.
inline const std::vector<std::string> layers = {"base",  "geom",    "mesh",    "io",    "refine", "sizing",
                                                "patch", "command", "session", "embed", "parts",  "app"};

/// Root of the source tree.
std::filesystem::path source_folder();

/// Files below a folder of the source tree with one of the extensions (".h"), sorted.
std::vector<std::filesystem::path> files_below(const std::string& folder, const std::vector<std::string>& extensions);

/// Whole content; fails the test when it can't be read.
std::string content(const std::filesystem::path& file);
std::vector<std::string> lines(const std::string& text);

/// Headers that are installed (cmake/hextwist_headers.cmake), besides hextwist/hextwist.h.
std::vector<std::filesystem::path> public_headers();

/// A shell command's exit status and what it printed (standard output and error together).
struct Outcome {
  int status = -1;
  std::string output;
};
Outcome run(const std::string& command);

/// For a shell: in single quotes.
std::string quoted(const std::string& word);

}  // namespace hextwist::test
