// Records of commands as dictionaries.
#pragma once

#include "hextwist/embed/python/convert_internal.h"
#include "hextwist/session/record_json.h"

namespace hextwist::python {

inline py::object from_json(const Json& json) {
  if (json.is_object()) {
    py::dict result;
    for (const auto& [name, value] : json.items()) result[text(name)] = from_json(value);
    return result;
  }
  if (json.is_array()) {
    py::list result;
    for (const Json& value : json) result.append(from_json(value));
    return result;
  }
  if (json.is_string()) return text(json.get_ref<const std::string&>());
  if (json.is_boolean()) return py::bool_(json.get<bool>());
  if (json.is_number_integer()) return py::int_(json.get<std::int64_t>());
  if (json.is_number()) return py::float_(json.get<double>());
  return py::none();
}

inline py::object record_dict(const CommandRecord& record) {
  return from_json(record_json(record));
}

}  // namespace hextwist::python
