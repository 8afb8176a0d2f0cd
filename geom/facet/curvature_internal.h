// How strongly a skin of facets bends, estimated from how neighbouring facets are turned.
//
// Facets are flat or nearly so; what bends is the surface that the nodes were put on. Exact for nodes on a circle (any
// spacing), and for even facets on a cylinder; off by a few percent on a sphere and where facets are uneven.
// What turns by less than least_turn from facet to facet counts as flat: so many elements per radian are there already.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hextwist/geom/facet/bilinear.h"

namespace hextwist {

inline constexpr double least_turn = 1e-3;  ///< radians

using FacetNodes = std::array<std::int32_t, 4>;
using FacetEdge = std::array<std::int32_t, 2>;  ///< lower node first

/// One value per facet of a surface: one over the radius of the tightest circle, at least 0. quads: the same facets by
/// the numbers of their nodes, in cyclic order. features: edges that are corners, ascending; facets on both sides of
/// one may still belong to one surface, as round a twisted ring. A facet without neighbours is flat.
std::vector<double> facet_curvatures(std::span<const BilinearPatch> patches, std::span<const FacetNodes> quads,
                                     std::span<const FacetEdge> features);

/// One value per segment of a polyline through these points; closed: the first point is the last one again, and
/// the polyline goes on there without a corner.
std::vector<double> segment_curvatures(std::span<const Vec3> points, bool closed);

}  // namespace hextwist
