// Numbers as the language writes them.
#pragma once

#include <array>
#include <charconv>
#include <string>

namespace hextwist {

/// The shortest text that reads back as the same number.
inline std::string number_text(double value) {
  std::array<char, 32> buffer;
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), end};
}

}  // namespace hextwist
