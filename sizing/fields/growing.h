// Sizes that grow with the distance from what a request names.
#pragma once

#include "hextwist/sizing/fields/size_field.h"
#include "hextwist/sizing/target_distance.h"

namespace hextwist {

/// size at the targets and growing by `growth` - 1 per unit of distance from them, so that neighbours grow by about the
/// factor `growth`. Throws Error unless size > 0 and growth >= 1.
SizeFieldPtr growing_size(double size, double growth, std::shared_ptr<const TargetDistance> from);

}  // namespace hextwist
