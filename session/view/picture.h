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

/// How values become colours: high is good, high is bad, or neither.
enum class ScaleKind { good, bad, plain };

/// Quads, lines and points in space. A line from a point to itself is a dot.
struct Picture {
  struct Facet {
    std::array<std::int32_t, 4> corners;  ///< a cycle, into points; of a triangle the last one is there twice
    std::array<Colour, 4> colours;        ///< at the corners
    std::uint8_t edges = 15;              ///< bit i: the edge from corner i to the next one is drawn
    bool is_lit = true;                   ///< false: light and shadow are in the colours
  };
  struct Line {
    Vec3 from, to;
    Colour colour;
    float width = 1;      ///< pixels of a picture of 1000
    bool on_top = false;  ///< seen through everything else
  };
  /// Stands at the first of its places that is seen and free.
  struct Label {
    std::string text;
    std::vector<Vec3> places;
  };
  struct LegendRow {
    Colour colour;
    std::string text;
  };
  /// Colours of values, for the legend.
  struct Scale {
    std::string name;  ///< of the values, "" where colours are no values
    ScaleKind kind = ScaleKind::good;
    double low = 0, high = 1;    ///< values at its ends
    double least = 0, most = 0;  ///< values of what is drawn
  };
  std::vector<Vec3> points;
  std::vector<Facet> facets;
  std::vector<Line> lines;
  std::vector<Label> labels;
  std::vector<LegendRow> legend;
  Scale scale;
  std::string caption;                               ///< stands above; "": nothing
  std::string source;                                ///< what it was drawn by
  Vec3 view = Vec3(1, -1, 0.7), up = Vec3::UnitZ();  ///< direction from the mesh to the eye
};

/// Colour of a value, as a part (0..1) of the way from the low to the high end of a scale.
Colour scale_colour(ScaleKind kind, double part);
/// The i-th of a row of colours that can be told apart.
Colour row_colour(std::size_t i);
const char* row_colour_name(std::size_t i);

/// Right, up and towards the eye.
std::array<Vec3, 3> axes_of(const Vec3& view, const Vec3& up);
/// How light a face with this normal is; both sides are alike.
double shade_of(const Vec3& normal, const std::array<Vec3, 3>& axes);

/// Where a picture of width x height shows what: axes of the screen, what is in its middle, and pixels per unit.
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

/// What lies on the side that the normal points to is taken away; facets that the plane runs through become smaller.
void clip(Picture& picture, const Vec3& normal, double distance);

/// width * height pixels, row by row from the top; parallel projection, the same for any number of threads.
std::vector<Colour> render(const Picture& picture, int width, int height);
/// A PNG file of such pixels.
std::string png(const std::vector<Colour>& pixels, int width, int height);
/// The pictures of a GIF file (empty: none yet), and these pixels behind them; it starts again when it has ended.
/// Throws Error where `file` is not a GIF of that size, or the program was built without giflib.
std::string gif(std::string_view file, const std::vector<Colour>& pixels, int width, int height);
/// The picture as lines and areas, with its caption and legend: for drawings of a few thousand faces.
std::string svg(const Picture& picture, int width, int height);

}  // namespace hextwist
