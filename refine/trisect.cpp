// Makes the table of the trisecting pass. Harris, Benzley, Owen, "Conformal refinement of all-hexahedral element
// meshes based on multiple twist plane insertion", section 4; the concave templates are ours (docs/design.md).
#include "hextwist/refine/trisect.h"

#include <bit>
#include <cmath>
#include <utility>

#include "hextwist/refine/cube_mesh.h"

namespace hextwist {
namespace {

// Where the nodes of templates go in the unit cube.
constexpr double depth = 0.66;              // how far the inner nodes of the one-edge pattern lie across the face
constexpr double inner_margin = 0.3;        // the inner hex of concave templates is [m, 1 - m]^3
constexpr double central_margin = 1.0 / 3;  // the central quad of L and U patterns is [m, 1 - m]^2
constexpr double central_depth = 0.5;       // how far down its block goes in the frustum

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
CubeMesh sheet_template(int axis, const Turn& turn) {
  const auto other = other_axes(axis);
  // The place of node (step, k): step 0..3 along the axis, k over the other two; steps 1 and 2 are the new nodes.
  const auto place = [&](int step, int k) {
    Vec3 p;
    p[axis] = step / 3.0;
    for (int b = 0; b < 2; ++b) {
      const int end = k >> b & 1;
      double at = end;
      if ((step == 1 || step == 2) && turn.extent[b] == +1 && end == 1) at = depth;
      if ((step == 1 || step == 2) && turn.extent[b] == -1 && end == 0) at = 1 - depth;
      p[other[b]] = at;
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
CubeMesh convex_template(int edge_mask) {
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
      add_mapped(next, sheet_template(axis, turn), corners);
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

bool is_corner_pattern(int face_code) {  // L or U
  return std::popcount(static_cast<unsigned>(face_code)) == 3 ||
         (std::popcount(static_cast<unsigned>(face_code)) == 2 && face_code != 0b0011 && face_code != 0b1100);
}

/// A frustum, in the unit cube, with an L or U on the given face: the face's central quad goes half-way down as a
/// block, with a block below it, and four blocks around, those at cut edges being template (c).
CubeMesh corner_frustum(int face, int edge_mask) {
  const int axis = face >> 1, outer = face & 1;
  const auto other = other_axes(axis);
  // Corner k of the quad at a level: 0 the outer face, 1 the central quad, 2 the bottom of its block, 3 the inner face.
  const auto quad = [&](int level, int k) {
    const double margin = level == 1 || level == 2 ? central_margin : 0;
    const double down = level == 2 ? central_depth : level == 3 ? 1 : 0;
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
    add_mapped(mesh, convex_template(edge_mask & 1 << face_edge(face, j)), corners);
  }
  return mesh;
}

/// A smaller hex inside and a frustum under each face; one frustum alone where all cuts are on one face.
CubeMesh concave_template(int edge_mask) {
  for (int face = 0; face < n_hex_faces; ++face)
    if ((edge_mask & ~edges_of_face(face)) == 0) return corner_frustum(face, edge_mask);
  const auto inner = [](int c) {
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis) p[axis] = c >> axis & 1 ? 1 - inner_margin : inner_margin;
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
    add_mapped(
        mesh,
        is_corner_pattern(trisect_face_code(edge_mask, face)) ? corner_frustum(face, cuts) : convex_template(cuts),
        corners);
  }
  return mesh;
}

HexTemplate make_trisect_template(const SplitTable& table, int edge_mask) {
  std::array<std::uint8_t, n_hex_edges> edge_code;
  std::array<std::uint16_t, n_hex_faces> face_code;
  for (int e = 0; e < n_hex_edges; ++e) edge_code[e] = edge_mask >> e & 1;
  for (int f = 0; f < n_hex_faces; ++f) face_code[f] = static_cast<std::uint16_t>(trisect_face_code(edge_mask, f));
  const CubeMesh mesh = is_convex(edge_mask) ? convex_template(edge_mask) : concave_template(edge_mask);
  return make_template(table, edge_code, face_code, mesh.points, mesh.hexes);
}

/// Nodes inside a face whose cut edges are the bits of `code`.
FacePattern make_face_pattern(int code) {
  FacePattern pattern;
  const auto rim_nodes = [&](double far_margin, double depth_here) {
    // Two nodes in front of each cut edge: at thirds of the way along, `depth_here` of the way from the edge to the
    // parallel line between `far_margin` and 1 - far_margin at that same distance.
    for (int j = 0; j < 4; ++j) {
      if (!(code >> j & 1)) continue;
      for (int third = 1; third <= 2; ++third) {
        const double narrowing = far_margin * depth_here;
        const double along = narrowing + (1 - 2 * narrowing) * third / 3;
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
    central_nodes(central_margin);
    rim_nodes(central_margin, depth);
  } else if (std::popcount(static_cast<unsigned>(code)) == 1) {
    rim_nodes(0, depth);
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

}  // namespace

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
    for (int code = 0; code < 16; ++code) made->face.push_back(make_face_pattern(code));
    complete_face_patterns(*made);
    return made;
  }();
  return table;
}

}  // namespace hextwist
