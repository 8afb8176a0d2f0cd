// Lifts the worst scaled Jacobians around single nodes; a patch in the sense of sweep_internal.h.
#pragma once

#include <array>
#include <vector>

#include "hextwist/mesh/smooth/smooth_patch_internal.h"

namespace hextwist {

/// Lifted corners cost no more shape than this, unless that is worse already.
inline constexpr double fair_shape = 0.3;

struct LiftRule {
  double wanted = 1;       ///< scaled Jacobian above which a corner hardly counts
  double least_shape = 0;  ///< no corner may get a smaller shape
  int power = 1;           ///< m below, a power of two
};

/// Energy: the sum of (f / f0)^m + (h / h0)^m over the corner matrices around the node; the larger m the more the worst
/// decides.
///   f = q^-2 = N / D^2, q the scaled Jacobian, N the product of the squared lengths of the columns, D the determinant,
///   which is affine in the node's place; f0: of what is wanted.
///   h = shape^-3 = (S / 3)^3 / D^2, S the sum of the squared lengths: angles alone would heap nodes upon each other,
///   as the best fan of triangles has size 0. h0: of the worst corner here, or of a fair shape if that is worse.
/// `worst` is the largest f.
class LiftPatch {
 public:
  LiftPatch(const SmoothProblem& problem, const LiftRule& rule);

  void load(const Vec3* points, const Vec3& x0, std::span<const Ring> rings);
  double edge_squared() const;
  Local derivatives() const;
  Local at(const Vec3& y) const;

 private:
  /// One hex. Lane 0 is the node itself, lane 1 + k the end of its edge k.
  struct Corners {
    std::array<Vec3, 3> end;  ///< of the edges, from x0
    Four gx, gy, gz, d;       ///< determinants at x0, and their gradients
    Four rest, sum;           ///< of the squared lengths of the edges that the node is not on: product, sum
  };
  Four powered(Four x) const;

  std::vector<Corners> corners_;
  std::size_t n_ = 0;
  int power_;
  double f_scale_, most_h_, h_scale_ = 1;
};

}  // namespace hextwist
