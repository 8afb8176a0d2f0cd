#include "hextwist/geom/renumbered_model.h"

#include <algorithm>
#include <numeric>

#include "hextwist/geom/curvature.h"
#include "hextwist/geom/facets.h"
#include "hextwist/geom/periods.h"

namespace hextwist {
namespace {

class RenumberedModel : public Model, public KnowsPeriods {
 public:
  RenumberedModel(std::shared_ptr<const Model> model, Renumbering renumbering)
      : model_(std::move(model)), new_(std::move(renumbering)) {
    for (int dim = 0; dim < 4; ++dim) {
      const auto n = static_cast<std::size_t>(model_->count(dim));
      old_[dim].assign(n, 0);
      bool good = new_.id[dim].size() == n;
      for (std::size_t i = 0; good && i < n; ++i) {
        const int id = new_.id[dim][i];
        good = id >= 1 && id <= static_cast<int>(n) && old_[dim][static_cast<std::size_t>(id - 1)] == 0;
        if (good) old_[dim][static_cast<std::size_t>(id - 1)] = static_cast<int>(i) + 1;
      }
      if (!good) throw Error(std::string("the new ids of each ") + dimension_name(dim) + " are not a permutation");
      new_.name[dim].resize(n);
    }
  }

  int count(int dim) const override { return model_->count(dim); }
  std::string name(Owner entity) const override {
    const Owner own = old(entity);
    const std::string& given = new_.name[own.dim][static_cast<std::size_t>(own.id - 1)];
    return given.empty() ? model_->name(own) : given;
  }
  std::string type(Owner entity) const override { return model_->type(old(entity)); }
  Box box(Owner entity) const override { return model_->box(old(entity)); }
  Box box() const override { return model_->box(); }
  double measure(Owner entity) const override { return model_->measure(old(entity)); }
  std::vector<int> adjacent(Owner entity, int dim) const override {
    return fresh(dim, model_->adjacent(old(entity), dim));
  }
  double tolerance(Owner entity) const override { return model_->tolerance(old(entity)); }
  CurveRange range(int curve) const override { return model_->range(old({1, curve}).id); }
  Vec3 point(Owner entity, Parameters at) const override { return model_->point(old(entity), at); }
  Vec3 tangent(int curve, double t) const override { return model_->tangent(old({1, curve}).id, t); }
  std::array<double, 2> periods(int surface) const override { return hextwist::periods(*model_, old({2, surface}).id); }
  Vec3 normal(int surface, Parameters at) const override {
    const Owner own = old({2, surface});
    const std::vector<int> volumes = model_->adjacent(own, 3);
    const Vec3 normal = model_->normal(own.id, at);
    // Out of the lower of two: which one that is may have changed.
    const bool turned = volumes.size() == 2 && new_.of({3, volumes[0]}).id > new_.of({3, volumes[1]}).id;
    return turned ? Vec3(-normal) : normal;
  }
  using Model::project;
  void project(Owner entity, std::span<const Vec3> points, std::span<const Parameters> seeds,
               std::span<Projection> out) const override {
    model_->project(old(entity), points, seeds, out);
  }
  bool contains(int volume, const Vec3& point) const override { return model_->contains(old({3, volume}).id, point); }
  std::vector<int> near(int dim, const Vec3& p, double distance) const override {
    return fresh(dim, model_->near(dim, p, distance));
  }
  const std::shared_ptr<const Model>& inside() const { return model_; }
  const Renumbering& renumbering() const { return new_; }

 protected:
  std::shared_ptr<const Model> model_;
  /// What does not exist is asked for as it is: the model says so.
  Owner old(Owner entity) const {
    if (entity.dim < 0 || entity.dim > 3 || entity.id < 1 || entity.id > count(entity.dim)) return entity;
    return {entity.dim, old_[entity.dim][static_cast<std::size_t>(entity.id - 1)]};
  }

 private:
  Renumbering new_;
  std::array<std::vector<int>, 4> old_;  // [dim][new id - 1]

  std::vector<int> fresh(int dim, std::vector<int> ids) const {
    for (int& id : ids) id = new_.of({dim, id}).id;
    std::ranges::sort(ids);
    return ids;
  }
};

class RenumberedCurvature final : public RenumberedModel, public KnowsCurvature {
 public:
  using RenumberedModel::RenumberedModel;
  double curvature(Owner entity, Parameters at) const override { return inner().curvature(old(entity), at); }
  bool in_pieces() const override { return inner().in_pieces(); }
  std::vector<Bend> bends(Owner entity) const override { return inner().bends(old(entity)); }

 private:
  const KnowsCurvature& inner() const { return *curvature_of(*model_); }
};

}  // namespace

std::shared_ptr<const Model> renumbered(std::shared_ptr<const Model> model, Renumbering renumbering) {
  if (curvature_of(*model)) return std::make_shared<RenumberedCurvature>(std::move(model), std::move(renumbering));
  return std::make_shared<RenumberedModel>(std::move(model), std::move(renumbering));
}

std::shared_ptr<const Model> renamed(std::shared_ptr<const Model> model,
                                     std::span<const std::pair<Owner, std::string>> names) {
  Renumbering renumbering;
  if (const auto of = renumbering_of(*model)) {
    renumbering = of->renumbering;
    model = std::shared_ptr<const Model>(of->model);
  } else {
    for (int dim = 0; dim < 4; ++dim) {
      renumbering.id[dim].resize(static_cast<std::size_t>(model->count(dim)));
      std::iota(renumbering.id[dim].begin(), renumbering.id[dim].end(), 1);
    }
  }
  for (int dim = 0; dim < 4; ++dim) renumbering.name[dim].resize(renumbering.id[dim].size());
  for (const auto& [owner, text] : names) {
    const auto& ids = renumbering.id[owner.dim];
    renumbering.name[owner.dim][static_cast<std::size_t>(std::ranges::find(ids, owner.id) - ids.begin())] = text;
  }
  return renumbered(std::move(model), std::move(renumbering));
}

std::optional<RenumberingOf> renumbering_of(const Model& model) {
  const auto* is = dynamic_cast<const RenumberedModel*>(&model);
  if (!is) return std::nullopt;
  return RenumberingOf{is->inside(), is->renumbering()};
}

SurfaceFacets facets_of(const Model& model, int surface) {
  if (const auto of = renumbering_of(model)) {
    const auto& ids = of->renumbering.id[2];
    return facets_of(*of->model, static_cast<int>(std::ranges::find(ids, surface) - ids.begin()) + 1);
  }
  const auto* knows = dynamic_cast<const KnowsFacets*>(&model);
  return knows ? knows->facets(surface) : SurfaceFacets{};
}

}  // namespace hextwist
