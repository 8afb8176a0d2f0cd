#include "hextwist/parts/local_mesh.h"

#include <algorithm>
#include <numeric>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/patch/patch.h"
#include "hextwist/sizing/targets.h"

namespace hextwist {

LocalMesh local_mesh(const MeshedModel& whole, std::span<const int> part_of_hex, int rank, int n_rings) {
  const Mesh& mesh = whole.mesh;
  constexpr std::uint8_t outside = 255;
  std::vector<std::uint8_t> ring(mesh.hexes.size(), outside), reached(mesh.points.size(), 0);
  for (std::size_t h = 0; h < ring.size(); ++h)
    if (part_of_hex[h] == rank) ring[h] = 0;
  LocalMesh local;
  bool grows = true;
  for (int r = 0; r <= n_rings && grows; ++r) {
    grows = r == 0;
    for (std::size_t h = 0; h < ring.size() && r > 0; ++h)
      if (ring[h] == outside && std::ranges::any_of(mesh.hexes[h], [&](Index n) { return reached[n] != 0; })) {
        ring[h] = static_cast<std::uint8_t>(r);
        grows = true;
      }
    for (std::size_t h = 0; h < ring.size(); ++h)
      if (ring[h] == r)
        for (const Index n : mesh.hexes[h]) reached[n] = 1;
  }
  std::vector<Index> hexes;
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    if (ring[h] != outside) hexes.push_back(h);
  local.is_all = std::ssize(hexes) == mesh.n_hexes();
  Patch patch = make_patch(whole, std::move(hexes));
  for (const Index h : patch.hexes) {
    local.base.ring.push_back(ring[h]);
    local.base.owner.push_back(part_of_hex[h]);
  }
  local.base.hex = std::move(patch.hexes);
  local.base.node = std::move(patch.nodes);
  local.meshed = std::move(patch.meshed);
  local.base_of.resize(local.base.hex.size());
  std::iota(local.base_of.begin(), local.base_of.end(), 0);
  local.n_rings = n_rings;
  return local;
}

void trim(LocalMesh& local, int n_rings, std::vector<Index>& kept_nodes, std::vector<Index>& kept_hexes) {
  const std::vector<Index> stay =
      indices_where(local.meshed.mesh.n_hexes(), [&](Index h) { return local.base.ring[local.base_of[h]] <= n_rings; });
  local.n_rings = std::min(local.n_rings, n_rings);
  Patch patch = make_patch(local.meshed, stay);
  local.base_of = items_at(local.base_of, patch.hexes);
  local.meshed = std::move(patch.meshed);
  kept_nodes = std::move(patch.nodes);
  kept_hexes = std::move(patch.hexes);
}

namespace {

[[noreturn]] void refuse(const std::string& what, const std::string& why) {
  throw Error(what + " is not done in parts: " + why + "; run it with hextwist, or with one rank");
}

bool cuts_levels(const Asked& asked) {
  return asked.approach == Approach::levels ||
         (asked.approach == Approach::trisect && asked.request.concave == Concave::templates &&
          asked.request.transition != Transition::nested);
}

}  // namespace

Asked asked_in_parts(const MeshedModel& whole, const Request& request, std::span<const Asked> before) {
  Asked asked{request, plan(whole, request).approach, {}, {}};
  const bool is_regular_request = is_regular(request);
  switch (asked.approach) {
    case Approach::uniform:
    case Approach::trisect:
    case Approach::levels:
    case Approach::parallel:
      break;
    case Approach::combination:
      if (std::get<Cuts>(request.how).numsplit > 1 && is_regular_request)
        refuse("numsplit above 1 along nodes, curves and surfaces (depth 0)",
               "it goes by levels first; 'depth 1' can be");
      break;
    case Approach::eight:
      refuse("one into eight", "its sheets are planned through the whole mesh");
    case Approach::thickness:
    case Approach::layers:
    case Approach::sheets:
      refuse("a direction or a sheet", "sheets run through the whole mesh");
    default:
      refuse("a size", "how well sizes are met is compared over the whole mesh");
  }
  if (request.finish.smooth) refuse("smooth", "smoothing goes across parts");
  if (request.finish.dry_run) refuse("dry_run", "it counts without making anything");
  const Target& target = request.target;
  const bool of_cad = is_cad(target.kind);
  if (!before.empty() && (!of_cad || target.radius))
    refuse("a refinement of nodes, edges, faces or hexes, or by a radius, after another one",
           "its ids would be those of the mesh that is in parts by then");
  if (!before.empty() && cuts_levels(asked) && cuts_levels(before.back()))
    refuse("a second level", "it is made from the mesh before the first; 'numsplit 2' or 'transition nested' can be");
  std::vector<std::string> told;
  if (target.radius) {
    asked.request.target = {EntityKind::hex, region_target(whole, target, told)};
    asked.request.method = Method::single;
  } else if (target.kind == EntityKind::edge || target.kind == EntityKind::face) {
    const CombinationTarget of = sub_element_target(whole, target, told);
    asked.edges = of.edges;
    asked.faces = of.faces;
  }
  return asked;
}

}  // namespace hextwist
