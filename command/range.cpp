#include "hextwist/command/range.h"

#include <array>
#include <cmath>

#include "hextwist/command/reader.h"

namespace hextwist {
namespace {

// Words that may follow the ids of a range in a later version of the language; today they get an error of their own.
constexpr std::array<std::string_view, 5> planned = {"common_to", "with", "expand", "include", "at"};
constexpr int max_nesting = 32;

bool is_symbol(const Token& token, std::string_view symbol) {
  return token.kind == Token::Kind::symbol && token.text == symbol;
}

std::int64_t read_whole_number(Reader& reader, const char* what, const char* whose) {
  if (reader.peek().kind != Token::Kind::number) {
    reader.expect(what);
    reader.fail();
  }
  const Token token = reader.take();
  // Beyond 2^53 a double can't tell neighbours apart; no mesh has such ids.
  if (token.value != std::floor(token.value)) reader.fail(token, std::string(whose) + " are whole numbers");
  if (token.value < 1) reader.fail(token, std::string(whose) + " start at 1");
  if (token.value > 9e15) reader.fail(token, "this number is out of range");
  return static_cast<std::int64_t>(token.value);
}

RangeItem read_ids(Reader& reader) {
  RangeItem item;
  item.kind = RangeItem::Kind::id;
  item.token = item.last_token = reader.peek();
  item.first = item.last = read_whole_number(reader, "an id", "ids");
  if (!reader.accept("to")) return item;
  item.kind = RangeItem::Kind::span;
  item.last_token = reader.peek();
  item.last = read_whole_number(reader, "an id", "ids");
  if (item.last < item.first)
    reader.fail(item.last_token,
                "this range runs backwards: " + std::to_string(item.first) + " to " + std::to_string(item.last));
  if (reader.accept("by") || reader.accept("step", 3)) item.step = read_whole_number(reader, "a step", "steps");
  return item;
}

bool starts_item(const Token& token, bool names, bool first) {
  if (token.kind == Token::Kind::number) return true;
  if (token.kind == Token::Kind::word && first && same_word(token.text, "all")) return true;
  if (!names) return false;
  // A name without quotes may stand first only: later it could be meant for an option.
  return token.kind == Token::Kind::string ||
         (token.kind == Token::Kind::word && first && !same_word(token.text, "except") && !same_word(token.text, "in"));
}

std::vector<RangeItem> read_items(Reader& reader, bool names) {
  std::vector<RangeItem> items;
  while (starts_item(reader.peek(), names, items.empty())) {
    const Token& token = reader.peek();
    if (token.kind == Token::Kind::number) {
      items.push_back(read_ids(reader));
    } else {
      RangeItem item;
      item.kind = token.kind == Token::Kind::word && same_word(token.text, "all") ? RangeItem::Kind::all
                                                                                  : RangeItem::Kind::name;
      item.token = item.last_token = reader.take();
      if (item.kind == RangeItem::Kind::name) item.name = item.token.text;
      items.push_back(std::move(item));
    }
    while (is_symbol(reader.peek(), ",")) {
      reader.take();
      if (!starts_item(reader.peek(), names, false)) {
        reader.expect("an id");
        reader.fail();
      }
    }
  }
  return items;
}

void refuse_planned(const Reader& reader) {
  Token token = reader.peek();
  if (is_symbol(token, "{")) reader.fail(token, "expressions in braces are not supported yet");
  if (is_symbol(token, "(")) reader.fail(token, "'(at x y z)' is not supported yet");
  if (token.kind == Token::Kind::word)
    for (const auto word : planned)
      if (same_word(token.text, word)) reader.fail(token, "'" + std::string(word) + "' is not supported yet");
}

void expect_items(Reader& reader, bool names, bool first) {
  reader.expect(first ? "an id" : "another id");
  if (first && names) reader.expect("a name");
  if (first) reader.expect("all");
}

Range read_range(Reader& reader, EntityKind kind, int nesting) {
  const bool names = has_names(kind);
  Range range;
  range.token = reader.peek();
  if (nesting > max_nesting) reader.fail(range.token, "this range is nested too deeply");
  refuse_planned(reader);
  range.items = read_items(reader, names);
  expect_items(reader, names, range.items.empty());
  refuse_planned(reader);
  if (reader.accept("except", 3)) {
    range.except = read_items(reader, names);
    if (range.except.empty()) {
      reader.expect("an id");
      reader.fail();
    }
    expect_items(reader, names, false);
  }
  refuse_planned(reader);
  if (reader.accept("in")) {
    // Further kinds must be written out, so that they can't be mistaken for shortened options.
    while (const auto inner = accept_kind(reader, range.in.empty()))
      range.in.push_back({*inner, read_range(reader, *inner, nesting + 1)});
    if (range.in.empty()) reader.fail();
  }
  if (range.items.empty() && range.in.empty()) {
    if (range.except.empty()) reader.fail();
    reader.fail(range.token, "'except' needs something to take away from, such as 'all'");
  }
  return range;
}

std::string to_string(const std::vector<RangeItem>& items) {
  std::string result;
  for (const RangeItem& item : items) {
    if (!result.empty()) result += ' ';
    switch (item.kind) {
      case RangeItem::Kind::all:
        result += "all";
        break;
      case RangeItem::Kind::name: {
        const char quote = item.name.find('"') == std::string::npos ? '"' : '\'';
        result += quote + item.name + quote;
        break;
      }
      case RangeItem::Kind::id:
        result += std::to_string(item.first);
        break;
      case RangeItem::Kind::span:
        result += std::to_string(item.first) + " to " + std::to_string(item.last);
        if (item.step != 1) result += " by " + std::to_string(item.step);
    }
  }
  return result;
}

}  // namespace

std::optional<EntityKind> accept_kind(Reader& reader, bool may_be_short) {
  if (!may_be_short) {
    for (int k = 0; k < n_entity_kinds; ++k)
      if (reader.peek().kind == Token::Kind::word && same_word(reader.peek().text, name(static_cast<EntityKind>(k)))) {
        reader.take();
        return static_cast<EntityKind>(k);
      }
    return std::nullopt;
  }
  std::array<Keyword, n_entity_kinds> words;
  for (int k = 0; k < n_entity_kinds; ++k) words[k].word = name(static_cast<EntityKind>(k));
  const auto found = reader.match(words);
  if (!found) return std::nullopt;
  reader.take();
  return static_cast<EntityKind>(*found);
}

Range read_range(Reader& reader, EntityKind kind) {
  return read_range(reader, kind, 0);
}

std::string to_string(const Range& range) {
  std::string result = to_string(range.items);
  if (!range.except.empty()) result += " except " + to_string(range.except);
  if (!range.in.empty()) {
    result += result.empty() ? "in" : " in";
    for (const RangeTerm& term : range.in) result += " " + std::string(name(term.kind)) + " " + to_string(term.range);
  }
  return result;
}

}  // namespace hextwist
