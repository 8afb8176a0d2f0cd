#include <algorithm>
#include <cmath>
#include <limits>

#include "hextwist/base/parallel.h"
#include "hextwist/base/text.h"
#include "hextwist/session/view/render_internal.h"
#include "hextwist/session/view/text.h"

namespace hextwist {
namespace {

constexpr int samples = 2;  // per pixel and direction
constexpr Colour background = {255, 255, 255}, ink = {40, 44, 52};
constexpr double line_shade = 0.35;  // of the edges of quads
constexpr std::size_t most_labels = 400, most_tried = 4000;

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
  const std::vector<float>& depth() const { return depth_; }

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

  /// colour: red, green, blue, 0..255.
  void set(int x, int y, double z, const Vec3& colour, double opacity = 1) {
    const std::size_t at = static_cast<std::size_t>(y) * width_ + x;
    if (z < depth_[at]) return;
    if (opacity >= 0.5) depth_[at] = static_cast<float>(z);
    for (int i = 0; i < 3; ++i)
      pixels_[at][i] = static_cast<std::uint8_t>(std::lround(opacity * colour[i] + (1 - opacity) * pixels_[at][i]));
  }

  void quad(const Picture::Facet& facet, const std::vector<Point2>& screen, int top, int bottom) {
    std::array<Point2, 4> p;
    for (int i = 0; i < 4; ++i) p[i] = screen[facet.corners[i]];
    const auto [lowest, highest] = std::ranges::minmax({p[0].y, p[1].y, p[2].y, p[3].y});
    if (highest < top || lowest > bottom) return;
    const double shade = shade_of(picture_, facet, frame_);
    std::array<Vec3, 4> colours;
    for (int i = 0; i < 4; ++i)
      colours[i] = shade * Vec3(facet.colours[i][0], facet.colours[i][1], facet.colours[i][2]);
    // Edges of small quads fade out: they would cover everything.
    const double area = (std::abs(cross(p[0], p[1], p[2])) + std::abs(cross(p[0], p[2], p[3]))) / 2;
    const double strength = std::clamp((std::sqrt(area) / samples - 2) / 6, 0.0, 1.0);
    const auto edge = [&](int i) { return (facet.edges >> i & 1) != 0; };
    const bool is_triangle = facet.corners[2] == facet.corners[3];
    triangle(p[0], p[1], p[2], {colours[0], colours[1], colours[2]}, strength,
             {edge(0), edge(1), is_triangle && edge(3)}, top, bottom);
    if (!is_triangle)
      triangle(p[0], p[2], p[3], {colours[0], colours[2], colours[3]}, strength, {false, edge(2), edge(3)}, top,
               bottom);
  }

  /// edges: which of ab, bc, ca are drawn.
  void triangle(const Point2& a, const Point2& b, const Point2& c, const std::array<Vec3, 3>& colours, double strength,
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
        const double dark = 1 - (1 - line_shade) * strength * line;
        set(x, y, u * a.z + v * b.z + w * c.z, dark * (u * colours[0] + v * colours[1] + w * colours[2]));
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
    const Vec3 colour(each.colour[0], each.colour[1], each.colour[2]);
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        const double px = x + 0.5 - a.x, py = y + 0.5 - a.y;
        const double t = square > 0 ? std::clamp((px * dx + py * dy) / square, 0.0, 1.0) : 0;
        const double opacity = std::clamp(radius + 0.5 - std::hypot(px - t * dx, py - t * dy), 0.0, 1.0);
        if (opacity > 0) set(x, y, a.z + t * (b.z - a.z) + nearer, colour, opacity);
      }
  }
};

void box(Rendered& to, double left, double top, double w, double h, const Colour& colour) {
  const auto pixel = [](double v, int most) { return static_cast<int>(std::clamp(std::round(v), 0.0, double(most))); };
  for (int y = pixel(top, to.height); y < pixel(top + h, to.height); ++y)
    for (int x = pixel(left, to.width); x < pixel(left + w, to.width); ++x)
      to.pixels[static_cast<std::size_t>(y) * to.width + x] = colour;
}

void text(Rendered& to, double x, double y, std::string_view what, double size, const Colour& colour = ink) {
  write_text(to.pixels, to.width, to.height, x, y, what, size, colour);
}

void write_legend(const Picture& picture, Rendered& to, double size) {
  const double x = 0.8 * size;
  double y = 1.6 * size;
  if (!picture.scale.name.empty()) {
    const Picture::Scale& scale = picture.scale;
    text(to, x, y, scale.name, size);
    y += 1.1 * size;
    const double tall = std::min(10 * size, to.height - y - 2 * size), wide = 1.1 * size;
    for (int i = 0; i < tall; ++i) box(to, x, y + i, wide, 1, scale_colour(scale.kind, 1 - (i + 0.5) / tall));
    for (int i = 0; i < n_scale_numbers; ++i) {
      const double part = static_cast<double>(i) / (n_scale_numbers - 1);
      text(to, x + 1.5 * wide, y + (1 - part) * tall + 0.35 * size,
           short_number(scale.low + part * (scale.high - scale.low), 4), size);
    }
    return;
  }
  for (std::size_t i = 0; i < picture.legend.size(); ++i, y += 1.4 * size) {
    if (i == most_legend_rows) {
      text(to, x, y, "and " + std::to_string(picture.legend.size() - i) + " more", size);
      break;
    }
    box(to, x, y - 0.85 * size, size, size, picture.legend[i].colour);
    text(to, x + 1.5 * size, y, picture.legend[i].text, size);
  }
}

}  // namespace

Rendered rendered(const Picture& picture, int width, int height) {
  Canvas canvas(picture, samples * width, samples * height);
  canvas.draw();
  Rendered result{width, height, std::vector<Colour>(static_cast<std::size_t>(width) * height), {}};
  result.depth.resize(result.pixels.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      std::array<int, 3> sum{};
      float depth = -std::numeric_limits<float>::infinity();
      for (int i = 0; i < samples * samples; ++i) {
        const std::size_t row = static_cast<std::size_t>(samples * y + i / samples);
        const std::size_t at = row * (samples * width) + samples * x + i % samples;
        for (int k = 0; k < 3; ++k) sum[k] += canvas.pixels()[at][k];
        depth = std::max(depth, canvas.depth()[at] / samples);
      }
      const std::size_t to = static_cast<std::size_t>(y) * width + x;
      for (int k = 0; k < 3; ++k) result.pixels[to][k] = static_cast<std::uint8_t>(sum[k] / (samples * samples));
      result.depth[to] = depth;
    }
  return result;
}

std::vector<PlacedLabel> placed_labels(const Picture& picture, const Rendered& seen, double size) {
  const PictureFrame frame = frame_of(picture, seen.width, seen.height);
  Box all;
  for (const Vec3& p : picture.points) all.add(p);
  const double slack = 0.02 * all.diagonal() * frame.scale / 2 + 3;  // lines lie before what they are on
  struct Taken {
    double x, y, half;
  };
  std::vector<Taken> taken;
  std::vector<PlacedLabel> result;
  std::size_t tried = 0;
  for (const Picture::Label& label : picture.labels) {
    if (result.size() == most_labels) break;
    const double half = text_width(label.text, size) / 2 + 0.35 * size;
    for (const Vec3& place : label.places) {
      const Vec3 at = frame.on_screen(place);
      if (at.x() < half || at.y() < size || at.x() > seen.width - half || at.y() > seen.height - size) continue;
      if (std::ranges::any_of(taken, [&](const Taken& t) {
            return std::abs(t.x - at.x()) < half + t.half && std::abs(t.y - at.y()) < 1.45 * size;
          }))
        continue;
      if (++tried > most_tried) return result;
      const std::size_t pixel = static_cast<std::size_t>(at.y()) * seen.width + static_cast<std::size_t>(at.x());
      if (seen.depth[pixel] < 1e8 && seen.depth[pixel] > at.z() + slack) continue;
      taken.push_back({at.x(), at.y(), half});
      result.push_back({label.text, at.x(), at.y()});
      break;
    }
  }
  return result;
}

double text_size_of(int width, int height) {
  return std::clamp(std::min(width, height) / 48.0, 8.0, 60.0);
}

void write_over(const Picture& picture, Rendered& to) {
  const double size = text_size_of(to.width, to.height);
  for (const PlacedLabel& label : placed_labels(picture, to, size)) {
    const double half = text_width(label.text, size) / 2;
    box(to, label.x - half - 0.25 * size, label.y - 0.62 * size, 2 * half + 0.5 * size, 1.24 * size, label_back);
    text(to, label.x - half, label.y + 0.36 * size, label.text, size, {255, 255, 255});
  }
  write_legend(picture, to, size);
  if (!picture.caption.empty())
    text(to, (to.width - text_width(picture.caption, 1.3 * size)) / 2, 1.9 * size, picture.caption, 1.3 * size);
}

std::vector<Colour> render(const Picture& picture, int width, int height) {
  Rendered result = rendered(picture, width, height);
  write_over(picture, result);
  return std::move(result.pixels);
}

}  // namespace hextwist
