#include "support/analytic_model.h"

#include <cassert>
#include <cmath>
#include <numbers>

#include "hextwist/geom/curvature.h"
#include "hextwist/geom/incidence.h"

namespace hextwist {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double contains_slack = 1e-12;  // of the model size

void check_size(const char* what, double value) {
  if (!(value > 0) || !std::isfinite(value))
    throw Error(std::string(what) + " must be positive and finite, not " + std::to_string(value));
}

/// Angle of (x, y) in [0, 2 pi); `fallback` at the origin.
double angle_of(double x, double y, double fallback) {
  if (x == 0 && y == 0) return fallback;
  const double angle = std::atan2(y, x);
  if (angle >= 0) return angle;
  const double turned = angle + 2 * pi;
  return turned < 2 * pi ? turned : 0;  // a tiny negative angle rounds up to the full turn
}

double number_or_zero(double value) {
  return std::isfinite(value) ? value : 0;
}

/// What the three solids share; each one provides foot(), point() and the measures.
class ClosedForm : public Model, public KnowsCurvature {
 public:
  using Model::project;

  int count(int dim) const override { return incidence_.count(dim); }
  std::string name(Owner) const override { return ""; }
  double tolerance(Owner) const override { return 0; }
  std::vector<int> adjacent(Owner entity, int dim) const override { return incidence_.adjacent(entity, dim); }

  void project(Owner entity, std::span<const Vec3> points, std::span<const Parameters> seeds,
               std::span<Projection> out) const override {
    assert(entity.dim >= 0 && entity.dim <= 2 && entity.id >= 1 && entity.id <= count(entity.dim));
    assert(out.size() == points.size() && (seeds.empty() || seeds.size() == points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) {
      out[i] = foot(entity, points[i], seeds.empty() ? Parameters{} : seeds[i]);
      out[i].distance = (points[i] - out[i].point).norm();
    }
  }

  std::vector<int> near(int dim, const Vec3& p, double distance) const override {
    std::vector<int> ids;
    for (int id = 1; id <= count(dim); ++id)
      if (project({dim, id}, p).distance <= distance * (1 + 1e-12) + contains_slack * box().diagonal())
        ids.push_back(id);
    return ids;
  }

 protected:
  explicit ClosedForm(const std::array<int, 4>& n) : incidence_(n) {}
  /// Closest point and its parameters.
  virtual Projection foot(Owner entity, const Vec3& p, Parameters seed) const = 0;

  Incidence incidence_;
};

class Brick final : public ClosedForm {
 public:
  double curvature(Owner, Parameters) const override { return 0; }
  explicit Brick(const Vec3& size) : ClosedForm({8, 12, 6, 1}), size_(size) {
    // An entity fixes some of the three axes; it is part of those that fix a subset of them at the same ends.
    for (int dim = 1; dim < 4; ++dim)
      for (int id = 1; id <= count(dim); ++id)
        for (int low = 0; low < dim; ++low)
          for (int part = 1; part <= count(low); ++part) {
            bool inside = true;
            for (int axis = 0; axis < 3; ++axis) {
              const int end = end_of({dim, id}, axis);
              inside = inside && (end < 0 || end == end_of({low, part}, axis));
            }
            if (inside) incidence_.add({dim, id}, {low, part});
          }
    incidence_.close();
  }

  std::string type(Owner entity) const override {
    constexpr const char* types[] = {"vertex", "line", "plane", "volume"};
    return types[entity.dim];
  }
  Box box() const override { return box({3, 1}); }
  Box box(Owner entity) const override {
    Box result;
    result.min = clamped(entity, Vec3::Zero());
    result.max = clamped(entity, size_);
    return result;
  }
  double measure(Owner entity) const override {
    if (entity.dim == 0) return 0;
    double product = 1;
    for (int axis = 0; axis < 3; ++axis)
      if (end_of(entity, axis) < 0) product *= size_[axis];
    return product;
  }
  CurveRange range(int curve) const override { return {0, size_[(curve - 1) / 4], 0}; }
  Vec3 point(Owner entity, Parameters at) const override {
    Vec3 free = Vec3::Zero();
    if (entity.dim == 1) free[(entity.id - 1) / 4] = at.u;
    if (entity.dim == 2) {
      const int axis = (entity.id - 1) / 2;
      free[axis == 0] = at.u;
      free[2 - (axis == 2)] = at.v;
    }
    return pinned(entity, free);
  }
  Vec3 tangent(int curve, double) const override { return Vec3::Unit((curve - 1) / 4); }
  Vec3 normal(int surface, Parameters) const override {
    return ((surface - 1) % 2 ? 1.0 : -1.0) * Vec3::Unit((surface - 1) / 2);
  }
  bool contains(int, const Vec3& p) const override {
    return (clamped({3, 1}, p) - p).norm() <= contains_slack * size_.norm();
  }

 protected:
  Projection foot(Owner entity, const Vec3& p, Parameters) const override {
    Projection result;
    result.point = clamped(entity, p);
    if (entity.dim == 1) result.parameters.u = result.point[(entity.id - 1) / 4];
    if (entity.dim == 2) {
      const int axis = (entity.id - 1) / 2;
      result.parameters = {result.point[axis == 0], result.point[2 - (axis == 2)]};
    }
    return result;
  }

 private:
  /// 0 or 1: the entity lies at that end of the axis; -1: it runs along it.
  static int end_of(Owner entity, int axis) {
    const int k = entity.id - 1;
    switch (entity.dim) {
      case 0:
        return k >> axis & 1;
      case 1: {
        const int along = k / 4;
        return axis == along ? -1 : k >> (axis > along ? axis - 1 : axis) & 1;
      }
      case 2:
        return k / 2 == axis ? k % 2 : -1;
      default:
        return -1;
    }
  }
  Vec3 pinned(Owner entity, Vec3 p) const {
    for (int axis = 0; axis < 3; ++axis)
      if (const int end = end_of(entity, axis); end >= 0) p[axis] = end * size_[axis];
    return p;
  }
  Vec3 clamped(Owner entity, const Vec3& p) const { return pinned(entity, p.cwiseMax(Vec3::Zero()).cwiseMin(size_)); }

  Vec3 size_;
};

class Cylinder final : public ClosedForm {
 public:
  double curvature(Owner entity, Parameters) const override {
    return entity.dim == 1 || entity == Owner{2, side} ? 1 / r_ : 0;
  }
  Cylinder(double r, double h) : ClosedForm({2, 2, 3, 1}), r_(r), h_(h) {
    for (int end = 1; end <= 2; ++end) {
      incidence_.add({1, end}, {0, end});
      incidence_.add({2, side}, {1, end});
      incidence_.add({2, side + end}, {1, end});
    }
    for (int s = 1; s <= 3; ++s) incidence_.add({3, 1}, {2, s});
    incidence_.close();
  }

  std::string type(Owner entity) const override {
    constexpr const char* types[] = {"vertex", "circle", "plane", "volume"};
    return entity == Owner{2, side} ? "cylinder" : types[entity.dim];
  }
  Box box() const override { return box({3, 1}); }
  Box box(Owner entity) const override {
    Box result;
    const double low = level(entity);
    if (entity.dim == 0) {
      result.add(Vec3(r_, 0, low));
    } else {
      const bool flat = entity.dim == 1 || (entity.dim == 2 && entity.id != side);
      result.add(Vec3(-r_, -r_, flat ? low : 0));
      result.add(Vec3(r_, r_, flat ? low : h_));
    }
    return result;
  }
  double measure(Owner entity) const override {
    switch (entity.dim) {
      case 0:
        return 0;
      case 1:
        return 2 * pi * r_;
      case 2:
        return entity.id == side ? 2 * pi * r_ * h_ : pi * r_ * r_;
      default:
        return pi * r_ * r_ * h_;
    }
  }
  CurveRange range(int) const override { return {0, 2 * pi, 2 * pi}; }
  Vec3 point(Owner entity, Parameters at) const override {
    if (entity.dim == 0) return Vec3(r_, 0, level(entity));
    if (entity.dim == 2 && entity.id != side) return Vec3(at.u, at.v, level(entity));
    return Vec3(r_ * std::cos(at.u), r_ * std::sin(at.u), entity.dim == 1 ? level(entity) : at.v);
  }
  Vec3 tangent(int, double t) const override { return Vec3(-std::sin(t), std::cos(t), 0); }
  Vec3 normal(int surface, Parameters at) const override {
    if (surface != side) return Vec3(0, 0, surface == side + 1 ? -1 : 1);
    return Vec3(std::cos(at.u), std::sin(at.u), 0);
  }
  bool contains(int, const Vec3& p) const override {
    const double slack = contains_slack * box().diagonal();
    return std::hypot(p.x(), p.y()) <= r_ + slack && p.z() >= -slack && p.z() <= h_ + slack;
  }

 protected:
  Projection foot(Owner entity, const Vec3& p, Parameters seed) const override {
    Projection result;
    if (entity.dim == 0) {
      result.point = Vec3(r_, 0, level(entity));
      return result;
    }
    const double radius = std::hypot(p.x(), p.y());
    if (entity.dim == 2 && entity.id != side) {
      const double shrink = radius > r_ ? r_ / radius : 1;
      result.point = Vec3(p.x() * shrink, p.y() * shrink, level(entity));
      result.parameters = {result.point.x(), result.point.y()};
      return result;
    }
    const double z = entity.dim == 1 ? level(entity) : std::min(std::max(p.z(), 0.0), h_);
    result.parameters.u = angle_of(p.x(), p.y(), number_or_zero(seed.u));
    if (entity.dim == 2) result.parameters.v = z;
    result.point =
        radius > 0 ? Vec3(p.x() * (r_ / radius), p.y() * (r_ / radius), z) : point(entity, result.parameters);
    return result;
  }

 private:
  static constexpr int side = 1;
  /// Height of an entity that lies at one end: vertices and curves 1, 2, surfaces 2, 3.
  double level(Owner entity) const { return entity.id == (entity.dim == 2 ? 3 : 2) ? h_ : 0; }

  double r_, h_;
};

class Sphere final : public ClosedForm {
 public:
  double curvature(Owner entity, Parameters) const override { return entity.dim == 2 ? 1 / r_ : 0; }
  explicit Sphere(double r) : ClosedForm({0, 0, 1, 1}), r_(r) {
    incidence_.add({3, 1}, {2, 1});
    incidence_.close();
  }

  std::string type(Owner entity) const override { return entity.dim == 2 ? "sphere" : "volume"; }
  Box box() const override { return box({3, 1}); }
  Box box(Owner) const override {
    Box result;
    result.add(Vec3::Constant(-r_));
    result.add(Vec3::Constant(r_));
    return result;
  }
  double measure(Owner entity) const override { return entity.dim == 2 ? 4 * pi * r_ * r_ : 4 * pi / 3 * r_ * r_ * r_; }
  CurveRange range(int) const override {
    assert(!"a sphere has no curves");
    return {};
  }
  Vec3 point(Owner, Parameters at) const override { return r_ * normal(1, at); }
  Vec3 tangent(int, double) const override {
    assert(!"a sphere has no curves");
    return Vec3::Zero();
  }
  Vec3 normal(int, Parameters at) const override {
    return Vec3(std::cos(at.v) * std::cos(at.u), std::cos(at.v) * std::sin(at.u), std::sin(at.v));
  }
  bool contains(int, const Vec3& p) const override { return p.norm() <= r_ + contains_slack * box().diagonal(); }

 protected:
  Projection foot(Owner, const Vec3& p, Parameters seed) const override {
    Projection result;
    const double radius = p.norm();
    const double flat = std::hypot(p.x(), p.y());
    result.parameters.u = angle_of(p.x(), p.y(), number_or_zero(seed.u));
    result.parameters.v = radius > 0 ? std::atan2(p.z(), flat) : number_or_zero(seed.v);
    result.point = radius > 0 ? Vec3(p * (r_ / radius)) : point({2, 1}, result.parameters);
    return result;
  }

 private:
  double r_;
};

}  // namespace

std::shared_ptr<const Model> analytic_brick(double x, double y, double z) {
  for (const double size : {x, y, z}) check_size("size of a brick", size);
  return std::make_shared<Brick>(Vec3(x, y, z));
}

std::shared_ptr<const Model> analytic_cylinder(double r, double h) {
  check_size("radius of a cylinder", r);
  check_size("height of a cylinder", h);
  return std::make_shared<Cylinder>(r, h);
}

std::shared_ptr<const Model> analytic_sphere(double r) {
  check_size("radius of a sphere", r);
  return std::make_shared<Sphere>(r);
}

}  // namespace hextwist
