// What the README shows works, and what it states is what the files say.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "hextwist/io/io.h"
#include "source_tree.h"
#include "support/grids.h"

namespace hextwist::test {
namespace {

std::string readme() {
  return content(source_folder() / "README.md");
}

/// The fenced blocks of one language, in order.
std::vector<std::string> blocks(const std::string& language, const std::string& text = readme()) {
  std::vector<std::string> found;
  bool inside = false;
  for (const std::string& line : lines(text)) {
    if (!inside && line == "```" + language) {
      inside = true;
      found.emplace_back();
    } else if (inside && line == "```") {
      inside = false;
    } else if (inside) {
      found.back() += line + "\n";
    }
  }
  return found;
}

/// Runs the blocks one after the other in a folder that has the models; returns how many there were.
int run_shell(const std::string& text) {
  const auto folder = output_folder();
  std::filesystem::create_directory_symlink(source_folder() / "models", folder / "models");
  int n_run = 0;
  for (const std::string& block : blocks("sh", text)) {
    // Installing, building and ./dev itself are for a shell outside of the tests.
    if (block.find("./dev") != std::string::npos || block.find("cmake") != std::string::npos) continue;
    ++n_run;
    const Outcome outcome = run("set -e; cd " + quoted(folder) + "; PATH=" + quoted(HEXTWIST_BINARY_DIR "/app") +
                                ":$PATH; export PATH\n" + block);
    EXPECT_EQ(outcome.status, 0) << block << outcome.output;
  }
  return n_run;
}

void run_python(const std::string& text) {
  const auto folder = output_folder();
  std::filesystem::create_directory_symlink(source_folder() / "models", folder / "models");
  ASSERT_FALSE(blocks("python", text).empty());
  const bool has_gmsh = run(HEXTWIST_PYTHON " -c 'import gmsh'").status == 0;
  for (const std::string& block : blocks("python", text)) {
    if (!has_gmsh && block.find("import gmsh") != std::string::npos) continue;
    const Outcome outcome = run("cd " + quoted(folder) + "; PYTHONPATH=" + quoted(HEXTWIST_BINARY_DIR "/python") +
                                " " HEXTWIST_PYTHON " -c " + quoted(block));
    EXPECT_EQ(outcome.status, 0) << block << outcome.output;
  }
}

std::string tutorial() {
  return content(source_folder() / "docs/tutorial.md");
}

TEST(Readme, shell_commands_work_in_the_order_shown) {
  if (!std::filesystem::exists(HEXTWIST_BINARY_DIR "/app/hextwist")) GTEST_SKIP() << "the program is not built";
  EXPECT_GE(run_shell(readme()), 3) << "the README shows no commands";
}

/// Pictures that a page of the docs shows, from the folder of the sources.
std::set<std::string> shown_pictures(const std::filesystem::path& page) {
  const std::regex picture(R"re(!\[[^\]]*\]\(([^)]+)\)|<img[^>]*src="([^"]+)")re");
  const std::string text = content(source_folder() / page);
  std::set<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), picture), end; at != end; ++at)
    found.insert((page.parent_path() / ((*at)[1].matched ? (*at)[1] : (*at)[2]).str()).lexically_normal().string());
  return found;
}

TEST(Readme, every_picture_of_it_and_of_the_docs_is_made_by_dev_pictures) {
  std::set<std::string> shown = shown_pictures("README.md"), there;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(source_folder() / "docs")) {
    const auto path = std::filesystem::relative(entry.path(), source_folder());
    if (path.extension() == ".md") shown.merge(shown_pictures(path));
    const std::string extension = path.extension().string();
    if (extension == ".png" || extension == ".gif" || extension == ".svg") there.insert(path.string());
  }
  const Outcome list = run(quoted(source_folder() / "docs/pictures.sh") + " --list");
  ASSERT_EQ(list.status, 0) << list.output;
  std::set<std::string> made;
  for (const std::string& line : lines(list.output)) made.insert(line);
  EXPECT_GT(made.size(), 25U);
  EXPECT_EQ(shown, made);
  EXPECT_EQ(there, made);
}

TEST(Tutorial, shell_commands_work_in_the_order_shown) {
  if (!std::filesystem::exists(HEXTWIST_BINARY_DIR "/app/hextwist")) GTEST_SKIP() << "the program is not built";
  EXPECT_GE(run_shell(tutorial()), 5);
}

TEST(Readme, python_works) {
  if (!std::filesystem::exists(HEXTWIST_BINARY_DIR "/python/hextwist"))
    GTEST_SKIP() << "the Python module is not built";
  run_python(readme());
}

TEST(Tutorial, python_works) {
  if (!std::filesystem::exists(HEXTWIST_BINARY_DIR "/python/hextwist"))
    GTEST_SKIP() << "the Python module is not built";
  run_python(tutorial());
}

TEST(Readme, embedding_example_is_part_of_the_one_that_is_compiled) {
  const std::string example = content(source_folder() / "examples/minimal/main.cpp");
  const auto shown = blocks("cpp");
  ASSERT_FALSE(shown.empty());
  for (const std::string& block : shown)
    for (const std::string& line : lines(block)) EXPECT_NE(example.find(line), std::string::npos) << line;
}

TEST(Readme, table_of_models_is_that_of_models_json) {
  const std::string text = readme();
  for (const auto& row : nlohmann::json::parse(content(source_folder() / "models/models.json"))) {
    char numbers[200];
    std::snprintf(numbers, sizeof numbers, " | %.8g | %.8g | %.2f |\n", double(row["volume"]), double(row["area"]),
                  double(row["min_scaled_jacobian"]));
    const std::string expected = "| " + row["name"].get<std::string>() + " | " + row["hexes"].dump() + " | " +
                                 row["exercises"].get<std::string>() + numbers;
    EXPECT_NE(text.find(expected), std::string::npos) << "run models/make_models.py; missing:\n" << expected;
  }
}

/// Words that begin with a dot and stand in backquotes.
std::set<std::string> extensions_in(const std::string& text) {
  std::set<std::string> found;
  static const std::regex extension(R"re(`(\.\w+)`)re");
  for (std::sregex_iterator at(text.begin(), text.end(), extension), end; at != end; ++at) found.insert((*at)[1]);
  return found;
}

TEST(Readme, table_of_files_says_what_is_read_and_written) {
  std::set<std::string> read, written;
  for (const std::string& line : lines(readme())) {
    static const std::regex row(R"re(\| ([^|]*`\.\w+`[^|]*) \| (\w+) \| (\w+) \|.*)re");
    std::smatch match;
    if (!std::regex_match(line, match, row)) continue;
    if (match[2] == "yes") read.merge(extensions_in(match[1]));
    if (match[3] == "yes") written.merge(extensions_in(match[1]));
  }
  const auto known = [](const std::string& text) {
    std::istringstream words(text);
    return std::set<std::string>(std::istream_iterator<std::string>(words), {});
  };
  EXPECT_EQ(read, known(readable_extensions()));
  EXPECT_EQ(written, known(writable_extensions()));
}

TEST(Documents, links_lead_to_files_that_exist_and_so_do_sources_that_are_named) {
  auto documents = files_below("docs", {".md"});
  for (const char* name : {"README.md", "CONTRIBUTING.md", "CHANGELOG.md"}) documents.push_back(source_folder() / name);
  std::string rooms = layers.front();
  for (const auto& layer : layers) rooms += "|" + layer;
  const std::regex source("(?:^|[\\s`(])((?:" + rooms + ")/[\\w/]+\\.(?:h|cpp|inc))\\b");
  for (const auto& file : documents) {
    const std::string text = content(file);
    for (std::sregex_iterator at(text.begin(), text.end(), source), end; at != end; ++at)
      EXPECT_TRUE(std::filesystem::exists(source_folder() / (*at)[1].str())) << file << ": " << (*at)[1];
    for (std::size_t at = 0; (at = text.find("](", at)) != std::string::npos; ++at) {
      const std::string link = text.substr(at + 2, text.find(')', at) - at - 2);
      if (link.starts_with("http") || link.starts_with("#")) continue;
      EXPECT_TRUE(std::filesystem::exists(file.parent_path() / link.substr(0, link.find('#')))) << file << ": " << link;
    }
  }
}

}  // namespace
}  // namespace hextwist::test
