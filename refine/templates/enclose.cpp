// Makes the table of the enclosing pass. Harris, Benzley, Owen, "Conformal refinement of all-hexahedral element meshes
// based on multiple twist plane insertion", section 5.
#include "hextwist/refine/templates/enclose.h"

#include <bit>
#include <stdexcept>

#include "hextwist/base/parallel.h"
#include "hextwist/refine/marks.h"
#include "hextwist/refine/templates/cube_mesh.h"
#include "hextwist/refine/templates/enclose_internal.h"

namespace hextwist {
namespace {

/// Per axis the side that the marked corners keep to (0 or 1), or -1 where they reach across.
std::array<int, 3> sides_kept(int mask) {
  std::array<int, 3> side = {-1, -1, -1};
  for (int axis = 0; axis < 3; ++axis)
    for (int at = 0; at < 2; ++at) {
      bool only = true;
      for (int c = 0; c < 8; ++c) only &= !(mask >> c & 1) || (c >> axis & 1) == at;
      if (only) side[axis] = at;
    }
  return side;
}

/// Optimised places of the new nodes. Printed by optimize_enclosing (optimize_enclosing.cpp).
constexpr EnclosePlaces places_at_half =
#include "hextwist/refine/templates/enclose_places_half.inc"
    ;
constexpr EnclosePlaces places_at_third =
#include "hextwist/refine/templates/enclose_places_third.inc"
    ;

/// Templates (a), (b), (c): a small hex at the box and one more across each direction in which the box keeps to a side.
CubeMesh box_template(int mask, const Reach& reach) {
  const std::array<int, 3> side = sides_kept(mask);
  const auto is_far = [&](int c, int axis) { return side[axis] >= 0 && (c >> axis & 1) != side[axis]; };
  const auto near_place = [&](int c) {
    const int n_far = is_far(c, 0) + is_far(c, 1) + is_far(c, 2);
    const double distance = n_far == 1 ? reach.edge : n_far == 2 ? reach.face : reach.inside;
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis) {
      const int end = c >> axis & 1;
      p[axis] = !is_far(c, axis) ? end : end == 1 ? distance : 1 - distance;
    }
    return p;
  };
  CubeMesh mesh;
  std::array<Vec3, 8> corners;
  for (int c = 0; c < 8; ++c) corners[c] = near_place(c);
  mesh.add_hex(corners);
  for (int axis = 0; axis < 3; ++axis) {
    if (side[axis] < 0) continue;
    for (int c = 0; c < 8; ++c) {
      const int flipped = c ^ 1 << axis;
      corners[c] = is_far(c, axis) ? unit_corners()[c] : near_place(flipped);
    }
    mesh.add_hex(corners);
  }
  return mesh;
}

/// Corner bits of a face in its bit frame.
int face_corner_mask(int corner_mask, int face) {
  int code = 0;
  for (int k = 0; k < 4; ++k) code |= (corner_mask >> face_corner(face, k) & 1) << k;
  return code;
}

HexTemplate make_enclose_template(const SplitTable& table, int mask, const EnclosePlaces& reach) {
  std::array<std::uint8_t, n_hex_edges> edge_code;
  std::array<std::uint16_t, n_hex_faces> face_code;
  for (int e = 0; e < n_hex_edges; ++e) {
    const bool a = mask >> edge_corner(e, 0) & 1, b = mask >> edge_corner(e, 1) & 1;
    edge_code[e] = a == b ? 0 : a ? 1 : 2;
  }
  for (int f = 0; f < n_hex_faces; ++f) face_code[f] = static_cast<std::uint16_t>(face_corner_mask(mask, f));
  CubeMesh mesh;
  if (mask == 0 || mask == 255)
    mesh.add_hex(unit_corners());
  else if (is_box_marking(mask))
    mesh = box_template(mask, reach.marked);
  else if (is_box_marking(255 & ~mask))
    mesh = box_template(255 & ~mask, reach.unmarked);
  else
    throw std::logic_error("no enclosing template for this marking");
  return make_template(table, edge_code, face_code, mesh.points, mesh.hexes);
}

FacePattern make_face_pattern(int code, const EnclosePlaces& reach) {
  FacePattern pattern;
  const int n_marked = std::popcount(static_cast<unsigned>(code));
  if (n_marked == 1 || n_marked == 3) {
    const int corner = std::countr_zero(static_cast<unsigned>(n_marked == 1 ? code : 15 & ~code));
    const double distance = n_marked == 1 ? reach.marked.face : reach.unmarked.face;
    pattern.at.push_back({corner & 1 ? 1 - distance : distance, corner & 2 ? 1 - distance : distance});
  }
  for (int symmetry = 0; symmetry < n_face_symmetries; ++symmetry) {
    int turned = 0;
    for (int k = 0; k < 4; ++k) turned |= (code >> turned_corner(symmetry, k) & 1) << k;
    pattern.turned[symmetry] = static_cast<std::uint16_t>(turned);
  }
  return pattern;
}

}  // namespace

bool is_box_marking(int mask) {
  if (mask == 0) return true;
  int low = 7, high = 0;
  for (int c = 0; c < n_hex_corners; ++c)
    if (mask >> c & 1) {
      low &= c;
      high |= c;
    }
  return std::popcount(static_cast<unsigned>(mask)) == 1 << std::popcount(static_cast<unsigned>(low ^ high));
}

bool has_enclosing_template(int mask) {
  return is_box_marking(mask) || is_box_marking(255 & ~mask);
}

std::shared_ptr<const SplitTable> make_enclose_table(const EnclosePlaces& reach) {
  auto table = std::make_shared<SplitTable>(
      256, [reach](const SplitTable& self, int mask) { return make_enclose_template(self, mask, reach); });
  table->edge = {{{}, 0}, {{reach.marked.edge}, 2}, {{1 - reach.marked.edge}, 1}};
  for (int code = 0; code < 16; ++code) table->face.push_back(make_face_pattern(code, reach));
  complete_face_patterns(*table);
  return table;
}

std::shared_ptr<const SplitTable> enclose_table(EncloseAt at) {
  static const std::array tables = {make_enclose_table(places_at_half), make_enclose_table(places_at_third)};
  return tables[at == EncloseAt::half ? 0 : 1];
}

std::shared_ptr<const SplitTable> enclose_table(double from_marked) {
  // Inner nodes a little farther out than those on edges, as at a third, and the same seen from the other side.
  const auto farther = [](double t, double by) {
    return t <= 0.5 ? t + by * t * (1 - 2 * t) : 1 - ((1 - t) + by * (1 - t) * (2 * t - 1));
  };
  const auto reach = [&](double t) { return Reach{t, farther(t, 0.6), farther(t, 0.78)}; };
  return make_enclose_table({reach(from_marked), reach(1 - from_marked)});
}

std::vector<std::uint16_t> enclose_codes(std::span<const Hex> hexes, std::span<const std::uint8_t> marked) {
  std::vector<std::uint16_t> codes(hexes.size());
  parallel_each(
      hexes.size(),
      [&](std::size_t h) {
        const int mask = corner_mask(hexes[h], marked);
        codes[h] = static_cast<std::uint16_t>(mask == 255 ? 0 : mask);
      },
      4096);
  return codes;
}

}  // namespace hextwist
