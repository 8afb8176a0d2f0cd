#include <algorithm>
#include <string>

#include "hextwist/command/expression.h"
#include "hextwist/command/reader.h"
#include "hextwist/command/syntax.h"

namespace hextwist {
namespace {

constexpr std::size_t line_width = 100;

/// Breaks text at blanks; continued lines are indented.
std::string wrapped(std::string_view text, std::size_t first_indent, std::size_t indent) {
  std::string result(first_indent, ' ');
  std::size_t column = first_indent;
  bool fresh = true;
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t end = std::min(text.find_first_of(" \n", at), text.size());
    const std::string_view word = text.substr(at, end - at);
    if (!fresh && column + 1 + word.size() > line_width) {
      result += '\n' + std::string(indent, ' ');
      column = indent;
      fresh = true;
    }
    result += (fresh ? "" : " ") + std::string(word);
    column += word.size() + (fresh ? 0 : 1);
    fresh = false;
    if (end < text.size() && text[end] == '\n') {
      result += '\n' + std::string(indent, ' ');
      column = indent;
      fresh = true;
    }
    at = end + 1;
  }
  return result + "\n";
}

std::string padded(std::string_view text, std::size_t width) {
  return std::string(text) + std::string(text.size() < width ? width - text.size() : 1, ' ');
}

constexpr std::string_view range_text = R"(range: which entities a command is about

  1 3 5              these ids, each of which must exist
  3 to 17            all existing ids from 3 to 17; the ends must not lie beyond the ids in use
  3 to 17 by 2       every second one ('step' is the same)
  all                every entity of the kind
  "name"             all entities of that name (CAD, blocks, sets, groups); "in*" with wildcards
  (at 0 1 2)         the nearest to that point; (at 0 1 2 ordinal 2) the second nearest
  ... except 5 7     without these; 'except hex in block 1' without any range of the same kind
  ... in volume 2    those that lie in, or touch, the others: up and down, across mesh, CAD, blocks and sets
                     (hex in volume 2, node in face in surface 7, curve in surface 3, block in hex 10);
                     several kinds may follow: face in surface 3 curve 1 2; or a name: curve in fillets
  ... common_to ...  those that lie in each of the others: curve common_to surface 1 2
  ... with ...       those that meet a condition:
                     hex all with quality shape < 0.3
                     curve with length < 2 and (x_coord > 1 or not z_max = 5)
                     about: id, x_coord y_coord z_coord, x_min .. z_max, length, area, volume, radius, quality <metric>,
                     is_planar, is_spline, is_meshed, is_hole, element_count, num_parents, block_assigned,
                     name "in*"; 'radius 4 to 6' is from 4 to 6
                     'and' and 'or' go from left to right; 'length of curve 5'; '= 5 tolerance 1e-3'
  (within 2 of 0 1 2)             with a point that near
  ... loop of surface 3 (at 0 1 2)  curves of the outer loop, or of the one nearest to that point
  ... chain from curve 3          that go on smoothly from there; surfaces too
  ... adjacent to surface 3       that meet it
  ... parallel to surface 3       or 'perpendicular to'; also x, y, z
  ... largest 3 by area           or 'smallest'
  ... in box 0 0 0 1 1 1          with their middle there; 'in sphere x y z radius r', 'in cylinder x y z to x y z radius r'

  'except' belongs to the list of ids before it: in 'hex in volume all except 5' that is volume 5. 'in' belongs to the
  kind before it. 'with' is about the kind that the range began with, or about a kind without ids right before it.
  Parentheses end a range: curve in (surface 1 to 9 with area > 3).
)";

constexpr std::string_view expression_text =
    R"(expressions: what stands between braces is replaced by its value, in file names too

  {n = 4}                          a line of its own; #{n = 4} is the same
  refine curve {n + 1} size {h/2}  variables keep their value until the session ends
  export vtk "part_{n}.vtu"        \{ is a plain brace
  {n > 3 ? 2 : 1}  {n++}  {"part_" // n}  {format(h, "%.2f")}

  operators  + - * / % ^ ( )  == != < <= > >=  && || !  ? :  = += -= *= /= ^= ++ --  // (joins texts)
)";

/// Words that the help on expressions ends with, so that they are never behind.
std::string functions_text() {
  std::string words = "functions and values:";
  for (const std::string& word : expression_words()) words += " " + word;
  return wrapped(words, 2, 13);
}

}  // namespace

std::string help() {
  std::string result = "Commands (words may be cut short; # starts a comment; ; separates commands):\n\n";
  for (const CommandSpec& spec : language())
    if (!spec.syntax.empty()) result += "  " + padded(spec.name, 12) + std::string(spec.summary) + "\n";
  return result + "  " + padded("help range", 12) + "how to say which entities\n" + "  " + padded("help expr", 12) +
         "{...}: variables and arithmetic\n" + "\n'help <command>' shows syntax, options and examples.\n";
}

std::string help(std::string_view word) {
  if (same_word(word, "range")) return std::string(range_text);
  if (word.size() >= 4 && begins_word(word, "expressions")) return std::string(expression_text) + functions_text();
  std::vector<const CommandSpec*> found;
  for (const CommandSpec& spec : language()) {
    if (spec.syntax.empty()) continue;
    if (same_word(spec.name, word)) {
      found = {&spec};
      break;
    }
    if (begins_word(word, spec.name)) found.push_back(&spec);
  }
  if (found.empty()) throw Error("there is no command '" + printable(word) + "'; 'help' lists them");
  std::string result;
  for (const CommandSpec* spec : found) {
    if (!result.empty()) result += "\n";
    result += std::string(spec->name) + ": " + std::string(spec->summary) + "\n\n";
    result += wrapped(shown_syntax(*spec), 2, 6);
    bool any = false;
    for (const ArgumentSpec& argument : spec->arguments) {
      if (argument.help.empty()) continue;
      result += (any ? "" : "\n") +
                wrapped(padded("<" + std::string(argument.name) + ">", 14) + std::string(argument.help), 2, 16);
      any = true;
    }
    if (!spec->details.empty()) result += "\n" + wrapped(spec->details, 2, 2);
    if (!spec->examples.empty()) result += "\n  examples\n";
    for (const auto example : spec->examples) result += "    " + std::string(example) + "\n";
  }
  return result;
}

}  // namespace hextwist
