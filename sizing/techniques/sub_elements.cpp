// Parallel hex sheet operations and the combination: around nodes, edges and faces.
#include <algorithm>

#include "hextwist/refine/templates/enclose.h"
#include "hextwist/refine/templates/trisect.h"
#include "hextwist/sizing/pipeline.h"
#include "hextwist/sizing/targets.h"

namespace hextwist {
namespace {

/// A hex without a template may bring so many nodes along; where it would take more, nodes are enclosed one after the
/// other instead.
constexpr Index max_growth = 2;

/// What the enclosing of one round did, over all rounds.
struct Enclosed {
  Index n_added = 0;  ///< nodes that are not of the target
  Index n_first = 0;  ///< nodes that had to go before the others
};

/// Encloses the target's nodes, in parts where they can't be all at once. uncut: loses the edges that get cut.
void enclose(Pipeline& run, EncloseAt at, CombinationTarget& target, std::vector<Edge>& uncut, Enclosed& done,
             const std::function<void()>& after_pass = {}) {
  std::vector<Index> rest = target.nodes;
  while (!rest.empty()) {
    run.stages().begin("close", run.fraction());
    const Mesh& mesh = run.current().mesh;
    std::vector<std::uint8_t> marked(mesh.points.size(), 0);
    for (const Index n : rest) marked[n] = 1;
    done.n_added += close_enclosure_nearby(mesh, marked, max_growth);
    const std::vector<std::uint8_t> part = enclosable_part(mesh.hexes, marked);
    std::erase_if(rest, [&](Index n) { return part[n] != 0; });
    if (!rest.empty()) done.n_first += static_cast<Index>(std::ranges::count(part, 1));
    run.pass(enclose_table(at), enclose_codes(mesh.hexes, part));
    if (after_pass) after_pass();
    target = carried_target(target, run.lineage(), run.current().mesh);
    std::erase_if(uncut, [&](const Edge& edge) {
      return std::ranges::binary_search(run.lineage().edges, edge, {}, [](const CutEdge& cut) {
        return Edge{cut.a, cut.b};
      });
    });
  }
}

void say(const Enclosed& done, std::vector<std::string>& notices) {
  const auto nodes = [](Index n) { return std::to_string(n) + (n == 1 ? " node" : " nodes"); };
  if (done.n_first > 0) notices.push_back(nodes(done.n_first) + " where targets meet enclosed before the others");
  if (done.n_added > 0) notices.push_back(nodes(done.n_added) + " beside the target enclosed with it");
}

}  // namespace

void combination_round(Pipeline& run, CombinationTarget target, const std::function<void()>& after_pass) {
  Enclosed done;
  std::vector<Edge> uncut = target_edges(target);
  enclose(run, EncloseAt::third, target, uncut, done, after_pass);
  say(done, run.report().notices);
  if (uncut.empty()) return;
  run.stages().begin("close", run.fraction());
  run.pass(trisect_table(), combination_codes(run.current().mesh, target, uncut));
  after_pass();
}

void sub_element_passes(Pipeline& run, Method method) {
  CombinationTarget target = sub_element_target(run.input(), run.request(), run.report().notices);
  const EncloseAt at = method == Method::parallel ? EncloseAt::half : EncloseAt::third;
  Enclosed done;
  for (int i = 0; i < run.request().numsplit; ++i) {
    if (i > 0) run.smooth_between_passes();
    std::vector<Edge> uncut = target_edges(target);
    enclose(run, at, target, uncut, done);
    if (method == Method::parallel || uncut.empty()) continue;
    run.stages().begin("close", run.fraction());
    run.pass(trisect_table(), combination_codes(run.current().mesh, target, uncut));
    target = carried_target(target, run.lineage(), run.current().mesh);
  }
  say(done, run.report().notices);
}

}  // namespace hextwist
