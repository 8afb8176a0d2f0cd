#include "hextwist/command/expression.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <optional>

#include "hextwist/base/text.h"
#include "hextwist/command/error_at.h"
#include "hextwist/command/flow.h"
#include "hextwist/command/reader.h"
#include "hextwist/command/written.h"

namespace hextwist {
namespace {

using std::numbers::pi;

constexpr double degree = pi / 180;

struct Function {
  std::string_view name;
  int n_arguments = 1;  // -1: one or more
  double (*of)(const double*, std::size_t) = nullptr;
};

const std::array functions = {
    Function{"abs", 1, [](const double* a, std::size_t) { return std::abs(a[0]); }},
    Function{"acos", 1, [](const double* a, std::size_t) { return std::acos(a[0]); }},
    Function{"acosd", 1, [](const double* a, std::size_t) { return std::acos(a[0]) / degree; }},
    Function{"acosh", 1, [](const double* a, std::size_t) { return std::acosh(a[0]); }},
    Function{"asin", 1, [](const double* a, std::size_t) { return std::asin(a[0]); }},
    Function{"asind", 1, [](const double* a, std::size_t) { return std::asin(a[0]) / degree; }},
    Function{"asinh", 1, [](const double* a, std::size_t) { return std::asinh(a[0]); }},
    Function{"atan", 1, [](const double* a, std::size_t) { return std::atan(a[0]); }},
    Function{"atan2", 2, [](const double* a, std::size_t) { return std::atan2(a[0], a[1]); }},
    Function{"atan2d", 2, [](const double* a, std::size_t) { return std::atan2(a[0], a[1]) / degree; }},
    Function{"atand", 1, [](const double* a, std::size_t) { return std::atan(a[0]) / degree; }},
    Function{"atanh", 1, [](const double* a, std::size_t) { return std::atanh(a[0]); }},
    Function{"cbrt", 1, [](const double* a, std::size_t) { return std::cbrt(a[0]); }},
    Function{"ceil", 1, [](const double* a, std::size_t) { return std::ceil(a[0]); }},
    Function{"cos", 1, [](const double* a, std::size_t) { return std::cos(a[0]); }},
    Function{"cosd", 1, [](const double* a, std::size_t) { return std::cos(a[0] * degree); }},
    Function{"cosh", 1, [](const double* a, std::size_t) { return std::cosh(a[0]); }},
    Function{"d2r", 1, [](const double* a, std::size_t) { return a[0] * degree; }},
    Function{"dim", 2, [](const double* a, std::size_t) { return a[0] - std::min(a[0], a[1]); }},
    Function{"dist", 4, [](const double* a, std::size_t) { return std::hypot(a[2] - a[0], a[3] - a[1]); }},
    Function{"exp", 1, [](const double* a, std::size_t) { return std::exp(a[0]); }},
    Function{"floor", 1, [](const double* a, std::size_t) { return std::floor(a[0]); }},
    Function{"fmod", 2, [](const double* a, std::size_t) { return std::fmod(a[0], a[1]); }},
    Function{"hypot", 2, [](const double* a, std::size_t) { return std::hypot(a[0], a[1]); }},
    Function{"int", 1, [](const double* a, std::size_t) { return std::trunc(a[0]); }},
    Function{"ln", 1, [](const double* a, std::size_t) { return std::log(a[0]); }},
    Function{"log", 1, [](const double* a, std::size_t) { return std::log(a[0]); }},
    Function{"log10", 1, [](const double* a, std::size_t) { return std::log10(a[0]); }},
    Function{"log1p", 1, [](const double* a, std::size_t) { return std::log1p(a[0]); }},
    Function{"max", -1, [](const double* a, std::size_t n) { return *std::max_element(a, a + n); }},
    Function{"min", -1, [](const double* a, std::size_t n) { return *std::min_element(a, a + n); }},
    Function{"nint", 1, [](const double* a, std::size_t) { return std::round(a[0]); }},
    Function{"polarX", 2, [](const double* a, std::size_t) { return a[0] * std::cos(a[1] * degree); }},
    Function{"polarY", 2, [](const double* a, std::size_t) { return a[0] * std::sin(a[1] * degree); }},
    Function{"pow", 2, [](const double* a, std::size_t) { return std::pow(a[0], a[1]); }},
    Function{"r2d", 1, [](const double* a, std::size_t) { return a[0] / degree; }},
    Function{"round", 1, [](const double* a, std::size_t) { return std::round(a[0]); }},
    Function{"sign", 2, [](const double* a, std::size_t) { return std::copysign(std::abs(a[0]), a[1]); }},
    Function{"sin", 1, [](const double* a, std::size_t) { return std::sin(a[0]); }},
    Function{"sind", 1, [](const double* a, std::size_t) { return std::sin(a[0] * degree); }},
    Function{"sinh", 1, [](const double* a, std::size_t) { return std::sinh(a[0]); }},
    Function{"sqrt", 1, [](const double* a, std::size_t) { return std::sqrt(a[0]); }},
    Function{"tan", 1, [](const double* a, std::size_t) { return std::tan(a[0]); }},
    Function{"tand", 1, [](const double* a, std::size_t) { return std::tan(a[0] * degree); }},
    Function{"tanh", 1, [](const double* a, std::size_t) { return std::tanh(a[0]); }},
};
constexpr std::array<std::string_view, 4> text_functions = {"format", "tolower", "tostring", "toupper"};

struct Constant {
  std::string_view name;
  double value;
};
constexpr std::array<Constant, 9> constants = {{{"PI", pi},
                                                {"PI_2", pi / 2},
                                                {"TAU", 2 * pi},
                                                {"SQRT2", std::numbers::sqrt2},
                                                {"E", std::numbers::e},
                                                {"GAMMA", std::numbers::egamma},
                                                {"PHI", std::numbers::phi},
                                                {"DEG", 180 / pi},
                                                {"RAD", pi / 180}}};

class Parser {
 public:
  Parser(std::string_view text, const Variables& variables) : text_(text), variables_(variables) {}

  Evaluated run() {
    refuse_flow();
    if (next() == '\0') fail("there is nothing between the braces", 0, text_.size());
    Value value = assignment();
    if (next() != '\0') fail("expected an operator or the end of the expression", at_, 1);
    if (const double* number = std::get_if<double>(&value); number && !std::isfinite(*number))
      fail("the result is not a finite number", 0, text_.size());
    return {std::move(value), assigned_};
  }
  Variables take_variables() { return std::move(variables_); }

 private:
  std::string_view text_;
  Variables variables_;
  std::string assigned_;
  std::size_t at_ = 0;
  int depth_ = 0;
  int skipping_ = 0;  // inside the branch of ?: that is not taken

  struct Deeper {
    explicit Deeper(Parser& parser) : depth(parser.depth_) {
      constexpr int max_depth = 100;
      if (++depth > max_depth) parser.fail("this expression is nested too deeply", parser.at_, 1);
    }
    ~Deeper() { --depth; }
    int& depth;
  };

  [[noreturn]] void fail(const std::string& message, std::size_t offset, std::size_t length) const {
    throw ExpressionError(message, std::min(offset, text_.size()), length);
  }

  char next() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  bool accept(std::string_view sign) {
    next();
    if (text_.substr(at_, sign.size()) != sign) return false;
    at_ += sign.size();
    return true;
  }
  /// A sign that is not the beginning of a longer one.
  bool accept(std::string_view sign, std::string_view but_not_before) {
    next();
    const std::size_t behind = at_ + sign.size();
    if (behind < text_.size() && but_not_before.find(text_[behind]) != std::string_view::npos) return false;
    return accept(sign);
  }

  static bool begins_name(char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; }
  std::string_view name_at(std::size_t at) const {
    std::size_t end = at;
    while (end < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[end])) || text_[end] == '_')) ++end;
    return text_.substr(at, end - at);
  }

  void refuse_flow() {
    if (!begins_name(next())) return;
    const std::string_view word = name_at(at_);
    std::size_t behind = at_ + word.size();
    while (behind < text_.size() && text_[behind] == ' ') ++behind;
    const bool alone = behind == text_.size() || text_[behind] == '(';
    if (alone && is_flow_word(word) && !variables_.contains(word))
      fail("'{" + std::string(word) +
               "}' stands alone on its line, as in {loop(3)} ... {endloop}, {if(n > 2)} ... {endif} or "
               "{include(\"a.jou\")}",
           at_, word.size());
  }

  double number(const Value& value, std::size_t begin) const {
    if (const double* number = std::get_if<double>(&value)) return *number;
    fail("a number was expected here, not a text", begin, std::max<std::size_t>(at_, begin + 1) - begin);
  }

  Value assignment() {
    const Deeper deeper(*this);
    if (begins_name(next())) {
      const std::size_t begin = at_;
      const std::string name(name_at(begin));
      at_ += name.size();
      constexpr std::array<std::string_view, 5> operators = {"+=", "-=", "*=", "/=", "^="};
      for (const auto each : operators)
        if (accept(each)) {
          const double old = number(variable(name, begin), begin);
          const std::size_t right_begin = at_;
          const double right = number(assignment(), right_begin);
          return assign(name, begin, arithmetic(each[0], old, right));
        }
      if (accept("=", "=")) return assign(name, begin, assignment());
      at_ = begin;
    }
    return conditional();
  }

  Value assign(const std::string& name, std::size_t begin, Value value) {
    for (const Function& function : functions)
      if (function.name == name) fail("'" + name + "' is a function", begin, name.size());
    if (const double* number = std::get_if<double>(&value); number && !std::isfinite(*number) && !skipping_)
      fail("the value of '" + name + "' is not a finite number", begin, name.size());
    if (!skipping_) {
      variables_[name] = value;
      assigned_ = name;
    }
    return value;
  }

  Value conditional() {
    const std::size_t begin = at_;
    Value condition = alternatives_of();
    if (!accept("?")) return condition;
    const bool taken = number(condition, begin) != 0;
    skipping_ += !taken;
    Value first = assignment();
    skipping_ -= !taken;
    if (!accept(":")) fail("expected ':' and what holds otherwise", at_, 1);
    skipping_ += taken;
    Value second = assignment();
    skipping_ -= taken;
    return taken ? first : second;
  }

  Value alternatives_of() {
    const std::size_t begin = at_;
    Value left = conditions();
    while (accept("||")) {
      const std::size_t right_begin = at_;
      Value right = conditions();
      left = number(left, begin) != 0 || number(right, right_begin) != 0 ? 1.0 : 0.0;
    }
    return left;
  }

  Value conditions() {
    const std::size_t begin = at_;
    Value left = comparison();
    while (accept("&&")) {
      const std::size_t right_begin = at_;
      Value right = comparison();
      left = number(left, begin) != 0 && number(right, right_begin) != 0 ? 1.0 : 0.0;
    }
    return left;
  }

  Value comparison() {
    const std::size_t begin = at_;
    Value left = sum();
    while (true) {
      static constexpr std::array<std::string_view, 6> operators = {"==", "!=", "<=", ">=", "<", ">"};
      const auto found = std::ranges::find_if(operators, [&](std::string_view sign) { return accept(sign); });
      if (found == operators.end()) return left;
      const std::size_t right_begin = at_;
      Value right = sum();
      if (left.index() != right.index()) {
        number(left, begin);
        number(right, right_begin);
      }
      const std::array<bool, 6> results = {left == right, left != right, left <= right, left >= right,
                                           left<right, left> right};
      left = results[static_cast<std::size_t>(found - operators.begin())] ? 1.0 : 0.0;
    }
  }

  double arithmetic(char sign, double a, double b) {
    switch (sign) {
      case '+':
        return a + b;
      case '-':
        return a - b;
      case '*':
        return a * b;
      case '/':
        if (b == 0 && !skipping_) fail("division by zero", at_ ? at_ - 1 : 0, 1);
        return a / b;
      case '%':
        if (b == 0 && !skipping_) fail("division by zero", at_ ? at_ - 1 : 0, 1);
        return std::fmod(a, b);
      default:
        return std::pow(a, b);
    }
  }

  Value sum() {
    const std::size_t begin = at_;
    Value left = product();
    while (true) {
      if (accept("//")) {
        const Value right = product();
        left = text_of(left) + text_of(right);
        constexpr std::size_t most = 100000;
        if (std::get<std::string>(left).size() > most) fail("this text is too long", begin, at_ - begin);
        continue;
      }
      const char sign = accept("+", "+=") ? '+' : accept("-", "-=") ? '-' : '\0';
      if (!sign) return left;
      const std::size_t right_begin = at_;
      const Value right = product();
      left = arithmetic(sign, number(left, begin), number(right, right_begin));
    }
  }

  Value product() {
    const std::size_t begin = at_;
    Value left = signed_factor();
    while (true) {
      const char sign = accept("*", "*=") ? '*' : accept("/", "/=") ? '/' : accept("%") ? '%' : '\0';
      if (!sign) return left;
      const std::size_t right_begin = at_;
      const Value right = signed_factor();
      left = arithmetic(sign, number(left, begin), number(right, right_begin));
    }
  }

  Value signed_factor() {
    const Deeper deeper(*this);
    const std::size_t begin = at_;
    if (accept("-")) return -number(signed_factor(), begin + 1);
    if (accept("+")) return number(signed_factor(), begin + 1);
    if (accept("!")) return number(signed_factor(), begin + 1) == 0 ? 1.0 : 0.0;
    Value base = factor();
    if (!accept("^") && !accept("**")) return base;
    const std::size_t right_begin = at_;
    const double exponent = number(signed_factor(), right_begin);
    return arithmetic('^', number(base, begin), exponent);
  }

  Value factor() {
    const char c = next();
    const std::size_t begin = at_;
    if (c == '(') {
      ++at_;
      Value inner = assignment();
      if (!accept(")")) fail("expected )", at_, 1);
      return inner;
    }
    if (c == '"' || c == '\'') {
      const std::size_t close = text_.find(c, at_ + 1);
      if (close == std::string_view::npos) fail("this quote is not closed", at_, text_.size() - at_);
      at_ = close + 1;
      return std::string(text_.substr(begin + 1, close - begin - 1));
    }
    if (std::isdigit(static_cast<unsigned char>(c)) || c == '.') {
      double value = 0;
      const auto [rest, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
      if (error == std::errc::result_out_of_range) fail("this number is out of range", at_, 1);
      if (error != std::errc()) fail("a number was expected here", at_, 1);
      at_ = static_cast<std::size_t>(rest - text_.data());
      return value;
    }
    if (!begins_name(c)) fail(c == '\0' ? "the expression ends too early" : "a value was expected here", at_, 1);
    const std::string name(name_at(begin));
    at_ += name.size();
    if (next() == '(') return call(name, begin);
    for (const auto each : {"++", "--"})
      if (accept(each)) {
        const double old = number(variable(name, begin), begin);
        assign(name, begin, old + (each[0] == '+' ? 1 : -1));
        return old;
      }
    return variable(name, begin);
  }

  Value variable(const std::string& name, std::size_t begin) const {
    if (const auto found = variables_.find(name); found != variables_.end()) return found->second;
    for (const Constant& constant : constants)
      if (constant.name == name) return constant.value;
    if (skipping_) return 0.0;
    std::vector<std::string> known = expression_words();
    for (const auto& [each, value] : variables_) known.push_back(each);
    const std::string near = nearest_word(name, known);
    fail("'" + printable(name) + "' has no value yet" + (near.empty() ? "" : " (did you mean '" + near + "'?)"), begin,
         name.size());
  }

  Value call(const std::string& name, std::size_t begin) {
    accept("(");
    std::vector<Value> arguments;
    std::vector<std::size_t> places;
    if (!accept(")")) {
      do {
        next();
        places.push_back(at_);
        arguments.push_back(assignment());
      } while (accept(","));
      if (!accept(")")) fail("expected , or )", at_, 1);
    }
    const auto want = [&](std::size_t n) {
      if (arguments.size() != n)
        fail(name + " takes " + counted(static_cast<std::int64_t>(n), "value") + ", not " +
                 std::to_string(arguments.size()),
             begin, at_ - begin);
    };
    if (std::ranges::find(text_functions, name) != text_functions.end()) {
      want(name == "format" ? 2 : 1);
      return text_function(name, arguments, places);
    }
    const auto function = std::ranges::find(functions, name, &Function::name);
    if (function == functions.end()) {
      const std::string near = nearest_word(name, expression_words());
      fail("there is no function '" + printable(name) + "'" + (near.empty() ? "" : " (did you mean '" + near + "'?)"),
           begin, name.size());
    }
    if (function->n_arguments >= 0)
      want(static_cast<std::size_t>(function->n_arguments));
    else if (arguments.empty())
      fail(name + " takes at least one value", begin, at_ - begin);
    std::vector<double> numbers;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      const double* each = std::get_if<double>(&arguments[i]);
      if (!each) fail("a number was expected here, not a text", places[i], 1);
      numbers.push_back(*each);
    }
    const double result = function->of(numbers.data(), numbers.size());
    if (std::isnan(result) && !skipping_) fail(name + " has no value there", begin, at_ - begin);
    return result;
  }

  Value text_function(const std::string& name, const std::vector<Value>& arguments,
                      const std::vector<std::size_t>& places) const {
    std::string text = text_of(arguments[0]);
    if (name == "format") {
      const std::string form = text_of(arguments[1]);
      const double* number = std::get_if<double>(&arguments[0]);
      if (!number) fail("a number was expected here, not a text", places[0], 1);
      return formatted(*number, form, places[1]);
    }
    for (char& c : text) {
      if (name == "tolower") c = lower_case(c);
      if (name == "toupper") c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    }
    return text;
  }

  /// %5.2f, %03d and the like, with text around.
  std::string formatted(double value, const std::string& form, std::size_t place) const {
    const std::size_t percent = form.find('%');
    const std::size_t letter = form.find_first_not_of("+- 0123456789.", percent == std::string::npos ? 0 : percent + 1);
    const bool sound = percent != std::string::npos && letter != std::string::npos && letter - percent < 8 &&
                       std::string_view("defgEFGi").find(form[letter]) != std::string_view::npos &&
                       form.find('%', letter) == std::string::npos;
    if (!sound) fail("the second value of format must hold one of %d, %f, %e, %g, with a width if you like", place, 1);
    const bool whole = form[letter] == 'd' || form[letter] == 'i';
    if (whole && std::abs(value) > 9e15) fail("this number is too large for %d", place, 1);
    std::string inner = form.substr(percent, letter - percent);
    inner += whole ? std::string("lld") : std::string(1, form[letter]);
    std::array<char, 500> buffer;
    const int n = whole ? std::snprintf(buffer.data(), buffer.size(), inner.c_str(), std::llround(value))
                        : std::snprintf(buffer.data(), buffer.size(), inner.c_str(), value);
    if (n < 0 || n >= static_cast<int>(buffer.size())) fail("this text is too long", place, 1);
    return form.substr(0, percent) + buffer.data() + form.substr(letter + 1);
  }
};

}  // namespace

Evaluated evaluate(std::string_view text, Variables& variables) {
  Parser parser(text, variables);
  Evaluated result = parser.run();
  variables = parser.take_variables();
  return result;
}

std::string text_of(const Value& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  const double number = std::get<double>(value);
  if (number == std::floor(number) && std::abs(number) < 1e15) return std::to_string(static_cast<long long>(number));
  return number_text(number);
}

std::vector<std::string> expression_words() {
  std::vector<std::string> result(text_functions.begin(), text_functions.end());
  for (const Function& function : functions) result.emplace_back(function.name);
  for (const Constant& constant : constants) result.emplace_back(constant.name);
  std::ranges::sort(result);
  return result;
}

}  // namespace hextwist
