// Completion that knows the session: names of CAD entities, blocks, sets and groups, and commands after `help`.

#include <algorithm>
#include <optional>

#include "hextwist/base/sorted.h"
#include "hextwist/command/reader.h"
#include "hextwist/command/syntax.h"
#include "hextwist/session/core.h"

namespace hextwist {
namespace {

constexpr Index max_named = 100000;  // beyond that nobody waits for a list

/// The kind of entity that a word is (short for).
std::optional<EntityKind> kind_of(const Token& token) {
  std::optional<EntityKind> result;
  for (int k = 0; k < n_entity_kinds && token.kind == Token::Kind::word; ++k) {
    const auto kind = static_cast<EntityKind>(k);
    if (same_word(token.text, name(kind))) return kind;
    if (!begins_word(token.text, name(kind))) continue;
    if (result) return std::nullopt;
    result = kind;
  }
  return result;
}

/// As it can be written in a command.
std::string written_name(const std::string& text) {
  const std::vector<Statement> statements = split_statements(text);
  const bool plain = statements.size() == 1 && statements[0].tokens.size() == 2 &&
                     statements[0].tokens[0].kind == Token::Kind::word && statements[0].tokens[0].text == text;
  return plain ? text : "\"" + text + "\"";
}

}  // namespace

std::vector<std::string> Session::completions(std::string_view line) const {
  std::vector<std::string> result = hextwist::completions(line);
  const Expected expected = expected_at_end(line);
  const auto expects = [&](const char* what) { return std::ranges::find(expected.what, what) != expected.what.end(); };
  std::optional<EntityKind> kind;
  for (const Token& token : expected.before)
    if (const auto said = kind_of(token)) kind = said;
  if (expects("a name") && kind && has_names(*kind)) {
    const Selector selector = core_->selector();
    for (Index i = 0; i < std::min(count(selector, *kind), max_named); ++i) {
      const std::string text = name_of(selector, *kind, i);
      if (!text.empty() && text.find('"') == std::string::npos && begins_word(expected.beginning, text))
        result.push_back(written_name(text));
    }
  }
  if (!expected.before.empty() && begins_word(expected.before[0].text, "help") && expects("a word"))
    for (const CommandSpec& spec : language())
      if (begins_word(expected.beginning, spec.name) && !spec.syntax.empty()) result.emplace_back(spec.name);
  sort_unique(result);
  return result;
}

}  // namespace hextwist
