#include "hextwist/sizing/targets.h"

#include <algorithm>
#include <numeric>

#include "hextwist/refine/marks.h"

namespace hextwist {
namespace {

int cad_dimension(TargetKind kind) {
  switch (kind) {
    case TargetKind::vertex:
      return 0;
    case TargetKind::curve:
      return 1;
    case TargetKind::surface:
      return 2;
    case TargetKind::volume:
      return 3;
    default:
      return -1;
  }
}

[[noreturn]] void unknown(TargetKind kind, std::int64_t id, std::int64_t n) {
  throw Error(std::string("there is no ") + name(kind) + " " + std::to_string(id) + ": " +
              (n == 0 ? "there are none" : std::string(name(kind)) + " ids go from 1 to " + std::to_string(n)));
}

void check_indices(TargetKind kind, std::span<const Index> targets, Index n) {
  for (const Index i : targets)
    if (i < 0 || i >= n) unknown(kind, std::int64_t{i} + 1, n);
}

/// Marks the nodes of mesh edges and faces or of a CAD entity with all that bounds it.
void mark_target_nodes(const MeshedModel& input, const Request& request, std::vector<std::uint8_t>& marked) {
  const Mesh& mesh = input.mesh;
  switch (request.kind) {
    case TargetKind::node:
      check_indices(request.kind, request.targets, mesh.n_nodes());
      for (const Index n : request.targets) marked[n] = 1;
      return;
    case TargetKind::edge: {
      const Edges all = edges(mesh);
      check_indices(request.kind, request.targets, static_cast<Index>(all.nodes.size()));
      for (const Index e : request.targets)
        for (const Index n : all.nodes[e]) marked[n] = 1;
      return;
    }
    case TargetKind::face: {
      const Faces all = faces(mesh);
      check_indices(request.kind, request.targets, static_cast<Index>(all.nodes.size()));
      for (const Index f : request.targets)
        for (const Index n : all.nodes[f]) marked[n] = 1;
      return;
    }
    default:
      break;
  }
  const int dim = cad_dimension(request.kind);
  for (const Index id : request.targets) {
    const std::vector<Index> nodes = nodes_on(input.association, *input.model, {dim, id});
    if (nodes.empty())
      throw Error("no node of the mesh lies on " + to_string(Owner{dim, id}) +
                  ": the mesh does not resolve it, so there is nothing to refine");
    for (const Index n : nodes) marked[n] = 1;
  }
}

std::vector<Index> hexes_of_volumes(const MeshedModel& input, std::span<const Index> volumes) {
  std::vector<Index> result;
  for (Index h = 0; h < input.mesh.n_hexes(); ++h)
    if (std::ranges::binary_search(volumes, input.association.hex_volume[h])) result.push_back(h);
  if (result.empty()) throw Error("no hex of the mesh lies in volume " + std::to_string(volumes.front()));
  return result;
}

}  // namespace

std::vector<Index> target_hexes(const MeshedModel& input, const Request& request) {
  const Mesh& mesh = input.mesh;
  if (request.targets.empty()) throw Error(std::string("no ") + name(request.kind) + " to refine");
  if (const int dim = cad_dimension(request.kind); dim >= 0) {
    if (!input.model) throw Error("there is no CAD and no facet model: refine by hex, face, edge or node");
    const int n = input.model->count(dim);
    for (const Index id : request.targets)
      if (id < 1 || id > n) unknown(request.kind, id, n);
  }
  const bool solid = request.kind == TargetKind::hex || request.kind == TargetKind::volume;
  int layers = request.depth.value_or(solid ? 0 : 1);
  if (layers < 0) throw Error("depth must not be negative");
  if (!solid && layers == 0)
    throw Error(std::string("depth 0 (refining nothing but the ") + name(request.kind) +
                " itself) is not available yet; depth 1 refines every hex that touches it");

  std::vector<std::uint8_t> marked(mesh.points.size(), 0);
  std::vector<Index> hexes;
  if (request.kind == TargetKind::hex) {
    check_indices(request.kind, request.targets, mesh.n_hexes());
    hexes = request.targets;
  } else if (request.kind == TargetKind::volume) {
    hexes = hexes_of_volumes(input, request.targets);
  } else {
    mark_target_nodes(input, request, marked);
    hexes = touching_hexes(mesh.hexes, marked);
    --layers;
  }
  for (; layers > 0 && static_cast<Index>(hexes.size()) < mesh.n_hexes(); --layers) {
    mark_nodes(mesh.hexes, hexes, marked);
    hexes = touching_hexes(mesh.hexes, marked);
  }
  return hexes;
}

bool is_whole_model(const MeshedModel& input, const Request& request) {
  return request.kind == TargetKind::volume && input.model &&
         static_cast<int>(request.targets.size()) == input.model->count(3);
}

}  // namespace hextwist
