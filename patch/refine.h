// The way into the engine: a request in, a verified mesh out.
#pragma once

#include "hextwist/patch/verify.h"
#include "hextwist/sizing/report.h"
#include "hextwist/sizing/request.h"

namespace hextwist {

/// Runs a request. The input is not changed. The result is conformal and all-hex; it is uninverted and on the model
/// unless the report has violations (the caller decides whether to keep such a mesh; the program does not).
/// Throws Error for unknown ids, options out of range, wishes that do not go together, CAD targets without a model;
/// Cancelled.
RefineResult refine(const MeshedModel& input, const Request& request, const Progress& progress = {});

/// The same for an input that is known: the result is verified where it differs from the input, in time proportional
/// to the change and a few sweeps over the arrays. What is reported is the same, but for rounding in averages.
RefineResult refine(const MeshedModel& input, const Measured& known, const Request& request,
                    const Progress& progress = {});

/// The same by passes over the whole mesh, where it is known that no patch would do. known may be null.
RefineResult refine_whole(const MeshedModel& input, const Measured* known, const Request& request,
                          const Progress& progress = {});

}  // namespace hextwist
