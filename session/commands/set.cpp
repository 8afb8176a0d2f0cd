#include <tbb/global_control.h>

#include <filesystem>

#include "hextwist/base/memory.h"
#include "hextwist/session/commands/commands.h"

namespace hextwist {

void do_set(Execution& run) {
  const Command& command = run.command;
  if (command.has("glue"))
    run.state.glue = command.has("on") ? Glue::on : command.has("off") ? Glue::off : Glue::automatic;
  if (const Item* degrees = command.find("degrees")) run.state.feature_angle = degrees->number;
  if (const Item* limit = command.find("limit")) {
    run.state.tolerance = limit->number;
    const OffModel& off = run.state.measured.off_cad;
    if (run.meshed->mesh.n_hexes() > 0 && off.max_relative > limit->number)
      run.note("the mesh lies farther off its CAD, by " + short_number(off.max_relative) +
               " of the model's size: 'check' will say so; 'project to geometry' puts it there");
  }
  if (const Item* order = command.find("order")) run.state.order = static_cast<int>(order->number);
  if (command.has("untangle")) run.state.untangle = command.has("on");
  if (command.has("snap")) run.state.snap = command.has("on");
  if (command.has("keep_jumps")) {
    std::vector<std::string>& kept = run.state.keep_jumps;
    const Item* field = command.find("field");
    if (!field)
      kept.clear();
    else if (std::ranges::find(kept, field->text) == kept.end())
      kept.push_back(field->text);
  }
  if (command.has("safe") && run.core.only_below.empty()) run.core.only_below = std::filesystem::current_path();
  if (command.has("reading")) {
    refuse_if_safe(run, "how files are read");
    if (command.has("fenced")) run.state.fenced = command.has("on") ? Fenced::on : Fenced::off;
    if (const Item* seconds = command.find("seconds")) run.state.reading_seconds = seconds->number;
    if (const Item* megabytes = command.find("megabytes")) run.state.reading_megabytes = megabytes->number;
  }
  if (command.has("duplicate")) run.note("blocks may always overlap: this setting changes nothing here");
  if (command.has("undo")) {
    History& history = run.core.history;
    if (const Item* size = command.find("megabytes")) {
      history.limit = static_cast<std::size_t>(size->number * 1e6);
      history.drop_oldest();
    } else {
      switch_undo(run, command.has("on"));
    }
  }
  // Limits hold for the process, too.
  if (command.find("most") || command.find("gigabytes")) refuse_if_safe(run, "a limit");
  if (const Item* most = command.find("most")) limit_hexes(most->number);
  if (const Item* memory = command.find("gigabytes")) limit_memory(static_cast<std::size_t>(memory->number * 1e9));
  if (const Item* count = command.find("count")) {
    // Held for the whole process while the session lives: TBB knows no narrower place.
    run.core.thread_limit.reset();
    if (count->number >= 1)
      run.core.thread_limit = std::make_shared<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                                    static_cast<std::size_t>(count->number));
  }
}

}  // namespace hextwist
