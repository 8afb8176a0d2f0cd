// Random refinements that together have every kind of entity and every technique.
#pragma once

#include <random>
#include <string>

#include "hextwist/patch/refine.h"

namespace hextwist::corpus {

/// So many kinds of requests there are.
int n_requests();

/// A command of a kind (modulo n_requests()) for a mesh on its model.
std::string request(int kind, const MeshedModel& input, std::mt19937& random);

}  // namespace hextwist::corpus
