// A body lies beside its prototype: who reads a header finds what it declares in the same folder, or in one below it
// (a reader of a format, a command), and no two folders hide in each other.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "prototypes.h"
#include "source_tree.h"

namespace hextwist::test {
namespace {

using Bodies = std::map<std::string, std::set<std::filesystem::path>>;  // name: folders

/// Prototypes of a header that have no body where it should be. folder: of the header.
std::vector<std::string> body_offences(const std::filesystem::path& folder, const std::string& header,
                                       const Bodies& bodies) {
  std::vector<std::string> offences;
  for (const FunctionSeen& each : functions_in(header)) {
    if (each.is_body) continue;
    const auto found = bodies.find(each.name);
    bool is_beside = false;
    if (found != bodies.end())
      for (const auto& theirs : found->second)
        is_beside = is_beside || !theirs.lexically_relative(folder).string().starts_with("..");
    if (!is_beside)
      offences.push_back(each.name +
                         (found == bodies.end() ? " has no body" : " is in " + found->second.begin()->string()));
  }
  return offences;
}

TEST(Bodies, lie_beside_their_prototypes) {
  Bodies bodies;
  for (const auto& layer : layers)
    for (const auto& file : files_below(layer, {".cpp"}))
      for (const auto& each : functions_in(content(file)))
        if (each.is_body) bodies[each.name].insert(file.parent_path());
  EXPECT_GT(bodies.size(), 300u) << "the scanner sees few bodies";
  std::size_t n_prototypes = 0;
  for (const auto& layer : layers)
    for (const auto& file : files_below(layer, {".h"})) {
      for (const auto& each : functions_in(content(file))) n_prototypes += !each.is_body;
      for (const auto& offence : body_offences(file.parent_path(), content(file), bodies))
        ADD_FAILURE() << file << ": " << offence;
    }
  EXPECT_GT(n_prototypes, 300u) << "the scanner sees few prototypes";
}

TEST(Bodies, scanner_sees_functions_at_namespace_scope) {
  const auto seen = functions_in(R"(
#define NOT_A_FUNCTION(x) f(x); \
  g(x);
// int comment(int);
namespace HEXTWIST_API a {
const char* name(Kind kind);  /* int other(); */
std::vector<std::pair<int, int>> two(std::map<int, int> list = {}, const Options& options = {1, 2});
inline int hidden() { return 0; }
template <class T> void also_hidden(T t);
struct S { void member(); int x = f(1); };
inline constexpr double infinite = limits<double>::infinity();
namespace { int inside(int i) { return i; } }
namespace detail { void deep(); }
void S::member() { call(R"x(a ; ")x"); }
int body(char c, int n) try { if (c == ';' && n == 1'000) { call(c); } } catch (...) {}
extern "C" { int c_function(void); }
}
)");
  const std::vector<FunctionSeen> expected = {{"a::name/1", false},         {"a::two/2", false},
                                              {"a::detail::deep/0", false}, {"a::S::member/0", true},
                                              {"a::body/2", true},          {"a::c_function/0", false}};
  EXPECT_EQ(seen, expected) << testing::PrintToString([&] {
    std::vector<std::string> names;
    for (const auto& each : seen) names.push_back(each.name + (each.is_body ? " {}" : ";"));
    return names;
  }());
}

TEST(Bodies, checker_finds_a_body_elsewhere_and_none_at_all) {
  const std::string header = "namespace a { int f(int x); int g(); }";
  EXPECT_EQ(body_offences("mesh", header, {{"a::f/1", {"mesh"}}, {"a::g/0", {"geom", "mesh/smooth"}}}).size(), 0u);
  EXPECT_EQ(body_offences("mesh", header, {{"a::f/1", {"geom"}}, {"a::g/0", {"mesh"}}}),
            std::vector<std::string>{"a::f/1 is in geom"});
  EXPECT_EQ(body_offences("mesh/smooth", header, {{"a::f/1", {"mesh"}}, {"a::g/0", {"mesh/smooth"}}}).size(), 1u);
  EXPECT_EQ(body_offences("mesh", header, {{"a::f/2", {"mesh"}}, {"a::g/0", {"mesh"}}}),
            std::vector<std::string>{"a::f/1 has no body"});
}

}  // namespace
}  // namespace hextwist::test
