// How the sizes of hexes compare with the wish.
#pragma once

#include <array>
#include <numbers>
#include <span>
#include <string>
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

/// By more than that a hex is coarser, or finer, than wished. ratio: of actual and wished size.
inline bool is_coarser(double ratio) {
  return ratio > std::numbers::sqrt3;
}
inline bool is_finer(double ratio) {
  return ratio < 1 / std::numbers::sqrt3;
}

/// "66% within a factor of sqrt(3), 12 coarser, ..."
std::string text_of_sizes(const SizesMet& counts);

/// Fills hexes, ratio and the counts.
SizeReport size_report(const Mesh& mesh, std::vector<Index> hexes, const SizeField& wish);

/// The same hexes in each of their directions.
DirectionSizes direction_sizes(const Mesh& mesh, std::span<const Index> hexes, const SizeField& wish);

}  // namespace hextwist
