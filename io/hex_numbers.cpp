#include "hextwist/io/hex_numbers.h"

#include <algorithm>
#include <cmath>

#include "hextwist/io/format.h"

namespace hextwist::io {

void add_hex_numbers(Mesh& mesh, const char* name, std::span<const std::int64_t> ids, std::span<const int> numbers,
                     const std::function<int(Index)>& usual) {
  Field field{name, Field::On::hex, 1, std::vector<double>(mesh.hexes.size(), 0), true};
  bool differs = false;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const Index h = find_hex(mesh, ids[i]);
    field.values[h] = numbers[i];
    differs = differs || numbers[i] != usual(h);
  }
  if (differs) mesh.fields.push_back(std::move(field));
}

const Field* hex_numbers(const Mesh& mesh, std::string_view name, std::int64_t highest) {
  for (const Field& field : mesh.fields) {
    if (field.name != name || field.on != Field::On::hex || field.components != 1) continue;
    const auto fits = [&](double value) {  // NaN does not
      return value >= 0 && value <= static_cast<double>(highest) && std::floor(value) == value;
    };
    if (std::ranges::all_of(field.values, fits)) return &field;
  }
  return nullptr;
}

void say_no_other_fields(const Mesh& mesh, std::span<const Field* const> written, const char* format,
                         std::vector<std::string>& notices) {
  Mesh others;
  for (const Field& field : mesh.fields)
    if (std::ranges::find(written, &field) == written.end()) others.fields.emplace_back().name = field.name;
  say_no_fields(others, format, notices);
}

}  // namespace hextwist::io
