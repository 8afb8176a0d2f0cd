#include "hextwist/command/flow.h"

#include <algorithm>
#include <array>
#include <utility>

#include "hextwist/base/text.h"
#include "hextwist/command/error_at.h"
#include "hextwist/command/expression.h"

namespace hextwist {
namespace {

struct FlowWord {
  std::string_view word;
  Flow kind;
  bool has_argument;
};

constexpr std::array<FlowWord, 20> words = {{{"loop", Flow::loop, true},
                                             {"endloop", Flow::endloop, false},
                                             {"if", Flow::when, true},
                                             {"ifdef", Flow::when_defined, true},
                                             {"ifndef", Flow::when_undefined, true},
                                             {"elseif", Flow::otherwise_when, true},
                                             {"else", Flow::otherwise, false},
                                             {"endif", Flow::endif, false},
                                             {"include", Flow::include, true},
                                             {"cinclude", Flow::include_if_there, true},
                                             {"echo", Flow::ignored, true},
                                             {"noecho", Flow::ignored, false},
                                             {"abortloop", Flow::unknown, false},
                                             {"exitloop", Flow::unknown, false},
                                             {"switch", Flow::unknown, true},
                                             {"case", Flow::unknown, true},
                                             {"default", Flow::unknown, false},
                                             {"endswitch", Flow::unknown, false},
                                             {"import", Flow::unknown, true},
                                             {"verbatim", Flow::unknown, true}}};

bool opens(Flow kind) {
  return kind == Flow::loop || kind == Flow::when || kind == Flow::when_defined || kind == Flow::when_undefined;
}

std::string said(const Statement& statement) {
  return printable(text_of(statement));
}

}  // namespace

FlowLine flow_of(const Statement& statement) {
  if (statement.tokens.empty() || statement.tokens.front().kind != Token::Kind::braces) return {};
  const Token& token = statement.tokens.front();
  const std::string_view inside = std::string_view(statement.source->text).substr(token.offset + 1, token.length - 2);
  const std::size_t begin = std::min(inside.find_first_not_of(" \t"), inside.size());
  const std::size_t end = std::min(inside.find_first_of(" \t(=", begin), inside.size());
  const auto known = std::ranges::find_if(
      words, [&](const FlowWord& each) { return same_word(each.word, inside.substr(begin, end - begin)); });
  if (known == words.end()) return {};
  const std::size_t open = std::min(inside.find_first_not_of(" \t", end), inside.size());
  const std::size_t last = inside.find_last_not_of(" \t");
  const bool argument = open < last && inside[open] == '(' && inside[last] == ')';
  if (!argument && (known->has_argument || open < inside.size())) {
    // {else()} and {else } are the same; {case = 3} is a variable.
    return {};
  }
  if (!argument) return {known->kind, 0, 0};
  return {known->kind, token.offset + 1 + open + 1, last - open - 1};
}

bool is_flow_word(std::string_view word) {
  return std::ranges::any_of(words, [&](const FlowWord& each) { return same_word(each.word, word); });
}

std::vector<std::size_t> flow_ends(std::span<const Statement> statements) {
  std::vector<std::size_t> ends(statements.size(), 0);
  std::vector<std::pair<std::size_t, Flow>> open;  // the last part of each, and what it is
  for (std::size_t i = 0; i < statements.size(); ++i) {
    const Flow kind = flow_of(statements[i]).kind;
    const auto fail = [&](const std::string& message) {
      throw error_at(statements[i], statements[i].tokens.front(), message);
    };
    if (opens(kind)) {
      constexpr std::size_t deepest = 100;
      if (open.size() >= deepest) fail("loops and conditions are nested too deeply");
      open.emplace_back(i, kind);
      continue;
    }
    const bool ends_loop = kind == Flow::endloop;
    if (!ends_loop && kind != Flow::otherwise_when && kind != Flow::otherwise && kind != Flow::endif) continue;
    if (open.empty() || (open.back().second == Flow::loop) != ends_loop)
      fail(open.empty() ? (ends_loop ? "no {loop(...)} is open here" : "no {if(...)} or {ifdef(...)} is open here")
                        : "this comes before the end of '" + said(statements[open.back().first]) + "'");
    if (open.back().second == Flow::otherwise && kind != Flow::endif) fail("after {else} only {endif} can follow");
    ends[open.back().first] = i;
    if (ends_loop || kind == Flow::endif)
      open.pop_back();
    else
      open.back() = {i, kind};
  }
  if (!open.empty()) {
    const auto& [at, kind] = open.back();
    throw error_at(statements[at], statements[at].tokens.front(),
                   kind == Flow::loop ? "this loop has no end: {endloop} is missing"
                                      : "this condition has no end: {endif} is missing");
  }
  return ends;
}

bool wants_more(std::string_view text) {
  std::size_t end = text.size();
  while (end > 0 && (text[end - 1] == ' ' || text[end - 1] == '\t' || text[end - 1] == '\r' || text[end - 1] == '\n'))
    --end;
  if (end > 0 && text[end - 1] == '\\') {
    const std::size_t line = text.rfind('\n', end - 1) + 1;
    return text.substr(line, end - line).find('#') == std::string_view::npos;
  }
  if (text.find('{') == std::string_view::npos) return false;
  int depth = 0;
  for (const Statement& statement : split_statements(text)) {
    const Flow kind = flow_of(statement).kind;
    depth += opens(kind) ? 1 : kind == Flow::endloop || kind == Flow::endif ? -1 : 0;
  }
  return depth > 0;
}

}  // namespace hextwist
