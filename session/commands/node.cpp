// node ... position fixed, free.

#include <algorithm>
#include <iterator>

#include "hextwist/session/commands/commands.h"

namespace hextwist {

void do_node(Execution& run) {
  const std::vector<Index> nodes = run.chosen(*run.command.find("range"));
  const std::vector<Index> old = run.state.fixed_nodes ? *run.state.fixed_nodes : std::vector<Index>();
  std::vector<Index> fixed;
  if (run.command.has("fixed"))
    std::ranges::set_union(old, nodes, std::back_inserter(fixed));
  else
    std::ranges::set_difference(old, nodes, std::back_inserter(fixed));
  run.say(counted(static_cast<std::int64_t>(nodes.size()), EntityKind::node) +
          (run.command.has("fixed") ? " fixed" : " free") + "; " + std::to_string(fixed.size()) + " of " +
          std::to_string(run.meshed->mesh.n_nodes()) + " are fixed now");
  run.state.fixed_nodes = fixed.empty() ? nullptr : std::make_shared<const std::vector<Index>>(std::move(fixed));
}

}  // namespace hextwist
