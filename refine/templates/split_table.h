// Templates as data: how a hex of each code is cut, and which nodes that puts on its edges, faces and inside.
//
// A pass gives every hex a code (0: left alone). The code fixes a code for each of its edges and faces, and a hex
// agrees with its neighbours when they come to the same codes for what they share. Since all that lies on an edge or
// face depends on that edge's or face's code alone, each hex can then be replaced without looking at any other
// (docs/design.md). There is one table per kind of pass; split() is the same for all.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "hextwist/mesh/corners.h"

namespace hextwist {

/// Local numbers of the nodes of a template: 0..7 corners; then max_edge_nodes for each edge, in the direction of the
/// edge; then max_face_nodes for each face, in the order of FacePattern; then those inside.
using LocalNode = std::uint16_t;

/// What a code means for an edge: parameters of its nodes, ascending, from its end 0.
struct EdgePattern {
  std::vector<double> at;
  std::uint8_t reversed = 0;  ///< the code of the same edge seen from its other end
};

/// The eight ways to look at a face. Symmetry s = m | swap << 2 makes corner m (bit frame) the new corner 0 and, with
/// swap, exchanges the two axes: new (u, v) = (u', v') or (v', u') where u' = m & 1 ? 1 - u : u, v' likewise.
inline constexpr int n_face_symmetries = 8;

/// What a code means for a face: nodes strictly inside, at (u, v) of its bit frame.
struct FacePattern {
  std::vector<std::array<double, 2>> at;
  std::array<std::uint16_t, n_face_symmetries> turned{};              ///< code after the symmetry
  std::array<std::vector<LocalNode>, n_face_symmetries> turned_slot;  ///< slot after the symmetry, per slot
};

struct ChildSide {
  LocalNode child = 0;
  std::uint8_t face = 0;
};

/// How a hex of one code is cut.
struct HexTemplate {
  std::array<std::uint8_t, n_hex_edges> edge_code{};
  std::array<std::uint16_t, n_hex_faces> face_code{};
  std::vector<Vec3> inside;  ///< nodes strictly inside, in the unit cube
  /// Per node inside and node inside a face (face by face): how much of its shift along each axis the inner node
  /// follows where the table fits its patterns to the cell (fitted.h). Empty: not at all.
  std::vector<Vec3> follow;
  std::vector<std::array<LocalNode, 8>> children;        ///< positively oriented
  std::array<std::vector<ChildSide>, n_hex_faces> side;  ///< children that make up each face of the parent
};

/// Most nodes inside a face of a pattern that is fitted.
inline constexpr int max_fitted_face_nodes = 10;

/// One kind of pass. Hex templates are made when first asked for.
struct SplitTable {
  int max_edge_nodes = 0;
  int max_face_nodes = 0;
  std::vector<EdgePattern> edge;
  std::vector<FacePattern> face;
  /// Moves the nodes of a face pattern to where they fit a face whose second axis is `ratio` times as long as its
  /// first; they are given where the pattern has them. Turning the face turns the result with it. Null: patterns are
  /// the same for all faces.
  void (*fit_face)(int code, double ratio, std::span<std::array<double, 2>> at) = nullptr;

  /// n_codes: hex codes are 0 .. n_codes - 1; make(code) must always return the same.
  SplitTable(int n_codes, std::function<HexTemplate(const SplitTable&, int)> make);

  /// Safe from any number of threads; the reference stays valid as long as the table.
  const HexTemplate& hex(int code) const;
  int n_codes() const { return static_cast<int>(entries_.size()); }

  LocalNode edge_node(int e, int slot) const { return static_cast<LocalNode>(8 + e * max_edge_nodes + slot); }
  LocalNode face_node(int f, int slot) const {
    return static_cast<LocalNode>(8 + n_hex_edges * max_edge_nodes + f * max_face_nodes + slot);
  }
  LocalNode inside_node(int i) const {
    return static_cast<LocalNode>(8 + n_hex_edges * max_edge_nodes + n_hex_faces * max_face_nodes + i);
  }

  /// Place of every local node of a code in the unit cube (NaN where the code does not use the number).
  std::vector<Vec3> positions(int code) const;

 private:
  std::function<HexTemplate(const SplitTable&, int)> make_;
  mutable std::vector<std::atomic<const HexTemplate*>> entries_;
  mutable std::mutex making_;
  mutable std::vector<std::unique_ptr<const HexTemplate>> made_;
};

/// The symmetry that brings the lowest node of a face to corner 0 and the lower of its two neighbours to corner 1:
/// every hex at a face finds the same frame. nodes: bit frame.
inline int face_symmetry(const std::array<Index, 4>& nodes) {
  int m = 0;
  for (int k = 1; k < 4; ++k)
    if (nodes[k] < nodes[m]) m = k;
  return m | (nodes[m ^ 2] < nodes[m ^ 1]) << 2;
}
/// Corner of the old frame that the symmetry makes corner k.
constexpr int turned_corner(int symmetry, int k) {
  const int unswapped = symmetry & 4 ? (k >> 1) | (k & 1) << 1 : k;
  return (symmetry & 3) ^ unswapped;
}
/// Where the symmetry takes a point of the face.
inline std::array<double, 2> turned_point(int symmetry, std::array<double, 2> at) {
  const double u = symmetry & 1 ? 1 - at[0] : at[0];
  const double v = symmetry & 2 ? 1 - at[1] : at[1];
  return symmetry & 4 ? std::array{v, u} : std::array{u, v};
}

/// Fills turned_slot of all face patterns from `turned` and the places of their nodes. For makers of tables.
void complete_face_patterns(SplitTable& table);

/// Fills `follow`: the nearer a node inside a face, the more (inverse fourth power of the distance).
void follow_faces(const SplitTable& table, HexTemplate& of);

/// Makes a template from a small mesh of the unit cube: names each of its nodes by where it lies, and finds the sides.
/// Throws std::logic_error when the mesh does not fit the edge and face codes. For makers of tables.
HexTemplate make_template(const SplitTable& table, const std::array<std::uint8_t, n_hex_edges>& edge_code,
                          const std::array<std::uint16_t, n_hex_faces>& face_code, const std::vector<Vec3>& points,
                          const std::vector<Hex>& hexes);

}  // namespace hextwist
