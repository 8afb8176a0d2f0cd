#include "hextwist/command/select/criterion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "hextwist/command/reader.h"
#include "hextwist/command/select/range.h"
#include "hextwist/command/written.h"
#include "hextwist/mesh/quality/quality.h"

namespace hextwist {
namespace {

using Op = Criterion::Op;

template <class... Kinds>
constexpr unsigned only(Kinds... kinds) {
  return ((1u << static_cast<int>(kinds)) | ...);
}
constexpr unsigned every_kind = (1u << n_entity_kinds) - 1;
constexpr unsigned cad = only(EntityKind::vertex, EntityKind::curve, EntityKind::surface, EntityKind::volume);
constexpr unsigned named = cad | only(EntityKind::block, EntityKind::nodeset, EntityKind::sideset, EntityKind::group);

constexpr std::array<AttributeSpec, 25> attribute_table = {{
    {Attribute::id, "id", every_kind},
    {Attribute::x_coord, "x_coord", every_kind, false, true},
    {Attribute::y_coord, "y_coord", every_kind, false, true},
    {Attribute::z_coord, "z_coord", every_kind, false, true},
    {Attribute::x_min, "x_min", every_kind, false, true},
    {Attribute::y_min, "y_min", every_kind, false, true},
    {Attribute::z_min, "z_min", every_kind, false, true},
    {Attribute::x_max, "x_max", every_kind, false, true},
    {Attribute::y_max, "y_max", every_kind, false, true},
    {Attribute::z_max, "z_max", every_kind, false, true},
    {Attribute::length, "length", only(EntityKind::edge, EntityKind::curve), false, true},
    {Attribute::area, "area", only(EntityKind::face, EntityKind::surface, EntityKind::sideset)},
    {Attribute::volume, "volume", only(EntityKind::hex, EntityKind::volume, EntityKind::block)},
    {Attribute::radius, "radius", only(EntityKind::curve, EntityKind::surface), false, true},
    {Attribute::quality, "quality", only(EntityKind::hex)},
    {Attribute::is_planar, "is_planar", only(EntityKind::surface), true},
    {Attribute::is_planar, "is_plane", only(EntityKind::surface), true, false, "is_planar"},
    {Attribute::is_spline, "is_spline", only(EntityKind::curve, EntityKind::surface), true},
    {Attribute::is_meshed, "is_meshed", cad, true},
    {Attribute::element_count, "element_count", every_kind & ~only(EntityKind::group)},
    {Attribute::num_parents, "num_parents", cad & ~only(EntityKind::volume)},
    {Attribute::block_assigned, "block_assigned", only(EntityKind::hex), true},
    {Attribute::is_hole, "is_hole", only(EntityKind::curve), true},
    {Attribute::name, "name", named, true},
    {Attribute::name, "has_name", named, true, false, "name"},
}};

const AttributeSpec& spec_of(Attribute attribute) {
  return *std::ranges::find(attribute_table, attribute, &AttributeSpec::attribute);
}

constexpr int precedence(Op op) {
  switch (op) {
    case Op::or_:
    case Op::and_:
      return 1;
    case Op::not_:
      return 2;
    case Op::less:
    case Op::less_equal:
    case Op::greater:
    case Op::greater_equal:
    case Op::equal:
    case Op::not_equal:
      return 3;
    case Op::add:
    case Op::subtract:
      return 4;
    case Op::multiply:
    case Op::divide:
      return 5;
    case Op::negate:
      return 6;
    default:
      return 7;
  }
}

struct Sign {
  std::string_view text;
  Op op;
};
constexpr std::array<Sign, 7> comparisons = {{{"<", Op::less},
                                              {"<=", Op::less_equal},
                                              {">", Op::greater},
                                              {">=", Op::greater_equal},
                                              {"=", Op::equal},
                                              {"==", Op::equal},
                                              {"<>", Op::not_equal}}};
constexpr std::array<Sign, 2> sums = {{{"+", Op::add}, {"-", Op::subtract}}};
constexpr std::array<Sign, 2> products = {{{"*", Op::multiply}, {"/", Op::divide}}};

std::string_view sign(Op op) {
  for (const std::span<const Sign> signs :
       {std::span<const Sign>(comparisons), std::span<const Sign>(sums), std::span<const Sign>(products)})
    for (const Sign& each : signs)
      if (each.op == op) return each.text;
  return op == Op::and_ ? "and" : "or";
}

class CriterionReader {
 public:
  CriterionReader(Reader& reader, EntityKind kind) : reader_(reader), kind_(kind) {}

  Criterion condition() {
    const Deeper deeper(*this);
    Criterion left = operand();
    while (true) {
      const Token token = reader_.peek();
      const Op op = reader_.accept("and") ? Op::and_ : reader_.accept("or") ? Op::or_ : Op::truth;
      if (op == Op::truth) return left;
      left = joined(op, token, std::move(left), operand());
    }
  }

  Criterion measure() {
    Criterion result = attribute();
    return want_number(result);
  }

 private:
  Reader& reader_;
  EntityKind kind_;
  int depth_ = 0;
  int size_ = 0;

  struct Deeper {
    explicit Deeper(CriterionReader& owner) : depth(owner.depth_) {
      constexpr int max_depth = 64;
      if (++depth > max_depth) owner.reader_.fail(owner.reader_.peek(), "this condition is nested too deeply");
    }
    ~Deeper() { --depth; }
    int& depth;
  };

  static bool is_condition(const Criterion& c) {
    if (c.op == Op::attribute) return spec_of(c.attribute).is_truth;
    return c.op == Op::truth || c.op == Op::named || precedence(c.op) <= 3;
  }

  const Criterion& want_condition(const Criterion& c) const {
    if (!is_condition(c))
      reader_.fail(c.token,
                   c.op == Op::attribute
                       ? "'" + c.token.text + "' is a number: compare it with something (" + c.token.text + " > ...)"
                       : "this is a number; a condition was expected, such as " +
                             std::string(kind_ == EntityKind::surface ? "is_planar" : "x_coord > 1"));
    return c;
  }
  const Criterion& want_number(const Criterion& c) const {
    if (is_condition(c)) reader_.fail(c.token, "this is true or false; a number was expected");
    return c;
  }

  static Criterion made(Op op, const Token& token) {
    Criterion result;
    result.op = op;
    result.token = token;
    return result;
  }
  Criterion joined(Op op, const Token& token, Criterion left, Criterion right) {
    constexpr int max_size = 1000;  // the tree is walked by recursion
    if (++size_ > max_size) reader_.fail(token, "this condition is too long");
    Criterion result = made(op, token);
    result.operands = {std::move(left), std::move(right)};
    return result;
  }

  /// What stands between and/or.
  Criterion operand() {
    const Deeper deeper(*this);
    const Token token = reader_.peek();
    if (reader_.accept("not")) {
      Criterion result = made(Op::not_, token);
      result.operands = {operand()};
      return result;
    }
    if (token.kind == Token::Kind::word && same_word(token.text, "with")) {
      reader_.take();
      return operand();
    }
    Criterion result = comparison();
    want_condition(result);
    return result;
  }

  /// The operator of the current token. A number with a sign, or a word that goes on behind a sign, is cut there.
  template <std::size_t n>
  Op accept_sign(const std::array<Sign, n>& signs) {
    const Token token = reader_.peek();
    const bool signed_number =
        token.kind == Token::Kind::number && (token.text.starts_with('+') || token.text.starts_with('-'));
    if (token.kind != Token::Kind::symbol && !signed_number && !token.text.starts_with('/')) return Op::truth;
    for (const Sign& each : signs) {
      const bool whole = token.kind == Token::Kind::symbol && token.text == each.text;
      const bool part = token.kind != Token::Kind::symbol && token.kind != Token::Kind::string &&
                        token.text.size() > 1 && token.text.substr(0, 1) == each.text;
      const bool slash = token.kind == Token::Kind::word && token.text == each.text;
      if (part) reader_.split(1);
      if (whole || part || slash) {
        reader_.take();
        return each.op;
      }
    }
    return Op::truth;
  }

  /// radius 4 to 6
  Criterion between(Criterion of, const Token& token) {
    Criterion low = sum();
    if (!reader_.accept("to")) reader_.fail();
    Criterion high = sum();
    want_number(low);
    want_number(high);
    // The ends are in it, whatever rounding has made of them.
    const auto side = [&](Op op, Criterion end) {
      Criterion beyond = joined(op, token, of, end);
      return joined(Op::or_, token, std::move(beyond), joined(Op::equal, token, of, std::move(end)));
    };
    Criterion above = side(Op::greater, std::move(low));
    return joined(Op::and_, token, std::move(above), side(Op::less, std::move(high)));
  }

  Criterion comparison() {
    // `x_coord -1 to 1` is no difference.
    const bool is_span = reader_.peek().kind == Token::Kind::word && reader_.ahead().kind == Token::Kind::number &&
                         reader_.ahead(2).kind == Token::Kind::word && same_word(reader_.ahead(2).text, "to");
    Criterion left = is_span ? factor() : sum();
    const Token token = reader_.peek();
    const bool is_number =
        token.kind == Token::Kind::number || (token.kind == Token::Kind::symbol && token.text == "(");
    if (left.op == Op::attribute && !is_condition(left) && is_number) return between(std::move(left), token);
    const Op op = accept_sign(comparisons);
    if (op == Op::truth) {
      if (!is_condition(left)) reader_.expect("a comparison");
      return left;
    }
    Criterion right = sum();
    const bool truths = is_condition(left) && is_condition(right) && (op == Op::equal || op == Op::not_equal);
    if (!truths) {
      want_number(left);
      want_number(right);
    }
    Criterion result = joined(op, token, std::move(left), std::move(right));
    if ((op == Op::equal || op == Op::not_equal) && !truths && reader_.accept("tolerance", 3)) {
      const Token number = reader_.peek();
      if (number.kind != Token::Kind::number) {
        reader_.expect("a number");
        reader_.fail();
      }
      if (number.value < 0) reader_.fail(number, "a tolerance can't be negative");
      result.tolerance = reader_.take().value;
    }
    return result;
  }

  Criterion sum() {
    return chain(sums, [&] { return chain(products, [&] { return factor(); }); });
  }

  template <std::size_t n, class F>
  Criterion chain(const std::array<Sign, n>& signs, F next) {
    Criterion left = next();
    while (true) {
      const Token token = reader_.peek();
      const Op op = accept_sign(signs);
      if (op == Op::truth) return left;
      Criterion right = next();
      want_number(left);
      want_number(right);
      left = joined(op, token, std::move(left), std::move(right));
    }
  }

  Criterion factor() {
    const Deeper deeper(*this);
    reader_.cut_at_sign();
    const Token token = reader_.peek();
    if (token.kind == Token::Kind::number) {
      Criterion result = made(Op::number, reader_.take());
      result.value = token.value;
      return result;
    }
    if (reader_.at_symbol("-")) {
      reader_.take();
      Criterion inner = factor();
      want_number(inner);
      if (inner.op == Op::number) {
        inner.value = -inner.value;
        return inner;
      }
      Criterion result = made(Op::negate, token);
      result.operands = {std::move(inner)};
      return result;
    }
    if (reader_.at_symbol("(")) {
      reader_.take();
      Criterion inner = inside_parentheses();
      if (!reader_.at_symbol(")")) {
        reader_.expect(")");
        reader_.fail();
      }
      reader_.take();
      return inner;
    }
    for (const auto& [word, value] : {std::pair{"true", 1.0}, {"false", 0.0}, {"yes", 1.0}, {"no", 0.0}})
      if (token.kind == Token::Kind::word && same_word(token.text, word)) {
        Criterion result = made(Op::truth, reader_.take());
        result.value = value;
        return result;
      }
    return attribute();
  }

  /// A condition or a number.
  Criterion inside_parentheses() {
    const Deeper deeper(*this);
    const Token& token = reader_.peek();
    const auto is = [&](std::string_view word) {
      return token.kind == Token::Kind::word && same_word(token.text, word);
    };
    if (is("not") || is("with")) return condition();
    Criterion left = comparison();
    while (true) {
      const Token between = reader_.peek();
      const Op op = reader_.accept("and") ? Op::and_ : reader_.accept("or") ? Op::or_ : Op::truth;
      if (op == Op::truth) return left;
      want_condition(left);
      left = joined(op, between, std::move(left), operand());
    }
  }

  Criterion attribute() {
    const Token token = reader_.peek();
    std::vector<Keyword> words;
    words.reserve(attribute_table.size());
    for (const AttributeSpec& spec : attribute_table)
      words.push_back(
          {spec.word, (spec.kinds >> static_cast<int>(kind_) & 1) && spec.spelled.empty(), spec.spelled.empty()});
    const auto found = reader_.match(words);
    if (!found) reader_.fail();
    const AttributeSpec& spec = attribute_table[*found];
    reader_.take();
    Criterion result = made(Op::attribute, token);
    result.token.text = spec.spelled.empty() ? spec.word : spec.spelled;  // in full for messages
    result.attribute = spec.attribute;
    if (spec.attribute == Attribute::quality) result.text = metric_name();
    if (spec.attribute == Attribute::name) return pattern(std::move(result));
    EntityKind about = kind_;
    if (reader_.accept("of")) {
      result.of.push_back(read_single(reader_));
      about = result.of[0].kind;
    }
    if (!(spec.kinds >> static_cast<int>(about) & 1)) refuse(token, spec, about);
    return result;
  }

  [[noreturn]] void refuse(const Token& token, const AttributeSpec& spec, EntityKind about) const {
    std::vector<std::string> known;
    for (const AttributeSpec& each : attribute_table)
      if ((each.kinds >> static_cast<int>(about) & 1) && each.spelled.empty()) known.emplace_back(each.word);
    reader_.fail(token, std::string(plural(about)) + " have no " + std::string(spec.word) + "; they have " +
                            alternatives(known));
  }

  /// "shape" when none is said; the metric's words joined by underscores.
  std::string metric_name() {
    Metric found = Metric::shape;
    reader_.cut_at_sign();
    const Token token = reader_.peek();
    const auto is_metric = [](const std::string& words) {
      try {
        metric(words);
        return true;
      } catch (const Error&) {
        return false;
      }
    };
    const bool keyword =
        token.kind == Token::Kind::word && (same_word(token.text, "of") || same_word(token.text, "in"));
    if (token.kind == Token::Kind::word && !keyword) {
      reader_.take();
      const Token& second = reader_.peek();
      const std::string tail = second.text.substr(0, second.text.find_first_of("-/"));
      const std::string two = token.text + " " + tail;
      if (second.kind == Token::Kind::word && !tail.empty() && is_metric(two)) {
        reader_.cut_at_sign();
        reader_.take();
        found = metric(two);
      } else if (is_metric(token.text)) {
        found = metric(token.text);
      } else {
        for (const Metric each : metrics()) reader_.expect(metric_word(each));
        reader_.fail(token);
      }
    }
    return metric_word(found);
  }

  static std::string metric_word(Metric metric) {
    std::string word = hextwist::name(metric);
    std::ranges::replace(word, ' ', '_');
    std::ranges::transform(word, word.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
    return word;
  }

  /// name "in*", name = "in*", name <> "in*"
  Criterion pattern(Criterion result) {
    const Token token = result.token;
    if (!(named >> static_cast<int>(kind_) & 1)) refuse(token, spec_of(Attribute::name), kind_);
    bool negated = false;
    for (const auto* sign : {"=", "==", "<>"})
      if (reader_.at_symbol(sign)) {
        negated = std::string_view(sign) == "<>";
        reader_.take();
        break;
      }
    const Token& text = reader_.peek();
    if (text.kind != Token::Kind::string && text.kind != Token::Kind::word) {
      reader_.expect("a name in quotes");
      reader_.fail();
    }
    result.op = Op::named;
    result.text = reader_.take().text;
    if (!negated) return result;
    Criterion inverse = made(Op::not_, token);
    inverse.operands = {std::move(result)};
    return inverse;
  }
};

}  // namespace

std::span<const AttributeSpec> attributes() {
  return attribute_table;
}

Criterion read_criterion(Reader& reader, EntityKind kind) {
  return CriterionReader(reader, kind).condition();
}

Criterion read_measure(Reader& reader, EntityKind kind) {
  return CriterionReader(reader, kind).measure();
}

std::string to_string(const Criterion& c) {
  const auto inner = [&](const Criterion& operand, bool tight) {
    const int mine = precedence(c.op), its = precedence(operand.op);
    const bool parentheses = tight ? its <= mine : its < mine;
    return parentheses ? "(" + to_string(operand) + ")" : to_string(operand);
  };
  switch (c.op) {
    case Op::number:
      return number_text(c.value);
    case Op::truth:
      return c.value != 0 ? "true" : "false";
    case Op::attribute: {
      std::string result(spec_of(c.attribute).word);
      if (c.attribute == Attribute::quality) result += " " + c.text;
      if (!c.of.empty()) result += " of " + to_string(c.of[0]);
      return result;
    }
    case Op::named:
      return "name " + quoted_text(c.text);
    case Op::negate:
      return "-" + inner(c.operands[0], false);
    case Op::not_:
      return "not " + inner(c.operands[0], false);
    default: {
      // Comparisons do not chain, so both sides are tight; and/or, sums and products go on to the left.
      const bool comparison = precedence(c.op) == 3;
      std::string result =
          inner(c.operands[0], comparison) + " " + std::string(sign(c.op)) + " " + inner(c.operands[1], true);
      if (!std::isnan(c.tolerance)) result += " tolerance " + number_text(c.tolerance);
      return result;
    }
  }
}

}  // namespace hextwist
