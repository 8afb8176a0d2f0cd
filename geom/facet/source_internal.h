// What a model of facets keeps of its making.
#pragma once

#include "hextwist/geom/facet/model.h"

namespace hextwist {

struct KnowsSource {
  std::shared_ptr<const FacetSource> source;
};

/// Arguments as for facet_model(). Of the nodes those of the skin alone are kept.
FacetSource source_of(std::span<const Vec3> points, std::span<const std::array<std::int32_t, 4>> quads,
                      std::span<const std::array<int, 2>> quad_volumes, const FacetModelOptions& options);

}  // namespace hextwist
