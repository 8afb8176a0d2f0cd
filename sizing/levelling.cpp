#include "hextwist/sizing/levelling.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "hextwist/base/interrupt.h"
#include "hextwist/base/memory.h"
#include "hextwist/base/sorted.h"
#include "hextwist/base/text.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/mesh/nodal_fields.h"
#include "hextwist/sizing/sizes_of_all.h"
#include "hextwist/sizing/targets.h"
#include "hextwist/sizing/techniques/level_sizes_internal.h"
#include "hextwist/sizing/techniques/techniques_internal.h"

namespace hextwist {
namespace {

constexpr const char* level_name = "level";

/// make: else null where there is none.
Field* level_field_of(Mesh& mesh, bool make) {
  if (const Field* found = level_field(mesh)) return &mesh.fields[static_cast<std::size_t>(found - mesh.fields.data())];
  if (!make) return nullptr;
  return &mesh.fields.emplace_back(Field{level_name, Field::On::hex, 1, std::vector<double>(mesh.hexes.size())});
}

/// Throws Error when what is asked for cannot fit into memory.
void check_fits(const Mesh& mesh, std::size_t n_cut, int numsplit) {
  const double n = mesh.n_hexes() + static_cast<double>(n_cut) * (std::pow(n_cell_children, numsplit) - 1);
  check_memory(n, n, "at least ");
}

/// The request's levelling, grown.
Levelling start_of(const State& state) {
  const MeshedModel& input = state.input;
  Levelling start;
  if (state.request.levelling) {
    start = *state.request.levelling;
  } else {  // for as long as the request runs
    start.forest = plant(std::shared_ptr<const MeshedModel>(std::shared_ptr<void>(), &input));
  }
  if (const auto& periodic = state.request.finish.periodic; periodic && !start.forest.mirror)
    start.forest.mirror = mirror_of(*start.forest.base, periodic->pairs);
  start.forest = with_stack(grown(std::move(start.forest)), input.mesh);
  return start;
}

/// What both need of a state.
struct LevelRun {
  State& state;
  Levelling from;
  LevelOptions options;
  bool stopped = false;
  Interruptible interruptible;

  explicit LevelRun(State& of)
      : state(of), from(start_of(of)), interruptible([this] {
          if (!state.stages.report("levels", state.fraction())) throw Cancelled();
        }) {
    const Finish& finish = state.request.finish;
    options.extensive = finish.extensive;
    options.keep_jumps = finish.keep_jumps;
    std::ranges::copy_if(finish.fixed, std::back_inserter(options.fixed),
                         [&](Index n) { return n < from.forest.base->mesh.n_nodes(); });
    options.progress = [this](const char* stage, double) {
      stopped |= !state.stages.report(stage, state.fraction());
      return !stopped;
    };
  }
  LevelStep change(LevelMarks wished) {
    LevelStep step = hextwist::change(from.forest, state.input.mesh, std::move(wished), options);
    if (stopped) throw Cancelled();
    return step;
  }
  /// is_bare: the forest has no wishes any more.
  void adopt(LevelStep step, bool is_bare);
  void adopt(LevelStep step) {
    const bool is_bare = step.forest.is_bare();
    adopt(std::move(step), is_bare);
  }
};

/// Of these (ascending) in new hexes: where they are is not where the forest puts them.
Index n_fixed_off_cells(const Overlay& overlay, std::span<const Index> pinned, const LevelStep& step) {
  std::vector<std::uint8_t> is_off(step.old_node.size(), 0);
  for (const Index n : overlay.nodes) is_off[n] = std::ranges::binary_search(pinned, step.old_node[n]);
  Index count = 0;
  for (Index h = 0; h < step.mesh.mesh.n_hexes(); ++h)
    if (step.origin.kind[h] != HexOrigin::same)
      for (const Index n : step.mesh.mesh.hexes[h]) count += std::exchange(is_off[n], std::uint8_t{0});
  return count;
}

void LevelRun::adopt(LevelStep step, bool is_bare) {
  const Request& request = state.request;
  std::vector<Index> pinned = request.finish.fixed;
  std::ranges::sort(pinned);
  Index n_dropped = 0;
  std::vector<Vec3> straight;  // where fields have been evaluated
  if (has_nodal_fields(state.input.mesh)) straight = step.mesh.mesh.points;
  if (is_bare) from.overlay = {};  // as if nothing had ever been done
  Overlay overlay = put_on(from.overlay, state.input.mesh, state.input.association, pinned, step, n_dropped);
  if (n_dropped > 0)
    state.note(counted(n_dropped, "node") +
               " that had been moved for better shapes went back, as hexes around changed");
  if (const Index n = pinned.empty() ? 0 : n_fixed_off_cells(overlay, pinned, step); n > 0)
    state.note(counted(n, "fixed node") +
               (n == 1 ? " stays where it had been moved to" : " stay where they had been moved to") +
               ": what is cut around has been placed without that");
  tell_forced(step.n_forced, state.report);
  std::ranges::move(step.off_nodes, std::back_inserter(state.report.off_nodes));
  if (step.is_repaired) state.report.by_whole = repaired_together;
  RefineResult result;
  result.refined = std::move(step.mesh);
  const std::vector<std::uint8_t> level = levels_of(step.forest);
  if (Field* const field = level_field_of(result.refined.mesh, request.finish.level_field))
    std::ranges::copy(level, field->values.begin());
  result.origin.resize(level.size());
  for (std::size_t h = 0; h < level.size(); ++h) result.origin[h] = step.origin.before(static_cast<Index>(h)).front();
  result.levelling = std::make_shared<const Levelling>(Levelling{std::move(step.forest), std::move(overlay)});
  result.came_from = std::move(step.origin);
  result.old_node = std::move(step.old_node);
  state.is_renumbered = has_levels(request);
  state.adopt(std::move(result), std::move(straight));
}

}  // namespace

const Field* level_field(const Mesh& mesh) {
  const auto found = std::ranges::find_if(mesh.fields, [](const Field& field) {
    return field.name == level_name && field.on == Field::On::hex && field.components == 1;
  });
  return found == mesh.fields.end() ? nullptr : &*found;
}

LevellingPtr with_base(const LevellingPtr& levelling, const std::function<void(MeshedModel& base)>& change) {
  if (!levelling) return nullptr;
  auto base = std::make_shared<MeshedModel>(*levelling->forest.base);
  change(*base);
  auto result = std::make_shared<Levelling>(*levelling);
  result->forest.base = std::move(base);
  return result;
}

void tell_forced(Index n_forced, Report& report) {
  report.graded_cells += n_forced;
  if (n_forced > 0)
    report.notices.push_back("cut " + counted(n_forced, "cell") +
                             " more than asked for, so that no piece of a transition is cut");
}

LevelMarks wishes_of(const Forest& forest, const MeshedModel& input, const Request& request,
                     std::vector<std::string>& notices) {
  if (const auto* changes = std::get_if<LevelChanges>(&request.how)) return wishes(forest, changes->by);
  const int numsplit = std::get<Cuts>(request.how).numsplit;
  const std::vector<Index> cut = region_target(input, request.target, notices);
  check_fits(input.mesh, cut.size(), numsplit);
  return wishes(forest, cut, numsplit);
}

void run_levels(State& state, KnownLevels& known) {
  state.begin("levels");
  LevelRun run(state);
  run.options.graded = &known.graded;
  LevelStep step = run.change(known.wished);
  known.is_repaired = step.is_repaired;
  step.n_forced = known.n_forced;
  run.adopt(std::move(step), known.is_bare);
  if (state.part) state.report.sizes = level_size_report(state.result(), state);
}

void run_levels(State& state) {
  state.begin("levels");
  LevelRun run(state);
  std::optional<LevelSizes> sizes;
  if (std::holds_alternative<Sizes>(state.request.how)) sizes.emplace(run.from.forest, state);
  LevelStep step = run.change(sizes ? sizes->wishes(run.options)
                                    : wishes_of(run.from.forest, state.input, state.request, state.report.notices));
  run.adopt(std::move(step));
  const RefineResult& result = state.result();
  if (sizes) state.report.sizes = sizes->report(result);
  if (!state.part) return;
  for (std::size_t h = 0; h < result.origin.size(); ++h)
    if (result.came_from.kind[h] != HexOrigin::same) state.part->note_cut(result.origin[h]);
}

LevelMarks size_wishes(State& state) {
  state.begin("levels");
  LevelRun run(state);
  return LevelSizes(run.from.forest, state).wishes(run.options);
}

bool run_combination_by_levels(State& state) {
  const Target& target = state.request.target;
  const bool is_bare = !has_levels(state.request);
  if (!is_bare && !is_cad(target.kind)) return false;
  state.begin("levels");
  LevelRun run(state);
  run.options.keep_meshes = true;
  const Cuts& cuts = std::get<Cuts>(state.request.how);
  // What the target is in the mesh of a step.
  std::vector<std::string> told;  // again
  const auto target_in = [&](const LevelStep& step) {
    if (is_cad(target.kind)) return sub_element_target(step.mesh, target, told);
    CombinationTarget there = sub_element_target(state.input, target, told);
    for (const auto& pass : step.forest.grown->stack) there = carried_target(there, pass->lineage, pass->mesh->mesh);
    return there;
  };
  LevelStep step;
  step.forest = run.from.forest;
  CombinationTarget at = sub_element_target(state.input, target, state.report.notices);
  const Mesh* mesh = &state.input.mesh;
  for (int level = 1; level < cuts.numsplit; ++level) {
    const std::vector<Index> touching = layers_around(*mesh, at.nodes, 1);
    check_fits(*mesh, touching.size(), 1);
    LevelMarks wished = wishes(step.forest, touching, 1);
    step = run.change(std::move(wished));
    run.options.reuse = step.forest.grown->stack;
    at = target_in(step);
    mesh = &step.mesh.mesh;
  }
  run.adopt(std::move(step));
  state.run(*enclose_technique(state, std::move(at)));
  return true;
}

LevellingPtr levelling_after(const Request& request, const RefineResult& result, const MeshedModel& refined) {
  if (!request.levelling || request.finish.dry_run) return nullptr;
  LevellingPtr after = result.levelling;
  if (!after) {
    if (has_levels(request) || !is_regular(request)) return nullptr;
    // A pass over a base, or levels in a patch of it.
    const Forest& bare = request.levelling->forest;
    const Approach approach = plan(*bare.base, request).approach;
    if (approach != Approach::trisect && approach != Approach::levels) return nullptr;
    std::vector<std::string> told;  // again
    const std::vector<Index> cut = region_target(*bare.base, request.target, told);
    after = std::make_shared<const Levelling>(Levelling{plant(bare.base, cut, std::get<Cuts>(request.how).numsplit)});
  }
  return result.smoothed.empty() ? after : levelling_after_move(after, result.smoothed, refined);
}

LevellingPtr levelling_after_move(const LevellingPtr& before, std::span<const Index> moved, const MeshedModel& meshed) {
  if (!before || before->forest.is_bare()) return nullptr;
  return std::make_shared<const Levelling>(Levelling{before->forest, overlay_after(before->overlay, moved, meshed)});
}

LevellingPtr without_stack(const LevellingPtr& levelling) {
  if (!levelling || !levelling->forest.grown || !levelling->forest.grown->has_stack) return levelling;
  const GrownForest& grown = *levelling->forest.grown;
  auto rest = std::make_shared<GrownForest>();
  rest->marks = grown.marks;
  rest->hexes = grown.hexes;
  rest->next_node_id = grown.next_node_id;
  rest->next_hex_id = grown.next_hex_id;
  Levelling result = *levelling;
  result.forest.grown = std::move(rest);
  return std::make_shared<const Levelling>(std::move(result));
}

std::size_t bytes_of(const Levelling& levelling) {
  std::size_t sum = 0;
  const auto add = [&](const auto& list) { sum += list.size() * sizeof list[0]; };
  const auto add_marks = [&](const LevelMarks& marks) {
    for (const CellMarks& level : marks) {
      add(level.cell);
      add(level.corners);
    }
  };
  add_marks(levelling.forest.wished);
  if (levelling.forest.grown) {
    add_marks(levelling.forest.grown->marks);
    add(levelling.forest.grown->hexes.cut);
    add(levelling.forest.grown->hexes.cell);
    add(levelling.forest.grown->hexes.origin);
  }
  add(levelling.overlay.nodes);
  add(levelling.overlay.points);
  add(levelling.overlay.parameters);
  return sum;
}

void raise_levels(const Lineage& lineage, bool make, Mesh& refined) {
  Field* const field = level_field_of(refined, make);
  if (!field) return;
  for (const CutHex& cut : lineage.hexes) {
    const HexTemplate& pieces = lineage.table->hex(cut.code);
    if (std::ranges::count(pieces.edge_code, 0) > 0) continue;
    for (std::size_t i = 0; i < pieces.children.size(); ++i)
      ++field->values[static_cast<std::size_t>(cut.first_child) + i];
  }
}

}  // namespace hextwist
