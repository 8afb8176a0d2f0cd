// Goals 1, 2 and 4: the pass itself.
#include "hextwist/refine/split.h"

#include "floor.h"
#include "groups.h"
#include "hextwist/refine/carry.h"
#include "hextwist/refine/marks.h"
#include "hextwist/refine/templates/trisect.h"
#include "hextwist/refine/templates/uniform.h"
#include "measure.h"
#include "meshes.h"

#include <map>

namespace hextwist::bench {
namespace {

constexpr int side27 = 33, side8 = 50, side_ball = 100;

const Mesh& cube_of(int n) {
  static std::map<int, Mesh> made;
  const auto found = made.find(n);
  return found != made.end() ? found->second : made.emplace(n, cube(n)).first->second;
}
const std::vector<std::uint8_t>& ball(Concave concave) {
  static const auto plain = mark_ball(cube_of(side_ball), side_ball);
  static const auto filled = [] {
    auto marked = plain;
    fill_concave(cube_of(side_ball), marked);
    return marked;
  }();
  return concave == Concave::fill ? filled : plain;
}

Split split27() {
  const Mesh& mesh = cube_of(side27);
  static const auto marked = mark_all(mesh);
  return split(mesh.hexes, mesh.n_nodes(), trisect_table(), trisect_codes(mesh.hexes, marked));
}
Split split8() {
  const Mesh& mesh = cube_of(side8);
  return split(mesh.hexes, mesh.n_nodes(), uniform_table(2), std::vector<std::uint16_t>(mesh.hexes.size(), 1));
}
Split split_ball(Concave concave) {
  const Mesh& mesh = cube_of(side_ball);
  return split(mesh.hexes, mesh.n_nodes(), trisect_table(), trisect_codes(mesh.hexes, ball(concave)));
}
/// From marks to the new mesh, coordinates and groups and all.
Mesh whole(const Mesh& mesh, Split parts) {
  return carry(mesh, {}, parts).mesh;
}

std::size_t n_hexes(const Split& parts) {
  return parts.hexes.size();
}
std::size_t n_hexes(const Mesh& mesh) {
  return mesh.hexes.size();
}
std::size_t n_hexes(const Emitted& out) {
  return out.split.hexes.size();
}
constexpr auto hexes = [](const auto& result) { return n_hexes(result); };

/// 1 when 2 and 8 threads give the bytes of one.
double same_bytes() {
  const auto run = [](int threads) {
    const Threads limit(threads);
    return tbb::task_arena(threads).execute([] {
      return fingerprint(whole(cube_of(side_ball), split_ball(Concave::templates))) ^
             (fingerprint(whole(cube_of(side8), split8())) << 1);
    });
  };
  const auto one = run(1);
  return run(2) == one && run(8) == one;
}

}  // namespace

void add_split() {
  add_rate(
      "floor/all27", [] { return emit_structured(side27, 3, false); }, hexes);
  add_rate(
      "floor/all8", [] { return emit_structured(side8, 2, false); }, hexes);
  add_rate(
      "floor/all27_points", [] { return emit_structured(side27, 3, true); }, hexes);
  add_rate(
      "floor/all8_points", [] { return emit_structured(side8, 2, true); }, hexes);
  add_rate("split/all27", split27, hexes);
  add_rate("split/all8", split8, hexes);
  add_rate(
      "pass/all27", [] { return whole(cube_of(side27), split27()); }, hexes);
  add_rate(
      "pass/all8", [] { return whole(cube_of(side8), split8()); }, hexes);
  add_rate(
      "split/ball_templates", [] { return split_ball(Concave::templates); }, hexes);
  add_rate(
      "split/ball_fill", [] { return split_ball(Concave::fill); }, hexes);
  add_rate(
      "pass/ball_templates", [] { return whole(cube_of(side_ball), split_ball(Concave::templates)); }, hexes);
  add_rate(
      "pass/ball_fill", [] { return whole(cube_of(side_ball), split_ball(Concave::fill)); }, hexes);
}

void add_split_threads() {
  add_on_two_threads("threads/split_all27", split27, hexes);
  add_on_two_threads("threads/split_all8", split8, hexes);
  add_on_two_threads(
      "threads/split_ball", [] { return split_ball(Concave::templates); }, hexes);
  add_on_two_threads(
      "threads/pass_all27", [] { return whole(cube_of(side27), split27()); }, hexes);
  add_on_two_threads(
      "threads/pass_all8", [] { return whole(cube_of(side8), split8()); }, hexes);
  add_on_two_threads(
      "threads/pass_ball", [] { return whole(cube_of(side_ball), split_ball(Concave::templates)); }, hexes);
  add_value("split/same_bytes", same_bytes);
}

}  // namespace hextwist::bench
