// What filling needs to know of curves and surfaces. Included by mesh/fill/*.cpp only.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "hextwist/geom/model.h"

namespace hextwist::fill {

/// A curve along which one walks.
struct Step {
  int curve = 0;
  bool forward = true;
};
using Chain = std::vector<Step>;
Chain reversed(const Chain& chain);

struct CurveFacts {
  int first = 0, last = 0;   ///< vertices at the ends of its parameters; 0: not looked at
  bool is_point = false;     ///< the pole of a sphere, the tip of a cone
  double length = 0;         ///< model units
  double turning = 0;        ///< radians by which the tangent turns from end to end
  std::vector<double> t, s;  ///< parameters and the lengths up to there
  bool is_closed() const { return first == last; }
};

struct SurfaceFacts {
  std::vector<Chain> loops;  ///< around it, without seams; the longest first
  std::vector<int> seams;    ///< curves with the surface on both sides
  bool has_poles = false;
  bool is_tube = false;  ///< two loops and a seam between them
  /// Where it is mapped: four sides one after the other, all the way round. Of a tube: one rim, seam, other rim, seam.
  std::optional<std::array<Chain, 4>> sides;
  bool is_torus = false;    ///< two closed seams: the shorter one, the longer one, and both back are its sides
  bool is_annulus = false;  ///< flat, between two circles about one center, each a single curve
  bool is_disc = false;     ///< flat, within one circle
  bool is_ring = false;     ///< flat, between two circles, not too wide
  std::string odd;          ///< why its rim cannot be walked along; empty: it can
};

/// Of the volumes asked for and what bounds them.
struct Facts {
  Facts(const Model& of, const std::vector<int>& volumes);

  const Model& model;
  std::vector<CurveFacts> curves;      ///< per curve id - 1
  std::vector<SurfaceFacts> surfaces;  ///< per surface id - 1

  int start(const Step& step) const {
    return step.forward ? curves[step.curve - 1].first : curves[step.curve - 1].last;
  }
  int end(const Step& step) const { return start({step.curve, !step.forward}); }
  /// Of the curve, by the part of its length behind it.
  Vec3 point_at(int curve, double part) const;
  double parameter_at(int curve, double part) const;
  /// Points along the chain, so many for each curve, without the last.
  std::vector<Vec3> samples(const Chain& chain, int per_curve) const;
};

/// Parameters of points of a surface, one after the other without jumps where it closes on itself. from: of the place
/// before the first; NaN: none.
std::vector<Eigen::Vector2d> unrolled(const Model& model, int surface, const std::vector<Vec3>& points,
                                      Eigen::Vector2d from);

}  // namespace hextwist::fill
