#include "hextwist/session/view/before.h"

#include <cassert>
#include <ranges>
#include <utility>

namespace hextwist {

SceneSource MeshBefore::source(std::string title) {
  return {{*meshed_, topology_, state_.groups ? std::span<const Group>(*state_.groups) : std::span<const Group>()},
          state_,
          std::move(title)};
}

bool has_mesh_before(const Session::Core& core) {
  for (const Step& step : core.history.undo | std::views::reverse) {
    if (const auto* whole = std::get_if<WholeMesh>(&step.mesh)) return whole->meshed->mesh.n_hexes() > 0;
    if (!std::holds_alternative<SameMesh>(step.mesh) && !std::holds_alternative<SetsChange>(step.mesh)) return true;
  }
  return false;
}

std::unique_ptr<MeshBefore> mesh_before(const Session::Core& core) {
  assert(has_mesh_before(core));
  std::shared_ptr<const MeshedModel> mesh;  // null: that of the session
  for (const Step& step : core.history.undo | std::views::reverse) {
    if (std::holds_alternative<SameMesh>(step.mesh)) continue;
    if (const auto* whole = std::get_if<WholeMesh>(&step.mesh))
      mesh = whole->meshed.lend();
    else
      mesh = std::make_shared<const MeshedModel>(changed(mesh ? *mesh : *core.meshed, step.mesh));
    if (std::holds_alternative<SetsChange>(step.mesh)) continue;
    SessionState state = core.state;
    static_cast<ModelState&>(state) = step.state;
    return std::make_unique<MeshBefore>(std::move(mesh), std::move(state));
  }
  return nullptr;
}

}  // namespace hextwist
