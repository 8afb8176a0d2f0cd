// Runs the folders next to this file: see README.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

#include "expectation.h"
#include "support/grids.h"

namespace hextwist::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const fs::path source_folder = HEXTWIST_SOURCE_DIR;

std::vector<std::string> names_of_cases() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(source_folder / "tests/journals"))
    if (fs::exists(entry.path() / "expect.json")) names.push_back(entry.path().filename().string());
  std::ranges::sort(names);
  return names;
}

std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw Error(file.string() + " can't be read");
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::string> models_of(const json& expected) {
  if (!expected.contains("model")) return {};
  if (expected["model"].is_array()) return expected["model"];
  return {expected["model"]};
}

/// The files of the case and of its models, in the folder where the journal runs.
void link_files(const fs::path& from, const std::vector<std::string>& models, const fs::path& to) {
  for (const auto& entry : fs::directory_iterator(from)) fs::copy(entry.path(), to / entry.path().filename());
  for (const std::string& model : models) {
    int n_found = 0;
    for (const auto& entry : fs::directory_iterator(source_folder / "models"))
      if (entry.path().stem() == model) {
        fs::create_symlink(entry.path(), to / entry.path().filename());
        ++n_found;
      }
    EXPECT_GE(n_found, 2) << "there is no model '" << model << "' in models/";
  }
}

/// Looks at the mesh after each line that changed it.
void run_by_lines(const std::string& text, Outcome& outcome, const json& expected) {
  std::istringstream stream(text);
  std::string line, command;
  int first = 1;
  for (int number = 1; std::getline(stream, line); ++number) {
    command += line;
    if (command.ends_with('\\')) {
      command += '\n';
      continue;
    }
    const Index before = outcome.session.meshed().mesh.n_hexes();
    outcome.session.run(command, "journal.jou", first);
    if (outcome.session.meshed().mesh.n_hexes() != before) {
      SCOPED_TRACE("after line " + std::to_string(number) + ": " + command);
      expect_promises(outcome.session.meshed(), expected);
    }
    if (const auto after = expected.find("after"); after != expected.end())
      if (const auto at = after->find(std::to_string(number)); at != after->end())
        expect_number(outcome.session.meshed().mesh.n_hexes(), *at, "hexes after line " + std::to_string(number));
    command.clear();
    first = number + 1;
  }
}

class journal : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { before_ = fs::current_path(); }
  void TearDown() override { fs::current_path(before_); }

 private:
  fs::path before_;
};

TEST_P(journal, does_what_is_expected) {
  const fs::path folder = source_folder / "tests/journals" / GetParam();
  const json expected = json::parse(content(folder / "expect.json"));
  const auto models = models_of(expected);
  const fs::path scratch = output_folder();
  link_files(folder, models, scratch);
  fs::current_path(scratch);

  Outcome outcome;
  outcome.session.set_callbacks({.output = [&](const std::string& line) { outcome.printed.push_back(line); },
                                 .notice = [&](const std::string& line) { outcome.notes.push_back(line); },
                                 .error = {},
                                 .progress = {}});
  const std::string text = content("journal.jou");
  try {
    const std::regex brings_its_own(R"((^|\n)\s*(import|create|playback)\b)", std::regex::icase);
    if (!models.empty() && !std::regex_search(text, brings_its_own))
      outcome.session.run("import brep \"" + models[0] + ".brep\"; import mesh \"" + models[0] + ".msh\"");
    run_by_lines(text, outcome, expected);
  } catch (const CommandError& error) {
    outcome.error = error.what();
    outcome.error_line = error.line();
    outcome.hexes_at_error = outcome.session.records().back().before.hexes;
  }
  expect_outcome(outcome, expected);
}

INSTANTIATE_TEST_SUITE_P(of_folder, journal, testing::ValuesIn(names_of_cases()),
                         [](const auto& each) { return each.param; });

TEST(journals, there_are_enough) {
  EXPECT_GE(names_of_cases().size(), 40u);
}

}  // namespace
}  // namespace hextwist::test
