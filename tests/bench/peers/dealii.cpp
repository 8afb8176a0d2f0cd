// deal.II refining what the benchmarks refine: a ball of a tenth of a million cells. It leaves hanging nodes.
// Prints "name CPU-seconds cells".
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>

#include <cmath>
#include <cstdio>
#include <ctime>

namespace {

double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

}  // namespace

int main() {
  {
    dealii::Triangulation<3> mesh;
    dealii::GridGenerator::subdivided_hyper_cube(mesh, 50);
    const double start = cpu_seconds();
    mesh.refine_global(1);
    std::printf("dealii_uniform %g %u\n", cpu_seconds() - start, mesh.n_active_cells());
  }
  dealii::Triangulation<3> mesh;
  dealii::GridGenerator::subdivided_hyper_cube(mesh, 100, -50, 50);
  const double radius = 100 * std::cbrt(0.1 * 3 / (4 * std::acos(-1.0)));
  for (const auto& cell : mesh.active_cell_iterators())
    if (cell->center().norm() < radius) cell->set_refine_flag();
  const double start = cpu_seconds();
  mesh.execute_coarsening_and_refinement();
  std::printf("dealii_ball %g %u\n", cpu_seconds() - start, mesh.n_active_cells());
}
