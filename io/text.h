// A place in a file that is being read: words, lines and numbers in text, raw values in binary parts. Every error
// names the file and the line (or the byte, in binary files).
#pragma once

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>

#include "hextwist/base/text.h"
#include "hextwist/io/file.h"

namespace hextwist::io {

template <class T>
T with_bytes_reversed(const T& value) {
  auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  std::ranges::reverse(bytes);
  return std::bit_cast<T>(bytes);
}

class Cursor {
 public:
  /// Behind the mark of UTF-8 (EF BB BF) that some editors put at the beginning of a file.
  explicit Cursor(const Bytes& bytes) : Cursor({bytes.data.get(), bytes.size}, bytes.name) {
    if (std::string_view(at, left()).starts_with("\xEF\xBB\xBF")) at += 3;
  }
  /// Part of a file, or what was decoded from one. `file` must live on.
  Cursor(std::string_view text, std::string_view file)
      : at(text.data()), begin(at), end(at + text.size()), name(file) {}

  const char* at;
  const char* begin;
  const char* end;
  std::string_view name;  ///< of the file
  bool binary = false;    ///< errors name the byte instead of the line
  bool swapped = false;   ///< binary values have the other byte order

  /// Blanks: everything up to and including the space character. Comma ends a number, too.
  static bool blank(char c) { return static_cast<unsigned char>(c) <= ' '; }
  void skip_blanks() {
    while (at < end && blank(*at)) ++at;
  }
  void skip_text_blanks() {
    if (!binary) skip_blanks();
  }
  /// Something other than blanks is left.
  bool more() {
    skip_blanks();
    return at < end;
  }
  /// Whether a line follows, be it empty, before a blank rest of the file.
  bool more_lines() {
    const char* const here = at;
    if (!more()) return false;
    at = here;
    return true;
  }
  std::size_t left() const { return static_cast<std::size_t>(end - at); }

  /// Next run of non-blanks, empty at the end.
  std::string_view word();
  /// Rest of this line without its end; continues at the next line.
  std::string_view line();

  /// Numbers, after blanks. `what` names them in messages. Throw at anything else.
  std::int64_t integer(std::string_view what) {
    skip_blanks();
    std::int64_t value = 0;
    const auto [stop, error] = std::from_chars(at, end, value);
    if (error != std::errc{} || !ends_number(stop)) return odd_integer(what);
    at = stop;
    return value;
  }
  /// Within the range of int.
  int small(std::string_view what);
  double real(std::string_view what) {
    skip_blanks();
    double value = 0;
    const auto [stop, error] = std::from_chars(at, end, value);
    if (error != std::errc{} || !ends_number(stop)) return odd_real(what);
    at = stop;
    return value;
  }
  /// One value of a binary part.
  template <class T>
  T raw(std::string_view what) {
    if (left() < sizeof(T)) fail_truncated(what);
    T value;
    std::memcpy(&value, at, sizeof(T));
    at += sizeof(T);
    return swapped ? with_bytes_reversed(value) : value;
  }

  /// The same for as many as there is room for.
  template <class T>
  void raw_all(std::span<T> to, std::string_view what) {
    if (to.size_bytes() > left()) fail_truncated(what);
    if (to.empty()) return;
    std::memcpy(to.data(), at, to.size_bytes());
    at += to.size_bytes();
    if (swapped)
      for (T& value : to) value = with_bytes_reversed(value);
  }

  /// Checks a number of items against what is left of the file, each taking at least `bytes`, so that a broken count
  /// ends in a message and not in a huge allocation; also that it fits an Index.
  std::size_t check_count(std::int64_t n, std::size_t bytes, std::string_view what) const;

  /// "file:line", or "file, byte n".
  std::string where(const char* place) const;
  /// Does the last line end? If not, the file may be cut short.
  bool last_line_ends() const { return begin == end || end[-1] == '\n'; }
  [[noreturn]] void fail(const std::string& what) const { fail_at(at, what); }
  [[noreturn]] void fail_at(const char* place, const std::string& what) const;
  [[noreturn]] void fail_truncated(std::string_view what) const;

 private:
  bool ends_number(const char* stop) const { return stop == end || blank(*stop) || *stop == ','; }
  std::int64_t odd_integer(std::string_view what);
  double odd_real(std::string_view what);
};

std::string_view trimmed(std::string_view text);
/// The number that fills a field of fixed width, blanks around it; a blank field is 0. False at anything else. Reals as
/// Fortran has them: "1.5E-3", "1.5D-3", "1.5-3".
bool integer_in_field(std::string_view field, std::int64_t& value);
bool real_in_field(std::string_view field, double& value);
/// What may stand in a message: cut to a few characters, control characters replaced.
std::string shown(std::string_view text);

}  // namespace hextwist::io
