// Which way each volume is swept, and how many intervals each curve has. Included by mesh/fill/*.cpp only.
#pragma once

#include <algorithm>
#include <cmath>

#include "hextwist/mesh/fill/facts_internal.h"
#include "hextwist/mesh/fill/fill.h"

namespace hextwist::fill {

/// A curve between caps at one end, and the one between caps at the other end that it becomes.
struct Partner {
  int curve = 0, other = 0;
  bool same_way = true;
};

/// Where a surface that was turned all the way round meets the axis: a disc, the pole of a dome, the tip of a cone.
struct AxisEnd {
  int surface = 0;
  int seam = 0;      ///< from the pole on; 0: a disc
  int pole = 0;      ///< vertex; 0: a disc
  double angle = 0;  ///< of the seam, from x
  double at = 0;     ///< along the axis
};

/// What a volume was turned about, and where it touches that.
struct Axis {
  Vec3 origin = Vec3::Zero(), x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();  ///< along z
  std::vector<AxisEnd> ends = {};  ///< ascending: the volume has the axis from each first to each second
  std::vector<int> rims = {};      ///< closed curves around it
  double widest = 0;               ///< the largest radius
  double core = 0;                 ///< within this radius there is nothing but the ends

  bool has_end(int surface) const { return std::ranges::count(ends, surface, &AxisEnd::surface) > 0; }
  double along(const Vec3& p) const { return (p - origin).dot(z); }
  double radius(const Vec3& p) const { return (p - origin - along(p) * z).norm(); }
  double angle(const Vec3& p) const { return std::atan2((p - origin).dot(y), (p - origin).dot(x)); }
  Vec3 point(double r, double phi, double h) const {
    return origin + h * z + r * (std::cos(phi) * x + std::sin(phi) * y);
  }
};

/// Where all surfaces of the volume were turned about one axis that they touch. Says what is in the way where they are
/// of that kind but for something.
std::optional<Axis> find_axis(const Facts& facts, int volume, std::string& why);

struct Sweep {
  int volume = 0;
  bool is_ball = false;                       ///< then there is nothing else
  bool is_turned = false;                     ///< all the way round: there are sides alone
  std::optional<Axis> axis = {};              ///< of a turned one that touches its axis
  std::vector<int> sides = {};                ///< surfaces along which it goes
  std::array<std::vector<int>, 2> caps = {};  ///< those at its ends
  std::vector<Chain> along = {};              ///< from the vertices of the first caps to the other end
  std::vector<Partner> partners = {};         ///< where both ends have several caps
};

/// Has the cap a mesh of its own making, without a QuadMesher?
bool is_regular(const SurfaceFacts& surface);

/// A sweep for each volume. Throws Error naming those that have none, and why. can_pave: caps of any form will do.
std::vector<Sweep> find_sweeps(const Facts& facts, const std::vector<int>& volumes, bool can_pave);

/// Per curve id - 1. intervals: instead of a size; 0: none. most_turning: radians within an interval. Throws Error
/// where the sides of surfaces cannot have the same numbers.
std::vector<int> find_intervals(const Facts& facts, const std::vector<Sweep>& sweeps, double size, int intervals,
                                double most_turning);

}  // namespace hextwist::fill
