// Sizes from expressions in x, y and z, by muParser.
#include <muParser.h>

#include <cmath>
#include <numbers>

#include "hextwist/base/parallel.h"
#include "hextwist/base/text.h"
#include "hextwist/sizing/fields/size_field.h"

namespace hextwist {
namespace {

/// A parser and its variables. One thread at a time: made anew for each piece of a batch.
class Evaluator {
 public:
  explicit Evaluator(const std::string& expression) {
    parser_.DefineVar("x", &at_[0]);
    parser_.DefineVar("y", &at_[1]);
    parser_.DefineVar("z", &at_[2]);
    parser_.DefineConst("pi", std::numbers::pi);
    parser_.SetExpr(expression);
  }
  double at(const Vec3& p) {
    at_ = {p.x(), p.y(), p.z()};
    return parser_.Eval();
  }

 private:
  mu::Parser parser_;
  std::array<double, 3> at_{};
};

std::string readable(const mu::ParserError& error) {
  std::string text = error.GetMsg();
  while (!text.empty() && (text.back() == '.' || text.back() == '\n')) text.pop_back();
  return text;
}

class Expression final : public SizeField {
 public:
  explicit Expression(std::string text) : text_(std::move(text)) {
    try {
      Evaluator(text_).at(Vec3::Zero());
    } catch (const mu::ParserError& error) {
      const auto position = static_cast<std::size_t>(std::max(0, static_cast<int>(error.GetPos())));
      throw SizeExpressionError("sizing function \"" + text_ + "\": " + readable(error),
                                std::min(position, text_.size()));
    }
  }

  void evaluate(std::span<const Vec3> points, std::span<double> out) const override {
    constexpr Index batch = 4096;
    parallel_ranges(
        static_cast<Index>(points.size()),
        [&](Index begin, Index end) {
          Evaluator evaluator(text_);
          for (Index i = begin; i < end; ++i) out[i] = evaluator.at(points[i]);
        },
        batch);
    // The first place by number, not the first that a thread meets.
    for (std::size_t i = 0; i < points.size(); ++i)
      if (!(out[i] > 0)) refuse(points[i], out[i]);
  }

 private:
  [[noreturn]] void refuse(const Vec3& p, double value) const {
    throw Error("sizing function \"" + text_ + "\" is " + short_number(value, 6) + " at " + point_text(p, 6) +
                ": sizes must be positive");
  }

  std::string text_;
};

}  // namespace

SizeFieldPtr expression_size(const std::string& expression) {
  return std::make_shared<Expression>(expression);
}

}  // namespace hextwist
