// What ranges ask of the shapes of the CAD: loops around surfaces, smooth chains, directions.
#pragma once

#include <optional>
#include <vector>

#include "hextwist/geom/model.h"
#include "hextwist/mesh/entity.h"

namespace hextwist {

/// Radius of a circle, cylinder, sphere or the tube of a torus; 0 of all others.
double radius(const Model& model, Owner entity);

/// Curves around a surface that hang together at vertices, the loop with the largest box first.
std::vector<std::vector<int>> surface_loops(const Model& model, int surface);
/// Whether a curve belongs to a loop that lies within the others around one of its surfaces.
bool is_hole(const Model& model, int curve);

/// The curves (or surfaces) that go on smoothly from these, and from there, and so on, with these; ascending.
std::vector<int> smooth_chain(const Model& model, int dim, std::vector<int> ids);

/// Along a line or an axis, or across a plane or the plane of a circle.
struct Direction {
  Vec3 along;
  bool is_normal = false;
};
/// Nothing for shapes that have none.
std::optional<Direction> direction(const Model& model, Owner entity);
/// Of a circle or sphere; of a cylinder the point of its axis that is nearest to the middle of its box.
std::optional<Vec3> centre(const Model& model, Owner entity);
/// A line in, or beside, a plane is parallel to it; within a thousandth of a right angle.
bool is_aligned(const Direction& a, const Direction& b, bool across);

/// Where two entities of a kind meet: surfaces in curves, hexes in faces, ...
EntityKind meeting_kind(EntityKind kind);

}  // namespace hextwist
