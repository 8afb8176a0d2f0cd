#include "hextwist/sizing/stop_at.h"

#include <algorithm>
#include <array>

#include "hextwist/base/text.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/refine/others.h"
#include "hextwist/sizing/plan.h"
#include "hextwist/sizing/targets.h"

namespace hextwist {
namespace {

/// Marks the nodes that are too near.
std::vector<std::uint8_t> near_nodes(const Mesh& mesh, const RigidEdges& rigid, int layers) {
  std::vector<std::uint8_t> near(mesh.points.size(), 0);
  for (const Edge& edge : rigid.edges) near[edge[0]] = near[edge[1]] = 1;
  for (int layer = 1; layer < layers; ++layer) mark_nodes(mesh.hexes, touching_hexes(mesh.hexes, near), near);
  return near;
}

/// Hexes are cut as a whole, or around what of the target is no hex.
bool cuts_hexes(const Request& request) {
  const Target& target = request.target;
  return is_solid(target.kind) || target.radius || target.depth.value_or(0) > 0 ||
         (request.method == Method::single && !target.depth) ||
         (std::holds_alternative<Sizes>(request.how) && request.method != Method::combination && !target.depth);
}

}  // namespace

Request away_from_others(const MeshedModel& input, Request request, int layers, std::vector<std::string>& notices) {
  const Mesh& mesh = input.mesh;
  if (plan(input, request).approach == Approach::uniform)
    throw Error("'stop_at other' goes with a part of the model: all volumes together are cut evenly");
  const std::vector<std::uint8_t> near = near_nodes(mesh, rigid_edges(mesh), layers);
  const auto is_near = [&](const auto& nodes) {
    return std::ranges::any_of(nodes, [&](Index n) { return near[n] != 0; });
  };
  std::vector<std::string> told;  // again by who cuts them
  Target left;
  std::size_t n_before = 0;
  const auto keep = [&](Index id, const auto& nodes) {
    ++n_before;
    if (!is_near(nodes)) left.ids.push_back(id);
  };
  if (cuts_hexes(request)) {
    left.kind = EntityKind::hex;
    Target target = request.target;
    if (!is_solid(target.kind) && !target.radius && !target.depth) target.depth = 1;
    for (const Index h : region_target(input, target, told)) keep(h, mesh.hexes[h]);
  } else {
    left.depth = request.target.depth;
    const CombinationTarget target = sub_element_target(input, request.target, told);
    if (!target.faces.empty()) {
      left.kind = EntityKind::face;
      const Faces all = faces(mesh);
      for (const Quad& quad : target.faces) keep(find_face(all, quad), quad);
    } else if (!target.edges.empty()) {
      left.kind = EntityKind::edge;
      const Edges all = edges(mesh);
      for (const Edge& edge : target.edges) keep(find_edge(all, edge[0], edge[1]), edge);
    } else {
      left.kind = EntityKind::node;
      for (const Index n : target.nodes) keep(n, std::array{n});
    }
    std::ranges::sort(left.ids);
  }
  const std::size_t n_left_out = n_before - left.ids.size();
  const std::string within = "within " + counted(layers, "layer") + " of hexes from elements that are not cut";
  if (left.ids.empty())
    throw Error("'stop_at other' leaves nothing to refine: " +
                counted(static_cast<std::int64_t>(n_before), name(left.kind), plural(left.kind)) +
                (n_before == 1 ? " lies " : " lie ") + within);
  notices.push_back("'stop_at other': " + std::to_string(n_left_out) + " of " +
                    counted(static_cast<std::int64_t>(n_before), name(left.kind), plural(left.kind)) +
                    " left out, which " + (n_left_out == 1 ? "lies " : "lie ") + within);
  request.target = std::move(left);
  if (request.target.kind == EntityKind::hex && request.method == Method::combination)
    request.method = Method::automatic;
  return request;
}

}  // namespace hextwist
