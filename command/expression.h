// Arithmetic in braces as APREPRO does it: `{n = 3}`, `{2 * n + sqrt(h)}`, `{"part_" // tostring(n)}`.
//
// From tight to loose: ++ and -- behind a name, ^ (or **, from right to left), signs and !, * / %, + - and // (joins
// texts), comparisons, && , || , a ? b : c, and assignments = += -= *= /= ^= (from right to left). Names of variables
// are case sensitive. sin, cos, ... take radians, sind, cosd, ... degrees. PI, E, ... are known from the start.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "hextwist/base/types.h"

namespace hextwist {

using Value = std::variant<double, std::string>;
using Variables = std::map<std::string, Value, std::less<>>;

/// What is wrong with an expression, and where in its text.
class ExpressionError : public Error {
 public:
  ExpressionError(const std::string& message, std::size_t offset, std::size_t length)
      : Error(message), offset_(offset), length_(length) {}
  std::size_t offset() const { return offset_; }
  std::size_t length() const { return length_; }

 private:
  std::size_t offset_, length_;
};

struct Evaluated {
  Value value;
  std::string assigned;  ///< the variable that it went to; "" for none
};

/// Throws ExpressionError; the variables are then as they were.
Evaluated evaluate(std::string_view text, Variables& variables);

/// As text for a command: whole numbers without a point, others so that they read back as the same number.
std::string text_of(const Value& value);

/// Names of all functions and predefined variables, sorted.
std::vector<std::string> expression_words();

}  // namespace hextwist
