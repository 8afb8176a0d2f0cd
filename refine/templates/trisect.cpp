// The table of the trisecting pass: one template for each orbit of edge masks under the symmetries of the cube, turned
// to every mask of the orbit.
#include "hextwist/refine/templates/trisect.h"

#include <algorithm>
#include <bit>

#include "hextwist/refine/templates/trisect_internal.h"

namespace hextwist {
namespace {

/// Optimised places of the nodes inside the hex, in the order in which trisect_cube() makes them.
/// Printed by optimize_templates (optimize_trisecting.cpp).
struct InsidePlaces {
  int edge_mask;  // canonical
  std::vector<Vec3> at;
};
const std::vector<InsidePlaces>& inside_places() {
  static const std::vector<InsidePlaces> table = {
#include "trisect_places.inc"
  };
  return table;
}

void move_inside_nodes(CubeMesh& mesh, int canonical_mask) {
  const auto found = std::ranges::find(inside_places(), canonical_mask, &InsidePlaces::edge_mask);
  if (found == inside_places().end()) return;
  std::size_t i = 0;
  for (Vec3& p : mesh.points)
    if (is_inside_cube(p)) p = found->at.at(i++);
}

HexTemplate make_trisect_template(const SplitTable& table, int edge_mask) {
  std::array<std::uint8_t, n_hex_edges> edge_code;
  std::array<std::uint16_t, n_hex_faces> face_code;
  for (int e = 0; e < n_hex_edges; ++e) edge_code[e] = edge_mask >> e & 1;
  for (int f = 0; f < n_hex_faces; ++f) face_code[f] = static_cast<std::uint16_t>(trisect_face_code(edge_mask, f));
  const CubeSymmetry symmetry = to_canonical(edge_mask);
  const int canonical = symmetry.edge_mask(edge_mask);
  CubeMesh mesh = trisect_cube(canonical, TrisectPlaces{});
  move_inside_nodes(mesh, canonical);
  for (Vec3& p : mesh.points) p = symmetry.back(p);
  if (symmetry.mirrors())
    for (Hex& hex : mesh.hexes)
      for (int c = 0; c < 8; c += 2) std::swap(hex[c], hex[c + 1]);
  return make_template(table, edge_code, face_code, mesh.points, mesh.hexes);
}

}  // namespace

/// Nodes inside a face whose cut edges are the bits of `code`.
FacePattern trisect_face_pattern(int code, const TrisectPlaces& places) {
  FacePattern pattern;
  const auto rim_nodes = [&](double far_margin, double depth_here) {
    // Two nodes in front of each cut edge: about thirds of the way along, `depth_here` of the way from the edge to the
    // parallel line between `far_margin` and 1 - far_margin at that same distance.
    for (int j = 0; j < 4; ++j) {
      if (!(code >> j & 1)) continue;
      for (const double offset : {-places.spread, places.spread}) {
        const double narrowing = far_margin * depth_here;
        const double along = narrowing + (1 - 2 * narrowing) * (0.5 + offset);
        const double reach = far_margin == 0 ? depth_here : narrowing;
        const double across = j & 1 ? 1 - reach : reach;
        pattern.at.push_back(j < 2 ? std::array{along, across} : std::array{across, along});
      }
    }
  };
  const auto central_nodes = [&](double margin) {
    for (int k = 0; k < 4; ++k) pattern.at.push_back({k & 1 ? 1 - margin : margin, k & 2 ? 1 - margin : margin});
  };
  if (code == 0b1111) {
    central_nodes(1.0 / 3);
  } else if (is_corner_pattern(code)) {
    central_nodes(places.central_margin);
    rim_nodes(places.central_margin, places.depth);
  } else if (std::popcount(static_cast<unsigned>(code)) == 1) {
    rim_nodes(0, places.depth);
  }
  for (int symmetry = 0; symmetry < n_face_symmetries; ++symmetry) {
    int turned = 0;
    for (int j = 0; j < 4; ++j) {
      const double end = j & 1;
      const auto middle = turned_point(symmetry, j < 2 ? std::array{0.5, end} : std::array{end, 0.5});
      const int image = middle[0] == 0.5 ? (middle[1] == 1) : 2 + (middle[0] == 1);
      turned |= (code >> j & 1) << image;
    }
    pattern.turned[symmetry] = static_cast<std::uint16_t>(turned);
  }
  return pattern;
}

int CubeSymmetry::corner(int c) const {
  int image = 0;
  for (int b = 0; b < 3; ++b) image |= (c >> b & 1) << axis[b];
  return image ^ flip;
}

int CubeSymmetry::edge_mask(int mask) const {
  int image = 0;
  for (int e = 0; e < n_hex_edges; ++e)
    if (mask >> e & 1) image |= 1 << edge_between(corner(edge_corner(e, 0)), corner(edge_corner(e, 1)));
  return image;
}

Vec3 CubeSymmetry::back(const Vec3& q) const {
  Vec3 p;
  for (int b = 0; b < 3; ++b) p[b] = flip >> axis[b] & 1 ? 1 - q[axis[b]] : q[axis[b]];
  return p;
}

bool CubeSymmetry::mirrors() const {
  const bool odd_permutation = (axis[0] > axis[1]) != ((axis[1] > axis[2]) != (axis[0] > axis[2]));
  return odd_permutation != (std::popcount(static_cast<unsigned>(flip)) % 2 == 1);
}

CubeSymmetry to_canonical(int edge_mask) {
  CubeSymmetry best, tried;
  do {
    for (tried.flip = 0; tried.flip < 8; ++tried.flip)
      if (tried.edge_mask(edge_mask) < best.edge_mask(edge_mask)) best = tried;
  } while (std::ranges::next_permutation(tried.axis).found);
  return best;
}

int edge_mask_of_corners(int corner_mask) {
  int edges = 0;
  for (int e = 0; e < n_hex_edges; ++e)
    edges |= (corner_mask >> edge_corner(e, 0) & corner_mask >> edge_corner(e, 1) & 1) << e;
  return edges;
}

std::shared_ptr<const SplitTable> trisect_table() {
  static const std::shared_ptr<const SplitTable> table = [] {
    auto made = std::make_shared<SplitTable>(n_trisect_codes, make_trisect_template);
    made->edge = {{{}, 0}, {{1.0 / 3, 2.0 / 3}, 1}};
    for (int code = 0; code < 16; ++code) made->face.push_back(trisect_face_pattern(code, TrisectPlaces{}));
    complete_face_patterns(*made);
    return made;
  }();
  return table;
}

}  // namespace hextwist
