// The reference that ./dev docs makes: something is said about everything that the public headers declare.
#include <gtest/gtest.h>

#include <fstream>
#include <regex>

#include "project/source_tree.h"
#include "support/grids.h"

namespace hextwist::test {
namespace {

bool has_doxygen() {
  return run("doxygen --version").status == 0;
}

/// Makes the reference of some headers by the project's own settings, below a folder. Returns Doxygen's warnings, and
/// values of enums that nothing is said about, which it does not warn of.
std::vector<std::string> undocumented(const std::vector<std::filesystem::path>& headers,
                                      const std::filesystem::path& folder) {
  std::string list;
  for (const auto& header : headers) list += header.string() + " ";
  // The last line counts.
  std::ofstream(folder / "Doxyfile") << content(source_folder() / "docs/Doxyfile")
                                     << "\nOUTPUT_DIRECTORY = " << folder.string()
                                     << "\nWARN_LOGFILE = " << (folder / "warnings.txt").string()
                                     << "\nGENERATE_XML = YES\n";
  std::filesystem::remove_all(folder / "xml");
  const Outcome made = run("cd " + quoted(source_folder()) + " && HEADERS=" + test::quoted(list) + " doxygen " +
                           quoted((folder / "Doxyfile").string()));
  EXPECT_EQ(made.status, 0);
  EXPECT_EQ(made.output, "");
  std::vector<std::string> found = lines(content(folder / "warnings.txt"));
  const std::regex bare(
      R"re(<enumvalue id="(\w+)"[^>]*>\s*<name>(\w+)</name>(?:\s*<initializer>[^<]*</initializer>)?)re"
      R"re(\s*<briefdescription>\s*</briefdescription>\s*<detaileddescription>\s*</detaileddescription>)re");
  for (const auto& entry : std::filesystem::directory_iterator(folder / "xml")) {
    const std::string page = content(entry.path());
    for (std::sregex_iterator at(page.begin(), page.end(), bare), end; at != end; ++at)
      found.push_back((*at)[1].str() + ": enum value " + (*at)[2].str() + " is not documented.");
  }
  return found;
}

/// As users include them.
std::vector<std::filesystem::path> installed_headers() {
  std::vector<std::filesystem::path> result;
  for (const auto& header : public_headers())
    result.push_back(source_folder() / "include/hextwist" / header.lexically_relative(source_folder()));
  return result;
}

TEST(Reference, says_something_about_every_public_symbol_and_leads_to_every_header) {
  if (!has_doxygen()) GTEST_SKIP() << "doxygen is not installed";
  const auto folder = output_folder();
  const auto headers = installed_headers();
  ASSERT_GT(headers.size(), 10u);
  for (const std::string& line : undocumented(headers, folder)) ADD_FAILURE() << line;

  const std::string front = content(folder / "cpp/index.html");
  for (const auto& header : public_headers()) {
    const std::string name = header.lexically_relative(source_folder()).string();
    EXPECT_NE(front.find(">" + name + "</a>"), std::string::npos) << "the front page does not lead to " << name;
  }
  // Nothing is left out because Doxygen does not see it: of each kind of symbol one, on some header's page.
  std::string pages;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "cpp"))
    if (entry.path().filename().string().ends_with("_8h.html")) pages += content(entry.path());
  for (const char* known :
       {"hextwist_create", "HEXTWIST_CANCELLED", "hextwist_arrays", "read_mesh", "max_numsplit", "HexOrigin", "How"})
    EXPECT_NE(pages.find(known), std::string::npos) << known << " is on no header's page";
}

TEST(Reference, checker_finds_a_symbol_about_which_nothing_is_said) {
  if (!has_doxygen()) GTEST_SKIP() << "doxygen is not installed";
  const auto folder = output_folder();
  const auto finds = [&](const std::string& text, const std::string& name) {
    const auto file = folder / "candidate.h";
    std::ofstream(file) << "// A header.\n#pragma once\n\nnamespace hextwist {\n" << text << "}\n";
    for (const std::string& line : undocumented({file}, folder))
      if (line.find("candidate") != std::string::npos && line.find(name) != std::string::npos &&
          line.find("not documented") != std::string::npos)
        return true;
    return false;
  };
  EXPECT_FALSE(finds("/// A struct.\nstruct Whole {\n  int field = 0;  ///< a field\n};\n", ""));
  EXPECT_TRUE(finds("/// A struct.\nstruct Half {\n  int bare = 0;\n};\n", "bare"));
  EXPECT_TRUE(finds("struct Bare {\n  int field = 0;  ///< a field\n};\n", "Bare"));
  EXPECT_TRUE(finds("int silent(int x);\n", "silent"));
  EXPECT_TRUE(finds("/// An enum.\nenum class Kind {\n  said,  ///< a value\n  lost = 5\n};\n", "lost"));
  EXPECT_FALSE(finds("/// An enum.\nenum class Kind {\n  said,  ///< a value\n  lost  ///< another\n};\n", ""));
}

}  // namespace
}  // namespace hextwist::test
