// Pictures of a mesh: what is seen of it, and the file that shows that.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hextwist/mesh/mesh.h"

namespace hextwist {

using Colour = std::array<std::uint8_t, 3>;

/// Quads, lines and points in space. A line from a point to itself is a dot.
struct Picture {
  struct Facet {
    std::array<std::int32_t, 4> corners;  ///< a cycle, into points
    Colour colour;
    std::int64_t hex = 0;  ///< id of the hex that it belongs to
    double value = 0;      ///< its quality, where that gives the colours
  };
  struct Line {
    Vec3 from, to;
    Colour colour;
    float width = 1;      ///< pixels of a picture of 1000
    bool on_top = false;  ///< seen through everything else
  };
  struct LegendRow {
    Colour colour;
    std::string text;
  };
  std::vector<Vec3> points;
  std::vector<Facet> facets;
  std::vector<Line> lines;
  std::vector<LegendRow> legend;
  std::string title;
  std::string metric;                                ///< what gives the colours, "" for none
  double low = 0, high = 1;                          ///< values at the ends of the scale
  bool small_is_better = false;                      ///< the good end of the scale is `low`
  Vec3 view = Vec3(1, -1, 0.7), up = Vec3::UnitZ();  ///< direction from the mesh to the eye
};

/// Colour of a value in 0 (bad) .. 1 (good).
Colour scale_colour(double goodness);
/// The i-th of a row of colours that can be told apart.
Colour row_colour(std::size_t i);
const char* row_colour_name(std::size_t i);

/// Where a picture of width x height shows what: axes of the screen (right, up, towards the eye), what is in its
/// middle, and pixels per unit. The line and the fill of a facet get darker the more it is turned away from the light.
struct PictureFrame {
  std::array<Vec3, 3> axes = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  Vec3 middle = Vec3::Zero();
  double scale = 1;
  int width = 0, height = 0;

  /// Pixels from the left, from the top, and towards the eye.
  Vec3 on_screen(const Vec3& p) const {
    return {width / 2.0 + scale * (axes[0].dot(p) - middle.x()), height / 2.0 - scale * (axes[1].dot(p) - middle.y()),
            scale * (axes[2].dot(p) - middle.z())};
  }
};
PictureFrame frame_of(const Picture& picture, int width, int height);
double shade_of(const Picture& picture, const Picture::Facet& facet, const PictureFrame& frame);

/// width * height pixels, row by row from the top; parallel projection, the same for any number of threads.
std::vector<Colour> render(const Picture& picture, int width, int height);
/// A PNG file of such pixels.
std::string png(const std::vector<Colour>& pixels, int width, int height);
/// The pictures of a GIF file (empty: none yet), and these pixels behind them; it starts again when it has ended.
/// Throws Error where `file` is not a GIF of that size, or the program was built without giflib.
std::string gif(std::string_view file, const std::vector<Colour>& pixels, int width, int height);
/// The picture as lines and areas, with its title and legend: for drawings of a few thousand faces.
std::string svg(const Picture& picture, int width, int height);

}  // namespace hextwist
