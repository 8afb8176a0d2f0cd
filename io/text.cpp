#include "hextwist/io/text.h"

#include <algorithm>
#include <limits>

#include "hextwist/mesh/mesh.h"

namespace hextwist::io {

std::string_view Cursor::word() {
  skip_blanks();
  const char* from = at;
  while (at < end && !blank(*at)) ++at;
  return {from, at};
}

std::string_view Cursor::line() {
  const char* from = at;
  const auto* stop = static_cast<const char*>(std::memchr(at, '\n', left()));
  at = stop ? stop + 1 : end;
  if (!stop) stop = end;
  while (stop > from && stop[-1] == '\r') --stop;
  return {from, stop};
}

int Cursor::small(std::string_view what) {
  skip_blanks();
  const char* from = at;
  const auto value = integer(what);
  if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max())
    fail_at(from, std::string(what) + " " + std::to_string(value) + " is too large");
  return static_cast<int>(value);
}

// What the fast path did not take: a leading plus; or an error.
std::int64_t Cursor::odd_integer(std::string_view what) {
  if (at == end) fail_truncated(what);
  const char* from = at;
  const std::string_view text = word();
  const std::string_view digits = text.substr(text[0] == '+' ? 1 : 0, text.find(',') - (text[0] == '+' ? 1 : 0));
  std::int64_t value = 0;
  const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || stop != digits.data() + digits.size())
    fail_at(from, "expected " + std::string(what) + ", found " + shown(text));
  at = stop;
  return value;
}

// Also: a Fortran exponent (1.5D+3), and numbers beyond the range of double, which become 0 or infinity.
double Cursor::odd_real(std::string_view what) {
  if (at == end) fail_truncated(what);
  const char* from = at;
  const std::string_view text = word();
  std::string number(text.substr(0, text.find(',')));
  at = from + number.size();
  if (number[0] == '+') number.erase(0, 1);
  std::ranges::replace(number, 'D', 'e');
  std::ranges::replace(number, 'd', 'e');
  char* stop = nullptr;
  const bool plain = number.find_first_not_of("0123456789+-.eE") == std::string::npos;
  double value = 0;
  if (plain && !number.empty()) {
    const auto [last, error] = std::from_chars(number.data(), number.data() + number.size(), value);
    stop = const_cast<char*>(last);
    if (error == std::errc::result_out_of_range) {
      const auto exponent = number.find_first_of("eE");
      const bool tiny = exponent != std::string::npos && number.compare(exponent + 1, 1, "-") == 0;
      value = tiny ? 0 : std::numeric_limits<double>::infinity();
    }
  }
  if (!stop || stop != number.data() + number.size())
    fail_at(from, "expected " + std::string(what) + ", found " + shown(text));
  return value;
}

std::size_t Cursor::check_count(std::int64_t n, std::size_t bytes, std::string_view what) const {
  if (n < 0) fail("negative number of " + std::string(what) + ": " + std::to_string(n));
  if (n > std::numeric_limits<Index>::max()) fail("too many " + std::string(what) + ": " + std::to_string(n));
  const auto count = static_cast<std::size_t>(n);
  if (bytes > 0 && count > left() / bytes)
    fail("the file is too short for " + std::to_string(n) + " " + std::string(what));
  return count;
}

std::string Cursor::where(const char* place) const {
  if (binary) return std::string(name) + ", byte " + std::to_string(place - begin);
  return std::string(name) + ":" + std::to_string(1 + std::count(begin, std::min(place, end), '\n'));
}

void Cursor::fail_at(const char* place, const std::string& what) const {
  throw Error(where(place) + ": " + what);
}

void Cursor::fail_truncated(std::string_view what) const {
  fail_at(end, "the file ends where " + std::string(what) + " should stand");
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && Cursor::blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && Cursor::blank(text.back())) text.remove_suffix(1);
  return text;
}

bool integer_in_field(std::string_view field, std::int64_t& value) {
  field = trimmed(field);
  value = 0;
  if (field.empty()) return true;
  if (field.front() == '+') field.remove_prefix(1);
  const auto [stop, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  return error == std::errc{} && stop == field.data() + field.size();
}

bool real_in_field(std::string_view field, double& value) {
  field = trimmed(field);
  value = 0;
  if (field.empty()) return true;
  if (field.front() == '+') field.remove_prefix(1);
  const char* const end = field.data() + field.size();
  auto [stop, error] = std::from_chars(field.data(), end, value);
  if (error == std::errc{} && stop == end) return std::isfinite(value);
  // What from_chars() does not know: other letters of an exponent, or none.
  std::string text(field);
  for (char& c : text)
    if (c == 'd' || c == 'D' || c == 'E') c = 'e';
  const auto sign = text.find_first_of("+-", 1);
  if (sign != std::string::npos && text.find('e') == std::string::npos) text.insert(sign, "e");
  const auto second = std::from_chars(text.data(), text.data() + text.size(), value);
  return second.ec == std::errc{} && second.ptr == text.data() + text.size() && std::isfinite(value);
}

std::string shown(std::string_view text) {
  std::string result = "'";
  for (const char c : text.substr(0, 30)) result += static_cast<unsigned char>(c) < ' ' || c == 127 ? '?' : c;
  return result + (text.size() > 30 ? "...'" : "'");
}

}  // namespace hextwist::io
