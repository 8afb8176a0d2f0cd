#include "hextwist/base/memory.h"
#include "hextwist/geom/primitives.h"
#include "hextwist/mesh/primitives.h"
#include "hextwist/session/commands/commands.h"
#include "hextwist/session/load.h"

namespace hextwist {
namespace {

double number_of(const Command& command, std::string_view name, double otherwise) {
  const Item* item = command.find(name);
  return item ? item->number : otherwise;
}
int whole_number_of(const Command& command, std::string_view name, int otherwise) {
  return static_cast<int>(number_of(command, name, otherwise));
}

struct Solid {
  CadImport cad;
  Mesh mesh;
};

Solid brick(const Command& command) {
  BrickShape shape;
  shape.width = number_of(command, "width", 1);
  shape.depth = number_of(command, "depth", shape.width);
  shape.height = number_of(command, "height", shape.width);
  BrickIntervals intervals;
  if (command.find("n")) intervals = brick_intervals(whole_number_of(command, "n", 0));
  intervals.depth = whole_number_of(command, "n_y", intervals.depth);
  intervals.height = whole_number_of(command, "n_z", intervals.height);
  check_hexes(static_cast<double>(intervals.width) * intervals.depth * intervals.height);
  return {cad_brick(shape), mesh_brick(shape, intervals)};
}

Solid cylinder(const Command& command) {
  const CylinderShape shape{number_of(command, "radius", 1), number_of(command, "height", 1)};
  CylinderIntervals intervals;
  if (command.find("n")) intervals = cylinder_intervals(whole_number_of(command, "n", 0));
  return {cad_cylinder(shape), mesh_cylinder(shape, intervals)};
}

Solid sphere(const Command& command) {
  const SphereShape shape{number_of(command, "radius", 1)};
  SphereIntervals intervals;
  if (command.find("n")) intervals = sphere_intervals(whole_number_of(command, "n", 0));
  return {cad_sphere(shape), mesh_sphere(shape, intervals)};
}

}  // namespace

void do_create(Execution& run) {
  const Item& what = run.command.items.at(run.command.has("create") ? 1 : 0);
  if (what.name == "group" || what.name == "block") return do_create_empty(run);
  forget_members(run.state, true);
  SessionState& state = run.state;
  run.stage("create");
  Solid solid = what.name == "brick"      ? brick(run.command)
                : what.name == "cylinder" ? cylinder(run.command)
                                          : sphere(run.command);
  check_hexes(static_cast<double>(solid.mesh.n_hexes()));
  for (const std::string& line : solid.cad.notices) run.note(line);
  state.has_cad = true;
  state.glued = false;
  state.cad_file.clear();
  state.tags = nullptr;
  state.extras = nullptr;
  note_replaced(run, run.meshed->mesh.n_hexes());
  load_mesh(run, std::move(solid.mesh), std::move(solid.cad.model), nullptr, what.name);
  say_mesh(run, what.name);
}

}  // namespace hextwist
