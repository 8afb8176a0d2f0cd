#include "source_tree.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace hextwist::test {

std::filesystem::path source_folder() {
  return HEXTWIST_SOURCE_DIR;
}

std::vector<std::filesystem::path> files_below(const std::string& folder, const std::vector<std::string>& extensions) {
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(source_folder() / folder))
    if (entry.is_regular_file() && std::ranges::count(extensions, entry.path().extension().string()))
      found.push_back(entry.path());
  std::ranges::sort(found);
  return found;
}

std::string content(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  EXPECT_TRUE(in) << "can't read " << file;
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> result;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) result.push_back(line);
  return result;
}

std::vector<std::filesystem::path> public_headers() {
  std::vector<std::filesystem::path> result;
  std::istringstream list(HEXTWIST_HEADERS);
  for (std::string name; std::getline(list, name, ',');) result.push_back(source_folder() / name);
  return result;
}

Outcome run(const std::string& command) {
  Outcome outcome;
  FILE* pipe = popen(("( " + command + "\n) 2>&1").c_str(), "r");
  if (!pipe) return outcome;
  std::array<char, 4096> buffer;
  for (std::size_t n; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    outcome.output.append(buffer.data(), n);
  const int status = pclose(pipe);
  if (WIFEXITED(status)) outcome.status = WEXITSTATUS(status);
  return outcome;
}

std::string quoted(const std::string& word) {
  std::string result = "'";
  for (const char c : word) c == '\'' ? result += "'\\''" : result += c;
  return result + "'";
}

}  // namespace hextwist::test
