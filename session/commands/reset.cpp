#include "hextwist/session/commands/commands.h"
#include "hextwist/session/commands/sets.h"
#include "hextwist/session/load.h"

namespace hextwist {

void do_reset(Execution& run) {
  if (run.command.has("genesis")) return run.change_sets({});
  for (const EntityKind kind : {EntityKind::block, EntityKind::nodeset, EntityKind::sideset})
    if (run.command.has(name(kind))) {
      Mesh lists = lists_of(run.meshed->mesh);
      with_groups(lists, kind, [](auto& groups, auto) { groups.clear(); });
      return run.change_sets(std::move(lists));
    }
  if (run.command.has("mesh")) {
    need_mesh(run, "to forget");
    if (!run.state.has_cad) throw Error("the mesh lies on its own skin: say 'reset'");
    forget_members(run.state, false);
    run.state.tags = nullptr;
    run.state.extras = nullptr;
    run.state.fixed_nodes = nullptr;
    return replace_and_measure(run, {{}, run.meshed->model, {}});
  }
  static_cast<ModelState&>(run.state) = ModelState();
  run.replace({});
  run.state.sizing.clear();
  run.state.last_sizing.clear();
}

}  // namespace hextwist
