// Nodal fields where nodes have ended up: a node that was moved, or put elsewhere than straight between old ones, gets
// the values that the fields of the old mesh have at its place.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "hextwist/mesh/locate.h"
#include "hextwist/mesh/mesh.h"

namespace hextwist {

bool has_nodal_fields(const Mesh& mesh);

/// Per node of `nodes`: the lowest hex of the old mesh that one of its hexes comes from. origin: per hex of `after`
/// that old hex; empty: itself.
std::vector<Index> hexes_to_begin_with(const Mesh& after, std::span<const Index> nodes, std::span<const Index> origin);

/// Where in a mesh points are, each looked for from a hex on, across faces, towards the point: near it, a fault that
/// opens between doubled nodes is not crossed. Outside of the mesh it ends at the hex at its boundary that is nearest
/// on that way. `at` may be outside of 0 .. 1 then.
std::vector<HexPlace> find_places(const Mesh& mesh, std::span<const Vec3> points, std::span<const Index> begin);

/// What the eight nodes of a hex count for a value at p; sum 1. Inside the hex: trilinear. Outside: from the nearest
/// place on by the slope that the field has there. What is linear is so everywhere, to rounding.
std::array<double, 8> weights_at(std::span<const Vec3, 8> corners, const Vec3& at, const Vec3& p);

/// Puts the values of before's nodal fields at the places of these nodes of `after` into `fields`, which begin with the
/// same fields. Fields of whole numbers get that of the corner that counts most; a value stays where one of the corners
/// has none (not finite). origin: as above. The same for any number of threads.
void evaluate_nodal_fields(const Mesh& before, const Mesh& after, std::span<const Index> nodes,
                           std::span<const Index> origin, std::span<Field> fields);

/// The same for a mesh whose nodes have moved, between the same hexes.
void evaluate_where_moved(const Mesh& before, Mesh& after);

/// Gives a node the values that a node of another mesh has. The fields of `from` are the first of `to`.
void copy_nodal_values(const Mesh& from, Index node, Mesh& to, Index at);

}  // namespace hextwist
