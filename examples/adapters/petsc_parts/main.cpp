// A DMPlex in parts, refined by the processes that have it: mpirun -n 4 petsc_parts [HEXES A SIDE] [COMMAND]
//
// PETSc makes and distributes a box of hexes. Its arrays and global numbers go to refine_parts(); what comes back
// becomes a DMPlex again, whose vertices are numbered over the star forest of shared nodes, and DMPlexCheck looks at
// it.
#include <petscdmplex.h>
#include <petscsf.h>

#include <cstdio>
#include <numeric>

#include "hextwist/mesh/corners.h"
#include "hextwist/parts/mpi/parts_call.h"

namespace {

using namespace hextwist;

constexpr int to_plex[] = {0, 3, 2, 1, 4, 5, 6, 7};  // DMPlex sees the bottom of a hex from outside; its own inverse

/// PETSc names a number that another rank owns by its negative.
std::int64_t id_of(PetscInt number) {
  return 1 + (number < 0 ? -(number + 1) : number);
}

Mesh mesh_of(DM plex) {
  PetscInt cell, cell_end, vertex, vertex_end;
  PetscCallAbort(PETSC_COMM_WORLD, DMPlexGetHeightStratum(plex, 0, &cell, &cell_end));
  PetscCallAbort(PETSC_COMM_WORLD, DMPlexGetDepthStratum(plex, 0, &vertex, &vertex_end));
  IS cells, vertices;
  const PetscInt *cell_number, *vertex_number;
  PetscCallAbort(PETSC_COMM_WORLD, DMPlexGetCellNumbering(plex, &cells));
  PetscCallAbort(PETSC_COMM_WORLD, DMPlexGetVertexNumbering(plex, &vertices));
  PetscCallAbort(PETSC_COMM_WORLD, ISGetIndices(cells, &cell_number));
  PetscCallAbort(PETSC_COMM_WORLD, ISGetIndices(vertices, &vertex_number));
  std::vector<std::int64_t> hex_ids, node_ids;
  std::vector<Index> hexes;
  for (PetscInt v = vertex; v < vertex_end; ++v) node_ids.push_back(id_of(vertex_number[v - vertex]));
  for (PetscInt c = cell; c < cell_end; ++c) {
    hex_ids.push_back(id_of(cell_number[c - cell]));
    PetscInt n, *closure = nullptr;
    PetscCallAbort(PETSC_COMM_WORLD, DMPlexGetTransitiveClosure(plex, c, PETSC_TRUE, &n, &closure));
    std::vector<Index> corners;
    for (PetscInt i = 0; i < n; ++i)
      if (closure[2 * i] >= vertex && closure[2 * i] < vertex_end) corners.push_back(closure[2 * i] - vertex);
    for (const int corner : to_plex) hexes.push_back(corners[corner]);
    PetscCallAbort(PETSC_COMM_WORLD, DMPlexRestoreTransitiveClosure(plex, c, PETSC_TRUE, &n, &closure));
  }
  Vec coordinates;
  const PetscScalar* points;
  PetscCallAbort(PETSC_COMM_WORLD, DMGetCoordinatesLocal(plex, &coordinates));
  PetscCallAbort(PETSC_COMM_WORLD, VecGetArrayRead(coordinates, &points));
  return mesh_of_arrays({points, 3 * node_ids.size()}, hexes, node_ids, hex_ids);
}

/// Global numbers of a part's nodes: each rank numbers those that no lower rank has, the others hear of theirs.
std::vector<PetscInt> numbers(const MeshPart& part, PetscInt& n_own) {
  std::vector<PetscInt> number(part.mesh.points.size(), 0), leaves;
  std::vector<PetscSFNode> roots;
  for (const SharedNode& shared : part.shared) {
    leaves.push_back(shared.node);
    roots.push_back({shared.rank, shared.there});
    number[shared.node] = -1;
  }
  n_own = static_cast<PetscInt>(number.size() - leaves.size());
  PetscInt next = 0;
  MPI_Scan(&n_own, &next, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD);
  next -= n_own;
  for (PetscInt& n : number)
    if (n == 0) n = next++;
  PetscSF forest;
  PetscCallAbort(PETSC_COMM_WORLD, PetscSFCreate(PETSC_COMM_WORLD, &forest));
  PetscCallAbort(PETSC_COMM_WORLD,
                 PetscSFSetGraph(forest, static_cast<PetscInt>(number.size()), static_cast<PetscInt>(leaves.size()),
                                 leaves.data(), PETSC_COPY_VALUES, roots.data(), PETSC_COPY_VALUES));
  const std::vector<PetscInt> own = number;
  PetscCallAbort(PETSC_COMM_WORLD, PetscSFBcastBegin(forest, MPIU_INT, own.data(), number.data(), MPI_REPLACE));
  PetscCallAbort(PETSC_COMM_WORLD, PetscSFBcastEnd(forest, MPIU_INT, own.data(), number.data(), MPI_REPLACE));
  PetscCallAbort(PETSC_COMM_WORLD, PetscSFDestroy(&forest));
  return number;
}

DM plex_of(const MeshPart& part) {
  PetscInt n_own = 0;
  const std::vector<PetscInt> number = numbers(part, n_own);
  std::vector<PetscInt> cells;
  for (const Hex& hex : part.mesh.hexes)
    for (const int corner : to_plex) cells.push_back(number[hex[file_corner[corner]]]);
  std::vector<PetscReal> points;
  std::size_t shared = 0;
  for (Index n = 0; n < part.mesh.n_nodes(); ++n) {
    if (shared < part.shared.size() && part.shared[shared].node == n) {
      ++shared;
      continue;
    }
    points.insert(points.end(), part.mesh.points[n].data(), part.mesh.points[n].data() + 3);
  }
  DM plex;
  PetscCallAbort(PETSC_COMM_WORLD, DMPlexCreateFromCellListParallelPetsc(
                                       PETSC_COMM_WORLD, 3, part.mesh.n_hexes(), n_own, PETSC_DECIDE, 8, PETSC_TRUE,
                                       cells.data(), 3, points.data(), nullptr, nullptr, &plex));
  return plex;
}

double sum(double value) {
  double all = 0;
  MPI_Allreduce(&value, &all, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  return all;
}

void run(PetscInt n, const std::string& command) {
  const PetscInt faces[] = {n, n, n};
  DM box, parts = nullptr;
  PetscCallAbort(PETSC_COMM_WORLD, DMPlexCreateBoxMesh(PETSC_COMM_WORLD, 3, PETSC_FALSE, faces, nullptr, nullptr,
                                                       nullptr, PETSC_TRUE, &box));
  PetscCallAbort(PETSC_COMM_WORLD, DMPlexDistribute(box, 0, nullptr, &parts));
  const double before = sum(mesh_of(parts ? parts : box).n_hexes());
  const std::string commands[] = {command};
  PartsOptions options;
  options.say = [](const std::string& line) { std::printf("%s\n", line.c_str()); };
  const MeshPart made = refine_parts(PETSC_COMM_WORLD, {mesh_of(parts ? parts : box), {}, {}}, commands, options);
  DM fine = plex_of(made);
  PetscCallAbort(PETSC_COMM_WORLD, DMPlexCheck(fine));
  PetscInt cell, end;
  double volume = 0;
  PetscCallAbort(PETSC_COMM_WORLD, DMPlexGetHeightStratum(fine, 0, &cell, &end));
  for (PetscInt c = cell; c < end; ++c) {
    PetscReal of_cell;
    PetscCallAbort(PETSC_COMM_WORLD, DMPlexComputeCellGeometryFVM(fine, c, &of_cell, nullptr, nullptr));
    volume += of_cell;
  }
  PetscPrintf(PETSC_COMM_WORLD, "%.0f -> %.0f hexes, %.0f nodes; DMPlexCheck finds nothing; volume %.3f\n", before,
              sum(made.mesh.n_hexes()), sum(static_cast<double>(made.mesh.points.size() - made.shared.size())),
              sum(volume));
  for (DM* dm : {&box, &parts, &fine}) PetscCallAbort(PETSC_COMM_WORLD, DMDestroy(dm));
}

}  // namespace

int main(int argc, char** argv) {
  PetscCall(PetscInitialize(&argc, &argv, nullptr, nullptr));
  int status = 0;
  try {
    run(argc > 1 ? std::atoi(argv[1]) : 6, argc > 2 ? argv[2] : "refine node 1 depth 1");
  } catch (const Error& error) {
    PetscPrintf(PETSC_COMM_WORLD, "error: %s\n", error.what());
    status = 1;
  }
  PetscCall(PetscFinalize());
  return status;
}
