// Goal 3: a small change of a large mesh, by everything that refine() does: targets to verification.
#include <algorithm>
#include <ctime>
#include <string>
#include <vector>

#include "groups.h"
#include "hextwist/patch/refine_known.h"
#include "hextwist/refine/carry.h"
#include "hextwist/refine/marks.h"
#include "hextwist/refine/templates/trisect.h"
#include "hextwist/session/session.h"
#include "measure.h"
#include "meshes.h"

namespace hextwist::bench {
namespace {

constexpr int side = 100;

const MeshedModel& input() {
  static const MeshedModel made = cube_on_brick(side);
  return made;
}

Split split_one() {
  const Mesh& mesh = input().mesh;
  static const auto marked = mark_one(mesh);
  return split(mesh.hexes, mesh.n_nodes(), trisect_table(), trisect_codes(mesh.hexes, marked));
}

/// A mesh with curves of one edge.
const MeshedModel& layered() {
  static const MeshedModel made = layered_bricks(side);
  return made;
}
std::vector<int> short_curves() {
  std::vector<int> ids;
  for (int id = 1; id <= layered().model->count(1); ++id)
    if (layered().model->measure({1, id}) < 1.5) ids.push_back(id);
  return ids;
}
RefineResult refined_short_curve(int depth) {
  Request request;
  request.target.kind = EntityKind::curve;
  request.target.depth = depth;
  request.target.ids = {short_curves().front()};
  static const Measured known = measured(layered());
  return refine(layered(), known, request);
}

RefineResult refined(EntityKind kind, Index target, int depth) {
  Request request;
  request.target.kind = kind;
  request.target.depth = depth;
  request.target.ids = {target};
  static const Measured known = measured(input());  // as in a session, which has measured what it holds
  return refine(input(), known, request);
}

/// Median and worst of some commands.
struct Times {
  double median = 0, worst = 0;
};

/// CPU milliseconds of commands in a session that has done one small refinement before.
Times later_commands(const MeshedModel& meshed, const std::vector<std::string>& commands) {
  const Threads limit(1);
  Session session;
  session.take(meshed.mesh, meshed.model);
  session.run("refine hex 505051");
  std::vector<double> times;
  for (const std::string& command : commands) {
    const std::clock_t start = std::clock();
    session.run(command);
    times.push_back(1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  std::ranges::sort(times);
  return {times[times.size() / 2], times.back()};
}

const Times& later_hexes() {
  static const Times times = [] {
    std::vector<std::string> commands;
    for (int id = 5; id < side * side * side; id += 90910) commands.push_back("refine hex " + std::to_string(id));
    return later_commands(input(), commands);
  }();
  return times;
}

/// Curves that have no vertex in common: what one refines, the others do not touch.
const Times& later_curves(int depth) {
  static const auto made = [](const std::string& options) {
    std::vector<std::string> commands;
    for (const int id : {1, 6, 12}) commands.push_back("refine curve " + std::to_string(id) + options);
    return later_commands(input(), commands);
  };
  static const Times of_depth[] = {made(" depth 0"), made(" depth 1")};
  return of_depth[depth];
}

const Times& later_short_curves(int depth) {
  static const auto made = [](const std::string& options) {
    std::vector<std::string> commands;
    for (const int id : short_curves()) commands.push_back("refine curve " + std::to_string(id) + options);
    return later_commands(layered(), commands);
  };
  static const Times of_depth[] = {made(" depth 0"), made(" depth 1")};
  return of_depth[depth];
}

}  // namespace

void add_small_change() {
  add_time("small/copy", [] { return Mesh(input().mesh); });
  add_time("small/copy_with_owners", [] { return MeshedModel(input()); });
  add_time("small/split", split_one);
  add_time("small/pass", [] {
    Split parts = split_one();
    return carry(input().mesh, input().association, parts);
  });
  add_time("small/hex", [] { return refined(EntityKind::hex, middle_hex(side), 0); });
  add_time("small/short_curve", [] { return refined_short_curve(1); });
  add_time("small/short_curve_combination", [] { return refined_short_curve(0); });
  add_time("small/curve", [] { return refined(EntityKind::curve, 1, 1); });
  add_time("small/curve_combination", [] { return refined(EntityKind::curve, 1, 0); });
  add_value("small/later_hex", [] { return later_hexes().median; });
  add_value("small/later_hex_worst", [] { return later_hexes().worst; });
  add_value("small/later_short_curve", [] { return later_short_curves(1).median; });
  add_value("small/later_short_curve_worst", [] { return later_short_curves(1).worst; });
  add_value("small/later_short_curve_combination", [] { return later_short_curves(0).median; });
  add_value("small/later_short_curve_combination_worst", [] { return later_short_curves(0).worst; });
  add_value("small/later_curve", [] { return later_curves(1).median; });
  add_value("small/later_curve_worst", [] { return later_curves(1).worst; });
  add_value("small/later_curve_combination", [] { return later_curves(0).median; });
  add_value("small/later_curve_combination_worst", [] { return later_curves(0).worst; });
}

}  // namespace hextwist::bench
