// Commands to refine, read by each part against what it has of the mesh.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "hextwist/command/syntax.h"
#include "hextwist/parts/local_mesh.h"

namespace hextwist {

/// What one part makes of a command; parts then agree (agreed()).
struct PartAsked {
  Asked asked;
  std::string nothing;               ///< why there is nothing of the target here; "": there is
  std::string wrong;                 ///< what can't be done, whatever others have
  std::vector<std::int64_t> has_id;  ///< per id that the command names: 1 where it is here
};

/// A node or hex that a command names.
struct NamedId {
  std::int64_t id;
  bool may_be_missing;
};

class PartCommands {
 public:
  /// Refinements, separated by ';'. Throws Error for any other command and what is not done in parts.
  explicit PartCommands(std::span<const std::string> texts);
  std::size_t size() const { return commands_.size(); }
  /// The deepest layers that are asked for.
  int depth() const;
  /// Of command i. ids: of all that is there. has_cad: the model is no skin. The mesh of `local` is as it was
  /// afterwards.
  PartAsked asked(std::size_t i, LocalMesh& local, const GlobalIds& ids, bool has_cad) const;
  /// What all parts have to say of command i, summed or chosen: throws Error where it can't be done. approach: the
  /// largest of those of parts that have something to do; before: those of the commands before.
  void check(std::size_t i, bool is_anywhere, const std::string& nothing, const std::string& wrong,
             std::span<const std::int64_t> has_id, Approach approach, std::span<const Approach> before) const;

 private:
  bool cuts_levels(std::size_t i, Approach approach) const;
  std::vector<Command> commands_;
  std::vector<std::vector<NamedId>> ids_;  // that command i names one by one
};

}  // namespace hextwist
