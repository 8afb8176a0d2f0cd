// The shared library: strangers find it as they find the static one, and it shows what the public headers declare.
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

#include "consumer.h"
#include "support/grids.h"

namespace hextwist::test {
namespace {

/// Identifiers in C and C++ text.
std::vector<std::string> words(const std::string& text) {
  static const std::regex word("[A-Za-z_]\\w*");
  std::vector<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), word), end; at != end; ++at) found.push_back(at->str());
  return found;
}

/// Identifiers of the public headers, comments apart.
std::vector<std::string> public_words() {
  static const std::regex comment("//[^\n]*");
  std::vector<std::string> all;
  for (const auto& header : public_headers()) {
    std::string text = content(header);
    for (std::size_t at; (at = text.find("/*")) != std::string::npos;) text.erase(at, text.find("*/", at) + 2 - at);
    std::ranges::copy(words(std::regex_replace(text, comment, "")), std::back_inserter(all));
  }
  std::ranges::sort(all);
  return all;
}

/// The name of a symbol, as `nm -C` has it, with its scopes but without arguments and template arguments.
std::string bare_name(std::string symbol) {
  static const std::regex left_out("\\[abi:cxx11\\]|operator(<=>|<<=|>>=|<<|>>|<=|>=|<|>|->|\\(\\))");
  symbol = std::regex_replace(symbol, left_out, "");
  std::string name;
  int depth = 0;
  for (const char c : symbol) {
    depth += (c == '<') - (c == '>');
    if (depth == 0 && c != '>') name += c;
  }
  if (const auto open = name.find('('); open != std::string::npos) name.erase(open);
  // Functions of templates come with the type that they return.
  if (const auto blank = name.rfind(' '); blank != std::string::npos) name.erase(0, blank + 1);
  return name;
}

/// Is it declared in the public headers? A table of or a type of a class goes by the class.
bool is_public(std::string symbol, const std::vector<std::string>& known) {
  static const std::regex kind("^(vtable|typeinfo|typeinfo name|VTT|construction vtable) for ");
  const std::string of = std::regex_replace(symbol, kind, "");
  const std::string name = bare_name(of);
  // Standard containers of public types: any of their users has these as well. Exceptions of libraries are shown by
  // their own headers, to be caught wherever they go.
  if (name.starts_with("std::") || name.starts_with("__gnu_cxx::")) return true;
  if (of != symbol && (name.starts_with("boost::") || name == "mu::ParserError")) return true;
  const auto names = words(name);
  return (name.starts_with("hextwist::") || name.starts_with("hextwist_")) &&
         std::ranges::all_of(names, [&](const std::string& each) { return std::ranges::binary_search(known, each); });
}

TEST(SharedLibrary, checker_knows_what_is_public) {
  const auto known = public_words();
  for (const char* symbol : {"hextwist_free", "hextwist::Session::run(std::basic_string_view<char>)",
                             "vtable for hextwist::Model", "hextwist::Session::~Session()",
                             "typeinfo name for hextwist::Cancelled", "std::vector<double>::reserve(unsigned long)",
                             "hextwist::readable_extensions[abi:cxx11]()", "typeinfo for mu::ParserError"})
    EXPECT_TRUE(is_public(symbol, known)) << symbol;
  for (const char* symbol : {"hextwist::detail::off_model(hextwist::Mesh const&)", "hextwist::Session::Core::say(int)",
                             "hextwist::OccModel::box() const", "CGAL::AABB_tree<int>::build()",
                             "vtable for NCollection_List<TopoDS_Shape>", "void tbb::detail::f<hextwist::Mesh>(int)"})
    EXPECT_FALSE(is_public(symbol, known)) << symbol;
}

/// A build of the shared library beside this one, kept from run to run. Of the same sources by the same commands from
/// a folder as deep: with ccache nothing is compiled twice.
class SlowSharedLibrary : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const std::filesystem::path build = HEXTWIST_BINARY_DIR "-shared";
    const Outcome built =
        run("cmake -S " HEXTWIST_SOURCE_DIR " -B " + quoted(build) + " -G Ninja " HEXTWIST_SAME_BUILD +
            " -DBUILD_SHARED_LIBS=ON -DHEXTWIST_BUILD_TESTS=OFF && "
            "CCACHE_BASEDIR=" HEXTWIST_SOURCE_DIR
            " CCACHE_NOHASHDIR=1 "
            "CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime "
            "cmake --build " +
            quoted(build));
    ASSERT_EQ(built.status, 0) << built.output;
    prefix = build / "installed";
    install(build, prefix);
    const Outcome found = run("find " + quoted(prefix) + " -name 'libhextwist.so'");
    library = found.output.substr(0, found.output.find('\n'));
  }
  inline static std::filesystem::path prefix, library;
  const std::filesystem::path examples = source_folder() / "examples";
};

// One test, for each would be a process of its own that builds the library.
TEST_F(SlowSharedLibrary, shows_what_is_public_and_serves_the_examples) {
  // What it shows.
  const Outcome shown = run("nm -DC --defined-only " + quoted(library));
  ASSERT_EQ(shown.status, 0) << shown.output;
  const auto known = public_words();
  std::size_t n_shown = 0;
  for (const std::string& line : lines(shown.output)) {
    static const std::regex entry("^[0-9a-f]+ (\\w) (.*)$");  // address, kind, name
    std::smatch match;
    ASSERT_TRUE(std::regex_match(line, match, entry)) << line;
    n_shown += match[1] == "T";
    EXPECT_TRUE(is_public(match[2], known)) << line;
  }
  EXPECT_GT(n_shown, 100u);

  // By CMake and by pkg-config.
  const auto folder = output_folder();
  Outcome built = build_with_cmake(prefix, examples / "minimal", folder / "minimal");
  ASSERT_EQ(built.status, 0) << built.output;
  expect_minimal_refines(folder / "minimal/minimal");
  built = build_with_cmake(prefix, examples / "c", folder / "c");
  ASSERT_EQ(built.status, 0) << built.output;
  expect_c_adapts(folder / "c/adapt");
  built = build_with_pkg_config(prefix, HEXTWIST_CXX_COMPILER " " HEXTWIST_CXX_FLAGS, examples / "minimal/main.cpp",
                                folder / "minimal-by-pkg-config");
  ASSERT_EQ(built.status, 0) << built.output;
  expect_minimal_refines(folder / "minimal-by-pkg-config");
  built = build_with_pkg_config(prefix, "cc " HEXTWIST_CXX_FLAGS, examples / "c/main.c", folder / "c-by-pkg-config");
  ASSERT_EQ(built.status, 0) << built.output;
  expect_c_adapts(folder / "c-by-pkg-config");

  // The program has the library inside.
  const Outcome program =
      run(quoted(prefix / "bin/hextwist") + " -c 'create brick x 1 y 1 z 1 interval 2 2 2; refine hex 1'");
  EXPECT_EQ(program.status, 0) << program.output;
}

}  // namespace
}  // namespace hextwist::test
