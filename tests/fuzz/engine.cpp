// Random forests: refinement of entities with levels, depths and techniques, coarsening, smoothing, undo and redo in
// any order. After each command the checkers, which share no code with the engine, have the word.
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "hextwist/session/session.h"
#include "support/checkers.h"

namespace {

using namespace hextwist;

class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : at_(data), end_(data + size) {}
  bool more() const { return at_ < end_; }
  int below(int n) { return more() ? *at_++ % n : 0; }

 private:
  const std::uint8_t *at_, *end_;
};

std::string next_command(Input& in, const Mesh& mesh) {
  const int what = in.below(16);
  if (mesh.n_hexes() == 0) return "redo";  // its making was undone
  if (what == 0) return "undo";
  if (what == 1) return "redo";
  if (what == 2) return "smooth volume all";
  const auto some = [&](Index n) {
    std::string text;
    for (int k = 1 + in.below(4); k > 0; --k)
      text += " " + std::to_string(1 + (in.below(251) * 251 + in.below(251)) % n);
    return text;
  };
  if (what < 5) return "coarsen hex in hex" + some(mesh.n_hexes()) + (what == 3 ? " levels 2" : "");
  static const char* kinds[] = {"hex", "node", "edge", "face", "surface", "curve", "vertex"};
  const int kind = in.below(7);
  std::string command = std::string("refine ") + kinds[kind] +
                        some(kind == 0   ? mesh.n_hexes()
                             : kind < 4  ? mesh.n_nodes()
                             : kind == 4 ? 6
                                         : 8);
  static const char* options[] = {
      "",        " depth 1",         " depth 2",      " numsplit 2",         " method single",
      " smooth", " method parallel", " concave fill", " size 0.3",           " transition nested",
      " graded", " depth 0",         " radius 0.4",   " direction thickness"};
  return command + options[in.below(14)] + options[in.below(5)];
}

/// Ends the program with the story unless it holds.
void require(const testing::AssertionResult& result, const std::string& story) {
  if (result) return;
  std::fprintf(stderr, "%s\n%s\n", story.c_str(), result.message());
  std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input in(data, size);
  Session session;
  std::string story =
      "create brick x 1 interval " + std::to_string(1 + in.below(3)) + "; block 1 volume 1; sideset 2 surface 3";
  session.run("set threads 1; " + story);
  constexpr std::int64_t most_hexes = 500;
  for (int n = 0; in.more() && n < 8; ++n) {
    const std::string command = next_command(in, session.meshed().mesh);
    const std::shared_ptr<const MeshedModel> before = session.share();
    try {
      if (command.starts_with("refine")) {
        session.run(command + " dry_run");
        if (session.records().back().after.hexes > most_hexes) continue;
      }
      session.run(command);
      story += "; " + command;
    } catch (const CommandError& error) {
      // Nothing happened, and never because the result was no good.
      require(testing::AssertionResult(session.meshed().mesh == before->mesh) << "changed by a failure",
              story + "; " + command);
      require(testing::AssertionResult(error.message().find("no good") == std::string::npos) << error.message(),
              story + "; " + command);
      continue;
    }
    const Mesh& mesh = session.meshed().mesh;
    require(test::conformal(mesh), story);
    require(test::uninverted(mesh), story);
    require(test::sets_valid(mesh), story);
  }
  return 0;
}
