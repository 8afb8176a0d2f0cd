// Skins of meshes, as facet_model() wants them, and meshes with interesting skins.
#pragma once

#include "hextwist/geom/facet/model.h"
#include "hextwist/mesh/mesh.h"

namespace hextwist::test {

struct Skin {
  std::vector<std::array<std::int32_t, 4>> quads;
  std::vector<std::array<int, 2>> volumes;
};
/// Boundary quads and those between hexes of different volumes. hex_volume: per hex, empty for all 1.
Skin skin(const Mesh& mesh, std::span<const int> hex_volume = {});
FacetImport facet_model_of(const Mesh& mesh, std::span<const int> hex_volume = {}, double feature_angle = 35);

/// The grid 2n x 2n x layers squeezed into the cylinder of radius 1 around z, z = 0..height.
Mesh round_grid(int n, int layers, double height);
/// A closed ring of radius 4, cross section a x b cells of size 1 / max(a, b), that turns by so many quarters on the
/// way round; odd numbers need a == b.
Mesh twisted_ring(int n, int a, int b, int quarters);

}  // namespace hextwist::test
