#include "hextwist/parts/split.h"

#include <algorithm>
#include <map>

#include "hextwist/base/sorted.h"
#include "hextwist/mesh/arrays.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/others.h"
#include "hextwist/patch/patch.h"

namespace hextwist {
namespace {

constexpr int nobody = -1, several = -2;

/// Per node the part that has it, if that is one.
std::vector<int> part_of_nodes(std::span<const Hex> hexes, Index n_nodes, std::span<const int> part_of_hex) {
  std::vector<int> part(static_cast<std::size_t>(n_nodes), nobody);
  for (std::size_t h = 0; h < hexes.size(); ++h)
    for (const Index n : hexes[h]) part[n] = part[n] == nobody || part[n] == part_of_hex[h] ? part_of_hex[h] : several;
  return part;
}

struct FaceUse {
  std::array<Index, 4> nodes;
  Side side;
  int part;
  auto key() const { return std::tie(nodes, part, side); }
};

}  // namespace

Borders borders_of(std::span<const Hex> hexes, Index n_nodes, std::span<const int> part_of_hex) {
  const std::vector<int> part_of_node = part_of_nodes(hexes, n_nodes, part_of_hex);
  const auto is_shared = [&](Index n) { return part_of_node[n] == several; };
  Borders borders;
  std::vector<FaceUse> uses;
  for (std::size_t h = 0; h < hexes.size(); ++h) {
    for (const Index n : hexes[h])
      if (is_shared(n)) borders.nodes.push_back({n, part_of_hex[h]});
    for (int f = 0; f < n_hex_faces; ++f) {
      auto nodes = face_nodes(hexes[h], f);
      if (!std::ranges::all_of(nodes, is_shared)) continue;
      std::ranges::sort(nodes);
      uses.push_back({{nodes[0], nodes[1], nodes[2], nodes[3]}, {static_cast<Index>(h), f}, part_of_hex[h]});
    }
  }
  sort_unique(borders.nodes);
  std::ranges::sort(uses, {}, &FaceUse::key);
  for (std::size_t i = 1; i < uses.size(); ++i)
    if (const FaceUse& a = uses[i - 1], &b = uses[i]; a.nodes == b.nodes && a.part != b.part)
      borders.faces.push_back({a.nodes, {a.side, b.side}, {a.part, b.part}});
  return borders;
}

Splitting::Splitting(const MeshedModel& whole, std::span<const int> part_of_hex, int n_parts)
    : whole_(whole),
      hexes_(static_cast<std::size_t>(n_parts)),
      borders_(borders_of(whole.mesh.hexes, whole.mesh.n_nodes(), part_of_hex)) {
  const Mesh& mesh = whole.mesh;
  if (mesh.others) throw Error("a mesh with other elements can't be split: it has " + others_text(mesh));
  for (Index h = 0; h < mesh.n_hexes(); ++h) hexes_[part_of_hex[h]].push_back(h);
  std::vector<char> used(mesh.points.size(), 0);
  for (const Hex& hex : mesh.hexes)
    for (const Index n : hex) used[n] = 1;
  n_loose_ = static_cast<Index>(std::ranges::count(used, 0));
  of_all_.n_parts = n_parts;
  of_all_.n_nodes = mesh.n_nodes() - n_loose_;
  of_all_.n_hexes = mesh.n_hexes();
  of_all_.highest_id = std::max(mesh.points.empty() ? 0 : node_id(mesh, mesh.n_nodes() - 1),
                                mesh.hexes.empty() ? 0 : hex_id(mesh, mesh.n_hexes() - 1));
  of_all_.blocks = block_counts(mesh);
  for (const NodeSet& set : mesh.node_sets)
    of_all_.node_sets.push_back(std::ranges::count_if(set.nodes, [&](Index n) { return used[n] != 0; }));
  for (const SideSet& set : mesh.side_sets) of_all_.side_sets.push_back(std::ssize(set.sides));
}

MeshPart Splitting::part(int number) const {
  const Patch patch = make_patch(whole_, hexes_[number]);
  MeshPart part{patch.meshed.mesh, of_all_};
  part.file.number = number;
  set_ids(whole_.mesh, patch, part.mesh);
  std::map<int, std::vector<Index>> nodes;
  for (auto at = borders_.nodes.begin(); at != borders_.nodes.end();) {
    const auto end =
        std::find_if(at, borders_.nodes.end(), [&](const auto& shared) { return shared.node != at->node; });
    if (std::any_of(at, end, [&](const auto& shared) { return shared.part == number; })) {
      const Index local = patch.local_node(at->node);
      for (auto other = at; other != end; ++other)
        if (other->part != number) nodes[other->part].push_back(local);
    }
    at = end;
  }
  std::map<int, std::vector<Side>> sides;
  for (const Borders::SharedFace& face : borders_.faces)
    for (int k = 0; k < 2; ++k)
      if (face.parts[k] == number)
        sides[face.parts[1 - k]].push_back({position_in(patch.hexes, face.sides[k].hex), face.sides[k].face});
  for (auto& [other, list] : nodes) part.file.nodes.push_back({other, std::move(list)});
  for (auto& [other, list] : sides) part.file.sides.push_back({other, std::move(list)});
  return part;
}

}  // namespace hextwist
