#include "hextwist/parts/partition.h"

#include <algorithm>
#include <numeric>
#include <random>

#include "hextwist/base/text.h"
#include "hextwist/mesh/topology.h"

#ifdef HEXTWIST_SCOTCH
#include <scotch/scotch.h>
#include <cstdio>
#endif

namespace hextwist {
namespace {

/// Equal counts in this order.
std::vector<int> in_order(std::span<const Index> order, int n_parts) {
  std::vector<int> part(order.size());
  const auto n = static_cast<std::int64_t>(order.size());
  for (std::int64_t i = 0; i < n; ++i) part[order[i]] = static_cast<int>(i * n_parts / n);
  return part;
}

std::vector<int> by_slabs(std::span<const Vec3> middle, const Box& box, int n_parts) {
  Eigen::Index axis = 0;
  (box.max - box.min).maxCoeff(&axis);
  std::vector<Index> order(middle.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](Index h) { return std::pair(middle[h][axis], h); });
  return in_order(order, n_parts);
}

/// Halves of halves.
std::vector<int> by_boxes(std::span<const Vec3> middle, int n_parts) {
  std::vector<Index> order(middle.size());
  std::iota(order.begin(), order.end(), 0);
  std::vector<int> part(middle.size(), 0);
  const auto halve = [&](const auto& self, std::span<Index> hexes, int first, int n) -> void {
    if (n == 1) {
      for (const Index h : hexes) part[h] = first;
      return;
    }
    Box box;
    for (const Index h : hexes) box.add(middle[h]);
    Eigen::Index axis = 0;
    (box.max - box.min).maxCoeff(&axis);
    const auto at = static_cast<std::ptrdiff_t>(std::ssize(hexes) * (n / 2) / n);
    std::ranges::nth_element(hexes, hexes.begin() + at, {}, [&](Index h) { return std::pair(middle[h][axis], h); });
    self(self, hexes.first(static_cast<std::size_t>(at)), first, n / 2);
    self(self, hexes.subspan(static_cast<std::size_t>(at)), first + n / 2, n - n / 2);
  };
  halve(halve, order, 0, n_parts);
  return part;
}

#ifdef HEXTWIST_SCOTCH
std::vector<int> by_scotch(const Mesh& mesh, int n_parts) {
  // Hexes are neighbours where they share a face.
  std::vector<SCOTCH_Num> first(mesh.hexes.size() + 1, 0), neighbour;
  {
    const Faces all = faces(mesh);
    for (std::size_t h = 0; h < mesh.hexes.size(); ++h) {
      for (const Index f : all.of_hex[h])
        for (const Side& side : all.sides[f])
          if (side.hex >= 0 && side.hex != static_cast<Index>(h)) neighbour.push_back(side.hex);
      first[h + 1] = static_cast<SCOTCH_Num>(neighbour.size());
    }
  }
  SCOTCH_Graph graph;
  SCOTCH_Strat strategy;
  std::vector<SCOTCH_Num> part(mesh.hexes.size());
  SCOTCH_graphInit(&graph);
  SCOTCH_stratInit(&strategy);
  const bool ok =
      SCOTCH_graphBuild(&graph, 0, static_cast<SCOTCH_Num>(mesh.hexes.size()), first.data(), nullptr, nullptr, nullptr,
                        static_cast<SCOTCH_Num>(neighbour.size()), neighbour.data(), nullptr) == 0 &&
      SCOTCH_stratGraphMapBuild(&strategy, SCOTCH_STRATDEFAULT, n_parts, 0.05) == 0 &&
      SCOTCH_graphPart(&graph, n_parts, &strategy, part.data()) == 0;
  SCOTCH_stratExit(&strategy);
  SCOTCH_graphExit(&graph);
  if (!ok) throw Error("SCOTCH could not divide the mesh in " + std::to_string(n_parts) + " parts");
  return {part.begin(), part.end()};
}
#endif

}  // namespace

bool has_scotch() {
#ifdef HEXTWIST_SCOTCH
  return true;
#else
  return false;
#endif
}

std::vector<Vec3> middles_of(const Mesh& mesh) {
  std::vector<Vec3> middle(mesh.hexes.size(), Vec3::Zero());
  for (std::size_t h = 0; h < middle.size(); ++h)
    for (const Index n : mesh.hexes[h]) middle[h] += mesh.points[n];
  return middle;
}

std::vector<int> partition(const Mesh& mesh, int n_parts, PartitionBy by) {
  if (by == PartitionBy::scotch && n_parts >= 1 && n_parts <= mesh.n_hexes()) {
#ifdef HEXTWIST_SCOTCH
    std::vector<int> part = by_scotch(mesh, n_parts);
    std::vector<char> has(static_cast<std::size_t>(n_parts), 0);
    for (const int p : part) has[p] = 1;
    // Of a few hexes a part, some can come out empty.
    if (std::ranges::all_of(has, [](char yes) { return yes != 0; })) return part;
#else
    throw Error("this program was built without SCOTCH (Debian: libscotch-dev); divide by slabs or ids instead");
#endif
  }
  return partition(middles_of(mesh), box(mesh), n_parts, by);
}

std::vector<int> partition(std::span<const Vec3> middles, const Box& box, int n_parts, PartitionBy by) {
  if (n_parts < 1) throw Error("the number of parts must be at least 1");
  if (n_parts > std::ssize(middles))
    throw Error("a mesh of " + counted(std::ssize(middles), "hex", "hexes") + " has no " + std::to_string(n_parts) +
                " parts");
  if (by == PartitionBy::boxes) return by_boxes(middles, n_parts);
  if (by == PartitionBy::slabs || by == PartitionBy::scotch) return by_slabs(middles, box, n_parts);
  std::vector<Index> order(middles.size());
  std::iota(order.begin(), order.end(), 0);
  std::mt19937 random(1);
  if (by == PartitionBy::random)
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random() % i]);
  return in_order(order, n_parts);
}

PartitionBy partition_by(std::string_view word) {
  if (word == "slabs") return PartitionBy::slabs;
  if (word == "boxes") return PartitionBy::boxes;
  if (word == "ids") return PartitionBy::ids;
  if (word == "random") return PartitionBy::random;
  return word == "scotch" || has_scotch() ? PartitionBy::scotch : PartitionBy::slabs;
}

}  // namespace hextwist
