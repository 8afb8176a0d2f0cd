// Sizes from the CAD: its curvature, and counts of elements along curves.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "hextwist/base/box_tree.h"
#include "hextwist/base/parallel.h"
#include "hextwist/geom/curvature.h"
#include "hextwist/sizing/fields/growing.h"

namespace hextwist {
namespace {

class Curvature final : public SizeField {
 public:
  Curvature(std::shared_ptr<const Model> model, std::vector<Owner> entities, double elements_per_radian, double growth)
      : model_(std::move(model)),
        knows_(curvature_of(*model_)),
        entities_(std::move(entities)),
        per_radian_(elements_per_radian),
        slope_(growth - 1) {}

  void evaluate(std::span<const Vec3> points, std::span<double> out) const override {
    parallel_ranges(
        static_cast<Index>(points.size()),
        [&](Index begin, Index end) {
          const auto n = static_cast<std::size_t>(end - begin);
          some(points.subspan(static_cast<std::size_t>(begin), n), out.subspan(static_cast<std::size_t>(begin), n));
        },
        512);
  }

 private:
  void some(std::span<const Vec3> points, std::span<double> out) const {
    std::ranges::fill(out, std::numeric_limits<double>::infinity());
    std::vector<Projection> feet(points.size());
    for (const Owner entity : entities_) {
      model_->project(entity, points, {}, feet);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const double curvature = knows_->curvature(entity, feet[i].parameters);
        if (curvature > 0) out[i] = std::min(out[i], 1 / (curvature * per_radian_) + slope_ * feet[i].distance);
      }
    }
  }

  std::shared_ptr<const Model> model_;
  const KnowsCurvature* knows_;
  std::vector<Owner> entities_;
  double per_radian_, slope_;
};

/// The same where curvature comes in pieces: a fillet and the flat face it runs out into are one surface of a skin, so
/// that the nearest place of the surface says nothing about what is bent beside it.
class CurvatureInPieces final : public SizeField {
 public:
  CurvatureInPieces(std::vector<Bend> bends, double elements_per_radian, double growth)
      : bends_(std::move(bends)), slope_(growth - 1) {
    std::vector<Box> boxes;
    for (const Bend& bend : bends_) {
      sizes_.push_back(1 / (bend.curvature * elements_per_radian));
      Box& box = boxes.emplace_back();
      for (const Vec3& p : bend.piece) box.add(p);
    }
    least_ = std::ranges::min(sizes_);
    tree_ = BoxTree(boxes);
  }

  void evaluate(std::span<const Vec3> points, std::span<double> out) const override {
    parallel_ranges(
        static_cast<Index>(points.size()),
        [&](Index begin, Index end) {
          for (Index i = begin; i < end; ++i) out[i] = slope_ > 0 ? wish(points[i]) : least_;
        },
        512);
  }
  double least() const override { return least_; }

 private:
  /// The least of size + slope x distance: the nearest piece, if each is farther by size / slope than it is.
  double wish(const Vec3& p) const {
    const NearItem near = tree_.nearest(p, [&](std::int32_t i) {
      const double farther = std::sqrt(closest(bends_[i].piece, p).distance2) + (sizes_[i] - least_) / slope_;
      return farther * farther;
    });
    return least_ + slope_ * std::sqrt(near.distance2);
  }

  std::vector<Bend> bends_;
  std::vector<double> sizes_;
  BoxTree tree_;
  double slope_, least_ = 0;
};

bool is_curved(const std::string& type) {
  return type != "line" && type != "plane" && type != "degenerate" && type != "vertex" && type != "volume";
}

void check_growth(double growth) {
  if (!(growth >= 1) || !std::isfinite(growth)) throw Error("growth must be a number of at least 1");
}

}  // namespace

SizeFieldPtr curvature_size(std::shared_ptr<const Model> model, std::span<const Owner> entities,
                            double elements_per_radian, double growth) {
  check_growth(growth);
  if (!(elements_per_radian > 0) || !std::isfinite(elements_per_radian))
    throw Error("elements per radian must be a positive number");
  if (!model) throw Error("there is no CAD whose curvature could be asked for");
  const KnowsCurvature* knows = curvature_of(*model);
  if (!knows) throw Error("this model does not know its curvature");
  std::vector<Owner> curved;
  std::vector<Bend> bends;
  for (const Owner entity : entities) {
    if (is_curved(model->type(entity))) curved.push_back(entity);
    if (knows->in_pieces()) std::ranges::move(knows->bends(entity), std::back_inserter(bends));
  }
  if (knows->in_pieces() ? bends.empty() : curved.empty()) throw Error("none of these curves and surfaces is curved");
  if (knows->in_pieces()) return std::make_shared<CurvatureInPieces>(std::move(bends), elements_per_radian, growth);
  return std::make_shared<Curvature>(std::move(model), std::move(curved), elements_per_radian, growth);
}

SizeFieldPtr interval_size(const MeshedModel& input, std::span<const Index> curves, int n_intervals, double growth) {
  check_growth(growth);
  if (n_intervals < 1) throw Error("the number of intervals must be at least 1");
  if (!input.model) throw Error("there is no CAD whose curves could be divided");
  std::vector<SizeFieldPtr> fields;
  for (const Index curve : curves) {
    const double length = input.model->measure({1, curve});
    if (!(length > 0)) continue;  // a pole
    fields.push_back(growing_size(length / n_intervals, growth,
                                  std::make_shared<TargetDistance>(input, EntityKind::curve, std::span(&curve, 1))));
  }
  if (fields.empty()) throw Error("none of these curves has a length");
  return smallest_of(std::move(fields));
}

}  // namespace hextwist
