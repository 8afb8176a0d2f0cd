// The CAD as the rest of the program sees it: entities, how they meet, and projection onto them.
//
// Implementations: OccModel (OpenCASCADE), FacetModel (skin of a mesh), AnalyticModel (closed forms, for tests).
//
// Guarantees of every implementation:
//  1. ids are 1-based and contiguous per dimension, in a documented, repeatable order;
//  2. every const member may be called from several threads at once;
//  3. project() lands on the trimmed entity (not on the unbounded plane or cylinder that carries it);
//  4. point(owner, projection.parameters) equals projection.point to rounding.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hextwist/base/types.h"
#include "hextwist/geom/owner.h"

namespace HEXTWIST_API hextwist {

/// Parameter interval of a curve; period 0 means not closed. For a closed curve last - first == period.
struct CurveRange {
  double first = 0;   ///< t where the curve begins
  double last = 1;    ///< t where it ends, above first
  double period = 0;  ///< above 0: t and t + period are the same point
};

/// A geometry: read from CAD (read_cad()), the skin of a mesh (associate_with_own_skin()), or a class of your own.
/// Immutable, and shared by all meshes on it. Entities that do not exist must not be asked about: count() tells.
class Model {
 public:
  virtual ~Model() = default;

  /// Number of entities of a dimension (0 vertices .. 3 volumes).
  virtual int count(int dim) const = 0;
  /// Name given in the CAD file, "" if none.
  virtual std::string name(Owner entity) const = 0;
  /// Geometric type in the usual words: "line", "circle", "plane", "cylinder", "bspline surface", "facets", ...
  virtual std::string type(Owner entity) const = 0;
  /// Tight box of one entity.
  virtual Box box(Owner entity) const = 0;
  /// Box of everything. box().diagonal() is the model size that relative tolerances refer to.
  virtual Box box() const = 0;
  /// Length of a curve, area of a surface, volume of a volume; 0 for a vertex.
  virtual double measure(Owner entity) const = 0;
  /// Ids of the entities of dimension `dim` that bound the entity (dim below its own) or that it bounds (dim above),
  /// through any number of steps; ascending, each once.
  virtual std::vector<int> adjacent(Owner entity, int dim) const = 0;
  /// How far the CAD's own pieces may lie apart at this entity, in model units (0 where exact).
  virtual double tolerance(Owner entity) const = 0;

  /// Parameter interval of a curve.
  virtual CurveRange range(int curve) const = 0;
  /// The point of a vertex, or of a curve at t = u, or of a surface at (u, v).
  virtual Vec3 point(Owner entity, Parameters at) const = 0;
  /// Unit tangent of a curve, zero where it has none.
  virtual Vec3 tangent(int curve, double t) const = 0;
  /// Unit normal of a surface, zero at a degenerate point. Points out of the volume where the surface bounds one
  /// volume only; for a surface between two volumes, out of the lower id.
  virtual Vec3 normal(int surface, Parameters at) const = 0;

  /// Closest points on one entity of dimension 0, 1 or 2, for many points at once.
  /// seeds: empty, or one per point (NaN: none): parameters to start from, e.g. those of a parent node; a seeded
  /// projection is local and fast, an unseeded one is global. out: one per point.
  virtual void project(Owner entity, std::span<const Vec3> points, std::span<const Parameters> seeds,
                       std::span<Projection> out) const = 0;

  /// Is the point inside the volume (distance to its boundary above tolerance counts; on the boundary: true)?
  virtual bool contains(int volume, const Vec3& point) const = 0;

  /// Vertices, curves and surfaces (of dimension `dim`) with a point within `distance` of p, ascending ids.
  /// A candidate filter: may return more, never less.
  virtual std::vector<int> near(int dim, const Vec3& p, double distance) const = 0;

  /// Closest point on one entity: project() for a single point without seed.
  Projection project(Owner entity, const Vec3& p) const;
};

}  // namespace hextwist
