// How good refined boxes are, beside what free optimisation of all new nodes reaches: the table in docs/design.md.
//
//   hextwist_boxes [ROUNDS [RATIO...]]
//
// The middle one of 3 x 3 x 3 boxes, 1 x 1 x r and 1 x r x r, is refined at each set of its corners (one of those that
// are alike). Free: every new node, those on edges too, goes where the sum of q^-p over the hexes around it is
// smallest, q their scaled Jacobian, p rising; by trial of random steps, from the templates' places and from the lifted
// ones. So it is a lower bound of what can be had.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <random>
#include <set>
#include <vector>

#include "hextwist/mesh/primitives.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/refine/carry.h"
#include "hextwist/refine/marks.h"
#include "hextwist/refine/templates/trisect.h"
#include "hextwist/sizing/lift_new.h"

namespace {

using namespace hextwist;

double worst(const Mesh& mesh) {
  return summarize(quality(Metric::scaled_jacobian, mesh)).min;
}

double energy(const Mesh& mesh, std::span<const Index> hexes, double p) {
  double sum = 0;
  for (const Index h : hexes) {
    const double q = quality(Metric::scaled_jacobian, corners_of(mesh, h));
    if (q < 1e-3) return INFINITY;
    sum += std::pow(q, -p);
  }
  return sum;
}

/// The smallest scaled Jacobian after nodes from `first` on have gone where they want to.
double freely(Mesh mesh, Index first, const Vec3& box, int n_rounds) {
  double best = worst(mesh);
  std::vector<std::vector<Index>> around(mesh.points.size());
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    for (const Index n : mesh.hexes[h]) around[n].push_back(h);
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (const double p : {4.0, 8.0, 16.0, 40.0, 100.0})
    for (const double step : {0.1, 0.03, 0.01, 0.003}) {
      for (int round = 0; round < n_rounds; ++round)
        for (Index n = first; n < mesh.n_nodes(); ++n) {
          const double before = energy(mesh, around[n], p);
          const Vec3 from = mesh.points[n];
          for (int axis = 0; axis < 3; ++axis) mesh.points[n][axis] += step * box[axis] * normal(random);
          if (!(energy(mesh, around[n], p) < before)) mesh.points[n] = from;
        }
      best = std::max(best, worst(mesh));
    }
  return best;
}

/// The least number of those sets of corners that mirroring the box, or exchanging its two equal sides, makes of this.
int representative(int corners, int equal_side, int other_equal_side) {
  int least = 255;
  for (int mirrored = 0; mirrored < 8; ++mirrored)
    for (const bool exchanged : {false, true}) {
      int image = 0;
      for (int c = 0; c < 8; ++c) {
        if (!(corners >> c & 1)) continue;
        int to = c ^ mirrored;
        const int a = to >> equal_side & 1, b = to >> other_equal_side & 1;
        if (exchanged && a != b) to ^= 1 << equal_side | 1 << other_equal_side;
        image |= 1 << to;
      }
      least = std::min(least, image);
    }
  return least;
}

void show(double ratio, bool is_flat, int n_rounds) {
  const Vec3 box = is_flat ? Vec3(1, ratio, ratio) : Vec3(1, 1, ratio), block = 3 * box;
  double as_made = 1, lifted = 1, free = 1;
  int n_marked = 0;
  for (int corners = 1; corners < 256; ++corners) {
    if (representative(corners, is_flat ? 1 : 0, is_flat ? 2 : 1) != corners) continue;
    const Mesh mesh = mesh_brick({block.x(), block.y(), block.z()}, {3, 3, 3});
    std::vector<std::uint8_t> marked(mesh.points.size(), 0);
    for (int c = 0; c < 8; ++c) marked[mesh.hexes[13][c]] = corners >> c & 1;
    Split parts = split(mesh.hexes, mesh.n_nodes(), trisect_table(), trisect_codes(mesh.hexes, marked));
    MeshedModel refined{carry(mesh, {}, parts).mesh, nullptr, {}};
    if (refined.mesh.n_hexes() == mesh.n_hexes()) continue;
    const Mesh templates = refined.mesh;
    std::vector<Index> nodes(templates.points.size() - mesh.points.size()), hexes(templates.hexes.size());
    std::iota(nodes.begin(), nodes.end(), mesh.n_nodes());
    std::iota(hexes.begin(), hexes.end(), 0);
    lift_new_hexes(refined, nodes, {}, parts.lineage.parent, hexes);
    const double is = worst(refined.mesh);
    double could = is;
    if (n_rounds > 0)
      for (const Mesh& start : {templates, refined.mesh})
        could = std::max(could, freely(start, mesh.n_nodes(), box, n_rounds));
    ++n_marked;
    as_made = std::min(as_made, worst(templates));
    lifted = std::min(lifted, is);
    free = std::min(free, could);
  }
  std::printf("| 1 x %s x r, r = %g | %d | %.3f | %.3f | %.3f | %.2f |\n", is_flat ? "r" : "1", ratio, n_marked,
              as_made, lifted, free, lifted / free);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const int n_rounds = argc > 1 ? std::atoi(argv[1]) : 20;
  std::vector<double> ratios;
  for (int i = 2; i < argc; ++i) ratios.push_back(std::atof(argv[i]));
  if (ratios.empty()) ratios = {1, 1.25, 1.5, 2, 3, 4, 6, 10, 20};
  std::printf("| box | markings | templates | lifted | free | part |\n|---|---|---|---|---|---|\n");
  for (const double ratio : ratios)
    for (const bool is_flat : {false, true})
      if (!is_flat || ratio != 1) show(ratio, is_flat, n_rounds);
}
