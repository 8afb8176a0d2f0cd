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
  std::int64_t count = 0;
  double min = 0, max = 0, average = 0, std_dev = 0;
  std::int64_t min_hex = 0, max_hex = 0;
};

struct ViolationRow {
  std::string kind;  ///< "inverted", "hanging node", ..., "association", "off cad"
  std::string text;
  std::vector<std::int64_t> hexes, nodes;  ///< ids
};

/// What a mesh was like before or after a command.
struct MeshState {
  std::int64_t hexes = 0, nodes = 0;
  QualityRow shape, scaled_jacobian;
  double volume = 0;
};

/// How well wished sizes were met (SizeReport), hexes by the ids that users know; hexes 0: none were wished for.
struct SizesRow {
  std::int64_t hexes = 0, coarser = 0, finer = 0, much_finer = 0, n_unmet = 0;
  int passes = 0;
  double met = 1, smallest_ratio = 0, largest_ratio = 0;
  std::vector<std::int64_t> unmet;  ///< at most 1000 of them
};

/// What one command did. Of a command that changes nothing, before and after are the same.
struct CommandRecord {
  std::string command;  ///< as said, on one line
  bool ok = false;
  std::string error;         ///< one line, empty when ok
  int line = 0, column = 0;  ///< of the error in its source, 1-based; 0: none
  MeshState before, after;
  bool dry_run = false;  ///< after.hexes and after.nodes are then what would have been
  std::int64_t filled_hexes = 0;
  SizesRow sizes;
  OffModel off_cad;               ///< of the mesh afterwards
  std::int64_t off_cad_node = 0;  ///< id of its worst node, 0: none
  double cad_volume = 0;          ///< of the model afterwards
  bool has_cad = false;           ///< false: the model is the skin of the mesh
  std::int64_t n_violations = 0;  ///< all, also those beyond the rows kept
  std::vector<ViolationRow> violations;
  std::vector<ViolationRow> warnings;
  std::vector<std::string> notices;
  std::vector<StageTime> seconds;
  double total_seconds = 0;
  std::size_t peak_memory_bytes = 0;  ///< of the process so far
};

/// What Session::adapt() did.
struct AdaptOutcome {
  std::vector<Index> origin;  ///< per hex of the new mesh: the hex of the old one that it lies in; of several the first
  Report report;
  LevelOrigin came_from;  ///< the same in full
};

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

class Session {
 public:
  Session();
  ~Session();
  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;

  void set_callbacks(SessionCallbacks callbacks);
  /// Go on after a command that failed; its error goes to the callback. Default: stop.
  void set_keep_going(bool keep_going);

  /// Executes commands (see docs/commands.md); source_name is what errors call the text. Returns how many failed.
  /// Throws CommandError for the first that failed, unless it is to keep going; Cancelled's text is "cancelled".
  int run(std::string_view text, std::string_view source_name = "", int first_line = 1);

  /// The same as the commands, for file names of any kind.
  void import_cad(const std::filesystem::path& file);
  void import_mesh(const std::filesystem::path& file);
  /// Overwrites.
  void export_mesh(const std::filesystem::path& file);
  /// Commands from a journal file.
  int playback(const std::filesystem::path& file);

  /// Takes a mesh as it is: repaired, checked and associated (with a model of its own skin if model is null; starting
  /// from tags if not null) as by import. Throws Error.
  void take(Mesh mesh, std::shared_ptr<const Model> model, const Association* tags = nullptr);
  /// The same with an association that is complete already (has_cad: with CAD, else with a skin); notices are the
  /// remarks of who made it.
  void take(MeshedModel meshed, bool has_cad, const std::vector<std::string>& notices = {});
  /// The same on the CAD that the session has (glued if need be), or the mesh's own skin where it has none.
  void take_mesh(Mesh mesh, const Association* tags = nullptr);

  /// adapt() on the mesh of the session, which becomes the result, as by a command: it can be undone, and a failure
  /// leaves the session as it was. flags, sizes: one per hex. Throws CommandError.
  /// changes: by how many levels each becomes finer (> 0) or coarser (< 0). The session knows how its mesh came about:
  /// options.levelling is not looked at.
  AdaptOutcome adapt(std::span<const std::uint8_t> flags, const AdaptOptions& options = {});
  AdaptOutcome adapt(std::span<const std::int8_t> changes, const AdaptOptions& options = {});
  AdaptOutcome adapt(std::span<const double> sizes, const AdaptOptions& options = {});

  /// Ids of the entities of a kind ("hex", "curve", ... as in commands) that a range means: ids("node", "in curve 3").
  /// Ascending. Throws CommandError for a kind or range that is wrong or names what does not exist.
  std::vector<std::int64_t> ids(std::string_view kind, std::string_view range = "all") const;

  /// Words and names that could stand at the end of this beginning of a command and start like its last word (all of
  /// them after a blank). Sorted; names with blanks in quotes.
  std::vector<std::string> completions(std::string_view line) const;

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
