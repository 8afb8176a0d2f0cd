// The mesh as it was before the last command that changed it, for who looks at both.
#pragma once

#include <memory>
#include <string>

#include "hextwist/session/core.h"
#include "hextwist/session/view/scene.h"

namespace hextwist {

/// Keeps what a scene of it needs. It stays as it is whatever becomes of the session.
class MeshBefore {
 public:
  MeshBefore(std::shared_ptr<const MeshedModel> meshed, SessionState state)
      : meshed_(std::move(meshed)), state_(std::move(state)), topology_(meshed_->mesh) {}
  MeshBefore(const MeshBefore&) = delete;

  const Mesh& mesh() const { return meshed_->mesh; }
  SceneSource source(std::string title);

 private:
  std::shared_ptr<const MeshedModel> meshed_;
  SessionState state_;
  DerivedTopology topology_;
};

/// By what `undo` knows. Changes of blocks and sets alone do not count, nor does what was no mesh yet.
bool has_mesh_before(const Session::Core& core);
/// Precondition: there is one.
std::unique_ptr<MeshBefore> mesh_before(const Session::Core& core);

}  // namespace hextwist
