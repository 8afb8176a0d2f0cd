// Text in pictures, by FreeType, in a font that is inside of the program: pictures are the same wherever they are
// drawn.
#pragma once

#include <string_view>
#include <vector>

#include "hextwist/session/view/picture.h"

namespace hextwist {

/// Was this program built with FreeType and a font? Without them pictures have no text.
bool has_text();
/// In pixels; a guess where there is no font.
double text_width(std::string_view text, double size);
/// UTF-8 from x on, on a line at y; what does not fit into the picture is cut off.
void write_text(std::vector<Colour>& pixels, int width, int height, double x, double y, std::string_view text,
                double size, const Colour& colour);

}  // namespace hextwist
