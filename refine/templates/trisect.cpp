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

#include <cstdlib>
double E(int i, double d) {
  static double v[20];
  static bool init = [] {
    for (int k = 0; k < 20; ++k) {
      char n[8];
      std::snprintf(n, 8, "E%d", k);
      const char* e = std::getenv(n);
      v[k] = e ? std::atof(e) : NAN;
    }
    return true;
  }();
  (void)init;
  return std::isnan(v[i]) ? d : v[i];
}
void fit_face(int code, double ratio, std::span<std::array<double, 2>> at, const TrisectPlaces& places) {
  std::size_t next = 0;
  const auto put = [&](double u, double v) { at[next++] = {u, v}; };
  // Two nodes in front of each cut edge: about thirds of the way along.
  const auto rim_nodes = [&](int j, double depth, double spread, std::array<double, 2> margin, bool corner) {
    for (const double offset : {-spread, spread}) {
      const double narrowing = (corner ? margin[j < 2 ? 0 : 1] : 0) * depth;
      const double along = narrowing + (1 - 2 * narrowing) * (0.5 + offset);
      const double reach = corner ? margin[j < 2 ? 1 : 0] * depth : depth;
      const double across = j & 1 ? 1 - reach : reach;
      if (j < 2)
        put(along, across);
      else
        put(across, along);
    }
  };
  if (code == 0b1111) {
    for (int k = 0; k < 4; ++k) put(k & 1 ? 2.0 / 3 : 1.0 / 3, k & 2 ? 2.0 / 3 : 1.0 / 3);
  } else if (is_corner_pattern(code)) {
    const double size = std::abs(std::log2(ratio));
    std::array<double, 2> margin = {places.central_margin, places.central_margin};
    const int longer = ratio > 1;
    margin[longer] = std::max(E(3, .22), margin[longer] - E(4, .1) * size);
    margin[!longer] = std::min(E(5, .4), margin[!longer] + E(6, .05) * size);
    for (int k = 0; k < 4; ++k) put(k & 1 ? 1 - margin[0] : margin[0], k & 2 ? 1 - margin[1] : margin[1]);
    for (int j = 0; j < 4; ++j)
      if (code >> j & 1) {
        const bool is_long = (j < 2) != (ratio > 1);
        const double depth = is_long ? std::max(E(7, .3), places.depth - E(8, .1) * size)
                                     : std::min(E(9, .8), places.depth + E(10, .05) * size);
        rim_nodes(j, depth, places.spread, margin, true);
      }
  } else if (std::popcount(static_cast<unsigned>(code)) == 1) {
    const int j = std::countr_zero(static_cast<unsigned>(code));
    const double deep = j < 2 ? ratio : 1 / ratio;
    const double depth =
        deep >= 1 ? 1 - (1 - places.depth) / deep : places.depth + (E(0, .4) - places.depth) * (1 - deep);
    const double spread = deep >= 1 ? places.spread : places.spread + (E(1, .25) - places.spread) * (1 - deep);
    rim_nodes(j, depth, spread, {}, false);
  }
}
void fit_trisect_face(int code, double ratio, std::span<std::array<double, 2>> at) {
  fit_face(code, ratio, at, TrisectPlaces{});
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
  HexTemplate made = make_template(table, edge_code, face_code, mesh.points, mesh.hexes);
  if (edge_mask != trisect_all) follow_faces(table, made);
  return made;
}

}  // namespace

/// Nodes inside a face whose cut edges are the bits of `code`.
FacePattern trisect_face_pattern(int code, const TrisectPlaces& places) {
  FacePattern pattern;
  const int n_cut = std::popcount(static_cast<unsigned>(code));
  pattern.at.resize(code == 0b1111 ? 4 : is_corner_pattern(code) ? 4 + 2 * n_cut : n_cut == 1 ? 2 : 0);
  fit_face(code, 1, pattern.at, places);
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
    made->fit_face = fit_trisect_face;
    return made;
  }();
  return table;
}

}  // namespace hextwist
