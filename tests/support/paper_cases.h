// The refinements of the paper's tables 2 to 4 on models of our own that stand for its: similar sizes, unrefined
// smallest shape no better. For `./dev paper` and its test.
#pragma once

#include <string>
#include <vector>

#include "hextwist/patch/refine.h"

namespace hextwist::test {

/// A row of a table: shape of all hexes.
struct PaperRow {
  std::int64_t hexes = 0;
  double average = 0, std_dev = 0, min = 0, max = 0;
};

/// A refinement, or the unrefined model of a figure (figure ends with "(a)").
struct PaperCase {
  std::string figure;            ///< the paper's, e.g. "7(c)"
  std::string model;             ///< ours, in models/
  std::string what;              ///< what is refined in ours
  std::int64_t exact_hexes = 0;  ///< what ours must have after refinement, 0: not derived by hand
  PaperRow paper;                ///< before smoothing
  PaperRow paper_smoothed;       ///< hexes 0: none
};
std::vector<PaperCase> paper_cases();

struct PaperResult {
  PaperRow plain, smoothed;  ///< smoothed: hexes 0 for unrefined models
  MeshedModel input;
  RefineResult refined;  ///< before smoothing
};
/// Reads the model, refines it, and smooths the result: all of it, nodes sliding on the CAD, for a higher smallest
/// shape and an average that rises by 0.02 where it can.
PaperResult run(const PaperCase& paper_case);

}  // namespace hextwist::test
