// `list`: one line per entity.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "hextwist/base/text.h"
#include "hextwist/command/select/shapes.h"
#include "hextwist/mesh/association/association.h"
#include "hextwist/mesh/others.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/session/commands/commands.h"

namespace hextwist {
namespace {

std::string ids_text(const auto& ids) {
  return ids.empty() ? "none" : joined(ids);
}

/// Lines of a table whose columns are as wide as they need to be.
std::vector<std::string> table_lines(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> width;
  for (const auto& row : rows) {
    width.resize(std::max(width.size(), row.size()), 0);
    for (std::size_t c = 0; c < row.size(); ++c) width[c] = std::max(width[c], row[c].size());
  }
  std::vector<std::string> lines;
  for (const auto& row : rows) {
    std::string& line = lines.emplace_back();
    for (std::size_t c = 0; c < row.size(); ++c) line += row[c] + std::string(width[c] - row[c].size() + 2, ' ');
    line.erase(line.find_last_not_of(' ') + 1);
  }
  return lines;
}

class Lister {
 public:
  Lister(const Execution& run) : run_(run), selector_(run.core.selector()) {}

  std::string line(EntityKind kind, Index i) {
    std::string result = std::string(name(kind)) + " " + std::to_string(id_of(selector_, kind, i));
    if (const std::string named = name_of(selector_, kind, i); !named.empty())
      result += " '" + printable(named, 1000) + "'";
    return result + ": " + (is_cad(kind) ? cad(kind, i) : is_mesh(kind) ? mesh_entity(kind, i) : group(kind, i));
  }

  /// Of several entities of the CAD.
  std::vector<std::string> table(EntityKind kind, const std::vector<Index>& positions) const {
    const int dim = dimension(kind);
    const std::vector<std::int64_t> n = n_owned(dim);
    std::vector<std::vector<std::string>> rows = {header(dim)};
    for (const Index i : positions) {
      const Owner owner{dim, i + 1};
      const Box box = model().box(owner);
      std::vector<std::string>& row = rows.emplace_back();
      row.push_back(std::to_string(owner.id));
      if (dim == 0) row.push_back(point_text(model().point(owner, {})));
      if (dim > 0) {
        if (dim < 3) row.push_back(model().type(owner));
        row.push_back(short_number(model().measure(owner)));
      }
      if (dim == 1 || dim == 2) {
        const double r = radius(model(), owner);
        row.push_back(r > 0 ? short_number(r) : "-");
      }
      if (dim == 1) {
        const CurveRange range = model().range(owner.id);
        for (const double end : {range.first, range.last}) row.push_back(place(model().point(owner, {end, 0})));
      } else if (dim > 1) {
        row.push_back(point_text(box.min));
        row.push_back(point_text(box.max));
      }
      if (dim > 0) row.push_back(ids_text(model().adjacent(owner, dim - 1)));
      if (dim < 3) row.push_back(ids_text(model().adjacent(owner, dim + 1)));
      if (!n.empty()) row.push_back(std::to_string(n[i]));
      row.push_back(printable(name_of(selector_, kind, i), 1000));
    }
    return table_lines(rows);
  }

 private:
  std::vector<std::string> header(int dim) const {
    std::vector<std::string> row = {
        std::string(name(static_cast<EntityKind>(static_cast<int>(EntityKind::vertex) + dim)))};
    if (dim == 0) row.insert(row.end(), {"at", "curves"});
    if (dim == 1) row.insert(row.end(), {"type", "length", "radius", "from", "to", "vertices", "surfaces"});
    if (dim == 2) row.insert(row.end(), {"type", "area", "radius", "box from", "to", "curves", "volumes"});
    if (dim == 3) row.insert(row.end(), {"volume", "box from", "to", "surfaces"});
    constexpr std::array<const char*, 4> meshed = {"nodes", "edges", "faces", "hexes"};
    if (!association().empty()) row.emplace_back(meshed[dim]);
    row.emplace_back("name");
    return row;
  }
  /// How many mesh entities lie on each CAD entity of a dimension.
  std::vector<std::int64_t> n_owned(int dim) const {
    if (association().empty()) return {};
    std::vector<std::int64_t> n(static_cast<std::size_t>(model().count(dim)), 0);
    const auto count = [&](const std::vector<int>& ids) {
      for (const int id : ids)
        if (id > 0) ++n[static_cast<std::size_t>(id - 1)];
    };
    if (dim == 0)
      for (const Owner owner : association().node_owner)
        if (owner.dim == 0) ++n[static_cast<std::size_t>(owner.id - 1)];
    if (dim == 1) count(association().edge_curve);
    if (dim == 2) count(association().face_surface);
    if (dim == 3) count(association().hex_volume);
    return n;
  }

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

  /// Radius, centre and directions, where a shape has them.
  std::string shape(Owner owner) const {
    std::string result;
    if (owner.dim == 0 || owner.dim == 3) return result;
    if (const double r = radius(model(), owner); r > 0) result += ", radius " + short_number(r);
    const auto along = direction(model(), owner);
    const bool straight = owner.dim == 1 && along && !along->is_normal,
               plane = owner.dim == 2 && along && along->is_normal;
    const auto middle = centre(model(), owner);
    if (middle) result += (model().type(owner) == "cylinder" ? ", around " : ", centre ") + place(*middle);
    if (along)
      result += (straight ? ", direction " : plane ? ", normal " : ", axis ") + point_text(clean(along->along));
    if (owner.dim == 1) {
      const CurveRange range = model().range(owner.id);
      if (range.period == 0)
        result += ", from " + place(model().point(owner, {range.first, 0})) + " to " +
                  place(model().point(owner, {range.last, 0}));
    }
    return result;
  }
  /// Without the noise of what is 0 but for rounding; of points at the size of the model.
  static Vec3 clean(Vec3 p, double size = 1) {
    constexpr double noise = 1e-12;
    for (double& x : p)
      if (std::abs(x) < noise * size) x = 0;
    return p;
  }
  std::string place(const Vec3& p) const { return point_text(clean(p, model().box().diagonal())); }

  /// Groups that it is a member of.
  std::string groups_with(EntityKind kind, Index i) const {
    std::string result;
    for (const Group& group : selector_.groups)
      if (std::ranges::binary_search(members(selector_, group, kind), i))
        result += (result.empty() ? ", in group '" : ", '") + printable(group.name, 1000) + "'";
    return result;
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
    result += shape(owner);
    if (!association().empty()) result += ", " + counted(n_owned(owner), static_cast<EntityKind>(owner.dim));
    if (owner.dim > 0) {
      const Box box = model().box(owner);
      result += ", box " + point_text(box.min) + " to " + point_text(box.max);
    }
    return result + groups_with(kind, i);
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
  if (mesh.others) run.say("other elements: " + others_text(mesh));
  run.say("shape: smallest " + short_number(state.measured.shape.min) + " (hex " +
          std::to_string(hex_id(mesh, state.measured.shape.min_hex)) + "), average " +
          short_number(state.measured.shape.average));
}

/// `list field`: every field, where it has values, and from where to where these go.
void list_fields(Execution& run) {
  const Mesh& mesh = run.meshed->mesh;
  if (mesh.fields.empty()) return run.note("there are no fields");
  std::vector<std::vector<std::string>> rows = {{"field", "on", "components", "smallest", "largest", ""}};
  for (const Field& field : mesh.fields) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const double x : field.values) {
      if (!(x >= low)) low = std::isnan(x) ? low : x;
      if (!(x <= high)) high = std::isnan(x) ? high : x;
    }
    rows.push_back({"'" + printable(field.name, 1000) + "'", field.on == Field::On::node ? "nodes" : "hexes",
                    std::to_string(field.components), short_number(low), short_number(high),
                    field.integer ? "integers" : ""});
  }
  for (const std::string& line : table_lines(rows)) run.say(line);
  if (const std::string steps = steps_text(mesh); !steps.empty()) run.say(steps);
}

}  // namespace

void do_list(Execution& run) {
  const Item* range = run.command.find("range");
  if (run.command.has("field")) return list_fields(run);
  if (run.command.has("periodic")) return list_periodic(run);
  if (run.command.has("undo")) return list_undo(run);
  if (!range) return list_model(run);
  if (run.asks_for_all_of_none(*range)) return;
  const std::vector<Index> positions = run.chosen(*range);
  Lister lister(run);
  if (is_cad(range->kind) && positions.size() > 1) {
    for (const std::string& line : lister.table(range->kind, positions)) run.say(line);
    return;
  }
  for (const Index i : positions) run.say(lister.line(range->kind, i));
}

}  // namespace hextwist
