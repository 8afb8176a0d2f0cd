#include "hextwist/patch/adapt.h"

#include <algorithm>
#include <numeric>

#include "hextwist/base/parallel.h"
#include "hextwist/patch/refine.h"
#include "hextwist/sizing/fields/size_field.h"
#include "hextwist/sizing/levelling.h"

namespace hextwist {
namespace {

Request request_of(const Mesh& mesh, std::size_t n, const char* what, const AdaptOptions& options) {
  if (n != mesh.hexes.size())
    throw Error("there are " + std::to_string(n) + " " + what + " for " + std::to_string(mesh.n_hexes()) + " hexes");
  check_extensive(mesh, options.extensive);
  return {.concave = options.concave,
          .transition = options.keep_gradation ? Transition::regular : Transition::nested,
          .levelling = options.levelling,
          .finish = {.smooth = options.smooth,
                     .fixed = options.fixed,
                     .level_field = options.level_field,
                     .extensive = options.extensive,
                     .keep_jumps = options.keep_jumps,
                     .allow_off_cad = options.allow_off_cad}};
}

AdaptResult run(const MeshedModel& input, const Request& request, const Progress& progress) {
  RefineResult result = refine(input, request, progress);
  LevelOrigin from = came_from(input.mesh, result);
  return {std::move(result.refined),  std::move(result.origin), std::move(from),
          std::move(result.old_node), std::move(result.report), std::move(result.levelling)};
}

}  // namespace

void check_extensive(const Mesh& mesh, std::span<const std::string> names) {
  for (const std::string& name : names)
    if (std::ranges::none_of(mesh.fields, [&](const Field& f) { return f.name == name && f.on == Field::On::hex; }))
      throw Error("there is no field '" + name + "' of hexes");
}

LevelOrigin came_from(const Mesh& input, const RefineResult& result) {
  if (!result.came_from.kind.empty()) return result.came_from;
  // Not by levels, or the first step on a base.
  const std::int64_t last = hex_id(input, input.n_hexes() - 1);
  LevelOrigin origin{{}, result.origin, {{0}, {}}};
  const Mesh& mesh = result.refined.mesh;
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    origin.kind.push_back(hex_id(mesh, h) <= last ? HexOrigin::same : HexOrigin::finer);
  return origin;
}

LevellingPtr levelling_of(std::shared_ptr<const MeshedModel> base) {
  Levelling bare;
  bare.forest.base = std::move(base);
  return std::make_shared<const Levelling>(std::move(bare));
}

Request adapt_request(const Mesh& mesh, std::span<const std::uint8_t> flags, const AdaptOptions& options) {
  Request request = request_of(mesh, flags.size(), "flags", options);
  request.method = options.method;
  request.target.ids = indices_where(mesh.n_hexes(), [&](Index h) { return flags[h] != 0; });
  return request;
}

Request adapt_request(const Mesh& mesh, std::span<const std::int8_t> changes, const AdaptOptions& options) {
  Request request = request_of(mesh, changes.size(), "flags", options);
  request.how = LevelChanges{{changes.begin(), changes.end()}};
  return request;
}

Request adapt_request(const Mesh& mesh, std::span<const double> sizes, const AdaptOptions& options) {
  Request request = request_of(mesh, sizes.size(), "sizes", options);
  auto background = std::make_shared<Mesh>();
  background->points = mesh.points;
  background->hexes = mesh.hexes;
  background->hex_ids = mesh.hex_ids;
  background->fields.push_back({"size", Field::On::hex, 1, {sizes.begin(), sizes.end()}});
  request.target.ids.resize(mesh.hexes.size());
  std::iota(request.target.ids.begin(), request.target.ids.end(), 0);
  request.method = Method::single;
  request.how = Sizes{.bias = options.bias,
                      .field = field_size(background, "size"),
                      .coarsen = is_regular(request) && has_levels(request)};
  return request;
}

AdaptResult adapt(const MeshedModel& input, std::span<const std::uint8_t> flags, const AdaptOptions& options,
                  const Progress& progress) {
  const Request request = adapt_request(input.mesh, flags, options);
  if (!request.target.ids.empty()) return run(input, request, progress);
  AdaptResult result;
  result.refined = input;
  raise_levels({}, options.level_field, result.refined.mesh);
  result.levelling = options.levelling;
  result.came_from = {std::vector<HexOrigin>(input.mesh.hexes.size(), HexOrigin::same), {}, {{0}, {}}};
  result.origin.resize(input.mesh.hexes.size());
  std::iota(result.origin.begin(), result.origin.end(), 0);
  result.came_from.at = result.origin;
  result.report.hexes_before = result.report.hexes_after = input.mesh.n_hexes();
  result.report.nodes_before = result.report.nodes_after = input.mesh.n_nodes();
  return result;
}

AdaptResult adapt(const MeshedModel& input, std::span<const std::int8_t> changes, const AdaptOptions& options,
                  const Progress& progress) {
  return run(input, adapt_request(input.mesh, changes, options), progress);
}

AdaptResult adapt(const MeshedModel& input, std::span<const double> sizes, const AdaptOptions& options,
                  const Progress& progress) {
  return run(input, adapt_request(input.mesh, sizes, options), progress);
}

}  // namespace hextwist
