#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "hextwist/geom/facet/curvature_internal.h"

namespace hextwist {
namespace {

struct Facet {
  Vec3 middle;
  Vec3 normal;
};

/// The symmetric matrix of the second fundamental form in the facet's plane, as the least squares fit to how the
/// normals turn towards the neighbours (Rusinkiewicz 2004, with facets for vertices). Every neighbour counts alike,
/// near or far.
class Fit {
 public:
  explicit Fit(const Facet& facet)
      : facet_(facet), u_(facet.normal.unitOrthogonal()), v_(facet.normal.cross(u_)), left_(Eigen::Matrix3d::Zero()) {}

  void add(const Facet& neighbour) {
    const Vec3 way = neighbour.middle - facet_.middle, turn = neighbour.normal - facet_.normal;
    most_turned_ = std::max(most_turned_, turn.norm());
    const double x = way.dot(u_), y = way.dot(v_), length = std::hypot(x, y);
    if (!(length > 1e-9 * way.norm())) return;
    // From middle to middle the way is shorter than on the circle that the nodes lie on.
    const double arc = std::sqrt(std::max(0.0, (1 + neighbour.normal.dot(facet_.normal)) / 2)) / length;
    const Vec3 across(x / length, y / length, 0), along(0, x / length, y / length);  // of the unknowns xx, xy, yy
    left_ += across * across.transpose() + along * along.transpose();
    right_ += across * turn.dot(u_) * arc + along * turn.dot(v_) * arc;
  }

  double largest() const {
    if (most_turned_ < least_turn) return 0;
    // Directions that the neighbours do not determine are taken as straight.
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(left_);
    Vec3 form = Vec3::Zero();
    for (int i = 0; i < 3; ++i)
      if (solver.eigenvalues()[i] > 1e-6 * solver.eigenvalues()[2])
        form += solver.eigenvectors().col(i) * solver.eigenvectors().col(i).dot(right_) / solver.eigenvalues()[i];
    return std::abs(form[0] + form[2]) / 2 + std::hypot((form[0] - form[2]) / 2, form[1]);
  }

 private:
  const Facet& facet_;
  Vec3 u_, v_;
  Eigen::Matrix3d left_;
  Vec3 right_ = Vec3::Zero();
  double most_turned_ = 0;
};

/// Per facet the ones across its sides (from corner i to the next), -1: none or across a feature.
std::vector<std::array<std::int32_t, 4>> facets_beside(std::span<const FacetNodes> quads,
                                                       std::span<const FacetEdge> features) {
  struct Side {
    FacetEdge edge;
    std::int32_t facet, side;
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Side> sides;
  sides.reserve(4 * quads.size());
  for (std::size_t f = 0; f < quads.size(); ++f)
    for (int i = 0; i < 4; ++i) {
      const auto [a, b] = std::minmax(quads[f][i], quads[f][(i + 1) % 4]);
      sides.push_back({{a, b}, static_cast<std::int32_t>(f), i});
    }
  std::ranges::sort(sides);
  std::vector<std::array<std::int32_t, 4>> result(quads.size(), {-1, -1, -1, -1});
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    const Side &one = sides[i], &other = sides[i + 1];
    if (one.edge != other.edge || std::ranges::binary_search(features, one.edge)) continue;
    result[one.facet][one.side] = other.facet;
    result[other.facet][other.side] = one.facet;
  }
  return result;
}

}  // namespace

std::vector<double> facet_curvatures(std::span<const BilinearPatch> patches, std::span<const FacetNodes> quads,
                                     std::span<const FacetEdge> features) {
  std::vector<Facet> facets;
  facets.reserve(patches.size());
  for (const BilinearPatch& patch : patches)
    facets.push_back({point(patch, 0.5, 0.5), area_vector(patch, 0.5, 0.5).stableNormalized()});
  const auto beside = facets_beside(quads, features);
  const auto has = [&](std::int32_t facet, std::int32_t node) {
    return facet >= 0 && std::ranges::find(quads[facet], node) != quads[facet].end();
  };
  std::vector<double> result(patches.size(), 0);
  for (std::size_t f = 0; f < patches.size(); ++f) {
    if (facets[f].normal.isZero()) continue;
    // Corner by corner: a fillet ends at flat facets, whose small turn must not dilute the curvature on its side.
    for (int corner = 0; corner < 4; ++corner) {
      Fit fit(facets[f]);
      const auto add = [&](std::int32_t other) {
        if (other >= 0 && !facets[other].normal.isZero()) fit.add(facets[other]);
      };
      for (const int side : {(corner + 3) % 4, corner}) {
        const std::int32_t next = beside[f][side];
        add(next);
        if (next < 0 || side != corner) continue;
        // The facet across the corner is a neighbour of this neighbour.
        for (const std::int32_t across : beside[next])
          if (across != static_cast<std::int32_t>(f) && has(across, quads[f][corner])) add(across);
      }
      result[f] = std::max(result[f], fit.largest());
    }
  }
  return result;
}

std::vector<double> segment_curvatures(std::span<const Vec3> points, bool closed) {
  const std::size_t n = points.size() - 1;
  // At each point the circle through it and its neighbours (Menger).
  const auto at = [&](std::size_t before, std::size_t i, std::size_t after) {
    const Vec3 in = points[i] - points[before], out = points[after] - points[i];
    const double across = (points[after] - points[before]).norm(), area = in.cross(out).norm();
    const double lengths = in.norm() * out.norm();
    return lengths > 0 && across > 0 && area >= least_turn * lengths ? 2 * area / (lengths * across) : 0;
  };
  std::vector<double> of_point(n + 1, 0);
  for (std::size_t i = 1; i < n; ++i) of_point[i] = at(i - 1, i, i + 1);
  const bool joined = closed && n > 1;
  if (joined) of_point[0] = of_point[n] = at(n - 1, 0, 1);
  std::vector<double> result(n, 0);
  for (std::size_t s = 0; s < n; ++s) {
    const bool first = s > 0 || joined, second = s + 1 < n || joined;
    const int n_known = (first ? 1 : 0) + (second ? 1 : 0);
    if (n_known > 0) result[s] = ((first ? of_point[s] : 0) + (second ? of_point[s + 1] : 0)) / n_known;
  }
  return result;
}

}  // namespace hextwist
