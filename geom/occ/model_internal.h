// The model behind model.h. Included by geom/occ/*.cpp only.
#pragma once

#include <BRepClass3d_SolidClassifier.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Shape.hxx>
#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "hextwist/geom/curvature.h"
#include "hextwist/geom/facets.h"
#include "hextwist/geom/occ/curve_internal.h"
#include "hextwist/geom/occ/surface_internal.h"
#include "hextwist/geom/periods.h"

namespace hextwist::occ {

/// Names per dimension and 1-based id (entry 0 unused); may be shorter than the number of entities.
using Names = std::array<std::vector<std::string>, 4>;

/// Entities per dimension in the order of TopExp::MapShapes, which defines the ids.
using ShapeMaps = std::array<TopTools_IndexedMapOfShape, 4>;
ShapeMaps entity_maps(const TopoDS_Shape& shape);

/// What is computed when it is asked for, and can be handed over instead (fenced.cpp).
struct Known {
  std::vector<double> lengths;           ///< per curve
  std::vector<FaceIntegrals> integrals;  ///< per surface
  std::array<std::vector<Box>, 4> boxes;
};

/// Whatever OpenCASCADE throws in its members becomes an Error that names the entity.
class OccModel final : public Model, public KnowsCurvature, public KnowsFacets, public KnowsPeriods {
 public:
  /// known: null, then all is computed when it is asked for. Throws Error for what has no finite size.
  OccModel(const TopoDS_Shape& shape, Names names, Known* known = nullptr);

  /// Computes all of it.
  Known known() const;

  const TopoDS_Shape& shape() const { return shape_; }
  const Names& names() const { return names_; }

  int count(int dim) const override;
  std::string name(Owner entity) const override;
  std::string type(Owner entity) const override;
  Box box(Owner entity) const override;
  Box box() const override;
  double measure(Owner entity) const override;
  std::vector<int> adjacent(Owner entity, int dim) const override;
  double tolerance(Owner entity) const override;
  CurveRange range(int curve) const override;
  Vec3 point(Owner entity, Parameters at) const override;
  Vec3 tangent(int curve, double t) const override;
  Vec3 normal(int surface, Parameters at) const override;
  std::array<double, 2> periods(int surface) const override;
  void project(Owner entity, std::span<const Vec3> points, std::span<const Parameters> seeds,
               std::span<Projection> out) const override;
  double curvature(Owner entity, Parameters at) const override;
  SurfaceFacets facets(int surface) const override;
  bool contains(int volume, const Vec3& point) const override;
  std::vector<int> near(int dim, const Vec3& p, double distance) const override;

  using Model::project;

 private:
  /// Classifiers keep state and take long to make: a pool hands each to one thread at a time.
  struct Classifiers {
    std::mutex mutex;
    std::vector<std::unique_ptr<BRepClass3d_SolidClassifier>> idle;
  };

  struct Sides {
    std::vector<char> inside_out;  // per volume: its faces' orientations say that it is everything but itself
    std::vector<char> flipped;     // per surface: the normal of its parameters points into its (first) volume
    std::vector<char> within;      // per surface: its volume lies on both sides
  };

  enum class Side { inside, outside, unknown };

  const TopoDS_Shape& entity(Owner owner) const;
  Side side_of_nearest(int volume, const Vec3& p, double slack) const;
  bool classify(int volume, const Vec3& p, double slack) const;
  void build_adjacency();
  void project_some(Owner owner, std::span<const Vec3> points, std::span<const Parameters> seeds,
                    std::span<Projection> out) const;
  void check_finite() const;
  double compute_measure(Owner entity) const;
  double signed_volume(int volume) const;
  const std::vector<Box>& boxes(int dim) const;
  const Sides& sides() const;
  TopoDS_Shape without_faces_inside(int volume) const;

  TopoDS_Shape shape_;
  Names names_;
  ShapeMaps maps_;
  std::vector<Vec3> vertices_;
  std::vector<std::unique_ptr<Curve>> curves_;
  std::vector<std::unique_ptr<Surface>> surfaces_;
  std::array<std::array<std::vector<std::vector<int>>, 4>, 4> adjacent_;  // [dim][other dim][id - 1]

  mutable std::array<std::once_flag, 4> boxes_made_;
  mutable std::array<std::vector<Box>, 4> boxes_;
  mutable std::array<std::vector<std::atomic<double>>, 4> measures_;  // NaN until asked for
  mutable std::once_flag sides_made_;
  mutable Sides sides_;
  mutable std::vector<Classifiers> classifiers_;
};

}  // namespace hextwist::occ
