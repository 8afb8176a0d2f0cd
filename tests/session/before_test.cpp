// The mesh before the last change, and which hexes that change made or moved.
#include "hextwist/session/view/before.h"

#include <gtest/gtest.h>

#include "io/io_support.h"
#include "session/session_fixture.h"
#include "support/meshed.h"

namespace hextwist::test {
namespace {

/// By comparing every hex with every other: has it no twin with the same corner places?
std::vector<std::uint32_t> changed_by_places(const Mesh& now, const Mesh& before) {
  std::vector<std::uint32_t> result;
  for (Index h = 0; h < now.n_hexes(); ++h) {
    bool is_new = true;
    for (Index g = 0; g < before.n_hexes() && is_new; ++g) is_new = corners_of(now, h) != corners_of(before, g);
    result.push_back(is_new);
  }
  return result;
}

void expect_before(Fixture& f, const Mesh& wanted) {
  Session::Core& core = f.session.core();
  ASSERT_TRUE(has_mesh_before(core));
  const auto before = mesh_before(core);
  EXPECT_TRUE(same_mesh(before->mesh(), wanted));
  const SceneSource now{core.selector(), core.state, "", [&]() -> const Mesh& { return before->mesh(); }};
  const std::vector<Channel> all = channels(now);
  const auto changed = std::ranges::find(all, Channel::What::changed, &Channel::what);
  ASSERT_NE(changed, all.end());
  EXPECT_EQ(classes_of(now, *changed), changed_by_places(core.meshed->mesh, wanted));
}

TEST(MeshBefore, is_that_of_the_last_command_that_changed_the_mesh) {
  Fixture f;
  const MeshedModel meshed = brick(5, 4, 4);
  f.session.take(meshed.mesh, meshed.model);
  EXPECT_FALSE(has_mesh_before(f.session.core()));
  const Mesh first = f.session.meshed().mesh;
  f.session.run("refine hex 7");
  expect_before(f, first);
  const Mesh second = f.session.meshed().mesh;
  // Sets alone change no mesh.
  f.session.run("nodeset 4 node 1 2");
  expect_before(f, first);
  f.session.run("refine hex 60 transition nested");
  const Mesh third = f.session.meshed().mesh;
  {
    Mesh with_set = second;
    with_set.node_sets.push_back({4, "", {0, 1}});
    expect_before(f, with_set);
  }
  f.session.run("smooth hex all");
  if (f.session.meshed().mesh.points != third.points) expect_before(f, third);
  f.session.run("undo 2");
  EXPECT_TRUE(has_mesh_before(f.session.core()));
  expect_before(f, first);
}

}  // namespace
}  // namespace hextwist::test
