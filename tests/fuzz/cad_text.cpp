// What is looked at in CAD files before OpenCASCADE sees them.
#include <cstdint>

#include "hextwist/geom/occ/cad_text_internal.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  hextwist::format_by_content(text);
  for (const auto format : {hextwist::CadFormat::step, hextwist::CadFormat::brep, hextwist::CadFormat::iges})
    if (!text.empty()) hextwist::text_defect(format, text);
  return 0;
}
