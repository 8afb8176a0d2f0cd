// The simple size fields: constant, growing with distance, the smallest of several.
#include <algorithm>
#include <cmath>

#include "hextwist/sizing/fields/growing.h"

namespace hextwist {
namespace {

class Constant final : public SizeField {
 public:
  explicit Constant(double size) : size_(size) {}
  void evaluate(std::span<const Vec3>, std::span<double> out) const override { std::ranges::fill(out, size_); }
  double least() const override { return size_; }

 private:
  double size_;
};

class Growing final : public SizeField {
 public:
  Growing(double size, double growth, std::shared_ptr<const TargetDistance> from)
      : size_(size), slope_(growth - 1), from_(std::move(from)) {}
  void evaluate(std::span<const Vec3> points, std::span<double> out) const override {
    from_->evaluate(points, out);
    for (double& value : out) value = size_ + slope_ * value;
  }
  double least() const override { return size_; }
  double least_at(const Vec3& point) const override { return size_ + slope_ * from_->at_least(point); }

 private:
  double size_, slope_;
  std::shared_ptr<const TargetDistance> from_;
};

class Smallest final : public SizeField {
 public:
  explicit Smallest(std::vector<SizeFieldPtr> fields) : fields_(std::move(fields)) {}
  void evaluate(std::span<const Vec3> points, std::span<double> out) const override {
    fields_.front()->evaluate(points, out);
    std::vector<double> other(points.size());
    for (std::size_t f = 1; f < fields_.size(); ++f) {
      fields_[f]->evaluate(points, other);
      for (std::size_t i = 0; i < out.size(); ++i) out[i] = std::min(out[i], other[i]);
    }
  }
  double least() const override {
    double result = fields_.front()->least();
    for (const SizeFieldPtr& field : fields_) result = std::min(result, field->least());
    return result;
  }
  double least_at(const Vec3& point) const override {
    double result = fields_.front()->least_at(point);
    for (const SizeFieldPtr& field : fields_) result = std::min(result, field->least_at(point));
    return result;
  }
  bool jumps() const override {
    return std::ranges::any_of(fields_, [](const SizeFieldPtr& field) { return field->jumps(); });
  }

 private:
  std::vector<SizeFieldPtr> fields_;
};

void check_size(double size) {
  if (!(size > 0) || !std::isfinite(size))
    throw Error("a wished size must be positive and finite, not " + std::to_string(size));
}

}  // namespace

double SizeField::at(const Vec3& p) const {
  double result = 0;
  evaluate({&p, 1}, {&result, 1});
  return result;
}

SizeFieldPtr constant_size(double size) {
  check_size(size);
  return std::make_shared<Constant>(size);
}

SizeFieldPtr growing_size(double size, double growth, std::shared_ptr<const TargetDistance> from) {
  check_size(size);
  if (!(growth >= 1) || !std::isfinite(growth)) throw Error("a bias must be at least 1");
  if (growth == 1) return constant_size(size);
  return std::make_shared<Growing>(size, growth, std::move(from));
}

SizeFieldPtr smallest_of(std::vector<SizeFieldPtr> fields) {
  if (fields.empty()) throw Error("the smallest of no sizing functions is asked for");
  if (fields.size() == 1) return fields.front();
  return std::make_shared<Smallest>(std::move(fields));
}

}  // namespace hextwist
