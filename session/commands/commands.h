// The functions behind the commands, and what they share.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "hextwist/command/error_at.h"
#include "hextwist/command/syntax.h"
#include "hextwist/geom/similarity.h"
#include "hextwist/session/transaction.h"

namespace hextwist {

/// One command on its way: where its function finds and leaves things.
struct Execution : Transaction {
  Execution(Session::Core& session, const Command& said)
      : Transaction(session, text_of(said.statement), &said.statement), command(said) {}

  const Command& command;
  /// Not a command of a text but a call by who made the session, who may do anything.
  bool by_caller = false;

  /// Positions chosen by the command's range. Throws when there are none.
  std::vector<Index> chosen(const Item& range) const;
  /// Whether it is all blocks, sets or groups where there are none: said, for that is no mistake (of `list`, `delete`).
  bool asks_for_all_of_none(const Item& range) const;
};

/// Does what the command says, by one of these. Each throws Error when it can't do what was asked.
void execute(Execution& run);
void do_check(Execution& run);
void do_coarsen(Execution& run);
void do_create(Execution& run);
void do_delete(Execution& run);
void do_draw(Execution& run);
void do_entity(Execution& run);
void do_export(Execution& run);
void do_group(Execution& run);
void do_help(Execution& run);
void do_import(Execution& run);
void do_list(Execution& run);
void do_move(Execution& run);
void do_node(Execution& run);
void do_periodic(Execution& run);
void do_playback(Execution& run);
/// `list periodic`.
void list_periodic(Execution& run);
/// The rotation that the words 'angle ... about ...' of a command say.
Similarity said_rotation(const Command& command);
void do_project(Execution& run);
void do_quality(Execution& run);
void do_quit(Execution& run);
void do_record(Execution& run);
void do_redo(Execution& run);
void do_refine(Execution& run);
void do_reset(Execution& run);
void do_scheme(Execution& run);
void do_set(Execution& run);
void do_sets(Execution& run);
void do_sizing(Execution& run);
void do_smooth(Execution& run);
void do_step(Execution& run);
void do_undo(Execution& run);

/// group.cpp: create group, create block.
void do_create_empty(Execution& run);
/// playback.cpp: runs the commands in a file, which has one of these endings where the session is safe.
void play(Execution& run, const Item& file, std::string_view endings);
/// files.cpp: throws Error where the session is safe and the file lies outside of its folder, is no ordinary one, or
/// has none of these endings (".a .b").
void check_file(const Execution& run, const Item& file, std::string_view endings);
std::string mesh_endings(bool writing);
/// Throws Error where the session is safe. what: "this limit"
void refuse_if_safe(const Execution& run, std::string_view what);

/// Throws Error where there is no mesh, saying where one comes from. purpose: "to refine"
void need_mesh(const Execution& run, std::string_view purpose);
/// Says that words were understood and change nothing here.
void note_ignored(const Execution& run, std::initializer_list<const char*> words);
/// step.cpp: "3 time steps (0 to 2; fields are those of step 3)"; empty where there is but one.
std::string steps_text(const Mesh& mesh);
/// group.cpp: "2 curves, 1 surface"
std::string members_text(const Selector& selector, const Group& group);
/// quality.cpp: the metrics that were said in the option which begins with that word (Item::option); shape where none
/// was.
std::vector<Metric> metrics_said(const Command& command, std::string_view option);
/// quality.cpp: leaves of hexes and their values those that 'low', 'high', 'top' and 'bottom' ask for, in the order
/// they had.
void filter(const Command& command, std::vector<Index>& hexes, std::vector<double>& values);
/// attributes.cpp: block ... attribute.
void change_attributes(Execution& run);
/// sizing.cpp: a sizing function typed as an expression, where the error points into it. One by name.
SizeFieldPtr typed_size(const Command& command, const Item& expression);
SizeFieldPtr named_size(const Execution& run, const Item& name);
/// refine.cpp: the range, depth and radius of a command.
Target target_of(const Execution& run);
/// undo.cpp: `list undo`. Switching undo off forgets all steps.
void list_undo(Execution& run);
void switch_undo(Execution& run, bool on);

}  // namespace hextwist
