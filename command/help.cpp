#include <algorithm>
#include <cctype>
#include <string>

#include "hextwist/command/expression.h"
#include "hextwist/command/pattern_internal.h"
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
         "{...}: variables and arithmetic\n" +
         "\n'help <command>' shows syntax and examples, 'help <command> <option>' one option, 'help <command> all' "
         "everything.\n";
}

namespace {

/// Longer ones come with `help ... all`.
constexpr std::size_t short_details = 400;

/// The command of that name, else those that begin with it.
std::vector<const CommandSpec*> commands_named(std::string_view word) {
  std::vector<const CommandSpec*> found;
  for (const CommandSpec& spec : language()) {
    if (spec.syntax.empty()) continue;
    if (same_word(spec.name, word)) return {&spec};
    if (begins_word(word, spec.name)) found.push_back(&spec);
  }
  if (!found.empty()) return found;
  std::vector<std::string> names;
  for (const CommandSpec& spec : language()) names.emplace_back(spec.name);
  const std::vector<std::string> near = nearest_words(word, names, 3);
  throw Error("there is no command '" + printable(word) + "'" +
              (near.empty() ? "" : ": did you mean " + alternatives(near) + "?") + (near.empty() ? ";" : "") +
              " 'help' lists them");
}

std::string arguments_text(const CommandSpec& spec, std::string_view syntax) {
  std::string result;
  for (const ArgumentSpec& argument : spec.arguments) {
    const std::string written = "<" + std::string(argument.name) + ">";
    if (argument.help.empty() || syntax.find(written) == std::string_view::npos) continue;
    result += (result.empty() ? "\n" : "") + wrapped(padded(written, 14) + std::string(argument.help), 2, 16);
  }
  return result;
}

std::string page(const CommandSpec& spec, bool whole) {
  std::string result = std::string(spec.name) + ": " + std::string(spec.summary) + "\n\n";
  const std::string syntax = shown_syntax(spec);
  result += wrapped(syntax, 2, 6) + arguments_text(spec, syntax);
  const bool details = whole || spec.details.size() <= short_details;
  if (details && !spec.details.empty()) result += "\n" + wrapped(spec.details, 2, 2);
  if (!spec.examples.empty()) result += "\n  examples\n";
  for (const auto example : spec.examples) result += "    " + std::string(example) + "\n";
  if (!details)
    result += "\n  'help " + std::string(spec.name) + " all' tells more, 'help " + std::string(spec.name) +
              " <option>' of one option.\n";
  return result;
}

/// The options that begin with that word, and whatever they stand in.
void collect_options(const Pattern& pattern, std::string_view word, std::vector<std::string>& found) {
  for (const PatternNode& node : pattern)
    for (const Pattern& choice : node.choices) {
      const PatternNode* first = &choice.front();
      bool begins = first->kind == PatternNode::Kind::word && !first->hidden && same_word(first->name, word);
      if (first->kind == PatternNode::Kind::one_of)
        begins = std::ranges::any_of(first->choices, [&](const Pattern& inner) {
          return inner.front().kind == PatternNode::Kind::word && same_word(inner.front().name, word);
        });
      const std::string text = to_string(choice);
      if (begins && !text.empty() && std::ranges::find(found, text) == found.end()) found.push_back(text);
      if (!begins) collect_options(choice, word, found);
    }
}

/// The sentences that say the word.
std::string sentences_with(std::string_view text, std::string_view word) {
  std::string result;
  while (!text.empty()) {
    const std::size_t stop = std::min(text.find(". "), text.find(".\n"));
    const std::size_t end = stop == std::string_view::npos ? text.size() : stop + 1;
    const std::string_view sentence = text.substr(0, end);
    text.remove_prefix(std::min(text.size(), end + 1));
    bool says = false;
    for (std::size_t at = sentence.find(word); at != std::string_view::npos && !says;
         at = sentence.find(word, at + 1)) {
      const auto ends = [&](std::size_t i) {
        return i >= sentence.size() || !std::isalnum(static_cast<unsigned char>(sentence[i]));
      };
      says = (at == 0 || ends(at - 1)) && ends(at + word.size()) &&
             (at + word.size() >= sentence.size() || sentence[at + word.size()] != '_');
    }
    if (says) result += (result.empty() ? "" : " ") + std::string(sentence);
  }
  return result;
}

}  // namespace

std::string help(std::string_view word) {
  if (same_word(word, "range")) return std::string(range_text);
  if (word.size() >= 4 && begins_word(word, "expressions")) return std::string(expression_text) + functions_text();
  std::string result;
  for (const CommandSpec* spec : commands_named(word)) result += (result.empty() ? "" : "\n") + page(*spec, false);
  return result;
}

std::string help(std::string_view word, std::string_view option) {
  const CommandSpec& spec = *commands_named(word).front();
  if (same_word(option, "all")) return page(spec, true);
  std::vector<std::string> found;
  collect_options(compile_pattern(spec.syntax), option, found);
  if (found.empty())
    throw Error("'" + std::string(spec.name) + "' has no option '" + printable(option) + "'; 'help " +
                std::string(spec.name) + "' shows them");
  std::string result = std::string(spec.name) + " ... " + lower_case(option) + "\n\n", arguments;
  for (const std::string& text : found) {
    result += wrapped(text, 2, 6);
    arguments += text;
  }
  result += arguments_text(spec, arguments);
  if (const std::string said = sentences_with(spec.details, lower_case(option)); !said.empty())
    result += "\n" + wrapped(said, 2, 2);
  std::string examples;
  for (const auto example : spec.examples)
    if ((" " + std::string(example) + " ").find(" " + lower_case(option) + " ") != std::string::npos)
      examples += "    " + std::string(example) + "\n";
  return result + (examples.empty() ? "" : "\n  examples\n" + examples);
}

}  // namespace hextwist
