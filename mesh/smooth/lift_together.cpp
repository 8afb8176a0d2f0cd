#include "hextwist/mesh/smooth/lift_together.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/hex_lanes.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/mesh/quality/validity.h"
#include "hextwist/mesh/smooth/lift_patch_internal.h"
#include "hextwist/mesh/smooth/problem_internal.h"

namespace hextwist {
namespace {

/// Corners come up in rounds, each to `growth` times what there is: what is asked for at once is paid for with shapes
/// that do not come back. The power of the energy: the larger, the more the worst corner decides. By trying on boxes of
/// 1 x 1 x r and 1 x r x r, r up to 20, and on all shipped models (docs/smoothing.md).
constexpr int n_rounds = 12, n_gentle_rounds = 8;
constexpr int gentle_power = 4, hard_power = 8;
constexpr double growth = 1.3;
/// So many rounds one after the other that gain less than this part are the last.
constexpr double least_growth = 0.01;
constexpr int most_vain = 2;
constexpr int most_steps = 40;  ///< of a round
constexpr int n_remembered = 8;
/// Of the logarithm of the distortion of the worst corners; less is the end of a round.
constexpr double least_gain = 3e-4;
/// The first step of a round, as a part of the shortest edge.
constexpr double first_step = 0.05;
/// Shapes come down a little for corners that come up by a multiple: no hex below this part of the worst.
constexpr double shape_kept = 0.85;
/// Blocks have a second turn where corners are below this part of what is wanted, as their neighbours moved.
constexpr double again_below = 0.7;
/// Faces between nodes that are less even on a bent surface follow it worse: a block may gain or lose this part of its
/// volume by that.
constexpr double volume_given = 4e-3;
/// The energy holds them a little above what they were, and aims a little beyond the wanted corner.
constexpr double hold_shape = 1.1, beyond = 1.05;

/// What is to be small, of every corner: f / f0 and h / h0 (lift_patch_internal.h), in the power m.
struct Energy {
  double f0 = 1, h0 = 1;
  int m = 4;
};

template <int N>
HEXTWIST_LANES Lanes<N> powered(Lanes<N> x, int m) {
  for (; m > 1; m /= 2) x *= x;
  return x;
}

template <int N>
HEXTWIST_LANES void add(LaneVec<N>& to, const Lanes<N>& a, const LaneVec<N>& x, const Lanes<N>& b,
                        const LaneVec<N>& y) {
  to.x += a * x.x + b * y.x;
  to.y += a * x.y + b * y.y;
  to.z += a * x.z + b * y.z;
}

/// Of N hexes the sums of (f / f0)^m + (h / h0)^m over their corners, the largest of these without the power, and the
/// gradient of the sums in the corners' places, divided by m.
template <int N>
struct LaneEnergy {
  Lanes<N> sum = Lanes<N>::Zero(), worst = Lanes<N>::Zero(), least = Lanes<N>::Constant(1e300);
  LaneHex<N> gradient;
};
template <int N>
HEXTWIST_LANES LaneEnergy<N> energy_of(const LaneHex<N>& hex, const Energy& energy) {
  LaneEnergy<N> result;
  const LaneVec<N> zero{Lanes<N>::Zero(), Lanes<N>::Zero(), Lanes<N>::Zero()};
  const LaneEdges<N> edges(hex);
  const std::array<std::array<Lanes<N>, 4>, 3> square = squares(edges);
  std::array<std::array<LaneVec<N>, 4>, 3> along;  // gradients in the edges
  for (std::array<LaneVec<N>, 4>& of_axis : along) of_axis.fill(zero);
  const double f_scale = 1 / energy.f0, h_scale = 1 / (27 * energy.h0);
  for (int c = 0; c < 8; ++c) {
    const int i = gather_bits(0, c), j = gather_bits(1, c), k = gather_bits(2, c);
    const LaneVec<N>&a = edges.along[0][i], &b = edges.along[1][j], &d = edges.along[2][k];
    const LaneVec<N> bd = cross(b, d), da = cross(d, a), ab = cross(a, b);
    const Lanes<N> volume = dot(a, bd);
    const Lanes<N>&aa = square[0][i], &bb = square[1][j], &dd = square[2][k];
    const Lanes<N> sum = aa + bb + dd, inverse = Lanes<N>::Ones() / volume, inverse_2 = inverse * inverse;
    const Lanes<N> f = f_scale * (aa * bb * dd * inverse_2), h = h_scale * (sum * sum * sum * inverse_2);
    const Lanes<N> fm = powered<N>(f, energy.m), hm = powered<N>(h, energy.m);
    result.least = result.least.min(volume);
    result.worst = result.worst.max(f).max(h);
    result.sum += fm + hm;
    const Lanes<N> of_volume = -2.0 * ((fm + hm) * inverse), of_sum = 6.0 * (hm / sum), twice = 2.0 * fm;
    add<N>(along[0][i], twice / aa + of_sum, a, of_volume, bd);
    add<N>(along[1][j], twice / bb + of_sum, b, of_volume, da);
    add<N>(along[2][k], twice / dd + of_sum, d, of_volume, ab);
  }
  result.gradient.fill(zero);
  for (int axis = 0; axis < 3; ++axis)
    for (int k = 0; k < 4; ++k) {
      LaneVec<N>&low = result.gradient[edge_corner(4 * axis + k, 0)],
      &high = result.gradient[edge_corner(4 * axis + k, 1)];
      low = low - along[axis][k];
      high = high + along[axis][k];
    }
  return result;
}

/// A node that stays on a surface: it moves in the plane at its place, then goes back onto it.
struct OnSurface {
  Index node;  ///< of the block
  Owner owner;
  Parameters at;
  Vec3 normal;  ///< 0: it stays
};

/// A mesh of its own of some hexes, whose first n_free nodes move.
class MovingBlock {
 public:
  MovingBlock(const Mesh& mesh, std::span<const Index> nodes, std::span<const Index> hexes,
              const Association& association, const Model* model)
      : model_(model) {
    n_free_ = static_cast<Index>(nodes.size());
    for (Index i = 0; i < n_free_ && model; ++i) {
      const Owner owner = association.node_owner[nodes[i]];
      if (owner.dim != 2) continue;
      Parameters at = association.node_parameters[nodes[i]];
      if (std::isnan(at.u)) at = model->project(owner, mesh.points[nodes[i]]).parameters;
      on_surfaces_.push_back({i, owner, at, model->normal(owner.id, at)});
    }
    all_.assign(nodes.begin(), nodes.end());
    std::vector<Index> corners;
    corners.reserve(8 * hexes.size());
    for (const Index h : hexes) corners.insert(corners.end(), mesh.hexes[h].begin(), mesh.hexes[h].end());
    std::vector<Index> known = corners;
    std::ranges::sort(known);
    known.erase(std::ranges::unique(known).begin(), known.end());
    std::vector<Index> place(known.size());
    for (std::size_t i = 0; i < known.size(); ++i) {
      const auto free = std::ranges::lower_bound(nodes, known[i]);
      if (free != nodes.end() && *free == known[i]) {
        place[i] = static_cast<Index>(free - nodes.begin());
      } else {
        place[i] = static_cast<Index>(all_.size());
        all_.push_back(known[i]);
      }
    }
    for (const Index n : all_) local_.points.push_back(mesh.points[n]);
    local_.hexes.resize(hexes.size());
    std::vector<Index> n_corners(n_free_ + 1, 0);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Index node = place[std::ranges::lower_bound(known, corners[i]) - known.begin()];
      local_.hexes[i / 8][i % 8] = node;
      if (node < n_free_) ++n_corners[node + 1];
    }
    std::partial_sum(n_corners.begin(), n_corners.end(), n_corners.begin());
    first_corner_ = n_corners;
    corner_.resize(first_corner_.back());
    for (std::size_t i = 0; i < corners.size(); ++i)
      if (const Index node = local_.hexes[i / 8][i % 8]; node < n_free_)
        corner_[n_corners[node]++] = static_cast<Index>(i);
    of_corner_.resize(corners.size());
  }

  /// Whether anything got better. least_shape: what no hex may fall below.
  bool lift(double wanted, double least_shape) {
    const double worst = least(Metric::scaled_jacobian);
    if (!(worst > 0) || worst >= wanted) return false;
    const std::vector<Index> inverted = inverted_hexes(local_);
    const double was = volume(local_);
    const auto is_kept = [&] {
      return least(Metric::shape) >= least_shape && inverted_hexes(local_) == inverted &&
             std::abs(volume(local_) - was) <= volume_given * was;
    };
    Eigen::VectorXd best = places();
    std::vector<OnSurface> best_on_surfaces = on_surfaces_;
    Energy energy;
    energy.h0 = std::pow(std::min(hold_shape * least_shape, fair_shape), -3);
    double reached = worst, now = worst;
    for (int round = 0, n_vain = 0; round < n_rounds && n_vain < most_vain && reached < beyond * wanted; ++round) {
      const double goal = std::min(growth * now, beyond * beyond * wanted);
      energy.f0 = 1 / (goal * goal);
      energy.m = round < n_gentle_rounds ? gentle_power : hard_power;
      const Eigen::VectorXd from = places();
      descend(energy);
      if (!settle(from)) break;
      now = least(Metric::scaled_jacobian);
      n_vain = now < (1 + least_growth) * reached ? n_vain + 1 : 0;
      if (!(now > reached) || !is_kept()) continue;
      reached = now;
      best = places();
      best_on_surfaces = on_surfaces_;
    }
    put(best);
    on_surfaces_ = std::move(best_on_surfaces);
    return reached > worst;
  }

  void put_into(Mesh& mesh, Association& association) const {
    for (Index i = 0; i < n_free_; ++i) mesh.points[all_[i]] = local_.points[i];
    for (const OnSurface& on : on_surfaces_) association.node_parameters[all_[on.node]] = on.at;
  }

 private:
  double least(Metric metric) const { return summarize(quality(metric, local_)).min; }
  Eigen::VectorXd places() const {
    Eigen::VectorXd x(3 * n_free_);
    for (Index i = 0; i < n_free_; ++i) x.segment<3>(3 * i) = local_.points[i];
    return x;
  }
  void put(const Eigen::VectorXd& x) {
    for (Index i = 0; i < n_free_; ++i) local_.points[i] = x.segment<3>(3 * i);
  }
  /// Back onto the surfaces; false where one leads elsewhere.
  bool settle(const Eigen::VectorXd& from) {
    for (OnSurface& on : on_surfaces_) {
      Vec3& place = local_.points[on.node];
      const Vec3 start = from.segment<3>(3 * on.node);
      if (place == start) continue;
      Projection foot;
      model_->project(on.owner, {&place, 1}, {&on.at, 1}, {&foot, 1});
      if ((foot.point - place).squaredNorm() > (place - start).squaredNorm()) return false;
      place = foot.point;
      on.at = foot.parameters;
      on.normal = model_->normal(on.owner.id, on.at);
    }
    return true;
  }
  double shortest_edge() const {
    double shortest = std::numeric_limits<double>::infinity();
    for (const Hex& hex : local_.hexes)
      for (int e = 0; e < 12; ++e)
        shortest =
            std::min(shortest, (local_.points[hex[edge_corner(e, 1)]] - local_.points[hex[edge_corner(e, 0)]]).norm());
    return shortest;
  }

  struct Value {
    double energy = std::numeric_limits<double>::infinity();  ///< the logarithm of the sum over m
    double worst = 0;
  };
  /// At x, which the nodes are put to.
  Value value(const Eigen::VectorXd& x, const Energy& energy, Eigen::VectorXd& gradient) {
    put(x);
    constexpr Index size = 256;
    const auto n = static_cast<Index>(local_.hexes.size());
    std::vector<Value> of_chunk(n_chunks(n, size));
    parallel_chunks(n, size, [&](Index chunk, Index begin, Index end) {
      double sum = 0, worst = 0, least = 1;
      for_lanes(begin, end, [&](auto lanes, Index h) HEXTWIST_LANE_LAMBDA {
        constexpr int N = decltype(lanes)::value;
        const LaneEnergy<N> of = energy_of<N>(load<N>(local_, h), energy);
        for (int lane = 0; lane < N; ++lane) {
          sum += of.sum[lane];
          worst = std::max(worst, of.worst[lane]);
          least = std::min(least, of.least[lane]);
          for (int c = 0; c < 8; ++c)
            of_corner_[8 * (h + lane) + c] = {of.gradient[c].x[lane], of.gradient[c].y[lane], of.gradient[c].z[lane]};
        }
      });
      if (least > 0) of_chunk[chunk] = {sum, worst};
    });
    Value all{0, 0};
    for (const Value& each : of_chunk) {
      all.energy += each.energy;
      all.worst = std::max(all.worst, each.worst);
    }
    if (!std::isfinite(all.energy)) return {};
    gradient.resize(3 * n_free_);
    parallel_each(n_free_, [&](std::size_t i) {
      Vec3 sum = Vec3::Zero();
      for (Index k = first_corner_[i]; k < first_corner_[i + 1]; ++k) sum += of_corner_[corner_[k]];
      gradient.segment<3>(3 * i) = sum / all.energy;
    });
    for (const OnSurface& on : on_surfaces_) {
      auto of_node = gradient.segment<3>(3 * on.node);
      if (on.normal.squaredNorm() > 0.5)
        of_node -= on.normal * on.normal.dot(of_node);
      else
        of_node.setZero();
    }
    all.energy = std::log(all.energy) / energy.m;
    return all;
  }

  /// L-BFGS (Nocedal and Wright, Numerical Optimization, algorithm 7.5) with halved steps.
  void descend(Energy energy) {
    Eigen::VectorXd x = places(), gradient, next_gradient, step;
    // So that the worst corner has 1: powers overflow otherwise.
    Energy first = energy;
    first.m = 1;
    const double worst = value(x, first, gradient).worst;
    energy.f0 *= worst, energy.h0 *= worst;
    Value now = value(x, energy, gradient);
    if (!std::isfinite(now.energy)) return;
    struct Pair {
      Eigen::VectorXd step, change;
      double product;
    };
    std::vector<Pair> pairs;  // the oldest first
    std::array<double, n_remembered> alpha{};
    const double length = first_step * shortest_edge();
    for (int i = 0; i < most_steps; ++i) {
      const double steepest = gradient.cwiseAbs().maxCoeff();
      if (!(steepest > 0)) break;
      step = -gradient;
      for (std::size_t k = pairs.size(); k-- > 0;) {
        alpha[k] = pairs[k].step.dot(step) / pairs[k].product;
        step -= alpha[k] * pairs[k].change;
      }
      step *= pairs.empty() ? length / steepest : pairs.back().product / pairs.back().change.squaredNorm();
      for (std::size_t k = 0; k < pairs.size(); ++k)
        step += (alpha[k] - pairs[k].change.dot(step) / pairs[k].product) * pairs[k].step;
      double slope = gradient.dot(step);
      if (!(slope < 0)) {
        pairs.clear();
        step = -length / steepest * gradient;
        slope = gradient.dot(step);
      }
      Value there;
      int halvings = 0;
      for (; halvings < 16; ++halvings, step /= 2, slope /= 2) {
        there = value(x + step, energy, next_gradient);
        if (there.energy <= now.energy + 1e-4 * slope) break;
      }
      if (halvings == 16) break;
      next_gradient.swap(gradient);
      Eigen::VectorXd change = gradient - next_gradient;
      const double product = step.dot(change);
      x += step;
      if (product > 1e-12 * step.norm() * change.norm()) {
        if (pairs.size() == n_remembered) pairs.erase(pairs.begin());
        pairs.push_back({step, std::move(change), product});
      }
      const double gain = now.energy - there.energy;
      now = there;
      if (gain < least_gain) break;
    }
    put(x);
  }

  std::vector<Index> all_;  ///< nodes of the mesh, the free ones first
  Index n_free_ = 0;
  Mesh local_;
  std::vector<Index> first_corner_, corner_;  ///< per free node 8 * hex + corner
  const Model* model_;
  std::vector<OnSurface> on_surfaces_;
  std::vector<Vec3> of_corner_;  ///< gradient of the sum in each corner's place
};

/// Blocks whose hexes are apart, so that they can move at the same time: by colour, then in their order.
std::vector<std::vector<Index>> by_colour(const std::vector<std::vector<Index>>& hexes_of, Index n_hexes) {
  std::vector<std::vector<Index>> result;
  std::vector<std::uint64_t> taken(n_hexes, 0);
  std::vector<Index> left(hexes_of.size());
  std::iota(left.begin(), left.end(), 0);
  while (!left.empty()) {  // 64 colours at a time, which nearly always are enough
    const std::size_t first = result.size();
    result.resize(first + 64);
    std::ranges::fill(taken, 0);
    std::vector<Index> next;
    for (const Index b : left) {
      std::uint64_t mask = 0;
      for (const Index h : hexes_of[b]) mask |= taken[h];
      const int colour = std::countr_one(mask);
      if (colour == 64) {
        next.push_back(b);
        continue;
      }
      for (const Index h : hexes_of[b]) taken[h] |= std::uint64_t{1} << colour;
      result[first + static_cast<std::size_t>(colour)].push_back(b);
    }
    left = std::move(next);
  }
  std::erase_if(result, [](const std::vector<Index>& blocks) { return blocks.empty(); });
  return result;
}

}  // namespace

void lift_together(Mesh& mesh, Association& association, const Model* model, const SmoothOptions& options,
                   std::span<const Index> cell, double wanted, std::span<const Vec3> before) {
  if (!association.empty()) association.node_parameters.resize(mesh.points.size());
  const SmoothProblem problem = make_smooth_problem(mesh, association, model, options);
  if (problem.n_nodes() == 0) return;
  // The nodes that move freely of hexes at a cell, and the hexes around them.
  const auto around = [&](std::span<const Index> nodes) {
    std::vector<Index> hexes;
    for (const Index n : nodes) {
      const Index s = problem.slot[n];
      hexes.insert(hexes.end(), problem.ring_hex.begin() + problem.first_ring[s],
                   problem.ring_hex.begin() + problem.first_ring[s + 1]);
    }
    sort_unique(hexes);
    return hexes;
  };
  const auto on_surface = [&](Index n) { return problem.owner[problem.slot[n]].dim == 2; };
  const auto moving = [&](std::span<const Index> hexes, bool on_surfaces) {
    std::vector<Index> nodes;
    for (const Index h : hexes)
      for (const Index n : mesh.hexes[h])
        if (const Index s = problem.slot[n];
            s >= 0 && (!problem.slides(s) || (on_surfaces && on_surface(n) && !problem.hold_of(s))))
          nodes.push_back(n);
    sort_unique(nodes);
    return nodes;
  };
  const auto take_turns = [&](bool on_surfaces, std::initializer_list<double> below_each) {
    const std::vector<Index> low = hexes_below(mesh, wanted, problem.hexes);
    if (low.empty()) return;
    std::vector<Index> cells;
    for (const Index h : low) cells.push_back(cell[h]);
    sort_unique(cells);
    std::vector<std::vector<Index>> of_cell(cells.size()), nodes_of(cells.size()), hexes_of(cells.size());
    for (const Index h : problem.hexes)
      if (const auto at = std::ranges::lower_bound(cells, cell[h]); at != cells.end() && *at == cell[h])
        of_cell[at - cells.begin()].push_back(h);
    parallel_each(
        cells.size(),
        [&](std::size_t c) {
          nodes_of[c] = moving(around(moving(of_cell[c], on_surfaces)), on_surfaces);
          if (on_surfaces && std::ranges::none_of(nodes_of[c], on_surface)) nodes_of[c].clear();
          hexes_of[c] = around(nodes_of[c]);
        },
        16);
    const std::vector<std::vector<Index>> colours = by_colour(hexes_of, mesh.n_hexes());
    for (const double below : below_each)
      for (const std::vector<Index>& blocks : colours)
        parallel_each(
            blocks.size(),
            [&](std::size_t i) {
              const std::vector<Index>&nodes = nodes_of[blocks[i]], &hexes = hexes_of[blocks[i]];
              if (nodes.empty() || hexes_below(mesh, below, hexes).empty()) return;
              double least_shape = 1;
              for (const Index h : hexes) {
                std::array<Vec3, 8> corners;
                for (std::size_t c = 0; c < 8; ++c) corners[c] = before[mesh.hexes[h][c]];
                least_shape = std::min(least_shape, quality(Metric::shape, corners));
              }
              MovingBlock block(mesh, nodes, hexes, association, model);
              if (block.lift(wanted, shape_kept * least_shape)) block.put_into(mesh, association);
            },
            1);
  };
  take_turns(false, {wanted, again_below * wanted});
  // Nodes on surfaces, which cost projections, where that was not enough.
  if (model && !options.fix_boundary) take_turns(true, {wanted, wanted});
}

}  // namespace hextwist
