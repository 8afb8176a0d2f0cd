// Sizes from the CAD: its curvature, and counts of elements along curves.
#include <algorithm>
#include <cmath>

#include "hextwist/geom/curvature.h"
#include "hextwist/mesh/parallel_internal.h"
#include "hextwist/sizing/size_field.h"

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
  if (!curvature_of(*model)) throw Error("the skin of a mesh has no curvature: import the CAD that the mesh lies on");
  std::vector<Owner> curved;
  for (const Owner entity : entities)
    if (is_curved(model->type(entity))) curved.push_back(entity);
  if (curved.empty()) throw Error("none of these curves and surfaces is curved");
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
                                  std::make_shared<TargetDistance>(input, TargetKind::curve, std::span(&curve, 1))));
  }
  if (fields.empty()) throw Error("none of these curves has a length");
  return smallest_of(std::move(fields));
}

}  // namespace hextwist
