#include "hextwist/session/commands/commands.h"
#include "hextwist/session/commands/sets.h"

namespace hextwist {

void do_delete(Execution& run) {
  const Item& range = *run.command.find("range");
  if (run.asks_for_all_of_none(range)) return;
  const std::vector<Index> positions = run.chosen(range);
  if (range.kind == EntityKind::group) {
    std::vector<Group> groups = *run.state.groups;
    for (auto i = positions.rbegin(); i != positions.rend(); ++i) groups.erase(groups.begin() + *i);
    run.state.groups = groups.empty() ? nullptr : std::make_shared<const std::vector<Group>>(std::move(groups));
    return run.say(counted(static_cast<std::int64_t>(positions.size()), range.kind) + " deleted");
  }
  Mesh lists = lists_of(run.meshed->mesh);
  with_groups(lists, range.kind, [&](auto& groups, auto) {
    for (auto i = positions.rbegin(); i != positions.rend(); ++i) groups.erase(groups.begin() + *i);
  });
  run.change_sets(std::move(lists));
  run.say(counted(static_cast<std::int64_t>(positions.size()), range.kind) + " deleted");
}

}  // namespace hextwist
