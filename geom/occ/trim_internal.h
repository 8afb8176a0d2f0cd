// Is a parameter pair inside a face's boundary? Included by geom/occ/*.cpp only.
#pragma once

#include <Geom2d_Curve.hxx>
#include <Geom_Surface.hxx>
#include <TopoDS_Face.hxx>
#include <vector>

#include "hextwist/base/types.h"

namespace hextwist::occ {

struct Range {
  double min = 0;
  double max = 0;
};

/// One use of an edge in a face's boundary: its curve in the face's parameter plane.
struct Boundary {
  int edge = 0;  // 0-based edge index in the model
  int wire = 0;  // uses of one wire follow each other
  Handle(Geom2d_Curve) curve;
  double first = 0;
  double last = 1;
  bool reversed = false;
  double tolerance = 0;
};

/// The boundary curves as polygons in the parameter plane, each segment with a bound on how far the curve strays from
/// it. A point farther than that from all segments is decided by counting crossings; one nearer, by the curve itself.
/// Immutable, so any number of threads may ask.
class Trim {
 public:
  /// surface: the face's surface with its location applied; boundaries: of the face oriented forward.
  /// tolerance: 3D distance outside the boundary that still counts as inside.
  Trim(const TopoDS_Face& face, const Handle(Geom_Surface) & surface, std::vector<Boundary> boundaries,
       double tolerance);

  const std::vector<Boundary>& boundaries() const { return boundaries_; }
  Range u() const { return u_; }
  Range v() const { return v_; }
  /// The boundary's curves follow each other without gaps worth mentioning.
  bool closed() const { return ordered_; }
  /// (u, v) must have been brought into the range where the surface is periodic.
  bool inside(double u, double v) const;

 private:
  // Coordinates are parameters scaled to the unit square.
  struct Segment {
    double au, av, bu, bv;
    double ta, tb;
    double slack;
    int boundary;
  };

  gp_Pnt2d scaled(const gp_Pnt2d& uv) const { return {uv.X() * scale_u_, uv.Y() * scale_v_}; }
  void sample(int boundary);
  void sample(int boundary, double ta, const gp_Pnt2d& a, double tb, const gp_Pnt2d& b, int depth);
  void close_gaps(const std::vector<std::size_t>& starts);
  bool find_rectangle() const;
  void sort_into_slabs();
  std::size_t slab(double v) const;
  bool inside_rectangle(double u, double v) const;
  bool near_boundary_inside(double u, double v, const Segment& segment) const;

  TopoDS_Face face_;
  Handle(Geom_Surface) surface_;
  std::vector<Boundary> boundaries_;
  double tolerance_;
  Range u_, v_;
  double scale_u_ = 1, scale_v_ = 1;
  bool ordered_ = true;     // boundaries follow each other, so gaps between them could be closed
  bool rectangle_ = false;  // the boundary is the parameter rectangle itself
  std::vector<Segment> segments_;
  std::vector<int> slab_start_, slab_segment_;
};

}  // namespace hextwist::occ
