// What the functions behind the commands share.
#pragma once

#include <chrono>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "hextwist/base/text.h"
#include "hextwist/command/error_at.h"
#include "hextwist/command/expression.h"
#include "hextwist/command/select/selection.h"
#include "hextwist/command/syntax.h"
#include "hextwist/patch/neighbours.h"
#include "hextwist/patch/patch_refine.h"
#include "hextwist/session/history_internal.h"
#include "hextwist/session/session.h"
#include "hextwist/session/state_internal.h"

namespace hextwist {

/// The journal that commands are written to.
struct Recording {
  std::filesystem::path file;
  std::ofstream stream;
  std::int64_t n_commands = 0;
};

struct [[gnu::visibility("hidden")]] Session::Core {
  SessionState state;
  SessionCallbacks callbacks;
  bool keep_going = false;
  std::vector<CommandRecord> records;
  Variables variables;  ///< of expressions in braces
  int nesting = 0;      ///< of playback
  std::shared_ptr<const MeshedModel> topology_of;
  std::shared_ptr<DerivedTopology> topology;
  std::unique_ptr<Neighbours> neighbours;  ///< of that mesh, if they are there
  std::weak_ptr<const MeshedModel> neighbours_of;
  std::shared_ptr<void> thread_limit;
  History history;
  std::shared_ptr<Recording> recording;                ///< null: none
  std::vector<std::weak_ptr<const MeshedModel>> lent;  ///< what share() gave away; each has a count of its own

  /// The same mesh as the session's, where somebody outside holds it; else null.
  std::shared_ptr<const MeshedModel> lent_mesh() const;
  /// Ranges are evaluated against this; the topology is kept while the mesh stays the same.
  Selector selector();
  void say(const std::string& line) const;
};

/// A broken file can have a violation per hex; nobody reads more rows than this, and the count says the rest.
inline constexpr std::size_t max_violation_rows = 1000;

/// A step from mesh to mesh.
struct SpliceStep {
  std::shared_ptr<const Splice> splice;
  bool forward = true;
};

/// One command on its way: where its function finds and leaves things.
struct Execution {
  Execution(Session::Core& session, const Command& said, CommandRecord& row)
      : core(session), state(session.state), command(said), record(row) {}

  Session::Core& core;
  SessionState& state;
  const Command& command;
  CommandRecord& record;

  void say(const std::string& line) const { core.say(line); }
  void note(const std::string& line) const;
  /// Begins a stage: its time goes to the record. Throws Cancelled when the user asked for it.
  void stage(const char* name);
  void close_stage();
  /// Positions chosen by the command's range. Throws when there are none.
  std::vector<Index> chosen(const Item& range) const;
  /// Gives the mesh these blocks and sets, in place: no other array is copied. The last thing that a command does.
  void change_sets(Mesh lists);
  /// Makes the mesh another one by splices, in place if nobody else holds it, and the state the next (but for its
  /// mesh). The last thing that a command does, but for these lines: where saying them throws, nothing has changed.
  void splice(std::span<const SpliceStep> steps, ModelState next, const std::vector<std::string>& lines);
  /// What change_sets() left to be undone.
  std::optional<Step> step;
  bool is_history = false;  ///< undo and redo, which leave no step of their own

 private:
  const char* stage_ = nullptr;
  std::chrono::steady_clock::time_point since_;
};

/// What a small refinement would do to the mesh; nothing where it is not small.
std::optional<PatchResult> refine_in_patch(const Execution& run, const Measured& known, const Request& request);
/// The mesh and model of a state changed: checks nothing, measures everything that the records want.
void take_meshed(SessionState& state, MeshedModel meshed);
/// The result of a refinement becomes the mesh of the session, unless it is no good: then throws Error.
void accept_refined(Execution& run, MeshedModel refined, const Report& report);
/// Repairs, checks and associates a mesh with the CAD of the state or its own skin.
void load_mesh(Execution& run, Mesh mesh, const Association* tags, const std::string& what);
/// The inverted hexes of these violations if untangling them could make the mesh right; else nothing.
std::vector<Index> inverted_among(const std::vector<Violation>& violations);
/// Untangles around these hexes, then everywhere; boundary: nodes on curves and surfaces slide. False: some are
/// inverted still.
bool untangle_mesh(const Execution& run, Mesh& mesh, Association& association, const Model* model,
                   const std::vector<Index>& inverted, bool boundary);
/// The notice of a mesh that was untangled.
std::string untangled_text(const Mesh& mesh, const std::vector<Vec3>& before, const std::vector<Index>& inverted);
/// The line that tells of a mesh that came in.
void say_mesh(const Execution& run, const std::string& what);
QualityRow quality_row(const Mesh& mesh, const Summary& summary);
ViolationRow violation_row(const Mesh& mesh, const Violation& violation);
/// Puts the violations into the record (warnings apart) and returns a line on those that are not warnings, "" if none.
std::string record_violations(CommandRecord& record, const Mesh& mesh, const std::vector<Violation>& violations);

// The functions behind the commands. Each throws Error when it can't do what was asked.
void do_check(Execution& run);
void do_create(Execution& run);
void do_delete(Execution& run);
void do_draw(Execution& run);
void do_export(Execution& run);
void do_group(Execution& run);
void do_help(Execution& run);
void do_import(Execution& run);
void do_list(Execution& run);
void do_named_group(Execution& run);
void do_node(Execution& run);
void do_playback(Execution& run);
void do_quality(Execution& run);
void do_quit(Execution& run);
void do_record(Execution& run);
void do_redo(Execution& run);
void do_refine(Execution& run);
void do_reset(Execution& run);
void do_scheme(Execution& run);
void do_set(Execution& run);
void do_sizing(Execution& run);
void do_smooth(Execution& run);
void do_undo(Execution& run);
/// "2 curves, 1 surface"
std::string members_text(const Selector& selector, const Group& group);
/// Takes members out of all groups that mean nothing for a new mesh, or drops the groups where the CAD is new too.
void forget_members(ModelState& state, bool also_cad);
/// `list undo`.
void list_undo(Execution& run);

/// The metrics that were said in the option which begins with that word (Item::option); shape where none was.
std::vector<Metric> metrics_said(const Command& command, std::string_view option);

/// Switching it off forgets all steps.
void switch_undo(Execution& run, bool on);
/// Says that words were understood and change nothing here.
void note_ignored(const Execution& run, std::initializer_list<const char*> words);

/// What a command changed since `before` can be undone from now on. Nothing if that is nothing.
void remember(Session::Core& core, const std::string& command, const ModelState& before);
void add_step(Session::Core& core, Step step) noexcept;
/// Writes a command that went well to the journal, if there is one; expressions alone likewise.
void keep_on_record(Session::Core& core, const Command& command);
void keep_on_record(Session::Core& core, const Statement& statement);

/// How sizes grow from a source unless it is said, per unit of distance and plus one: the usual 1.5.
inline constexpr double default_growth = 1.5;
/// A sizing function typed as an expression; the error points into it. One by name.
SizeFieldPtr typed_size(const Command& command, const Item& expression);
SizeFieldPtr named_size(const Execution& run, const Item& name);

/// Runs the commands of a text; see Session::run().
int run_text(Session::Core& core, std::string_view text, std::string_view source_name, int first_line = 1);
void run_command(Session::Core& core, const Command& command);
/// The words and file of a command as if they had been typed.
Command made_command(std::string_view name, std::string_view word, const std::filesystem::path& file,
                     std::string_view last_word = "");

/// "312 bytes", "4.1 kB", "2.3 MB".
std::string bytes_text(std::size_t bytes);
/// "1 hex", "3 hexes".
inline std::string counted(std::int64_t n, EntityKind kind) {
  return counted(n, name(kind), plural(kind));
}

}  // namespace hextwist
