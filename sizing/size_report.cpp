#include "hextwist/sizing/size_report.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hextwist/base/parallel.h"
#include "hextwist/base/text.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/sizing/targets.h"

namespace hextwist {

std::vector<double> actual_sizes(const Mesh& mesh, std::span<const Index> hexes) {
  std::vector<double> sizes(hexes.size());
  parallel_each(hexes.size(), [&](std::size_t i) { sizes[i] = std::cbrt(std::abs(volume(mesh, hexes[i]))); });
  return sizes;
}

std::vector<double> wished_sizes(const Mesh& mesh, std::span<const Index> hexes, const SizeField& wish) {
  const std::vector<Vec3> centres = centroids(mesh, hexes);
  std::vector<double> wished(hexes.size());
  wish.evaluate(centres, wished);
  return wished;
}

std::array<double, 3> lengths(const Mesh& mesh, Index hex) {
  std::array<double, 3> longest{};
  const Hex& nodes = mesh.hexes[hex];
  for (int e = 0; e < n_hex_edges; ++e) {
    double& length = longest[e >> 2];
    length = std::max(length, (mesh.points[nodes[edge_corner(e, 1)]] - mesh.points[nodes[edge_corner(e, 0)]]).norm());
  }
  return longest;
}

DirectionSizes direction_sizes(const Mesh& mesh, std::span<const Index> hexes, const SizeField& wish) {
  DirectionSizes sizes;
  const std::vector<double> wished = wished_sizes(mesh, hexes, wish);
  for (std::size_t i = 0; i < hexes.size(); ++i)
    for (const double length : lengths(mesh, hexes[i])) {
      sizes.n_longer += length > std::numbers::sqrt3 * wished[i];
      sizes.n_shorter += length < wished[i] / std::numbers::sqrt3;
    }
  return sizes;
}

std::string text_of_sizes(const SizesMet& counts) {
  return short_number(100 * counts.met()) + "% within a factor of sqrt(3), " + std::to_string(counts.n_coarser) +
         " coarser, " + std::to_string(counts.n_finer) + " finer (" + std::to_string(counts.n_much_finer) +
         " by more than 3)";
}

SizeReport size_report(const Mesh& mesh, std::vector<Index> hexes, const SizeField& wish) {
  SizeReport report;
  std::vector<double> wished = wished_sizes(mesh, hexes, wish);
  std::size_t n = 0;
  for (std::size_t i = 0; i < hexes.size(); ++i) {
    if (!std::isfinite(wished[i])) continue;  // no wish here
    hexes[n] = hexes[i];
    wished[n++] = wished[i];
  }
  hexes.resize(n);
  report.ratio = actual_sizes(mesh, hexes);
  for (std::size_t i = 0; i < hexes.size(); ++i) {
    double& ratio = report.ratio[i];
    ratio /= wished[i];
    report.n_coarser += is_coarser(ratio);
    report.n_finer += is_finer(ratio);
    report.n_much_finer += ratio < 1.0 / 3;
  }
  report.hexes = std::move(hexes);
  return report;
}

}  // namespace hextwist
