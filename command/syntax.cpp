#include "hextwist/command/syntax.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <map>

#include "hextwist/command/pattern_internal.h"
#include "hextwist/command/reader.h"
#include "hextwist/command/written.h"

namespace hextwist {
namespace {

const Pattern& pattern_of(const CommandSpec& spec) {
  static const std::map<std::string_view, Pattern> patterns = [] {
    std::map<std::string_view, Pattern> result;
    for (const CommandSpec& each : language()) result.emplace(each.name, compile_pattern(each.syntax));
    return result;
  }();
  return patterns.at(spec.name);
}

std::string bounds_text(const ArgumentSpec& argument, double said) {
  const bool low = std::isfinite(argument.min), high = argument.max < 1e100 || said > argument.max;
  const std::string least = number_text(argument.min), most = number_text(argument.max);
  if (low && high) return argument.open ? " above " + least + ", at most " + most : " from " + least + " to " + most;
  if (low) return (argument.open ? " above " : " of at least ") + least;
  return high ? " of at most " + most : "";
}

class Matcher {
 public:
  Matcher(Reader& reader, const CommandSpec& spec, Command& out) : reader_(reader), spec_(spec), out_(out) {}

  void sequence(const Pattern& pattern) {
    for (const PatternNode& node : pattern) one(node);
  }

 private:
  Reader& reader_;
  const CommandSpec& spec_;
  Command& out_;
  std::vector<Keyword> outer_;  // options that may follow: a name that is left out must not swallow them

  const ArgumentSpec& argument(const std::string& name) const {
    const auto found = std::ranges::find(spec_.arguments, name, &ArgumentSpec::name);
    assert(found != spec_.arguments.end());
    return *found;
  }

  /// Words that a sequence can begin with.
  static void first_words(const Pattern& pattern, std::size_t choice, std::vector<Keyword>& words,
                          std::vector<std::size_t>& choices) {
    assert(!pattern.empty());
    const PatternNode& first = pattern.front();
    if (first.kind == PatternNode::Kind::word) {
      words.push_back({first.name, !first.planned && !first.hidden, !first.hidden});
      choices.push_back(choice);
    } else {
      for (const Pattern& inner : first.choices) first_words(inner, choice, words, choices);
    }
  }

  /// The choice that the current token begins, by word, else by argument. Options around it, the first so many of
  /// `outer_`, could be meant as well: cut short, a word must tell them apart.
  std::optional<std::size_t> choose(const PatternNode& node, const std::vector<bool>& said = {},
                                    std::size_t n_outer = 0) {
    std::vector<Keyword> words;
    std::vector<std::size_t> of_word;
    for (std::size_t i = 0; i < node.choices.size(); ++i) first_words(node.choices[i], i, words, of_word);
    for (std::size_t w = 0; w < words.size() && !said.empty(); ++w) words[w].shown &= !said[of_word[w]];
    // Written out, such a word would be one more kind: so it is none when cut short either.
    if (behind_open_range())
      for (Keyword& word : words) word.may_be_short &= !entity_kind(word.word);
    const std::size_t n_words = words.size();
    for (std::size_t i = 0; i < n_outer; ++i) {
      words.push_back(outer_[i]);
      words.back().shown = false;  // they are told where they are looked for
    }
    if (const auto found = reader_.match(words)) {
      if (*found >= n_words) return std::nullopt;
      return of_word[*found];
    }
    for (std::size_t i = 0; i < node.choices.size(); ++i) {
      const PatternNode& first = node.choices[i].front();
      if (first.kind == PatternNode::Kind::argument && could_be(argument(first.name))) return i;
    }
    return std::nullopt;
  }

  bool could_be(const ArgumentSpec& spec) {
    const Token& token = reader_.peek();
    using Kind = ArgumentSpec::Kind;
    switch (spec.kind) {
      case Kind::range:
        return token.kind == Token::Kind::number || token.kind == Token::Kind::string || reader_.at_symbol("(");
      case Kind::integer:
      case Kind::number:
        if (token.kind == Token::Kind::number) return true;
        reader_.expect(spec.kind == Kind::integer ? "a whole number" : "a number");
        return false;
      case Kind::string:
        if (token.kind == Token::Kind::string) return true;
        reader_.expect("a text in quotes");
        return false;
      case Kind::file:
        // A plain path needs no quotes, but a single word might be an option in the wrong place.
        if (token.kind == Token::Kind::string) return true;
        if (token.kind == Token::Kind::word && token.text.find_first_of("./") != std::string::npos) return true;
        reader_.expect("a file name in quotes");
        return false;
      case Kind::word:
        if (token.kind == Token::Kind::word &&
            std::ranges::none_of(outer_, [&](const Keyword& option) { return begins_word(token.text, option.word); }))
          return true;
        reader_.expect("a word");
        return false;
    }
    return false;
  }

  void one(const PatternNode& node) {
    switch (node.kind) {
      case PatternNode::Kind::word:
        return word(node);
      case PatternNode::Kind::argument:
        return value(argument(node.name));
      case PatternNode::Kind::one_of: {
        const auto choice = choose(node);
        if (!choice) reader_.fail();
        return sequence(node.choices[*choice]);
      }
      case PatternNode::Kind::options:
        return options(node);
      case PatternNode::Kind::repeated: {
        const Pattern& once = node.choices.front();
        const bool has_word = once.front().kind == PatternNode::Kind::word;  // which need not be said again
        do {
          sequence(once);
          while (has_word && could_be(argument(once.back().name))) value(argument(once.back().name));
        } while (goes_on(once));
      }
    }
  }

  /// Right behind a range that ends with `in` or `common_to`, which kinds of entities go on.
  bool behind_open_range() const {
    if (out_.items.empty() || out_.items.back().is_word) return false;
    const auto& filters = out_.items.back().range.filters;
    return !filters.empty() &&
           (filters.back().kind == RangeFilter::Kind::in || filters.back().kind == RangeFilter::Kind::common_to);
  }

  /// Whether one more kind follows a range. It may be cut to three letters, fewer could be meant for an option; behind
  /// `in` all that are written out have been read, and others would be printed as if they belonged there too.
  bool goes_on(const Pattern& once) {
    std::vector<Keyword> words;
    std::vector<std::size_t> ignored;
    first_words(once, 0, words, ignored);
    const bool open = behind_open_range();
    for (Keyword& word : words) word.may_be_short = !open && reader_.peek().text.size() >= 3;
    return reader_.match(words).has_value();
  }

  void word(const PatternNode& node) {
    const Keyword keyword{node.name, !node.planned && !node.hidden, !node.hidden};
    if (!reader_.match({&keyword, 1})) reader_.fail();
    Item item;
    item.is_word = true;
    item.name = node.name;
    item.token = reader_.take();
    if (node.planned) reader_.fail(item.token, "'" + node.name + "' is not supported yet");
    out_.items.push_back(std::move(item));
  }

  void options(const PatternNode& node) {
    std::vector<bool> said(node.choices.size());
    const std::size_t n_outer = outer_.size();
    std::vector<std::size_t> ignored;
    for (std::size_t i = 0; i < node.choices.size(); ++i) first_words(node.choices[i], i, outer_, ignored);
    while (true) {
      const auto choice = choose(node, said, n_outer);
      if (!choice) break;
      const PatternNode& front = node.choices[*choice].front();
      if (said[*choice] && !front.hidden) reader_.fail(reader_.peek(), "this option was given already");
      said[*choice] = true;
      const std::size_t begin = out_.items.size();
      sequence(node.choices[*choice]);
      const PatternNode* first = &front;
      while (!first->choices.empty()) first = &first->choices.front().front();
      for (std::size_t i = begin; i < out_.items.size(); ++i) out_.items[i].option = first->name;
    }
    outer_.resize(n_outer);
  }

  void value(const ArgumentSpec& spec) {
    Item item;
    item.name = spec.name;
    item.token = reader_.peek();
    if (spec.kind == ArgumentSpec::Kind::range) {
      item.kind = kind_before();
      item.range = read_range(reader_, item.kind);
    } else {
      if (!could_be(spec)) reader_.fail();
      reader_.take();
      item.text = item.token.text;
      item.number = item.token.value;
      check(spec, item);
    }
    out_.items.push_back(std::move(item));
  }

  void check(const ArgumentSpec& spec, const Item& item) const {
    const bool integer = spec.kind == ArgumentSpec::Kind::integer;
    if (spec.kind == ArgumentSpec::Kind::file && item.text.empty()) reader_.fail(item.token, "this file name is empty");
    if (!integer && spec.kind != ArgumentSpec::Kind::number) return;
    const bool low = spec.open ? item.number > spec.min : item.number >= spec.min;
    if (low && item.number <= spec.max && !(integer && item.number != std::floor(item.number))) return;
    const auto option =
        std::find_if(out_.items.rbegin(), out_.items.rend(), [](const Item& said) { return said.is_word; });
    reader_.fail(item.token,
                 option->name + " must be a " + (integer ? "whole " : "") + "number" + bounds_text(spec, item.number));
  }

  /// The kind of entity named last.
  EntityKind kind_before() const {
    for (auto item = out_.items.rbegin(); item != out_.items.rend(); ++item)
      if (const auto kind = entity_kind(item->name); item->is_word && kind) return *kind;
    assert(false && "a <range> without a kind before it");
    return EntityKind::hex;
  }
};

const CommandSpec& command_named(Reader& reader) {
  std::vector<Keyword> names;
  for (const CommandSpec& spec : language()) names.push_back({spec.name, !spec.syntax.empty(), spec.may_be_short});
  const auto found = reader.match(names);
  if (!found) {
    if (reader.peek().kind == Token::Kind::braces) reader.fail();
    const std::vector<std::string> nearest = nearest_words(reader.peek().text, reader.expected(), 3);
    reader.fail(reader.peek(), "there is no command '" + printable(reader.peek().text) + "'" +
                                   (nearest.empty() ? "" : ": did you mean " + alternatives(nearest) + "?") +
                                   (nearest.empty() ? "; 'help' lists them" : " 'help' lists all"));
  }
  return language()[*found];
}

Command parse(Reader& reader) {
  const CommandSpec& spec = command_named(reader);
  if (spec.syntax.empty()) reader.fail(reader.peek(), "'" + std::string(spec.name) + "' is not supported yet");
  Command command{&spec, reader.statement(), {}};
  Matcher(reader, spec, command).sequence(pattern_of(spec));
  if (!reader.at_end()) {
    reader.expect("the end of the command");
    reader.fail();
  }
  return command;
}

}  // namespace

bool Command::has(std::string_view word) const {
  return std::ranges::any_of(items, [&](const Item& item) { return item.is_word && item.name == word; });
}

const Item* Command::find(std::string_view argument) const {
  const auto found =
      std::ranges::find_if(items, [&](const Item& item) { return !item.is_word && item.name == argument; });
  return found == items.end() ? nullptr : &*found;
}

std::vector<const Item*> Command::find_all(std::string_view argument) const {
  std::vector<const Item*> result;
  for (const Item& item : items)
    if (!item.is_word && item.name == argument) result.push_back(&item);
  return result;
}

Command parse(const Statement& statement) {
  Reader reader(statement);
  return parse(reader);
}

std::string to_string(const Command& command) {
  std::string result;
  for (const Item& item : command.items) {
    if (!result.empty()) result += ' ';
    const auto argument = std::ranges::find(command.spec->arguments, item.name, &ArgumentSpec::name);
    if (item.is_word || argument == command.spec->arguments.end()) {
      result += item.name;
      continue;
    }
    switch (argument->kind) {
      case ArgumentSpec::Kind::range:
        result += to_string(item.range);
        break;
      case ArgumentSpec::Kind::integer:
      case ArgumentSpec::Kind::number:
        result += number_text(item.number);
        break;
      case ArgumentSpec::Kind::word:
        result += item.text;
        break;
      case ArgumentSpec::Kind::string:
      case ArgumentSpec::Kind::file:
        result += quoted_text(item.text);
    }
  }
  return result;
}

Expected expected_at_end(std::string_view line) {
  std::vector<Statement> statements = split_statements(line);
  const bool fresh = line.empty() || std::string_view(" \t;\n").find(line.back()) != std::string_view::npos;
  const bool separated = line.find_last_not_of(" \t") == std::string_view::npos ||
                         std::string_view(";\n").find(line[line.find_last_not_of(" \t")]) != std::string_view::npos;
  Expected result;
  Statement statement{std::make_shared<const Source>(), {Token{}}};
  if (!separated && !statements.empty()) {
    statement = std::move(statements.back());
    if (!fresh) {
      result.beginning = statement.tokens[statement.tokens.size() - 2].text;
      statement.tokens.erase(statement.tokens.end() - 2);
    }
  }
  for (Token& token : statement.tokens)  // its value is not known yet; most are numbers
    if (token.kind == Token::Kind::braces) token = {Token::Kind::number, "1", 1, token.offset, token.length};
  Reader reader(statement);
  result.before.assign(statement.tokens.begin(), statement.tokens.end() - 1);
  try {
    parse(reader);
  } catch (const CommandError&) {
    // Wrong before its end: nothing to offer. Wrong at its end: that is where the word goes.
    if (!reader.stopped_at_end()) return result;
  }
  result.what = reader.expected();
  return result;
}

namespace {

/// Options that a command refuses together: with the first the second is not offered any more.
constexpr std::array<std::pair<std::string_view, std::string_view>, 9> exclusive = {{{"size", "numsplit"},
                                                                                     {"sizing_function", "numsplit"},
                                                                                     {"numsplit", "size"},
                                                                                     {"numsplit", "bias"},
                                                                                     {"numsplit", "sizing_function"},
                                                                                     {"depth", "radius"},
                                                                                     {"radius", "depth"},
                                                                                     {"direction", "size"},
                                                                                     {"direction", "method"}}};

bool is_excluded(std::string_view word, const std::vector<Token>& before) {
  return std::ranges::any_of(exclusive, [&](const auto& pair) {
    return word == pair.second &&
           std::ranges::any_of(before, [&](const Token& token) { return same_word(token.text, pair.first); });
  });
}

}  // namespace

std::vector<std::string> completions(std::string_view line) {
  const Expected expected = expected_at_end(line);
  std::vector<std::string> result;
  for (const std::string& word : expected.what)
    if (!is_excluded(word, expected.before) && word.find(' ') == std::string::npos &&
        begins_word(expected.beginning, word))
      result.push_back(word);
  std::ranges::sort(result);
  return result;
}

std::string shown_syntax(const CommandSpec& command) {
  return to_string(pattern_of(command));
}

}  // namespace hextwist
