// Arrays of numbers in VTK's files.
#include <optional>

#include "hextwist/base/large_array.h"
#include "hextwist/io/vtk/vtk_internal.h"

namespace hextwist::io {
namespace {

struct NamedType {
  std::string_view name;
  VtkType type;
};
constexpr NamedType vtk_types[] = {{"Int8", VtkType::int8},
                                   {"UInt8", VtkType::uint8},
                                   {"Int16", VtkType::int16},
                                   {"UInt16", VtkType::uint16},
                                   {"Int32", VtkType::int32},
                                   {"UInt32", VtkType::uint32},
                                   {"Int64", VtkType::int64},
                                   {"UInt64", VtkType::uint64},
                                   {"Float32", VtkType::float32},
                                   {"Float64", VtkType::float64},
                                   {"char", VtkType::int8},
                                   {"signed_char", VtkType::int8},
                                   {"unsigned_char", VtkType::uint8},
                                   {"short", VtkType::int16},
                                   {"unsigned_short", VtkType::uint16},
                                   {"int", VtkType::int32},
                                   {"unsigned_int", VtkType::uint32},
                                   {"long", VtkType::int64},
                                   {"unsigned_long", VtkType::uint64},
                                   {"vtkIdType", VtkType::int32},
                                   {"vtktypeint64", VtkType::int64},
                                   {"vtktypeuint64", VtkType::uint64},
                                   {"float", VtkType::float32},
                                   {"double", VtkType::float64}};

}  // namespace

VtkType vtk_type(std::string_view name, const Cursor& cursor) {
  for (const auto& [known, type] : vtk_types)
    if (same_word(known, name)) return type;
  cursor.fail("numbers of type " + shown(name) + " are not known");
}

std::size_t vtk_size(VtkType type) {
  constexpr std::array<std::size_t, 10> sizes = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

void VtkArray::keep() {
  if (!own.empty() || bytes.empty()) return;
  own.resize((bytes.size() + sizeof own[0] - 1) / sizeof own[0]);
  std::memcpy(own.data(), bytes.data(), bytes.size());
  bytes = {reinterpret_cast<const char*>(own.data()), bytes.size()};
}

void read_vtk_values(Cursor& cursor, VtkType type, std::size_t n, VtkArray& to) {
  to.type = type;
  const std::size_t size = vtk_size(type);
  if (n > cursor.left() / size) cursor.fail_truncated("the values of " + shown(to.name));
  to.bytes = {cursor.at, n * size};
  cursor.at += n * size;
  if (!cursor.swapped || size == 1) return;
  to.keep();
  auto* at = reinterpret_cast<char*>(to.own.data());
  for (std::size_t i = 0; i < n; ++i, at += size) std::reverse(at, at + size);
}

void read_vtk_text(Cursor& cursor, VtkType type, std::optional<std::size_t> n, VtkArray& to) {
  if (n && *n > cursor.left() / 2 + 1) cursor.fail_truncated("the values of " + shown(to.name));
  to.type = type;
  to.type = to.is_integer() ? VtkType::int64 : VtkType::float64;
  if (n) reserve_large(to.own, *n);
  for (std::size_t i = 0; n ? i < *n : cursor.more(); ++i)
    to.own.push_back(to.is_integer() ? std::bit_cast<std::uint64_t>(cursor.integer("a value"))
                                     : std::bit_cast<std::uint64_t>(cursor.real("a value")));
  to.bytes = {reinterpret_cast<const char*>(to.own.data()), to.own.size() * sizeof to.own[0]};
}

void set_integers(VtkArray& to, const std::vector<std::int64_t>& numbers) {
  to.type = VtkType::int64;
  to.own.clear();
  to.bytes = {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof numbers[0]};
  to.keep();
}

std::vector<std::string> made_names(VtkArray::On on, std::string_view name) {
  constexpr std::string_view marker = "hextwist:made";
  std::vector<std::string> names;
  if (on != VtkArray::On::file || !name.starts_with(marker)) return names;
  name.remove_prefix(marker.size());
  while (!(name = trimmed(name)).empty()) {
    const auto end = std::min(name.find(' '), name.size());
    names.emplace_back(name.substr(0, end));
    name.remove_prefix(end);
  }
  return names;
}

bool is_made(std::string_view name, std::string_view usual) {
  while (name != usual && name.starts_with(made_prefix)) name.remove_prefix(made_prefix.size());
  return name == usual;
}

void say_file_arrays(std::span<const VtkArray> arrays, std::vector<std::string>& notices) {
  std::vector<std::string> names;
  for (const VtkArray& array : arrays)
    if (array.on == VtkArray::On::file && !array.name.starts_with("hextwist:")) names.push_back("'" + array.name + "'");
  if (!names.empty())
    notices.push_back("left out " + counted(std::ssize(names), "array") + " of field data, which " +
                      (names.size() == 1 ? "is" : "are") + " of the whole file: " + joined(names, ", "));
}

std::vector<Vec3> vtk_points(const VtkArray& array, const Cursor& cursor) {
  std::vector<Vec3> points;
  array.visit([&](auto numbers) {
    const std::size_t n = numbers.size() / 3;
    reserve_large(points, n);
    for (std::size_t i = 0; i < n; ++i) {
      const auto x = [&](std::size_t axis) { return static_cast<double>(numbers[3 * i + axis]); };
      points.emplace_back(x(0), x(1), x(2));
      if (!points.back().allFinite())
        throw Error(std::string(cursor.name) + ": a coordinate of point " + std::to_string(i) +
                    " (counted from 0) is not finite");
    }
  });
  return points;
}

}  // namespace hextwist::io
