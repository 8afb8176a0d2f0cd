// Checks of CAD files as text, before OpenCASCADE reads them: it accepts files that end early, and crashes on some
// with pieces missing. Internal to geom.
#pragma once

#include <string>
#include <string_view>

namespace hextwist {

enum class CadFormat { unknown, step, brep, iges };

/// "STEP", "BREP", "IGES", "CAD".
const char* format_name(CadFormat format);

/// By its first lines.
CadFormat format_by_content(std::string_view text);

/// What is wrong with the file, "" if nothing is seen: its end is missing; an instance of a STEP file is referred to
/// but not there; the shapes of a BREP file are fewer or more than announced.
std::string text_defect(CadFormat format, std::string_view text);

}  // namespace hextwist
