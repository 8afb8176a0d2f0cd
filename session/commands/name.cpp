// surface 1 name "inlet", and what else begins with curve, surface, vertex or volume.

#include "hextwist/geom/renumbered_model.h"
#include "hextwist/session/commands/commands.h"
#include "hextwist/sizing/levelling.h"

namespace hextwist {
namespace {

void name_entities(Execution& run, const Item& range, const Item& text) {
  if (text.text.empty()) throw error_at(run.command.statement, text.token, "this name is empty");
  const std::vector<Index> positions = run.chosen(range);
  std::vector<std::pair<Owner, std::string>> names;
  for (const Index i : positions) names.emplace_back(Owner{dimension(range.kind), i + 1}, text.text);
  MeshedModel meshed = *run.meshed;
  meshed.model = renamed(std::move(meshed.model), names);
  run.replace(std::move(meshed));
  run.state.levelling = with_base(run.state.levelling, [&](MeshedModel& base) { base.model = run.meshed->model; });
  run.keep_levels();
  const auto n = static_cast<std::int64_t>(positions.size());
  run.say((n == 1 ? std::string(name(range.kind)) + " " + std::to_string(positions.front() + 1) + " is"
                  : counted(n, range.kind) + " are") +
          " called '" + printable(text.text) + "'");
}

}  // namespace

void do_entity(Execution& run) {
  if (run.command.has("smooth")) return do_scheme(run);
  if (const Item* text = run.command.find("text")) return name_entities(run, *run.command.find("range"), *text);
  do_move(run);
}

}  // namespace hextwist
