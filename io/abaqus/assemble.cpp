// Parts, instances and sets of an Abaqus file become a mesh.
//
// Element sets are blocks (their hexes) and side sets (their quads), node sets and surfaces of nodes are node sets,
// surfaces of elements side sets; ids count them in the order of the file. A second instance whose ids are taken gets
// ids above all others. Sets of parts that stand several times are named instance.set.
#include <limits>
#include <set>

#include "hextwist/base/sorted.h"
#include "hextwist/io/abaqus/abaqus_internal.h"

namespace hextwist::io {
namespace {

/// A part as it stands in the mesh.
struct Placed {
  std::string instance;
  const AbaqusScope* scope;
  std::int64_t node_shift = 0, element_shift = 0;
};

/// Members of a set: indices of the mesh.
struct Members {
  std::vector<Index> nodes, hexes;
  std::vector<Side> sides;
};

class Assembly {
 public:
  explicit Assembly(AbaqusContents&& contents) : in_(std::move(contents)) {}

  MeshFile result() {
    for (const auto& scope : in_.scopes) sort_unique(scope->other_ids);
    place();
    elements();
    for (const Placed& placed : placed_)
      for (const AbaqusSet& set : placed.scope->sets) add_set(placed, set);
    if (in_.assembly && !placed_by_scope(in_.assembly))
      for (const AbaqusSet& set : in_.assembly->sets) add_set({"", in_.assembly, 0, 0}, set);
    finish_sets();
    for (const auto& [type, n] : in_.n_dropped)
      out_.notices.push_back("dropped " + std::to_string(n) + " elements of type " + type);
    if (n_missing_) out_.notices.push_back("sets name " + std::to_string(n_missing_) + " nodes or elements not there");
    return std::move(out_);
  }

 private:
  bool placed_by_scope(const AbaqusScope* scope) const {
    return std::ranges::any_of(placed_, [&](const Placed& placed) { return placed.scope == scope; });
  }

  /// Puts all instances (or, without any, all parts) side by side in one numbering.
  void place() {
    std::vector<AbaqusInstance> instances = in_.instances;
    if (instances.empty())
      for (const auto& scope : in_.scopes)
        if (scope.get() != in_.scopes[0].get() && scope.get() != in_.assembly)
          instances.push_back({scope->name, scope.get()});
    std::vector<std::int64_t> node_ids, hex_ids;
    std::vector<const char*> node_at;
    std::int64_t highest_node = 0, highest_element = 0;
    const auto add = [&](const AbaqusInstance& instance) {
      const AbaqusScope& part = *instance.part;
      Placed placed{instance.name, &part};
      const auto shift = [](const std::vector<std::int64_t>& ids, std::int64_t highest) {
        return !ids.empty() && std::ranges::min(ids) <= highest ? highest : std::int64_t{0};
      };
      placed.node_shift = shift(part.node_ids, highest_node);
      auto all = part.hex_ids;
      for (const auto* more : {&part.quad_ids, &part.other_ids}) all.insert(all.end(), more->begin(), more->end());
      placed.element_shift = shift(all, highest_element);
      for (std::size_t i = 0; i < part.node_ids.size(); ++i) {
        node_ids.push_back(part.node_ids[i] + placed.node_shift);
        node_origin_.emplace_back(&part, i);
        const bool still = instance.turn.isIdentity(0) && instance.shift.isZero(0);
        out_.mesh.points.push_back(still ? part.points[i] : Vec3(instance.turn * part.points[i] + instance.shift));
      }
      for (std::size_t i = 0; i < part.hex_ids.size(); ++i) hex_ids.push_back(part.hex_ids[i] + placed.element_shift);
      for (const auto id : node_ids) highest_node = std::max(highest_node, id);
      for (const auto id : all) highest_element = std::max(highest_element, id + placed.element_shift);
      placed_.push_back(placed);
    };
    add({"", in_.scopes[0].get()});
    for (const AbaqusInstance& instance : instances) add(instance);
    if (in_.assembly && !in_.assembly->hex_ids.empty())
      add({"", in_.assembly});
    else if (in_.assembly && !in_.assembly->node_ids.empty())
      out_.notices.push_back("dropped " + std::to_string(in_.assembly->node_ids.size()) +
                             " nodes of the assembly (reference points)");
    if (hex_ids.empty()) throw Error(in_.sources[0]->name + ": there is no hex in the file");

    nodes_ = Ids(std::move(node_ids), "node", [&](std::size_t i, const std::string& what) {
      const auto [part, k] = node_origin_[i];
      const auto run = std::ranges::upper_bound(part->node_runs, k, {}, &Run::first) - 1;
      const char* at = run->at;
      for (std::size_t line = run->first; line < k; ++line) at = std::strchr(at, '\n') + 1;
      in_.fail(at, what);
    });
    nodes_.sort(out_.mesh.points);
    out_.mesh.node_ids = nodes_.stored();
    hexes_ = Ids(std::move(hex_ids), "element", [&](std::size_t i, const std::string& what) {
      for (const Placed& placed : placed_) {
        if (i < placed.scope->hex_at.size()) in_.fail(placed.scope->hex_at[i], what);
        i -= placed.scope->hex_at.size();
      }
      throw Error(in_.sources[0]->name + ": " + what);
    });
    out_.mesh.hex_ids = hexes_.stored();
  }

  void elements() {
    for (const Placed& placed : placed_) {
      const AbaqusScope& part = *placed.scope;
      for (std::size_t i = 0; i < part.hex_ids.size(); ++i) {
        Hex& hex = out_.mesh.hexes.emplace_back();
        for (std::size_t c = 0; c < 8; ++c) {
          const std::int64_t id = part.hex_nodes[8 * i + c];
          const Index node = nodes_.find(id + placed.node_shift);
          if (node < 0)
            in_.fail(part.hex_at[i], "element " + std::to_string(part.hex_ids[i]) + " names node " +
                                         std::to_string(id) + ", which is not there");
          hex[file_corner[c]] = node;
        }
      }
    }
    hexes_.sort(out_.mesh.hexes);
    std::vector<Quad> quads;
    for (const Placed& placed : placed_)
      for (std::size_t i = 0; i < placed.scope->quad_ids.size(); ++i) {
        Quad quad;
        bool there = true;
        for (std::size_t c = 0; c < 4; ++c) {
          quad[c] = nodes_.find(placed.scope->quad_nodes[4 * i + c] + placed.node_shift);
          there = there && quad[c] >= 0;
        }
        if (!there) continue;
        quads.push_back(quad);
        quad_of_id_.emplace(placed.scope->quad_ids[i] + placed.element_shift, static_cast<Index>(quads.size() - 1));
      }
    quad_sides_ = oriented_sides(out_.mesh, quads);
    if (const auto lost = std::ranges::count(quad_sides_, -1, &Side::hex))
      out_.notices.push_back("dropped " + std::to_string(lost) + " quads that are no side of a hex");
  }

  const Placed* find_instance(std::string_view name) const {
    for (const Placed& placed : placed_)
      if (same_word(placed.instance, name)) return &placed;
    return nullptr;
  }

  void add_node(const Placed& placed, std::int64_t id, Members& to) {
    const Index node = nodes_.find(id + placed.node_shift);
    if (node >= 0)
      to.nodes.push_back(node);
    else
      ++n_missing_;
  }
  void add_element(const Placed& placed, std::int64_t id, Members& to) {
    const Index hex = hexes_.find(id + placed.element_shift);
    if (hex >= 0) {
      to.hexes.push_back(hex);
    } else if (const auto quad = quad_of_id_.find(id + placed.element_shift); quad != quad_of_id_.end()) {
      if (quad_sides_[quad->second].hex >= 0) to.sides.push_back(quad_sides_[quad->second]);
    } else if (!std::ranges::binary_search(placed.scope->other_ids, id)) {
      ++n_missing_;
    }
  }

  /// Members of a set with the sets that it names, to any depth.
  void resolve(const Placed& placed, const AbaqusSet& set, Members& to, int depth = 0) {
    if (depth > 50) in_.fail(set.at, "set " + shown(set.name) + " contains itself");
    const Placed* home = &placed;
    if (!set.instance.empty()) {
      home = find_instance(set.instance);
      if (!home) in_.fail(set.at, "there is no instance " + shown(set.instance));
    }
    for (const std::int64_t id : set.ids)
      set.kind == AbaqusSet::nodes ? add_node(*home, id, to) : add_element(*home, id, to);
    for (const AbaqusMember& member : set.members) resolve_member(*home, set.kind, member, to, depth);
  }
  void resolve_member(const Placed& placed, AbaqusSet::Kind kind, const AbaqusMember& member, Members& to, int depth) {
    const Placed* home = &placed;
    std::string name = member.text;
    if (const auto dot = name.find('.'); dot != std::string::npos)
      if (const Placed* instance = find_instance(std::string_view(name).substr(0, dot))) {
        home = instance;
        name.erase(0, dot + 1);
      }
    std::int64_t id = 0;
    const auto [stop, error] = std::from_chars(name.data(), name.data() + name.size(), id);
    if (error == std::errc{} && stop == name.data() + name.size()) {
      kind == AbaqusSet::nodes ? add_node(*home, id, to) : add_element(*home, id, to);
      return;
    }
    bool found = false;
    for (const AbaqusSet& other : home->scope->sets)
      if (other.kind == kind && same_word(other.name, name)) {
        found = true;
        resolve(*home, other, to, depth + 1);
      }
    if (!found) in_.fail(member.at, "there is no set " + shown(member.text));
  }

  void add_set(const Placed& placed, const AbaqusSet& set) {
    Members members;
    if (set.kind == AbaqusSet::surface)
      for (const auto& [member, face] : set.surface_members) add_surface(placed, member, face, members);
    else
      resolve(placed, set, members);
    std::size_t times = 0;
    for (const Placed& other : placed_) times += other.scope == placed.scope;
    std::string name = times > 1 ? placed.instance + "." + set.name : set.name;
    const std::array<const char*, 3> kinds = {"nodeset", "block", "sideset"};
    const std::string key = upper_case(name);
    if (in_.ours && !in_.real_names.contains({kinds[set.kind], key})) return;  // NALL, EALL
    auto& to = sets_[{set.kind, key}];
    if (to.order == 0) to = {sets_.size(), name, {}};
    for (auto [from, into] : {std::pair(&members.nodes, &to.members.nodes), {&members.hexes, &to.members.hexes}})
      into->insert(into->end(), from->begin(), from->end());
    to.members.sides.insert(to.members.sides.end(), members.sides.begin(), members.sides.end());
  }

  void add_surface(const Placed& placed, const AbaqusMember& member, const std::string& face, Members& to) {
    Members elements;
    resolve_member(placed, AbaqusSet::elements, member, elements, 0);
    to.sides.insert(to.sides.end(), elements.sides.begin(), elements.sides.end());  // quads: SPOS, SNEG
    if (elements.hexes.empty()) return;
    if (face.empty()) {
      // Without a face: those that are on the skin.
      if (!skin_.n_hexes) skin_ = {out_.mesh.n_hexes(), boundary_sides(faces(out_.mesh))};
      sort_unique(elements.hexes);
      for (const Side& side : skin_.sides)
        if (std::ranges::binary_search(elements.hexes, side.hex)) to.sides.push_back(side);
      return;
    }
    const int number = face.size() == 2 && face[0] == 'S' ? face[1] - '0' : 0;
    if (number < 1 || number > 6) in_.fail(member.at, "face " + shown(face) + " of a hex; known are S1 to S6");
    for (const Index h : elements.hexes) to.sides.push_back({h, abaqus_face[number - 1]});
  }

  void finish_sets() {
    std::vector<std::pair<std::size_t, std::pair<AbaqusSet::Kind, std::string>>> order;
    for (const auto& [key, set] : sets_) order.emplace_back(set.order, key);
    std::ranges::sort(order);
    Mesh& mesh = out_.mesh;
    for (const auto& [position, key] : order) {
      auto& [unused, name, members] = sets_[key];
      sort_unique(members.nodes);
      sort_unique(members.hexes);
      sort_unique(members.sides);
      const auto real = [&](const char* kind, auto& groups) -> auto& {
        const auto known = in_.real_names.find({kind, key.second});
        auto& group = group_of_id(groups, known == in_.real_names.end() ? free_id(groups) : known->second.first);
        group.name = known == in_.real_names.end() ? name : known->second.second;
        return group;
      };
      if (key.first == AbaqusSet::nodes) real("nodeset", mesh.node_sets).nodes = std::move(members.nodes);
      if (key.first == AbaqusSet::surface) real("sideset", mesh.side_sets).sides = std::move(members.sides);
      if (key.first != AbaqusSet::elements) continue;
      const bool quads = !members.sides.empty();
      if (!members.hexes.empty() || (in_.ours && !quads)) real("block", mesh.blocks).hexes = std::move(members.hexes);
      if (quads) real("sideset", mesh.side_sets).sides = std::move(members.sides);
    }
  }

  struct Collected {
    std::size_t order = 0;
    std::string name;
    Members members;
  };
  struct Skin {
    Index n_hexes = 0;
    std::vector<Side> sides;
  };

  AbaqusContents in_;
  MeshFile out_;
  std::vector<Placed> placed_;
  std::vector<std::pair<const AbaqusScope*, std::size_t>> node_origin_;
  Ids nodes_, hexes_;
  std::map<std::int64_t, Index> quad_of_id_;
  std::vector<Side> quad_sides_;
  std::map<std::pair<AbaqusSet::Kind, std::string>, Collected> sets_;
  Skin skin_;
  std::int64_t n_missing_ = 0;
};

}  // namespace

MeshFile assemble_abaqus(AbaqusContents&& contents) {
  return Assembly(std::move(contents)).result();
}

}  // namespace hextwist::io
