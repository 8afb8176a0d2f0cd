// deal.II refining what the benchmarks refine: a ball of a tenth of a million cells, and around a front that moves
// (examples/moving_front). It leaves hanging nodes.
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

/// As the example has it: finer where the sphere passes between corners, coarser where it does not.
bool follow(dealii::Triangulation<3>& mesh, const dealii::Point<3>& centre, int n_levels) {
  bool changes = false;
  for (const auto& cell : mesh.active_cell_iterators()) {
    unsigned n_outside = 0;
    for (const unsigned v : cell->vertex_indices()) n_outside += cell->vertex(v).distance(centre) > 2.2;
    if (n_outside == 0 || n_outside == 8) {
      if (cell->level() > 0) cell->set_coarsen_flag();
    } else if (cell->level() < n_levels) {
      cell->set_refine_flag();
      changes = true;
    }
  }
  changes |= mesh.prepare_coarsening_and_refinement();
  mesh.execute_coarsening_and_refinement();
  return changes;
}

/// Cells after each step, all together, and the time for all steps.
void move_front(int n_levels) {
  dealii::Triangulation<3> mesh(dealii::Triangulation<3>::limit_level_difference_at_vertices);
  dealii::GridGenerator::subdivided_hyper_cube(mesh, 10, -5, 5);
  double seconds = 0, n_cells = 0;
  for (int step = 0; step < 10; ++step) {
    const dealii::Point<3> centre(-4.9 + 0.53 * step, 0.07 * step, 0.03 * step);
    const double start = cpu_seconds();
    for (int call = 0; call <= n_levels && follow(mesh, centre, n_levels); ++call) {
    }
    seconds += cpu_seconds() - start;
    n_cells += mesh.n_active_cells();
  }
  std::printf("dealii_front%d %g %g\n", n_levels, seconds, n_cells);
}

}  // namespace

int main() {
  move_front(2);
  move_front(3);
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
