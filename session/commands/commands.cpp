#include "hextwist/session/commands/commands.h"

#include <map>

#include "hextwist/session/commands/mesh.h"

namespace hextwist {
namespace {

using Function = void (*)(Execution&);

Function function_of(std::string_view command) {
  static const std::map<std::string_view, Function> functions = {
      {"block", do_sets},        {"brick", do_create},      {"check", do_check},     {"coarsen", do_coarsen},
      {"create", do_create},     {"curve", do_entity},      {"cylinder", do_create}, {"delete", do_delete},
      {"draw", do_draw},         {"exit", do_quit},         {"export", do_export},   {"group", do_group},
      {"help", do_help},         {"import", do_import},     {"list", do_list},       {"move", do_move},
      {"merge", do_merge},       {"mesh", do_mesh},         {"node", do_node},       {"nodeset", do_sets},
      {"periodic", do_periodic}, {"playback", do_playback}, {"project", do_project}, {"quality", do_quality},
      {"quit", do_quit},         {"record", do_record},     {"redo", do_redo},       {"refine", do_refine},
      {"reflect", do_move},      {"reset", do_reset},       {"rotate", do_move},     {"scale", do_move},
      {"set", do_set},           {"sideset", do_sets},      {"sizing", do_sizing},   {"smooth", do_smooth},
      {"sphere", do_create},     {"step", do_step},         {"surface", do_entity},  {"undo", do_undo},
      {"vertex", do_entity},     {"volume", do_entity},
  };
  return functions.at(command);
}

}  // namespace

void execute(Execution& run) {
  const std::string_view name = run.command.spec->name;
  run.record().command = text_of(run.command.statement);
  run.is_playback = name == "playback";
  // Of a journal played back its commands are recorded, each as it succeeds. 'quit' would end whoever plays this back.
  run.is_journaled = !run.is_playback && name != "record" && name != "quit" && name != "exit";
  function_of(name)(run);
}

std::vector<Index> Execution::chosen(const Item& range) const {
  std::vector<std::string> notices;
  std::string why;
  std::vector<Index> result = select(core.selector(), command.statement, range.kind, range.range, notices, &why);
  for (const std::string& line : notices) note(line);
  if (result.empty())
    throw error_at(command.statement, range.range.token,
                   "there is no such " + std::string(name(range.kind)) + (why.empty() ? "" : ": " + why));
  return result;
}

bool Execution::asks_for_all_of_none(const Item& range) const {
  const auto& [items, filters, token] = range.range;
  if (is_cad(range.kind) || is_mesh(range.kind) || count(core.selector(), range.kind) > 0) return false;
  if (!filters.empty() || (!items.empty() && items.front().kind != RangeItem::Kind::all)) return false;
  note("there are no " + std::string(plural(range.kind)));
  return true;
}

void need_mesh(const Execution& run, std::string_view purpose) {
  if (run.meshed->mesh.n_hexes() > 0) return;
  const std::string from =
      run.state.has_cad
          ? "there is only CAD: read its mesh ('import mesh \"part.e\"'), all-hexahedral, or fill it ('mesh volume "
            "all')"
          : "read one ('import mesh \"part.e\"', its CAD before it) or make one ('create brick x 10 interval 5')";
  throw Error("there is no mesh " + std::string(purpose) + "; " + from);
}

void note_ignored(const Execution& run, std::initializer_list<const char*> words) {
  for (const char* word : words)
    if (run.command.has(word)) run.note("'" + std::string(word) + "' changes nothing here");
}

}  // namespace hextwist
