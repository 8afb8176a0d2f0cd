// Arrays in few bytes, for a page to unpack: page/src/unpack.js is the other side.
//
// A block is deflated (zlib). Inside: the length of a header (four bytes, lowest first), the header, and the arrays one
// after the other. The header is JSON, [["name", "f32", components, records], ...]. Of every array first the records
// are replaced by their differences from the record before (as integers of the same bits, zigzag), then all first bytes
// stand together, then all second ones, and so on: most of them are zeros then.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hextwist/base/types.h"

namespace hextwist {

/// One array of a block. bytes: as in memory, records * components * size of the type.
struct PackedArray {
  enum class Type { u8, u32, f32, f64 };
  std::string name;
  Type type = Type::u8;
  int components = 1;
  std::string bytes;
};

struct PackedBlock {
  std::string name;
  std::vector<PackedArray> arrays;
};

namespace detail {
template <class T>
constexpr PackedArray::Type packed_type() {
  if constexpr (sizeof(T) == 1) return PackedArray::Type::u8;
  if constexpr (sizeof(T) == 8) return PackedArray::Type::f64;
  return std::is_floating_point_v<T> ? PackedArray::Type::f32 : PackedArray::Type::u32;
}
}  // namespace detail

/// T: std::uint8_t, Index or std::uint32_t, float, double. values.size() is a multiple of components.
template <class T>
PackedArray packed(std::string name, const std::vector<T>& values, int components = 1) {
  PackedArray result{std::move(name), detail::packed_type<T>(), components,
                     std::string(values.size() * sizeof(T), '\0')};
  if (!values.empty()) std::memcpy(result.bytes.data(), values.data(), result.bytes.size());
  return result;
}

/// Three numbers more.
inline void add_point(std::vector<float>& to, const Vec3& p) {
  for (int k = 0; k < 3; ++k) to.push_back(static_cast<float>(p[k]));
}

/// What of `now` is not in `before`, for who has that: of arrays that are the same "name:same" without records; of
/// those that have most records in common "name:runs", pairs of a number of records and where in `before` they begin
/// (-1: they are new), and "name:new"; all else as it is.
PackedBlock difference(const PackedBlock& before, const PackedBlock& now);

/// The block as it is sent: deflated.
std::string deflated(const PackedBlock& block);
/// The same in the characters of a page.
std::string base64(std::string_view bytes);

/// A text as a string of JSON that may also stand in a page.
std::string json_text(std::string_view text);
/// The shortest number that reads back the same; null where it is not finite.
std::string json_number(double value);

}  // namespace hextwist
