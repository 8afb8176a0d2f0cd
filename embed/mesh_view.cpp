#include "hextwist/embed/mesh_view.h"

#include <algorithm>
#include <numeric>

#include "hextwist/mesh/corners.h"

namespace hextwist {
namespace {

std::vector<Quad> cycles(const Mesh& mesh, std::span<const Side> sides) {
  std::vector<Quad> quads;
  quads.reserve(sides.size());
  for (const Side side : sides) quads.push_back(face_node_cycle(mesh.hexes[side.hex], side.face));
  return quads;
}

std::vector<std::int64_t> counted_ids(std::size_t n) {
  std::vector<std::int64_t> ids(n);
  std::iota(ids.begin(), ids.end(), std::int64_t{1});
  return ids;
}

}  // namespace

std::span<const Hex> MeshView::file_hexes() const {
  std::call_once(hexes_.once, [&] {
    std::vector<Hex> hexes(mesh().hexes.size());
    for (std::size_t h = 0; h < hexes.size(); ++h)
      for (int c = 0; c < n_hex_corners; ++c) hexes[h][c] = mesh().hexes[h][file_corner[c]];
    hexes_.values = std::move(hexes);
  });
  return hexes_.values;
}

std::span<const std::int64_t> MeshView::node_ids() const {
  if (!mesh().node_ids.empty()) return mesh().node_ids;
  std::call_once(node_ids_.once, [&] { node_ids_.values = counted_ids(mesh().points.size()); });
  return node_ids_.values;
}

std::span<const std::int64_t> MeshView::hex_ids() const {
  if (!mesh().hex_ids.empty()) return mesh().hex_ids;
  std::call_once(hex_ids_.once, [&] { hex_ids_.values = counted_ids(mesh().hexes.size()); });
  return hex_ids_.values;
}

std::span<const Quad> MeshView::surface_quads() const {
  std::call_once(surface_quads_.once,
                 [&] { surface_quads_.values = cycles(mesh(), meshed().association.surface_faces); });
  return surface_quads_.values;
}

std::span<const Quad> MeshView::set_quads(std::size_t side_set) const {
  std::call_once(set_quads_.once, [&] {
    std::vector<std::vector<Quad>> quads;
    for (const SideSet& set : mesh().side_sets) quads.push_back(cycles(mesh(), set.sides));
    set_quads_.values = std::move(quads);
  });
  return set_quads_.values.at(side_set);
}

std::vector<std::int32_t> MeshView::surfaces_of(std::span<const Quad> quads) const {
  std::call_once(surface_of_quad_.once, [&] {
    const std::span<const Quad> known = surface_quads();
    std::vector<std::pair<Quad, std::int32_t>> table(known.size());
    for (std::size_t i = 0; i < known.size(); ++i) {
      table[i] = {known[i], meshed().association.face_surface[i]};
      std::ranges::sort(table[i].first);
    }
    std::ranges::sort(table);
    surface_of_quad_.values = std::move(table);
  });
  std::vector<std::int32_t> surfaces;
  surfaces.reserve(quads.size());
  for (Quad quad : quads) {
    std::ranges::sort(quad);
    const auto found = std::ranges::lower_bound(surface_of_quad_.values, std::pair{quad, std::int32_t{0}});
    surfaces.push_back(found != surface_of_quad_.values.end() && found->first == quad ? found->second : 0);
  }
  return surfaces;
}

}  // namespace hextwist
