#include <limits>

#include "hextwist/io/lsdyna/lsdyna_internal.h"

namespace hextwist::io {

std::size_t DynaCard::filled() const {
  std::size_t last = n;
  while (last > 0 && fields[last - 1].empty()) --last;
  return last;
}

bool DynaCard::any(std::size_t first, std::size_t last) const {
  for (std::size_t i = first; i <= last && i < n; ++i) {
    double value = 0;
    if (!real_in_field(fields[i], value) || value != 0) return true;
  }
  return false;
}

const std::string& DynaCards::next_keyword() {
  keyword_.clear();
  while (cursor_.at < cursor_.end) {
    const char* at = cursor_.at;
    std::string_view line = cursor_.line();
    if (!line.starts_with('*')) continue;  // cards of a keyword that is not read
    keyword_at_ = at;
    line = trimmed(line.substr(1));
    std::string_view name = line.substr(0, line.find_first_of(" ,\t"));
    const std::string options = lower_case(line.substr(name.size()));
    for (const char c : name) keyword_ += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    // "*NODE+", "*NODE %": how wide the fields of its cards are.
    std::string marks = options;
    while (!keyword_.empty() && std::string_view("+-%").find(keyword_.back()) != std::string_view::npos) {
      marks += keyword_.back();
      keyword_.pop_back();
    }
    if (keyword_.empty()) cursor_.fail_at(at, "a '*' without a keyword");
    if (keyword_ == "KEYWORD" || keyword_.starts_with("KEYWORD_")) {
      all_long_ = options.find("long=y") != std::string::npos || options.find("long=k") != std::string::npos;
      all_ten_ = options.find("i10=y") != std::string::npos;
    }
    long_ = (all_long_ || marks.find('+') != std::string::npos) && marks.find('-') == std::string::npos;
    ten_ = all_ten_ || marks.find('%') != std::string::npos;
    return keyword_;
  }
  return keyword_;
}

bool DynaCards::next_line(std::string_view& line, const char*& at) {
  while (cursor_.at < cursor_.end && *cursor_.at != '*') {
    at = cursor_.at;
    line = cursor_.line();
    if (!line.starts_with('$')) return true;
  }
  return false;
}

bool DynaCards::next(DynaCard& card, const DynaWidths& widths) {
  std::string_view line;
  do
    if (!next_line(line, card.at)) return false;
  while (trimmed(line).empty());
  card.text = line;
  card.n = 0;
  if (line.find(',') != std::string_view::npos) {
    for (;;) {
      const auto comma = line.find(',');
      if (card.n == DynaCard::most) cursor_.fail_at(card.at, "a card of more than 24 fields");
      card.fields[card.n++] = trimmed(line.substr(0, comma));
      if (comma == std::string_view::npos) return true;
      line.remove_prefix(comma + 1);
    }
  }
  std::size_t width = long_ ? 20 : ten_ ? std::max<std::size_t>(10, widths.first) : widths.first;
  while (card.n < widths.n && !line.empty()) {
    card.fields[card.n++] = trimmed(line.substr(0, width));
    line.remove_prefix(std::min(width, line.size()));
    const std::size_t usual = card.n + widths.n_last < widths.n ? widths.others : widths.first;
    width = long_ ? 20 : ten_ ? std::max<std::size_t>(10, usual) : usual;
  }
  return true;
}

bool DynaCards::next_title(std::string& title) {
  std::string_view line;
  const char* at = nullptr;
  if (!next_line(line, at)) return false;
  title = std::string(trimmed(line));
  return true;
}

std::int64_t DynaCards::integer(const DynaCard& card, std::size_t field, const char* what) const {
  std::int64_t value = 0;
  if (!integer_in_field(card[field], value))
    cursor_.fail_at(card.at, "*" + keyword_ + " has " + shown(card[field]) + " where " + what + " should stand");
  return value;
}

int DynaCards::id(const DynaCard& card, std::size_t field, const char* what) const {
  const std::int64_t value = integer(card, field, what);
  if (value < 0 || value > std::numeric_limits<int>::max())
    cursor_.fail_at(card.at, std::string(what) + " " + std::to_string(value) + " is not between 0 and 2147483647");
  return static_cast<int>(value);
}

double DynaCards::real(const DynaCard& card, std::size_t field) const {
  double value = 0;
  if (!real_in_field(card[field], value))
    cursor_.fail_at(card.at, "*" + keyword_ + " has " + shown(card[field]) + " where a coordinate should stand");
  return value;
}

}  // namespace hextwist::io
