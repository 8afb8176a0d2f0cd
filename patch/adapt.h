// Adaptive analysis: which hexes are too coarse comes from a solver, the refined mesh and where it came from go back.
//
//   const AdaptResult next = adapt(meshed, flags);          // flags[h] != 0: cut hex h
//   for (Index h = 0; h < next.refined.mesh.n_hexes(); ++h) transfer(old_solution[next.origin[h]], h);
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hextwist/sizing/report.h"
#include "hextwist/sizing/request.h"

namespace HEXTWIST_API hextwist {

struct AdaptOptions {
  /// Cut more hexes than flagged, so that none has a neighbour (that shares a node) of a level more than one below its
  /// own: repeated calls of both kinds then grade from coarse to fine. False: exactly the flagged ones.
  bool keep_gradation = true;
  /// Of wished sizes: limits their growth from element to element (Sizes::bias).
  double bias = 1;
  Concave concave = Concave::templates;
  bool smooth = false;
  std::vector<Index> fixed = {};  ///< nodes (0-based) that are not moved (Finish::fixed)
};

struct AdaptResult {
  MeshedModel refined;        ///< with the field of levels
  std::vector<Index> origin;  ///< per hex: the hex of the input that it lies in
  Report report;
};

/// Flags and wishes of a solver as requests like any other.
/// flags: one per hex, 0 or not. Throws Error when there is not one flag per hex.
Request adapt_request(const Mesh& mesh, std::span<const std::uint8_t> flags, const AdaptOptions& options = {});
/// sizes: one per hex, infinity where there is no wish. Throws Error when there is not one size per hex.
Request adapt_request(const Mesh& mesh, std::span<const double> sizes, const AdaptOptions& options = {});

/// Cuts the flagged hexes into 27 each. No flag at all: the mesh as it was. Throws as adapt_request(); Cancelled.
AdaptResult adapt(const MeshedModel& input, std::span<const std::uint8_t> flags, const AdaptOptions& options = {},
                  const Progress& progress = {});

/// Cuts hexes until they have their wished sizes. Throws as adapt_request(), and when one is not positive; Cancelled.
AdaptResult adapt(const MeshedModel& input, std::span<const double> sizes, const AdaptOptions& options = {},
                  const Progress& progress = {});

}  // namespace hextwist
