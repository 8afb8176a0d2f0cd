// What a range means: the entities of a session that it names.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hextwist/command/group.h"
#include "hextwist/command/select/range.h"
#include "hextwist/mesh/meshed_model.h"
#include "hextwist/mesh/sheets.h"
#include "hextwist/mesh/topology.h"

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
/// in the lists of blocks, sets and groups, and id - 1 for CAD entities.
struct Selector {
  const MeshedModel& meshed;
  DerivedTopology& topology;
  std::span<const Group> groups = {};
};

/// How many entities of a kind there are; 0 where the mesh or model is missing.
Index count(const Selector& selector, EntityKind kind);
/// Id and name as the user knows them.
std::int64_t id_of(const Selector& selector, EntityKind kind, Index position);
std::string name_of(const Selector& selector, EntityKind kind, Index position);

/// Positions, ascending, each once; may be empty when a filter leaves nothing. Remarks (ids of a span that
/// do not exist, exceptions without effect) are appended to notices. why: says what left nothing, and what comes
/// nearest. Throws CommandError at the first id or name that does not exist. Memory and time are bounded by what
/// exists, not by the ids written.
std::vector<Index> select(const Selector& selector, const Statement& statement, EntityKind kind, const Range& range,
                          std::vector<std::string>& notices, std::string* why = nullptr);

/// Positions of the members of a group that still exist, ascending.
std::vector<Index> members(const Selector& selector, const Group& group, EntityKind kind);
/// The same as the group keeps them.
std::array<std::int64_t, 4> member_of(const Selector& selector, EntityKind kind, Index position);

/// Does a name match a pattern? Without case; * stands for any text, ? for one byte.
bool matches(std::string_view name, std::string_view pattern);

/// Box of an entity, empty where it has no place (a set without members). The middle: the node or vertex itself, else
/// the average of the corners of a mesh entity, the point of a curve or surface that is nearest to the middle of its
/// box, or the middle of the box.
Box box(const Selector& selector, EntityKind kind, Index position);
Vec3 middle(const Selector& selector, EntityKind kind, Index position);

/// Whether each of the positions meets a criterion, 1 or 0. Throws CommandError where it can't be evaluated.
std::vector<char> meets(const Selector& selector, const Statement& statement, EntityKind kind,
                        const Criterion& criterion, std::span<const Index> positions);

/// A number per position: the value of an attribute.
std::vector<double> values_of(const Selector& selector, const Statement& statement, EntityKind kind,
                              const Criterion& measure, std::span<const Index> positions);

/// Distance of each entity of a kind from a point, as by_distance() has it.
std::vector<double> distances(const Selector& selector, EntityKind kind, const Vec3& point);
/// Positions of all entities of a kind by their distance from a point: that of the entity itself, of the nearest member
/// for blocks, sets, groups and sheets, 0 inside of hexes and volumes. Those equally near (within rounding, as entities
/// that meet at the point are) by the distance of their middle, then by id.
std::vector<Index> by_distance(const Selector& selector, EntityKind kind, const Vec3& point);

/// Entities of one kind that lie in (or touch, where they are of higher dimension) entities of another: positions to
/// positions, ascending. Between CAD entities by the model's adjacency, else through the mesh. A group stands for its
/// members of the kind asked for; where it has none, for what lies in any of its members.
std::vector<Index> related(const Selector& selector, EntityKind from, const std::vector<Index>& positions,
                           EntityKind to);

}  // namespace hextwist
