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
#include "hextwist/mesh/quality/validity.h"
#include "hextwist/mesh/smooth/sweep_internal.h"

namespace hextwist {
namespace {

double chi(double d, double eps) {
  const double root = std::sqrt(d * d + eps * eps);
  // For d < 0 the sum cancels; the other root of the same quadratic does not.
  return d > 0 ? (d + root) / 2 : eps * eps / (2 * (root - d));
}

struct Regularized {
  const Mesh& mesh;
  const std::vector<double>& hex_size;  ///< per hex of the mesh: wished determinant
  double eps = 1;
  /// Corners are not enough: hexes are left that are inverted between them, so that the middles of edges, faces and
  /// hexes count too.
  bool inner = false;
};

/// The middles of edges, faces and the hex: every point of {0, 1/2, 1}^3 that is no corner.
constexpr auto middles = [] {
  std::array<std::array<double, 3>, 19> list{};
  std::size_t n = 0;
  for (int i = 0; i < 27; ++i)
    if (i % 3 == 1 || i / 3 % 3 == 1 || i / 9 == 1) list[n++] = {i % 3 * 0.5, i / 3 % 3 * 0.5, i / 9 * 0.5};
  return list;
}();

/// Part that the edge of an axis at corner c has in the derivative along that axis.
double edge_weight(int c, int axis, const std::array<double, 3>& at) {
  double weight = 1;
  for (int other = 0; other < 3; ++other)
    if (other != axis) weight *= c >> other & 1 ? at[other] : 1 - at[other];
  return weight;
}

Eigen::Matrix3d derivatives_at(const std::array<Vec3, 8>& x, const std::array<double, 3>& at) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  for (int axis = 0; axis < 3; ++axis)
    for (int c = 0; c < 8; ++c)
      if (!(c >> axis & 1)) matrix.col(axis) += edge_weight(c, axis, at) * (x[c | 1 << axis] - x[c]);
  return matrix;
}

/// Energy of one matrix: its determinant and squared norm in wished sizes.
struct Term {
  double chi, shape, size;
  double energy() const { return shape + size; }
};
Term term(double determinant, double square, double wished, double eps) {
  const double d = determinant / wished, x = chi(d, eps);
  return {x, inverse_root_27 * square * std::sqrt(square) / (wished * x), (d * d + 1) / (2 * x)};
}

class UntanglePatch {
 public:
  UntanglePatch(const SmoothProblem& problem, const Regularized& target)
      : problem_(problem), target_(target), corners_(problem.max_rings), volume_(problem.max_rings) {}

  void load(const Vec3* points, const Vec3& x0, std::span<const Ring> rings) {
    n_ = rings.size();
    inner_.clear();
    const std::size_t first = rings.data() - problem_.rings.data();
    for (std::size_t i = 0; i < n_; ++i) {
      const Index hex = problem_.ring_hex[first + i];
      corners_[i] = corner_terms(points, x0, rings[i]);
      volume_[i] = target_.hex_size[hex];
      if (target_.inner) add_inner(points, target_.mesh.hexes[hex], rings[i], volume_[i]);
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
  /// A matrix all of whose columns may contain the node: determinant d + g.y, squared norm n - 2 s.y + k |y|^2.
  struct Inner {
    Vec3 g, s;
    double d, n, k, wished;
  };
  void add_inner(const Vec3* points, const Hex& hex, const Ring& ring, double wished) {
    std::array<Vec3, 8> x;
    for (int c = 0; c < 8; ++c) x[c] = points[hex[c]];
    int corner = 0;  // the one whose neighbours these are
    while (!is_at(ring, hex, corner)) ++corner;
    for (const auto& at : middles) {
      const Eigen::Matrix3d matrix = derivatives_at(x, at);
      Inner inner{Vec3::Zero(), Vec3::Zero(), matrix.determinant(), matrix.squaredNorm(), 0, wished};
      for (int axis = 0; axis < 3; ++axis) {
        const double part = (corner >> axis & 1 ? 1 : -1) * edge_weight(corner, axis, at);
        inner.g += part * matrix.col((axis + 1) % 3).cross(matrix.col((axis + 2) % 3));
        inner.s -= part * matrix.col(axis);
        inner.k += part * part;
      }
      if (inner.k > 0) inner_.push_back(inner);
    }
  }
  static bool is_at(const Ring& ring, const Hex& hex, int corner) {
    const Ring other = ring_at(hex, corner);
    return other.edge == ring.edge && other.face == ring.face;
  }

  Local evaluate(const Vec3& y, bool with_derivatives) const {
    Local local;
    local.energy = local.worst = 0;
    const double y_squared = y.squaredNorm();
    const auto add = [&](double determinant, double n, const Vec3& g, const Vec3& s, double k, double wished) {
      const Term of = term(determinant, n, wished, target_.eps);
      const double d = determinant / wished;
      local.energy += of.energy();
      if (!with_derivatives || !(n > 0)) return;
      // chi' / chi = 1 / sqrt(d^2 + eps^2). Terms with chi'' are left out where they would be negative, as in the
      // paper: what remains is positive semidefinite.
      const double slope = 1 / std::sqrt(d * d + target_.eps * target_.eps);
      const Vec3 dd = g / wished, dc = slope * dd;
      const Vec3 m = 2 / n * (k * y - s), u = 1.5 * m - dc;
      local.gradient += of.shape * u + of.size * (2 * d / (d * d + 1) * dd - dc);
      local.hessian += of.shape * (u * u.transpose() - 1.5 * m * m.transpose() + dc * dc.transpose() +
                                   3 * k / n * Eigen::Matrix3d::Identity());
      // (d^2 + 1) / (2 chi): second derivative of d^2 over chi as if chi were affine, d = ratio * chi.
      const double ratio = d * slope;
      local.hessian +=
          (1 - ratio) * (1 - ratio) / of.chi * dd * dd.transpose() + slope * slope / of.chi * dd * dd.transpose();
    };
    for (std::size_t i = 0; i < n_; ++i) {
      const CornerTerms& t = corners_[i];
      const auto [determinants, squares] = values(t, y, y_squared);
      for (int c = 0; c < 4; ++c)
        add(determinants[c], squares[c], Vec3(t.gx[c], t.gy[c], t.gz[c]), Vec3(t.sx[c], t.sy[c], t.sz[c]),
            c == 0 ? 3 : 1, volume_[i]);
    }
    for (const Inner& t : inner_)
      add(t.d + t.g.dot(y), t.n - 2 * t.s.dot(y) + t.k * y_squared, t.g, t.s, t.k, t.wished);
    return local;
  }

  const SmoothProblem& problem_;
  const Regularized& target_;
  std::vector<CornerTerms> corners_;
  std::vector<double> volume_;
  std::vector<Inner> inner_;
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

/// Smallest wished-size determinant and the energy of all corners (and middles).
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
      const std::array<Vec3, 8> x = corners_of(mesh, hexes[i]);
      const double wished = target.hex_size[hexes[i]];
      const auto add = [&](double determinant, double square) {
        part.least = std::min(part.least, determinant / wished);
        part.energy += term(determinant, square, wished, target.eps).energy();
      };
      for (int c = 0; c < 8; ++c) {
        const Vec3 a = x[c | 1] - x[c & ~1], b = x[c | 2] - x[c & ~2], e = x[c | 4] - x[c & ~4];
        add(a.dot(b.cross(e)), a.squaredNorm() + b.squaredNorm() + e.squaredNorm());
      }
      if (target.inner)
        for (const auto& at : middles) {
          const Eigen::Matrix3d matrix = derivatives_at(x, at);
          add(matrix.determinant(), matrix.squaredNorm());
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

/// Starts with an eps for what there is.
Level begin_level(const Mesh& mesh, std::span<const Index> hexes, Regularized& target) {
  const double least = level(mesh, hexes, target).least;
  target.eps = 2 * std::sqrt(1e-4 + least * least);
  return level(mesh, hexes, target);
}

}  // namespace

Bounds bounds_of(const Mesh& mesh, std::span<const Index> hexes, double wanted) {
  const auto least = [&](Metric metric) { return std::max(0.0, summarize(quality(metric, mesh, hexes)).min); };
  return {std::min(wanted, least(Metric::scaled_jacobian)), least(Metric::shape)};
}

void take_back(SmoothState& state, const std::vector<Vec3>& points, const std::vector<Parameters>& parameters,
               std::span<const Index> inverted_before, const Bounds& least) {
  for (;;) {
    bool any = false;
    const auto put_back = [&](Index hex) {
      for (const Index node : state.mesh.hexes[hex])
        if (state.problem.slot[node] >= 0 && state.mesh.points[node] != points[node]) {
          state.mesh.points[node] = points[node];
          if (!parameters.empty()) state.association.node_parameters[node] = parameters[node];
          any = true;
        }
    };
    for (const Index h : inverted_hexes(state.mesh, state.problem.hexes))
      if (!std::ranges::binary_search(inverted_before, h)) put_back(h);
    for (const auto& [metric, bound] :
         {std::pair(Metric::shape, least.shape), std::pair(Metric::scaled_jacobian, least.scaled_jacobian)}) {
      if (bound <= 0) continue;
      const auto is_below = [&](Index k) { return quality(metric, state.mesh, state.problem.hexes[k]) < bound; };
      for (const Index i : indices_where(static_cast<Index>(state.problem.hexes.size()), is_below))
        put_back(state.problem.hexes[i]);
    }
    if (!any) return;
  }
}

void untangle(SmoothState& state, int max_sweeps, const std::function<bool(const SweepCount&)>& after_sweep) {
  const SmoothProblem& problem = state.problem;
  const std::vector<Index> inverted_before = inverted_hexes(state.mesh, problem.hexes);
  if (inverted_before.empty()) return;
  const std::vector<Vec3> points = state.mesh.points;
  const std::vector<Parameters> parameters = state.association.node_parameters;
  const std::vector<double> sizes = wished_sizes(state.mesh, problem);
  Regularized target{state.mesh, sizes};
  std::ranges::fill(state.awake, 0);
  const SweepRule rule;
  Level before;
  for (int i = 0; i < max_sweeps; ++i) {
    const std::vector<Index> bad = inverted_hexes(state.mesh, problem.hexes);
    if (bad.empty()) return;
    const bool was_inner = target.inner;
    target.inner |= std::ranges::all_of(bad, [&](Index h) { return min_corner_jacobian(state.mesh, h) > 0; });
    if (i == 0 || target.inner != was_inner) before = begin_level(state.mesh, problem.hexes, target);
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
  take_back(state, points, parameters, inverted_before, {});
}

}  // namespace hextwist
