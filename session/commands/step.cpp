// step: fields at another time of the mesh's file.
#include <algorithm>
#include <cmath>

#include "hextwist/io/results.h"
#include "hextwist/session/commands/commands.h"

namespace hextwist {

std::string steps_text(const Mesh& mesh) {
  if (!mesh.results || mesh.results->times.size() < 2) return "";
  const std::vector<double>& times = mesh.results->times;
  return std::to_string(times.size()) + " time steps (" + short_number(times.front()) + " to " +
         short_number(times.back()) + "; fields are those of step " + std::to_string(mesh.results->step + 1) + ")";
}

void do_step(Execution& run) {
  const Command& command = run.command;
  const Mesh& mesh = run.meshed->mesh;
  const std::vector<double> times = mesh.results ? mesh.results->times : std::vector<double>();
  if (times.size() < 2)
    throw error_at(command.statement, command.items.front().token, "the mesh has come with no more than one time step");
  if (mesh.file_hexes.size() != mesh.hexes.size())
    throw error_at(command.statement, command.items.front().token,
                   "it is no longer known where in their file the hexes lie");
  std::size_t step = times.size() - 1;
  if (const Item* n = command.find("n")) {
    if (n->number > static_cast<double>(times.size()))
      throw error_at(command.statement, n->token, "there are " + std::to_string(times.size()) + " time steps");
    step = static_cast<std::size_t>(n->number) - 1;
  } else if (const Item* t = command.find("t")) {
    step = static_cast<std::size_t>(
        std::ranges::min_element(times, {}, [&](double time) { return std::abs(time - t->number); }) - times.begin());
  }
  MeshedModel meshed = *run.meshed;
  take_step(meshed.mesh, step);
  run.replace_fields(std::move(meshed));
  run.say("step " + std::to_string(step + 1) + " of " + std::to_string(times.size()) + ", time " +
          short_number(times[step]));
}

}  // namespace hextwist
