// The mesh as it grows: curves first, then surfaces, then volumes. Included by mesh/fill/*.cpp only.
#pragma once

#include <map>

#include "hextwist/mesh/fill/plan_internal.h"
#include "hextwist/mesh/topology.h"

namespace hextwist::fill {

class Inside;

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
  /// The same of a closed chain, each node once.
  std::vector<Index> rim_of(const Chain& loop) const;
  /// What lies within a closed line of nodes, as it turns.
  Vec3 vector_area(const std::vector<Index>& rim) const;
  bool is_meshed(int surface) const { return !surface_quads[surface - 1].empty(); }

  /// Gives a surface its quads: a grid, an O-grid, circles or a pavement.
  void mesh_surface(int surface);
  /// A core of squares and layers around it, within a rim of 4, 8, 12, ... nodes that lies about on a circle.
  std::vector<Quad> o_grid(const std::vector<Index>& rim, Owner owner);
  /// Between closed rims of an even number of nodes, whose places in a plane are `flat`: by the QuadMesher, with edges
  /// of about that length. add_at makes a node of a place. name: what messages call it.
  std::vector<Quad> pavement(const std::string& name, const std::vector<std::vector<Index>>& rims,
                             const std::vector<std::vector<Eigen::Vector2d>>& flat, double edge,
                             const std::function<Index(const Eigen::Vector2d&)>& add_at);
  /// Fills a volume from that end, and gives the other end the quads of the other.
  void sweep(const Sweep& sweep, int from);
  /// The same of a volume that was turned all the way round: its section is filled first.
  void turn(const Sweep& sweep);
  /// Of a volume that touches its axis: hexes around that, from end to end, and quads on the ends. What the section
  /// around the core has there are these lines of nodes, and quads all the way round.
  void fill_core(const Sweep& sweep, std::vector<std::vector<Index>>& pieces, std::vector<Quad>& sides);
  /// The nodes of a surface around the axis from rim to rim, where the section is.
  std::vector<Index> meridian(const Axis& axis, int surface) const;
  /// Circles between the two rims of a flat ring. even: so many layers.
  void ring(int surface, bool even = false);
  /// Throws Error where hexes between so many quads and layers cannot fit into memory.
  void check_room(std::size_t n_quads, std::size_t n_layers) const;
  /// Places of the rim in layer k of these columns, in the order of rim_nodes(); level gets what its nodes become.
  std::vector<Vec3> rim_of_level(const Inside& inside, const std::map<Index, std::vector<Index>>& columns,
                                 std::size_t k, std::map<Index, Index>& level) const;
  /// Hexes between copies of the quads: what each node becomes in each level.
  void add_layers(const std::vector<Quad>& source, const std::vector<std::map<Index, Index>>& level, int volume);
  void fill_ball(int volume, int intervals_said);
  /// Takes out what no hex has: nodes on seams and poles that the hexes pass by.
  void drop_unused();

  Index at_vertex(int vertex);

 private:
  std::vector<Index> vertex_nodes_;
  std::map<int, std::vector<Index>> ring_columns_;  // per ring from its inner to its outer rim
  void grid(int surface);
  void pave(int surface);
  double average_edge(const Chain& chain) const;
};

}  // namespace hextwist::fill
