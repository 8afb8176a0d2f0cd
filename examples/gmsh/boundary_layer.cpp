// A box meshed by Gmsh, with layers along one side: boundary_layer OUTPUT.msh
#include <gmsh.h>

#include <iostream>

#include "hextwist/embed/gmsh.h"

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::cerr << "usage: boundary_layer OUTPUT\n";
    return 2;
  }
  gmsh::initialize();
  gmsh::option::setNumber("General.Verbosity", 2);
  gmsh::model::occ::addBox(0, 0, 0, 4, 2, 1);
  gmsh::model::occ::synchronize();
  gmsh::vectorpair entities;
  gmsh::model::getEntities(entities);
  for (const auto& [dim, tag] : entities) {
    if (dim == 1) gmsh::model::mesh::setTransfiniteCurve(tag, 9);
    if (dim == 2) gmsh::model::mesh::setTransfiniteSurface(tag), gmsh::model::mesh::setRecombine(2, tag);
    if (dim == 3) gmsh::model::mesh::setTransfiniteVolume(tag);
  }
  gmsh::model::mesh::generate(3);

  // Surface 1 is that of Gmsh. The callback prints what the command did.
  hextwist::SessionCallbacks callbacks;
  callbacks.output = [](const std::string& line) { std::cout << line << '\n'; };
  hextwist::refine_gmsh("refine surface 1 direction layers 4 growth 1.5", callbacks);
  gmsh::write(argv[1]);
  gmsh::finalize();
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
