// Numbers that a format has of each hex beside its block (material, section, real constants): fields of whole numbers
// here, which refinement carries, and from which they are written.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hextwist/mesh/mesh.h"

namespace hextwist::io {

/// Adds such a field of hexes, unless all have what is written without one. ids, numbers: of all hexes, in any order;
/// usual: what is written of a hex by its place.
void add_hex_numbers(Mesh& mesh, const char* name, std::span<const std::int64_t> ids, std::span<const int> numbers,
                     const std::function<int(Index)>& usual);

/// The field of this name where it has a whole number of every hex, 0 .. highest; null otherwise.
const Field* hex_numbers(const Mesh& mesh, std::string_view name, std::int64_t highest);

/// say_no_fields() (format.h) of all fields but these, of which some may be null.
void say_no_other_fields(const Mesh& mesh, std::span<const Field* const> written, const char* format,
                         std::vector<std::string>& notices);

}  // namespace hextwist::io
