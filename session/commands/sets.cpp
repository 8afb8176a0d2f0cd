// block, nodeset, sideset.

#include <algorithm>
#include <iterator>

#include "hextwist/base/sorted.h"
#include "hextwist/command/reader.h"
#include "hextwist/mesh/association/meant.h"
#include "hextwist/session/commands/commands.h"
#include "hextwist/session/commands/sets.h"
#include "hextwist/sizing/levelling.h"

namespace hextwist {
namespace {

EntityKind kind_of(const Command& command) {
  for (const EntityKind kind : {EntityKind::block, EntityKind::nodeset, EntityKind::sideset})
    if (command.spec->name == name(kind)) return kind;
  return EntityKind::block;
}
/// What its members are called.
std::string members_text(EntityKind kind, std::size_t n) {
  const auto count = static_cast<std::int64_t>(n);
  return kind == EntityKind::block     ? counted(count, EntityKind::hex)
         : kind == EntityKind::nodeset ? counted(count, EntityKind::node)
                                       : counted(count, "side");
}

/// The side of a face that a side set takes: that of the hex in the volume with the lower id, which the normal of a
/// surface between volumes points out of; within a volume that of the first hex.
int forward_side(const Association& association, const std::array<Side, 2>& sides) {
  if (sides[1].hex < 0 || association.hex_volume.empty()) return 0;
  return association.hex_volume[sides[1].hex] < association.hex_volume[sides[0].hex] ? 1 : 0;
}

std::vector<Side> sides_of(const Execution& run, const std::vector<Index>& chosen_faces) {
  const Command& command = run.command;
  const Selector selector = run.core.selector();
  const Faces& faces = selector.topology.faces();
  std::vector<char> wanted;
  const Item* which = command.find("which");
  if (which) {
    wanted.assign(selector.meshed.mesh.hexes.size(), 0);
    for (const Index hex : related(selector, which->kind, run.chosen(*which), EntityKind::hex)) wanted[hex] = 1;
  }
  const bool reverse = command.has("reverse");
  const bool both = command.has("both") || (command.has("remove") && !which && !reverse && !command.has("forward"));
  std::vector<Side> result;
  for (const Index face : chosen_faces) {
    const std::array<Side, 2>& sides = faces.sides[face];
    const auto is_there = [&](int i) { return sides[i].hex >= 0; };
    const auto is_wanted = [&](int i) { return is_there(i) && wanted[sides[i].hex] != 0; };
    if (which && !is_wanted(0) && !is_wanted(1)) continue;
    const int forward = forward_side(selector.meshed.association, sides);
    for (int i = 0; i < 2; ++i)
      if (is_there(i) && (both || (which ? is_wanted(i) : i == forward) != reverse)) result.push_back(sides[i]);
  }
  std::ranges::sort(result);
  return result;
}

auto members(const Execution& run, const Item& range, const std::vector<Block>&) {
  return related(run.core.selector(), range.kind, run.chosen(range), EntityKind::hex);
}
auto members(const Execution& run, const Item& range, const std::vector<NodeSet>&) {
  return related(run.core.selector(), range.kind, run.chosen(range), EntityKind::node);
}
auto members(const Execution& run, const Item& range, const std::vector<SideSet>&) {
  return sides_of(run, related(run.core.selector(), range.kind, run.chosen(range), EntityKind::face));
}

/// What all ranges of the command give, ascending, each once. Each must give something.
template <class Groups>
auto all_members(const Execution& run, EntityKind kind, const Groups& groups) {
  decltype(members(run, Item{}, groups)) result;
  for (const Item* range : run.command.find_all("range")) {
    const auto given = members(run, *range, groups);
    if (given.empty())
      throw error_at(run.command.statement, range->range.token,
                     "there is nothing for a " + std::string(name(kind)) + " there");
    result.insert(result.end(), given.begin(), given.end());
  }
  return sorted_unique(std::move(result));
}

template <class Group, class Items>
void note_overlaps(const Execution& run, const std::vector<Group>& groups, Items items, const Group& changed) {
  for (const Group& other : groups) {
    if (other.id == changed.id) continue;
    const std::vector<Index> common = intersection(other.*items, changed.*items);
    if (!common.empty())
      run.note(counted(static_cast<std::int64_t>(common.size()), EntityKind::hex) + " of block " +
               std::to_string(changed.id) + (common.size() == 1 ? " is" : " are") + " in block " +
               std::to_string(other.id) + " too");
  }
}

/// What a node set is meant to hold: CAD entities that it was made of, and what the nodes of anything else say.
std::vector<Owner> meant(const Execution& run, const NodeSet& set) {
  std::vector<Owner> entities = set.meant;
  bool only_cad = true;
  for (const Item* range : run.command.find_all("range")) {
    only_cad = only_cad && is_cad(range->kind);
    if (is_cad(range->kind) && range->kind != EntityKind::vertex && !run.command.has("remove"))
      for (const Index i : run.chosen(*range)) entities.push_back({dimension(range->kind), i + 1});
  }
  const auto& [mesh, model, association] = *run.meshed;
  sort_unique(entities);
  if (!only_cad) {
    std::vector<Owner> left_out;
    entities = union_of(entities, meant_entities(mesh, association, set.nodes, &left_out));
    std::erase_if(left_out, [&](Owner entity) { return std::ranges::binary_search(entities, entity); });
    if (!left_out.empty()) run.note(left_out_text(set, entities, left_out));
  }
  return held_entities(mesh, association, set.nodes, entities);
}

std::string change_members(const Execution& run, Mesh& lists, EntityKind kind, int id) {
  const Command& command = run.command;
  return with_groups(lists, kind, [&](auto& groups, auto items) {
    const auto given = all_members(run, kind, groups);
    auto group = std::ranges::find(groups, id, [](const auto& g) { return g.id; });
    const bool remove = command.has("remove");
    const std::string named = command.spec->name.data() + (" " + std::to_string(id));
    if (remove && group == groups.end())
      throw error_at(command.statement, command.find("id")->token, "there is no " + named);
    if (group == groups.end()) {
      groups.push_back({id, "", {}});
      group = groups.end() - 1;
    }
    auto& own = (*group).*items;
    const std::size_t before = own.size();
    own = remove ? difference(own, given) : union_of(own, given);
    if constexpr (requires { group->meant; }) group->meant = meant(run, *group);
    if (const Item* text = command.find("text")) group->name = text->text;
    const std::size_t after = own.size();
    const std::string line = named + ": " + members_text(kind, before) + " -> " + std::to_string(after);
    if constexpr (std::is_same_v<decltype(own), std::vector<Index>&>)
      if (kind == EntityKind::block && !remove)
        if constexpr (requires { group->hexes; }) note_overlaps(run, groups, items, *group);
    if (after > 0) return line;
    groups.erase(group);
    return line + "; it is empty now and was deleted";
  });
}

/// block ... element type: how many nodes hexes have in files.
void change_element_type(Execution& run, const Item& type) {
  const Command& command = run.command;
  const std::string word = lower_case(type.text);
  const int n = word == "hex" || word == "hex8" ? 8 : word == "hex20" ? 20 : word == "hex27" ? 27 : 0;
  if (n == 0)
    throw error_at(command.statement, type.token,
                   "'" + printable(type.text) + "' elements are not written: files have hex8, hex20 or hex27");
  FileExtras extras = run.state.extras ? *run.state.extras : FileExtras();
  std::string what = "every element";
  if (const Item* id = command.find("id")) {
    const int block = static_cast<int>(id->number);
    if (std::ranges::find(run.meshed->mesh.blocks, block, &Block::id) == run.meshed->mesh.blocks.end())
      throw error_at(command.statement, id->token, "there is no block " + std::to_string(block));
    extras.nodes_per_hex[block] = n;
    what = "every element of block " + std::to_string(block);
  } else {
    extras.nodes_per_hex.clear();
    if (n > 8) extras.nodes_per_hex[0] = n;
  }
  run.state.extras = extras.empty() ? nullptr : std::make_shared<const FileExtras>(std::move(extras));
  run.say(what + " is a hex" + std::to_string(n) + " in files");
}

/// Levels go on where a block or set of their base gets another name.
void keep_levels_with_name(Execution& run, EntityKind kind, int id, const std::string& name) {
  bool is_there = false;
  const LevellingPtr named = with_base(run.state.levelling, [&](MeshedModel& base) {
    with_groups(base.mesh, kind, [&](auto& groups, auto) {
      const auto group = std::ranges::find(groups, id, [](const auto& g) { return g.id; });
      is_there = group != groups.end();
      if (is_there) group->name = name;
      return std::string();
    });
  });
  if (!is_there) return;
  run.state.levelling = named;
  run.keep_levels();
}

}  // namespace

void do_sets(Execution& run) {
  const Command& command = run.command;
  const EntityKind kind = kind_of(command);
  const Mesh& mesh = run.meshed->mesh;
  need_mesh(run, "to make sets of");
  if (const Item* type = command.find("type")) {
    return change_element_type(run, *type);
  }
  const Item* text = command.find("text");
  if (text && text->text.empty()) throw error_at(command.statement, text->token, "this name is empty");
  if (!command.find("id"))
    throw error_at(command.statement, command.items.at(1).token,
                   "one " + std::string(name(kind)) + " at a time; 'all' goes with 'element type' only");
  if (command.has("attribute")) return change_attributes(run);
  const int id = static_cast<int>(command.find("id")->number);
  Mesh lists = lists_of(mesh);
  std::string line;
  if (command.find("range")) {
    line = change_members(run, lists, kind, id);
  } else {
    line = with_groups(lists, kind, [&](auto& groups, auto) {
      const auto group = std::ranges::find(groups, id, [](const auto& g) { return g.id; });
      const std::string named = std::string(name(kind)) + " " + std::to_string(id);
      if (group == groups.end()) throw error_at(command.statement, command.find("id")->token, "there is no " + named);
      group->name = text->text;
      return named + " is called '" + printable(text->text) + "'";
    });
    keep_levels_with_name(run, kind, id, text->text);
  }
  run.change_sets(std::move(lists));
  run.say(line);
}

}  // namespace hextwist
