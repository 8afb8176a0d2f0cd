#include "hextwist/sizing/plan.h"

#include <cmath>

#include "hextwist/refine/templates/uniform.h"
#include "hextwist/sizing/levelling.h"
#include "hextwist/sizing/targets.h"

namespace hextwist {
namespace {

bool has_depth(const Target& target) {
  return target.radius || target.depth.value_or(0) > 0;
}

std::string the(EntityKind kind) {
  return "a " + std::string(name(kind));
}

void check_target(const Target& target, Method method) {
  if (target.depth && *target.depth < 0) throw Error("depth must not be negative");
  if (target.radius && !(*target.radius >= 0 && std::isfinite(*target.radius)))
    throw Error("radius must be a number of at least 0");
  if (target.radius && target.depth) throw Error("give a depth or a radius, not both");
  if (target.radius && method == Method::combination)
    throw Error("a radius chooses whole hexes, the combination technique refines around nodes, edges and faces");
}

void check_numsplit(int numsplit, int limit) {
  if (numsplit < 1) throw Error("numsplit must be at least 1");
  if (numsplit > limit) throw Error("numsplit must be at most " + std::to_string(limit) + " here");
}

void check_direction(const Request& request) {
  if (request.target.depth || request.target.radius || request.method != Method::automatic)
    throw Error("a direction goes with numsplit, not with sizes, depth, radius or a method");
}

/// The technique of the paper that the target and the method ask for.
Method technique_of(const Request& request) {
  const Target& target = request.target;
  const bool solid = is_solid(target.kind), deep = has_depth(target);
  switch (request.method) {
    case Method::single:
      if (!solid && target.depth && !deep)
        throw Error("the single sheet technique refines whole hexes: it needs depth 1 or more");
      return Method::single;
    case Method::combination:
      if (solid)
        throw Error("the combination technique refines around nodes, edges and faces, not " + the(target.kind));
      if (target.depth && deep) throw Error("the combination technique has depth 0");
      return Method::combination;
    case Method::parallel:
      return Method::parallel;
    case Method::automatic:
      break;
  }
  return solid || deep ? Method::single : Method::combination;
}

Plan plan_how(const MeshedModel& input, const Request& request, const Cuts& cuts) {
  const Target& target = request.target;
  const bool solid = is_solid(target.kind), deep = has_depth(target);
  const bool whole = is_whole_model(input, target);
  const Method method = technique_of(request);
  const bool uniform = whole && method == Method::single && !target.radius;
  check_numsplit(cuts.numsplit, whole ? max_uniform_pieces - 1 : max_numsplit);
  if (uniform) return {Approach::uniform};
  if (method == Method::parallel && (solid || deep)) return {Approach::eight};  // planned by sheets
  if (method == Method::parallel) return {Approach::parallel, 2};
  if (method == Method::combination && cuts.numsplit > 1 && is_regular(request)) {  // by levels before
    if (has_levels(request)) return {Approach::combination};
    return {Approach::combination, 3};
  }
  if (method == Method::combination) return {Approach::combination, 2};
  const int reach = target.radius ? 1 : target.depth.value_or(solid ? 0 : 1) + 1;
  if (request.finish.periodic && is_regular(request)) return {Approach::levels};  // marks go to images
  if (!is_regular(request) || (cuts.numsplit == 1 && !has_levels(request))) return {Approach::trisect, reach};
  if (has_levels(request)) return {Approach::levels};  // from the base on
  return {Approach::levels, reach + 1};                // all rings that further levels add are within one of the first
}

Plan plan_how(const MeshedModel&, const Request& request, const Sizes& sizes) {
  const Target& target = request.target;
  if (!(sizes.bias >= 1 && std::isfinite(sizes.bias))) throw Error("bias must be a number of at least 1");
  if (!sizes.size && !sizes.field)
    throw Error(sizes.bias != 1 ? "a bias other than 1 needs a size or a sizing function to grow from"
                                : "give a size or a sizing function");
  if (sizes.size && !(*sizes.size > 0 && std::isfinite(*sizes.size))) throw Error("size must be a positive number");
  if (sizes.coarsen && !is_regular(request))
    throw Error("sizes become coarser by levels only: not with a nested transition or filled regions");
  if (sizes.max_passes < 1 || sizes.max_passes > 30) throw Error("max_passes must be from 1 to 30");
  const bool exactly = target.depth && *target.depth == 0 && !is_solid(target.kind);
  if (exactly && request.method == Method::parallel)
    throw Error("sizes by one into eight need whole hexes to be cut: depth 1 or more");
  const Method method = technique_of(request);
  if (method == Method::combination && (request.method == method || exactly)) return {Approach::size_by_combination};
  if (request.method == Method::parallel) return {Approach::size_by_halves};
  const bool by_levels = is_regular(request) &&
                         (request.transition == Transition::regular || has_levels(request) || request.finish.periodic);
  if (by_levels || sizes.coarsen) return {Approach::size_by_levels};
  if (request.method == Method::single)
    return {is_regular(request) ? Approach::nearest_size : Approach::size_by_threes};
  // Where the wish changes from place to place, halved regions have steps for
  // sides, which twos meet badly: nothing to choose from, but for a size that grows from the target, which the
  // combination may meet better there.
  const bool varies = sizes.bias > 1 || sizes.field;
  return {varies && !may_combine(target, sizes) && !is_regular(request) ? Approach::size_by_threes
                                                                        : Approach::nearest_size};
}

Plan plan_how(const MeshedModel&, const Request& request, const Thickness& thickness) {
  check_direction(request);
  const EntityKind kind = request.target.kind;
  if (kind != EntityKind::surface && kind != EntityKind::face)
    throw Error("through the thickness means away from surfaces or faces, not from " + the(kind));
  check_numsplit(thickness.numsplit, max_numsplit);
  return {Approach::thickness};
}

Plan plan_how(const MeshedModel&, const Request& request, const Layers& layers) {
  check_direction(request);
  if (is_solid(request.target.kind))
    throw Error("layers lie along nodes, edges and faces, not " + the(request.target.kind));
  if (layers.n_layers < 1 || layers.n_layers > 50) throw Error("the number of layers must be from 1 to 50");
  if (!(layers.growth >= 0.1 && layers.growth <= 10)) throw Error("the growth of layers must be from 0.1 to 10");
  return {Approach::layers};
}

Plan plan_how(const MeshedModel&, const Request& request, const AcrossSheets& sheets) {
  check_direction(request);
  if (sheets.edges.empty()) throw Error("no edge to choose a sheet by");
  if (sheets.greater_than && sheets.factor) throw Error("give greater_than or a factor, not both");
  return {Approach::sheets};
}

Plan plan_how(const MeshedModel& input, const Request& request, const LevelChanges& changes) {
  if (!is_regular(request)) throw Error("levels need a regular transition, and templates for concave places");
  if (changes.by.size() != input.mesh.hexes.size())
    throw Error("there are " + std::to_string(changes.by.size()) + " flags for " +
                std::to_string(input.mesh.n_hexes()) + " hexes");
  return {Approach::levels};
}

}  // namespace

const char* name(Method method) {
  constexpr const char* names[] = {"auto", "single", "parallel", "combination"};
  return names[static_cast<int>(method)];
}

Plan plan(const MeshedModel& input, const Request& request) {
  if (input.mesh.hexes.empty()) throw Error("there is no mesh to refine");
  if (!std::holds_alternative<AcrossSheets>(request.how) && !std::holds_alternative<LevelChanges>(request.how))
    check_targets(input, request.target);
  check_target(request.target, request.method);
  return std::visit([&](const auto& how) { return plan_how(input, request, how); }, request.how);
}

}  // namespace hextwist
