// Single hex sheet operations: whole hexes and layers of them.
#include "hextwist/refine/templates/trisect.h"
#include "hextwist/refine/marks.h"
#include "hextwist/sizing/levels.h"
#include "hextwist/sizing/pipeline.h"
#include "hextwist/sizing/targets.h"

namespace hextwist {

void trisect_passes(Pipeline& run) {
  std::vector<Index> targets = region_target(run.input(), run.request(), run.report().notices);
  for (int i = 0; i < run.request().numsplit; ++i) {
    if (i > 0) run.smooth_between_passes();
    run.stages().begin("close", run.fraction());
    const Mesh& mesh = run.current().mesh;
    std::vector<std::uint8_t> marked(mesh.points.size(), 0);
    mark_nodes(mesh.hexes, targets, marked);
    if (run.request().concave == Concave::fill) run.report().filled_hexes += fill_concave(mesh, marked);
    if (run.request().levels == Levels::graded)
      say_graded(grade_marks(mesh, run.request().concave, marked), run.report().notices);
    run.pass(trisect_table(), trisect_codes(mesh.hexes, marked));
    if (i + 1 < run.request().numsplit) targets = children_of(run.lineage(), targets);
  }
}

}  // namespace hextwist
