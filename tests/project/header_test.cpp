// Public headers are complete, and their users need no header from inside, of OpenCASCADE or of CGAL anywhere near.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <mutex>
#include <regex>
#include <thread>

#include "source_tree.h"
#include "support/grids.h"

namespace hextwist::test {
namespace {

/// Compiles headers, included one after the other, as a user would: the installed names and Eigen on the include path
/// and nothing else (OpenCASCADE's folder is not, so that one of its headers does not even compile). Returns what is
/// wrong, "" if nothing. The compiler's list of all files it read goes to `scratch`.
std::string offence(const std::vector<std::filesystem::path>& headers, const std::filesystem::path& scratch) {
  std::string includes;
  for (const auto& header : headers) includes += " -include " + quoted(header.string());
  const Outcome compiled = run(HEXTWIST_CXX_COMPILER " -std=c++20 -fsyntax-only -Wall -Wextra -Werror -I" +
                               quoted(HEXTWIST_SOURCE_DIR "/include") + " -isystem " + quoted(HEXTWIST_EIGEN_INCLUDE) +
                               " -MD -MF " + quoted(scratch.string()) + includes + " -x c++ /dev/null");
  if (compiled.status != 0) return "does not compile on its own:\n" + compiled.output;
  const std::string read = content(scratch);
  for (const auto& header : headers)
    if (read.find(header.filename().string()) == std::string::npos) return "the compiler did not say what it read";
  for (const char* foreign : {"/CGAL/", ".hxx", "/opencascade/"})
    if (const auto at = read.find(foreign); at != std::string::npos) {
      const auto start = read.find_last_of(" \n", at) + 1;
      return "reaches " + read.substr(start, read.find_first_of(" \n", at) - start);
    }
  const std::regex own(HEXTWIST_SOURCE_DIR "/include/hextwist/(\\S+)");
  for (std::sregex_iterator at(read.begin(), read.end(), own), end; at != end; ++at)
    if ((*at)[1] != "hextwist.h" && !std::ranges::count(public_headers(), source_folder() / (*at)[1].str()))
      return "reaches what is not installed, " + (*at)[1].str();
  return "";
}

TEST(PublicHeader, reaches_no_header_from_inside_and_none_of_OpenCASCADE_or_CGAL) {
  const auto headers = public_headers();
  ASSERT_GT(headers.size(), 10u);
  const auto scratch = output_folder() / "all.d";
  if (offence(headers, scratch).empty()) return;
  for (const auto& header : headers) EXPECT_EQ(offence({header}, scratch), "") << header;
}

TEST(SlowPublicHeader, each_compiles_on_its_own) {
  const auto headers = public_headers();
  const auto folder = output_folder();
  std::atomic<std::size_t> next = 0;
  std::mutex reporting;
  const auto work = [&] {
    for (std::size_t i; (i = next++) < headers.size();) {
      const std::string wrong = offence({headers[i]}, folder / (std::to_string(i) + ".d"));
      const std::lock_guard lock(reporting);
      EXPECT_EQ(wrong, "") << headers[i];
    }
  };
  std::jthread second(work);
  work();
}

TEST(PublicHeader, hextwist_h_brings_all_but_those_for_C_and_Gmsh) {
  const std::string text = content(source_folder() / "include/hextwist/hextwist.h");
  for (const auto& header : public_headers()) {
    const std::string name = header.lexically_relative(source_folder()).string();
    const bool brought = text.find("#include \"hextwist/" + name + "\"") != std::string::npos;
    EXPECT_EQ(brought, !name.starts_with("embed/") && name != "base/export.h") << name;
  }
  EXPECT_EQ(offence({source_folder() / "include/hextwist/hextwist.h"}, output_folder() / "hextwist.d"), "");
}

TEST(PublicHeader, shows_what_it_declares_and_no_other_does) {
  for (const auto& layer : layers)
    for (const auto& header : files_below(layer, {".h"})) {
      const std::string name = header.lexically_relative(source_folder()).string(), text = content(header);
      if (name == "base/export.h" || name == "embed/c.h") continue;
      const bool is_public = std::ranges::count(public_headers(), header);
      EXPECT_EQ(text.find("namespace HEXTWIST_API hextwist {") != std::string::npos, is_public) << name;
      EXPECT_EQ(text.find("namespace hextwist {") != std::string::npos && is_public, false) << name;
    }
}

TEST(PublicHeader, checker_finds_a_header_that_reaches_inside_or_OpenCASCADE_or_CGAL_or_is_incomplete) {
  const auto folder = output_folder();
  const auto of = [&](const std::string& text) {
    const auto file = folder / "candidate.h";
    std::ofstream(file) << "#pragma once\n" << text;
    return offence({file}, folder / "candidate.d");
  };
  EXPECT_EQ(of("#include <vector>\nstd::vector<int> complete();\n"), "");
  EXPECT_NE(of("std::vector<int> incomplete();\n").find("does not compile"), std::string::npos);
  EXPECT_NE(of("#include \"hextwist/base/memory.h\"\n").find("not installed"), std::string::npos);
  EXPECT_NE(of("#include <gp_Pnt.hxx>\n").find("does not compile"), std::string::npos);
  EXPECT_NE(of("#include <CGAL/version.h>\n").find("reaches /"), std::string::npos);
}

}  // namespace
}  // namespace hextwist::test
