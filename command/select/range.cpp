#include "hextwist/command/select/range.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "hextwist/command/reader.h"
#include "hextwist/command/written.h"

namespace hextwist {
namespace {

constexpr int max_nesting = 32;

bool is_word(const Token& token, std::string_view word) {
  return token.kind == Token::Kind::word && same_word(token.text, word);
}

/// Accepts a word that changes nothing.
void skip_word(Reader& reader, std::string_view word) {
  if (is_word(reader.peek(), word)) reader.take();
}

std::int64_t read_whole_number(Reader& reader, const char* what, const char* whose, int lowest = 1) {
  if (reader.peek().kind != Token::Kind::number) {
    reader.expect(what);
    reader.fail();
  }
  const Token token = reader.take();
  // Beyond 2^53 a double can't tell neighbours apart; no mesh has such ids.
  if (token.value != std::floor(token.value)) reader.fail(token, std::string(whose) + " are whole numbers");
  if (token.value < lowest) reader.fail(token, std::string(whose) + " start at " + std::to_string(lowest));
  if (token.value > 9e15) reader.fail(token, "this number is out of range");
  return static_cast<std::int64_t>(token.value);
}

/// names: of what has names, of which blocks and sets start at 0.
RangeItem read_ids(Reader& reader, bool names) {
  RangeItem item;
  item.kind = RangeItem::Kind::id;
  item.token = item.last_token = reader.peek();
  item.first = item.last = read_whole_number(reader, "an id", "ids", names ? 0 : 1);
  // `draw hex 3 to "a.png"` is no span.
  const Token& next = reader.ahead();
  const bool file = next.kind == Token::Kind::string ||
                    (next.kind == Token::Kind::word && next.text.find_first_of("./") != std::string::npos);
  if (file || !reader.accept("to")) return item;
  item.kind = RangeItem::Kind::span;
  item.last_token = reader.peek();
  item.last = read_whole_number(reader, "an id", "ids", names ? 0 : 1);
  if (item.last < item.first)
    reader.fail(item.last_token,
                "this range runs backwards: " + std::to_string(item.first) + " to " + std::to_string(item.last));
  if (reader.accept("by") || reader.accept("step", 3)) item.step = read_whole_number(reader, "a step", "steps");
  return item;
}

void close_parenthesis(Reader& reader) {
  if (!reader.at_symbol(")")) {
    reader.expect(")");
    reader.fail();
  }
  reader.take();
}

bool starts_point(const Reader& reader) {
  return reader.at_symbol("(") && (is_word(reader.ahead(), "at") || is_word(reader.ahead(), "within"));
}

double read_number(Reader& reader) {
  if (reader.peek().kind != Token::Kind::number) {
    reader.expect("a number");
    reader.fail();
  }
  return reader.take().value;
}

template <class Numbers>
void read_numbers(Reader& reader, Numbers& numbers) {
  for (double& x : numbers) {
    x = read_number(reader);
    if (reader.at_symbol(",")) reader.take();
  }
}

/// ( at x y z [ordinal n] [ordered] ), ( within r [of] x y z )
RangeItem read_point(Reader& reader) {
  RangeItem item;
  item.token = item.last_token = reader.take();
  item.kind = is_word(reader.take(), "at") ? RangeItem::Kind::at : RangeItem::Kind::within;
  item.first = 1;
  if (item.kind == RangeItem::Kind::within) {
    const Token number = reader.peek();
    item.distance = read_number(reader);
    if (item.distance < 0) reader.fail(number, "a distance can't be negative");
    skip_word(reader, "of");
    read_numbers(reader, item.point);
    close_parenthesis(reader);
    return item;
  }
  read_numbers(reader, item.point);
  if (reader.accept("ordinal")) item.first = read_whole_number(reader, "a whole number", "ordinals");
  skip_word(reader, "ordered");  // says nothing that the ordinal doesn't
  close_parenthesis(reader);
  return item;
}

/// Words that go on with a range rather than being a name.
bool belongs_to_range(const Token& token) {
  for (const auto word : {"in", "with", "all", "to", "by", "expand"})
    if (is_word(token, word)) return true;
  const auto begins = [&](std::string_view word, std::size_t least) {
    return token.kind == Token::Kind::word && token.text.size() >= least && begins_word(token.text, word);
  };
  return begins("except", 3) || begins("common_to", 6) || begins("step", 3);
}

/// Two words that begin a filter; by itself the first may be a name.
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> word_pairs = {
    {{"adjacent", "to"}, {"parallel", "to"}, {"perpendicular", "to"}, {"loop", "of"}, {"chain", "from"}}};

bool starts_filter(const Reader& reader, std::size_t from = 0) {
  const Token& first = from == 0 ? reader.peek() : reader.ahead(from);
  const Token& second = reader.ahead(from + 1);
  if (is_word(first, "largest") || is_word(first, "smallest"))
    return second.kind == Token::Kind::number || is_word(second, "by");
  return std::ranges::any_of(
      word_pairs, [&](const auto& pair) { return is_word(first, pair.first) && is_word(second, pair.second); });
}

bool starts_item(const Reader& reader, bool names, bool first) {
  const Token& token = reader.peek();
  if (token.kind == Token::Kind::number || starts_point(reader)) return true;
  if (first && is_word(token, "all")) return true;
  if (!names || starts_filter(reader)) return false;
  // A name without quotes may stand first only: later it could be meant for an option.
  return token.kind == Token::Kind::string || (token.kind == Token::Kind::word && first && !belongs_to_range(token));
}

std::vector<RangeItem> read_items(Reader& reader, bool names) {
  std::vector<RangeItem> items;
  while (starts_item(reader, names, items.empty())) {
    const Token& token = reader.peek();
    if (token.kind == Token::Kind::number) {
      items.push_back(read_ids(reader, names));
    } else if (starts_point(reader)) {
      items.push_back(read_point(reader));
    } else {
      RangeItem item;
      item.kind = is_word(token, "all") ? RangeItem::Kind::all : RangeItem::Kind::name;
      item.token = item.last_token = reader.take();
      if (item.kind == RangeItem::Kind::name) item.name = item.token.text;
      items.push_back(std::move(item));
    }
    while (reader.at_symbol(",")) {
      reader.take();
      if (!starts_item(reader, names, false)) {
        reader.expect("an id");
        reader.fail();
      }
    }
  }
  return items;
}

void expect_items(Reader& reader, bool names, bool first) {
  reader.expect(first ? "an id" : "another id");
  if (first && names) reader.expect("a name");
  if (first) reader.expect("all");
}

constexpr const char* test_words[] = {"above", "below", "top", "bottom"};

/// "name" {above v | below v | top p [%] | bottom p [%]}
void read_field_test(Reader& reader, RangeFilter& filter) {
  filter.token = reader.take();
  filter.field = filter.token.text;
  using Test = RangeFilter::Test;
  for (std::size_t test = 0;; ++test) {
    if (test == std::size(test_words)) reader.fail();
    filter.test = static_cast<Test>(test);
    if (reader.accept(test_words[test])) break;
  }
  const bool is_part = filter.test == Test::top || filter.test == Test::bottom;
  // "5%" and "%" are words.
  const std::string& text = reader.peek().text;
  double joined = 0;
  const auto [end, bad] = std::from_chars(text.data(), text.data() + text.size(), joined);
  const bool percent = is_part && bad == std::errc() && std::string_view(end) == "%";
  if (reader.peek().kind != Token::Kind::number && !percent) {
    reader.expect("a number");
    reader.fail();
  }
  const Token number = reader.take();
  filter.value = percent ? joined : number.value;
  if (!is_part) return;
  if (!(filter.value > 0 && filter.value <= 100))
    reader.fail(number, "a part of the whole is above 0 and at most 100 %");
  skip_word(reader, "%");
}

constexpr const char* solid_words[] = {"box", "sphere", "cylinder"};

/// {box corner corner | sphere x y z [radius] r | cylinder x y z [to] x y z [radius] r}
void read_solid(Reader& reader, RangeFilter& filter) {
  filter.token = reader.take();
  for (const char* word : solid_words)
    if (is_word(filter.token, word)) filter.field = word;
  const bool sphere = filter.field == "sphere", box = filter.field == "box";
  std::array<double, 3> point{};
  for (int end = 0; end < (sphere ? 1 : 2); ++end) {
    if (end == 1) skip_word(reader, "to");
    read_numbers(reader, point);
    filter.numbers.insert(filter.numbers.end(), point.begin(), point.end());
  }
  if (box) return;
  skip_word(reader, "radius");
  const Token number = reader.peek();
  filter.numbers.push_back(read_number(reader));
  if (!(filter.numbers.back() > 0)) reader.fail(number, "a radius must be positive");
}

/// Where a range stands: that decides what may follow it.
enum class Within { whole, term };

class RangeReader {
 public:
  explicit RangeReader(Reader& reader) : reader_(reader) {}

  Range range(EntityKind kind, Within place, int nesting) {
    const bool names = has_names(kind);
    Range range;
    range.token = reader_.peek();
    if (nesting > max_nesting) reader_.fail(range.token, "this range is nested too deeply");
    range.items = read_items(reader_, names);
    skip_word(reader_, "expand");
    expect_items(reader_, names, range.items.empty());
    const bool bare = range.items.empty();
    while (true) {
      const auto filter = accept_filter(kind, place, bare, range.filters.empty());
      if (!filter) break;
      RangeFilter read;
      read.kind = *filter;
      read.token = last_;
      if (*filter == RangeFilter::Kind::field)
        read_field_test(reader_, read);
      else if (*filter == RangeFilter::Kind::with)
        read.criterion = read_criterion(reader_, kind);
      else if (*filter == RangeFilter::Kind::except)
        read.terms.push_back(exception(kind, place, nesting));
      else if (*filter == RangeFilter::Kind::inside)
        read_solid(reader_, read);
      else if (*filter == RangeFilter::Kind::loop)
        loop(kind, read);
      else if (*filter == RangeFilter::Kind::most)
        most(kind, read);
      else if (!axis(read))
        read.terms = terms(nesting + 1);
      range.filters.push_back(std::move(read));
    }
    if (bare && range.filters.empty()) reader_.fail();
    if (bare && range.filters.front().kind == RangeFilter::Kind::except)
      reader_.fail(range.token, "'except' needs something to take away from, such as 'all'");
    return range;
  }

 private:
  Reader& reader_;
  Token last_;  // of the filter

  /// x, y or z behind `parallel to`.
  bool axis(RangeFilter& filter) {
    if (filter.kind != RangeFilter::Kind::parallel && filter.kind != RangeFilter::Kind::perpendicular) return false;
    for (const char* word : {"x", "y", "z"})
      if (is_word(reader_.peek(), word)) {
        filter.field = word;
        reader_.take();
        return true;
      }
    return false;
  }

  void loop(EntityKind kind, RangeFilter& filter) {
    if (kind != EntityKind::curve) reader_.fail(filter.token, "a loop is of curves: 'curve loop of surface 3'");
    filter.terms.push_back(read_single(reader_));
    if (filter.terms[0].kind != EntityKind::surface)
      reader_.fail(filter.terms[0].range.token, "loops are around surfaces");
    if (!reader_.at_symbol("(") || !is_word(reader_.ahead(), "at")) return;
    const RangeItem at = read_point(reader_);
    filter.numbers.assign(at.point.begin(), at.point.end());
  }

  /// [n] by attribute
  void most(EntityKind kind, RangeFilter& filter) {
    filter.test = is_word(filter.token, "largest") ? RangeFilter::Test::top : RangeFilter::Test::bottom;
    filter.value = 1;
    if (reader_.peek().kind == Token::Kind::number)
      filter.value = static_cast<double>(read_whole_number(reader_, "a whole number", "numbers of entities"));
    if (!reader_.accept("by")) reader_.fail();
    filter.criterion = read_measure(reader_, kind);
  }

  /// A term leaves to the range around it what is not about itself.
  std::optional<RangeFilter::Kind> accept_filter(EntityKind kind, Within place, bool bare, bool first) {
    const bool whole = place == Within::whole;
    if ((whole || first) && (whole || !other_kind_follows(kind)) && reader_.accept("except", 3))
      return RangeFilter::Kind::except;
    // In a term it is about what the whole range is about, which must be said with that.
    if (is_word(reader_.peek(), "in") && is_word(reader_.ahead(), "field") &&
        reader_.ahead(2).kind == Token::Kind::string) {
      if (!whole) return std::nullopt;
      reader_.take();
      reader_.take();
      return RangeFilter::Kind::field;
    }
    last_ = reader_.peek();
    if (is_word(last_, "in"))
      for (const char* word : solid_words)
        if (is_word(reader_.ahead(), word) && reader_.ahead(2).kind == Token::Kind::number) {
          if (!whole && !(bare && first)) return std::nullopt;
          reader_.take();
          return RangeFilter::Kind::inside;
        }
    const bool in_loop = is_word(last_, "in") && is_word(reader_.ahead(), "loop") && is_word(reader_.ahead(2), "of");
    if (in_loop) reader_.take();
    if (starts_filter(reader_)) {
      const Token word = last_ = reader_.take();
      if (is_word(word, "largest") || is_word(word, "smallest")) return RangeFilter::Kind::most;
      reader_.take();
      constexpr std::array kinds = {RangeFilter::Kind::adjacent, RangeFilter::Kind::parallel,
                                    RangeFilter::Kind::perpendicular, RangeFilter::Kind::loop,
                                    RangeFilter::Kind::chain};
      for (std::size_t i = 0; i < kinds.size(); ++i)
        if (is_word(word, word_pairs[i].first)) return kinds[i];
    }
    if (reader_.accept("in")) return RangeFilter::Kind::in;
    if (reader_.accept("common_to", 6)) return RangeFilter::Kind::common_to;
    if ((whole || (bare && first)) && reader_.accept("with")) return RangeFilter::Kind::with;
    return std::nullopt;
  }

  bool other_kind_follows(EntityKind kind) const {
    const std::size_t at = reader_.ahead(1).text == "(" ? 2 : 1;
    for (int k = 0; k < n_entity_kinds; ++k)
      if (is_word(reader_.ahead(at), name(static_cast<EntityKind>(k)))) return static_cast<EntityKind>(k) != kind;
    return false;
  }

  /// What stands behind `except`: ids and names, or the kind again and any range of it.
  RangeTerm exception(EntityKind kind, Within place, int nesting) {
    const bool names = has_names(kind);
    const bool parenthesis = reader_.at_symbol("(") && !starts_point(reader_);
    const Token word = parenthesis ? reader_.ahead() : reader_.peek();
    RangeTerm term{kind, false, {}};
    if (is_word(word, name(kind))) {
      if (parenthesis) reader_.take();
      reader_.take();
      term.range = range(kind, parenthesis ? Within::whole : place, nesting + 1);
      if (parenthesis) close_parenthesis(reader_);
      return term;
    }
    for (int k = 0; k < n_entity_kinds; ++k)
      if (is_word(word, name(static_cast<EntityKind>(k))))
        reader_.fail(word, "only " + std::string(plural(kind)) + " can be taken from a list of " +
                               std::string(plural(kind)) + "; '" + std::string(name(kind)) + " in " + word.text +
                               " ...' names those that lie there");
    term.range.token = reader_.peek();
    term.range.items = read_items(reader_, names);
    skip_word(reader_, "expand");
    if (term.range.items.empty()) {
      reader_.expect("an id");
      if (names) reader_.expect("a name");
      reader_.fail();
    }
    expect_items(reader_, names, false);
    return term;
  }

  /// Something of any kind by its name. A word before an id is no name but a kind that was mistyped.
  bool accept_name(std::vector<RangeTerm>& terms) {
    const Token& token = reader_.peek();
    const bool word = token.kind == Token::Kind::word && !belongs_to_range(token) &&
                      reader_.ahead().kind != Token::Kind::number && !is_word(reader_.ahead(), "all");
    if (!word && token.kind != Token::Kind::string) {
      reader_.expect("a name");
      return false;
    }
    RangeTerm term;
    term.any_kind = true;
    term.range.token = reader_.take();
    RangeItem item;
    item.kind = RangeItem::Kind::name;
    item.name = term.range.token.text;
    item.token = item.last_token = term.range.token;
    term.range.items.push_back(std::move(item));
    terms.push_back(std::move(term));
    skip_word(reader_, "expand");
    return true;
  }

  /// Before another word a shortened one is no kind: `hex in g with id < 9` is about what is called g.
  bool may_be_short() const {
    const Token& next = reader_.ahead();
    return next.kind != Token::Kind::word || is_word(next, "all");
  }

  bool accept_parenthesis(std::vector<RangeTerm>& terms, int nesting) {
    if (!reader_.at_symbol("(")) return false;
    reader_.take();
    bool first = true;
    do {
      const auto kind = accept_kind(reader_, first && may_be_short());
      first = false;
      if (kind)
        terms.push_back({*kind, false, range(*kind, Within::whole, nesting + 1)});
      else if (!accept_name(terms))
        reader_.fail();
    } while (!reader_.at_symbol(")"));
    reader_.take();
    skip_word(reader_, "expand");
    return true;
  }

  std::vector<RangeTerm> terms(int nesting) {
    std::vector<RangeTerm> result;
    // Further kinds must be written out, so that they can't be mistaken for shortened options.
    while (true) {
      if (accept_parenthesis(result, nesting)) continue;
      const auto kind = accept_kind(reader_, result.empty() && may_be_short());
      if (kind)
        result.push_back({*kind, false, range(*kind, Within::term, nesting)});
      else if (!result.empty() || !accept_name(result))
        break;
    }
    if (result.empty()) reader_.fail();
    return result;
  }
};

std::string to_string(const std::vector<RangeItem>& items) {
  std::string result;
  for (const RangeItem& item : items) {
    if (!result.empty()) result += ' ';
    switch (item.kind) {
      case RangeItem::Kind::all:
        result += "all";
        break;
      case RangeItem::Kind::name:
        result += quoted_text(item.name);
        break;
      case RangeItem::Kind::id:
        result += std::to_string(item.first);
        break;
      case RangeItem::Kind::at:
        result += "(at";
        for (const double x : item.point) result += " " + number_text(x);
        result += (item.first > 1 ? " ordinal " + std::to_string(item.first) : "") + ")";
        break;
      case RangeItem::Kind::within:
        result += "(within " + number_text(item.distance) + " of";
        for (const double x : item.point) result += " " + number_text(x);
        result += ")";
        break;
      case RangeItem::Kind::span:
        result += std::to_string(item.first) + " to " + std::to_string(item.last);
        if (item.step != 1) result += " by " + std::to_string(item.step);
    }
  }
  return result;
}

/// Whether a term must stand in parentheses, so that it neither loses its end nor takes what follows. `last`: nothing
/// follows that it could take.
bool needs_parentheses(const RangeTerm& term, bool last) {
  const auto& filters = term.range.filters;
  for (std::size_t i = 0; i < filters.size(); ++i) {
    if (filters[i].kind == RangeFilter::Kind::with && (i > 0 || !term.range.items.empty())) return true;
    if (filters[i].kind == RangeFilter::Kind::except && (i > 0 || !filters[i].terms[0].range.filters.empty()))
      return true;
  }
  return !last && (!filters.empty() || term.any_kind);
}

}  // namespace

std::optional<EntityKind> accept_kind(Reader& reader, bool may_be_short) {
  if (!may_be_short) {
    for (int k = 0; k < n_entity_kinds; ++k)
      if (is_word(reader.peek(), name(static_cast<EntityKind>(k)))) {
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
  return RangeReader(reader).range(kind, Within::whole, 0);
}

RangeTerm read_single(Reader& reader) {
  const auto kind = accept_kind(reader);
  if (!kind) reader.fail();
  RangeTerm term{*kind, false, {}};
  reader.cut_at_sign();
  term.range.token = reader.peek();
  if (reader.peek().kind == Token::Kind::number)
    term.range.items.push_back(read_ids(reader, has_names(*kind)));
  else if (starts_item(reader, has_names(*kind), true) && !is_word(reader.peek(), "all"))
    term.range.items = read_items(reader, has_names(*kind));
  if (term.range.items.size() != 1) {
    reader.expect("an id");
    if (has_names(*kind)) reader.expect("a name");
    term.range.items.empty() ? reader.fail() : reader.fail(term.range.token, "'of' takes a single entity");
  }
  return term;
}

std::string to_string(const RangeTerm& term) {
  if (term.any_kind) return to_string(term.range.items);
  return std::string(name(term.kind)) + " " + to_string(term.range);
}

std::string to_string(const Range& range) {
  std::string result = to_string(range.items);
  for (std::size_t i = 0; i < range.filters.size(); ++i) {
    const RangeFilter& filter = range.filters[i];
    if (!result.empty()) result += ' ';
    if (filter.kind == RangeFilter::Kind::field) {
      result += "in field " + quoted_text(filter.field) + " " + test_words[static_cast<int>(filter.test)] + " " +
                number_text(filter.value);
      if (filter.test == RangeFilter::Test::top || filter.test == RangeFilter::Test::bottom) result += " %";
    } else if (filter.kind == RangeFilter::Kind::with) {
      result += "with " + to_string(filter.criterion);
    } else if (filter.kind == RangeFilter::Kind::except) {
      const Range& list = filter.terms[0].range;
      result += "except " + (list.filters.empty() ? to_string(list.items) : "(" + to_string(filter.terms[0]) + ")");
    } else if (filter.kind == RangeFilter::Kind::inside) {
      result += "in " + filter.field;
      for (std::size_t k = 0; k < filter.numbers.size(); ++k)
        result += (filter.field == "cylinder" && k == 3           ? " to "
                   : k % 3 == 0 && k > 0 && filter.field != "box" ? " radius "
                                                                  : " ") +
                  number_text(filter.numbers[k]);
    } else if (filter.kind == RangeFilter::Kind::most) {
      result += (filter.test == RangeFilter::Test::top ? "largest " : "smallest ") + number_text(filter.value) +
                " by " + to_string(filter.criterion);
    } else if (filter.kind == RangeFilter::Kind::loop) {
      result += "loop of " + to_string(filter.terms[0]);
      if (!filter.numbers.empty()) {
        result += " (at";
        for (const double x : filter.numbers) result += " " + number_text(x);
        result += ")";
      }
    } else if (!filter.field.empty()) {
      result += filter.kind == RangeFilter::Kind::parallel ? "parallel to " : "perpendicular to ";
      result += filter.field;
    } else {
      using Kind = RangeFilter::Kind;
      result += filter.kind == Kind::in              ? "in"
                : filter.kind == Kind::common_to     ? "common_to"
                : filter.kind == Kind::adjacent      ? "adjacent to"
                : filter.kind == Kind::parallel      ? "parallel to"
                : filter.kind == Kind::perpendicular ? "perpendicular to"
                                                     : "chain from";
      bool followed = false;
      for (std::size_t j = i + 1; j < range.filters.size(); ++j)
        followed |= range.filters[j].kind != RangeFilter::Kind::with;
      for (std::size_t t = 0; t < filter.terms.size(); ++t) {
        const RangeTerm& term = filter.terms[t];
        const bool last = t + 1 == filter.terms.size();
        const bool parentheses =
            (t > 0 && term.any_kind) || needs_parentheses(term, last && !followed) || (last && followed);
        result += parentheses ? " (" + to_string(term) + ")" : " " + to_string(term);
      }
    }
  }
  return result;
}

}  // namespace hextwist
