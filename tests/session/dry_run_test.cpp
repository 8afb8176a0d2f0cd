// A dry run says what the same command then does, whatever the technique, and changes nothing.
#include <gtest/gtest.h>

#include "session/session_fixture.h"

namespace hextwist {
namespace {

using test::Fixture;

const std::vector<std::string> commands = {
    "refine hex 1",
    "refine hex 1 to 20 numsplit 2",
    "refine node 1 5 9",
    "refine edge 3 numsplit 2",
    "refine face 2 depth 1",
    "refine vertex 1 numsplit 2",
    "refine vertex 1 size SMALL bias 1.4",
    "refine curve 1 numsplit 3",
    "refine curve 1 depth 2 method single",
    "refine curve 1 size SMALL",
    "refine curve 1 size SMALL bias 1.3",
    "refine curve 1 size SMALL depth 0",
    "refine surface 1",
    "refine surface 1 depth 1 method parallel",
    "refine surface 1 depth 2 concave fill",
    "refine surface 1 numsplit 2 smooth",
    "refine surface 1 radius WIDE",
    "refine surface 1 radius WIDE numsplit 2",
    "refine surface 1 size HALF",
    "refine surface 1 size HALF bias 1.3",
    "refine surface 1 size HALF radius WIDE",
    "refine surface 1 size HALF bias 1.5 method single",
    "refine surface 1 size HALF method parallel",
    "refine surface 1 size HALF method combination bias 1.3",
    "refine surface 1 size HALF transition nested",
    "refine surface 1 direction thickness",
    "refine surface 1 direction layers 3 growth 1.2",
    "refine volume all",
    "refine volume all numsplit 2",
    "refine volume 1 method parallel depth 0",
    "refine volume all sizing_function \"HALF + 0.05*abs(x)\"",
    "refine hex 1 to 30 by 3 graded numsplit 2",
    "refine sheet edge 5",
    "refine sheet edge 5 factor 1.1",
    "refine volume 1 using surface 1",
};

std::string with_sizes(std::string command, double cell) {
  for (const auto& [word, size] : {std::pair{"SMALL", 0.3 * cell}, {"HALF", 0.5 * cell}, {"WIDE", 1.6 * cell}})
    if (const auto at = command.find(word); at != std::string::npos)
      command.replace(at, std::string_view(word).size(), std::to_string(size));
  return command;
}

void compare(Fixture& f, const std::string& command) {
  SCOPED_TRACE(command);
  const MeshedModel before = f.session.meshed();
  const std::string dry = f.error(command + " dry_run");
  EXPECT_EQ(f.session.meshed().mesh, before.mesh);
  const CommandRecord planned = f.last();
  const std::string real = f.error(command);
  if (real != "no error") {
    // What a dry run has not looked at, it does not promise; what it says must be the same.
    EXPECT_TRUE(dry == "no error" || dry == real) << dry << "\n" << real;
    return;
  }
  EXPECT_EQ(dry, "no error");
  EXPECT_TRUE(planned.dry_run);
  EXPECT_EQ(planned.after.hexes, f.session.meshed().mesh.n_hexes());
  EXPECT_EQ(planned.after.nodes, f.session.meshed().mesh.n_nodes());
  EXPECT_EQ(planned.filled_hexes, f.last().filled_hexes);
  f.session.run("undo");
}

double cell_of(const Mesh& mesh) {
  return std::cbrt(volume(mesh) / mesh.n_hexes());
}

TEST(DryRun, has_the_counts_of_the_real_run_for_every_technique_on_every_kind_of_model) {
  for (const char* start :
       {"create sphere radius 5 interval 2", "create brick x 4 interval 4", "create cylinder radius 2 height 3",
        "import brep 'inclusion.brep'; import mesh 'inclusion.msh'"}) {
    SCOPED_TRACE(start);
    Fixture f;
    std::string line = start;
    for (std::size_t at; (at = line.find('\'')) != std::string::npos;) {
      const std::size_t end = line.find('\'', at + 1);
      line = line.substr(0, at) + "\"" + HEXTWIST_SOURCE_DIR + "/models/" + line.substr(at + 1, end - at - 1) + "\"" +
             line.substr(end + 1);
    }
    f.session.run(line);
    const double cell = cell_of(f.session.meshed().mesh);
    for (const std::string& command : commands) compare(f, with_sizes(command, cell));
  }
}

TEST(DryRun, has_the_counts_of_the_real_run_on_levels) {
  Fixture f;
  f.session.run("create sphere radius 5 interval 2");
  const double cell = cell_of(f.session.meshed().mesh);
  f.session.run("refine surface 1 depth 1; refine hex 300 301 302");
  for (const char* command :
       {"refine hex 1 40 99", "refine hex 5 transition nested", "refine surface 1 size HALF bias 1.3",
        "refine vertex 1 radius WIDE", "refine curve 1 size SMALL", "refine volume all"})
    compare(f, with_sizes(command, cell));
}

}  // namespace
}  // namespace hextwist
