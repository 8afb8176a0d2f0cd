// A small renderer: quads with their edges and lines into a depth buffer.
#pragma once

#include <span>

#include "hextwist/session/view/picture.h"

namespace hextwist {

/// What is seen of a picture at each pixel, before anything is written over it.
struct Rendered {
  int width = 0, height = 0;
  std::vector<Colour> pixels;
  std::vector<float> depth;  ///< per pixel, in pixels towards the eye; -infinity where nothing is
};
Rendered rendered(const Picture& picture, int width, int height);

/// Where a label stands: its middle, in pixels.
struct PlacedLabel {
  std::string text;
  double x = 0, y = 0;
};
/// Those that have a place where they are seen and do not cover each other. size: of the text, in pixels.
std::vector<PlacedLabel> placed_labels(const Picture& picture, const Rendered& seen, double size);

/// How large text is in a picture of this size.
double text_size_of(int width, int height);
/// Caption, legend and labels, over what was rendered.
void write_over(const Picture& picture, Rendered& rendered);

/// What is behind a label.
inline constexpr Colour label_back = {42, 49, 64};

/// Longer legends end with "and 7 more".
inline constexpr std::size_t most_legend_rows = 14;
/// Numbers beside a scale.
inline constexpr int n_scale_numbers = 5;

}  // namespace hextwist
