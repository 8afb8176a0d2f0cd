#include "hextwist/parts/own_part.h"

#include <algorithm>
#include <map>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/parts/split.h"
#include "hextwist/patch/patch.h"

namespace hextwist {

OwnPart take_own(LocalMesh local, GlobalIds ids, int number, int n_parts) {
  const Mesh& mesh = local.meshed.mesh;
  std::vector<int> owner(mesh.hexes.size());
  for (Index h = 0; h < mesh.n_hexes(); ++h) owner[h] = local.owner(h);
  Borders borders = borders_of(mesh.hexes, mesh.n_nodes(), owner);
  OwnPart part;
  std::vector<Index> own = indices_where(mesh.n_hexes(), [&](Index h) { return owner[h] == number; });
  owner = {};
  Patch patch = take_patch(local.meshed, std::move(own));
  local = {};

  part.file.number = number;
  part.file.n_parts = n_parts;
  std::map<int, std::vector<Index>> nodes;
  std::map<int, std::vector<Side>> sides;
  std::vector<std::uint8_t> is_counted(patch.nodes.size(), 1);
  for (const Borders::SharedNode& shared : borders.nodes) {
    if (shared.part == number) continue;
    const Index n = patch.local_node(shared.node);
    if (n < 0) continue;
    nodes[shared.part].push_back(n);
    if (shared.part < number) is_counted[n] = 0;
  }
  for (const Borders::SharedFace& face : borders.faces)
    for (int k = 0; k < 2; ++k)
      if (face.parts[k] == number)
        sides[face.parts[1 - k]].push_back({position_in(patch.hexes, face.sides[k].hex), face.sides[k].face});
  borders = {};
  for (auto& [other, list] : nodes) part.file.nodes.push_back({other, std::move(list)});
  for (auto& [other, list] : sides) part.file.sides.push_back({other, std::move(list)});

  part.mesh = std::move(patch.meshed.mesh);
  part.association = std::move(patch.meshed.association);
  patch.meshed = {};
  part.mesh.node_ids = items_at(ids.node, patch.nodes);
  part.mesh.hex_ids = items_at(ids.hex, patch.hexes);

  part.counts = {part.mesh.n_hexes(), std::ranges::count(is_counted, 1)};
  for (const NodeSet& set : part.mesh.node_sets)
    part.counts.push_back(std::ranges::count_if(set.nodes, [&](Index n) { return is_counted[n] != 0; }));
  for (const SideSet& set : part.mesh.side_sets) part.counts.push_back(std::ssize(set.sides));
  for (const Block& block : part.mesh.blocks) part.counts.push_back(std::ssize(block.hexes));
  return part;
}

namespace {

std::span<const std::int64_t> block_sizes(const Mesh& mesh, std::span<const std::int64_t> counts) {
  return counts.last(mesh.blocks.size());
}

}  // namespace

std::vector<std::int64_t> block_shares(const OwnPart& part, std::span<const std::int64_t> counts_of_whole) {
  const BlockCounts blocks = block_counts(part.mesh, block_sizes(part.mesh, counts_of_whole));
  std::vector<std::int64_t> shares = blocks.own;
  shares.push_back(blocks.rest);
  return shares;
}

void fill_in_whole(OwnPart& part, std::span<const std::int64_t> counts, std::span<const std::int64_t> shares,
                   std::int64_t highest_id) {
  const Mesh& mesh = part.mesh;
  FilePart& file = part.file;
  file.highest_id = highest_id;
  file.n_hexes = counts[0];
  file.n_nodes = counts[1];
  const auto node_sets = counts.subspan(2, mesh.node_sets.size());
  file.node_sets.assign(node_sets.begin(), node_sets.end());
  const auto side_sets = counts.subspan(2 + mesh.node_sets.size(), mesh.side_sets.size());
  file.side_sets.assign(side_sets.begin(), side_sets.end());
  file.blocks = block_counts(mesh, block_sizes(mesh, counts));
  file.blocks.own.assign(shares.begin(), shares.end() - 1);
  file.blocks.rest = shares.back();
}

}  // namespace hextwist
