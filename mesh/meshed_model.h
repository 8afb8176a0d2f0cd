// A mesh on its model.
#pragma once

#include <memory>

#include "hextwist/geom/model.h"
#include "hextwist/mesh/association/association.h"
#include "hextwist/mesh/mesh.h"

namespace HEXTWIST_API hextwist {

/// A mesh, the model it lies on, and who owns what. model may be null only when the association is empty.
struct MeshedModel {
  Mesh mesh;                           ///< without hexes: a model alone
  std::shared_ptr<const Model> model;  ///< shared by all meshes on it
  Association association;             ///< of that mesh with that model; empty: nobody owns anything
};

}  // namespace hextwist
