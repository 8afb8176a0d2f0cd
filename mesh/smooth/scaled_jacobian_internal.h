// Lifts the worst scaled Jacobians around single nodes; a patch in the sense of sweep_internal.h.
#pragma once

#include <array>
#include <vector>

#include "hextwist/mesh/smooth/smooth_patch_internal.h"

namespace hextwist {

/// Energy: the sum of q^-2m over the corner matrices around the node, q their scaled Jacobians, m = `power`. The larger
/// m the more the worst decides. q^-2 = f = N / D^2 with N the product of the squared lengths of the columns and D the
/// determinant, which is affine; `worst` is the largest f.
class ScaledJacobianPatch {
 public:
  ScaledJacobianPatch(const SmoothProblem& problem, int power) : corners_(problem.max_rings), power_(power) {}

  void load(const Vec3* points, const Vec3& x0, std::span<const Ring> rings);
  double edge_squared() const;
  Local derivatives() const;
  Local at(const Vec3& y) const;

 private:
  /// Corner 0 is the node itself, corner 1 + k the end of its edge k, 4 the centre of the hex.
  struct Corners {
    std::array<Vec3, 6> end;  ///< of the edges, from x0; then the principal axes of the hex, which go by -y like them
    std::array<Vec3, 5> g;    ///< gradients of the determinants
    std::array<double, 5> d;  ///< determinants at x0
    std::array<double, 3> rest;  ///< at end k: product of the squared lengths of the edges that the node is not on
  };
  double powered(double f) const;

  std::vector<Corners> corners_;
  std::size_t n_ = 0;
  int power_;
};

}  // namespace hextwist
