// Refines a mesh along the curves of its CAD: minimal part.brep part.msh refined.vtu CURVE...
//
// The whole library in the order in which a refinement runs through it. Errors come as hextwist::Error with a line
// that is ready to be shown.
#include <algorithm>
#include <iostream>

#include "hextwist/hextwist.h"

int main(int argc, char** argv) try {
  if (argc < 5) {
    std::cerr << "usage: minimal CAD MESH OUTPUT CURVE...\n";
    return 2;
  }
  const auto cad = hextwist::read_cad(argv[1]);
  const auto file = hextwist::read_mesh(argv[2]);
  const auto associated = hextwist::associate(file.mesh, *cad.model, &file.tags);

  hextwist::Request request;
  request.target.kind = hextwist::EntityKind::curve;
  for (int i = 4; i < argc; ++i) request.target.ids.push_back(std::stoi(argv[i]));
  std::ranges::sort(request.target.ids);

  const auto result = hextwist::refine({file.mesh, cad.model, associated.association}, request);
  const auto& report = result.report;
  std::cout << report.hexes_before << " hexes became " << report.hexes_after << ", smallest shape "
            << report.shape_after.min << ", nodes within " << report.off_cad.max << " of the CAD\n";
  if (!report.violations.empty()) throw hextwist::Error(report.violations.front().text);
  hextwist::write_mesh(argv[3], result.refined.mesh, &result.refined.association);
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
