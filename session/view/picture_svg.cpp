// A picture as a drawing: areas and lines from the back to the front.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "hextwist/base/text.h"
#include "hextwist/session/view/picture.h"

namespace hextwist {
namespace {

constexpr int text_size = 13, row_height = 18;

std::string colour_text(const Colour& colour, double shade = 1) {
  std::array<char, 8> text;
  std::array<unsigned, 3> c;
  for (int k = 0; k < 3; ++k) c[k] = static_cast<unsigned>(std::lround(std::clamp(shade * colour[k], 0.0, 255.0)));
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", c[0], c[1], c[2]);
  return text.data();
}

std::string number(double value) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.2f", value);
  return text.data();
}

std::string text_at(double x, double y, const std::string& text) {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\">" + markup_text(text) + "</text>\n";
}

/// Swatches with their texts, or the scale with its numbers.
std::string legend(const Picture& picture) {
  std::string result;
  double y = 20;
  if (!picture.metric.empty()) {
    result += text_at(10, y, picture.metric);
    const double good = picture.small_is_better ? picture.low : picture.high, bad = picture.low + picture.high - good;
    constexpr int n = 20;
    for (int i = 0; i < n; ++i)
      result += "<rect x=\"10\" y=\"" + number(y + 10 + 6 * i) + "\" width=\"14\" height=\"6.3\" fill=\"" +
                colour_text(scale_colour(1 - (i + 0.5) / n)) + "\"/>\n";
    for (int i = 0; i <= 4; ++i) result += text_at(30, y + 14 + 30 * i, short_number(good + (bad - good) * i / 4, 3));
  }
  for (const Picture::LegendRow& row : picture.legend) {
    result += "<rect x=\"10\" y=\"" + number(y - 11) + "\" width=\"12\" height=\"12\" fill=\"" +
              colour_text(row.colour) + "\"/>\n" + text_at(28, y, row.text);
    y += row_height;
  }
  return result;
}

}  // namespace

std::string svg(const Picture& picture, int width, int height) {
  const PictureFrame frame = frame_of(picture, width, height);
  const auto depth = [&](const Vec3& p) { return frame.axes[2].dot(p); };
  const auto place = [&](const Vec3& p) {
    const Vec3 at = frame.on_screen(p);
    return number(at.x()) + "," + number(at.y());
  };
  const std::string size = "width=\"" + std::to_string(width) + "\" height=\"" + std::to_string(height) + "\"";
  std::string result = "<svg xmlns=\"http://www.w3.org/2000/svg\" " + size + " viewBox=\"0 0 " + std::to_string(width) +
                       " " + std::to_string(height) + "\" font-family=\"sans-serif\" font-size=\"" +
                       std::to_string(text_size) + "\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n<title>" +
                       markup_text(picture.title) + "</title>\n<rect " + size + " fill=\"white\"/>\n";

  // Facets and lines by the depth of their middles; lines a little nearer, as they lie on facets.
  struct Piece {
    double depth;
    std::size_t number;
    bool is_line;
  };
  std::vector<Piece> pieces;
  const double nearer = 2.5 / frame.scale;
  for (std::size_t i = 0; i < picture.facets.size(); ++i) {
    double sum = 0;
    for (const std::int32_t corner : picture.facets[i].corners) sum += depth(picture.points[corner]) / 4;
    pieces.push_back({sum, i, false});
  }
  for (std::size_t i = 0; i < picture.lines.size(); ++i) {
    const Picture::Line& line = picture.lines[i];
    pieces.push_back({line.on_top ? 1e300 : (depth(line.from) + depth(line.to)) / 2 + nearer, i, true});
  }
  std::ranges::stable_sort(pieces, {}, &Piece::depth);
  for (const Piece& piece : pieces) {
    if (piece.is_line) {
      const Picture::Line& line = picture.lines[piece.number];
      result += "<polyline points=\"" + place(line.from) + " " + place(line.to) + "\" stroke=\"" +
                colour_text(line.colour) + "\" stroke-width=\"" +
                number(std::max(0.8, double{line.width} * std::min(width, height) / 1000.0)) + "\"/>\n";
      continue;
    }
    const Picture::Facet& facet = picture.facets[piece.number];
    const double shade = shade_of(picture, facet, frame);
    std::string points;
    for (const std::int32_t corner : facet.corners)
      points += (points.empty() ? "" : " ") + place(picture.points[corner]);
    result += "<polygon points=\"" + points + "\" fill=\"" + colour_text(facet.colour, shade) + "\" stroke=\"" +
              colour_text(facet.colour, 0.4 * shade) + "\" stroke-width=\"0.8\"/>\n";
  }
  return result + legend(picture) + "</svg>\n";
}

}  // namespace hextwist
