// Where the parameters of surfaces come again.
#pragma once

#include <array>

#include "hextwist/geom/model.h"

namespace hextwist {

/// A model whose surfaces may close on themselves implements this too.
class KnowsPeriods {
 public:
  virtual ~KnowsPeriods() = default;
  /// By how much the parameters (u, v) of a surface may differ and mean the same place; 0 where it does not close.
  virtual std::array<double, 2> periods(int surface) const = 0;
};

/// {0, 0} of a model that does not know.
inline std::array<double, 2> periods(const Model& model, int surface) {
  const auto* knows = dynamic_cast<const KnowsPeriods*>(&model);
  return knows ? knows->periods(surface) : std::array<double, 2>{0, 0};
}

}  // namespace hextwist
