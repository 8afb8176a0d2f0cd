// Names of fields in formats that can't have every name: no two alike, of whole characters, and what is changed is
// told.
#pragma once

#include <functional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hextwist/mesh/mesh.h"

namespace hextwist::io {

/// What links of HDF5 and nodes of CGNS can be called: one line, no slash, no blank at an end, and no mere dots.
std::string link_name(std::string_view name);

/// The name of a field in a file: `fitted` (what the format can have of `name`), cut to so many bytes, with "-2", "-3"
/// ... behind it where it is taken; "field" where that is empty. Tells where it is not `name`. is_free: takes the name
/// where it is.
std::string distinct_field_name(const std::string& name, const std::string& fitted, std::size_t longest,
                                const std::function<bool(const std::string&)>& is_free,
                                std::vector<std::string>& notices);

/// Tells which fields have values on other elements that are written without them. format: "MED".
void say_values_of_others(const Mesh& mesh, const char* format, std::vector<std::string>& notices);

/// Tells which fields of whole numbers a file does not know as such.
void say_whole_numbers(const Mesh& mesh, const char* format, std::vector<std::string>& notices);

/// Throws Error naming the first value of a field of whole numbers that is none.
void check_whole_numbers(const Field& field);

}  // namespace hextwist::io
