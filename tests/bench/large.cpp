// Goals 5 and 10: memory. Each task runs in a process of its own (main.cpp --task).
#include "large.h"

#include <cmath>
#include <ctime>
#include <limits>

#include "groups.h"
#include "hextwist/refine/carry.h"
#include "hextwist/refine/marks.h"
#include "hextwist/refine/templates/trisect.h"
#include "hextwist/refine/templates/uniform.h"
#include "hextwist/session/session.h"
#include "measure.h"
#include "meshes.h"

namespace hextwist::bench {
namespace {

/// Peak beyond `before` over the bytes of input and output, and of who owns what; says what happened on stderr.
double ratio(std::size_t before, const Mesh& input, const Mesh& output, std::size_t owners, const char* what) {
  const double arrays = static_cast<double>(bytes(input) + bytes(output) + owners);
  const double peak = static_cast<double>(peak_memory() - before);
  std::fprintf(stderr, "%s: %.1f -> %.1f million hexes, arrays %.2f GiB, peak %.2f GiB, %.1f CPU s\n", what,
               1e-6 * input.n_hexes(), 1e-6 * output.n_hexes(), arrays / 0x1p30, peak / 0x1p30,
               static_cast<double>(std::clock()) / CLOCKS_PER_SEC);
  return peak / arrays;
}

}  // namespace

double run_task(const std::string& task, int n) {
  const std::size_t before = memory();
  if (task == "refine_uniform") {  // all that the program does: place, verify
    MeshedModel input = cube_on_brick(n);
    Request request;
    request.target.kind = EntityKind::volume;
    request.target.ids = {1};
    const RefineResult result = refine(input, request);
    return ratio(before, input.mesh, result.refined.mesh, bytes(input.association) + bytes(result.refined.association),
                 task.c_str());
  }
  if (task == "refine_hex") {
    MeshedModel input = cube_on_brick(n);
    Request request;
    request.target.ids = {middle_hex(n)};
    const RefineResult result = refine(input, request);
    return ratio(before, input.mesh, result.refined.mesh, bytes(input.association) + bytes(result.refined.association),
                 task.c_str());
  }
  if (task == "session_uniform") {  // a hex of the result, the step of undo included
    Session session;
    session.run("create brick x 10 interval " + std::to_string(n));
    session.run("refine volume all numsplit 1 method parallel");
    return static_cast<double>(peak_memory() - before) / session.meshed().mesh.n_hexes();
  }
  const Mesh mesh = cube(n);
  Split parts;
  if (task == "pass_all8") {
    const std::vector<std::uint16_t> codes(mesh.hexes.size(), 1);
    parts = split(mesh.hexes, mesh.n_nodes(), uniform_table(2), codes);
  } else if (task == "pass_all27" || task == "pass_ball") {
    const auto marked = task == "pass_ball" ? mark_ball(mesh, n) : mark_all(mesh);
    parts = split(mesh.hexes, mesh.n_nodes(), trisect_table(), trisect_codes(mesh.hexes, marked));
  } else {
    throw Error("there is no task " + task);
  }
  const Mesh refined = carry(mesh, {}, parts).mesh;
  return ratio(before, mesh, refined, 0, task.c_str());
}

void add_memory() {
  add_value("memory/pass_all8", [] { return peak_ratio("pass_all8 50"); });
  add_value("memory/pass_all27", [] { return peak_ratio("pass_all27 33"); });
  add_value("memory/pass_ball", [] { return peak_ratio("pass_ball 100"); });
  add_value("memory/refine_uniform", [] { return peak_ratio("refine_uniform 50"); });
  add_value("memory/session_uniform", [] { return peak_ratio("session_uniform 70"); });
  add_value("memory/refine_hex", [] { return peak_ratio("refine_hex 100"); });
}

}  // namespace hextwist::bench
