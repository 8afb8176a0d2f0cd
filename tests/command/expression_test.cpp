// Expressions in braces: what they are worth, what they turn commands into, and where their errors point.
#include "hextwist/command/expression.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "hextwist/command/braces.h"
#include "hextwist/command/syntax.h"
#include "hextwist/session/session.h"
#include "support/seed.h"

namespace hextwist {
namespace {

double number_of(std::string_view text) {
  Variables variables = {{"a", 3.0}, {"B", -2.0}, {"name", std::string("left")}};
  return std::get<double>(evaluate(text, variables).value);
}
std::string text_from(std::string_view text) {
  Variables variables = {{"a", 3.0}, {"name", std::string("left")}};
  return text_of(evaluate(text, variables).value);
}

TEST(Expressions, arithmetic_is_the_usual) {
  for (const auto& [text, value] : std::vector<std::pair<const char*, double>>{
           {"1 + 2 * 3", 7},
           {"(1 + 2) * 3", 9},
           {"2 ^ 3 ^ 2", 512},
           {"2 ** 3", 8},
           {"-2 ^ 2", -4},
           {"2 ^ -1", 0.5},
           {"7 - 2 - 1", 4},
           {"8 / 4 / 2", 1},
           {"7 % 4", 3},
           {"a * B", -6},
           {"+a - -a", 6},
           {"1e-3 * 1e3", 1},
           {".5 + 5.", 5.5},
           {"a > 2 && B < 0", 1},
           {"a > 2 && B > 0 || 0", 0},
           {"!a", 0},
           {"a == 3 ? 10 : 20", 10},
           {"a != 3 ? 10 : 20", 20},
           {"a <= 3", 1},
           {"a >= 4", 0},
           {"0 ? 1 / 0 : 5", 5},
           {"1 ? 5 : undefined", 5},
           {"name == \"left\"", 1},
           {"sin(PI / 6)", 0.5},
           {"sind(30)", 0.5},
           {"cosd(60)", 0.5},
           {"tand(45)", 1},
           {"asind(0.5)", 30},
           {"acosd(0.5)", 60},
           {"atand(1)", 45},
           {"atan2(1, 1)", std::atan(1.0)},
           {"atan2d(1, 1)", 45},
           {"sqrt(16)", 4},
           {"cbrt(27)", 3},
           {"abs(-4)", 4},
           {"min(3, 1, 2)", 1},
           {"max(3, 1, 2)", 3},
           {"pow(2, 10)", 1024},
           {"exp(0) + ln(E) + log(E) + log10(100)", 5},
           {"floor(1.7) + ceil(1.2) + int(-1.7) + nint(2.5) + round(-2.5)", 1 + 2 - 1 + 3 - 3},
           {"hypot(3, 4) + dist(0, 0, 3, 4)", 10},
           {"sign(3, -1)", -3},
           {"dim(5, 3) + dim(3, 5)", 2},
           {"fmod(7, 4)", 3},
           {"d2r(180) / PI + r2d(PI)", 181},
           {"polarX(2, 60) + polarY(2, 30)", 2},
           {"sinh(0) + cosh(0) + tanh(0) + asinh(0) + acosh(1) + atanh(0) + log1p(0)", 1},
           {"PI_2 * 2 - PI + TAU - 2 * PI + DEG * RAD", 1},
       })
    EXPECT_NEAR(number_of(text), value, 1e-12) << text;
}

TEST(Expressions, texts_are_joined_and_formatted) {
  EXPECT_EQ(text_from("\"part_\" // a"), "part_3");
  EXPECT_EQ(text_from("'a \"b\"'"), "a \"b\"");
  EXPECT_EQ(text_from("toupper(name) // tolower(\"ABC\") // tostring(0.5)"), "LEFTabc0.5");
  EXPECT_EQ(text_from("format(a, \"n%03d.msh\")"), "n003.msh");
  EXPECT_EQ(text_from("format(2/3, \"%.2f\")"), "0.67");
  EXPECT_EQ(text_from("1000000"), "1000000");
  EXPECT_EQ(text_from("1e20"), "1e+20");
  EXPECT_EQ(text_from("1/4"), "0.25");
  EXPECT_EQ(std::stod(text_from("1/3")), 1.0 / 3);
}

TEST(Expressions, assignments_stay_and_failures_change_nothing) {
  Variables variables;
  EXPECT_EQ(evaluate("n = 3", variables).assigned, "n");
  evaluate("n += 2", variables);
  evaluate("m = k = n * 2", variables);
  EXPECT_EQ(std::get<double>(variables.at("m")), 10);
  EXPECT_EQ(std::get<double>(variables.at("k")), 10);
  EXPECT_EQ(std::get<double>(evaluate("n++", variables).value), 5);
  EXPECT_EQ(std::get<double>(evaluate("n--", variables).value), 6);
  evaluate("n -= 1", variables);
  evaluate("n *= 6", variables);
  evaluate("n /= 3", variables);
  evaluate("n ^= 2", variables);
  EXPECT_EQ(std::get<double>(variables.at("n")), 64);
  evaluate("PI = 3", variables);  // as APREPRO allows
  EXPECT_EQ(std::get<double>(evaluate("PI", variables).value), 3);
  evaluate("n == 1 ? q = 1 : 0", variables);
  EXPECT_FALSE(variables.contains("q"));
  const Variables before = variables;
  EXPECT_THROW(evaluate("(n = 4) + bogus", variables), ExpressionError);
  EXPECT_EQ(variables, before);
}

struct Wrong {
  const char* text;
  std::size_t offset;
  const char* message;
};

TEST(Expressions, errors_point_at_what_is_wrong) {
  for (const auto& [text, offset, message] : std::vector<Wrong>{
           {"", 0, "there is nothing between the braces"},
           {"1 +", 3, "the expression ends too early"},
           {"1 + )", 4, "a value was expected here"},
           {"(1", 2, "expected )"},
           {"1 2", 2, "expected an operator or the end"},
           {"1 / 0", 4, "division by zero"},
           {"1 % 0", 4, "division by zero"},
           {"height", 0, "'height' has no value yet"},
           {"2 * nams", 4, "'nams' has no value yet (did you mean 'name'?)"},
           {"A", 0, "'A' has no value yet"},
           {"sqr(2)", 0, "there is no function 'sqr' (did you mean 'sqrt'?)"},
           {"sqrt()", 0, "sqrt takes 1 value, not 0"},
           {"pow(2)", 0, "pow takes 2 values, not 1"},
           {"max()", 0, "max takes at least one value"},
           {"sqrt(2", 6, "expected , or )"},
           {"sqrt(-1)", 0, "sqrt has no value there"},
           {"sqrt(name)", 5, "a number was expected here, not a text"},
           {"name + 1", 0, "a number was expected here, not a text"},
           {"name < 1", 0, "a number was expected here, not a text"},
           {"'a", 0, "this quote is not closed"},
           {"1e999", 0, "this number is out of range"},
           {"1e300 * 1e300", 0, "the result is not a finite number"},
           {"sin = 3", 0, "'sin' is a function"},
           {"x = 1e300 * 1e300", 0, "the value of 'x' is not a finite number"},
           {"x += 1", 0, "'x' has no value yet"},
           {"1 ? 2", 5, "expected ':'"},
           {"format(1, 'abc')", 10, "must hold one of %d"},
           {"format(1, '%s')", 10, "must hold one of %d"},
           {"format(1, '%d%d')", 10, "must hold one of %d"},
           {"format(1e300, '%d')", 14, "too large for %d"},
           {"format(name, '%d')", 7, "a number was expected"},
           {"loop(5)", 0, "'{loop}' stands alone on its line, as in {loop(3)} ... {endloop}"},
           {"EndLoop", 0, "'{EndLoop}' stands alone"},
           {"Ifdef(x)", 0, "'{Ifdef}' stands alone"},
           {"else", 0, "'{else}' stands alone"},
           {"include(\"a.jou\")", 0, "'{include}' stands alone"},
       }) {
    Variables variables = {{"name", std::string("left")}};
    try {
      evaluate(text, variables);
      ADD_FAILURE() << "no error: " << text;
    } catch (const ExpressionError& error) {
      EXPECT_EQ(error.offset(), offset) << text << ": " << error.what();
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << text << ": " << error.what();
    }
  }
  Variables variables;
  EXPECT_THROW(evaluate(std::string(100000, '('), variables), ExpressionError);
  EXPECT_THROW(evaluate(std::string(100000, '-'), variables), ExpressionError);
}

TEST(Expressions, garbage_is_refused_or_worth_something) {
  const unsigned seed = test::random_seed();
  RecordProperty("seed", static_cast<int>(seed));
  std::mt19937 random(seed);
  const std::vector<std::string> pieces = {"a",  "=",   "+",     "-",  "*",  "/",       "^",   "(",  ")",  "sqrt(",
                                           "1",  "2.5", "\"x\"", "?",  ":",  ",",       "!",   "&&", "||", "//",
                                           "++", "--",  "<",     "==", "PI", "format(", "'",   "\"", "{",  "}",
                                           "%",  "e",   ".",     " ",  "_",  "max(",    "\xff"};
  for (int run = 0; run < 20000; ++run) {
    std::string text;
    for (int i = static_cast<int>(random() % 10); i >= 0; --i) text += pieces[random() % pieces.size()];
    Variables variables = {{"a", 2.0}};
    const Variables before = variables;
    try {
      const Evaluated result = evaluate(text, variables);
      if (const double* number = std::get_if<double>(&result.value)) {
        EXPECT_TRUE(std::isfinite(*number)) << text;
        EXPECT_EQ(std::stod(text_of(result.value)), *number) << text;
      }
    } catch (const ExpressionError& error) {
      EXPECT_LE(error.offset(), text.size()) << text;
      EXPECT_EQ(variables, before) << text << ", seed " << seed;
    }
  }
}

std::string expanded(std::string_view text, Variables variables = {}) {
  std::string result;
  for (const Statement& statement : split_statements(text)) {
    const Expanded one = expand(statement, variables);
    for (const std::string& line : one.lines) result += "[" + line + "]";
    if (one.statement) result += "<" + to_string(parse(*one.statement)) + ">";
  }
  return result;
}

TEST(Braces, values_take_their_place_in_commands) {
  const Variables variables = {{"n", 3.0}, {"h", 0.5}, {"s", std::string("left")}, {"c", std::string("refine hex 1")}};
  EXPECT_EQ(expanded("refine curve {n} numsplit {n - 1}", variables), "<refine curve 3 numsplit 2>");
  EXPECT_EQ(expanded("refine curve {n} to {n*2} by {n-1}", variables), "<refine curve 3 to 6 by 2>");
  EXPECT_EQ(expanded("import mesh \"part_{n}.msh\"", variables), "<import mesh \"part_3.msh\">");
  EXPECT_EQ(expanded("import mesh part_{n}.msh", variables), "<import mesh \"part_3.msh\">");
  EXPECT_EQ(expanded("refine curve 1{n}", variables), "<refine curve 13>");
  EXPECT_EQ(expanded("refine hex in block {s}", variables), "<refine hex in block \"left\">");
  EXPECT_EQ(expanded("refine hex with x_coord < {h} and y_coord > -{h}", variables),
            "<refine hex with x_coord < 0.5 and y_coord > -0.5>");
  EXPECT_EQ(expanded("refine hex with x_coord > {n}-{h}", variables), "<refine hex with x_coord > 3 - 0.5>");
  EXPECT_EQ(expanded("{c} numsplit 2", variables), "<refine hex 1 numsplit 2>");
  EXPECT_EQ(expanded("{c}", variables), "<refine hex 1>");
  EXPECT_EQ(expanded("refine curve {k = 2} numsplit {k}", variables), "<refine curve 2 numsplit 2>");
  EXPECT_EQ(expanded("import mesh \"a\\{n}.msh\"", variables), "<import mesh \"a\\{n}.msh\">");
  EXPECT_EQ(expanded("import mesh '{\"a\" // n}.msh'", variables), "<import mesh \"a3.msh\">");
}

TEST(Braces, lines_may_be_expressions_alone) {
  EXPECT_EQ(expanded("{h = 0.5}"), "[h = 0.5]");
  EXPECT_EQ(expanded("#{h = 0.5}"), "[h = 0.5]");
  EXPECT_EQ(expanded("# {h = 0.5}"), "[h = 0.5]");
  EXPECT_EQ(expanded("## { n = 1 } # { n ++ } #{n}"), "[n = 1][n = 1][2]");
  EXPECT_EQ(expanded("# {not this} {nor = this"), "");
  EXPECT_EQ(expanded("# {h == 0.5}"), "");
  EXPECT_EQ(expanded("#{a = 1} {b = \"x\"} # {c = 2} and so on {d = 3}"), "[a = 1][b = \"x\"][c = 2]");
  EXPECT_EQ(expanded("{a = 1}; {b = a + 1}; refine hex {b} # and {not} this"), "[a = 1][b = 2]<refine hex 2>");
  EXPECT_EQ(expanded("reset #{a = 1}\nrefine hex {a}"), "<reset>[a = 1]<refine hex 1>");
  EXPECT_EQ(expanded("{1 + 1}"), "[2]");
}

TEST(Braces, errors_point_into_them) {
  const auto error = [](std::string_view text) -> std::string {
    Variables variables;
    try {
      for (const Statement& statement : split_statements(text)) {
        const Expanded one = expand(statement, variables);
        if (one.statement) parse(*one.statement);
      }
    } catch (const CommandError& wrong) {
      return std::to_string(wrong.column()) + ": " + wrong.message();
    }
    return "no error";
  };
  EXPECT_EQ(error("refine curve {n}"), "15: 'n' has no value yet");
  EXPECT_EQ(error("refine curve {1 + }"), "19: the expression ends too early");
  EXPECT_EQ(error("refine curve 3 numsplit {2.5}"), "25: numsplit must be a whole number from 1 to 29");
  EXPECT_EQ(error("refine {\"crve\"} 3").substr(0, 26), "8: expected node, edge, fa");
  EXPECT_EQ(error("refine curve {n"), "14: this brace is not closed on its line");
  EXPECT_EQ(error("import mesh \"a{n.msh\""), "15: this brace is not closed (\\{ is a plain brace)");
  EXPECT_EQ(error("import mesh ${HOME}/a.msh"), "13: '${...}' is not supported, only '{...}'");
  EXPECT_EQ(error("import mesh \"${HOME}/a.msh\""), "14: '${...}' is not supported, only '{...}'");
  EXPECT_EQ(error("refine curve {loop(3)}").substr(0, 37), "15: '{loop}' stands alone on its line");
  EXPECT_EQ(error("refine curve {''}"),
            "18: expected an id, a name, all, except, in, common_to or with, found the end of the command");
  EXPECT_EQ(error("{''}"), "1: this leaves no command");
}

TEST(Braces, variables_live_in_the_session) {
  Session session;
  std::vector<std::string> output;
  session.set_callbacks(
      {.output = [&](const std::string& line) { output.push_back(line); }, .notice = {}, .error = {}, .progress = {}});
  session.run("{n = 4}\ncreate brick x {n} interval {n}");
  EXPECT_EQ(session.meshed().mesh.n_hexes(), 64);
  EXPECT_EQ(output.at(0), "n = 4");
  EXPECT_EQ(session.records().at(0).command, "{n = 4}");
  EXPECT_TRUE(session.records().at(0).ok);
  EXPECT_THROW(session.run("refine hex {n = 99}"), CommandError);
  EXPECT_EQ(session.records().back().column, 12);
  session.run("refine hex {n}");  // what a failed command set is forgotten
  EXPECT_EQ(session.records().back().command, "refine hex {n}");
  EXPECT_GT(session.meshed().mesh.n_hexes(), 64);
  EXPECT_EQ(completions("refine hex {n} nu"), (std::vector<std::string>{"numsplit"}));
}

}  // namespace
}  // namespace hextwist
