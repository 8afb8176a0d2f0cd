// Untangling by a foldover-free energy (Garanzha, Kaporin, Kudryavtseva, Protais, Ray, Sokolov, "Foldover-free maps in
// 50 lines of code", ACM TOG 40(4), 2021), minimised node by node.
//
// With N = |A|^2 and D = det A at a corner, both divided by powers of the size wished there (so that D = 1, N = 3 is a
// cube of that size), and chi(D) = (D + sqrt(D^2 + eps^2)) / 2, which is positive whatever D is:
//   energy = (N / 3)^(3/2) / chi(D) + (D^2 + 1) / (2 chi(D)).
// The first term is the distortion of smooth_patch_internal.h for D > 0, the second holds sizes. eps falls, as
// the smallest D rises, by the rule of that paper; when it reaches zero only uninverted corners have finite energy.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "hextwist/mesh/mesh.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/mesh/smooth/sweep_internal.h"

namespace hextwist {
namespace {

double chi(double d, double eps) {
  const double root = std::sqrt(d * d + eps * eps);
  // For d < 0 the sum cancels; the other root of the same quadratic does not.
  return d > 0 ? (d + root) / 2 : eps * eps / (2 * (root - d));
}

struct Regularized {
  const std::vector<double>& hex_size;  ///< per hex of the mesh: wished determinant
  double eps = 1;
};

class UntanglePatch {
 public:
  UntanglePatch(const SmoothProblem& problem, const Regularized& target)
      : problem_(problem), target_(target), corners_(problem.max_rings), volume_(problem.max_rings) {}

  void load(const Vec3* points, const Vec3& x0, std::span<const Ring> rings) {
    n_ = rings.size();
    const std::size_t first = rings.data() - problem_.rings.data();
    for (std::size_t i = 0; i < n_; ++i) {
      corners_[i] = corner_terms(points, x0, rings[i]);
      volume_[i] = target_.hex_size[problem_.ring_hex[first + i]];
    }
  }
  double edge_squared() const {
    double sum = 0;
    for (std::size_t i = 0; i < n_; ++i) sum += std::cbrt(volume_[i] * volume_[i]);
    return sum / static_cast<double>(n_);
  }
  Local derivatives() const { return evaluate(Vec3::Zero(), true); }
  Local at(const Vec3& y) const { return evaluate(y, false); }

 private:
  Local evaluate(const Vec3& y, bool with_derivatives) const {
    Local local;
    local.energy = local.worst = 0;
    const double y_squared = y.squaredNorm();
    for (std::size_t i = 0; i < n_; ++i) {
      const CornerTerms& t = corners_[i];
      const auto [determinants, squares] = values(t, y, y_squared);
      for (int c = 0; c < 4; ++c) {
        const double n = squares[c], d = determinants[c] / volume_[i];
        const double x = chi(d, target_.eps);
        const double shape = inverse_root_27 * n * std::sqrt(n) / (volume_[i] * x), size = (d * d + 1) / (2 * x);
        local.energy += shape + size;
        if (!with_derivatives || !(n > 0)) continue;
        // chi' / chi = 1 / sqrt(d^2 + eps^2). Terms with chi'' are left out where they would be negative, as in the
        // paper: what remains is positive semidefinite.
        const double slope = 1 / std::sqrt(d * d + target_.eps * target_.eps), k = c == 0 ? 3 : 1;
        const Vec3 dd = Vec3(t.gx[c], t.gy[c], t.gz[c]) / volume_[i], dc = slope * dd;
        const Vec3 m = 2 / n * (k * y - Vec3(t.sx[c], t.sy[c], t.sz[c])), u = 1.5 * m - dc;
        local.gradient += shape * u + size * (2 * d / (d * d + 1) * dd - dc);
        local.hessian += shape * (u * u.transpose() - 1.5 * m * m.transpose() + dc * dc.transpose() +
                                  3 * k / n * Eigen::Matrix3d::Identity());
        // (d^2 + 1) / (2 chi): second derivative of d^2 over chi as if chi were affine, d = ratio * chi.
        const double ratio = d * slope;
        local.hessian += (1 - ratio) * (1 - ratio) / x * dd * dd.transpose() + slope * slope / x * dd * dd.transpose();
      }
    }
    return local;
  }

  const SmoothProblem& problem_;
  const Regularized& target_;
  std::vector<CornerTerms> corners_;
  std::vector<double> volume_;
  std::size_t n_ = 0;
};

/// Wished determinant per hex: volumes, averaged over neighbours a few times, so that those of inverted hexes come from
/// their surroundings. The sum stays the total volume.
std::vector<double> wished_sizes(const Mesh& mesh, const SmoothProblem& problem) {
  std::vector<double> size(mesh.hexes.size(), 1), node_sum(mesh.points.size(), 0), node_count(mesh.points.size(), 0);
  double total = 0, positive = 0;
  for (const Index h : problem.hexes) {
    const double v = volume(mesh, h);
    total += v;
    size[h] = std::max(v, 0.0);
    positive += size[h];
  }
  const double n = static_cast<double>(problem.hexes.size());
  if (!(total > 0)) total = positive > 0 ? positive : 1;
  for (int round = 0; round < 3; ++round) {
    for (const Index h : problem.hexes)
      for (const Index node : mesh.hexes[h]) node_sum[node] = node_count[node] = 0;
    for (const Index h : problem.hexes)
      for (const Index node : mesh.hexes[h]) {
        node_sum[node] += size[h];
        node_count[node] += 1;
      }
    for (const Index h : problem.hexes) {
      double sum = 0;
      for (const Index node : mesh.hexes[h]) sum += node_sum[node] / node_count[node];
      size[h] = sum / 8;
    }
  }
  double sum = 0;
  for (const Index h : problem.hexes) sum += size[h] = std::max(size[h], 1e-3 * total / n);
  for (const Index h : problem.hexes) size[h] *= total / sum;
  return size;
}

/// Smallest wished-size determinant and the energy of all corners.
struct Level {
  double least = never;
  double energy = 0;
};
Level level(const Mesh& mesh, std::span<const Index> hexes, const Regularized& target) {
  constexpr Index size = 1024;
  const Index n = static_cast<Index>(hexes.size());
  std::vector<Level> parts(n_chunks(n, size));
  parallel_chunks(n, size, [&](Index chunk, Index begin, Index end) {
    Level part;
    for (Index i = begin; i < end; ++i) {
      const Hex& hex = mesh.hexes[hexes[i]];
      const double wished = target.hex_size[hexes[i]];
      for (int c = 0; c < 8; ++c) {
        const Vec3 a = mesh.points[hex[c | 1]] - mesh.points[hex[c & ~1]];
        const Vec3 b = mesh.points[hex[c | 2]] - mesh.points[hex[c & ~2]];
        const Vec3 e = mesh.points[hex[c | 4]] - mesh.points[hex[c & ~4]];
        const double d = a.dot(b.cross(e)) / wished, square = a.squaredNorm() + b.squaredNorm() + e.squaredNorm();
        const double x = chi(d, target.eps);
        part.least = std::min(part.least, d);
        part.energy += inverse_root_27 * square * std::sqrt(square) / (wished * x) + (d * d + 1) / (2 * x);
      }
    }
    parts[chunk] = part;
  });
  Level all;
  for (const Level& part : parts) {
    all.least = std::min(all.least, part.least);
    all.energy += part.energy;
  }
  return all;
}

/// Puts nodes back until no hex is inverted that was sound at the start.
void take_back(SmoothState& state, const std::vector<Vec3>& points, const std::vector<Parameters>& parameters,
               std::span<const Index> inverted_before) {
  for (;;) {
    bool any = false;
    for (const Index h : inverted_hexes(state.mesh, state.problem.hexes)) {
      if (std::ranges::binary_search(inverted_before, h)) continue;
      for (const Index node : state.mesh.hexes[h])
        if (state.problem.slot[node] >= 0 && state.mesh.points[node] != points[node]) {
          state.mesh.points[node] = points[node];
          if (!parameters.empty()) state.association.node_parameters[node] = parameters[node];
          any = true;
        }
    }
    if (!any) return;
  }
}

}  // namespace

void untangle(SmoothState& state, int max_sweeps, const std::function<bool(const SweepCount&)>& after_sweep) {
  const SmoothProblem& problem = state.problem;
  const std::vector<Index> inverted_before = inverted_hexes(state.mesh, problem.hexes);
  if (inverted_before.empty()) return;
  const std::vector<Vec3> points = state.mesh.points;
  const std::vector<Parameters> parameters = state.association.node_parameters;
  const std::vector<double> sizes = wished_sizes(state.mesh, problem);
  Regularized target{sizes};
  std::ranges::fill(state.awake, 0);
  const SweepRule rule;
  Level before = level(state.mesh, problem.hexes, target);
  target.eps = 2 * std::sqrt(1e-4 + before.least * before.least);
  before = level(state.mesh, problem.hexes, target);
  for (int i = 0; i < max_sweeps; ++i) {
    const std::vector<Index> bad = inverted_hexes(state.mesh, problem.hexes);
    if (bad.empty()) return;
    for (const Index h : bad)
      for (const Index node : state.mesh.hexes[h])
        if (const Index slot = problem.slot[node]; slot >= 0) state.awake[slot] = 1;
    const SweepCount count = sweep(state, [&] {
      return [&, patch = UntanglePatch(problem, target)](Index slot, bool& moved) mutable {
        return improve_node(state, rule, slot, patch, moved);
      };
    });
    if (!after_sweep(count)) break;
    const Level now = level(state.mesh, problem.hexes, target);
    const double progress = std::max(0.1, 1 - now.energy / before.energy);
    const double mu = (1 - progress) * chi(now.least, target.eps);
    target.eps = now.least < mu ? 2 * std::sqrt(mu * (mu - now.least)) : 1e-10;
    before = level(state.mesh, problem.hexes, target);
  }
  take_back(state, points, parameters, inverted_before);
}

}  // namespace hextwist
