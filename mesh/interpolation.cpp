#include "hextwist/mesh/interpolation.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "hextwist/base/parallel.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/locate.h"
#include "hextwist/mesh/nodal_fields.h"

namespace hextwist {
namespace {

void check(const Mesh& mesh, std::span<const Vec3> points) {
  if (mesh.hexes.empty()) throw Error("there is no mesh to look for points in");
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!points[i].allFinite()) throw Error("points[" + std::to_string(i) + "]: a coordinate is not finite");
}

/// onwards: outside of the hex by its slope, else the value at the nearest place.
Interpolation weighed(const Mesh& mesh, std::span<const Vec3> points, std::span<const HexPlace> places, bool onwards) {
  Interpolation result{std::vector<Index>(points.size()), std::vector<double>(8 * points.size()),
                       std::vector<double>(points.size())};
  parallel_each(points.size(), [&](std::size_t i) {
    const HexPlace& place = places[i];
    const std::array<Vec3, 8> corners = corners_of(mesh, place.hex);
    result.hexes[i] = place.hex;
    result.distances[i] = place.distance;
    double* const weight = result.weights.data() + 8 * i;
    const auto same = std::ranges::find(corners, points[i]);
    if (same != corners.end()) {
      weight[same - corners.begin()] = 1;
      return;
    }
    const Vec3 inside = place.at.cwiseMax(0.0).cwiseMin(1.0);
    const Vec3 to = onwards || place.distance == 0 ? points[i] : trilinear_point(corners, inside);
    std::ranges::copy(weights_at(corners, inside, to), weight);
  });
  return result;
}

}  // namespace

Interpolation interpolation_at(const Mesh& mesh, std::span<const Vec3> points) {
  check(mesh, points);
  const HexLocator locator(mesh);
  std::vector<HexPlace> places(points.size());
  parallel_each(
      points.size(), [&](std::size_t i) { places[i] = locator.locate(points[i]); }, 64);
  return weighed(mesh, points, places, false);
}

Interpolation prolongation(const Mesh& before, const Mesh& after, std::span<const Index> origin) {
  check(before, after.points);
  if (!origin.empty() && origin.size() != after.hexes.size())
    throw Error("there are " + std::to_string(origin.size()) + " origins for " + std::to_string(after.n_hexes()) +
                " hexes");
  for (std::size_t h = 0; h < origin.size(); ++h)
    if (origin[h] < 0 || origin[h] >= before.n_hexes())
      throw Error("origin[" + std::to_string(h) + "]: there is no hex " + std::to_string(origin[h]));
  std::vector<Index> nodes(after.points.size());
  std::iota(nodes.begin(), nodes.end(), 0);
  std::vector<Index> begin(nodes.size(), std::numeric_limits<Index>::max());
  if (!origin.empty()) begin = hexes_to_begin_with(after, nodes, origin);
  // Nodes of no hex, and all where nothing is known, are found by their place.
  const auto is_lost = [&](Index n) { return begin[n] == std::numeric_limits<Index>::max(); };
  if (std::ranges::any_of(nodes, is_lost)) {
    const HexLocator locator(before);
    parallel_each(
        nodes.size(),
        [&](std::size_t n) {
          if (is_lost(static_cast<Index>(n))) begin[n] = locator.locate(after.points[n]).hex;
        },
        64);
  }
  return weighed(before, after.points, find_places(before, after.points, begin), true);
}

SparseRows sparse_rows(const Mesh& mesh, const Interpolation& at) {
  SparseRows rows;
  const auto each = [&](std::size_t i, const auto& use) {
    std::array<std::pair<Index, double>, 8> entries;
    for (int c = 0; c < n_hex_corners; ++c)
      entries[c] = {mesh.hexes[at.hexes[i]][c], at.weights[8 * i + static_cast<std::size_t>(c)]};
    std::ranges::sort(entries, {}, &std::pair<Index, double>::first);
    for (const auto& [node, weight] : entries)
      if (weight != 0) use(node, weight);
  };
  rows.first.resize(at.hexes.size() + 1);
  parallel_each(at.hexes.size(), [&](std::size_t i) { each(i, [&](Index, double) { ++rows.first[i + 1]; }); });
  std::partial_sum(rows.first.begin(), rows.first.end(), rows.first.begin());
  rows.columns.resize(static_cast<std::size_t>(rows.first.back()));
  rows.values.resize(rows.columns.size());
  parallel_each(at.hexes.size(), [&](std::size_t i) {
    auto k = static_cast<std::size_t>(rows.first[i]);
    each(i, [&](Index node, double weight) {
      rows.columns[k] = node;
      rows.values[k++] = weight;
    });
  });
  return rows;
}

std::vector<double> values_at(const Mesh& mesh, const Field& field, const Interpolation& at) {
  const auto width = static_cast<std::size_t>(field.components);
  std::vector<double> values(at.hexes.size() * width);
  parallel_each(at.hexes.size(), [&](std::size_t i) {
    const auto from = [&](Index item) { return field.values.data() + static_cast<std::size_t>(item) * width; };
    const auto to = values.begin() + static_cast<std::ptrdiff_t>(i * width);
    if (field.on == Field::On::hex) {
      std::copy_n(from(at.hexes[i]), width, to);
      return;
    }
    const Hex& hex = mesh.hexes[at.hexes[i]];
    const std::span<const double, 8> weight(at.weights.data() + 8 * i, 8);
    if (field.integer) {
      std::copy_n(from(hex[std::ranges::max_element(weight) - weight.begin()]), width, to);
      return;
    }
    for (std::size_t c = 0; c < weight.size(); ++c)
      if (weight[c] != 0)
        for (std::size_t k = 0; k < width; ++k) to[static_cast<std::ptrdiff_t>(k)] += weight[c] * from(hex[c])[k];
  });
  return values;
}

}  // namespace hextwist
