// Commands to refine, read by each part against what it has of the mesh.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "hextwist/base/types.h"
#include "hextwist/command/syntax.h"
#include "hextwist/parts/local_mesh.h"

namespace hextwist {

/// What parts can't do, each with its own hexes and some around them: who has the whole mesh can. Thrown by all parts
/// alike.
struct NeedsWhole : Error {
  explicit NeedsWhole(const std::string& reason)
      : Error(reason + "; that is not done part after part: run it with hextwist or hextwist-mpi"), why(reason) {}
  std::string why;  ///< "what: why"
};

/// What speaks against a command.
struct Objections {
  std::string nothing;   ///< why there is nothing of the target here; "": there is
  std::string wrong;     ///< what can't be done, whatever others have
  std::string by_whole;  ///< NeedsWhole::why; "": it can be done in parts
};

/// What one part makes of a command; parts then agree (agreed()).
struct PartAsked : Objections {
  Asked asked;
  bool has_target = false;           ///< something of the target is here
  std::vector<std::int64_t> has_id;  ///< per id that the command names: 1 where it is here
};

/// A node or hex that a command names.
struct NamedId {
  std::int64_t id;
  bool may_be_missing;
  bool is_end;  ///< of a span, which ends among ids that there are
};

class PartCommands {
 public:
  /// None.
  PartCommands() = default;
  /// Refinements, and what else a mesh is changed by, separated by ';'. Throws Error for what is wrong already, and for
  /// commands that begin or end a session of their own.
  explicit PartCommands(std::span<const std::string> texts);
  /// NeedsWhole::why, of any of them; "": they can be done in parts, as far as is known before the mesh is.
  const std::string& by_whole() const { return by_whole_; }
  /// What was said, and by which commands; "": that is not known before it is done.
  std::span<const std::string> texts() const { return texts_; }
  std::span<const std::string> names() const { return names_; }
  /// What is to be said of lines that are skipped.
  std::span<const std::string> notices() const { return notices_; }
  /// Those that can be done in parts, where all can.
  std::size_t size() const { return commands_.size(); }
  /// The deepest layers that are asked for.
  int depth() const;
  /// Of command i. ids: of all that is there. has_cad: the model is no skin. The mesh of `local` is as it was
  /// afterwards.
  PartAsked asked(std::size_t i, LocalMesh& local, const GlobalIds& ids, bool has_cad) const;
  /// What all parts have to say of command i, summed or chosen: throws Error where it can't be done, or NeedsWhole.
  /// approach: the largest of those of parts that have something to do; before: those of the commands before.
  void check(std::size_t i, bool is_anywhere, const Objections& said, std::span<const std::int64_t> has_id,
             Approach approach, std::span<const Approach> before) const;

 private:
  bool cuts_levels(std::size_t i, Approach approach) const;
  /// False: a line of another program that is skipped.
  bool add(const Statement& statement);
  std::vector<std::string> texts_, names_, notices_;
  std::string by_whole_;
  std::vector<Command> commands_;
  struct Function {
    std::size_t before;  ///< which command
    Command command;
  };
  std::vector<Function> functions_;        // for sizes
  std::vector<std::vector<NamedId>> ids_;  // that command i names one by one
};

}  // namespace hextwist
