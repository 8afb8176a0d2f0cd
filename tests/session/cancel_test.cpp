// Cancelling: at whatever call of the progress callback, the session is bit by bit as it was.
#include <gtest/gtest.h>

#include <map>

#include "hextwist/command/command_error.h"
#include "session/session_fixture.h"

namespace hextwist {
namespace {

/// Counts the calls of the progress callback and stops at one of them.
struct Stopper {
  Session session;
  int n_calls = 0, stop_at = -1;
  std::map<std::string, int> n_in_stage;

  Stopper() {
    session.set_callbacks({.output = {}, .notice = {}, .error = {}, .progress = [this](const char* stage, double) {
                             ++n_in_stage[stage];
                             return ++n_calls != stop_at;
                           }});
  }
  /// Whether it was cancelled; anything else that goes wrong is thrown on.
  bool cancelled(const std::string& command, int at) {
    n_calls = 0;
    n_in_stage.clear();
    stop_at = at;
    try {
      session.run(command);
    } catch (const CommandError& error) {
      if (error.message() != "cancelled") throw;
      return true;
    }
    return false;
  }
};

/// Runs a command again and again, stopped at the first call, the second, ... (with growing steps), until it gets
/// through. Returns how many calls were made in that stage then.
int cancel_everywhere(const std::string& before, const std::string& command, const std::string& stage) {
  Stopper stopper;
  stopper.session.run(before);
  const Mesh mesh = stopper.session.meshed().mesh;
  const auto owners = stopper.session.meshed().association.node_owner;
  const Model* model = stopper.session.meshed().model.get();
  for (int at = 1; stopper.cancelled(command, at); at += 1 + at / 8) {
    EXPECT_TRUE(stopper.session.meshed().mesh == mesh) << command << " stopped at call " << at;
    EXPECT_TRUE(stopper.session.meshed().association.node_owner == owners) << at;
    EXPECT_EQ(stopper.session.meshed().model.get(), model) << at;
    EXPECT_FALSE(stopper.session.records().back().ok);
    if (testing::Test::HasFailure()) return 0;
  }
  // What was stopped before has left nothing behind.
  Session fresh;
  fresh.run(before);
  fresh.run(command);
  EXPECT_TRUE(stopper.session.meshed().mesh == fresh.meshed().mesh) << command;
  return stopper.n_in_stage[stage];
}

std::string model(const std::string& name) {
  return std::string(HEXTWIST_SOURCE_DIR) + "/models/" + name;
}

TEST(Cancel, leaves_the_session_as_it_was_at_every_call_while_nodes_are_placed) {
  const std::string part =
      "import brep '" + model("plate_hole.brep") + "'; import mesh '" + model("plate_hole.msh") + "'";
  EXPECT_GT(cancel_everywhere(part, "refine surface all numsplit 2", "place"), 10) << "placing asks now and then";
  cancel_everywhere(part, "refine curve 10 size 0.6 bias 1.5 smooth", "place");
}

TEST(Cancel, leaves_the_session_as_it_was_at_every_call_while_a_mesh_is_read) {
  const std::string before = "import brep '" + model("bearing_plate.brep") + "'";
  EXPECT_GT(cancel_everywhere(before, "import mesh '" + model("bearing_plate.msh") + "'", "associate"), 2)
      << "associating asks now and then";
}

}  // namespace
}  // namespace hextwist
