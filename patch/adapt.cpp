#include "hextwist/patch/adapt.h"

#include <numeric>

#include "hextwist/base/parallel.h"
#include "hextwist/patch/refine.h"
#include "hextwist/sizing/fields/size_field.h"
#include "hextwist/sizing/levels.h"

namespace hextwist {
namespace {

Request request_of(const Mesh& mesh, std::size_t n, const char* what, const AdaptOptions& options) {
  if (n != mesh.hexes.size())
    throw Error("there are " + std::to_string(n) + " " + what + " for " + std::to_string(mesh.n_hexes()) + " hexes");
  return {.concave = options.concave,
          .levels = options.keep_gradation ? Levels::graded : Levels::counted,
          .finish = {.smooth = options.smooth, .fixed = options.fixed}};
}

AdaptResult run(const MeshedModel& input, const Request& request, const Progress& progress) {
  RefineResult refined = refine(input, request, progress);
  return {std::move(refined.refined), std::move(refined.origin), std::move(refined.report)};
}

}  // namespace

Request adapt_request(const Mesh& mesh, std::span<const std::uint8_t> flags, const AdaptOptions& options) {
  Request request = request_of(mesh, flags.size(), "flags", options);
  request.target.ids = indices_where(mesh.n_hexes(), [&](Index h) { return flags[h] != 0; });
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
  request.how = Sizes{.bias = options.bias, .field = field_size(background, "size")};
  return request;
}

AdaptResult adapt(const MeshedModel& input, std::span<const std::uint8_t> flags, const AdaptOptions& options,
                  const Progress& progress) {
  const Request request = adapt_request(input.mesh, flags, options);
  if (!request.target.ids.empty()) return run(input, request, progress);
  AdaptResult result;
  result.refined = input;
  level_field_of(result.refined.mesh);
  result.origin.resize(input.mesh.hexes.size());
  std::iota(result.origin.begin(), result.origin.end(), 0);
  result.report.hexes_before = result.report.hexes_after = input.mesh.n_hexes();
  result.report.nodes_before = result.report.nodes_after = input.mesh.n_nodes();
  return result;
}

AdaptResult adapt(const MeshedModel& input, std::span<const double> sizes, const AdaptOptions& options,
                  const Progress& progress) {
  return run(input, adapt_request(input.mesh, sizes, options), progress);
}

}  // namespace hextwist
