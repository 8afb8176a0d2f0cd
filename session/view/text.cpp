#include "hextwist/session/view/text.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#ifdef HEXTWIST_FONT
#include <ft2build.h>
#include FT_FREETYPE_H

extern "C" const unsigned char hextwist_font_begin[], hextwist_font_end[];
#endif

namespace hextwist {

#ifdef HEXTWIST_FONT
namespace {

/// One face for all; whoever uses it holds the lock.
struct Font {
  std::mutex mutex;
  FT_Library library = nullptr;
  FT_Face face = nullptr;

  Font() {
    if (FT_Init_FreeType(&library) != 0) return;
    if (FT_New_Memory_Face(library, hextwist_font_begin, hextwist_font_end - hextwist_font_begin, 0, &face) != 0)
      face = nullptr;
  }
  ~Font() {
    if (face) FT_Done_Face(face);
    if (library) FT_Done_FreeType(library);
  }
};
Font& font() {
  static Font the_one;
  return the_one;
}

/// The next character of UTF-8, which is taken away; bytes that are none are U+FFFD.
char32_t next_character(std::string_view& text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  const std::size_t n = first < 0x80 ? 1 : first >> 5 == 6 ? 2 : first >> 4 == 14 ? 3 : first >> 3 == 30 ? 4 : 0;
  bool good = n > 0 && n <= text.size();
  for (std::size_t i = 1; good && i < n; ++i) good = byte(i) >> 6 == 2;
  if (!good) {
    text.remove_prefix(1);
    return 0xfffd;
  }
  char32_t result = n == 1 ? first : first & (0x7fU >> n);
  for (std::size_t i = 1; i < n; ++i) result = result << 6 | (byte(i) & 0x3f);
  text.remove_prefix(n);
  return result;
}

/// Calls visit(glyph slot, x) for each character; returns how wide all of it is. The lock is held.
template <class F>
double each_glyph(FT_Face face, std::string_view text, double size, const F& visit) {
  FT_Set_Char_Size(face, 0, static_cast<FT_F26Dot6>(std::lround(64 * size)), 72, 72);
  double x = 0;
  while (!text.empty()) {
    const char32_t c = next_character(text);
    if (FT_Load_Char(face, c < 0x20 ? char32_t{0x20} : c, FT_LOAD_RENDER | FT_LOAD_NO_HINTING) != 0) continue;
    visit(*face->glyph, x);
    x += static_cast<double>(face->glyph->linearHoriAdvance) / 65536;
  }
  return x;
}

}  // namespace

bool has_text() {
  return font().face != nullptr;
}

double text_width(std::string_view text, double size) {
  const std::lock_guard lock(font().mutex);
  return font().face ? each_glyph(font().face, text, size, [](const FT_GlyphSlotRec&, double) {}) : 0;
}

void write_text(std::vector<Colour>& pixels, int width, int height, double x, double y, std::string_view text,
                double size, const Colour& colour) {
  const std::lock_guard lock(font().mutex);
  if (!font().face) return;
  each_glyph(font().face, text, size, [&](const FT_GlyphSlotRec& glyph, double along) {
    const FT_Bitmap& bitmap = glyph.bitmap;
    const int left = static_cast<int>(std::lround(x + along)) + glyph.bitmap_left;
    const int top = static_cast<int>(std::lround(y)) - glyph.bitmap_top;
    for (int j = 0; j < static_cast<int>(bitmap.rows); ++j)
      for (int i = 0; i < static_cast<int>(bitmap.width); ++i) {
        const int at_x = left + i, at_y = top + j;
        if (at_x < 0 || at_y < 0 || at_x >= width || at_y >= height) continue;
        Colour& pixel = pixels[static_cast<std::size_t>(at_y) * width + at_x];
        const int share = bitmap.buffer[j * bitmap.pitch + i];
        for (int k = 0; k < 3; ++k)
          pixel[k] = static_cast<std::uint8_t>((share * colour[k] + (255 - share) * pixel[k] + 127) / 255);
      }
  });
}

#else

bool has_text() {
  return false;
}
double text_width(std::string_view text, double size) {
  return 0.6 * size * static_cast<double>(text.size());
}
void write_text(std::vector<Colour>&, int, int, double, double, std::string_view, double, const Colour&) {}

#endif

}  // namespace hextwist

#ifdef HEXTWIST_FONT
asm(".section .rodata\n"
    ".global hextwist_font_begin\n"
    ".hidden hextwist_font_begin\n"
    "hextwist_font_begin:\n"
    ".incbin \"" HEXTWIST_FONT
    "\"\n"
    ".global hextwist_font_end\n"
    ".hidden hextwist_font_end\n"
    "hextwist_font_end:\n"
    ".byte 0\n"
    ".text\n");
#endif
