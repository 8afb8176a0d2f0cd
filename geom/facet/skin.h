// Features of the skin of a mesh: which quads form a surface, which edges a curve, which nodes a vertex.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "hextwist/geom/facet/model.h"
#include "hextwist/geom/facet/quadratic.h"

namespace hextwist {

struct SkinFeatures {
  FacetClassification classification;
  int n_surfaces = 0;
  int n_volumes = 0;
  /// Quads turned so that their counter-clockwise side looks out of the volume, or out of the lower of two.
  std::vector<std::array<std::int32_t, 4>> quads;
  std::vector<QuadraticPatch> patches;  ///< the same, curved; empty where the skin is straight
  /// Per surface: the volume behind it (the lower one), and the one in front (0: none).
  std::vector<std::array<int, 2>> surface_volumes;
  /// Per curve: its nodes in order. The lowest edge runs from its lower to its higher node; a closed curve starts and
  /// ends at its vertex, or at its lowest node if it has none, which is then listed twice.
  std::vector<std::vector<std::int32_t>> curve_nodes;
  /// Pairs (surface, curve), ascending, each once.
  std::vector<std::array<int, 2>> surface_curves;
};

/// Arguments as for facet_model(); labels and middles may be null. Throws Error when the angle is not within 0..180.
SkinFeatures find_skin_features(std::span<const Vec3> points, std::span<const std::array<std::int32_t, 4>> quads,
                                std::span<const std::array<int, 2>> quad_volumes, double feature_angle,
                                const FacetLabels* labels = nullptr, const FacetMiddles* middles = nullptr);

}  // namespace hextwist
