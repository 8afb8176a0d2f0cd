#include "hextwist/patch/forest_patch_internal.h"

#include <algorithm>

#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/loose_topology.h"
#include "hextwist/mesh/others.h"
#include "hextwist/refine/templates/trisect.h"

namespace hextwist {
namespace {

/// The corners at which the edges of a code end.
std::uint8_t corners_of(std::uint32_t code) {
  int mask = 0;
  for (int e = 0; e < n_hex_edges; ++e)
    if (code >> e & 1) mask |= 1 << edge_corner(e, 0) | 1 << edge_corner(e, 1);
  return static_cast<std::uint8_t>(mask);
}

/// Faces inside the mesh, between two volumes or on a surface within one, are sides of the lower hex. Where that is
/// just outside of the patch, they are sides of the hex inside here: it may be cut, and its nodes on that face belong
/// to the surface.
void add_faces_seen_from_outside(const Forest& forest, const Rings& rings, Association& part) {
  const Mesh& base = forest.base->mesh;
  const Association& whole = forest.base->association;
  if (rings.is_all || whole.surface_faces.empty() || !forest.base_corners) return;
  const auto sorted_face = [&](Side side) {
    Quad nodes = face_nodes(base.hexes[side.hex], side.face);
    std::ranges::sort(nodes);
    return nodes;
  };
  std::vector<std::pair<Side, int>> faces;
  for (std::size_t i = 0; i < rings.hexes.size(); ++i) {
    const Index h = rings.hexes[i];
    if (rings.ring[i] < rings.n_rings) continue;
    for (int f = 0; f < n_hex_faces; ++f) {
      const Quad nodes = sorted_face({h, f});
      if (std::ranges::any_of(nodes, [&](Index n) { return whole.node_owner[n].dim == 3; })) continue;
      for (const Index corner : (*forest.base_corners)[nodes[0]]) {
        const Index other = corner >> 3;
        if (other >= h || position_in(rings.hexes, other) >= 0) continue;
        for (int g = 0; g < n_hex_faces; ++g)
          if (sorted_face({other, g}) == nodes)
            if (const int surface = value_of(whole.surface_faces, whole.face_surface, Side{other, g}))
              faces.emplace_back(Side{static_cast<Index>(i), f}, surface);
      }
    }
  }
  if (faces.empty()) return;
  for (std::size_t i = 0; i < part.surface_faces.size(); ++i)
    faces.emplace_back(part.surface_faces[i], part.face_surface[i]);
  set_surface_faces(part, std::move(faces));
}

}  // namespace

void set_surface_faces(Association& association, std::vector<std::pair<Side, int>> faces) {
  std::ranges::sort(faces);
  association.surface_faces.clear();
  association.face_surface.clear();
  for (const auto& [side, surface] : faces) {
    association.surface_faces.push_back(side);
    association.face_surface.push_back(surface);
  }
}

Forest bare_forest(Forest forest) {
  const Mesh& base = forest.base->mesh;
  auto grown = std::make_shared<GrownForest>();
  grown->hexes.n_base = base.n_hexes();
  grown->next_node_id = node_id(base, base.n_nodes() - 1) + 1;
  grown->next_hex_id = highest_element_id(base) + 1;
  forest.grown = std::move(grown);
  return forest;
}

std::vector<Index> changed_roots(const LevelMarks& a, const LevelMarks& b) {
  static const CellMarks none;
  std::vector<Index> roots;
  for (std::size_t k = 0; k < std::max(a.size(), b.size()); ++k) {
    const CellMarks &one = k < a.size() ? a[k] : none, &other = k < b.size() ? b[k] : none;
    const auto add = [&](CellNumber cell) {
      const Index root = root_of({static_cast<int>(k), cell});
      if (roots.empty() || roots.back() != root) roots.push_back(root);
    };
    std::size_t i = 0, j = 0;
    while (i < one.size() || j < other.size())
      if (j == other.size() || (i < one.size() && one.cell[i] < other.cell[j])) {
        add(one.cell[i++]);
      } else if (i == one.size() || other.cell[j] < one.cell[i]) {
        add(other.cell[j++]);
      } else {
        if (one.corners[i] != other.corners[j]) add(one.cell[i]);
        ++i, ++j;
      }
  }
  return sorted_unique(std::move(roots));
}

std::vector<Index> hexes_in(const HandedHexes& hexes, std::span<const Index> roots) {
  std::vector<std::uint8_t> is_in(static_cast<std::size_t>(hexes.n_base), 0);
  std::vector<Index> result;
  for (const Index root : roots) {
    is_in[root] = 1;
    if (!std::ranges::binary_search(hexes.cut, root)) result.push_back(after_gaps(hexes.cut, root));
  }
  for (std::size_t i = 0; i < hexes.cell.size(); ++i)
    if (is_in[hexes.root_of_piece(i)]) result.push_back(hexes.n_whole() + static_cast<Index>(i));
  return result;
}

std::optional<Rings> rings_in_base(Forest& forest, std::span<const Index> nodes, int n_rings, std::size_t limit) {
  const Mesh& base = forest.base->mesh;
  if (!forest.base_corners) forest.base_corners = std::make_shared<const CompressedRows>(node_corners(base));
  return rings_around(base, nodes, n_rings, limit, [&](std::span<const Index> at, std::vector<Index>& hexes) {
    for (const Index n : at)
      for (const Index corner : (*forest.base_corners)[n]) hexes.push_back(corner >> 3);
    return true;
  });
}

ForestPatch::ForestPatch(const MeshedModel& input, const Levelling& whole, const Rings& rings, std::vector<Index> hexes)
    : patch(make_patch(input, std::move(hexes))), cells(rings.hexes) {
  const std::vector<Index>& roots = rings.hexes;
  set_ids(input.mesh, patch, patch.meshed.mesh);
  Patch of_base = make_patch(*whole.forest.base, {roots.begin(), roots.end()});
  set_ids(whole.forest.base->mesh, of_base, of_base.meshed.mesh);
  add_faces_seen_from_outside(whole.forest, rings, of_base.meshed.association);
  const GrownForest& all = *whole.forest.grown;
  auto grown = std::make_shared<GrownForest>();
  grown->next_node_id = all.next_node_id;
  grown->next_hex_id = all.next_hex_id;
  HandedHexes& local = grown->hexes;
  local.n_base = static_cast<Index>(roots.size());
  for (Index i = 0; i < local.n_base; ++i)
    if (std::ranges::binary_search(all.hexes.cut, roots[i])) local.cut.push_back(i);
  for (const Index h : patch.hexes) {
    if (h < all.hexes.n_whole()) continue;
    const auto piece = static_cast<std::size_t>(h - all.hexes.n_whole());
    const int level = all.hexes.block(piece) - 1;
    const CellNumber cell = cells.local({level, all.hexes.cell[piece]});
    local.cell.push_back(cell);
    local.origin.push_back(all.hexes.origin[piece]);
    if (rings.is_all || rings.ring[root_of({level, cell})] < rings.n_rings) continue;
    if (border.size() <= static_cast<std::size_t>(level)) border.resize(level + std::size_t{1});
    CellMarks& marks = border[level];
    if (!marks.empty() && marks.cell.back() == cell) continue;
    marks.add(cell, corners_of(all.hexes.origin[piece] >> 16 & (n_trisect_codes - 1)));
  }
  border = closed(std::move(border));
  grown->marks = with_border(all.marks);
  levelling.forest.base = std::make_shared<const MeshedModel>(std::move(of_base.meshed));
  levelling.forest.wished = cells.local(whole.forest.wished);
  levelling.forest.grown = std::move(grown);
  Overlay& overlay = levelling.overlay;
  for (std::size_t i = 0; i < whole.overlay.nodes.size(); ++i) {
    const Index n = patch.local_node(whole.overlay.nodes[i]);
    if (n < 0) continue;
    overlay.nodes.push_back(n);
    overlay.points.push_back(whole.overlay.points[i]);
    if (!whole.overlay.parameters.empty()) overlay.parameters.push_back(whole.overlay.parameters[i]);
  }
}

}  // namespace hextwist
