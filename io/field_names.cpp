#include "hextwist/io/field_names.h"

#include <algorithm>
#include <cmath>

#include "hextwist/base/text.h"
#include "hextwist/io/format.h"
#include "hextwist/io/group_names.h"
#include "hextwist/mesh/others.h"

namespace hextwist::io {

std::string link_name(std::string_view name) {
  std::string link(trimmed(one_line(std::string(name))));
  std::ranges::replace(link, '/', '_');
  if (!link.empty() && link.find_first_not_of('.') == std::string::npos) link.insert(0, "_");
  return link;
}

std::string distinct_field_name(const std::string& name, const std::string& fitted, std::size_t longest,
                                const std::function<bool(const std::string&)>& is_free,
                                std::vector<std::string>& notices) {
  const std::string stem = fitted.empty() ? "field" : fitted;
  const auto cut = [&](std::size_t n) {
    std::string text(first_letters(stem, n));
    while (text.size() > 1 && text.back() == ' ') text.pop_back();
    return text;
  };
  std::string result = cut(longest);
  for (int k = 2; !is_free(result); ++k) {
    const std::string tail = "-" + std::to_string(k);  // with "_" components would have it
    result = cut(longest - tail.size()) + tail;
  }
  say_renamed("field", name, result, notices);
  return result;
}

void say_values_of_others(const Mesh& mesh, const char* format, std::vector<std::string>& notices) {
  if (!mesh.others) return;
  std::vector<std::string> names;
  for (const OtherField& field : mesh.others->heads->fields)
    if (!field.is_attribute && std::ranges::any_of(field.values, [](double x) { return !std::isnan(x); }))
      names.push_back("'" + field.name + "'");
  if (!names.empty())
    notices.push_back("values of " + counted(std::ssize(names), "field") + " on other elements are left out, which " +
                      format + " files have no place for here: " + joined(names, ", "));
}

void say_whole_numbers(const Mesh& mesh, const char* format, std::vector<std::string>& notices) {
  std::string names;
  for (const Field& field : mesh.fields)
    if (field.integer) names += (names.empty() ? "'" : ", '") + one_line(field.name) + "'";
  if (!names.empty()) notices.push_back("whole numbers are real ones in " + std::string(format) + ": " + names);
}

void check_whole_numbers(const Field& field) {
  if (!field.integer) return;
  const auto odd = std::ranges::find_if(field.values, [](double x) { return std::isfinite(x) && x != std::floor(x); });
  if (odd != field.values.end())
    throw Error("field '" + one_line(field.name) + "' is of whole numbers, but values[" +
                std::to_string(odd - field.values.begin()) + "] is " + short_number(*odd));
}

}  // namespace hextwist::io
