// Meshes on their models, ready to be refined.
#pragma once

#include <string>

#include "hextwist/patch/refine.h"

namespace hextwist::test {

/// grid(a, b, c) on the brick that it fills, associated by geometry.
MeshedModel brick(int a, int b, int c);

/// One of models/ by name: the .brep with the .msh, associated with its tags.
MeshedModel shipped(const std::string& name);

/// Adds failures unless the result is conformal, uninverted, without violations, and its association complete.
void expect_sound(const RefineResult& result);

/// What refine() says against a request; "not refused" where it does not.
std::string refusal(const MeshedModel& input, const Request& request);

/// The hex field "level" as integers, zeros where there is none.
std::vector<int> levels(const Mesh& mesh);

/// Average of the corners.
Vec3 centroid(const Mesh& mesh, Index hex);

}  // namespace hextwist::test
