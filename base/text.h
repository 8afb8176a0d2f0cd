// Words and numbers as users read them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "hextwist/base/types.h"

namespace hextwist {

/// ASCII letters only; other characters stay.
constexpr char lower_case(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
}
std::string lower_case(std::string_view text);
/// The same but for case.
bool same_word(std::string_view a, std::string_view b);
/// ".vtu" for "Part.VTU"; empty where there is none.
std::string lower_extension(const std::filesystem::path& file);

/// At most so many significant digits.
std::string short_number(double value, int digits = 4);
/// "(1.5, 0, -2)"
std::string point_text(const Vec3& point, int digits = 4);

/// "1 node", "3 hexes". many: empty for the regular plural of `one`.
std::string counted(std::int64_t n, std::string_view one, std::string_view many = {});

/// Text within HTML and SVG: < > and & as they are written there.
std::string markup_text(std::string_view text);

/// What the system says of an error number (errno).
std::string error_text(int number);

/// Items with something between them; each a number or a text.
template <class Items>
std::string joined(const Items& items, std::string_view between = " ") {
  std::string text;
  bool first = true;
  for (const auto& item : items) {
    if (!first) text += between;
    first = false;
    if constexpr (requires { std::to_string(item); })
      text += std::to_string(item);
    else
      text += item;
  }
  return text;
}

}  // namespace hextwist
