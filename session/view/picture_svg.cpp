// A picture as a drawing: areas and lines from the back to the front.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "hextwist/base/text.h"
#include "hextwist/session/view/render_internal.h"
#include "hextwist/session/view/text.h"

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

std::string text_at(double x, double y, const std::string& text, const std::string& more = {}) {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\"" + more + ">" + markup_text(text) + "</text>\n";
}

std::string box(double x, double y, double w, double h, const Colour& colour, const std::string& more = {}) {
  return "<rect x=\"" + number(x) + "\" y=\"" + number(y) + "\" width=\"" + number(w) + "\" height=\"" + number(h) +
         "\" fill=\"" + colour_text(colour) + "\"" + more + "/>\n";
}

/// Swatches with their texts, or the scale with its numbers.
std::string legend(const Picture& picture) {
  std::string result;
  double y = 20;
  if (const Picture::Scale& scale = picture.scale; !scale.name.empty()) {
    result += text_at(10, y, scale.name);
    constexpr int n = 20;
    for (int i = 0; i < n; ++i) result += box(10, y + 10 + 6 * i, 14, 6.3, scale_colour(scale.kind, 1 - (i + 0.5) / n));
    for (int i = 0; i < n_scale_numbers; ++i)
      result += text_at(30, y + 14 + 30 * i,
                        short_number(scale.high + (scale.low - scale.high) * i / (n_scale_numbers - 1), 4));
    return result;
  }
  for (std::size_t i = 0; i < picture.legend.size(); ++i, y += row_height) {
    if (i == most_legend_rows)
      return result + text_at(10, y, "and " + std::to_string(picture.legend.size() - i) + " more");
    result += box(10, y - 11, 12, 12, picture.legend[i].colour) + text_at(28, y, picture.legend[i].text);
  }
  return result;
}

/// Ids, where a renderer that knows depths says that they are seen.
std::string labels(const Picture& picture, int width, int height) {
  std::string result;
  if (picture.labels.empty()) return result;
  for (const PlacedLabel& label : placed_labels(picture, rendered(picture, width, height), text_size)) {
    const double half = 0.3 * text_size * static_cast<double>(label.text.size()) + 3;
    result += box(label.x - half, label.y - 8, 2 * half, 16, label_back, " rx=\"3\"") +
              text_at(label.x, label.y + 4.5, label.text, " text-anchor=\"middle\" fill=\"white\"");
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
                       markup_text(picture.source) + "</title>\n<rect " + size + " fill=\"white\"/>\n";

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
    std::array<double, 3> sum{};
    for (int i = 0; i < 4; ++i) {
      points += (points.empty() ? "" : " ") + place(picture.points[facet.corners[i]]);
      for (int k = 0; k < 3; ++k) sum[k] += facet.colours[i][k] / 4.0;
    }
    Colour fill;
    for (int k = 0; k < 3; ++k) fill[k] = static_cast<std::uint8_t>(std::lround(sum[k]));
    const bool all = facet.edges == 15;
    const std::string dark = colour_text(fill, 0.4 * shade);
    result += "<polygon points=\"" + points + "\" fill=\"" + colour_text(fill, shade) + "\" stroke=\"" +
              (all ? dark : colour_text(fill, shade)) + "\" stroke-width=\"0.8\"/>\n";
    for (int i = 0; i < 4 && !all; ++i)
      if (facet.edges >> i & 1)
        result += "<polyline points=\"" + place(picture.points[facet.corners[i]]) + " " +
                  place(picture.points[facet.corners[(i + 1) % 4]]) + "\" stroke=\"" + dark +
                  "\" stroke-width=\"0.8\"/>\n";
  }
  if (!picture.caption.empty())
    result += text_at(width / 2.0, 24, picture.caption, " text-anchor=\"middle\" font-size=\"17\"");
  return result + legend(picture) + labels(picture, width, height) + "</svg>\n";
}

}  // namespace hextwist
