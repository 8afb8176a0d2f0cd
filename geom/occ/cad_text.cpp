#include "hextwist/geom/occ/cad_text_internal.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <limits>
#include <vector>

namespace hextwist {
namespace {

constexpr const char* blanks = " \t\r\n";

/// OpenCASCADE has integers for them.
constexpr std::uint64_t most_step_id = std::numeric_limits<std::int32_t>::max();

bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

std::string truncated(CadFormat format) {
  return "the " + std::string(format_name(format)) + " file is truncated: its end is missing";
}

// Instances are "#12 = ...;"; anything else that starts with # and a digit refers to one. Strings and comments aside.
std::string step_defect(std::string_view text) {
  const std::string_view tail = text.substr(text.size() - std::min<std::size_t>(text.size(), 2000));
  if (tail.find("END-ISO-10303-21") == std::string_view::npos) return truncated(CadFormat::step);
  std::vector<std::uint64_t> defined, used;
  bool statement_starts = true;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\'') {
      i = text.find('\'', i + 1);
      if (i == std::string_view::npos) return "a string in the STEP file is not closed";
    } else if (c == '/' && i + 1 < text.size() && text[i + 1] == '*') {
      i = text.find("*/", i + 2);
      if (i == std::string_view::npos) return "a comment in the STEP file is not closed";
      ++i;
      continue;
    } else if (c == '#' && i + 1 < text.size() && is_digit(text[i + 1])) {
      std::uint64_t id = 0;
      const auto [end, error] = std::from_chars(text.data() + i + 1, text.data() + text.size(), id);
      if (error != std::errc() || id > most_step_id)
        return "the STEP file has an instance number beyond " + std::to_string(most_step_id) +
               ", the last that can be read: #" + std::string(text.data() + i + 1, end);
      i = static_cast<std::size_t>(end - text.data()) - 1;
      (statement_starts ? defined : used).push_back(id);
    }
    if (c == ';') {
      statement_starts = true;
    } else if (std::string_view(blanks).find(c) == std::string_view::npos) {
      statement_starts = false;
    }
  }
  std::sort(defined.begin(), defined.end());
  for (const std::uint64_t id : used)
    if (!std::binary_search(defined.begin(), defined.end(), id))
      return "the STEP file is damaged: #" + std::to_string(id) + " is referred to but not there";
  return "";
}

// The last section lists the shapes, each starting with a line of its two-letter kind; after them stands one line with
// the reference of the root: "+1 0", or "-1 0" of a shape turned round.
std::string brep_defect(std::string_view text) {
  const std::size_t section = text.rfind("\nTShapes ");
  const std::size_t star = text.rfind('*'), end = text.find_last_not_of(blanks);
  const std::size_t root = star == std::string_view::npos ? star : text.find_first_not_of(blanks, star + 1);
  if (section == std::string_view::npos || root == std::string_view::npos || end < root + 3 ||
      (text[root] != '+' && text[root] != '-')) {
    return truncated(CadFormat::brep);
  }
  long announced = 0;
  std::from_chars(text.data() + section + 9, text.data() + text.size(), announced);
  constexpr std::array<std::string_view, 8> kinds{"Ve", "Ed", "Wi", "Fa", "Sh", "So", "CS", "Co"};
  long found = 0;
  std::array<std::string_view, 6> sections{"\nLocations ", "\nCurve2ds ", "\nCurves ",
                                           "\nPolygon3D ", "\nSurfaces ", "\nTriangulations "};
  for (const std::string_view name : sections) {
    if (text.find(name) == std::string_view::npos) {
      return "the BREP file is damaged: it has no section " + std::string(name.substr(1, name.size() - 2));
    }
  }
  for (std::size_t line = section + 1; line < text.size();) {
    const std::size_t next = std::min(text.find('\n', line), text.size());
    std::string_view word = text.substr(line, next - line);
    while (!word.empty() && std::string_view(blanks).find(word.back()) != std::string_view::npos) word.remove_suffix(1);
    if (std::find(kinds.begin(), kinds.end(), word) != kinds.end()) ++found;
    line = next + 1;
  }
  if (found != announced) {
    return "the BREP file is damaged: " + std::to_string(announced) + " shapes announced, " + std::to_string(found) +
           " found";
  }
  return "";
}

std::string iges_defect(std::string_view text) {
  const std::size_t end = text.find_last_not_of(blanks), line = text.rfind('\n', end);
  const std::size_t start = line == std::string_view::npos ? 0 : line + 1;
  if (end == std::string_view::npos) return truncated(CadFormat::iges);
  return end - start >= 72 && text[start + 72] == 'T' ? "" : truncated(CadFormat::iges);
}

}  // namespace

const char* format_name(CadFormat format) {
  switch (format) {
    case CadFormat::step:
      return "STEP";
    case CadFormat::brep:
      return "BREP";
    case CadFormat::iges:
      return "IGES";
    default:
      return "CAD";
  }
}

CadFormat format_by_content(std::string_view text) {
  const std::string_view head = text.substr(0, 1000);
  if (head.find("ISO-10303-21") != std::string_view::npos) return CadFormat::step;
  if (head.find("CASCADE Topology V") != std::string_view::npos) return CadFormat::brep;
  // A line of IGES has 80 columns, the 73rd its section letter, the rest a number.
  if (text.size() >= 80 && text[72] == 'S' && is_digit(text[79])) return CadFormat::iges;
  return CadFormat::unknown;
}

std::string text_defect(CadFormat format, std::string_view text) {
  switch (format) {
    case CadFormat::step:
      return step_defect(text);
    case CadFormat::brep:
      return brep_defect(text);
    case CadFormat::iges:
      return iges_defect(text);
    default:
      return "";
  }
}

}  // namespace hextwist
