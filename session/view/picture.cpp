// Colours, light, frames and planes of pictures.
#include "hextwist/session/view/render_internal.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>

namespace hextwist {
namespace {

Colour between(const Colour& a, const Colour& b, double t) {
  Colour result;
  for (int k = 0; k < 3; ++k) result[k] = static_cast<std::uint8_t>(std::lround((1 - t) * a[k] + t * b[k]));
  return result;
}

struct Stop {
  double at;
  Colour colour;
};
constexpr Stop good_stops[] = {
    {0, {140, 25, 38}}, {0.35, {230, 115, 64}}, {0.6, {250, 217, 140}}, {0.8, {168, 214, 219}}, {1, {84, 153, 199}}};
constexpr Stop plain_stops[] = {
    {0, {68, 40, 110}}, {0.25, {59, 82, 139}}, {0.5, {33, 145, 140}}, {0.75, {94, 201, 98}}, {1, {253, 231, 37}}};

/// A corner of a facet while it is cut.
struct Corner {
  Vec3 point;
  Colour colour;
  bool is_edge;  ///< is the line to the next one drawn?
};

}  // namespace

Colour scale_colour(ScaleKind kind, double part) {
  double t = std::isfinite(part) ? std::clamp(part, 0.0, 1.0) : part > 0 ? 1.0 : 0.0;
  if (kind == ScaleKind::bad) t = 1 - t;
  const std::span<const Stop> stops = kind == ScaleKind::plain ? std::span<const Stop>(plain_stops) : good_stops;
  std::size_t i = 1;
  while (i + 1 < stops.size() && stops[i].at < t) ++i;
  return between(stops[i - 1].colour, stops[i].colour, (t - stops[i - 1].at) / (stops[i].at - stops[i - 1].at));
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

std::array<Vec3, 3> axes_of(const Vec3& view, const Vec3& up) {
  const Vec3 eye = view.normalized();
  Vec3 right = up.cross(eye);
  // Straight from above x points to the right, as on the page.
  if (right.norm() < 1e-6) right = (std::abs(eye.x()) < 0.5 ? Vec3::UnitX() : Vec3::UnitY());
  right = (right - right.dot(eye) * eye).normalized();
  return {right, eye.cross(right), eye};
}

PictureFrame frame_of(const Picture& picture, int width, int height) {
  PictureFrame frame;
  frame.width = width;
  frame.height = height;
  frame.axes = axes_of(picture.view, picture.up);
  Box seen;
  const auto add = [&](const Vec3& p) {
    seen.add(Vec3(frame.axes[0].dot(p), frame.axes[1].dot(p), frame.axes[2].dot(p)));
  };
  for (const Vec3& p : picture.points) add(p);
  for (const Picture::Line& line : picture.lines) add(line.from), add(line.to);
  if (seen.empty()) return frame;
  const Vec3 size = (seen.max - seen.min).cwiseMax(1e-12 * seen.diagonal());
  const double above = picture.caption.empty() ? 0 : 2.4 * text_size_of(width, height);  // for the caption
  frame.scale = 0.92 * std::min(width / std::max(size.x(), 1e-300), (height - above) / std::max(size.y(), 1e-300));
  if (!(frame.scale > 0 && std::isfinite(frame.scale))) frame.scale = 1;
  frame.middle = (seen.min + seen.max) / 2;
  frame.middle.y() += above / 2 / frame.scale;
  return frame;
}

double shade_of(const Vec3& normal, const std::array<Vec3, 3>& axes) {
  // Light comes from the left above the eye, as on the page (page/src/materials.js).
  const Vec3 light = (-0.25 * axes[0] + 0.45 * axes[1] + 0.9 * axes[2]).normalized();
  const double side = normal.dot(axes[2]) < 0 ? -1 : 1;
  return std::min(1.0, 0.70 + 0.32 * std::max(0.0, side * normal.dot(light)));
}

double shade_of(const Picture& picture, const Picture::Facet& facet, const PictureFrame& frame) {
  if (!facet.is_lit) return 1;
  const Vec3 a = picture.points[facet.corners[2]] - picture.points[facet.corners[0]];
  const Vec3 b = picture.points[facet.corners[3]] - picture.points[facet.corners[1]];
  Vec3 normal = a.cross(b);
  if (normal.norm() > 0) normal.normalize();
  return shade_of(normal, frame.axes);
}

void clip(Picture& picture, const Vec3& normal, double distance) {
  const auto height = [&](const Vec3& p) { return normal.dot(p) - distance; };
  std::vector<Vec3> points;
  std::vector<std::int32_t> place(picture.points.size(), -1);
  std::vector<Picture::Facet> facets;
  const auto kept = [&](std::int32_t corner) {
    std::int32_t& to = place[corner];
    if (to < 0) {
      to = static_cast<std::int32_t>(points.size());
      points.push_back(picture.points[corner]);
    }
    return to;
  };
  std::vector<Corner> ring, rest;
  for (Picture::Facet facet : picture.facets) {
    std::array<double, 4> heights;
    for (int i = 0; i < 4; ++i) heights[i] = height(picture.points[facet.corners[i]]);
    const auto [lowest, highest] = std::ranges::minmax(heights);
    if (lowest > 0) continue;
    if (highest <= 0) {
      for (std::int32_t& corner : facet.corners) corner = kept(corner);
      facets.push_back(facet);
      continue;
    }
    ring.clear();
    const bool is_triangle = facet.corners[2] == facet.corners[3];
    for (int i = 0; i < (is_triangle ? 3 : 4); ++i) {
      const int edge = is_triangle && i == 2 ? 3 : i;
      ring.push_back({picture.points[facet.corners[i]], facet.colours[i], (facet.edges >> edge & 1) != 0});
    }
    rest.clear();
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Corner &a = ring[i], &b = ring[(i + 1) % ring.size()];
      const double s = height(a.point), t = height(b.point);
      if (s <= 0) rest.push_back(a);
      if ((s <= 0) == (t <= 0)) continue;
      const double w = s / (s - t);
      // Along the plane, from where the rim leaves it to where it comes back, there is a line as well.
      rest.push_back(
          {(1 - w) * a.point + w * b.point, between(a.colour, b.colour, w), s <= 0 ? facet.edges != 0 : a.is_edge});
    }
    if (rest.size() < 3) continue;
    const auto first = static_cast<std::int32_t>(points.size());
    for (const Corner& corner : rest) points.push_back(corner.point);
    for (std::size_t i = 1; i + 1 < rest.size(); i += 2) {
      const bool is_last = i + 2 >= rest.size();
      const std::array<std::size_t, 4> of = {0, i, i + 1, is_last ? i + 1 : i + 2};
      Picture::Facet piece{.corners = {}, .colours = {}, .edges = 0, .is_lit = facet.is_lit};
      for (int k = 0; k < 4; ++k) {
        piece.corners[k] = first + static_cast<std::int32_t>(of[k]);
        piece.colours[k] = rest[of[k]].colour;
      }
      const auto edge = [&](int bit, bool drawn) { piece.edges |= static_cast<std::uint8_t>(drawn ? 1 << bit : 0); };
      edge(0, i == 1 && rest[0].is_edge);
      edge(1, rest[i].is_edge);
      if (!is_last) edge(2, rest[i + 1].is_edge);
      const std::size_t end = of[3];
      edge(3, end + 1 == rest.size() && rest[end].is_edge);
      facets.push_back(piece);
    }
  }
  picture.points = std::move(points);
  picture.facets = std::move(facets);
  for (Picture::Label& label : picture.labels)
    std::erase_if(label.places, [&](const Vec3& p) { return height(p) > 0; });
}

}  // namespace hextwist
