// Meshes on their models, ready to be refined.
#pragma once

#include <string>

#include "hextwist/sizing/request.h"

namespace hextwist::test {

/// grid(a, b, c) on the brick that it fills, associated by geometry.
MeshedModel brick(int a, int b, int c);

/// One of models/ by name: the .brep with the .msh, associated with its tags.
MeshedModel shipped(const std::string& name);

}  // namespace hextwist::test
