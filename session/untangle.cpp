#include <algorithm>

#include "hextwist/base/sorted.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/mesh/smooth/smooth.h"
#include "hextwist/mesh/validate/validate.h"
#include "hextwist/session/untangle.h"

namespace hextwist {
namespace {

constexpr int band_layers = 2;
constexpr int sweeps_after = 10;  // so that hexes are not only just right
constexpr int max_sweeps = 300;

/// True when no hex is inverted any more.
bool untangle(const Transaction& run, Mesh& mesh, Association& association, const Model* model,
              const std::vector<Index>& around, bool boundary) {
  SmoothOptions options;
  options.scheme = SmoothScheme::untangle;
  options.fix_boundary = !boundary;
  options.iterations = max_sweeps;
  options.nodes.emplace();
  std::vector<char> wanted(mesh.points.size(), 0);
  for (const Index h : around)
    for (const Index node : mesh.hexes[h]) wanted[node] = 1;
  for (Index node = 0; node < mesh.n_nodes(); ++node)
    if (wanted[node]) options.nodes->push_back(node);
  const auto progress = [&](const char* stage, double fraction) {
    return !run.core.callbacks.progress || run.core.callbacks.progress(stage, fraction);
  };
  SmoothReport report = smooth(mesh, association, model, options, progress);
  if (report.stopped) throw Cancelled();
  if (!report.not_repaired.empty()) return false;
  options.scheme = SmoothScheme::mean_ratio;
  options.iterations = sweeps_after;
  report = smooth(mesh, association, model, options, progress);
  if (report.stopped) throw Cancelled();
  return true;
}

}  // namespace

std::vector<Index> inverted_among(const std::vector<Violation>& violations) {
  std::vector<Index> result;
  for (const Violation& violation : violations) {
    if (is_warning(violation.kind)) continue;
    // A node of a tangled skin lies inside faces that it does not belong to.
    if (violation.kind == ViolationKind::hanging_node) continue;
    if (violation.kind != ViolationKind::inverted) return {};
    result.insert(result.end(), violation.hexes.begin(), violation.hexes.end());
  }
  sort_unique(result);
  return result;
}

bool untangle_mesh(const Transaction& run, Mesh& mesh, Association& association, const Model* model,
                   const std::vector<Index>& inverted, bool boundary) {
  std::vector<Index> all(mesh.hexes.size());
  for (Index h = 0; h < mesh.n_hexes(); ++h) all[h] = h;
  return untangle(run, mesh, association, model, with_layers(mesh, inverted, band_layers), boundary) ||
         untangle(run, mesh, association, model, all, boundary);
}

std::string untangled_text(const Mesh& mesh, const std::vector<Vec3>& before, const std::vector<Index>& inverted) {
  constexpr std::size_t max_ids = 5;
  std::string line = counted(static_cast<std::int64_t>(inverted.size()), EntityKind::hex) +
                     (inverted.size() == 1 ? " was" : " were") + " inverted (hex";
  for (std::size_t i = 0; i < std::min(inverted.size(), max_ids); ++i)
    line += " " + std::to_string(hex_id(mesh, inverted[i]));
  if (inverted.size() > max_ids) line += " ...";
  std::int64_t n_moved = 0;
  double farthest = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double way = (mesh.points[i] - before[i]).norm();
    if (way > 0) ++n_moved;
    farthest = std::max(farthest, way);
  }
  return line + "): untangled, " + counted(n_moved, EntityKind::node) + " moved by at most " + short_number(farthest);
}

}  // namespace hextwist
