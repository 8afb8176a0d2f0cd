// Single hex sheet operations: whole hexes and layers of them, and all of a model at once.
#include "hextwist/refine/templates/trisect.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/refine/marks.h"
#include "hextwist/refine/templates/uniform.h"
#include "hextwist/sizing/targets.h"
#include "hextwist/sizing/techniques/techniques_internal.h"

namespace hextwist {
namespace {

class Trisect : public Technique {
 public:
  explicit Trisect(State& state)
      : targets_(region_target(state.input, state.request.target, state.report.notices)),
        n_left_(std::get<Cuts>(state.request.how).numsplit) {}

  std::optional<Cut> next(State& state) override {
    if (n_left_ == 0) return std::nullopt;
    state.begin("close");
    const Mesh& mesh = state.mesh();
    std::vector<std::uint8_t> marked(mesh.points.size(), 0);
    mark_nodes(mesh.hexes, targets_, marked);
    std::vector<std::uint8_t> filled;
    if (state.request.concave == Concave::fill) state.report.filled_hexes += fill_concave(mesh, marked, &filled);
    const Turn turn{n_done_++, 0, 0};
    return Cut{trisect_table(), trisect_codes(mesh.hexes, marked), &mesh != &state.input.mesh, turn, std::move(filled)};
  }
  void follow(const Lineage& lineage, const Mesh&, const Mesh&) override {
    if (--n_left_ > 0) targets_ = children_of(lineage, targets_);
  }

 private:
  std::vector<Index> targets_;
  int n_left_, n_done_ = 0;
};

class Uniform : public Technique {
 public:
  explicit Uniform(State& state) : pieces_(std::get<Cuts>(state.request.how).numsplit + 1) {
    state.note("all volumes: uniform, every edge in " + std::to_string(pieces_) + " equal pieces");
  }
  std::optional<Cut> next(State& state) override {
    if (is_done_) return std::nullopt;
    return Cut{uniform_table(pieces_), std::vector<std::uint16_t>(state.mesh().hexes.size(), 1)};
  }
  void follow(const Lineage&, const Mesh&, const Mesh&) override { is_done_ = true; }

 private:
  int pieces_;
  bool is_done_ = false;
};

}  // namespace

std::unique_ptr<Technique> trisect_technique(State& state) {
  return std::make_unique<Trisect>(state);
}
std::unique_ptr<Technique> uniform_technique(State& state) {
  return std::make_unique<Uniform>(state);
}

}  // namespace hextwist
