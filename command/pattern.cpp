#include <cassert>
#include <optional>

#include "hextwist/command/pattern_internal.h"

namespace hextwist {
namespace {

struct Cursor {
  std::string_view text;
  std::size_t at = 0;

  char skip_blanks() {
    while (at < text.size() && (text[at] == ' ' || text[at] == '\n')) ++at;
    return at < text.size() ? text[at] : '\0';
  }
};

Pattern sequence(Cursor& cursor);

PatternNode choices(Cursor& cursor, PatternNode::Kind kind, char close) {
  PatternNode node{kind, "", false, false, {}};
  do {
    ++cursor.at;  // the opening brace or the bar
    node.choices.push_back(sequence(cursor));
  } while (cursor.skip_blanks() == '|');
  assert(cursor.skip_blanks() == close);
  static_cast<void>(close);
  ++cursor.at;
  return node;
}

Pattern sequence(Cursor& cursor) {
  Pattern result;
  while (true) {
    const char c = cursor.skip_blanks();
    if (c == '\0' || c == '|' || c == '}' || c == ']') return result;
    if (c == '{') {
      result.push_back(choices(cursor, PatternNode::Kind::one_of, '}'));
    } else if (c == '[') {
      PatternNode node = choices(cursor, PatternNode::Kind::options, ']');
      // Options that follow each other may come in any order: one node for all. Those within one pair of brackets
      // exclude each other.
      if (node.choices.size() > 1) {
        PatternNode one{PatternNode::Kind::one_of, "", false, false, std::move(node.choices)};
        node.choices = {{std::move(one)}};
      }
      if (!result.empty() && result.back().kind == PatternNode::Kind::options)
        result.back().choices.push_back(std::move(node.choices.front()));
      else
        result.push_back(std::move(node));
    } else if (c == '.') {
      assert(cursor.text.substr(cursor.at).starts_with("...") && result.size() >= 2);
      Pattern once(result.end() - 2, result.end());
      result.resize(result.size() - 2);
      result.push_back({PatternNode::Kind::repeated, "", false, false, {std::move(once)}});
      cursor.at += 3;
    } else {
      const bool planned = c == '~';
      const bool hidden = c == '=';
      if (planned || hidden) ++cursor.at;
      const bool argument = cursor.text[cursor.at] == '<';
      const std::size_t end = argument ? cursor.text.find('>', cursor.at) + 1
                                       : std::min(cursor.text.find_first_of(" \n{}[]|", cursor.at), cursor.text.size());
      std::string name(cursor.text.substr(cursor.at, end - cursor.at));
      if (argument) name = name.substr(1, name.size() - 2);
      assert(!name.empty());
      result.push_back({argument ? PatternNode::Kind::argument : PatternNode::Kind::word, name, planned, hidden, {}});
      cursor.at = end;
    }
  }
}

/// nullopt: nothing to show, for it starts with something planned or hidden.
std::optional<std::string> shown(const Pattern& pattern);

/// What can be shown of the choices, "a|b"; several: whether that are more than one.
std::string shown_choices(const PatternNode& node, bool& several) {
  std::string piece;
  several = false;
  for (const Pattern& choice : node.choices) {
    const std::optional<std::string> text = shown(choice);
    if (!text) continue;
    several = !piece.empty();
    piece += (piece.empty() ? "" : "|") + *text;
  }
  return piece;
}

std::optional<std::string> shown(const Pattern& pattern) {
  std::string result;
  for (const PatternNode& node : pattern) {
    if (node.planned || node.hidden) return std::nullopt;
    std::string piece;
    bool several = false;
    switch (node.kind) {
      case PatternNode::Kind::word:
        piece = node.name;
        break;
      case PatternNode::Kind::argument:
        piece = "<" + node.name + ">";
        break;
      case PatternNode::Kind::one_of:
        piece = shown_choices(node, several);
        if (piece.empty()) return std::nullopt;
        if (several) piece = "{" + piece + "}";
        break;
      case PatternNode::Kind::options:
        for (const Pattern& choice : node.choices) {
          const bool nested = choice.size() == 1 && choice[0].kind == PatternNode::Kind::one_of;
          const std::string text = nested ? shown_choices(choice[0], several) : shown(choice).value_or("");
          if (!text.empty()) piece += (piece.empty() ? "[" : " [") + text + "]";
        }
        break;
      case PatternNode::Kind::repeated:
        piece = shown(node.choices.front()).value_or("") + " ...";
    }
    if (!piece.empty()) result += (result.empty() ? "" : " ") + piece;
  }
  return result;
}

}  // namespace

Pattern compile_pattern(std::string_view syntax) {
  Cursor cursor{syntax};
  Pattern result = sequence(cursor);
  assert(cursor.at == syntax.size());
  return result;
}

std::string to_string(const Pattern& pattern) {
  return shown(pattern).value_or("");
}

}  // namespace hextwist
