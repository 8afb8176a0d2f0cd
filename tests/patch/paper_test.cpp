// The refinements of the paper's tables on our own models: counts, and better shapes than the paper's.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "support/checkers.h"
#include "support/paper_cases.h"

namespace hextwist {
namespace {

/// What every refined case must fulfil; the unrefined one must be no better than the paper's.
void check(const test::PaperCase& paper_case) {
  SCOPED_TRACE(paper_case.figure);
  const test::PaperResult result = test::run(paper_case);
  if (paper_case.exact_hexes > 0) {
    EXPECT_EQ(result.plain.hexes, paper_case.exact_hexes);
  }
  if (result.smoothed.hexes == 0) {
    EXPECT_LE(result.plain.min, paper_case.paper.min);
    EXPECT_LE(result.plain.average, paper_case.paper.average);
    return;
  }
  EXPECT_TRUE(test::conformal(result.refined.refined.mesh));
  EXPECT_TRUE(test::uninverted(result.refined.refined.mesh));
  EXPECT_TRUE(result.refined.report.off_nodes.empty());
  EXPECT_GT(result.smoothed.min, paper_case.paper_smoothed.min);
  EXPECT_GT(result.smoothed.average, paper_case.paper_smoothed.average);
  EXPECT_GE(result.smoothed.min, result.plain.min);
}

void check(const std::string& figure) {
  const auto cases = test::paper_cases();
  const auto found = std::ranges::find(cases, figure, &test::PaperCase::figure);
  ASSERT_NE(found, cases.end());
  check(*found);
}

TEST(paper, unrefined_models_are_no_better_than_the_paper_s) {
  for (const char* figure : {"7(a)", "16(a)", "17(a)"}) check(figure);
}

TEST(paper, a_curve_and_a_surface_of_figure_7_have_its_counts_and_better_shapes) {
  check("7(c)");
  check("7(d)");
}

TEST(paper, combination_along_a_curve_stays_within_one_original_element_as_figure_17b) {
  check("17(b)");
  const auto cases = test::paper_cases();
  const test::PaperResult result = test::run(*std::ranges::find(cases, "17(b)", &test::PaperCase::figure));
  const Mesh& before = result.input.mesh;
  const Mesh& after = result.refined.refined.mesh;
  std::set<Index> on_curve;
  for (const Edge& edge : result.input.association.curve_edges) on_curve.insert(edge.begin(), edge.end());
  // Every cut hex has a node on a rim or the seam, so what is refined lies within one element; the others are as
  // before.
  Index n_kept = 0;
  for (Index h = 0; h < before.n_hexes(); ++h) {
    const bool touches = std::ranges::any_of(before.hexes[h], [&](Index n) {
      return on_curve.contains(n) && (before.points[n].z() < 1e-9 || before.points[n].z() > 40 - 1e-9);
    });
    const Index now = find_hex(after, hex_id(before, h));
    EXPECT_EQ(now < 0, touches) << h;
    if (now >= 0) {
      EXPECT_EQ(after.hexes[now], before.hexes[h]);
      ++n_kept;
    }
  }
  EXPECT_GT(n_kept, before.n_hexes() / 2);
}

TEST(Paper, every_row_has_better_shapes_than_the_paper_s) {
  for (const test::PaperCase& paper_case : test::paper_cases()) check(paper_case);
}

}  // namespace
}  // namespace hextwist
