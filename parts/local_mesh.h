// What one rank has of a mesh: the hexes of its part and some rings of others' hexes around them (its halo).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hextwist/parts/pass_record.h"
#include "hextwist/sizing/plan.h"

namespace hextwist {

/// Hexes of the input mesh that a rank has; what they have become since says which of them it came of.
struct BaseHexes {
  std::vector<Index> hex, node;    ///< indices in the whole, ascending
  std::vector<std::uint8_t> ring;  ///< per hex: 0 own, 1 those that share a node with own ones, ...
  std::vector<int> owner;          ///< per hex
};

struct LocalMesh {
  MeshedModel meshed;          ///< in the order of the whole, ids left out
  std::vector<Index> base_of;  ///< per hex: position in base.hex
  BaseHexes base;
  int n_rings = 0;      ///< that are there, and as they are in the whole
  bool is_all = false;  ///< nothing of the mesh lies beyond
};

/// Precondition: the rank has a hex.
LocalMesh local_mesh(const MeshedModel& whole, std::span<const int> part_of_hex, int rank, int n_rings);

/// Takes away all rings beyond these. kept_nodes, kept_hexes: what the nodes and hexes that stay were called.
void trim(LocalMesh& local, int n_rings, std::vector<Index>& kept_nodes, std::vector<Index>& kept_hexes);

/// A refinement, with its target by indices of the whole input mesh where it names nodes, edges, faces or hexes.
struct Asked {
  Request request;
  Approach approach = Approach::trisect;
  std::vector<Edge> edges;
  std::vector<Quad> faces;
};
/// Throws Error naming what can't be done in parts. before: what is done before it.
Asked asked_in_parts(const MeshedModel& whole, const Request& request, std::span<const Asked> before);

struct LocalRun {
  std::vector<PassRecord> records;
  bool by_levels = false;
  Index n_cut = 0;
  std::vector<std::uint64_t> digest;  ///< per base hex: of all that it has become
};
/// Runs the passes on what is there; the local mesh becomes the result, which is right where what lies beyond the halo
/// has no say. Throws Error where the result is no good, or depends on the whole.
LocalRun run_locally(LocalMesh& local, const Asked& asked);

}  // namespace hextwist
