// What a range means: the entities of a session that it names.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hextwist/command/range.h"
#include "hextwist/mesh/sheets.h"
#include "hextwist/mesh/topology.h"
#include "hextwist/sizing/request.h"

namespace hextwist {

/// Topology of a mesh, derived when first asked for and kept. The mesh must not change meanwhile. Not for several
/// threads at once.
class DerivedTopology {
 public:
  explicit DerivedTopology(const Mesh& mesh) : mesh_(mesh) {}
  const Edges& edges();
  const Faces& faces();
  const Sheets& sheets();

 private:
  const Mesh& mesh_;
  std::optional<Edges> edges_;
  std::optional<Faces> faces_;
  std::optional<Sheets> sheets_;
};

/// What ranges are evaluated against. Positions are 0-based: indices of nodes, edges, faces, hexes and sheets, places
/// in the mesh's lists of blocks and sets, and id - 1 for CAD entities.
struct Selector {
  const MeshedModel& meshed;
  DerivedTopology& topology;
};

/// How many entities of a kind there are; 0 where the mesh or model is missing.
Index count(const Selector& selector, EntityKind kind);
/// Id and name as the user knows them.
std::int64_t id_of(const Selector& selector, EntityKind kind, Index position);
std::string name_of(const Selector& selector, EntityKind kind, Index position);

/// Positions, ascending, each once; may be empty when an `in` or `except` leaves nothing. Remarks (ids of a span that
/// do not exist, exceptions without effect) are appended to notices.
/// Throws CommandError at the first id or name that does not exist. Memory and time are bounded by what exists, not by
/// the ids written.
std::vector<Index> select(const Selector& selector, const Statement& statement, EntityKind kind, const Range& range,
                          std::vector<std::string>& notices);

/// Entities of one kind that lie in (or touch, where they are of higher dimension) entities of another: positions to
/// positions, ascending. Between CAD entities by the model's adjacency, else through the mesh.
std::vector<Index> related(const Selector& selector, EntityKind from, const std::vector<Index>& positions,
                           EntityKind to);

}  // namespace hextwist
