// coarsen: levels of refinement are taken back.

#include "hextwist/session/commands/request.h"
#include "hextwist/session/load.h"
#include "hextwist/session/refining.h"
#include "hextwist/sizing/levelling.h"
#include "hextwist/sizing/targets.h"

namespace hextwist {

void do_coarsen(Execution& run) {
  const Command& command = run.command;
  const Mesh& mesh = run.meshed->mesh;
  need_mesh(run, "to coarsen");
  run.stage("select");
  const Item& range = *command.find("range");
  const Target target = target_of(run);
  if (target.depth && target.radius) throw Error("give a depth or a radius, not both");
  if (!run.state.levelling)
    throw Error(
        "no hex can become coarser: this mesh is the base, nothing was refined by levels since (levels come of whole "
        "hexes, 'depth 1' or more, and 'transition regular'; depth 0, sheets and one into eight make a new base)");
  std::vector<std::string> told;
  std::vector<Index> hexes = region_target(*run.meshed, target, told);
  for (const std::string& line : told) run.note(line);

  Levelling levelling = *run.state.levelling;
  levelling.forest = grown(std::move(levelling.forest));
  const Item* levels = command.find("levels");
  const int n_levels = levels ? static_cast<int>(levels->number) : 1;
  if (range.kind != EntityKind::hex) hexes = with_siblings(levelling.forest, hexes, n_levels);
  LevelChanges changes{std::vector<std::int8_t>(mesh.hexes.size(), 0)};
  for (const Index h : hexes) changes.by[h] = static_cast<std::int8_t>(-n_levels);
  Request request{.how = std::move(changes), .levelling = std::make_shared<const Levelling>(std::move(levelling))};
  if (run.state.fixed_nodes) request.finish.fixed = *run.state.fixed_nodes;
  request.finish.extensive = extensive_fields(run);
  run.close_stage();

  Refining refining = prepare_refining(run, std::move(request));
  const Report report = refining.report();
  for (const std::string& line : report.notices) run.note(line);
  run.record().seconds.insert(run.record().seconds.end(), report.seconds.begin(), report.seconds.end());
  const double shape_before = run.state.measured.shape.min;
  if (refining.changes_nothing())
    run.note(
        "nothing became coarser: 27 hexes become one where all of them are named, and where no finer ones around need "
        "them");
  if (report.hexes_after > report.hexes_before)
    run.note(
        "there are more hexes than before: cells that are left whole among finer ones take more hexes than the 27 "
        "that they were cut into; coarsen what lies around too, or leave them");
  accept_refining(run, std::move(refining));
  run.say(text_of(command.statement) + ": " + std::to_string(report.hexes_before) + " -> " +
          counted(report.hexes_after, EntityKind::hex) + ", smallest shape " + short_number(shape_before) + " -> " +
          short_number(run.state.measured.shape.min) + off_text(", ", run.state.measured.off_cad, run.state.has_cad));
}

}  // namespace hextwist
