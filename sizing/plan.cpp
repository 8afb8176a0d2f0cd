// What a request means: its options checked, its technique chosen.
#include <cmath>

#include "hextwist/refine/templates/uniform.h"
#include "hextwist/sizing/pipeline.h"
#include "hextwist/sizing/targets.h"

namespace hextwist {
namespace {

bool is_directional(const Request& request) {
  return request.through_thickness || request.layers || request.sheets;
}

void check_direction(const Request& request) {
  if (request.through_thickness + request.layers.has_value() + request.sheets.has_value() > 1)
    throw Error("give one direction, not several");
  if (request.size || request.size_field || request.depth || request.radius || request.method != Method::automatic)
    throw Error("a direction goes with numsplit, not with sizes, depth, radius or a method");
  if (const auto& sheets = request.sheets) {
    if (sheets->edges.empty()) throw Error("no edge to choose a sheet by");
    if (sheets->greater_than && sheets->factor) throw Error("give greater_than or a factor, not both");
    if (request.numsplit != 1) throw Error("sheets are cut once: repeat the command instead of numsplit");
    return;
  }
  if (request.through_thickness && request.kind != TargetKind::surface && request.kind != TargetKind::face)
    throw Error(std::string("through the thickness means away from surfaces or faces, not from a ") +
                name(request.kind));
  if (!request.layers) return;
  if (is_solid(request.kind))
    throw Error(std::string("layers lie along nodes, edges and faces, not a ") + name(request.kind));
  if (request.layers->n_layers < 1 || request.layers->n_layers > 50)
    throw Error("the number of layers must be from 1 to 50");
  if (!(request.layers->growth >= 0.1 && request.layers->growth <= 10))
    throw Error("the growth of layers must be from 0.1 to 10");
  if (request.numsplit != 1) throw Error("give a number of layers or numsplit, not both");
}

bool is_size_driven(const Request& request) {
  return request.size || request.size_field;
}

void check_options(const Request& request) {
  const auto positive = [](double value) { return value > 0 && std::isfinite(value); };
  if (request.depth && *request.depth < 0) throw Error("depth must not be negative");
  if (request.radius && !(*request.radius >= 0 && std::isfinite(*request.radius)))
    throw Error("radius must be a number of at least 0");
  if (request.radius && request.depth) throw Error("give a depth or a radius, not both");
  if (request.radius && request.method == Method::combination)
    throw Error("a radius chooses whole hexes, the combination technique refines around nodes, edges and faces");
  if (!(request.bias >= 1 && std::isfinite(request.bias))) throw Error("bias must be a number of at least 1");
  if (!is_size_driven(request)) {
    if (request.bias != 1) throw Error("a bias other than 1 needs a size or a sizing function to grow from");
    return;
  }
  if (request.size && !positive(*request.size)) throw Error("size must be a positive number");
  if (request.numsplit != 1) throw Error("give numsplit or a size, not both");
  if (request.max_passes < 1 || request.max_passes > 30) throw Error("max_passes must be from 1 to 30");
  if (request.depth && *request.depth == 0 && !is_solid(request.kind) && request.method == Method::parallel)
    throw Error("sizes by one into eight need whole hexes to be cut: depth 1 or more");
  if (request.levels == Levels::graded && request.method == Method::combination)
    throw Error("graded levels need whole hexes to be cut: not the combination");
}

}  // namespace

void check(const MeshedModel& input, const Request& request) {
  if (input.mesh.hexes.empty()) throw Error("there is no mesh to refine");
  if (!request.sheets) check_targets(input, request);
  check_options(request);
  if (is_directional(request)) check_direction(request);
  if (request.numsplit < 1) throw Error("numsplit must be at least 1");
  const int limit = is_whole_model(input, request) && !is_directional(request) ? max_uniform_pieces - 1 : max_numsplit;
  if (request.numsplit > limit) throw Error("numsplit must be at most " + std::to_string(limit) + " here");
}

Method technique(const Request& request) {
  const bool solid = is_solid(request.kind);
  const bool has_depth = request.radius || request.depth.value_or(0) > 0;
  switch (request.method) {
    case Method::single:
      if (!solid && request.depth && !has_depth)
        throw Error("the single sheet technique refines whole hexes: it needs depth 1 or more");
      return Method::single;
    case Method::combination:
      if (solid)
        throw Error(std::string("the combination technique refines around nodes, edges and faces, not a ") +
                    name(request.kind));
      if (request.depth && has_depth) throw Error("the combination technique has depth 0");
      return Method::combination;
    case Method::parallel:
      return Method::parallel;
    case Method::automatic:
      break;
  }
  return solid || has_depth ? Method::single : Method::combination;
}

RefineResult run_passes(Pipeline& run) {
  run.stages().begin("targets", 0);
  const Request& request = run.request();
  const Method method = technique(request);
  if (request.sheets) {
    sheet_passes(run);
  } else if (request.through_thickness) {
    thickness_passes(run);
  } else if (request.layers) {
    layer_passes(run);
  } else if (is_size_driven(request)) {
    const bool at_target = request.depth && *request.depth == 0 && !is_solid(request.kind);
    if (method == Method::combination && (request.method == method || at_target))
      size_passes(run, SizeTechnique::combination);
    else if (request.method == Method::automatic)
      nearest_sizes(run);
    else
      size_passes(run, request.method == Method::parallel ? SizeTechnique::halves : SizeTechnique::thirds);
  } else if (is_whole_model(run.input(), request) && method == Method::single && !request.radius) {
    const int pieces = request.numsplit + 1;
    run.report().notices.push_back("all volumes: uniform, every edge in " + std::to_string(pieces) + " equal pieces");
    run.pass(uniform_table(pieces), std::vector<std::uint16_t>(run.input().mesh.hexes.size(), 1));
  } else if (method == Method::single) {
    trisect_passes(run);
  } else if (method == Method::parallel &&
             (is_solid(request.kind) || request.depth.value_or(0) > 0 || request.radius)) {
    eight_passes(run);
  } else {
    sub_element_passes(run, method);
  }
  if (&run.current() == &run.input()) run.keep();  // nothing was to be cut: one layer, say
  if (request.smooth && !request.dry_run) run.smooth_band();
  run.stages().begin("verify", 0.9);
  return run.take_result();
}

const char* name(TargetKind kind) {
  constexpr const char* names[] = {"node", "edge", "face", "hex", "vertex", "curve", "surface", "volume"};
  return names[static_cast<int>(kind)];
}

const char* name(Method method) {
  constexpr const char* names[] = {"auto", "single", "parallel", "combination"};
  return names[static_cast<int>(method)];
}

}  // namespace hextwist
