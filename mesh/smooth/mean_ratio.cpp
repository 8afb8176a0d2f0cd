// The sweep of the default scheme. Compiled for speed: this is where smoothing spends its time.
#include <numeric>

#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/smooth/sweep_internal.h"

namespace hextwist {
namespace {

template <bool with_power>
SweepCount sweep_shape(SmoothState& state, const SweepRule& rule) {
  return sweep(state, [&] {
    return [&, patch = ShapePatch<with_power>(state.problem, rule)](Index slot, bool& moved) mutable {
      return improve_node(state, rule, slot, patch, moved);
    };
  });
}

/// h of corners c, c ^ 1, c ^ 2, c ^ 3 of a hex, c = 0 or 4; infinite where the determinant is not positive.
Four corner_distortions(const std::array<Vec3, 8>& x, int c) {
  Four determinant, square;
  for (int i = 0; i < 4; ++i) {
    const int corner = c + i;
    const Vec3 e0 = x[corner | 1] - x[corner & ~1], e1 = x[corner | 2] - x[corner & ~2],
               e2 = x[corner | 4] - x[corner & ~4];
    determinant[i] = e0.dot(
        Vec3(e1.y() * e2.z() - e1.z() * e2.y(), e1.z() * e2.x() - e1.x() * e2.z(), e1.x() * e2.y() - e1.y() * e2.x()));
    square[i] = e0.squaredNorm() + e1.squaredNorm() + e2.squaredNorm();
  }
  return (determinant > 0).select(inverse_root_27 * square * square.sqrt() / determinant, Four::Constant(never));
}

}  // namespace

SweepCount sweep_mean_ratio(SmoothState& state, const SweepRule& rule) {
  return rule.weight > 0 ? sweep_shape<true>(state, rule) : sweep_shape<false>(state, rule);
}

void hex_distortions(const Mesh& mesh, std::span<const Index> hexes, std::vector<double>& out) {
  out.resize(hexes.size());
  parallel_ranges(static_cast<Index>(hexes.size()), [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      const auto x = corners_of(mesh, hexes[i]);
      out[i] = corner_distortions(x, 0).max(corner_distortions(x, 4)).maxCoeff();
    }
  });
}

double average_distortion(const Mesh& mesh, std::span<const Index> hexes) {
  if (hexes.empty()) return 1;
  constexpr Index size = 4096;
  const auto n = static_cast<Index>(hexes.size());
  std::vector<double> sums(n_chunks(n, size));
  parallel_chunks(n, size, [&](Index chunk, Index begin, Index end) {
    double sum = 0;
    for (Index i = begin; i < end; ++i) {
      const auto x = corners_of(mesh, hexes[i]);
      sum += corner_distortions(x, 0).sum() + corner_distortions(x, 4).sum();
    }
    sums[chunk] = sum;
  });
  return std::accumulate(sums.begin(), sums.end(), 0.0) / (8 * static_cast<double>(n));
}

}  // namespace hextwist
