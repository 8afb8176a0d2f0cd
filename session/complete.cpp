// Completion that knows the session: names of CAD entities, blocks, sets and groups, and commands after `help`.

#include <algorithm>
#include <array>
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

/// Words that a range of the kind may go on with, besides those that every error names.
std::vector<std::string> shape_words(EntityKind kind) {
  if (!is_cad(kind)) return {};
  std::vector<std::string> words = {"adjacent", "largest", "smallest"};
  if (kind == EntityKind::curve) words.emplace_back("loop");
  if (kind == EntityKind::curve || kind == EntityKind::surface)
    for (const char* word : {"chain", "parallel", "perpendicular"}) words.emplace_back(word);
  return words;
}

/// The second of two words that belong together.
std::string_view partner(std::string_view word) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 5> pairs = {
      {{"loop", "of"}, {"chain", "from"}, {"adjacent", "to"}, {"parallel", "to"}, {"perpendicular", "to"}}};
  const auto found = std::ranges::find_if(pairs, [&](const auto& pair) { return same_word(pair.first, word); });
  return found == pairs.end() ? std::string_view() : found->second;
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
  const auto offer = [&](std::string text) {
    if (begins_word(expected.beginning, text)) result.push_back(std::move(text));
  };
  const std::string_view last = expected.before.empty() ? std::string_view() : expected.before.back().text;
  if (kind && expects("common_to"))
    for (std::string& word : shape_words(*kind)) offer(std::move(word));
  if (kind && !partner(last).empty()) {
    result.clear();
    offer(std::string(partner(last)));
    return result;
  }
  if (kind && same_word(last, "in") && expects("sheet")) {
    if (*kind == EntityKind::hex || *kind == EntityKind::node) offer("field");
    for (const char* word : {"box", "sphere", "cylinder"}) offer(word);
  }
  if (same_word(last, "field"))
    for (const Field& field : core_->meshed->mesh.fields) offer("\"" + field.name + "\"");
  const bool behind_number = expected.before.size() > 1 && expected.before.rbegin()[1].kind == Token::Kind::number;
  if (kind && same_word(last, "to") && behind_number) {
    const Selector selector = core_->selector();
    if (const Index n = count(selector, *kind)) offer(std::to_string(id_of(selector, *kind, n - 1)));
  }
  if (!expected.before.empty() && begins_word(expected.before[0].text, "help") && expects("a word"))
    for (const CommandSpec& spec : language())
      if (begins_word(expected.beginning, spec.name) && !spec.syntax.empty()) result.emplace_back(spec.name);
  sort_unique(result);
  return result;
}

}  // namespace hextwist
