// project: the mesh onto its CAD, or onto a CAD that has changed a little.

#include <algorithm>
#include <cmath>

#include "hextwist/base/sorted.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/mesh/nodal_fields.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/mesh/quality/validity.h"
#include "hextwist/session/commands/commands.h"
#include "hextwist/session/load.h"
#include "hextwist/session/untangle.h"

namespace hextwist {
namespace {

constexpr double default_share = 0.01;  // of the size of the model
constexpr double at_rest = 1e-10;       // likewise: rounding

/// The CAD of the file takes the place of the one that was; the mesh is as far off it as it is.
void take_cad(Execution& run, const Item& file, double within) {
  SessionState& state = run.state;
  check_file(run, file, ".step .stp .brep .brp .iges .igs");
  forget_members(state, true);
  state.glued = state.glue == Glue::on;
  std::shared_ptr<const Model> model = read_model(run, file.text, state.glued);
  state.has_cad = true;
  state.cad_file = file.text;
  const double tolerance = state.tolerance, share = within > 0 ? within / model->box().diagonal() : default_share;
  const bool snap = state.snap;
  state.tolerance = std::max(tolerance, share);
  state.snap = false;
  load_mesh(run, run.meshed->mesh, std::move(model), state.tags.get(), "the mesh");
  state.tolerance = tolerance;
  state.snap = snap;
}

/// Distances from where boundary nodes belong; 0 for all others.
std::vector<double> move_to_places(MeshedModel& meshed) {
  auto& [mesh, model, association] = meshed;
  std::vector<double> way(mesh.points.size(), 0);
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    const Owner owner = association.node_owner[n];
    const Parameters at = association.node_parameters[n];
    if (owner.dim < 0 || owner.dim > 2 || (owner.dim > 0 && std::isnan(at.u))) continue;
    const Vec3 place = model->point(owner, at);
    way[n] = (place - mesh.points[n]).norm();
    mesh.points[n] = place;
  }
  return way;
}

/// One line per surface on which something has moved.
void report(const Execution& run, const Mesh& before, const std::vector<double>& way, double least) {
  const auto& [mesh, model, association] = *run.meshed;
  for (int surface = 1; surface <= model->count(2); ++surface) {
    std::vector<std::uint8_t> on(mesh.points.size(), 0);
    Index n_moved = 0, worst = -1;
    for (const Index n : nodes_on(association, *model, {2, surface})) {
      on[n] = 1;
      if (way[n] <= least) continue;
      ++n_moved;
      if (worst < 0 || way[n] > way[worst]) worst = n;
    }
    if (n_moved == 0) continue;
    const std::vector<Index> hexes = touching_hexes(mesh.hexes, on);
    const auto shape = [&](const Mesh& of) { return summarize(quality(Metric::shape, of, hexes)); };
    const Summary was = shape(before), is = shape(mesh);
    run.say("  surface " + std::to_string(surface) + ": " + counted(n_moved, EntityKind::node) + " moved, at most " +
            short_number(way[worst]) + " (node " + std::to_string(node_id(mesh, worst)) + "); smallest shape " +
            short_number(was.min) + " -> " + short_number(is.min) + " (hex " +
            std::to_string(hex_id(mesh, hexes[is.min_hex])) + ")");
  }
}

}  // namespace

void do_project(Execution& run) {
  const Command& command = run.command;
  need_mesh(run, "to project");
  const Mesh before = run.meshed->mesh;
  const std::shared_ptr<const Levelling> levelling = run.state.levelling;
  const Item *file = command.find("file"), *distance = command.find("distance");
  const double within = distance ? distance->number : 0;
  if (file)
    take_cad(run, *file, within);
  else if (!run.state.has_cad)
    throw error_at(command.statement, command.items.back().token,
                   "there is no CAD to project to: name its file, as in 'project to geometry \"part.step\"'");
  MeshedModel meshed = *run.meshed;
  const double size = meshed.model->box().diagonal();
  run.stage("project");
  const std::vector<double> way = move_to_places(meshed);
  const auto farthest = std::ranges::max_element(way);
  const double limit = within > 0 ? within : default_share * size;
  if (*farthest > limit) {
    const auto n = static_cast<Index>(farthest - way.begin());
    throw Error("node " + std::to_string(node_id(before, n)) + " is " + short_number(*farthest) +
                " from its place, more than " + short_number(limit) + ": say 'within " + short_number(*farthest, 2) +
                "' or more, if that is what you mean");
  }
  if (std::vector<Index> inverted = inverted_hexes(meshed.mesh); !inverted.empty()) {
    const auto n_inverted = std::ssize(inverted);
    const std::vector<Vec3> points = meshed.mesh.points;
    run.stage("untangle");
    auto& [mesh, model, association] = meshed;
    for (const bool slide : {false, true})
      if (!inverted.empty()) inverted = untangle_near(run, mesh, association, model.get(), inverted, slide);
    if (!inverted.empty()) inverted = untangle_far(run, mesh, association, model.get(), inverted);
    if (!inverted.empty())
      throw Error(counted(std::ssize(inverted), EntityKind::hex) + " would be inside out, the first: hex " +
                  std::to_string(hex_id(mesh, inverted.front())) +
                  "; the CAD has changed there by more than a hex is thick");
    run.note(counted(n_inverted, EntityKind::hex) + " would have been inside out: nodes near them have moved too");
  }
  evaluate_where_moved(before, meshed.mesh);
  if (const auto broken = check_association(meshed.mesh, meshed.association, *meshed.model); !broken.empty())
    throw Error("the mesh would not lie on its CAD: " + broken.front());
  replace_and_measure(run, std::move(meshed));
  if (levelling) run.note("levels end here: this mesh is the base of what is refined from now on");
  const double least = at_rest * size;
  report(run, before, way, least);
  const auto n_moved = std::ranges::count_if(way, [&](double each) { return each > least; });
  run.say(text_of(command.statement) + ": " + counted(n_moved, EntityKind::node) + " moved, at most " +
          short_number(*farthest) + "; smallest shape " + short_number(summarize(quality(Metric::shape, before)).min) +
          " -> " + short_number(run.state.measured.shape.min));
}

}  // namespace hextwist
