#include <algorithm>
#include <functional>
#include <iterator>

#include "hextwist/mesh/quality/histogram.h"
#include "hextwist/patch/refine_known.h"
#include "hextwist/patch/verify.h"
#include "hextwist/session/session_internal.h"
#include "hextwist/sizing/targets.h"

namespace hextwist {
namespace {

/// What is asked of sizes: nothing where no word is about them. The engine checks the rest, these have a place to point
/// at.
std::optional<Sizes> sizes_of(const Execution& run) {
  const Command& command = run.command;
  const Item* splits = command.find("splits");
  Sizes sizes;
  if (const Item* size = command.find("size")) {
    sizes.size = size->number;
    if (splits) throw error_at(command.statement, size->token, "give numsplit or a size, not both");
  }
  if (const Item* function = command.find("function")) {
    sizes.field = named_size(run, *function);
  } else if (const Item* expression = command.find("expression")) {
    sizes.field = typed_size(command, *expression);
  } else if (command.has("sizing_function")) {
    if (run.state.sizing.empty()) throw Error("there is no sizing function; define one with 'sizing function'");
    sizes.field = run.state.sizing.at(run.state.last_sizing).field;
  }
  if (sizes.field && splits)
    throw error_at(command.statement, splits->token, "give numsplit or a sizing function, not both");
  const bool is_asked = sizes.size || sizes.field;
  if (const Item* growth = command.find("growth")) {
    sizes.bias = growth->number;
    if (sizes.bias != 1 && !is_asked)
      throw error_at(command.statement, growth->token,
                     "a bias other than 1 needs a size or a sizing function to grow from");
  }
  return is_asked ? std::optional(sizes) : std::nullopt;
}

SizesRow sizes_row(const Mesh& mesh, const SizeReport& sizes) {
  SizesRow row;
  row.hexes = static_cast<std::int64_t>(sizes.hexes.size());
  row.coarser = sizes.n_coarser;
  row.finer = sizes.n_finer;
  row.much_finer = sizes.n_much_finer;
  row.passes = sizes.n_passes;
  row.met = sizes.met();
  if (!sizes.ratio.empty()) {
    const auto [least, most] = std::ranges::minmax(sizes.ratio);
    row.smallest_ratio = least;
    row.largest_ratio = most;
  }
  row.n_unmet = static_cast<std::int64_t>(sizes.unmet.size());
  for (std::size_t i = 0; i < std::min(sizes.unmet.size(), max_violation_rows); ++i)
    row.unmet.push_back(hex_id(mesh, sizes.unmet[i]));
  return row;
}

std::string sizes_text(const Mesh& mesh, const SizeReport& sizes) {
  std::string text =
      "actual / wished size of " + counted(static_cast<std::int64_t>(sizes.hexes.size()), EntityKind::hex) + " after " +
      counted(sizes.n_passes, "pass") + ": " + short_number(100 * sizes.met()) + "% within a factor of sqrt(3), " +
      std::to_string(sizes.n_coarser) + " coarser, " + std::to_string(sizes.n_finer) + " finer (" +
      std::to_string(sizes.n_much_finer) + " by more than 3)\n" + histogram(sizes.ratio);
  if (text.ends_with('\n')) text.pop_back();
  if (!sizes.unmet.empty())
    text += "\n" + counted(static_cast<std::int64_t>(sizes.unmet.size()), EntityKind::hex) +
            " are still too large, the first: hex " + std::to_string(hex_id(mesh, sizes.unmet.front()));
  return text;
}

/// `refine sheet ...`.
AcrossSheets sheets_of(const Execution& run) {
  const Command& command = run.command;
  AcrossSheets request;
  if (const Item* range = command.find("range")) {
    request.edges = run.chosen(*range);
  } else {
    const Mesh& mesh = run.state.meshed->mesh;
    std::array<Index, 2> nodes{};
    for (int i = 0; i < 2; ++i) {
      const Item& said = *command.find(i == 0 ? "first" : "second");
      nodes[i] = find_node(mesh, static_cast<std::int64_t>(said.number));
      if (nodes[i] < 0) throw error_at(command.statement, said.token, "there is no node " + short_number(said.number));
    }
    request.edges = {find_edge(run.core.selector().topology.edges(), nodes[0], nodes[1])};
    if (request.edges.front() < 0)
      throw error_at(command.statement, command.find("second")->token, "no edge joins these nodes");
  }
  request.crossing = command.has("intersect");
  if (const Item* length = command.find("length")) request.greater_than = length->number;
  if (const Item* multiple = command.find("multiple")) request.factor = multiple->number;
  return request;
}

How how_of(const Execution& run) {
  const Command& command = run.command;
  const Item* splits = command.find("splits");
  const int numsplit = splits ? static_cast<int>(splits->number) : 1;
  const std::optional<Sizes> sizes = sizes_of(run);
  const Item* layers = command.find("n");
  if ((command.has("thickness") || layers) && sizes)
    throw Error("a direction goes with numsplit, not with sizes, depth, radius or a method");
  if (command.has("graded") && (numsplit != 1 || sizes || command.has("thickness") || layers))
    throw Error("graded cuts whole hexes once: it goes with depth, radius and concave only");
  if (sizes) return *sizes;
  if (command.has("thickness")) return Thickness{numsplit};
  if (!layers) return Cuts{numsplit};
  if (numsplit != 1) throw Error("give a number of layers or numsplit, not both");
  Layers result{.n_layers = static_cast<int>(layers->number)};
  if (const Item* ratio = command.find("ratio")) result.growth = ratio->number;
  return result;
}

Target target_of(const Execution& run) {
  const Command& command = run.command;
  const Item& range = *command.find("range");
  Target target{.kind = range.kind, .ids = run.chosen(range)};
  if (is_cad(range.kind))
    for (Index& id : target.ids) ++id;
  if (const Item* splits = command.find("splits"); splits && splits->number > max_numsplit)
    if (!is_whole_model(*run.state.meshed, target))
      throw error_at(command.statement, splits->token,
                     "numsplit must be at most " + std::to_string(max_numsplit) + " unless all volumes are refined");
  if (const Item* layers = command.find("layers")) target.depth = static_cast<int>(layers->number);
  if (const Item* radius = command.find("radius")) target.radius = radius->number;
  return target;
}

Request request_of(const Execution& run) {
  const Command& command = run.command;
  Request request{.concave = command.has("fill") ? Concave::fill : Concave::templates,
                  .finish = {.smooth = command.has("smooth"), .dry_run = command.has("dry_run")}};
  if (run.state.fixed_nodes) request.finish.fixed = *run.state.fixed_nodes;
  if (command.has("sheet")) {
    request.how = sheets_of(run);
    return request;
  }
  request.target = target_of(run);
  request.how = how_of(run);
  for (const Method method : {Method::automatic, Method::single, Method::parallel, Method::combination})
    if (command.has(name(method))) request.method = method;
  if (!command.has("graded")) return request;
  if (request.method != Method::automatic)
    throw Error("graded cuts whole hexes once: it goes with depth, radius and concave only");
  request.levels = Levels::graded;
  return request;
}

/// What the session knows of its mesh, so that it need not be measured again.
Measured known_of(const SessionState& state) {
  const auto summary = [&](const QualityRow& row) {
    const Mesh& mesh = state.meshed->mesh;
    return Summary{
        static_cast<Index>(row.count), row.average, row.std_dev, row.min, row.max, find_hex(mesh, row.min_hex),
        find_hex(mesh, row.max_hex)};
  };
  return {summary(state.mesh_state.shape), summary(state.mesh_state.scaled_jacobian), state.mesh_state.volume,
          state.off_cad, state.extremes};
}

std::string summary_of(const Report& report, bool has_cad, bool dry_run) {
  std::string line = std::to_string(report.hexes_before) + " -> " + counted(report.hexes_after, EntityKind::hex);
  if (report.filled_hexes > 0)
    line += " (" + std::to_string(report.filled_hexes) + " joined the region to make it convex)";
  if (dry_run) return line + ", " + counted(report.nodes_after, EntityKind::node) + "; nothing was changed";
  line += ", smallest shape " + short_number(report.shape_before.min) + " -> " + short_number(report.shape_after.min);
  if (report.off_cad.node >= 0)
    line += ", nodes at most " + short_number(report.off_cad.max) + " off " + (has_cad ? "the CAD" : "the skin");
  return line + ", " + short_number(report.total_seconds) + " s";
}

/// What nodes and hexes of a result are called.
struct Ids {
  std::function<std::int64_t(Index)> hex, node;

  QualityRow row(const Summary& of) const {
    if (of.count == 0) return {};
    return {of.count, of.min, of.max, of.average, of.std_dev, hex(of.min_hex), hex(of.max_hex)};
  }
};

/// The state after a refinement, but for the mesh and its size, and what is to be said of nodes off the CAD. The engine
/// measured the result already.
ModelState state_after(const Execution& run, const Report& report, const Ids& ids) {
  if (!report.off_nodes.empty()) {
    const auto worst = std::ranges::max_element(report.off_nodes, {}, &OffOwner::distance);
    run.note(counted(static_cast<std::int64_t>(report.off_nodes.size()), EntityKind::node) +
             " could not be put where they belong; the worst is node " + std::to_string(ids.node(worst->node)) + ", " +
             short_number(worst->distance) + " from " + to_string(worst->owner));
  }
  ModelState state = run.state;
  state.mesh_state.shape = ids.row(report.shape_after);
  state.mesh_state.scaled_jacobian = ids.row(report.scaled_jacobian_after);
  state.mesh_state.volume = report.volume_after;
  state.off_cad = report.off_cad;
  state.extremes = report.extremes;
  state.tags = nullptr;
  return state;
}

/// Notes and what goes on record; returns the line that is said in the end.
std::string tell(Execution& run, const Report& report, bool dry_run) {
  run.record.filled_hexes = report.filled_hexes;
  run.record.seconds.insert(run.record.seconds.end(), report.seconds.begin(), report.seconds.end());
  for (const std::string& line : report.notices) run.note(line);
  return text_of(run.command.statement) + ": " + summary_of(report, run.state.has_cad, dry_run);
}

/// Puts a refined patch into the mesh.
void splice_in(Execution& run, PatchResult patch) {
  const Mesh& mesh = run.state.meshed->mesh;
  const std::shared_ptr<const Splice> splice = std::move(patch.splice);
  const Report& report = patch.result.report;
  const std::string line = tell(run, report, false);
  ModelState next = state_after(
      run, report,
      {[&](Index h) { return splice->new_hex_id(mesh, h); }, [&](Index n) { return splice->new_node_id(mesh, n); }});
  next.mesh_state.hexes = report.hexes_after;
  next.mesh_state.nodes = report.nodes_after;
  next.meshed = nullptr;
  Step back(text_of(run.command.statement), run.state, splice, false);
  run.splice(std::vector{SpliceStep{splice, true}}, std::move(next), {line});
  run.step = std::move(back);
}

}  // namespace

void accept_refined(Execution& run, MeshedModel refined, const Report& report) {
  const Mesh& mesh = refined.mesh;
  const std::string wrong = record_violations(run.record, mesh, report.violations);
  if (!wrong.empty()) throw Error("the result would be no good and is dropped: " + wrong);
  ModelState next =
      state_after(run, report, {[&](Index h) { return hex_id(mesh, h); }, [&](Index n) { return node_id(mesh, n); }});
  next.mesh_state.hexes = mesh.n_hexes();
  next.mesh_state.nodes = mesh.n_nodes();
  next.meshed = std::make_shared<MeshedModel>(std::move(refined));
  static_cast<ModelState&>(run.state) = std::move(next);
}

void do_refine(Execution& run) {
  SessionState& state = run.state;
  if (state.meshed->mesh.n_hexes() == 0)
    throw error_at(run.command.statement, run.command.items.front().token, "there is no mesh to refine");
  run.stage("select");
  const Request request = request_of(run);
  run.close_stage();
  const Measured known = known_of(state);
  std::optional<PatchResult> patch = refine_in_patch(run, known, request);
  if (patch && patch->is_verified) return splice_in(run, std::move(*patch));
  RefineResult result = patch ? whole_result(std::move(*patch), *state.meshed, known, request)
                              : refine_whole(*state.meshed, &known, request, run.core.callbacks.progress);
  const Report& report = result.report;
  const std::string line = tell(run, report, request.finish.dry_run);
  if (request.finish.dry_run) {
    run.record.dry_run = true;
    run.record.after.hexes = report.hexes_after;
    run.record.after.nodes = report.nodes_after;
    return run.say(line);
  }

  accept_refined(run, std::move(result.refined), report);
  run.say(line);
  if (!report.sizes) return;
  run.record.sizes = sizes_row(state.meshed->mesh, *report.sizes);
  run.say(sizes_text(state.meshed->mesh, *report.sizes));
}

}  // namespace hextwist
