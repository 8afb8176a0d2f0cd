// Hex meshes of volumes of the CAD that nobody has meshed yet: what can be swept or was turned, and balls.
//
// A volume is swept from the surfaces at its one end (its caps) to those at the other, along side surfaces with four
// sides (or tubes, which have two rims and a seam). Caps with four corners get a grid, discs an O-grid, narrow rings
// circles; all others are paved with quads by somebody else (QuadMesher). Boxes, extruded and turned solids, pipes and
// cylinders are all of that kind. What was turned about an axis that it touches (shafts with steps, cones, domes) has a
// core around that axis, and its section turned around the core. Balls get the seven blocks of mesh/primitives.h.
//
// Guarantees:
//  1. volumes that share a surface have the same quads there;
//  2. nodes on vertices, curves and surfaces lie where Model::point() puts them;
//  3. no hex is promised to be right: who fills looks at the shapes;
//  4. the same mesh for the same model, options and pavings.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "hextwist/geom/model.h"
#include "hextwist/mesh/association/association.h"
#include "hextwist/mesh/mesh.h"

namespace hextwist {

/// Triangles and quads in a plane; a triangle has -1 in its last place.
struct FlatMesh {
  std::vector<Eigen::Vector2d> points;
  std::vector<std::array<Index, 4>> elements;
};

/// Sine of the angle at p from the way to `next` to the way to `before`: negative where a polygon that turns to the
/// left turns back there, -1 where there is no angle.
inline double corner_sine(const Eigen::Vector2d& before, const Eigen::Vector2d& p, const Eigen::Vector2d& next) {
  const Eigen::Vector2d a = next - p, b = before - p;
  const double lengths = a.norm() * b.norm();
  return lengths > 0 ? (a.x() * b.y() - a.y() * b.x()) / lengths : -1.0;
}

/// Meshes what lies between closed polygons (the outer one and those of holes, in any order and direction): points are
/// those of the polygons, in their order, and then what it adds inside; no side of a polygon is cut. size: wished
/// length of edges inside. Throws Error.
using QuadMesher = std::function<FlatMesh(const std::vector<std::vector<Eigen::Vector2d>>& polygons, double size)>;

struct FillOptions {
  std::vector<int> volumes;  ///< ids, ascending; empty: all
  double size = 0;           ///< length of edges, model units; 0: a fifteenth of the diagonal of these volumes
  int intervals = 0;         ///< along each curve, instead of a size; 0: by size
  QuadMesher quads;          ///< null: caps that need it are refused
};

struct FillResult {
  Mesh mesh;         ///< a block for each volume, of its id and name
  Association tags;  ///< of everything but balls, as known from how it was made: for associate()
  std::vector<std::string> notices;
};

/// Throws Error naming the volumes that cannot be filled, each with the reason, and what else can be done.
FillResult fill_volumes(const Model& model, const FillOptions& options);

}  // namespace hextwist
