// A small renderer: quads with their edges and lines into a depth buffer, and the pixels into a PNG file.
#include <zlib.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "hextwist/base/parallel.h"
#include "hextwist/base/text.h"
#include "hextwist/session/view/picture.h"

namespace hextwist {
namespace {

constexpr int samples = 2;  // per pixel and direction
constexpr Colour background = {255, 255, 255};
constexpr double line_shade = 0.35;  // of the edges of quads

struct Point2 {
  double x, y, z;  // pixels from the left and from the top; z towards the eye, in pixels
};

double cross(const Point2& a, const Point2& b, const Point2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

class Canvas {
 public:
  Canvas(const Picture& picture, int width, int height)
      : picture_(picture),
        width_(width),
        height_(height),
        pixels_(static_cast<std::size_t>(width) * height, background),
        depth_(pixels_.size(), -std::numeric_limits<float>::infinity()),
        frame_(frame_of(picture, width, height)) {}

  void draw() {
    std::vector<Point2> screen(picture_.points.size());
    for (std::size_t i = 0; i < screen.size(); ++i) screen[i] = project(picture_.points[i]);
    // Bands of rows are independent of each other.
    constexpr Index band = 64;
    parallel_chunks(height_, band, [&](Index, Index begin, Index end) {
      for (const Picture::Facet& facet : picture_.facets) quad(facet, screen, begin, end);
      for (const bool on_top : {false, true})
        for (const Picture::Line& each : picture_.lines)
          if (each.on_top == on_top) line(each, begin, end);
    });
  }

  const std::vector<Colour>& pixels() const { return pixels_; }

 private:
  const Picture& picture_;
  int width_, height_;
  std::vector<Colour> pixels_;
  std::vector<float> depth_;
  const PictureFrame frame_;

  Point2 project(const Vec3& p) const {
    const Vec3 at = frame_.on_screen(p);
    return {at.x(), at.y(), at.z()};
  }

  void set(int x, int y, double z, const Colour& colour, double shade, double opacity = 1) {
    const std::size_t at = static_cast<std::size_t>(y) * width_ + x;
    if (z < depth_[at]) return;
    if (opacity >= 0.5) depth_[at] = static_cast<float>(z);
    for (int i = 0; i < 3; ++i)
      pixels_[at][i] =
          static_cast<std::uint8_t>(std::lround(opacity * shade * colour[i] + (1 - opacity) * pixels_[at][i]));
  }

  void quad(const Picture::Facet& facet, const std::vector<Point2>& screen, int top, int bottom) {
    std::array<Point2, 4> p;
    for (int i = 0; i < 4; ++i) p[i] = screen[facet.corners[i]];
    const auto [lowest, highest] = std::ranges::minmax({p[0].y, p[1].y, p[2].y, p[3].y});
    if (highest < top || lowest > bottom) return;
    const double shade = shade_of(picture_, facet, frame_);
    // Edges of small quads fade out: they would cover everything.
    const double area = (std::abs(cross(p[0], p[1], p[2])) + std::abs(cross(p[0], p[2], p[3]))) / 2;
    const double strength = std::clamp((std::sqrt(area) / samples - 2) / 6, 0.0, 1.0);
    triangle(p[0], p[1], p[2], facet.colour, shade, strength, {true, true, false}, top, bottom);
    triangle(p[0], p[2], p[3], facet.colour, shade, strength, {false, true, true}, top, bottom);
  }

  /// edges: which of ab, bc, ca are drawn.
  void triangle(const Point2& a, const Point2& b, const Point2& c, const Colour& colour, double shade, double strength,
                const std::array<bool, 3>& edges, int top, int bottom) {
    const double area = cross(a, b, c);
    if (!(std::abs(area) > 1e-9)) return;
    const int x0 = std::max(0, static_cast<int>(std::floor(std::min({a.x, b.x, c.x}))));
    const int x1 = std::min(width_ - 1, static_cast<int>(std::ceil(std::max({a.x, b.x, c.x}))));
    const int y0 = std::max(top, static_cast<int>(std::floor(std::min({a.y, b.y, c.y}))));
    const int y1 = std::min(bottom - 1, static_cast<int>(std::ceil(std::max({a.y, b.y, c.y}))));
    // Weight of a corner times this is the distance from the opposite edge.
    const auto height = [&](const Point2& p, const Point2& q) {
      return std::abs(area) / std::hypot(p.x - q.x, p.y - q.y);
    };
    const std::array<double, 3> heights = {height(b, c), height(c, a), height(a, b)};
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        const Point2 p = {x + 0.5, y + 0.5, 0};
        const double u = cross(b, c, p) / area, v = cross(c, a, p) / area, w = 1 - u - v;
        if (u < 0 || v < 0 || w < 0) continue;
        double line = 0;
        const auto near = [&](bool drawn, double distance) {
          if (drawn) line = std::max(line, std::clamp(1.2 * samples / 2 + 0.5 - distance, 0.0, 1.0));
        };
        near(edges[0], w * heights[2]);
        near(edges[1], u * heights[0]);
        near(edges[2], v * heights[1]);
        set(x, y, u * a.z + v * b.z + w * c.z, colour, shade * (1 - (1 - line_shade) * strength * line));
      }
  }

  void line(const Picture::Line& each, int top, int bottom) {
    const Point2 a = project(each.from), b = project(each.to);
    const double radius = std::max(0.6, double{each.width} * std::min(width_, height_) / 1000.0 / 2);
    const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
    const double nearer = each.on_top ? 1e9 : 2 * radius + 1;  // in front of the quads that it lies on
    const int x0 = std::max(0, static_cast<int>(std::min(a.x, b.x) - radius - 1));
    const int x1 = std::min(width_ - 1, static_cast<int>(std::max(a.x, b.x) + radius + 1));
    const int y0 = std::max(top, static_cast<int>(std::min(a.y, b.y) - radius - 1));
    const int y1 = std::min(bottom - 1, static_cast<int>(std::max(a.y, b.y) + radius + 1));
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        const double px = x + 0.5 - a.x, py = y + 0.5 - a.y;
        const double t = square > 0 ? std::clamp((px * dx + py * dy) / square, 0.0, 1.0) : 0;
        const double opacity = std::clamp(radius + 0.5 - std::hypot(px - t * dx, py - t * dy), 0.0, 1.0);
        if (opacity > 0) set(x, y, a.z + t * (b.z - a.z) + nearer, each.colour, 1, opacity);
      }
  }
};

void append_number(std::string& to, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) to += static_cast<char>(value >> shift & 0xff);
}

void append_chunk(std::string& to, const std::string& name, const std::string& data) {
  append_number(to, static_cast<std::uint32_t>(data.size()));
  const std::string body = name + data;
  to += body;
  append_number(to, static_cast<std::uint32_t>(
                        crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()))));
}

/// Rows of squares, five high, for the numbers beside the scale.
struct Glyph {
  char character;
  std::array<std::uint8_t, 5> rows;  // three bits each
};
constexpr Glyph glyphs[] = {{'0', {7, 5, 5, 5, 7}}, {'1', {2, 6, 2, 2, 7}}, {'2', {7, 1, 7, 4, 7}},
                            {'3', {7, 1, 7, 1, 7}}, {'4', {5, 5, 7, 1, 1}}, {'5', {7, 4, 7, 1, 7}},
                            {'6', {7, 4, 7, 5, 7}}, {'7', {7, 1, 2, 2, 2}}, {'8', {7, 5, 7, 5, 7}},
                            {'9', {7, 5, 7, 1, 7}}, {'.', {0, 0, 0, 0, 2}}, {'-', {0, 0, 7, 0, 0}},
                            {'+', {0, 2, 7, 2, 0}}, {'e', {0, 7, 7, 4, 7}}};

class Labels {
 public:
  Labels(std::vector<Colour>& pixels, int width, int height) : pixels_(pixels), width_(width), height_(height) {}

  void box(int x0, int y0, int w, int h, const Colour& colour) {
    for (int y = std::max(0, y0); y < std::min(height_, y0 + h); ++y)
      for (int x = std::max(0, x0); x < std::min(width_, x0 + w); ++x)
        pixels_[static_cast<std::size_t>(y) * width_ + x] = colour;
  }
  void number(int x, int y, int size, double value) {
    for (const char c : short_number(value, 3)) {
      for (const Glyph& glyph : glyphs)
        if (glyph.character == c)
          for (int row = 0; row < 5; ++row)
            for (int column = 0; column < 3; ++column)
              if (glyph.rows[row] >> (2 - column) & 1) box(x + column * size, y + row * size, size, size, {60, 60, 60});
      x += 4 * size;
    }
  }

 private:
  std::vector<Colour>& pixels_;
  int width_, height_;
};

/// Colours from bad (below) to good (above) at the left, with the numbers at the ends.
void draw_scale(const Picture& picture, std::vector<Colour>& pixels, int width, int height) {
  if (picture.metric.empty()) return;
  const int unit = std::max(1, std::min(width, height) / 300);
  const int x = 6 * unit, top = 12 * unit, long_side = std::min(height - 24 * unit, 120 * unit);
  Labels labels(pixels, width, height);
  for (int y = 0; y < long_side; ++y)
    labels.box(x, top + y, 8 * unit, 1, scale_colour(1 - static_cast<double>(y) / long_side));
  const double good = picture.small_is_better ? picture.low : picture.high;
  labels.number(x + 11 * unit, top - 2 * unit, unit, good);
  labels.number(x + 11 * unit, top + long_side - 3 * unit, unit, picture.low + picture.high - good);
}

}  // namespace

Colour scale_colour(double goodness) {
  struct Stop {
    double at;
    std::array<double, 3> colour;
  };
  constexpr Stop stops[] = {
      {0, {140, 25, 38}}, {0.35, {230, 115, 64}}, {0.6, {250, 217, 140}}, {0.8, {168, 214, 219}}, {1, {84, 153, 199}}};
  const double g = std::isfinite(goodness) ? std::clamp(goodness, 0.0, 1.0) : 0;
  std::size_t i = 1;
  while (i + 1 < std::size(stops) && stops[i].at < g) ++i;
  const double t = (g - stops[i - 1].at) / (stops[i].at - stops[i - 1].at);
  Colour result;
  for (int k = 0; k < 3; ++k)
    result[k] = static_cast<std::uint8_t>(std::lround((1 - t) * stops[i - 1].colour[k] + t * stops[i].colour[k]));
  return result;
}

Colour row_colour(std::size_t i) {
  constexpr Colour colours[] = {{133, 176, 212}, {236, 165, 96},  {148, 196, 133}, {212, 128, 136}, {176, 158, 207},
                                {222, 205, 120}, {119, 190, 190}, {205, 150, 190}, {170, 150, 125}, {160, 168, 178}};
  return colours[i % std::size(colours)];
}

const char* row_colour_name(std::size_t i) {
  constexpr const char* names[] = {"blue",   "orange", "green", "red",   "violet",
                                   "yellow", "teal",   "pink",  "brown", "grey"};
  return names[i % std::size(names)];
}

PictureFrame frame_of(const Picture& picture, int width, int height) {
  PictureFrame frame;
  frame.width = width;
  frame.height = height;
  const Vec3 eye = picture.view.normalized();
  Vec3 right = picture.up.cross(eye);
  if (right.norm() < 1e-6) right = (std::abs(eye.x()) < 0.5 ? Vec3::UnitX() : Vec3::UnitY()).cross(eye);
  frame.axes = {right.normalized(), eye.cross(right.normalized()), eye};
  Box seen;
  const auto add = [&](const Vec3& p) {
    seen.add(Vec3(frame.axes[0].dot(p), frame.axes[1].dot(p), frame.axes[2].dot(p)));
  };
  for (const Vec3& p : picture.points) add(p);
  for (const Picture::Line& line : picture.lines) add(line.from), add(line.to);
  if (seen.empty()) return frame;
  const Vec3 size = (seen.max - seen.min).cwiseMax(1e-12 * seen.diagonal());
  frame.scale = 0.92 * std::min(width / std::max(size.x(), 1e-300), height / std::max(size.y(), 1e-300));
  if (!std::isfinite(frame.scale)) frame.scale = 1;
  frame.middle = (seen.min + seen.max) / 2;
  return frame;
}

double shade_of(const Picture& picture, const Picture::Facet& facet, const PictureFrame& frame) {
  // Light comes from the left above the eye.
  const Vec3 a = picture.points[facet.corners[2]] - picture.points[facet.corners[0]];
  const Vec3 b = picture.points[facet.corners[3]] - picture.points[facet.corners[1]];
  Vec3 normal = a.cross(b);
  if (normal.norm() > 0) normal.normalize();
  if (normal.dot(frame.axes[2]) < 0) normal = -normal;
  const Vec3 light = (-0.35 * frame.axes[0] + 0.5 * frame.axes[1] + 0.8 * frame.axes[2]).normalized();
  return 0.68 + 0.32 * std::max(0.0, normal.dot(light));
}

std::vector<Colour> render(const Picture& picture, int width, int height) {
  Canvas canvas(picture, samples * width, samples * height);
  canvas.draw();
  std::vector<Colour> result(static_cast<std::size_t>(width) * height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int k = 0; k < 3; ++k) {
        int sum = 0;
        for (int i = 0; i < samples * samples; ++i) {
          const std::size_t row = static_cast<std::size_t>(samples * y + i / samples);
          sum += canvas.pixels()[row * (samples * width) + samples * x + i % samples][k];
        }
        result[static_cast<std::size_t>(y) * width + x][k] = static_cast<std::uint8_t>(sum / (samples * samples));
      }
  draw_scale(picture, result, width, height);
  return result;
}

std::string png(const std::vector<Colour>& pixels, int width, int height) {
  std::string rows;
  rows.reserve(pixels.size() * 3 + height);
  for (int y = 0; y < height; ++y) {
    // Each byte as its difference from the one above ("up"), which packs flat colours well.
    rows += '\2';
    for (int x = 0; x < width; ++x)
      for (int k = 0; k < 3; ++k) {
        const std::size_t at = static_cast<std::size_t>(y) * width + x;
        rows += static_cast<char>(pixels[at][k] - (y > 0 ? pixels[at - width][k] : 0));
      }
  }
  uLongf size = compressBound(static_cast<uLong>(rows.size()));
  std::string packed(size, '\0');
  compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(rows.data()),
            static_cast<uLong>(rows.size()), 6);
  packed.resize(size);
  std::string header;
  append_number(header, static_cast<std::uint32_t>(width));
  append_number(header, static_cast<std::uint32_t>(height));
  header += std::string("\10\2\0\0\0", 5);  // eight bits, red green blue, the usual everything else
  std::string file = "\x89PNG\r\n\x1a\n";
  append_chunk(file, "IHDR", header);
  append_chunk(file, "IDAT", packed);
  append_chunk(file, "IEND", "");
  return file;
}

}  // namespace hextwist
