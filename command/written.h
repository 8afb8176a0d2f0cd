// Values as the language writes them.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <string>

namespace hextwist {

/// The shortest text that reads back as the same number.
inline std::string number_text(double value) {
  std::array<char, 32> buffer;
  constexpr double most = 1e15;  // whole numbers are written as such: ids can't have an exponent
  const bool is_whole = std::abs(value) < most && value == std::trunc(value);
  const auto [end, error] =
      is_whole ? std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed)
               : std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), end};
}

/// Text in quotes that reads back as the same text. It must not have both kinds of quotes.
inline std::string quoted_text(const std::string& text) {
  const char quote = text.find('"') == std::string::npos ? '"' : '\'';
  std::string result(1, quote);
  for (const char c : text) {
    if (c == '{') result += '\\';
    result += c;
  }
  return result + quote;
}

}  // namespace hextwist
