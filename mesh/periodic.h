// Surfaces that repeat others: what lies on one lies on the other as well, moved rigidly.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "hextwist/mesh/meshed_model.h"

namespace hextwist {

/// A periodic boundary.
struct PeriodicPair {
  int of = 0;                                          ///< the surface that decides
  int surface = 0;                                     ///< the one that repeats it
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();  ///< takes `of` to `surface`: p -> turn p + shift
  Vec3 shift = Vec3::Zero();                           ///< see there

  /// Where a point of `of` is on `surface`.
  Vec3 image(const Vec3& p) const { return turn * p + shift; }
};

/// A node, and the one that repeats it.
using NodePair = std::array<Index, 2>;

/// What a request has to keep (Finish::periodic).
struct PeriodicBoundary {
  std::vector<PeriodicPair> pairs;
};

/// The nodes on `of`, ascending, each with its image: nodes of `surface` correspond one to one, and their faces to
/// faces. near: how far an image may be from where the map takes the node; none: a quarter of the shortest edge there,
/// as for nodes that were moved on one side. Throws Error that says what has no image, by id.
std::vector<NodePair> node_pairs(const Mesh& mesh, const Association& association, const PeriodicPair& pair,
                                 std::optional<double> near = std::nullopt);

/// How far images may lie off their places, for a mesh of that size.
double periodic_tolerance(const Mesh& mesh);

/// The map between two surfaces: a translation, or where both are flat a rotation about the line in which their planes
/// meet. Throws Error where neither takes the nodes of one to those of the other.
PeriodicPair find_periodic_pair(const Mesh& mesh, const Association& association, int of, int surface);

/// Puts nodes that repeat others exactly where these decide, on the entities that own them. Returns those that moved,
/// ascending. Throws Error as node_pairs(), and when the CAD itself does not repeat there.
std::vector<Index> repeat_places(MeshedModel& meshed, std::span<const PeriodicPair> pairs);

/// Throws Error when a pair does not hold (any more).
void check_periodic(const MeshedModel& meshed, std::span<const PeriodicPair> pairs);

/// Nodes of the faces on these surfaces, ascending.
std::vector<Index> nodes_on_surfaces(const Mesh& mesh, const Association& association, std::span<const int> surfaces);

/// The surfaces of pairs, ascending.
std::vector<int> periodic_surfaces(std::span<const PeriodicPair> pairs);

/// Nodes on the surfaces of pairs, ascending.
std::vector<Index> periodic_nodes(const Mesh& mesh, const Association& association,
                                  std::span<const PeriodicPair> pairs);

}  // namespace hextwist
