// Refines the mesh of Gmsh's current model in place. Needs the library hextwist_gmsh (CMake: hextwist::gmsh), which is
// built where libgmsh is found.
//
//   gmsh::initialize();
//   gmsh::open("part.geo");
//   gmsh::model::mesh::generate(3);
//   hextwist::refine_gmsh("refine curve 3 numsplit 2");
//   gmsh::write("part.msh");
//
// What gmsh_exchange.h says holds: what ids in commands mean, what is refused, where elements go. The model has to have
// 8-node hexes and no other volume elements. New nodes lie on its OpenCASCADE CAD where it has that, else (Gmsh's
// built-in kernel, models from mesh files) on the skin of the mesh. Physical groups stay, since they are
// made of entities; views do not change. Entities that no hex touches are left alone. Periodic correspondences of nodes
// on refined entities are dropped.
#pragma once

#include <string_view>

#include "hextwist/embed/gmsh_exchange.h"

namespace HEXTWIST_API hextwist {

/// Takes the mesh, runs the commands in a session and puts the mesh back. Throws Error (CommandError for a command);
/// Gmsh's model is then as it was.
void refine_gmsh(std::string_view commands, SessionCallbacks callbacks = {});

/// The first half, for those who want to do more in between. Throws Error with the session as it was.
GmshLink take_from_gmsh(Session& session);
/// The second half, into the model that was current then. Throws Error with Gmsh's model as it was.
void put_into_gmsh(const Session& session, const GmshLink& link);

}  // namespace hextwist
