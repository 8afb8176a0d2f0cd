// `list`: one line per entity.

#include <algorithm>
#include <array>
#include <map>

#include "hextwist/base/text.h"
#include "hextwist/mesh/association/association.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/session/commands/commands.h"

namespace hextwist {
namespace {

std::string ids_text(const auto& ids) {
  return ids.empty() ? "none" : joined(ids);
}

class Lister {
 public:
  Lister(const Execution& run) : run_(run), selector_(run.core.selector()) {}

  std::string line(EntityKind kind, Index i) {
    std::string result = std::string(name(kind)) + " " + std::to_string(id_of(selector_, kind, i));
    if (const std::string named = name_of(selector_, kind, i); !named.empty()) result += " '" + named + "'";
    return result + ": " + (is_cad(kind) ? cad(kind, i) : is_mesh(kind) ? mesh_entity(kind, i) : group(kind, i));
  }

 private:
  const Execution& run_;
  Selector selector_;
  std::map<std::pair<EntityKind, EntityKind>, std::vector<Index>> sizes_;

  const Mesh& mesh() const { return selector_.meshed.mesh; }
  const Model& model() const { return *selector_.meshed.model; }
  const Association& association() const { return selector_.meshed.association; }

  bool fixed(Index node) const {
    const auto& nodes = run_.state.fixed_nodes;
    return nodes && std::ranges::binary_search(*nodes, node);
  }

  std::string node_ids_text(std::span<const Index> nodes) const {
    std::vector<std::int64_t> ids;
    for (const Index node : nodes) ids.push_back(node_id(mesh(), node));
    return ids_text(ids);
  }

  /// How many mesh entities of the same dimension lie on a CAD entity.
  std::int64_t n_owned(Owner owner) const {
    const Association& a = association();
    switch (owner.dim) {
      case 0:
        return std::ranges::count(a.node_owner, owner);
      case 1:
        return std::ranges::count(a.edge_curve, owner.id);
      case 2:
        return std::ranges::count(a.face_surface, owner.id);
      default:
        return std::ranges::count(a.hex_volume, owner.id);
    }
  }

  std::string cad(EntityKind kind, Index i) const {
    const Owner owner{dimension(kind), i + 1};
    std::string result = model().type(owner);
    constexpr std::array<const char*, 4> measures = {"", "length", "area", "volume"};
    if (owner.dim > 0)
      result +=
          (result.empty() ? "" : ", ") + std::string(measures[owner.dim]) + " " + short_number(model().measure(owner));
    if (owner.dim == 0) result += (result.empty() ? "" : " ") + point_text(model().point(owner, {}));
    if (owner.dim == 1 && model().range(owner.id).period > 0) result += ", closed";
    if (owner.dim > 0)
      result += ", " + std::string(plural(static_cast<EntityKind>(static_cast<int>(kind) - 1))) + " " +
                ids_text(model().adjacent(owner, owner.dim - 1));
    if (owner.dim < 3)
      result += ", in " + std::string(plural(static_cast<EntityKind>(static_cast<int>(kind) + 1))) + " " +
                ids_text(model().adjacent(owner, owner.dim + 1));
    if (!association().empty()) result += ", " + counted(n_owned(owner), static_cast<EntityKind>(owner.dim));
    return result;
  }

  std::string mesh_entity(EntityKind kind, Index i) {
    DerivedTopology& topology = selector_.topology;
    switch (kind) {
      case EntityKind::node:
        return point_text(mesh().points[i]) + ", on " + to_string(owner_of_node(association(), i)) +
               (fixed(i) ? ", fixed" : "");
      case EntityKind::edge: {
        const Edge nodes = topology.edges().nodes[i];
        return "nodes " + node_ids_text(nodes) + ", length " +
               short_number((mesh().points[nodes[1]] - mesh().points[nodes[0]]).norm()) + ", on " +
               to_string(owner_of_edge(association(), mesh(), topology.edges(), topology.faces(), i));
      }
      case EntityKind::face: {
        std::string result = "nodes " + node_ids_text(topology.faces().nodes[i]) + ", hexes";
        for (const Side side : topology.faces().sides[i])
          if (side.hex >= 0) result += " " + std::to_string(hex_id(mesh(), side.hex));
        return result + ", on " + to_string(owner_of_face(association(), topology.faces(), i));
      }
      default: {
        std::vector<int> blocks;
        for (const Block& block : mesh().blocks)
          if (std::ranges::binary_search(block.hexes, i)) blocks.push_back(block.id);
        return "nodes " + node_ids_text(mesh().hexes[i]) + ", in volume " +
               std::to_string(association().hex_volume.at(i)) + (blocks.empty() ? "" : ", block " + ids_text(blocks)) +
               ", volume " + short_number(volume(mesh(), i)) + ", shape " +
               short_number(quality(Metric::shape, mesh(), i)) + ", scaled Jacobian " +
               short_number(quality(Metric::scaled_jacobian, mesh(), i));
      }
    }
  }

  std::string group(EntityKind kind, Index i) {
    switch (kind) {
      case EntityKind::block:
        return counted(static_cast<std::int64_t>(mesh().blocks[i].hexes.size()), EntityKind::hex);
      case EntityKind::nodeset:
        return counted(static_cast<std::int64_t>(mesh().node_sets[i].nodes.size()), EntityKind::node);
      case EntityKind::sideset:
        return counted(static_cast<std::int64_t>(mesh().side_sets[i].sides.size()), "side");
      case EntityKind::group:
        return members_text(selector_, selector_.groups[i]);
      default:
        break;
    }
    const Sheets& sheets = selector_.topology.sheets();
    std::string result = counted(static_cast<std::int64_t>(sheets.edges[i].size()), EntityKind::edge) + ", " +
                         counted(static_cast<std::int64_t>(sheets.hexes[i].size()), EntityKind::hex);
    if (const Index n = sheets.n_self_crossings[i]) result += ", crosses itself in " + counted(n, EntityKind::hex);
    if (const Index n = sheets.n_self_touches[i]) result += ", touches itself at " + counted(n, EntityKind::face);
    return result;
  }
};

void list_model(Execution& run) {
  const SessionState& state = run.state;
  const auto& [mesh, model, association] = *run.meshed;
  if (!model && mesh.n_hexes() == 0) return run.say("nothing: neither CAD nor mesh was read");
  if (model) {
    std::string line = state.has_cad ? "CAD" : "skin of the mesh";
    if (!state.cad_file.empty()) line += " " + state.cad_file.string();
    line += ":";
    for (int dim = 3; dim >= 0; --dim)
      line += (dim == 3 ? " " : ", ") +
              counted(model->count(dim), static_cast<EntityKind>(static_cast<int>(EntityKind::vertex) + dim));
    const Box box = model->box();
    run.say(line + ", volume " + short_number(state.cad_volume) + ", box " + point_text(box.min) + " to " +
            point_text(box.max));
  }
  if (mesh.n_hexes() == 0) return run.say("mesh: none");
  const auto n = [](const auto& list) { return static_cast<std::int64_t>(list.size()); };
  run.say("mesh: " + counted(mesh.n_hexes(), EntityKind::hex) + ", " + counted(mesh.n_nodes(), EntityKind::node) +
          ", volume " + short_number(state.measured.volume) + ", " + counted(n(mesh.blocks), EntityKind::block) + ", " +
          counted(n(mesh.node_sets), EntityKind::nodeset) + ", " + counted(n(mesh.side_sets), EntityKind::sideset) +
          ", " + counted(n(mesh.fields), "field") + (steps_text(mesh).empty() ? "" : ", " + steps_text(mesh)));
  run.say("shape: smallest " + short_number(state.measured.shape.min) + " (hex " +
          std::to_string(hex_id(mesh, state.measured.shape.min_hex)) + "), average " +
          short_number(state.measured.shape.average));
}

}  // namespace

void do_list(Execution& run) {
  const Item* range = run.command.find("range");
  if (run.command.has("undo")) return list_undo(run);
  if (!range) return list_model(run);
  if (run.asks_for_all_of_none(*range)) return;
  const std::vector<Index> positions = run.chosen(*range);
  Lister lister(run);
  for (const Index i : positions) run.say(lister.line(range->kind, i));
}

}  // namespace hextwist
