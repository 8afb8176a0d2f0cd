// The mesh as it grows: curves first, then surfaces, then volumes. Included by mesh/fill/*.cpp only.
#pragma once

#include "hextwist/mesh/fill/plan_internal.h"
#include "hextwist/mesh/topology.h"

namespace hextwist::fill {

struct Builder {
  Builder(const Facts& of, std::vector<int> intervals_of_curves, double size_of_edges, QuadMesher paver);

  const Facts& facts;
  std::vector<int> intervals;  ///< per curve id - 1
  double size;                 ///< wished length of edges inside of surfaces; 0: that of the edges around
  QuadMesher quads;

  std::vector<Vec3> points;
  std::vector<Owner> owners;
  std::vector<std::vector<Index>> curve_nodes;   ///< per curve id - 1, from its first vertex to its last
  std::vector<std::vector<Quad>> surface_quads;  ///< per surface id - 1, cycles of nodes; empty: not meshed yet
  std::vector<Hex> hexes;
  std::vector<int> hex_volume;

  Index add(const Vec3& point, Owner owner);
  /// Nodes along a chain, both ends with it (of a closed one the first node comes again).
  std::vector<Index> nodes(const Chain& chain) const;
  bool is_meshed(int surface) const { return !surface_quads[surface - 1].empty(); }

  /// Gives a surface its quads: a grid, an O-grid, circles or a pavement.
  void mesh_surface(int surface);
  /// The same of an end of a sweep, with the quads of the other.
  void sweep(const Sweep& sweep, int from);
  void fill_ball(int volume, int intervals_said);

 private:
  std::vector<Index> vertex_nodes_;
  void grid(int surface);
  void disc(int surface);
  void ring(int surface);
  void pave(int surface);
  double average_edge(const Chain& chain) const;
};

/// Makes the quads of a surface turn all the same way. The quads of several surfaces at one end of a volume hang
/// together.
void orient_alike(std::vector<Quad>& quads);

}  // namespace hextwist::fill
