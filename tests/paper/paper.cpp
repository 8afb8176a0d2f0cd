// Prints the paper's tables 2 to 4 beside the same refinements of our own models, as the table in docs/paper.md.
#include <cstdio>

#include "support/paper_cases.h"

namespace {

using hextwist::test::PaperRow;

void print(const std::string& figure, const char* state, const std::string& ours, const PaperRow& paper,
           const PaperRow& row) {
  std::printf("| %s%s | %s | %lld | %.3f | %.3f | %.3f | %.3f | %lld | %.3f | %.3f | %.3f | %.3f |\n", figure.c_str(),
              state, ours.c_str(), static_cast<long long>(paper.hexes), paper.average, paper.std_dev, paper.min,
              paper.max, static_cast<long long>(row.hexes), row.average, row.std_dev, row.min, row.max);
  std::fflush(stdout);
}

}  // namespace

int main() {
  std::puts(
      "| figure | ours | paper: hexes | average | std. dev. | min. | max. | ours: hexes | average | std. dev. | min. | "
      "max. |");
  std::puts("|---|---|---|---|---|---|---|---|---|---|---|---|");
  for (const auto& one : hextwist::test::paper_cases()) {
    const auto result = hextwist::test::run(one);
    print(one.figure, "", one.model + ": " + one.what, one.paper, result.plain);
    if (result.smoothed.hexes > 0) print(one.figure, " smoothed", "", one.paper_smoothed, result.smoothed);
  }
}
