// deal.II and hextwist: a mesh as a Triangulation with material ids (volumes of the CAD), boundary and manifold ids
// (its surfaces), refined by deal.II's own flags, but without its hanging nodes:  adapt_dealii CAD MESH [STEPS]
#include <deal.II/grid/grid_refinement.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria.h>

#include <iostream>

#include "hextwist/hextwist.h"

using dealii::Triangulation;

/// On a surface of the CAD: points that deal.II makes, as middles of edges and faces of higher order, lie on it.
class OnSurface : public dealii::Manifold<3> {
 public:
  OnSurface(std::shared_ptr<const hextwist::Model> model, int id) : model_(std::move(model)), id_(id) {}
  std::unique_ptr<dealii::Manifold<3>> clone() const override { return std::make_unique<OnSurface>(model_, id_); }
  dealii::Point<3> project_to_manifold(const dealii::ArrayView<const dealii::Point<3>>&,
                                       const dealii::Point<3>& p) const override {
    const hextwist::Vec3 from(p[0], p[1], p[2]);
    hextwist::Projection to;
    model_->project({2, id_}, {&from, 1}, {}, {&to, 1});
    return {to.point.x(), to.point.y(), to.point.z()};
  }

 private:
  std::shared_ptr<const hextwist::Model> model_;
  int id_;
};

/// Hex h becomes cell h, node n vertex n: deal.II numbers corners as hextwist does.
void make_triangulation(const hextwist::MeshedModel& meshed, Triangulation<3>& to) {
  const auto& [mesh, association] = std::tie(meshed.mesh, meshed.association);
  std::vector<dealii::Point<3>> vertices;
  for (const hextwist::Vec3& p : mesh.points) vertices.emplace_back(p.x(), p.y(), p.z());
  std::vector<dealii::CellData<3>> cells(mesh.hexes.size());
  for (std::size_t h = 0; h < cells.size(); ++h) {
    cells[h].vertices.assign(mesh.hexes[h].begin(), mesh.hexes[h].end());
    cells[h].material_id = static_cast<dealii::types::material_id>(association.hex_volume[h]);
  }
  // Surfaces between two volumes are inside: of these only the manifold is kept.
  dealii::SubCellData sides;
  for (std::size_t i = 0; i < association.surface_faces.size(); ++i) {
    const auto [hex, face] = association.surface_faces[i];
    const auto surface = static_cast<unsigned>(association.face_surface[i]);
    const bool inside = meshed.model->adjacent({2, association.face_surface[i]}, 3).size() > 1;
    dealii::CellData<2>& quad = sides.boundary_quads.emplace_back();
    const auto nodes = hextwist::face_nodes(mesh.hexes[hex], face);
    quad.vertices.assign(nodes.begin(), nodes.end());
    quad.manifold_id = surface;
    quad.boundary_id = inside ? dealii::numbers::internal_face_boundary_id : surface;
  }
  to.clear();
  to.create_triangulation(vertices, cells, sides);
  for (int id = 1; id <= meshed.model->count(2); ++id) to.set_manifold(id, OnSurface(meshed.model, id));
}

int main(int argc, char** argv) try {
  if (argc < 3) throw hextwist::Error("usage: adapt_dealii CAD MESH [STEPS]");
  hextwist::Session session;
  session.import_cad(argv[1]);
  session.import_mesh(argv[2]);
  Triangulation<3> triangulation;
  make_triangulation(session.meshed(), triangulation);
  for (int step = 0; step < (argc > 3 ? std::stoi(argv[3]) : 2); ++step) {
    // An estimator would say where; here it is the nearness to the first vertex.
    dealii::Vector<float> error(triangulation.n_active_cells());
    for (const auto& cell : triangulation.active_cell_iterators())
      error[cell->active_cell_index()] =
          static_cast<float>(cell->diameter() / (1 + cell->center().distance(triangulation.get_vertices()[0])));
    dealii::GridRefinement::refine_and_coarsen_fixed_number(triangulation, error, 0.05, 0);
    std::vector<std::uint8_t> flags(triangulation.n_active_cells());
    for (const auto& cell : triangulation.active_cell_iterators())
      flags[cell->active_cell_index()] = cell->refine_flag_set();
    Triangulation<3> hanging;
    hanging.copy_triangulation(triangulation);
    for (const auto& cell : hanging.active_cell_iterators())
      if (flags[cell->active_cell_index()]) cell->set_refine_flag();
    hanging.execute_coarsening_and_refinement();

    session.adapt(flags);  // instead of that
    make_triangulation(session.meshed(), triangulation);
    const double volume = dealii::GridTools::volume(triangulation), wanted = session.records().back().after.volume;
    std::cout << "step " << step + 1 << ": " << flags.size() << " -> " << triangulation.n_active_cells()
              << " cells, hanging nodes: " << (triangulation.has_hanging_nodes() ? "yes" : "no")
              << " (deal.II's own: " << (hanging.has_hanging_nodes() ? "yes" : "no") << "), "
              << triangulation.get_boundary_ids().size() << " boundary ids, volume off by "
              << std::abs(volume / wanted - 1) << "\n";
    if (triangulation.has_hanging_nodes() || std::abs(volume / wanted - 1) > 1e-6) return 1;
  }
} catch (const std::exception& error) {
  std::cerr << error.what() << "\n";
  return 1;
}
