// The way into the engine: a request in, a verified mesh out.
#pragma once

#include "hextwist/sizing/report.h"
#include "hextwist/sizing/request.h"

namespace HEXTWIST_API hextwist {

/// Runs a request. The input is not changed. The result is conformal and all-hex; it is uninverted and on the model
/// unless the report has violations (the caller decides whether to keep such a mesh; the program does not).
/// Throws Error for unknown ids, options out of range, wishes that do not go together, CAD targets without a model;
/// Cancelled.
RefineResult refine(const MeshedModel& input, const Request& request, const Progress& progress = {});

}  // namespace hextwist
