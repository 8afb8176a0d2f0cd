#include "hextwist/base/text.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <system_error>

namespace hextwist {

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = lower_case(c);
  return result;
}

bool same_word(std::string_view a, std::string_view b) {
  return std::ranges::equal(
      a, b, {}, [](char c) { return lower_case(c); }, [](char c) { return lower_case(c); });
}

std::string lower_extension(const std::filesystem::path& file) {
  return lower_case(file.extension().string());
}

std::string short_number(double value, int digits) {
  std::array<char, 48> text;
  std::snprintf(text.data(), text.size(), "%.*g", digits, value);
  return text.data();
}

std::string markup_text(std::string_view text) {
  std::string result;
  for (const char c : text) result += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  return result;
}

std::string error_text(int number) {
  return std::generic_category().message(number);
}

std::string point_text(const Vec3& p, int digits) {
  return "(" + short_number(p.x(), digits) + ", " + short_number(p.y(), digits) + ", " + short_number(p.z(), digits) +
         ")";
}

std::string counted(std::int64_t n, std::string_view one, std::string_view many) {
  std::string text = std::to_string(n) + " ";
  if (n != 1 && !many.empty()) return text.append(many);
  text += one;
  return n == 1 ? text : text + (one.ends_with('x') || one.ends_with('s') ? "es" : "s");
}

}  // namespace hextwist
