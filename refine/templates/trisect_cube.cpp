// The trisecting templates as small meshes of the unit cube. Harris, Benzley, Owen, "Conformal refinement of
// all-hexahedral element meshes based on multiple twist plane insertion", section 4; the concave templates are ours
// (docs/design.md).
#include <bit>
#include <cmath>
#include <utility>

#include "hextwist/refine/templates/trisect_internal.h"

namespace hextwist {
namespace {

/// How the four parallel edges k (bit frame of the other two axes) of a direction are cut, in a form that the
/// templates (a), (b), (c) can use: extent[b] 0: cut at both ends of the other axis b; +1 or -1: only at its low or
/// high end, so the cut turns back across b.
struct Turn {
  bool any = false;
  bool convex = true;
  std::array<int, 2> extent{};
};

Turn turn_of(int mask4) {
  switch (mask4) {
    case 0:
      return {};
    case 0b1111:
      return {true, true, {0, 0}};
    case 0b0011:
      return {true, true, {0, +1}};
    case 0b1100:
      return {true, true, {0, -1}};
    case 0b0101:
      return {true, true, {+1, 0}};
    case 0b1010:
      return {true, true, {-1, 0}};
    case 0b0001:
      return {true, true, {+1, +1}};
    case 0b0010:
      return {true, true, {-1, +1}};
    case 0b0100:
      return {true, true, {+1, -1}};
    case 0b1000:
      return {true, true, {-1, -1}};
    default:
      return {true, false, {}};
  }
}

/// The axes other than `axis`, lower first.
std::array<int, 2> other_axes(int axis) {
  return {axis == 0 ? 1 : 0, axis == 2 ? 1 : 2};
}

/// Templates (a), (b), (c) of figure 5 in the unit cube for cuts along one axis.
CubeMesh sheet_template(int axis, const Turn& turn, const TrisectPlaces& places) {
  const auto other = other_axes(axis);
  // The place of node (step, k): step 0..3 along the axis, k over the other two; steps 1 and 2 are the new nodes.
  const auto place = [&](int step, int k) {
    Vec3 p;
    p[axis] = step / 3.0;
    for (int b = 0; b < 2; ++b) {
      const int end = k >> b & 1;
      p[other[b]] = end;
      const bool turned = (step == 1 || step == 2) && turn.extent[b] == (end == 1 ? +1 : -1);
      if (!turned) continue;
      p[other[b]] = end == 1 ? places.depth : 1 - places.depth;
      p[axis] = step == 1 ? 0.5 - places.spread : 0.5 + places.spread;
    }
    return p;
  };
  CubeMesh mesh;
  for (int step = 0; step < 3; ++step) {
    std::array<Vec3, 8> corners;
    for (int c = 0; c < 8; ++c) corners[c] = place(step + (c >> axis & 1), gather_bits(axis, c));
    mesh.add_hex(corners);
  }
  // Where the cut turns back, one more hex between the new nodes and the uncut side.
  for (int b = 0; b < 2; ++b) {
    if (turn.extent[b] == 0) continue;
    const int far = turn.extent[b] > 0 ? 1 : 0;
    std::array<Vec3, 8> corners;
    for (int c = 0; c < 8; ++c) {
      const int k = gather_bits(axis, c);
      const bool outside = (k >> b & 1) == far;
      const int k_far = (k & ~(1 << b)) | far << b;
      const int along = c >> axis & 1;
      corners[c] = outside ? place(3 * along, k) : place(1 + along, k_far);
    }
    mesh.add_hex(corners);
  }
  return mesh;
}

bool is_at(double x, int end) {
  return std::abs(x - end) < 1e-9;
}

/// Which of the four edges of a piece along an axis are cut, given which edges of the cube are. An edge in the
/// interior of a face (or of the cube) is cut when all parallel edges of the cube around it are; one that does not
/// reach from side to side never is.
int inherited_cuts(int edge_mask, int axis, const CubeMesh& mesh, const Hex& hex) {
  const auto other = other_axes(axis);
  int cuts = 0;
  for (int k = 0; k < 4; ++k) {
    const Vec3& a = mesh.points[hex[edge_corner(4 * axis + k, 0)]];
    const Vec3& b = mesh.points[hex[edge_corner(4 * axis + k, 1)]];
    bool cut = is_at(a[axis], 0) && is_at(b[axis], 1);
    for (int around = 0; around < 4; ++around) {
      bool applies = true;
      for (int i = 0; i < 2; ++i) applies &= !is_at(a[other[i]], 1 - (around >> i & 1));
      if (applies) cut &= edge_mask >> (4 * axis + around) & 1;
    }
    cuts |= cut << k;
  }
  return cuts;
}

/// The paper's templates, direction after direction.
CubeMesh convex_template(int edge_mask, const TrisectPlaces& places) {
  CubeMesh mesh;
  mesh.add_hex(unit_corners());
  for (int axis = 0; axis < 3; ++axis) {
    CubeMesh next;
    next.points = mesh.points;
    for (const Hex& hex : mesh.hexes) {
      const Turn turn = turn_of(inherited_cuts(edge_mask, axis, mesh, hex));
      if (!turn.any) {
        next.hexes.push_back(hex);
        continue;
      }
      std::array<Vec3, 8> corners;
      for (int c = 0; c < 8; ++c) corners[c] = mesh.points[hex[c]];
      add_mapped(next, sheet_template(axis, turn, places), corners);
    }
    mesh = std::move(next);
  }
  return mesh;
}

int edges_of_face(int face) {
  int edges = 0;
  for (int j = 0; j < 4; ++j) edges |= 1 << face_edge(face, j);
  return edges;
}

/// A frustum, in the unit cube, with an L or U on the given face: the face's central quad goes half-way down as a
/// block, with a block below it, and four blocks around, those at cut edges being template (c).
CubeMesh corner_frustum(int face, int edge_mask, const TrisectPlaces& places) {
  const int axis = face >> 1, outer = face & 1;
  const auto other = other_axes(axis);
  // Corner k of the quad at a level: 0 the outer face, 1 the central quad, 2 the bottom of its block, 3 the inner face.
  const auto quad = [&](int level, int k) {
    const double margin = level == 1 || level == 2 ? places.central_margin : 0;
    const double down = level == 2 ? places.central_depth : level == 3 ? 1 : 0;
    Vec3 p;
    p[axis] = outer ? 1 - down : down;
    for (int b = 0; b < 2; ++b) p[other[b]] = k >> b & 1 ? 1 - margin : margin;
    return p;
  };
  CubeMesh mesh;
  for (const auto& [upper, lower] : {std::pair{1, 2}, std::pair{2, 3}}) {
    std::array<Vec3, 8> corners;
    for (int c = 0; c < 8; ++c) corners[c] = quad((c >> axis & 1) == outer ? upper : lower, gather_bits(axis, c));
    mesh.add_hex(corners);
  }
  for (int j = 0; j < 4; ++j) {
    const int across = j < 2 ? 1 : 0;  // position in `other` of the axis from this edge to the centre
    const int side = j & 1;
    std::array<Vec3, 8> corners;
    for (int c = 0; c < 8; ++c) {
      const int k = gather_bits(axis, c);
      const bool top = (c >> axis & 1) == outer;
      const bool rim = (k >> across & 1) == side;
      const int toward = (k & ~(1 << across)) | side << across;  // the quad corner at this edge's side
      corners[c] = rim ? quad(top ? 0 : 3, toward) : quad(top ? 1 : 2, toward);
    }
    add_mapped(mesh, convex_template(edge_mask & 1 << face_edge(face, j), places), corners);
  }
  return mesh;
}

/// A smaller hex inside and a frustum under each face; one frustum alone where all cuts are on one face.
CubeMesh concave_template(int edge_mask, const TrisectPlaces& places) {
  for (int face = 0; face < n_hex_faces; ++face)
    if ((edge_mask & ~edges_of_face(face)) == 0) return corner_frustum(face, edge_mask, places);
  const auto inner = [&](int c) {
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis) p[axis] = c >> axis & 1 ? 1 - places.inner_margin : places.inner_margin;
    return p;
  };
  CubeMesh mesh;
  std::array<Vec3, 8> corners;
  for (int c = 0; c < 8; ++c) corners[c] = inner(c);
  mesh.add_hex(corners);
  for (int face = 0; face < n_hex_faces; ++face) {
    const int axis = face >> 1;
    for (int c = 0; c < 8; ++c) {
      const int on_face = (c & ~(1 << axis)) | (face & 1) << axis;
      corners[c] = c == on_face ? unit_corners()[c] : inner(on_face);
    }
    const int cuts = edge_mask & edges_of_face(face);
    add_mapped(mesh,
               is_corner_pattern(trisect_face_code(edge_mask, face)) ? corner_frustum(face, cuts, places)
                                                                     : convex_template(cuts, places),
               corners);
  }
  return mesh;
}

}  // namespace

bool is_corner_pattern(int face_code) {
  return std::popcount(static_cast<unsigned>(face_code)) == 3 ||
         (std::popcount(static_cast<unsigned>(face_code)) == 2 && face_code != 0b0011 && face_code != 0b1100);
}

int trisect_face_code(int edge_mask, int face) {
  int code = 0;
  for (int j = 0; j < 4; ++j) code |= (edge_mask >> face_edge(face, j) & 1) << j;
  return code;
}

bool is_concave_in_a_direction(int edge_mask) {
  for (int axis = 0; axis < 3; ++axis)
    if (!turn_of(edge_mask >> 4 * axis & 0b1111).convex) return true;
  return false;
}

bool is_convex(int edge_mask) {
  if (is_concave_in_a_direction(edge_mask)) return false;
  for (int face = 0; face < n_hex_faces; ++face)
    if (is_corner_pattern(trisect_face_code(edge_mask, face))) return false;
  return true;
}

CubeMesh trisect_cube(int edge_mask, const TrisectPlaces& places) {
  return is_convex(edge_mask) ? convex_template(edge_mask, places) : concave_template(edge_mask, places);
}

}  // namespace hextwist
