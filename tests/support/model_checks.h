// Promises that every Model makes, checked from outside with the model's own public functions.
#pragma once

#include <gtest/gtest.h>

#include <random>

#include "hextwist/geom/model.h"

namespace hextwist::test {

/// Adjacency is symmetric, ascending, within range; boxes nest; measures are positive.
void expect_entities_consistent(const Model& model);

struct ProjectionChecks {
  int n_points = 50;        ///< random points per entity, in and around its box
  int n_rivals = 200;       ///< sampled points of the entity that must not be closer (curves; surfaces by projecting)
  double tolerance = 1e-9;  ///< relative to the model size
};
/// For random points and every vertex, curve and surface: the distance is that of the point, parameters give the
/// point, projecting again stays, the point is in the entity's box, near() finds the entity, tangents and normals
/// have length one, nothing sampled on the entity is closer, and batches and seeds change nothing.
void expect_projections_consistent(const Model& model, std::mt19937& random, const ProjectionChecks& checks = {});

}  // namespace hextwist::test
