// Includes only point from app towards base; the CAD and geometry libraries stay behind the sources that wrap them.
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

#include "source_tree.h"

namespace hextwist::test {
namespace {

/// What is wrong with the includes of a file; path relative to the source tree.
std::vector<std::string> include_offences(const std::filesystem::path& path, const std::string& text) {
  static const std::regex include(R"re(^\s*#\s*include\s*([<"])([^>"]+)[>"])re");
  const std::string layer = path.begin()->string();
  // Neither sources nor internal headers are installed: nobody outside of the library reads them.
  const bool is_inside = path.extension() == ".cpp" || path.filename().string().ends_with("_internal.h");
  std::vector<std::string> offences;
  int number = 0;
  for (const std::string& line : lines(text)) {
    ++number;
    std::smatch match;
    if (!std::regex_search(line, match, include)) continue;
    const auto complain = [&](const std::string& why) {
      offences.push_back(path.string() + ":" + std::to_string(number) + ": " + why + ": " + match[2].str());
    };
    const std::filesystem::path included = match[2].str();
    if (match[1] == "<") {
      if (included.extension() == ".hxx" && !(layer == "geom" && is_inside))
        complain("OpenCASCADE header outside the inside of geom");
      if (*included.begin() == "CGAL" && !is_inside) complain("CGAL header in a public header");
      if (*included.begin() == "hextwist") complain("own header in angle brackets");
    } else if (*included.begin() == "hextwist") {
      const auto theirs = std::ranges::find(layers, (++included.begin())->string());
      if (theirs == layers.end())
        complain("no such layer");
      else if (theirs > std::ranges::find(layers, layer))
        complain(layer + " includes a layer above it");
      else if (*theirs != layer && included.filename().string().ends_with("_internal.h"))
        complain("the inside of another layer");
    } else if (layer != "app" && included.extension() != ".inc") {  // generated tables beside their source
      complain("own headers are included as hextwist/<layer>/<file>.h");
    }
  }
  return offences;
}

/// The layers and these.
std::vector<std::string> all_folders(std::vector<std::string> more) {
  more.insert(more.begin(), layers.begin(), layers.end());
  return more;
}

TEST(Layering, includes_only_point_towards_base) {
  std::size_t n_files = 0;
  for (const auto& layer : layers)
    for (const auto& file : files_below(layer, {".h", ".cpp"})) {
      ++n_files;
      for (const auto& offence : include_offences(file.lexically_relative(source_folder()), content(file)))
        ADD_FAILURE() << offence;
    }
  EXPECT_GT(n_files, 20u) << "the layers were not found";
}

TEST(Layering, checker_finds_each_kind_of_offence) {
  const auto n = [](const char* path, const char* text) { return include_offences(path, text).size(); };
  EXPECT_EQ(n("mesh/a.cpp", "#include \"hextwist/refine/split.h\"\n"), 1u);
  EXPECT_EQ(n("mesh/a.cpp", "#include \"hextwist/nowhere/split.h\"\n"), 1u);
  EXPECT_EQ(n("mesh/a.cpp", "#include \"split.h\"\n"), 1u);
  EXPECT_EQ(n("mesh/a.cpp", "#include \"hextwist/geom/occ/model_internal.h\"\n"), 1u);
  EXPECT_EQ(n("geom/facet/a.cpp", "#include \"hextwist/geom/occ/model_internal.h\"\n"), 0u);
  EXPECT_EQ(n("mesh/a.cpp", "#include <hextwist/mesh/mesh.h>\n"), 1u);
  EXPECT_EQ(n("mesh/a.cpp", "#  include <gp_Pnt.hxx>\n"), 1u);
  EXPECT_EQ(n("geom/a.h", "#include <gp_Pnt.hxx>\n#include <CGAL/AABB_tree.h>\n"), 2u);
  EXPECT_EQ(n("geom/a.cpp", "#include <gp_Pnt.hxx>\n#include <CGAL/AABB_tree.h>\n"), 0u);
  EXPECT_EQ(n("geom/a_internal.h", "#include <gp_Pnt.hxx>\n"), 0u);
  EXPECT_EQ(n("mesh/a_internal.h", "#include <gp_Pnt.hxx>\n"), 1u);
  EXPECT_EQ(n("mesh/a.cpp", "#include \"table.inc\"\n"), 0u);
  EXPECT_EQ(n("refine/a.cpp", "#include \"hextwist/geom/model.h\"\n#include <vector>\n"), 0u);
}

TEST(Layering, every_source_is_listed_for_the_build) {
  // A test or source that is not listed is never compiled, and nobody notices.
  for (const std::string& folder : all_folders({"tests"}))
    for (const auto& file : files_below(folder, {".cpp"})) {
      auto list = file.parent_path();
      while (!std::filesystem::exists(list / "CMakeLists.txt")) list = list.parent_path();
      const std::string name = file.lexically_relative(list).generic_string();
      const std::string text = content(list / "CMakeLists.txt");
      const std::regex word("(^|[\\s(/])" + std::regex_replace(name, std::regex("\\."), "\\.") + "($|[\\s)])");
      EXPECT_TRUE(std::regex_search(text, word)) << name << " is not in " << list / "CMakeLists.txt";
    }
}

TEST(Layering, no_file_is_longer_than_600_lines) {
  for (const std::string& folder : all_folders({"tests", "models", "examples"}))
    for (const auto& file : files_below(folder, {".h", ".c", ".cpp", ".py", ".sh", ".txt"}))
      EXPECT_LE(lines(content(file)).size(), 600u) << file;
}

}  // namespace
}  // namespace hextwist::test
