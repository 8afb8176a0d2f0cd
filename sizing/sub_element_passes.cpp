// Parallel hex sheet operations and the combination: around nodes, edges and faces.
#include "hextwist/refine/enclose.h"
#include "hextwist/refine/trisect.h"
#include "hextwist/sizing/pipeline_internal.h"
#include "hextwist/sizing/targets.h"

namespace hextwist {

void sub_element_passes(Pipeline& run, Method method) {
  CombinationTarget target = sub_element_target(run.input(), run.request(), run.report().notices);
  const EncloseAt at = method == Method::parallel ? EncloseAt::half : EncloseAt::third;
  for (int i = 0; i < run.request().numsplit; ++i) {
    run.stages().begin("close", run.fraction());
    std::vector<std::uint8_t> marked(run.current().mesh.points.size(), 0);
    for (const Index n : target.nodes) marked[n] = 1;
    const Index n_added = close_enclosure(run.current().mesh.hexes, marked);
    if (n_added > 0)
      run.report().notices.push_back("enclosed " + std::to_string(n_added) +
                                     " nodes more than the target has, for want of a template");
    run.pass(enclose_table(at), enclose_codes(run.current().mesh.hexes, marked));
    target = carried_target(target, run.lineage(), run.current().mesh);
    if (method == Method::parallel || (target.edges.empty() && target.faces.empty())) continue;
    run.stages().begin("close", run.fraction());
    run.pass(trisect_table(), combination_codes(run.current().mesh, target));
    target = carried_target(target, run.lineage(), run.current().mesh);
  }
}

}  // namespace hextwist
