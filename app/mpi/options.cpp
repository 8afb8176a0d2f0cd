#include "mpi/options.h"

#include <CLI/CLI.hpp>
#include <iostream>

#include "exit_status.h"

namespace hextwist::app {

int read_mpi_options(int argc, char** argv, bool is_first, MpiOptions& options) {
  CLI::App app(
      "Refines a mesh by several processes: mpirun -n 8 hextwist-mpi --cad part.step mesh.e -c 'refine curve 3' -o "
      "out.e\n"
      "writes out.e.8.0 .. out.e.8.7, whose join is what hextwist writes. What can't be done in parts is done by the "
      "first process with the whole mesh, and said.",
      "hextwist-mpi");
  app.add_option("MESH", options.mesh, "mesh to start from; of a split one, any part: mesh.e.8.0, mesh_1.msh")
      ->required();
  app.add_option("-c,--commands", options.commands, "refinements and other changes of the mesh, separated by ';'")
      ->type_name("COMMANDS")
      ->allow_extra_args(false)
      ->take_all()
      ->required();
  app.add_option("--cad", options.cad, "CAD that the mesh lies on (.step, .brep, .iges)");
  app.add_option("-o,--output", options.output,
                 "OUT: each process writes its part to OUT.n.i (Exodus); where it ends in .msh, to OUT_i.msh as Gmsh "
                 "splits meshes; in .pvtu, to a .vtu file");
  app.add_option("--by", options.by,
                 "how hexes are shared out: scotch (default where the first process reads all, and it was built in), "
                 "boxes (default for an Exodus file read in slices), slabs, ids or random; parts of a split mesh stay "
                 "what they are where there are as many as processes, or go by boxes")
      ->check(CLI::IsMember({"scotch", "boxes", "slabs", "ids", "random"}));
  app.add_flag("--no-rebalance", options.fixed, "leave hexes where they are, however many each becomes");
  app.add_option("--rings", options.rings,
                 "of hexes of others around a part, to begin with; default 6, fewer than 4 are 4")
      ->check(CLI::Range(1, 250));
  app.add_option("--threads", options.threads, "threads of each process; default 1; 0: all")
      ->check(CLI::Range(0, 1024));
  app.set_version_flag("--version", "hextwist-mpi " HEXTWIST_VERSION);
  if (options.describe) {
    options.describe(app);
    return done;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::ostringstream out, err;
    const int status = app.exit(error, out, err);
    if (is_first) std::cout << out.str(), std::cerr << err.str();
    return status == 0 ? done : wrong_usage;
  }
  return -1;
}

}  // namespace hextwist::app
