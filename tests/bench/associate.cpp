// Goals 4 and 6: who owns what.
#include "groups.h"
#include "measure.h"
#include "meshes.h"

namespace hextwist::bench {
namespace {

/// 14 surfaces, planes and cylinders, smooth edges between them; 1.2 million hexes.
const MeshedModel& bracket() {
  static const MeshedModel made = shipped("bracket_fillet", 10);
  return made;
}
/// 36 surfaces, 8 volumes; a million hexes.
const MeshedModel& bricks() {
  static const MeshedModel made = glued_bricks(100);
  return made;
}

template <const MeshedModel& input()>
AssociateResult from_geometry() {
  return associate(input().mesh, *input().model);
}
template <const MeshedModel& input()>
AssociateResult from_tags() {
  return associate(input().mesh, *input().model, &input().association);
}

}  // namespace

void add_associate() {
  add_time("associate/geometry", from_geometry<bricks>);
  add_time("associate/tags", from_tags<bricks>);
  add_time("associate/bracket_geometry", from_geometry<bracket>);
  add_time("associate/bracket_tags", from_tags<bracket>);
}

void add_associate_threads() {
  add_on_two_threads("threads/associate", from_geometry<bricks>, [](const auto&) { return 1; });
}

}  // namespace hextwist::bench
