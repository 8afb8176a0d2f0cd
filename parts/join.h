// Parts of a mesh made one mesh again.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "hextwist/mesh/meshed_model.h"

namespace hextwist {

/// Pieces of one mesh, under the ids of the whole: nodes of the same id are one node, all that is known of a hex comes
/// from the piece that has it. Nodes, hexes and members of groups ascend by id; ids 1, 2, ... are left out. Groups are
/// all that any piece has; a field that a piece lacks is not a number there. The model is that of the first piece; what
/// files said beyond (Mesh::results) is not joined.
/// name: what messages call a piece. Throws Error when two pieces have the same hex, or a node at different places.
MeshedModel join(std::span<const MeshedModel> pieces, const std::function<std::string(std::size_t)>& name);
MeshedModel join(std::span<const MeshedModel* const> pieces, const std::function<std::string(std::size_t)>& name);

/// Adds what another part says of the whole (Mesh::results) to what those before it have said: values of properties, of
/// groups that have members there. Either may be null.
void join_results(std::shared_ptr<const FileResults>& whole, const std::shared_ptr<const FileResults>& part);

}  // namespace hextwist
