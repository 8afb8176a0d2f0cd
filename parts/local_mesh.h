// What one part has of a mesh: its own hexes and some rings of others' hexes around them (its halo).
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "hextwist/parts/numbering.h"
#include "hextwist/sizing/among_parts.h"
#include "hextwist/sizing/lift_new.h"
#include "hextwist/sizing/plan.h"
#include "hextwist/sizing/report.h"

namespace hextwist {

/// Hexes of the input mesh that a part has; what they have become since says which of them it came of.
struct BaseHexes {
  std::vector<std::int64_t> hex, node;  ///< ids, ascending
  std::vector<std::uint8_t> ring;       ///< per hex: 0 own, 1 those that share a node with own ones, ...
  std::vector<int> owner;               ///< per hex: the part that has it as its own
};

struct LocalMesh {
  MeshedModel meshed;          ///< in the order of the whole, ids left out
  std::vector<Index> base_of;  ///< per hex: position in base.hex
  BaseHexes base;
  int n_rings = 0;      ///< that are there, as they are in the whole and with their ids
  bool is_all = false;  ///< nothing of the mesh lies beyond

  bool is_own(Index hex) const { return base.ring[base_of[hex]] == 0; }
  int owner(Index hex) const { return base.owner[base_of[hex]]; }
};
std::int64_t n_own_hexes(const LocalMesh& local);
/// Bytes of its mesh and of who owns what.
std::size_t array_bytes(const LocalMesh& local);

/// Takes away all rings beyond these, and their ids. Throws Error where what stays is not in the order of ids.
void trim(LocalMesh& local, int n_rings, GlobalIds& ids);

/// A refinement of what one part has.
struct Asked {
  Request request;  ///< in the numbers of its local mesh
  Approach approach = Approach::trisect;
  bool is_here = true;  ///< false: nothing of the target is
  /// Of requests for sizes: hexes of the target that are here, which may be none where sizes are wished for everywhere.
  std::vector<Index> region;
};

/// What parts know of the whole mesh before a command.
struct OfWhole {
  Box box;
  std::int64_t n_hexes = 0;
};
/// Around the part's own hexes.
Box own_box(const LocalMesh& local);

/// How well sizes are met.
struct SizeCounts {
  SizesMet met;
  std::int64_t unmet = 0;
  void add(const SizeCounts& more);
};
/// One line; none where no size was wished for.
std::string text_of(const SizeCounts& counts);

struct LocalRun {
  std::vector<PassRecord> records;
  bool by_levels = false;
  std::vector<std::uint64_t> digest;  ///< per base hex: of all that it has become, and how
  std::string by_whole;               ///< what was decided by all that is here at once; empty: nothing was
  SizeCounts sizes;                   ///< of own hexes
  std::string wrong;                  ///< why the part's own hexes are no good; empty: they are, if all parts agree
};
/// The least of the bounds that all parts have for a step of lifting (sizing/lift_new.h), freedom 0 to n_freedoms - 1.
using LeastOfAll = std::function<Bounds(int freedom, const Bounds& mine)>;
/// Of a part that has nothing to lift.
inline constexpr Bounds no_bounds = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
inline Bounds least(const Bounds& a, const Bounds& b) {
  return {std::min(a.scaled_jacobian, b.scaled_jacobian), std::min(a.shape, b.shape)};
}

/// The numbers of all parts by which techniques for sizes are compared (sizing/among_parts.h), and whether one of them
/// could not go on.
using NumbersOfAll = std::function<PartNumbers(const PartNumbers& mine, bool& has_failed)>;
struct OfAll {
  LeastOfAll least;
  NumbersOfAll numbers;
};

/// Runs the passes on what is there; the local mesh becomes the result, which is right where what lies beyond the halo
/// has no say (agree.h). of_all.least is called n_freedoms times, whatever happens, of_all.numbers as often as by all
/// other parts. Throws Error; where another part did, nothing is made.
LocalRun run_locally(LocalMesh& local, const Asked& asked, const OfWhole& whole, const OfAll& of_all);

}  // namespace hextwist
