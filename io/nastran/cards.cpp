#include "hextwist/io/nastran/nastran_internal.h"

namespace hextwist::io {
namespace {

/// Tabs go to the next eighth column.
std::string without_tabs(std::string_view text) {
  std::string result;
  for (const char c : text)
    if (c == '\t')
      result.resize(result.size() / 8 * 8 + 8, ' ');
    else
      result += c;
  return result;
}

bool is_continuation(const std::string& name) {
  return name.empty() || name[0] == '+' || name[0] == '*';
}

}  // namespace

NastranCards::Line NastranCards::split(std::string_view text) const {
  Line line;
  const std::string plain = without_tabs(text.substr(0, text.find('$')));
  std::size_t n_fields = 8;
  if (const auto comma = plain.find(','); comma != std::string::npos) {
    line.name = trimmed(plain.substr(0, comma));
    std::string_view rest = std::string_view(plain).substr(comma + 1);
    for (bool more = true; more;) {
      const auto end = rest.find(',');
      line.fields.emplace_back(trimmed(rest.substr(0, end)));
      more = end != std::string_view::npos;
      if (more) rest.remove_prefix(end + 1);
    }
    if (line.name.ends_with('*') || line.name.starts_with('*')) n_fields = 4;
  } else {
    line.name = trimmed(plain.substr(0, 8));
    const bool large = line.name.find('*') != std::string::npos;
    const std::size_t width = large ? 16 : 8;
    n_fields = large ? 4 : 8;
    for (std::size_t i = 0; i < n_fields && 8 + i * width < plain.size(); ++i)
      line.fields.emplace_back(trimmed(std::string_view(plain).substr(8 + i * width, width)));
  }
  // What follows the last data field is the mark of the continuation.
  for (std::size_t i = n_fields; i < line.fields.size(); ++i)
    if (!line.fields[i].empty()) line.behind += (line.behind.empty() ? "" : ",") + line.fields[i];
  line.fields.resize(n_fields);
  line.continues = is_continuation(line.name);
  return line;
}

void NastranCards::finish(const NastranCard& card, const std::string& behind) {
  if (behind.empty() || behind[0] == '+' || behind[0] == '*') return;
  if (overfull_.n++ == 0) overfull_ = {1, card.name, behind, card.at};
}

NastranCard NastranCards::next(const std::function<void(std::string_view, const char*)>& comment) {
  NastranCard card{"", {}, cursor_.at};
  std::string behind;  // the last line of the card
  while (cursor_.at < cursor_.end) {
    const char* at = cursor_.at;
    const std::string_view text = cursor_.line();
    if (!text.empty() && text[0] == '$') comment(text, at);
    if (trimmed(text.substr(0, text.find('$'))).empty()) continue;
    Line line = split(text);
    if (line.continues && !card.name.empty()) {
      card.fields.insert(card.fields.end(), line.fields.begin(), line.fields.end());
      behind = line.behind;
      continue;
    }
    if (line.continues) continue;  // of a card that is not read
    if (!card.name.empty()) {
      cursor_.at = at;
      finish(card, behind);
      return card;
    }
    behind = line.behind;
    card = {line.name, std::move(line.fields), at};
    for (char& c : card.name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    while (card.name.ends_with('*')) card.name.pop_back();
    if (card.name.empty()) card.name = "?";
  }
  finish(card, behind);
  return card;
}

std::string nastran_real(double value, std::size_t width) {
  for (int digits = 17; digits > 0; --digits) {
    std::array<char, 40> text{};
    const auto shortest = std::to_chars(text.begin(), text.end(), value);
    const auto [end, error] =
        digits == 17 ? shortest : std::to_chars(text.begin(), text.end(), value, std::chars_format::general, digits);
    std::string number(text.begin(), end);
    const auto e = number.find('e');
    std::string mantissa = number.substr(0, e), exponent;
    if (e != std::string::npos) {
      // "1.5e-07" is "1.5-7".
      exponent = number.substr(e + 1);
      const auto digit = exponent.find_first_not_of("0", 1);
      exponent = exponent[0] + (digit == std::string::npos ? "0" : exponent.substr(digit));
    }
    if (mantissa.find('.') == std::string::npos) mantissa += '.';
    if (mantissa.size() + exponent.size() <= width) return mantissa + exponent;
  }
  return "0.";
}

}  // namespace hextwist::io
