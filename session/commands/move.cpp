// move, scale, rotate, reflect, and the same behind `volume all`.

#include <cmath>
#include <numbers>

#include "hextwist/session/commands/commands.h"
#include "hextwist/session/move.h"

namespace hextwist {
namespace {

double number(const Command& command, std::string_view name) {
  const Item* item = command.find(name);
  return item ? item->number : 0;
}

Vec3 vector(const Command& command, const char* x, const char* y, const char* z) {
  return {number(command, x), number(command, y), number(command, z)};
}

/// The axis of a rotation, the normal of a mirror.
Vec3 direction(const Command& command) {
  if (!command.find("ax")) return {command.has("x") ? 1.0 : 0, command.has("y") ? 1.0 : 0, command.has("z") ? 1.0 : 0};
  const Vec3 said = vector(command, "ax", "ay", "az");
  if (!(said.stableNorm() > 0)) throw error_at(command.statement, command.find("ax")->token, "this is not a direction");
  return said.stableNormalized();
}

double factor_of(const Command& command) {
  if (const Item* factor = command.find("factor")) return factor->number;
  const Vec3 factors = vector(command, "fx", "fy", "fz");
  if (factors.x() != factors.y() || factors.y() != factors.z())
    throw error_at(command.statement, command.find("fx")->token,
                   "CAD is scaled by the same factor along x, y and z: say one number");
  return factors.x();
}

/// The identity, but for whole quarters exactly.
Eigen::Matrix3d rotation(double degrees, const Vec3& axis) {
  const double turn = std::remainder(degrees, 360);
  const double quarter = std::round(turn / 90);
  const bool exact = turn == 90 * quarter;
  const double angle = turn * std::numbers::pi / 180;
  const double c = exact ? (quarter == 0 ? 1 : std::abs(quarter) == 2 ? -1 : 0) : std::cos(angle);
  const double s = exact ? (std::abs(quarter) == 1 ? quarter : 0) : std::sin(angle);
  Eigen::Matrix3d cross;
  cross << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  return c * Eigen::Matrix3d::Identity() + s * cross + (1 - c) * axis * axis.transpose();
}

}  // namespace

Similarity said_rotation(const Command& command) {
  Similarity turn{.turn = rotation(number(command, "degrees"), direction(command))};
  const Vec3 about = command.find("x") ? vector(command, "x", "y", "z") : Vec3::Zero();
  turn.shift = about - turn.turn * about;
  return turn;
}

void do_move(Execution& run) {
  const Command& command = run.command;
  if (const Item* range = command.find("range")) {
    const std::vector<Index> volumes = run.chosen(*range);
    const int n = run.meshed->model ? run.meshed->model->count(3) : 0;
    if (static_cast<int>(volumes.size()) < n)
      throw error_at(command.statement, range->range.token,
                     "all " + counted(n, EntityKind::volume) + " of the model move together: say 'volume all'");
  }
  note_ignored(run, {"include_merged"});
  Similarity similarity;
  // A point that stays.
  Vec3 about = command.find("x") ? vector(command, "x", "y", "z") : Vec3::Zero();
  std::string done;
  if (command.has("move")) {
    similarity.shift = vector(command, "dx", "dy", "dz");
    about = Vec3::Zero();
    done = "moved by " + point_text(similarity.shift);
  } else if (command.has("scale")) {
    similarity.factor = factor_of(command);
    done = "scaled by " + short_number(similarity.factor);
  } else if (command.has("rotate")) {
    similarity.turn = rotation(number(command, "degrees"), direction(command));
    done = "turned by " + short_number(number(command, "degrees")) + " degrees";
  } else {
    const Vec3 normal = direction(command);
    similarity.turn = Eigen::Matrix3d::Identity() - 2 * normal * normal.transpose();
    done = "mirrored";
  }
  if (!command.has("move")) similarity.shift = about - similarity.factor * (similarity.turn * about);
  move(run, similarity);
  const MeshedModel& now = *run.meshed;
  const Box box = now.mesh.n_hexes() > 0 ? hextwist::box(now.mesh) : now.model->box();
  run.say(std::string(now.mesh.n_hexes() == 0 ? "CAD"
                      : run.state.has_cad     ? "mesh and CAD"
                                              : "mesh") +
          " " + done + ": now from " + point_text(box.min) + " to " + point_text(box.max));
}

}  // namespace hextwist
