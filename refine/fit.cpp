// Where the templates come out badly, their nodes go where the worst hex around is best.
#include <algorithm>

#include "hextwist/base/parallel.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/mesh/smooth/lift.h"
#include "hextwist/refine/place.h"

namespace hextwist {
namespace {

constexpr double threshold = 0.35;
constexpr int n_sweeps = 6;

}  // namespace

void fit_children(const Split& split, const Model* model, Mesh& mesh, Association& association) {
  const Lineage& lineage = split.lineage;
  const SplitTable& table = *lineage.table;
  const auto n_children = [&](std::size_t i) { return table.hex(lineage.hexes[i].code).children.size(); };
  std::vector<std::uint8_t> bad(lineage.hexes.size());
  parallel_each(
      bad.size(),
      [&](std::size_t i) {
        const Index first = lineage.hexes[i].first_child, n = static_cast<Index>(n_children(i));
        for (Index h = first; h < first + n && !bad[i]; ++h)
          bad[i] = quality(Metric::scaled_jacobian, mesh, h) < threshold;
      },
      64);
  for (const bool on_surfaces : {false, true}) {
    if (on_surfaces && (association.empty() || !model)) break;
    std::vector<std::uint8_t> wanted(lineage.faces.size());
    std::vector<Index> nodes, hexes;
    std::vector<Owner> owners;
    const auto add_nodes = [&](Index first, std::size_t n, Owner owner) {
      for (std::size_t s = 0; s < n; ++s) {
        nodes.push_back(first + static_cast<Index>(s));
        owners.push_back(owner);
      }
    };
    for (std::size_t i = 0; i < bad.size(); ++i)
      if (bad[i])
        for (const Index face : split.hex_faces[i])
          if (face >= 0) wanted[face] = 1;
    for (std::size_t f = 0; f < wanted.size(); ++f) {
      if (!wanted[f]) continue;
      const CutFace& face = lineage.faces[f];
      const Owner owner = association.empty() ? Owner{3, 0} : association.node_owner[face.first_node];
      // Without a model the skin stays: a face that only one hex has.
      if (owner.dim == 3 || on_surfaces) add_nodes(face.first_node, table.face[face.code].at.size(), owner);
    }
    for (std::size_t i = 0; i < bad.size(); ++i)
      if (bad[i]) add_nodes(lineage.hexes[i].first_node, table.hex(lineage.hexes[i].code).inside.size(), {3, 0});
    for (std::size_t i = 0; i < bad.size(); ++i)
      if (bad[i] || std::ranges::any_of(split.hex_faces[i], [&](Index f) { return f >= 0 && wanted[f]; }))
        for (Index h = lineage.hexes[i].first_child, n = static_cast<Index>(n_children(i)); n > 0; --n)
          hexes.push_back(h++);
    if (nodes.empty()) return;
    lift_scaled_jacobians(mesh, association, model, nodes, owners, hexes, threshold, n_sweeps);
  }
}

}  // namespace hextwist
