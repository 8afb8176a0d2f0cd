// Middle nodes on the model: by projection from halfway, inner ones by blending.
#include <cmath>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/association/association_internal.h"
#include "hextwist/mesh/second_order/middles_internal.h"

namespace hextwist::detail {
namespace {

constexpr double straight = 1e-12;  // of the length: rounding, no bend
constexpr double most_bent = 0.5;   // of the length: half a circle; what is farther belongs elsewhere
constexpr int n_sweeps = 8;         // layers that a bend at the boundary reaches into

/// Where to begin to look for the place on the owner: between the places of the nodes around, where that is near.
template <class Nodes>
Parameters seed_between(const Association& association, const Model& model, Owner owner, const Nodes& nodes,
                        const Vec3& from, double size) {
  Parameters sum{0, 0};
  for (const Index n : nodes) {
    if (association.node_owner[n] != owner) return {};
    sum.u += association.node_parameters[n].u / static_cast<double>(nodes.size());
    sum.v += association.node_parameters[n].v / static_cast<double>(nodes.size());
  }
  if (std::isnan(sum.u) || (owner.dim == 2 && std::isnan(sum.v))) return {};
  // Across a seam the mean is on the other side.
  return (model.point(owner, sum) - from).norm() < most_bent * size ? sum : Parameters{};
}

/// From halfway to its place on the owner; far: how far that is, where it is too far to be meant.
void displace(const Vec3& from, const Vec3& place, double size, Vec3& displacement, double& far) {
  const double way = (place - from).norm();
  if (way >= most_bent * size)
    far = way;
  else if (way > straight * size)
    displacement = place - from;
}

/// Projects items with owners of a dimension; take(item, projection).
template <class From, class Seed, class Take>
void project_items(const Model& model, int dim, const std::vector<Owner>& owners, From&& from, Seed&& seed,
                   Take&& take) {
  const std::vector<Index> items = indices_where(static_cast<Index>(owners.size()),
                                                 [&](Index i) { return owners[i].dim == dim && owners[i].id > 0; });
  std::vector<int> id(items.size());
  std::vector<Vec3> points(items.size());
  std::vector<Parameters> seeds(items.size());
  parallel_each(items.size(), [&](std::size_t i) {
    id[i] = owners[items[i]].id;
    points[i] = from(items[i]);
    seeds[i] = seed(items[i], points[i]);
  });
  const std::vector<Projection> places = project_all(model, dim, id, points, seeds);
  for (std::size_t i = 0; i < items.size(); ++i) take(items[i], points[i], places[i]);
}

/// Inner edges take the mean bend of the edges opposite to them in the faces around, sweep by sweep.
void fade_inwards(const Edges& edges, Index n_hexes, Displacements& out) {
  const bool any = std::ranges::any_of(out.edge, [](const Vec3& d) { return !d.isZero(0); });
  if (!any) return;
  const CompressedRows around = edge_hexes(edges, n_hexes);
  const std::vector<Index> inner =
      indices_where(static_cast<Index>(out.edge.size()), [&](Index e) { return out.edge_owner[e].dim == 3; });
  std::vector<Vec3> next(inner.size());
  for (int sweep = 0; sweep < n_sweeps; ++sweep) {
    parallel_each(inner.size(), [&](std::size_t i) {
      const Index edge = inner[i];
      Vec3 sum = Vec3::Zero();
      int n = 0;
      for (const Index h : around[edge]) {
        const auto& of_hex = edges.of_hex[h];
        const int at = static_cast<int>(std::ranges::find(of_hex, edge) - of_hex.begin());
        for (const int other : {at ^ 1, at ^ 2}) sum += out.edge[of_hex[other]];
        n += 2;
      }
      next[i] = n > 0 ? Vec3(sum / n) : Vec3::Zero();
    });
    parallel_each(inner.size(), [&](std::size_t i) { out.edge[inner[i]] = next[i]; });
  }
  // What is left of a bend far away is no reason for a hex not to be straight.
  constexpr double faded = 1e-3;
  double most = 0;
  for (const Vec3& d : out.edge) most = std::max(most, d.norm());
  for (const Index edge : inner)
    if (out.edge[edge].norm() < faded * most) out.edge[edge].setZero();
}

}  // namespace

Vec3 halfway(const Mesh& mesh, const Edge& edge) {
  return (mesh.points[edge[0]] + mesh.points[edge[1]]) / 2;
}

void find_owners(const Mesh& mesh, const Association& association, const Edges& edges, const Faces& faces,
                 Displacements& out) {
  out.edge_owner.assign(edges.nodes.size(), {});
  out.face_owner.assign(faces.nodes.size(), {});
  if (association.empty()) return;
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    const Owner volume{3, association.hex_volume.empty() ? 0 : association.hex_volume[h]};
    for (const Index e : edges.of_hex[h]) out.edge_owner[e] = volume;
    for (const Index f : faces.of_hex[h]) out.face_owner[f] = volume;
  }
  for (std::size_t i = 0; i < association.surface_faces.size(); ++i) {
    const Side side = association.surface_faces[i];
    const Owner surface{2, association.face_surface[i]};
    out.face_owner[faces.of_hex[side.hex][side.face]] = surface;
    for (int j = 0; j < 4; ++j)
      if (Owner& owner = out.edge_owner[edges.of_hex[side.hex][face_edge(side.face, j)]]; owner.dim != 2)
        owner = surface;
  }
  for (std::size_t i = 0; i < association.curve_edges.size(); ++i)
    if (const Index e = find_edge(edges, association.curve_edges[i][0], association.curve_edges[i][1]); e >= 0)
      out.edge_owner[e] = {1, association.edge_curve[i]};
}

void displace_edges(const Mesh& mesh, const Association& association, const Model& model, const Edges& edges,
                    Displacements& out) {
  const auto length = [&](Index e) { return (mesh.points[edges.nodes[e][1]] - mesh.points[edges.nodes[e][0]]).norm(); };
  for (const int dim : {1, 2})
    project_items(
        model, dim, out.edge_owner, [&](Index e) { return halfway(mesh, edges.nodes[e]); },
        [&](Index e, const Vec3& from) {
          return seed_between(association, model, out.edge_owner[e], edges.nodes[e], from, length(e));
        },
        [&](Index e, const Vec3& from, const Projection& place) {
          out.edge_parameters[e] = place.parameters;
          displace(from, place.point, length(e), out.edge[e], out.edge_far[e]);
        });
  fade_inwards(edges, mesh.n_hexes(), out);
}

void displace_faces(const Mesh& mesh, const Association& association, const Model& model, const Edges& edges,
                    const Faces& faces, Displacements& out) {
  const auto middle = [&](Index e) -> Vec3 { return halfway(mesh, edges.nodes[e]) + out.edge[e]; };
  const auto size = [&](Index f) {
    const Quad& q = faces.nodes[f];
    return std::min((mesh.points[q[3]] - mesh.points[q[0]]).norm(), (mesh.points[q[2]] - mesh.points[q[1]]).norm());
  };
  project_items(
      model, 2, out.face_owner, [&](Index f) { return blended(mesh, edges, faces.sides[f][0], middle); },
      [&](Index f, const Vec3& from) {
        return seed_between(association, model, out.face_owner[f], faces.nodes[f], from, size(f));
      },
      [&](Index f, const Vec3& from, const Projection& place) {
        out.face_parameters[f] = place.parameters;
        displace(from, place.point, size(f), out.face[f], out.face_far[f]);
      });
}

}  // namespace hextwist::detail
