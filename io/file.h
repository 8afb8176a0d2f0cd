// Whole files in, whole files out.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "hextwist/base/replacement.h"

namespace hextwist::io {

/// Gives back what holds the bytes of a file: its pages, or memory.
struct ReleaseBytes {
  std::size_t mapped = 0;  ///< 0: memory
  void operator()(const char* data) const;
};

/// The bytes of a file; name is what error messages call it.
struct Bytes {
  std::string name;
  std::unique_ptr<const char[], ReleaseBytes> data;
  std::size_t size = 0;
};

/// The bytes of a whole file, mapped where the system can: no copy of them is made, and pages that were read can go.
/// Somebody may write it meanwhile: what is gone reads as zeros (mapped.h), and check_unchanged() tells.
/// Throws Error when it is missing, a folder, a pipe, unreadable or empty.
Bytes read_bytes(const std::filesystem::path& file);

/// Throws Error when somebody has written the file after read_bytes().
void check_unchanged(const Bytes& bytes);
/// Reads by f; whatever comes of it, a file that was changed meanwhile is said to be the reason.
template <class F>
auto unchanged_by(const Bytes& bytes, F&& f) {
  try {
    auto result = f();
    check_unchanged(bytes);
    return result;
  } catch (const Error&) {
    check_unchanged(bytes);
    throw;
  }
}

/// A number in at most `width` characters (16 to 32) and with an exponent of two digits, as near as that gets; below
/// 1e-99 it is 0.
struct NumberText {
  NumberText(double value, std::size_t width);
  std::string_view text() const { return {characters.data(), size}; }
  std::array<char, 32> characters;
  std::size_t size = 0;
};

/// An integer right-aligned in a field.
struct Right {
  std::int64_t number;
  std::size_t width;
};

/// Buffered output. Numbers in text are the shortest that read back to the same bits. Every failed write (full disk)
/// throws Error.
class Output {
 public:
  Output(const std::filesystem::path& file, bool overwrite);
  ~Output();
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  Output& operator<<(std::string_view text) {
    raw(text.data(), text.size());
    return *this;
  }
  Output& operator<<(const char* text) { return *this << std::string_view(text); }
  Output& operator<<(char c) {
    if (used_ == capacity) flush();
    buffer_[used_++] = c;
    return *this;
  }
  Output& operator<<(std::int64_t value);
  Output& operator<<(std::int32_t value) { return *this << std::int64_t{value}; }
  Output& operator<<(std::size_t value) { return *this << static_cast<std::int64_t>(value); }
  Output& operator<<(double value);
  Output& operator<<(const Right& field);
  /// A number for readers that take at most `width` characters of one (16 or more) and exponents of two digits: as
  /// near to the value as fits, which is the value itself but for some that are small. Below 1e-99 it is 0.
  Output& number(double value, std::size_t width) { return *this << NumberText(value, width).text(); }

  void raw(const void* bytes, std::size_t n) {
    if (n > capacity - used_) return raw_large(bytes, n);
    if (n > 0) std::memcpy(buffer_.get() + used_, bytes, n);  // nothing may be at no address
    used_ += n;
  }
  /// One value as the machine stores it.
  template <class T>
  void put(const T& value) {
    raw(&value, sizeof value);
  }
  template <class T>
  void put_all(std::span<const T> values) {
    raw(values.data(), values.size_bytes());
  }
  /// value(0) .. value(n - 1), computed straight into the buffer.
  template <class F>
  void put_each(std::size_t n, F&& value) {
    using T = decltype(value(n));
    for (std::size_t i = 0; i < n;) {
      const std::size_t piece = std::min(n - i, capacity / sizeof(T));
      char* at = room(piece * sizeof(T));
      used_ += piece * sizeof(T);
      for (const std::size_t end = i + piece; i < end; ++i, at += sizeof(T)) {
        const T one = value(i);
        std::memcpy(at, &one, sizeof(T));
      }
    }
  }

  /// Flushes, closes and moves the file to its place.
  void commit();

 private:
  static constexpr std::size_t capacity = std::size_t{1} << 18;  // stays in the cache
  char* room(std::size_t n) {
    if (n > capacity - used_) flush();
    return buffer_.get() + used_;
  }
  void raw_large(const void* bytes, std::size_t n);
  void write_out(const char* bytes, std::size_t n);
  void flush();

  Replacement file_;
  std::unique_ptr<char[]> buffer_;
  std::size_t used_ = 0;
  int descriptor_ = -1;
};

}  // namespace hextwist::io
