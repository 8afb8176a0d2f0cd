// Whether a mesh that was sound is so after a change, told from what came and what is gone.
//
// Sides with nothing behind are on the CAD: they are found among the faces that have all nodes on curves, surfaces or
// vertices, few of all. That everything else is joined as before is told by one sum (mesh/validate/boundary_sum.h): the
// hexes that came have the boundary of those that are gone, but for those sides. This is enough: where no hex is
// inverted, so many hexes cover a point as the boundary winds around it, so that two hexes on the same side of a face
// or in the same place would show there.
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/loose_topology.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/mesh/validate/boundary_sum.h"
#include "hextwist/mesh/validate/validate_parts.h"
#include "hextwist/patch/verify_internal.h"

namespace hextwist {
namespace {

Box box_of(const Mesh& mesh, const Quad& nodes) {
  Box box;
  for (const Index n : nodes) box.add(mesh.points[n]);
  return box;
}

/// Kept hexes of the part that share a node with changed ones; ascending.
std::vector<Index> kept_around(const ChangedPart& change) {
  if (change.n_kept == 0) return {};
  const Mesh& mesh = change.after.mesh;
  std::vector<std::uint8_t> near(mesh.points.size(), 0);
  mark_nodes(mesh.hexes, change.touched, near);
  for (Index h = change.n_kept; h < mesh.n_hexes(); ++h)
    for (const Index n : mesh.hexes[h]) near[n] = 1;
  return touching_hexes(std::span(mesh.hexes).first(change.n_kept), near);
}

/// A face with all nodes on vertices, curves or surfaces, of one hex: its lowest node, and the rest.
using FaceOnCad = std::pair<Index, FaceUse>;

std::vector<FaceOnCad> faces_on_cad(const MeshedModel& meshed, Index n, const auto& hex_of) {
  constexpr Index size = 4096;
  std::vector<std::vector<FaceOnCad>> of_chunk(n_chunks(n, size));
  parallel_chunks(n, size, [&](Index chunk, Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      const Index h = hex_of(i);
      const Hex& hex = meshed.mesh.hexes[h];
      unsigned on_cad = 0;
      for (int c = 0; c < n_hex_corners; ++c) on_cad |= unsigned{meshed.association.node_owner[hex[c]].dim < 3} << c;
      if (on_cad == 0) continue;
      for (int face = 0; face < n_hex_faces; ++face) {
        unsigned wanted = 0;
        for (int k = 0; k < 4; ++k) wanted |= 1U << face_corner(face, k);
        if ((on_cad & wanted) != wanted) continue;
        const Quad nodes = face_nodes(hex, face);
        const auto place = static_cast<int>(std::ranges::min_element(nodes) - nodes.begin());
        const FaceUse use({h, face}, place, nodes[place ^ 3], nodes[place ^ 1], nodes[place ^ 2]);
        of_chunk[chunk].emplace_back(nodes[place], use);
      }
    }
  });
  std::vector<FaceOnCad> all;
  for (const auto& list : of_chunk) all.insert(all.end(), list.begin(), list.end());
  tbb::parallel_sort(all.begin(), all.end());
  return all;
}

/// Sides with nothing behind of the hexes hex_of(0) to hex_of(n - 1), ascending, of those on the CAD. Nothing where
/// hexes don't fit together at one.
std::optional<std::vector<Side>> open_on_cad(const MeshedModel& meshed, Index n, const auto& hex_of) {
  const std::vector<FaceOnCad> all = faces_on_cad(meshed, n, hex_of);
  std::vector<Side> open;
  std::vector<FaceUse> of_node;
  for (std::size_t i = 0; i < all.size(); ++i) {
    of_node.push_back(all[i].second);
    if (i + 1 < all.size() && all[i + 1].first == all[i].first) continue;
    if (!faces_are_sound(of_node, open)) return std::nullopt;
    of_node.clear();
  }
  tbb::parallel_sort(open.begin(), open.end());
  return open;
}

/// Hexes of the input that were kept and have a side on the CAD near new ones, wherever in the mesh; ascending.
std::vector<Index> hexes_near_new_boundary(const ChangedPart& change) {
  Box fresh;
  double longest = 0;
  for (const Side side : change.after.association.surface_faces)
    if (side.hex >= change.n_kept) {
      const Box face = box_of(change.after.mesh, face_nodes(change.after.mesh.hexes[side.hex], side.face));
      longest = std::max(longest, face.diagonal());
      fresh.add(face);
    }
  std::vector<Index> near;
  if (fresh.empty()) return near;
  fresh.min.array() -= longest;
  fresh.max.array() += longest;
  const Mesh& mesh = change.input.mesh;
  // All boundary faces are asked: most lie beyond one side of the box, which their coordinates in one direction tell.
  const auto apart = [&](const std::array<Index, 4>& nodes, int axis) {
    const auto at = [&](int k) { return mesh.points[nodes[k]][axis]; };
    const double low = fresh.min[axis], high = fresh.max[axis];
    return (at(0) < low && at(1) < low && at(2) < low && at(3) < low) ||
           (at(0) > high && at(1) > high && at(2) > high && at(3) > high);
  };
  for (const Side side : change.input.association.surface_faces) {
    const auto nodes = face_nodes(mesh.hexes[side.hex], side.face);
    if (!apart(nodes, 0) && !apart(nodes, 1) && !apart(nodes, 2)) near.push_back(side.hex);
  }
  near.erase(std::ranges::unique(near).begin(), near.end());
  std::erase_if(near, [gone = change.whole_gone()](Index h) { return std::ranges::binary_search(gone, h); });
  return near;
}

/// A mesh of hexes of the changed part, then of others of the input.
Mesh mesh_of(const ChangedPart& change, std::span<const Index> of_part, std::span<const Index> others) {
  const Mesh &part = change.after.mesh, &input = change.input.mesh;
  Mesh mesh;
  mesh.hexes.reserve(of_part.size() + others.size());
  std::vector<Index> number(part.points.size(), -1);  // per node of the part
  const auto of_part_node = [&](Index n) {
    if (number[n] < 0) {
      number[n] = mesh.n_nodes();
      mesh.points.push_back(part.points[n]);
    }
    return number[n];
  };
  for (const Index h : of_part)
    for (Index& n : mesh.hexes.emplace_back(part.hexes[h])) n = of_part_node(n);
  // Other hexes may have nodes of the part, and of their own.
  std::vector<Index> own;
  const auto in_part = [&](Index n) { return change.nodes.empty() ? n : position_in(change.nodes, n); };
  for (const Index h : others)
    for (const Index n : input.hexes[h])
      if (in_part(n) < 0) own.push_back(n);
  sort_unique(own);
  const Index first_own = mesh.n_nodes();
  for (const Index n : own) mesh.points.push_back(input.points[n]);
  for (const Index h : others)
    for (Index& n : mesh.hexes.emplace_back(input.hexes[h])) {
      const Index there = in_part(n);
      n = there >= 0 ? of_part_node(there) : first_own + position_in(own, n);
    }
  return mesh;
}

/// Whether nodes hang in faces or edges of sides with nothing behind: of those of the part, and of kept hexes near
/// them.
bool have_joined_nodes(const ChangedPart& change, std::span<const Side> skin_of_part, std::span<const Index> kept) {
  std::vector<Index> of_part, known;
  for (const Side side : skin_of_part)
    if (of_part.empty() || of_part.back() != side.hex) of_part.push_back(side.hex);
  for (const Index h : kept) known.push_back(change.whole_hex(before_gaps(change.gone, h)));
  const std::vector<Index> others = difference(hexes_near_new_boundary(change), known);
  const Mesh mesh = mesh_of(change, of_part, others);
  std::vector<Side> skin;
  for (const Side side : skin_of_part) skin.push_back({position_in(of_part, side.hex), side.face});
  const auto first_other = static_cast<Index>(of_part.size());
  const auto& faces = change.input.association.surface_faces;
  for (std::size_t i = 0; i < others.size(); ++i)
    for (auto at = std::ranges::lower_bound(faces, Side{others[i], 0}); at != faces.end() && at->hex == others[i]; ++at)
      skin.push_back({first_other + static_cast<Index>(i), at->face});
  return has_joined_nodes(mesh, skin);
}

}  // namespace

bool is_sound(const ChangedPart& change) {
  const Mesh &before = change.before.mesh, &after = change.after.mesh;
  const Index n_kept = change.n_kept, n_new = after.n_hexes() - n_kept;
  const std::span<const Hex> fresh = std::span(after.hexes).subspan(static_cast<std::size_t>(n_kept));
  if (!are_on_eight_nodes(after, n_kept)) return false;

  const std::vector<Index> kept = kept_around(change);
  const auto n_around = static_cast<Index>(kept.size()), n_gone = static_cast<Index>(change.gone.size());
  const auto open_before = open_on_cad(change.before, n_around + n_gone, [&](Index i) {
    return i < n_around ? before_gaps(change.gone, kept[i]) : change.gone[i - n_around];
  });
  const auto open = open_on_cad(change.after, n_around + n_new,
                                [&](Index i) { return i < n_around ? kept[i] : n_kept + i - n_around; });
  if (!open_before || !open) return false;

  std::uint64_t difference = boundary_sum(fresh) - boundary_sum(before.hexes, change.gone);
  for (const Side side : *open_before)
    if (std::ranges::binary_search(change.gone, side.hex)) difference += side_number(before.hexes[side.hex], side.face);
  std::vector<Side> skin;  // what is open and not on the CAD has a neighbour that is not here, if it is of a kept hex
  for (const Side side : *open) {
    if (side.hex >= n_kept) difference -= side_number(after.hexes[side.hex], side.face);
    if (std::ranges::binary_search(change.after.association.surface_faces, side))
      skin.push_back(side);
    else if (side.hex >= n_kept)
      return false;
  }
  return difference == 0 && !have_joined_nodes(change, skin, kept);
}

}  // namespace hextwist
