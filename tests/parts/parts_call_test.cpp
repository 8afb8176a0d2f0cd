// Programs that have their mesh in parts: the call, and PETSc through it.
#include <gtest/gtest.h>

#include "io/io_support.h"
#include "ranks_support.h"
#include "support/seed.h"

namespace hextwist {
namespace {

using test::model;
using test::Outcome;

/// In every third try rank 1 begins with nothing.
void expect_same(int n, const std::string& mesh_and_cad, const std::string& commands,
                 unsigned seed = test::random_seed() % 1000000) {
  const std::string arguments = mesh_and_cad + " " + std::to_string(seed) + " " + commands;
  SCOPED_TRACE(std::to_string(n) + " ranks: " + arguments);
  const Outcome outcome = test::run_program_in_ranks(n, HEXTWIST_PARTS_CALL, arguments);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("hexes in " + std::to_string(n) + " parts are those of one"), std::string::npos);
}

TEST(PartsCall, gives_arrays_of_parts_what_one_process_makes_of_the_whole) {
  const std::string cam = model("cam.msh") + " " + model("cam.brep");
  expect_same(3, cam, "'refine curve 1 depth 1' 'refine hex 1 2 transition nested'");
  expect_same(2, model("bracket.msh") + " -", "'refine node 5 depth 1'");
  expect_same(2, cam, "'refine curve 1 depth 1'", 3);
  expect_same(4, model("bracket.msh") + " -", "'refine hex 7 8 9 depth 1' 'refine node 70 transition nested'");
}

TEST(PartsCall, says_what_is_wrong_on_all_ranks) {
  const Outcome outcome =
      test::run_program_in_ranks(2, HEXTWIST_PARTS_CALL, model("bracket.msh") + " - 1 'refine hex 99999999'");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("error: "), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("99999999"), std::string::npos) << outcome.err;
}

TEST(PartsCall, a_DMPlex_in_parts_is_refined_and_sound) {
#ifdef HEXTWIST_PETSC_PARTS
  // One process and three say the same.
  std::string last;
  for (const int n : {1, 3}) {
    const Outcome outcome = test::run_program_in_ranks(n, HEXTWIST_PETSC_PARTS, "5 'refine node 1 depth 1'");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const auto at = outcome.out.rfind("125 -> ");
    ASSERT_NE(at, std::string::npos) << outcome.out << outcome.err;
    EXPECT_NE(outcome.out.find("DMPlexCheck finds nothing; volume 1.000\n", at), std::string::npos) << outcome.out;
    last = n == 1 ? outcome.out.substr(at) : last;
  }
#else
  GTEST_SKIP() << "there is no PETSc (Debian: petsc-dev)";
#endif
}

}  // namespace
}  // namespace hextwist
