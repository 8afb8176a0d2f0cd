// Mesh and model elsewhere.
#pragma once

#include "hextwist/geom/similarity.h"
#include "hextwist/session/transaction.h"

namespace hextwist {

/// What is read is scaled before anything looks at it: the mesh with what its file says beyond.
void scale(Mesh& mesh, double factor);

/// Moves the mesh and the model of the session. Entities, blocks and sets keep their ids, fields their values; the mesh
/// is the base of what is refined later. Throws Error where there is neither.
void move(Transaction& run, const Similarity& similarity);

}  // namespace hextwist
