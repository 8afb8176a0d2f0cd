// What happens to a session, a command or a call, happens wholly or leaves no trace but its record.
//
//   Transaction run(core, "take mesh");
//   transact(run, [&] { ...; run.replace(std::move(meshed)); });
//
// The mesh has one owner, the session. A mesh that is replaced is kept aside until it is known that nothing failed;
// what was changed in place is changed back. In place means in time proportional to the change, but for moving what
// comes behind it in the arrays. Where somebody outside holds the mesh (Session::share) a copy is changed.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "hextwist/command/token.h"
#include "hextwist/session/core.h"

namespace hextwist {

class Transaction {
 public:
  /// text: what the record calls it. statement: what errors point at; null: nothing.
  Transaction(Session::Core& session, std::string text, const Statement* statement = nullptr);
  Transaction(const Transaction&) = delete;

  Session::Core& core;
  SessionState& state;
  const MeshHolder& meshed;
  CommandRecord& record() const { return core.records[place_]; }

  void say(const std::string& line) const { core.say(line); }
  void note(const std::string& line) const;
  /// Begins a stage: its time goes to the record. Throws Cancelled when the user asked for it.
  void stage(const char* name);
  void close_stage();
  /// Since it began.
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  /// Makes this the mesh of the session.
  void replace(MeshedModel meshed);
  /// Gives the mesh these blocks and sets, in place: no other array is copied.
  void change_sets(Mesh lists);
  /// Makes this, which differs in its fields alone, the mesh of the session: levels go on.
  void replace_fields(MeshedModel meshed);
  /// The state says how the mesh came out of its base: by the same levels as before, where these are the same.
  void keep_levels() { levels_go_on_ = true; }
  /// The mesh stays, by a command that would have changed it: a step that can be undone like any other.
  void leave_mesh();
  /// Changes the mesh in place.
  void splice(const SpliceChange& change);
  /// How to undo the last change in place.
  std::optional<MeshChange> back;

  /// What it holds are transactions of their own: what those before one that failed did stays done.
  bool is_playback = false;
  bool is_history = false;    ///< undo and redo, which leave no step of their own
  bool is_journaled = false;  ///< goes to the journal, if there is one

 private:
  friend void transact(Transaction& run, const std::function<void()>& f);
  /// The same with the nodes and hexes that there are now, and their neighbours.
  void replace_alike(MeshedModel next);
  std::optional<Step> undo_step();
  void end_levels();
  /// Throws Error where the mesh is no longer the same on periodic surfaces.
  void check_pairs() const;
  void roll_back() noexcept;
  void close_record();
  void fail(const CommandError& error);

  using Clock = std::chrono::steady_clock;
  const std::size_t place_;  // of the record: a playback appends others
  const Statement* statement_;
  bool levels_go_on_ = false;
  const Clock::time_point start_ = Clock::now();
  SessionState state_before_;
  Variables variables_before_;
  std::optional<MeshHolder> mesh_before_;               // where the mesh was replaced
  std::vector<std::variant<Mesh, SpliceChange>> done_;  // in place to it: the former sets; splices
  const char* stage_ = nullptr;
  Clock::time_point since_;
};

/// Calls f, which does the work of the transaction. Whatever it throws becomes a CommandError (but for what is no
/// exception of the standard library's kind), after the session has been put back.
void transact(Transaction& run, const std::function<void()>& f);

}  // namespace hextwist
