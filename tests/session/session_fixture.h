// A session and what it says, and files of a test's own.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "hextwist/session/session.h"
#include "support/grids.h"

namespace hextwist::test {

/// The folder of this test, emptied when it starts.
inline const std::filesystem::path& folder() {
  static std::filesystem::path result;
  static const testing::TestInfo* of = nullptr;
  if (const auto* now = testing::UnitTest::GetInstance()->current_test_info(); now != of) {
    of = now;
    result = output_folder();
  }
  return result;
}

/// A session and what it says.
struct Fixture {
  Session session;
  std::vector<std::string> output, notices, errors;
  bool go_on = true;

  Fixture() { session.set_callbacks(callbacks()); }
  SessionCallbacks callbacks() {
    return {.output = [this](const std::string& line) { output.push_back(line); },
            .notice = [this](const std::string& line) { notices.push_back(line); },
            .error = [this](const CommandError& error) { errors.emplace_back(error.what()); },
            .progress = [this](const char*, double) { return go_on; }};
  }

  std::string error(std::string_view text) {
    try {
      session.run(text);
    } catch (const CommandError& error) {
      return error.message();
    }
    return "no error";
  }
  std::string all_output() const { return together(output); }
  std::string all_notices() const { return together(notices); }
  const CommandRecord& last() const { return session.records().back(); }

 private:
  static std::string together(const std::vector<std::string>& lines) {
    std::string result;
    for (const std::string& line : lines) result += line + "\n";
    return result;
  }
};

inline std::filesystem::path written(const std::string& name, const std::string& text) {
  const auto file = folder() / name;
  std::ofstream(file) << text;
  return file;
}

}  // namespace hextwist::test
