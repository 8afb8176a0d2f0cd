// refine() for who knows more of its input than anybody.
#pragma once

#include "hextwist/patch/refine.h"
#include "hextwist/patch/verify.h"

namespace hextwist {

/// refine() for an input that is known: the result is verified where it differs from the input, in time proportional
/// to the change and a few sweeps over the arrays. What is reported is the same, but for rounding in averages.
RefineResult refine(const MeshedModel& input, const Measured& known, const Request& request,
                    const Progress& progress = {});

/// The same by passes over the whole mesh, where it is known that no patch would do. known may be null.
RefineResult refine_whole(const MeshedModel& input, const Measured* known, const Request& request,
                          const Progress& progress = {});

}  // namespace hextwist
