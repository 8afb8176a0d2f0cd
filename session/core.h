// The inside of a session.
#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "hextwist/command/expression.h"
#include "hextwist/command/select/selection.h"
#include "hextwist/patch/neighbours.h"
#include "hextwist/session/history.h"
#include "hextwist/session/record.h"

namespace hextwist {

struct [[gnu::visibility("hidden")]] Session::Core {
  MeshHolder meshed;
  SessionState state;
  SessionCallbacks callbacks;
  bool keep_going = false;
  /// Set once, by 'set safe on': commands touch no file outside of this folder. Empty: they may.
  std::filesystem::path only_below;
  std::vector<CommandRecord> records;
  Variables variables;  ///< of expressions in braces
  int nesting = 0;      ///< of playback
  std::shared_ptr<void> thread_limit;
  History history;
  std::set<std::string> skipped;         ///< words of other programs that were noted as skipped
  std::unique_ptr<Recording> recording;  ///< null: none

  /// Made of the mesh when first asked for, kept until it changes (the neighbours: through splices).
  std::unique_ptr<DerivedTopology> topology;
  std::unique_ptr<Neighbours> neighbours;

  /// Ranges are evaluated against this.
  Selector selector() {
    if (!topology) topology = std::make_unique<DerivedTopology>(meshed->mesh);
    return {*meshed, *topology, state.groups ? std::span<const Group>(*state.groups) : std::span<const Group>()};
  }
  void exchange_mesh(MeshHolder next) noexcept {
    meshed = std::move(next);
    topology = nullptr;
    neighbours = nullptr;
  }
  void say(const std::string& line) const {
    if (callbacks.output) callbacks.output(line);
  }
};

}  // namespace hextwist
