// Physical groups and nothing else, as Gmsh writes files unless told to save all: what meshio and deal.II want.
#include "hextwist/io/gmsh/plan_internal.h"

namespace hextwist::io {

std::vector<Index> keep_groups_only(GmshPlan& plan, const Mesh& mesh, bool split, const SecondOrder* second) {
  std::vector<char> used(mesh.points.size(), 0);
  for (int dim = 0; dim < 4; ++dim) {
    PlannedElements& elements = plan.elements[dim];
    PlannedElements kept;
    kept.first_tag = elements.first_tag;
    const std::size_t width = dim == 3 ? 0 : std::size_t{1} << dim;
    for (PlannedElements::Run run : elements.runs) {
      if (split ? plan.entity(dim, run.entity).physicals.empty() : run.physical == 0) continue;
      for (std::size_t k = run.first; k < run.first + run.n; ++k) kept.items.push_back(elements.item(k));
      kept.nodes.insert(kept.nodes.end(), elements.nodes.begin() + static_cast<std::ptrdiff_t>(width * run.first),
                        elements.nodes.begin() + static_cast<std::ptrdiff_t>(width * (run.first + run.n)));
      run.first = kept.size;
      kept.size += run.n;
      kept.runs.push_back(run);
    }
    elements = std::move(kept);
    for (std::size_t k = 0; k < elements.size; ++k) {
      const auto nodes = gmsh_nodes(mesh, elements, dim, k, second);
      for (const Index n : nodes.all()) used[n] = 1;
    }
  }
  std::vector<Index> nodes;
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    if (used[n]) nodes.push_back(n);
  return nodes;
}

}  // namespace hextwist::io
