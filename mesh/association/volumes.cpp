// Hexes to volumes: faces that lie on surfaces divide the mesh into parts; the surfaces around a part tell which
// volume it is.
#include <algorithm>
#include <numeric>
#include <string>

#include "hextwist/base/large_array.h"
#include "hextwist/base/sorted.h"
#include "hextwist/base/text.h"
#include "hextwist/base/union_find.h"
#include "hextwist/mesh/association/association_internal.h"

namespace hextwist::detail {
namespace {

/// Part of each hex: hexes joined through faces that are not in `walls`. Parts are numbered by their first hex.
std::vector<Index> parts(const Mesh& mesh, const Faces& faces, std::span<const Index> walls, Index& n_parts) {
  std::vector<char> wall;
  resize_large(wall, faces.nodes.size());
  for (const Index face : walls) wall[face] = 1;
  std::vector<Index> joined = singletons(mesh.n_hexes());
  parallel_each(faces.sides.size(), [&](std::size_t face) {
    const auto& [first, second] = faces.sides[face];
    if (!wall[face] && second.hex >= 0) join(joined, first.hex, second.hex);
  });
  std::vector<Index> part, root;
  resize_for_overwrite(part, mesh.hexes.size());
  resize_for_overwrite(root, mesh.hexes.size());
  parallel_each(root.size(), [&](std::size_t hex) { root[hex] = find_root(joined, static_cast<Index>(hex)); });
  const std::vector<Index> roots = indices_where(mesh.n_hexes(), [&](Index hex) { return root[hex] == hex; });
  n_parts = static_cast<Index>(roots.size());
  for (Index i = 0; i < n_parts; ++i) joined[roots[i]] = i;  // a root's number from here on
  parallel_each(part.size(), [&](std::size_t hex) { part[hex] = joined[root[hex]]; });
  return part;
}

/// Where the surfaces leave a choice (two volumes with all the surfaces of a part), three hexes decide.
int volume_by_containment(const ModelFacts& facts, const Mesh& mesh, std::span<const Index> part, Index wanted,
                          std::span<const int> among) {
  std::vector<Index> hexes;
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    if (part[h] == wanted) hexes.push_back(h);
  std::vector<int> votes(among.size(), 0);
  for (const std::size_t i : {std::size_t{0}, hexes.size() / 2, hexes.size() - 1}) {
    Vec3 centre = Vec3::Zero();
    for (const Index node : mesh.hexes[hexes[i]]) centre += mesh.points[node] / 8;
    for (std::size_t v = 0; v < among.size(); ++v) votes[v] += facts.model.contains(among[v], centre);
  }
  return among[std::ranges::max_element(votes) - votes.begin()];
}

std::string volume_names(std::span<const int> ids) {
  return (ids.size() == 1 ? "volume " : "volumes ") + joined(ids, " and ");
}

}  // namespace

std::string match_volumes(const ModelFacts& facts, const Mesh& mesh, const Faces& faces, const Skin& skin,
                          std::span<const int> quad_surface, std::vector<int>& hex_volume) {
  if (facts.model.count(3) == 1) {
    hex_volume.clear();
    resize_large(hex_volume, mesh.hexes.size(), 1);
    return "";
  }
  Index n_parts = 0;
  const auto part = parts(mesh, faces, skin.faces, n_parts);
  std::vector<std::vector<int>> possible(n_parts);
  std::vector<Index> first_quad(n_parts, -1);
  for (Index q = 0; q < skin.n_quads(); ++q)
    for (const Side& side : faces.sides[skin.faces[q]]) {
      if (side.hex < 0) continue;
      auto& volumes = possible[part[side.hex]];
      const auto& here = facts.surface_volumes[quad_surface[q] - 1];
      if (here.empty()) continue;  // a face of the CAD that bounds nothing
      Index& first = first_quad[part[side.hex]];
      if (first < 0) {
        first = q;
        volumes = here;
        continue;
      }
      if (volumes == here) continue;
      std::vector<int> common = intersection(volumes, here);
      if (common.empty()) {
        bool shared = false;
        for (const auto& both : facts.surface_volumes)
          shared = shared || (both.size() > 1 && std::ranges::any_of(both, [&](int v) {
                                return std::ranges::find(here, v) != here.end();
                              }));
        std::string text = "hexes " + std::to_string(hex_id(mesh, skin.sides[first].hex)) + " and " +
                           std::to_string(hex_id(mesh, side.hex)) + " are joined, but lie on surface " +
                           std::to_string(quad_surface[first]) + " of " + volume_names(volumes) + " and surface " +
                           std::to_string(quad_surface[q]) + " of " + volume_names(here);
        return text + (shared ? ": the mesh does not follow the surfaces between the volumes"
                              : ", which share no surface: glue them, by 'set glue on' before the CAD is read, or "
                                "'merge all tolerance' before the mesh is, where there are gaps");
      }
      volumes = std::move(common);
    }
  std::vector<int> part_volume(n_parts), every(facts.model.count(3));
  std::iota(every.begin(), every.end(), 1);
  for (Index p = 0; p < n_parts; ++p) {
    const auto& among = possible[p].empty() ? every : possible[p];
    part_volume[p] = among.size() == 1 ? among[0] : volume_by_containment(facts, mesh, part, p, among);
  }
  resize_for_overwrite(hex_volume, mesh.hexes.size());
  parallel_each(hex_volume.size(), [&](std::size_t h) { hex_volume[h] = part_volume[part[h]]; });
  return "";
}

}  // namespace hextwist::detail
