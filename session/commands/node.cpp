// node ... position fixed, free.

#include "hextwist/base/sorted.h"
#include "hextwist/session/commands/commands.h"

namespace hextwist {

void do_node(Execution& run) {
  const std::vector<Index> nodes = run.chosen(*run.command.find("range"));
  const std::vector<Index> old = run.state.fixed_nodes ? *run.state.fixed_nodes : std::vector<Index>();
  std::vector<Index> fixed = run.command.has("fixed") ? union_of(old, nodes) : difference(old, nodes);
  run.say(counted(static_cast<std::int64_t>(nodes.size()), EntityKind::node) +
          (run.command.has("fixed") ? " fixed" : " free") + "; " + std::to_string(fixed.size()) + " of " +
          std::to_string(run.meshed->mesh.n_nodes()) + " are fixed now");
  run.state.fixed_nodes = fixed.empty() ? nullptr : std::make_shared<const std::vector<Index>>(std::move(fixed));
}

}  // namespace hextwist
