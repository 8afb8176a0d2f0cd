// Condition number of the corner matrices around one node; a patch in the sense of sweep_internal.h.
#pragma once

#include <array>
#include <vector>

#include "hextwist/mesh/smooth/smooth_patch_internal.h"

namespace hextwist {

/// Energy: sum of kappa + weight * (kappa / reference)^16. The reference is one of distortions h; kappa^(3/2) is close
/// to h, so it is taken to the power 2/3.
class ConditionPatch {
 public:
  ConditionPatch(const SmoothProblem& problem, const SweepRule& rule)
      : corners_(problem.max_rings), cofactors_(problem.max_rings) {
    const double reference = std::pow(rule.reference, 2.0 / 3);
    weight_ = rule.weight * reference;
    inverse_reference_ = 1 / reference;
  }

  void load(const Vec3* points, const Vec3& x0, std::span<const Ring> rings);
  double edge_squared() const;
  Local derivatives() const { return evaluate(Vec3::Zero(), true); }
  Local at(const Vec3& y) const { return evaluate(y, false); }

 private:
  /// |adj A|^2 = value + 2 linear.y + y' quadratic y.
  struct Cofactors {
    double value = 0;
    Vec3 linear = Vec3::Zero();
    Eigen::Matrix3d quadratic = Eigen::Matrix3d::Zero();
    void add(const Vec3& constant, const Vec3& e);
  };
  Local evaluate(const Vec3& y, bool with_derivatives) const;

  std::vector<CornerTerms> corners_;
  std::vector<std::array<Cofactors, 4>> cofactors_;
  std::size_t n_ = 0;
  double weight_, inverse_reference_;
};

}  // namespace hextwist
