#include "hextwist/refine/templates/uniform.h"

#include <cassert>

namespace hextwist {
namespace {

/// Local node at grid place (i, j, k) of a hex cut in `pieces` per direction.
LocalNode grid_node(const SplitTable& table, int pieces, const std::array<int, 3>& at) {
  const int n = pieces - 1;
  int ends = 0, free = 0;  // bits: axes where the place is at the high end; strictly between
  for (int axis = 0; axis < 3; ++axis) {
    ends |= (at[axis] == pieces) << axis;
    free |= (at[axis] > 0 && at[axis] < pieces) << axis;
  }
  if (free == 0) return static_cast<LocalNode>(ends);
  for (int axis = 0; axis < 3; ++axis) {
    if (free == 1 << axis) return table.edge_node(4 * axis + gather_bits(axis, ends), at[axis] - 1);
    if (free == (7 & ~(1 << axis))) {
      const int u = at[axis == 0 ? 1 : 0], v = at[axis == 2 ? 1 : 2];
      return table.face_node(2 * axis + (ends >> axis & 1), u - 1 + n * (v - 1));
    }
  }
  return table.inside_node(at[0] - 1 + n * (at[1] - 1 + n * (at[2] - 1)));
}

HexTemplate make_uniform_template(const SplitTable& table, int code, int pieces) {
  HexTemplate result;
  if (code == 0) {
    result.children.push_back({0, 1, 2, 3, 4, 5, 6, 7});
    for (int f = 0; f < n_hex_faces; ++f) result.side[f].push_back({0, static_cast<std::uint8_t>(f)});
    return result;
  }
  result.edge_code.fill(1);
  result.face_code.fill(1);
  for (int k = 1; k < pieces; ++k)
    for (int j = 1; j < pieces; ++j)
      for (int i = 1; i < pieces; ++i) result.inside.push_back(Vec3(i, j, k) / pieces);
  for (int k = 0; k < pieces; ++k)
    for (int j = 0; j < pieces; ++j)
      for (int i = 0; i < pieces; ++i) {
        const auto child = static_cast<LocalNode>(result.children.size());
        auto& nodes = result.children.emplace_back();
        for (int c = 0; c < 8; ++c)
          nodes[c] = grid_node(table, pieces, {i + (c & 1), j + (c >> 1 & 1), k + (c >> 2 & 1)});
        const std::array at = {i, j, k};
        for (int axis = 0; axis < 3; ++axis) {
          if (at[axis] == 0) result.side[2 * axis].push_back({child, static_cast<std::uint8_t>(2 * axis)});
          if (at[axis] == pieces - 1)
            result.side[2 * axis + 1].push_back({child, static_cast<std::uint8_t>(2 * axis + 1)});
        }
      }
  return result;
}

}  // namespace

std::shared_ptr<const SplitTable> uniform_table(int pieces) {
  assert(pieces >= 2 && pieces <= max_uniform_pieces);
  static std::array<std::shared_ptr<const SplitTable>, max_uniform_pieces + 1> made;
  static std::mutex making;
  const std::lock_guard lock(making);
  if (made[pieces]) return made[pieces];
  auto table = std::make_shared<SplitTable>(
      2, [pieces](const SplitTable& self, int code) { return make_uniform_template(self, code, pieces); });
  EdgePattern edge{{}, 1};
  FacePattern face;
  for (int i = 1; i < pieces; ++i) edge.at.push_back(static_cast<double>(i) / pieces);
  for (const double v : edge.at)
    for (const double u : edge.at) face.at.push_back({u, v});
  face.turned.fill(1);
  table->edge = {EdgePattern{}, edge};
  table->face = {FacePattern{}, face};
  complete_face_patterns(*table);
  return made[pieces] = table;
}

}  // namespace hextwist
