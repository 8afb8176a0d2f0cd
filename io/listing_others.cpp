// Elements beside the hexes in formats that list nodes and elements.
#include <map>

#include "hextwist/base/sorted.h"
#include "hextwist/io/listing.h"

namespace hextwist::io {

void Listing::add_other(const OtherType& type, std::int64_t id, int part, std::span<const std::int64_t> nodes,
                        std::string rest, bool rigid, const char* at) {
  OtherHeads& heads = others_.heads;
  const auto known = std::ranges::find(heads.types, type);
  heads.type.push_back(static_cast<int>(known - heads.types.begin()));
  if (known == heads.types.end()) heads.types.push_back(type);
  heads.ids.push_back(id);
  heads.rest.push_back(std::move(rest));
  heads.is_rigid.push_back(rigid);
  others_.parts.push_back(part);
  others_.at.push_back(at);
  others_.nodes.insert(others_.nodes.end(), nodes.begin(), nodes.end());
  others_.first.push_back(others_.nodes.size());
  dropped_ids_.push_back(id);  // groups may name it
}

void Listing::assemble_others() {
  OtherHeads& heads = others_.heads;
  if (heads.ids.empty()) return;
  Mesh& mesh = out_.mesh;
  const Ids ids(heads.ids, "element", [&](std::size_t item, const std::string& what) { fail(others_.at[item], what); });
  std::vector<Index> nodes, first = {0};
  for (std::size_t e = 0; e < heads.ids.size(); ++e) {
    if (hex_ids_.find(heads.ids[e]) >= 0)
      fail(others_.at[e], "element id " + std::to_string(heads.ids[e]) + " occurs twice");
    for (std::size_t i = others_.first[e]; i < others_.first[e + 1]; ++i)
      nodes.push_back(node(others_.nodes[i], heads.ids[e], others_.at[e]));
    first.push_back(static_cast<Index>(nodes.size()));
  }
  std::vector<Index> by_id(heads.ids.size());  // places in the file by those in ascending order of id
  for (std::size_t e = 0; e < by_id.size(); ++e)
    by_id[ids.place().empty() ? e : static_cast<std::size_t>(ids.place()[e])] = static_cast<Index>(e);
  // The block of a group or part of this id and name, which hexes may have made.
  const auto block_of = [&](int id, const std::string& name, bool is_own) {
    const Index at = position_in(mesh.blocks, id, &Block::id);
    if (at >= 0 && mesh.blocks[at].name == name) return id;
    const int own = is_own ? -1 : generated_id(name, "block");
    Block& block = group_of_id(mesh.blocks, own >= 0 ? own : at < 0 ? id : free_id(mesh.blocks));
    if (own < 0) block.name = name;
    return block.id;
  };
  std::map<int, std::vector<Index>> sets;
  for (const Group& group : groups_) {
    std::vector<Index> members;
    for (const std::int64_t id : group.elements)
      if (const Index at = ids.find(id); at >= 0) members.push_back(by_id[at]);
    if (members.empty()) continue;
    std::vector<Index>& set = sets[block_of(group.id, group.name, group.is_own)];
    set.insert(set.end(), members.begin(), members.end());
  }
  const bool grouped = !sets.empty();
  std::map<int, std::vector<Index>> of_part;
  for (std::size_t e = 0; e < others_.parts.size(); ++e)
    if (others_.parts[e] > 0) of_part[others_.parts[e]].push_back(static_cast<Index>(e));
  for (auto& [part, members] : of_part) {
    if (grouped) break;
    const auto name = part_names_.find(part);
    std::vector<Index>& set = sets[block_of(part, name == part_names_.end() ? "" : name->second, true)];
    set.insert(set.end(), members.begin(), members.end());
  }
  for (auto& [id, members] : sets) heads.sets.push_back({id, sorted_unique(std::move(members))});
  if (std::ranges::all_of(heads.rest, [](const std::string& rest) { return rest.empty(); })) heads.rest.clear();
  if (std::ranges::count(heads.is_rigid, 0) == std::ssize(heads.is_rigid)) heads.is_rigid.clear();
  mesh.others = other_elements(std::move(heads), std::move(first), std::move(nodes));
}

}  // namespace hextwist::io
