// Who bounds whom among the entities of a model.
#pragma once

#include <array>
#include <vector>

#include "hextwist/geom/owner.h"

namespace hextwist {

/// Answers Model::adjacent() for models that know their incidences as a list: add() each direct one (a curve and its
/// vertex, a surface and a vertex that is on none of its curves, ...), close() once, then ask.
class Incidence {
 public:
  /// n: number of entities per dimension.
  explicit Incidence(const std::array<int, 4>& n);

  /// `part` bounds `whole`; its dimension is the lower one. Repeating is harmless.
  void add(Owner whole, Owner part);
  /// Follows chains, so that a volume has the curves of its surfaces, and the same upwards.
  void close();

  int count(int dim) const { return n_[dim]; }
  /// Ascending, each once; empty for the entity's own dimension.
  const std::vector<int>& adjacent(Owner entity, int dim) const { return lists_[entity.dim][dim][entity.id - 1]; }

 private:
  std::array<int, 4> n_;
  std::array<std::array<std::vector<std::vector<int>>, 4>, 4> lists_;  // [dim][dim of the answer][id - 1]
};

}  // namespace hextwist
