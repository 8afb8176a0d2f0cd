// Each rank writes its part.
#include <algorithm>
#include <map>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/io/file_part.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/parts/mpi/refine.h"
#include "hextwist/patch/patch.h"

namespace hextwist {
namespace {

using Key = std::array<std::int64_t, 4>;

/// The communication maps: what lies on the skin of the part and is another's too. Returns how many nodes are counted
/// by this rank: those that no rank before has; n_in_sets: the same of node sets.
std::int64_t find_shared(Ranks& ranks, const Mesh& mesh, FilePart& file) {
  std::vector<Side> sides;
  std::vector<Key> nodes;
  std::vector<std::pair<Key, Side>> faces_at;
  ranks.together([&] {
    sides = boundary_sides(faces(mesh));
    for (const Side& side : sides) {
      Key face{};
      const auto corners = face_nodes(mesh.hexes[side.hex], side.face);
      for (int k = 0; k < 4; ++k) {
        face[k] = node_id(mesh, corners[k]);
        nodes.push_back({face[k], 0, 0, 0});
      }
      std::ranges::sort(face);
      faces_at.emplace_back(face, side);
    }
    sort_unique(nodes);
    std::ranges::sort(faces_at);
  });
  const auto with_node = others_with(ranks, nodes);
  std::vector<Key> keys;
  for (const auto& [key, side] : faces_at) keys.push_back(key);
  const auto with_face = others_with(ranks, keys);

  std::map<int, std::vector<Index>> nodes_of;
  std::map<int, std::vector<Side>> sides_of;
  std::vector<std::uint8_t> is_counted(mesh.points.size(), 1);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Index n = find_node(mesh, nodes[i][0]);
    for (const int other : with_node[i]) {
      nodes_of[other].push_back(n);
      if (other < ranks.rank()) is_counted[n] = 0;
    }
  }
  for (std::size_t i = 0; i < faces_at.size(); ++i)
    for (const int other : with_face[i]) sides_of[other].push_back(faces_at[i].second);
  for (auto& [other, list] : nodes_of) file.nodes.push_back({other, std::move(list)});
  for (auto& [other, list] : sides_of) file.sides.push_back({other, std::move(list)});
  for (const NodeSet& set : mesh.node_sets)
    file.node_sets.push_back(std::ranges::count_if(set.nodes, [&](Index n) { return is_counted[n] != 0; }));
  return std::ranges::count(is_counted, 1);
}

}  // namespace

std::vector<std::string> write_in_ranks(Ranks& ranks, const InRanks& made, const std::filesystem::path& name) {
  const LocalMesh& local = made.local;
  Mesh mesh;
  ranks.together([&] {
    const std::vector<Index> own =
        indices_where(local.meshed.mesh.n_hexes(), [&](Index h) { return local.base.ring[local.base_of[h]] == 0; });
    Patch patch = make_patch(local.meshed, own);
    mesh = std::move(patch.meshed.mesh);
    mesh.node_ids = items_at(made.ids.node, patch.nodes);
    mesh.hex_ids = items_at(made.ids.hex, patch.hexes);
  });
  FilePart file;
  file.number = ranks.rank();
  file.n_parts = ranks.size();
  file.highest_id = std::max(made.ids.highest_node, made.ids.highest_hex);
  file.n_hexes = ranks.sum(mesh.n_hexes());
  file.n_nodes = ranks.sum(find_shared(ranks, mesh, file));
  file.node_sets = ranks.sum(file.node_sets);
  std::vector<std::int64_t> sizes;
  for (const SideSet& set : mesh.side_sets) sizes.push_back(std::ssize(set.sides));
  file.side_sets = ranks.sum(sizes);
  sizes.clear();
  for (const Block& block : mesh.blocks) sizes.push_back(std::ssize(block.hexes));
  sizes = ranks.sum(sizes);
  file.blocks = block_counts(mesh, sizes);
  file.blocks.own = ranks.sum(file.blocks.own);
  file.blocks.rest = ranks.sum(file.blocks.rest);

  std::vector<std::string> notices;
  std::unique_ptr<Replacement> to;
  ranks.together([&] {
    to = std::make_unique<Replacement>(part_name(name, ranks.size(), ranks.rank()), true);
    write_part(*to, mesh, file, notices);
  });
  ranks.together([&] { to->commit(); });
  return notices;
}

}  // namespace hextwist
