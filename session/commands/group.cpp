// group: named collections of entities.

#include <algorithm>
#include <iterator>

#include "hextwist/base/sorted.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/session/commands/commands.h"

namespace hextwist {
namespace {

using Members = std::vector<std::array<std::int64_t, 4>>;

Group& wanted_group(const Execution& run, std::vector<Group>& groups) {
  const Command& command = run.command;
  const Item* name = command.find("name") ? command.find("name") : command.find("word");
  if (!name) {
    const Item& id = *command.find("id");
    const auto found = std::ranges::find(groups, static_cast<int>(id.number), &Group::id);
    if (found == groups.end())
      throw error_at(command.statement, id.token,
                     "there is no group " + std::to_string(static_cast<int>(id.number)) +
                         "; a new one is made by its name: group \"name\" add ...");
    return *found;
  }
  if (name->text.empty()) throw error_at(command.statement, name->token, "this name is empty");
  const auto found = std::ranges::find(groups, name->text, &Group::name);
  if (found != groups.end()) return *found;
  if (command.has("remove"))
    throw error_at(command.statement, name->token, "no group is named '" + printable(name->text) + "'");
  const int id = groups.empty() ? 1 : groups.back().id + 1;
  groups.push_back({id, name->text, {}});
  return groups.back();
}

/// Hexes of a range that 'high 0.3' and the like leave.
std::vector<Index> hexes_by_quality(const Execution& run, const Item& range) {
  std::vector<Index> hexes = related(run.core.selector(), range.kind, run.chosen(range), EntityKind::hex);
  const std::vector<Metric> metrics = metrics_said(run.command, "shape");
  std::vector<double> values = quality(metrics.front(), run.meshed->mesh, hexes);
  filter(run.command, hexes, values);
  return hexes;
}

}  // namespace

std::string members_text(const Selector& selector, const Group& group) {
  std::string result;
  for (int k = 0; k < n_entity_kinds; ++k) {
    const auto kind = static_cast<EntityKind>(k);
    if (group.members[k].empty()) continue;
    const auto n = static_cast<std::int64_t>(members(selector, group, kind).size());
    const auto n_gone = static_cast<std::int64_t>(group.members[k].size()) - n;
    result += (result.empty() ? "" : ", ") + counted(n, kind);
    if (n_gone > 0) result += " (" + std::to_string(n_gone) + " more gone)";
  }
  return result.empty() ? "empty" : result;
}

void do_create_empty(Execution& run) {
  const Command& command = run.command;
  if (const Item* id = command.find("id")) {
    const int block = static_cast<int>(id->number);
    if (std::ranges::find(run.meshed->mesh.blocks, block, &Block::id) != run.meshed->mesh.blocks.end())
      throw error_at(command.statement, id->token, "block " + std::to_string(block) + " is there already");
    return run.note("block " + std::to_string(block) + " begins with its first hex: 'block " + std::to_string(block) +
                    " volume 1', say");
  }
  std::vector<Group> groups = run.state.groups ? *run.state.groups : std::vector<Group>();
  const std::size_t before = groups.size();
  const Group& group = wanted_group(run, groups);
  if (groups.size() == before)
    throw error_at(command.statement, command.find("name")->token,
                   "group " + std::to_string(group.id) + " is called that already");
  run.say("group " + std::to_string(group.id) + " '" + printable(group.name) + "': empty");
  run.state.groups = std::make_shared<const std::vector<Group>>(std::move(groups));
}

void do_group(Execution& run) {
  const Command& command = run.command;
  std::vector<Group> groups = run.state.groups ? *run.state.groups : std::vector<Group>();
  const Selector selector = run.core.selector();
  const bool by_quality = command.has("quality");
  const auto kind_of = [&](const Item& range) { return by_quality ? EntityKind::hex : range.kind; };
  std::array<Members, n_entity_kinds> given;
  for (const Item* range : command.find_all("range"))
    for (const Index i : by_quality ? hexes_by_quality(run, *range) : run.chosen(*range))
      given[static_cast<int>(kind_of(*range))].push_back(member_of(selector, kind_of(*range), i));
  Group& group = wanted_group(run, groups);
  for (int kind = 0; kind < n_entity_kinds; ++kind) {
    Members& own = group.members[kind];
    Members& said = given[kind];
    sort_unique(said);
    if (command.has("equals")) own.clear();
    own = command.has("remove") ? difference(own, said)
          : command.has("xor")  ? union_of(difference(own, said), difference(said, own))
                                : union_of(own, said);
  }
  run.say("group " + std::to_string(group.id) + " '" + printable(group.name) + "': " + members_text(selector, group));
  run.state.groups = std::make_shared<const std::vector<Group>>(std::move(groups));
}

}  // namespace hextwist
