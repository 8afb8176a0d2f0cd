// Goal 3: a small change of a large mesh, by everything that refine() does: targets to verification.
#include "groups.h"
#include "hextwist/command/session.h"
#include "hextwist/refine/carry.h"
#include "hextwist/refine/marks.h"
#include "hextwist/refine/trisect.h"
#include "hextwist/sizing/verify.h"
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

RefineResult refined(TargetKind kind, Index target, int depth) {
  Request request;
  request.kind = kind;
  request.depth = depth;
  request.targets = {target};
  static const Measured known = measured(input());  // as in a session, which has measured what it holds
  return refine(input(), known, request);
}

/// Wall milliseconds of the second of two commands in a session.
double second_command() {
  const Threads limit(1);
  Session session;
  session.take(input().mesh, input().model);
  session.run("refine hex 505051");
  session.run("refine hex 707071");
  return 1e3 * session.records().back().total_seconds;
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
  add_time("small/hex", [] { return refined(TargetKind::hex, middle_hex(side), 0); });
  add_time("small/curve", [] { return refined(TargetKind::curve, 1, 1); });
  add_time("small/curve_combination", [] { return refined(TargetKind::curve, 1, 0); });
  add_value("small/second_command", second_command);
}

}  // namespace hextwist::bench
