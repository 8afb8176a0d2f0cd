#include "floor.h"

namespace hextwist::bench {

Emitted emit_structured(int n, int pieces, bool with_mesh) {
  Emitted out;
  Split& split = out.split;
  Lineage& lineage = split.lineage;
  const int m = n * pieces, stride = m + 1;
  const std::size_t n_old = static_cast<std::size_t>(n) * n * n, n_hexes = static_cast<std::size_t>(m) * m * m;
  split.n_nodes = stride * stride * stride;
  split.hexes.reserve(n_hexes);
  split.first_child.reserve(n_old);
  split.hex_edges.reserve(n_old);
  split.hex_faces.reserve(n_old);
  lineage.parent.reserve(n_hexes);
  lineage.hexes.reserve(n_old);
  lineage.edges.reserve(3 * n_old + 6 * static_cast<std::size_t>(n) * n);
  lineage.faces.reserve(3 * n_old + 3 * static_cast<std::size_t>(n) * n);
  const auto node = [&](int i, int j, int k) { return i + stride * (j + stride * k); };
  const int pieces3 = pieces * pieces * pieces;
  for (Index z = 0, h = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x, ++h) {
        for (int k = z * pieces; k < (z + 1) * pieces; ++k)
          for (int j = y * pieces; j < (y + 1) * pieces; ++j)
            for (int i = x * pieces; i < (x + 1) * pieces; ++i) {
              const Index a = node(i, j, k), b = node(i, j, k + 1);
              split.hexes.push_back({a, a + 1, a + stride, a + stride + 1, b, b + 1, b + stride, b + stride + 1});
              lineage.parent.push_back(h);
            }
        split.first_child.push_back(h * pieces3);
        split.hex_edges.push_back({h, h, h, h, h, h, h, h, h, h, h, h});
        split.hex_faces.push_back({h, h, h, h, h, h});
        lineage.hexes.push_back({h, h * pieces3, h, 1});
        for (int axis = 0; axis < 3; ++axis) {
          lineage.edges.push_back({h, h + 1, h, h, 1});
          lineage.faces.push_back({{h, axis}, {h, h + 1, h + 2, h + 3}, h, 1});
        }
      }
  if (!with_mesh) return out;
  out.points.reserve(static_cast<std::size_t>(split.n_nodes));
  for (int k = 0; k <= m; ++k)
    for (int j = 0; j <= m; ++j)
      for (int i = 0; i <= m; ++i) out.points.emplace_back(i, j, k);
  out.hex_ids.reserve(n_hexes);
  out.block.reserve(n_hexes);
  for (std::size_t h = 0; h < n_hexes; ++h) {
    out.hex_ids.push_back(static_cast<std::int64_t>(n_old + h + 1));
    out.block.push_back(static_cast<Index>(h));
  }
  return out;
}

}  // namespace hextwist::bench
