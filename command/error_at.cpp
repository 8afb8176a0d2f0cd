#include "hextwist/command/error_at.h"

#include <algorithm>

namespace hextwist {
namespace {

/// Bytes of the UTF-8 character at `at`, 0 where there is none that is valid.
std::size_t character_length(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned lead = byte(at);
  if (lead < 0x80) return lead >= 0x20 && lead != 0x7f ? 1 : 0;
  const std::size_t length = lead >= 0xc2 && lead < 0xe0   ? 2
                             : lead >= 0xe0 && lead < 0xf0 ? 3
                             : lead >= 0xf0 && lead < 0xf5 ? 4
                                                           : 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(at + i) & 0xc0) != 0x80) return 0;
  const unsigned second = byte(at + 1);
  const bool overlong = (lead == 0xe0 && second < 0xa0) || (lead == 0xf0 && second < 0x90);
  const bool outside = (lead == 0xed && second > 0x9f) || (lead == 0xf4 && second > 0x8f);
  return overlong || outside ? 0 : length;
}

/// Calls f(piece) for each character; tabs are blanks, what is no character is "?".
template <class F>
void for_each_character(std::string_view text, F f) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = character_length(text, at);
    const bool blank = text[at] == '\t' || text[at] == '\r';
    f(length ? text.substr(at, length) : std::string_view(blank ? " " : "?"));
    at += std::max<std::size_t>(length, 1);
  }
}

int n_characters(std::string_view text) {
  int n = 0;
  for_each_character(text, [&](std::string_view) { ++n; });
  return n;
}

struct Place {
  int line = 1;    // 1-based
  int column = 1;  // 1-based, characters
  std::string_view text;
  std::size_t begin = 0;  // of the line
};

Place place_of(const Statement& statement, std::size_t offset) {
  const std::string_view text = statement.source->text;
  Place place;
  const bool known = statement.line > 0 && statement.begin <= offset;
  const std::size_t from = known ? statement.begin : 0;
  place.line = (known ? statement.line : statement.source->first_line) +
               static_cast<int>(std::ranges::count(text.substr(from, offset - from), '\n'));
  const std::size_t before = offset == 0 ? std::string_view::npos : text.rfind('\n', offset - 1);
  place.begin = before == std::string_view::npos ? 0 : before + 1;
  place.text = text.substr(place.begin, std::min(text.find('\n', offset), text.size()) - place.begin);
  while (place.text.ends_with('\r')) place.text.remove_suffix(1);
  place.column = 1 + n_characters(text.substr(place.begin, offset - place.begin));
  return place;
}

std::string prefix(const Statement& statement, const Place& place, bool with_column) {
  if (statement.source->name.empty()) return "";
  return statement.source->name + ":" + std::to_string(place.line) + ":" +
         (with_column ? std::to_string(place.column) + ": " : " ");
}

/// A window of a line around the word, so that a very long line still shows its caret.
struct Window {
  std::string text;
  int column = 0;
};
Window window_of(const Place& place, std::size_t offset) {
  constexpr std::size_t reach = 100;
  const std::size_t at = offset - place.begin;
  std::size_t begin = at > reach ? at - reach : 0;
  while (begin > 0 && (static_cast<unsigned char>(place.text[begin]) & 0xc0) == 0x80) --begin;
  Window window{begin ? "..." : "", 0};
  window.column = static_cast<int>(window.text.size()) + n_characters(place.text.substr(begin, at - begin));
  window.text += printable(place.text.substr(begin, 8 * reach), 2 * reach);
  return window;
}

}  // namespace

std::string printable(std::string_view text, std::size_t max_bytes) {
  std::string result;
  for_each_character(text, [&](std::string_view piece) {
    if (result.size() <= max_bytes) result += piece;
  });
  if (result.size() <= max_bytes) return result;
  result.resize(max_bytes);
  while (!result.empty() && (static_cast<unsigned char>(result.back()) & 0xc0) == 0x80) result.pop_back();
  if (!result.empty() && static_cast<unsigned char>(result.back()) >= 0x80) result.pop_back();
  return result + "...";
}

CommandError error_at(const Statement& statement, const Token& token, const std::string& message) {
  const Place place = place_of(statement, token.offset);
  const Window window = window_of(place, token.offset);
  const int wide =
      std::max(1, n_characters(std::string_view(statement.source->text).substr(token.offset, token.length)));
  const int room = static_cast<int>(n_characters(window.text)) - window.column;
  std::string whole = prefix(statement, place, true) + message + "\n  " + window.text + "\n  ";
  whole += std::string(window.column, ' ') + "^" + std::string(std::max(0, std::min(wide, room) - 1), '~');
  return {whole, message, place.line, place.column};
}

CommandError error_in(const Statement& statement, const std::string& message) {
  const Place place = place_of(statement, statement.tokens.front().offset);
  return {prefix(statement, place, false) + message, message, place.line, 0};
}

}  // namespace hextwist
