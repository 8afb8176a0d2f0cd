// Sets of Exodus II.
#include "hextwist/io/exodus/reader_internal.h"

namespace hextwist::io {

std::pair<std::vector<int>, std::vector<int>> ExodusReader::set(ex_entity_type type, std::int64_t id) const {
  const std::string name = "set " + std::to_string(id);
  int n = 0, n_factors = 0;
  check(ex_get_set_param(file_.id, type, id, &n, &n_factors), name);
  std::pair<Ints, Ints> result;
  result.first.resize(size(n, "members"));
  result.second.resize(type == EX_SIDE_SET ? result.first.size() : 0);
  if (n > 0)
    check(ex_get_set(file_.id, type, id, result.first.data(), type == EX_SIDE_SET ? result.second.data() : nullptr),
          name);
  return result;
}

void ExodusReader::side_sets() {
  for (const std::int64_t id : ids(EX_SIDE_SET, init_.num_side_sets)) {
    const std::string who = "side set " + std::to_string(id);
    SideSet& to = group_of_id(out_.mesh.side_sets, group_id(EX_SIDE_SET, id));
    to.name = group_name(EX_SIDE_SET, id);
    const auto [elements, sides] = set(EX_SIDE_SET, id);
    std::int64_t dropped = 0;
    std::vector<std::pair<Index, int>> others;
    for (std::size_t i = 0; i < elements.size(); ++i) {
      const Index h = hex(elements[i], who);
      if (h >= 0 && (sides[i] < 1 || sides[i] > 6)) fail(who + " names side " + std::to_string(sides[i]));
      const Index other = h < 0 ? other_of(elements[i] - 1) : -1;
      if (h >= 0)
        to.sides.push_back({h, exodus_face[sides[i] - 1]});
      else if (other >= 0)
        others.emplace_back(other, sides[i]);
      else if (!is_elsewhere(elements[i]))
        ++dropped;
    }
    sort_unique(to.sides);
    sort_unique(others);
    if (!others.empty()) {
      OtherSides& list = heads_.sides.emplace_back();
      list.id = to.id;
      for (const auto& [element, side] : others) {
        list.elements.push_back(element);
        list.sides.push_back(std::to_string(side));
        if (is_face_of_shell(heads_.types[heads_.type[element]], side)) continue;
        heads_.is_rigid.resize(heads_.ids.size(), 0);
        heads_.is_rigid[element] = 1;
      }
    }
    if (dropped)
      out_.notices.push_back(who + ": dropped " + std::to_string(dropped) + " sides that are not sides of a hex");
  }
}

void ExodusReader::node_sets() {
  for (const std::int64_t id : ids(EX_NODE_SET, init_.num_node_sets)) {
    NodeSet& to = group_of_id(out_.mesh.node_sets, group_id(EX_NODE_SET, id));
    to.name = group_name(EX_NODE_SET, id);
    for (const std::int64_t position : set(EX_NODE_SET, id).first)
      if (const Index n = node(position, "node set " + std::to_string(id)); n >= 0) to.nodes.push_back(n);
    sort_unique(to.nodes);
  }
}

void ExodusReader::element_sets() {
  for (const std::int64_t id : ids(EX_ELEM_SET, init_.num_elem_sets)) {
    Block group{group_id(EX_ELEM_SET, id), group_name(EX_ELEM_SET, id), {}};
    std::vector<Index> others;
    for (const std::int64_t element : set(EX_ELEM_SET, id).first) {
      if (const Index h = hex(element, "element set " + std::to_string(id)); h >= 0) group.hexes.push_back(h);
      if (const Index other = other_of(element - 1); other >= 0) others.push_back(other);
    }
    sort_unique(group.hexes);
    sort_unique(others);
    auto& blocks = out_.mesh.blocks;
    const auto same = std::ranges::find(blocks, group.id, &Block::id);
    const bool whole =
        same != blocks.end() && same->name == group.name && std::ranges::includes(group.hexes, same->hexes);
    if (same != blocks.end() && !whole) {
      group.id = free_id(blocks);
      out_.notices.push_back("element set " + std::to_string(id) + " is block " + std::to_string(group.id) +
                             ": an element block has its id");
    }
    group_of_id(blocks, group.id) = group;
    if (others.empty()) continue;
    const auto known = std::ranges::find(heads_.sets, group.id, &OtherSet::id);
    if (known == heads_.sets.end())
      heads_.sets.push_back({group.id, std::move(others)});
    else
      known->elements = union_of(known->elements, others);
  }
}

}  // namespace hextwist::io
