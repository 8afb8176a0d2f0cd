#include "hextwist/session/move.h"

#include <algorithm>
#include <numeric>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/geom/renumbered_model.h"
#include "hextwist/io/results.h"
#include "hextwist/mesh/association/check.h"
#include "hextwist/mesh/move.h"
#include "hextwist/mesh/others.h"
#include "hextwist/mesh/periodic.h"
#include "hextwist/mesh/second_order/second_order.h"
#include "hextwist/session/load.h"

namespace hextwist {
namespace {

/// Where nodes are on their curves and surfaces now.
void find_parameters(const Mesh& mesh, Association& association, const Model& model) {
  std::vector<Index> order = indices_where(mesh.n_nodes(), [&](Index n) {
    return association.node_owner[n].dim == 1 || association.node_owner[n].dim == 2;
  });
  std::ranges::stable_sort(order, {}, [&](Index n) { return association.node_owner[n]; });
  std::vector<std::span<const Index>> groups;
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i;
    while (end < order.size() && association.node_owner[order[end]] == association.node_owner[order[i]]) ++end;
    groups.emplace_back(order.data() + i, end - i);
    i = end;
  }
  parallel_each(groups.size(), [&](std::size_t g) {
    const Owner owner = association.node_owner[groups[g].front()];
    const std::vector<Vec3> points = items_at(mesh.points, groups[g]);
    std::vector<Projection> found(points.size());
    model.project(owner, points, {}, found);
    for (std::size_t i = 0; i < points.size(); ++i) association.node_parameters[groups[g][i]] = found[i].parameters;
  });
}

/// A skin of its own for the moved mesh, under the ids and names of the one before.
void put_on_own_skin(MeshedModel& meshed, const MiddleNodes& middles) {
  FacetResult skin = associate_with_own_skin(meshed.mesh, {.tags = &meshed.association, .middles = &middles});
  const Model& before = *meshed.model;
  Renumbering ids;
  for (int dim = 0; dim < 4; ++dim) ids.id[dim].assign(static_cast<std::size_t>(skin.model->count(dim)), 0);
  const auto pair = [&](int dim, int now, int then) {
    if (now > 0 && then > 0) ids.id[dim][static_cast<std::size_t>(now - 1)] = then;
  };
  const Association &then = meshed.association, &now = skin.association;
  if (then.surface_faces != now.surface_faces || then.curve_edges != now.curve_edges)
    throw Error("the skin of the mesh would be divided otherwise where it is moved to");
  for (std::size_t i = 0; i < now.face_surface.size(); ++i) pair(2, now.face_surface[i], then.face_surface[i]);
  for (std::size_t i = 0; i < now.edge_curve.size(); ++i) pair(1, now.edge_curve[i], then.edge_curve[i]);
  for (std::size_t i = 0; i < now.hex_volume.size(); ++i) pair(3, now.hex_volume[i], then.hex_volume[i]);
  for (std::size_t n = 0; n < now.node_owner.size(); ++n)
    if (now.node_owner[n].dim == 0 && then.node_owner[n].dim == 0) pair(0, now.node_owner[n].id, then.node_owner[n].id);
  for (int dim = 0; dim < 4; ++dim)
    for (const int id : ids.id[dim]) ids.name[dim].push_back(id > 0 ? before.name({dim, id}) : "");
  meshed.model = renumbered(std::move(skin.model), ids);  // checks that it is a permutation
  meshed.association = std::move(skin.association);
  Association& own = meshed.association;
  for (Owner& owner : own.node_owner) owner = ids.of(owner);
  for (int& id : own.face_surface) id = ids.of({2, id}).id;
  for (int& id : own.edge_curve) id = ids.of({1, id}).id;
  for (int& id : own.hex_volume) id = ids.of({3, id}).id;
}

/// Gmsh's maps between periodic entities.
std::shared_ptr<const FileExtras> moved_extras(const std::shared_ptr<const FileExtras>& extras,
                                               const Similarity& similarity) {
  if (!extras || extras->periodic.empty()) return extras;
  using Matrix = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
  Matrix there = Matrix::Identity();
  there.topLeftCorner<3, 3>() = similarity.factor * similarity.turn;
  there.topRightCorner<3, 1>() = similarity.shift;
  Matrix back = Matrix::Identity();
  back.topLeftCorner<3, 3>() = similarity.turn.transpose() / similarity.factor;
  back.topRightCorner<3, 1>() = -(back.topLeftCorner<3, 3>() * similarity.shift);
  auto result = std::make_shared<FileExtras>(*extras);
  for (PeriodicPairs& pairs : result->periodic)
    if (pairs.affine.size() == 16)
      Eigen::Map<Matrix>(pairs.affine.data()) = there * Eigen::Map<Matrix>(pairs.affine.data()) * back;
  return result;
}

/// The same of periodic surfaces.
std::shared_ptr<const PeriodicBoundary> moved_pairs(const std::shared_ptr<const PeriodicBoundary>& periodic,
                                                    const Similarity& similarity) {
  if (!periodic) return nullptr;
  auto result = std::make_shared<PeriodicBoundary>(*periodic);
  for (PeriodicPair& pair : result->pairs) {
    pair.shift = similarity.factor * (similarity.turn * pair.shift);
    pair.turn = (similarity.turn * pair.turn * similarity.turn.transpose()).eval();
    pair.shift += similarity.shift - pair.turn * similarity.shift;
    if (pair.turn.isIdentity(1e-14)) pair.turn.setIdentity();
  }
  return result;
}

}  // namespace

void scale(Mesh& mesh, double factor) {
  const Similarity similarity{.factor = factor};
  move(mesh, similarity);
  if (mesh.results) mesh.results = moved(*mesh.results, similarity);
}

void move(Transaction& run, const Similarity& similarity) {
  SessionState& state = run.state;
  MeshedModel meshed = *run.meshed;
  Mesh& mesh = meshed.mesh;
  if (mesh.n_hexes() == 0 && !meshed.model) throw Error("there is neither mesh nor CAD to move");
  if (mesh.others && similarity.mirrors())
    throw Error("a mesh with other elements can't be reflected: it has " + others_text(mesh));
  run.stage("move");
  MiddleNodes middles;
  if (!state.has_cad) middles = skin_middles(meshed);
  for (auto* points : {&middles.edge_points, &middles.face_points})
    for (Vec3& p : *points) p = similarity.of(p);
  if (state.has_cad) meshed.model = moved(*meshed.model, similarity);
  if (mesh.n_hexes() == 0) return replace_and_measure(run, std::move(meshed));
  move(mesh, similarity);
  if (mesh.results) mesh.results = moved(*mesh.results, similarity);
  move(meshed.association, similarity);
  if (state.has_cad)
    find_parameters(mesh, meshed.association, *meshed.model);
  else
    put_on_own_skin(meshed, middles);
  if (const auto broken = check_association(mesh, meshed.association, *meshed.model,
                                            std::max(state.tolerance, AssociateOptions().relative_tolerance));
      !broken.empty())
    throw Error("the mesh would leave its CAD: " + broken.front());
  if (state.levelling) run.note("levels end here: this mesh is the base of what is refined from now on");
  const bool turns = !similarity.turn.isIdentity(0);
  if (turns && std::ranges::any_of(mesh.fields, [](const Field& field) { return field.components > 1; }))
    run.note("fields keep their values: vectors among them are not turned");
  if (mesh.others && (turns || similarity.factor != 1))
    run.note("other elements keep what is said of them (thicknesses, directions) as it was");
  if ((turns || similarity.factor != 1) && state.extras && !state.extras->cards.empty())
    run.note(
        "cards of the .inp file stay as they were read: directions, systems and lengths in them are of the place "
        "before");
  if (!state.sizing.empty()) run.note("sizing functions stay where they are: they are of the place before");
  const Measured before = state.measured;
  replace_and_measure(run, std::move(meshed));
  if (before.off_cad.max_relative <= state.tolerance && !(state.measured.off_cad.max_relative <= state.tolerance))
    throw Error("the mesh would leave its CAD: node " +
                std::to_string(node_id(run.meshed->mesh, state.measured.off_cad.node)) + " by " +
                short_number(state.measured.off_cad.max));
  state.tags = nullptr;
  state.periodic = moved_pairs(state.periodic, similarity);
  state.extras = moved_extras(state.extras, similarity);
}

}  // namespace hextwist
