#include <algorithm>
#include <iterator>
#include <utility>

#include "hextwist/base/sorted.h"
#include "hextwist/mesh/quality/histogram.h"
#include "hextwist/patch/adapt.h"
#include "hextwist/refine/others.h"
#include "hextwist/session/commands/request.h"
#include "hextwist/session/load.h"
#include "hextwist/session/refining.h"
#include "hextwist/sizing/size_report.h"
#include "hextwist/sizing/stop_at.h"
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
    if (sizes.bias != 1 && splits)
      run.note("'bias' is how sizes grow: it changes nothing with numsplit");
    else if (sizes.bias != 1 && !is_asked)
      throw error_at(command.statement, growth->token,
                     "a bias other than 1 needs a size or a sizing function to grow from");
  }
  return is_asked ? std::optional(sizes) : std::nullopt;
}

std::string sizes_text(const Mesh& mesh, const SizeReport& sizes) {
  if (sizes.hexes.empty()) return "no hex has a wished size";
  std::string text =
      "actual / wished size of " + counted(static_cast<std::int64_t>(sizes.hexes.size()), EntityKind::hex) + " after " +
      counted(sizes.n_passes, "pass") + ": " + text_of_sizes(sizes.counts()) + "\n" + histogram(sizes.ratio);
  if (text.ends_with('\n')) text.pop_back();
  if (const auto& moved = sizes.moved;
      moved && (moved->n_coarser != sizes.n_coarser || moved->n_finer != sizes.n_finer))
    text += "\nafter nodes were moved for better shapes: " + text_of_sizes(*moved);
  if (sizes.directions)
    text += "\nof the " + std::to_string(3 * sizes.hexes.size()) + " directions of these hexes " +
            std::to_string(sizes.directions->n_longer) + " are longer than wished by more than sqrt(3), " +
            std::to_string(sizes.directions->n_shorter) + " shorter";
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
    const Mesh& mesh = run.meshed->mesh;
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
  if (command.has("graded") && (command.has("thickness") || layers || command.has("fill")))
    throw Error("graded cuts whole hexes: not in one direction, and not with concave fill");
  if (sizes) return *sizes;
  if (command.has("thickness")) return Thickness{numsplit};
  if (!layers) return Cuts{numsplit};
  if (numsplit != 1) throw Error("give a number of layers or numsplit, not both");
  Layers result{.n_layers = static_cast<int>(layers->number)};
  if (const Item* ratio = command.find("ratio")) result.growth = ratio->number;
  return result;
}

/// Nodes of a file may be corners of no hex (those of elements that were dropped): there is nothing to refine at them.
void check_nodes(const Execution& run, const Target& target) {
  if (target.kind != EntityKind::node) return;
  const Mesh& mesh = run.meshed->mesh;
  const auto is_loose = [&](Index n) { return !run.meshed->association.node_owner[n]; };
  if (std::ranges::none_of(target.ids, is_loose)) return;
  std::string ids;
  std::size_t n = 0;
  constexpr std::size_t most = 5;
  for (const Index node : target.ids) {
    if (!is_loose(node)) continue;
    if (n++ < most) ids += " " + std::to_string(node_id(mesh, node));
  }
  ids = std::string(n == 1 ? "node" : "nodes") + ids + (n > most ? " ..." : "") + (n == 1 ? " belongs" : " belong") +
        " to no hex";
  if (n == target.ids.size())
    throw error_at(run.command.statement, run.command.find("range")->range.token, "there is nothing to refine: " + ids);
  run.note(ids + ": nothing is refined there");
}

}  // namespace

std::vector<std::string> extensive_fields(const Execution& run) {
  std::vector<std::string> names;
  for (const Item& item : run.command.items)
    if (item.name == "field") names.push_back(item.text);
  check_extensive(run.meshed->mesh, names);
  return names;
}

Request request_of(const Execution& run) {
  const Command& command = run.command;
  Request request{
      .concave = command.has("fill") ? Concave::fill : Concave::templates,
      .finish = {
          .smooth = command.has("smooth"), .dry_run = command.has("dry_run"), .allow_off_cad = command.has("allow")}};
  if (run.state.fixed_nodes) request.finish.fixed = *run.state.fixed_nodes;
  request.finish.keep_jumps = run.state.keep_jumps;
  request.finish.extensive = extensive_fields(run);
  if (command.has("sheet")) {
    request.how = sheets_of(run);
    return request;
  }
  request.target = target_of(run);
  check_nodes(run, request.target);
  request.how = how_of(run);
  if (command.has("nested")) request.transition = Transition::nested;
  if (command.has("regular")) request.transition = Transition::regular;
  for (const Method method : {Method::automatic, Method::single, Method::parallel, Method::combination})
    if (command.has(name(method))) request.method = method;
  if (command.has("graded")) {
    if (request.method != Method::automatic && request.method != Method::single)
      throw Error("graded cuts whole hexes: it goes with 'method single' alone");
    if (request.transition == Transition::nested) throw Error("graded levels have a regular transition");
    request.transition = Transition::regular;
    request.method = Method::single;
    request.finish.level_field = true;
  }
  return request;
}

namespace {

std::string summary_of(const Report& report, bool has_cad, bool dry_run) {
  std::string line = std::to_string(report.hexes_before) + " -> " + counted(report.hexes_after, EntityKind::hex);
  if (report.filled_hexes > 0)
    line += " (" + std::to_string(report.filled_hexes) + " joined the region to make it convex)";
  if (dry_run) return line + ", " + counted(report.nodes_after, EntityKind::node) + "; nothing was changed";
  line += ", smallest shape " + short_number(report.shape_before.min) + " -> " + short_number(report.shape_after.min);
  return line + off_text(", ", report.off_cad, has_cad);
}

/// Notes and what goes on record; returns the line that is said in the end.
std::string tell(Execution& run, const Report& report, bool dry_run) {
  run.record().filled_hexes = report.filled_hexes;
  run.record().seconds.insert(run.record().seconds.end(), report.seconds.begin(), report.seconds.end());
  for (const std::string& line : report.notices) run.note(line);
  return text_of(run.command.statement) + ": " + summary_of(report, run.state.has_cad, dry_run);
}

/// `refine location x y z radius r`: hexes whose middle is that near.
Target hexes_near_point(const Execution& run) {
  const Command& command = run.command;
  const Mesh& mesh = run.meshed->mesh;
  const auto number = [&](std::string_view name) { return command.find(name)->number; };
  const Vec3 point(number("x"), number("y"), number("z"));
  const Item* radius = command.find("radius");
  if (const Item* layers = command.find("layers"))
    throw error_at(command.statement, layers->token, "give a depth or a radius, not both");
  if (!radius)
    throw error_at(command.statement, command.find("z")->token, "say how far around the point, such as 'radius 2'");
  const std::vector<Vec3> middle = centroids(mesh);
  Target target{.kind = EntityKind::hex};
  Index nearest = 0;
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    const double distance = (middle[h] - point).norm();
    if (distance <= radius->number) target.ids.push_back(h);
    if (distance < (middle[nearest] - point).norm()) nearest = h;
  }
  if (target.ids.empty())
    throw error_at(command.statement, radius->token,
                   "no hex has its middle within " + short_number(radius->number) + " of there; hex " +
                       std::to_string(hex_id(mesh, nearest)) + " comes nearest with " +
                       short_number((middle[nearest] - point).norm()));
  return target;
}

Target named_target(const Execution& run) {
  const Item& range = *run.command.find("range");
  Target target{.kind = range.kind, .ids = run.chosen(range)};
  if (is_cad(range.kind))
    for (Index& id : target.ids) ++id;
  if (const Item* layers = run.command.find("layers")) target.depth = static_cast<int>(layers->number);
  if (const Item* radius = run.command.find("radius")) target.radius = radius->number;
  return target;
}

/// `using surface 7`: of the target only what lies in these, or touches them; of volumes that are hexes.
void narrow(const Execution& run, Target& target) {
  const Item* which = run.command.find("which");
  if (!which) return;
  const Selector selector = run.core.selector();
  std::vector<Index> positions = target.ids;
  if (is_cad(target.kind))
    for (Index& id : positions) --id;
  if (dimension(target.kind) == 3 && target.kind != EntityKind::hex) {
    positions = related(selector, target.kind, positions, EntityKind::hex);
    target.kind = EntityKind::hex;
  }
  sort_unique(positions);
  const std::size_t before = positions.size();
  target.ids = intersection(positions, related(selector, which->kind, run.chosen(*which), target.kind));
  if (target.ids.empty())
    throw error_at(run.command.statement, which->range.token,
                   "none of the " + counted(static_cast<std::int64_t>(before), target.kind) + " lies there");
  run.note("'using': " + std::to_string(target.ids.size()) + " of " +
           counted(static_cast<std::int64_t>(before), target.kind) + (target.ids.size() == 1 ? " lies" : " lie") +
           " there");
  if (is_cad(target.kind))
    for (Index& id : target.ids) ++id;
}

/// With `stop_at other` of as much of the target as no other element stands in the way of.
Refining refining_of(Execution& run, const Request& request) {
  constexpr int max_layers = 100;
  for (int layers = 0;; ++layers) {
    std::vector<std::string> told;
    try {
      Refining refining =
          prepare_refining(run, layers == 0 ? request : away_from_others(*run.meshed, request, layers, told));
      for (const std::string& line : told) run.note(line);
      return refining;
    } catch (const BlockedByOther&) {
      if (!run.command.has("stop_at") || layers == max_layers) throw;
    }
  }
}

}  // namespace

Target target_of(const Execution& run) {
  const Command& command = run.command;
  Target target = command.find("x") ? hexes_near_point(run) : named_target(run);
  narrow(run, target);
  if (const Item* splits = command.find("splits"); splits && splits->number > max_numsplit)
    if (!is_whole_model(*run.meshed, target))
      throw error_at(command.statement, splits->token,
                     "numsplit must be at most " + std::to_string(max_numsplit) + " unless all volumes are refined");
  return target;
}

void do_refine(Execution& run) {
  need_mesh(run, "to refine");
  run.stage("select");
  const Request request = request_of(run);
  run.close_stage();
  Refining refining = refining_of(run, request);
  const Report& report = refining.report();
  const bool dry_run = refining.request.finish.dry_run;
  if (request.target.kind == EntityKind::node && !report.sizes && report.hexes_after == report.hexes_before)
    run.note(
        "nothing is cut: around nodes that is edges of which one end is among them and the other is not; "
        "'depth 1' cuts all hexes at them");
  const std::string line = tell(run, report, dry_run);
  if (dry_run) {
    if (const std::string wrong = record_violations(run.record(), refining.whole.refined.mesh, report.violations);
        !wrong.empty())
      throw Error("the result would be refused: " + wrong);
    run.record().dry_run = true;
    run.record().after.hexes = report.hexes_after;
    run.record().after.nodes = report.nodes_after;
    return run.say(line);
  }

  const std::optional<SizeReport> sizes = report.sizes;
  accept_refining(run, std::move(refining));
  run.say(line + ", " + short_number(run.seconds()) + " s");
  if (!sizes) return;
  run.record().sizes = sizes_row(run.meshed->mesh, *sizes);
  run.say(sizes_text(run.meshed->mesh, *sizes));
}

}  // namespace hextwist
