// How the sizes of hexes compare with the wish.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "hextwist/sizing/fields/size_field.h"
#include "hextwist/sizing/report.h"

namespace hextwist {

/// Size of each hex of a selection: the cube root of its volume.
std::vector<double> actual_sizes(const Mesh& mesh, std::span<const Index> hexes);

/// What is wished of hexes: the field at their centroids.
std::vector<double> wished_sizes(const Mesh& mesh, std::span<const Index> hexes, const SizeField& wish);

/// Of a hex in each of its three directions: the longest edge.
std::array<double, 3> lengths(const Mesh& mesh, Index hex);

/// Fills hexes, ratio and the counts.
SizeReport size_report(const Mesh& mesh, std::vector<Index> hexes, const SizeField& wish);

/// The same hexes in each of their directions.
DirectionSizes direction_sizes(const Mesh& mesh, std::span<const Index> hexes, const SizeField& wish);

}  // namespace hextwist
