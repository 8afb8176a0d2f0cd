// A session: a mesh on its model, changed by commands. What `hextwist` does, as a class to embed.
//
//   hextwist::Session session;
//   session.run("import step \"part.step\"; import mesh \"part.msh\"");
//   session.run("refine curve 3 numsplit 2");
//   const hextwist::Mesh& mesh = session.meshed().mesh;
//
// Guarantees:
//  1. a command that fails leaves the session as it was, and says why;
//  2. the mesh in a session is conformal and uninverted, and every boundary node has an owner; one that comes in with
//     inverted hexes is untangled (with a notice) or refused;
//  3. `undo` brings back mesh, model and association bit by bit.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hextwist/command/command_error.h"
#include "hextwist/patch/adapt.h"

namespace HEXTWIST_API hextwist {

/// Quality of a mesh by one metric, hexes by the ids that users know; count 0 where there was no mesh.
struct QualityRow {
  std::int64_t count = 0;    ///< of the hexes; 0: all else means nothing
  double min = 0;            ///< the smallest value, be it the best or the worst
  double max = 0;            ///< the largest value
  double average = 0;        ///< every hex counts the same
  double std_dev = 0;        ///< of the population (divided by count)
  std::int64_t min_hex = 0;  ///< id of the hex with the smallest value; the first among equals
  std::int64_t max_hex = 0;  ///< id of the hex with the largest value
};

/// A violation or warning, with ids as users know them.
struct ViolationRow {
  std::string kind;                 ///< "inverted", "hanging node", ..., "association", "off cad"
  std::string text;                 ///< one line, long lists cut short
  std::vector<std::int64_t> hexes;  ///< ids of those involved, ascending
  std::vector<std::int64_t> nodes;  ///< ids of those involved, ascending
};

/// What a mesh was like before or after a command.
struct MeshState {
  std::int64_t hexes = 0;      ///< 0: there was no mesh
  std::int64_t nodes = 0;      ///< those of no hex too
  QualityRow shape;            ///< over all hexes
  QualityRow scaled_jacobian;  ///< over all hexes
  double volume = 0;           ///< of all hexes, model units cubed
};

/// How well wished sizes were met (SizeReport), hexes by the ids that users know; hexes 0: none were wished for.
struct SizesRow {
  std::int64_t hexes = 0;           ///< at which a size was wished for
  std::int64_t coarser = 0;         ///< of them: larger than wished by more than a factor sqrt(3)
  std::int64_t finer = 0;           ///< smaller than wished by more than a factor sqrt(3)
  std::int64_t much_finer = 0;      ///< smaller than wished by more than a factor 3
  std::int64_t n_unmet = 0;         ///< that would be cut again if there were passes left
  int passes = 0;                   ///< run
  double met = 1;                   ///< part of the hexes within a factor sqrt(3) of the wish, 0..1
  double smallest_ratio = 0;        ///< of actual size / wished size
  double largest_ratio = 0;         ///< likewise
  std::vector<std::int64_t> unmet;  ///< at most 1000 of them
  double met_in_the_end = 1;        ///< as `met`, after nodes were moved for better shapes
};

/// What one command did. Of a command that changes nothing, before and after are the same.
struct CommandRecord {
  std::string command;            ///< as said, on one line
  bool ok = false;                ///< false: it failed and changed nothing (of a playback, what came before stays)
  std::string error;              ///< one line, empty when ok
  int line = 0;                   ///< of the error in its source, 1-based; 0: none
  int column = 0;                 ///< of the error in its line, 1-based; 0: none
  MeshState before;               ///< the mesh that it found
  MeshState after;                ///< the mesh that it left
  bool dry_run = false;           ///< after.hexes and after.nodes are then what would have been
  std::int64_t filled_hexes = 0;  ///< hexes that joined the region because of `concave fill`
  SizesRow sizes;                 ///< of a request for sizes
  OffModel off_cad;               ///< of the mesh afterwards
  std::int64_t off_cad_node = 0;  ///< id of its worst node, 0: none
  double cad_volume = 0;          ///< of the model afterwards
  bool has_cad = false;           ///< false: the model is the skin of the mesh
  std::int64_t n_violations = 0;  ///< all, also those beyond the rows kept
  std::vector<ViolationRow> violations;  ///< of the result or the refused mesh; at most 1000
  std::vector<ViolationRow> warnings;    ///< faults that do not matter (is_warning()); at most 1000
  std::vector<std::string> notices;      ///< remarks of the command, one line each
  std::vector<StageTime> seconds;        ///< in the order run; a stage may stand there more than once
  double total_seconds = 0;              ///< from beginning to end, wall clock
  std::size_t peak_memory_bytes = 0;     ///< of the process so far
};

/// What Session::adapt() did.
struct AdaptOutcome {
  std::vector<Index> origin;  ///< per hex of the new mesh: the hex of the old one that it lies in; of several the first
  Report report;              ///< where nothing was cut, counts alone
  LevelOrigin came_from;      ///< the same in full
};

/// Who is told while commands run; empty functions: nobody. They are called on the thread that runs the command, and
/// may throw, which stops it; they must not call the session.
struct SessionCallbacks {
  /// Lines of text that a command prints, without their line end.
  std::function<void(const std::string&)> output;
  /// Remarks: what was repaired, glued, skipped. One line each.
  std::function<void(const std::string&)> notice;
  /// Errors that run() does not throw: because of `keep_going`, or of a journal that can't be written any more (what
  /// was to be written there has been done; without this callback it is a notice).
  std::function<void(const CommandError&)> error;
  /// Progress of a long command; returning false cancels it.
  Progress progress;
};

/// A mesh on its model, changed by commands. For one thread at a time; several sessions may run side by side. Can be
/// moved, not copied; one that was moved from can only be assigned to or destroyed.
class Session {
 public:
  /// Without CAD and mesh.
  Session();
  ~Session();
  /// Takes over everything: mesh, model, steps back and forth, callbacks.
  Session(Session&&) noexcept;
  /// Likewise; what was here is dropped.
  Session& operator=(Session&&) noexcept;

  /// Replaces all of them. Not while a command runs.
  void set_callbacks(SessionCallbacks callbacks);
  /// Go on after a command that failed; its error goes to the callback. Default: stop.
  void set_keep_going(bool keep_going);

  /// Executes commands (see docs/commands.md); source_name is what errors call the text. Returns how many failed.
  /// Throws CommandError for the first that failed, unless it is to keep going; Cancelled's text is "cancelled".
  int run(std::string_view text, std::string_view source_name = "", int first_line = 1);

  /// `import geometry`, for file names of any kind: CAD in place of what there is; a mesh is put on it. Throws
  /// CommandError.
  void import_cad(const std::filesystem::path& file);
  /// `import mesh`, likewise: a mesh in place of what there is, on the CAD of the session or its own skin. Throws
  /// CommandError.
  void import_mesh(const std::filesystem::path& file);
  /// `export mesh`, likewise. Overwrites. Throws CommandError.
  void export_mesh(const std::filesystem::path& file);
  /// Commands from a journal file: returns and throws as run().
  int playback(const std::filesystem::path& file);

  /// Takes a mesh as it is: repaired, checked and associated (with a model of its own skin if model is null; starting
  /// from tags if not null) as by import. Throws Error.
  void take(Mesh mesh, std::shared_ptr<const Model> model, const Association* tags = nullptr);
  /// The same with an association that is complete already (has_cad: with CAD, else with a skin); notices are the
  /// remarks of who made it.
  void take(MeshedModel meshed, bool has_cad, const std::vector<std::string>& notices = {});
  /// The same on the CAD that the session has (glued if need be), or the mesh's own skin where it has none.
  void take_mesh(Mesh mesh, const Association* tags = nullptr);

  /// Gives the mesh this field, in place of the one of the same name and place that it has; the hex field "level" is
  /// the session's own. As by a command: it can be undone, and levels go on. Throws CommandError.
  void set_field(Field field);

  /// adapt() on the mesh of the session, which becomes the result, as by a command: it can be undone, and a failure
  /// leaves the session as it was. flags: one per hex, 0 or not. Throws CommandError.
  AdaptOutcome adapt(std::span<const std::uint8_t> flags, const AdaptOptions& options = {});
  /// The same by levels. changes: one per hex, by how many it becomes finer (> 0) or coarser (< 0). The session knows
  /// how its mesh came about: options.levelling is to be null.
  AdaptOutcome adapt(std::span<const std::int8_t> changes, const AdaptOptions& options = {});
  /// The same by sizes: one per hex, positive, model units; infinity: no wish.
  AdaptOutcome adapt(std::span<const double> sizes, const AdaptOptions& options = {});

  /// Ids of the entities of a kind ("hex", "curve", ... as in commands) that a range means: ids("node", "in curve 3").
  /// Ascending. Throws CommandError for a kind or range that is wrong or names what does not exist.
  std::vector<std::int64_t> ids(std::string_view kind, std::string_view range = "all") const;

  /// Words and names that could stand at the end of this beginning of a command and start like its last word (all of
  /// them after a blank). Sorted; names with blanks in quotes.
  std::vector<std::string> completions(std::string_view line) const;

  /// The mesh as it is now, without hexes where there is none: valid until the next call that may change it.
  const MeshedModel& meshed() const;
  /// The same, to keep: it stays as it is whatever the session does afterwards.
  std::shared_ptr<const MeshedModel> share() const;
  /// Did the model come from CAD? False: there is none, or it is the skin of the mesh.
  bool has_cad() const;
  /// One per command run so far.
  const std::vector<CommandRecord>& records() const;
  /// Was `quit` run?
  bool finished() const;

  struct Core;  ///< defined in core.h
  /// For our own programs, which know what is inside.
  Core& core() { return *core_; }

 private:
  std::unique_ptr<Core> core_;
};

}  // namespace hextwist
