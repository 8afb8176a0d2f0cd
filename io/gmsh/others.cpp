// Elements beside the hexes in Gmsh's files: tetrahedra, wedges, pyramids and triangles, and those quads and lines that
// are no side or edge of a hex. Physical groups of dimension 3 are blocks, of dimension 2 side sets; those of dimension
// 1 are kept as they are, but for blocks of lines that we have written.
#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "hextwist/base/sorted.h"
#include "hextwist/io/gmsh/others.h"
#include "hextwist/io/others.h"

namespace hextwist::io {
namespace {

/// Types with the order of their nodes: place in the file per place here (that of VTK); empty: the same.
struct KnownGmshType {
  int type;
  OtherShape shape;
  std::vector<int> order;
};
const std::vector<KnownGmshType>& known_gmsh_types() {
  static const std::vector<KnownGmshType> types = {
      {1, OtherShape::line, {}},
      {8, OtherShape::line, {}},
      {2, OtherShape::triangle, {}},
      {9, OtherShape::triangle, {}},
      {3, OtherShape::quad, {}},
      {16, OtherShape::quad, {}},
      {10, OtherShape::quad, {}},
      {4, OtherShape::tetrahedron, {}},
      {11, OtherShape::tetrahedron, {0, 1, 2, 3, 4, 5, 6, 7, 9, 8}},
      {7, OtherShape::pyramid, {}},
      {19, OtherShape::pyramid, {0, 1, 2, 3, 4, 5, 8, 10, 6, 7, 9, 11, 12}},
      {14, OtherShape::pyramid, {0, 1, 2, 3, 4, 5, 8, 10, 6, 7, 9, 11, 12, 13}},
      {6, OtherShape::wedge, {}},
      {18, OtherShape::wedge, {0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11}},
      {13, OtherShape::wedge, {0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11, 15, 17, 16}},
  };
  return types;
}

int gmsh_type_of(OtherShape shape, std::size_t n_nodes) {
  if (shape == OtherShape::point) return gmsh_point;
  if (shape == OtherShape::connector) return n_nodes == 1 ? gmsh_point : n_nodes == 2 ? gmsh_line : 0;
  for (const KnownGmshType& known : known_gmsh_types())
    if (known.shape == shape && gmsh_type(known.type)->n_nodes == static_cast<int>(n_nodes)) return known.type;
  return 0;
}

const KnownGmshType* known_gmsh_type(int type) {
  const auto at = std::ranges::find(known_gmsh_types(), type, &KnownGmshType::type);
  return at == known_gmsh_types().end() ? nullptr : &*at;
}

}  // namespace

bool is_gmsh_other(int type) {
  return type != gmsh_line && type != gmsh_quad &&
         std::ranges::find(gmsh_second_order, type) == gmsh_second_order.end() && known_gmsh_type(type);
}

void GmshOthersFound::add(int type, std::int64_t tag, Owner entity, std::vector<int> physicals,
                          std::span<const Index> nodes_in_file) {
  const KnownGmshType& known = *known_gmsh_type(type);
  const OtherType of{known.shape, gmsh_type(type)->n_nodes, ""};
  const auto at = std::ranges::find(heads.types, of);
  heads.type.push_back(static_cast<int>(at - heads.types.begin()));
  if (at == heads.types.end()) heads.types.push_back(of);
  heads.ids.push_back(tag);
  entities.push_back(entity);
  groups.push_back(std::move(physicals));
  for (std::size_t i = 0; i < nodes_in_file.size(); ++i)
    nodes.push_back(nodes_in_file[known.order.empty() ? i : static_cast<std::size_t>(known.order[i])]);
  first.push_back(static_cast<Index>(nodes.size()));
}

void GmshOthersFound::finish(Mesh& mesh, const std::function<std::string(int dim, int id)>& group_name,
                             const std::map<int, int>& line_blocks, std::vector<std::string>& notices) {
  if (heads.ids.empty()) return;
  heads.format = "gmsh";
  merge_copies();
  // Tags that are no hex's and no other's.
  std::vector<std::int64_t> taken = sorted_unique(heads.ids);
  bool repeats = taken.size() != heads.ids.size() || (taken.front() < 1);
  for (const std::int64_t id : heads.ids) repeats = repeats || find_hex(mesh, id) >= 0;
  if (repeats) {
    std::int64_t next = std::max(taken.back(), hex_id(mesh, mesh.n_hexes() - 1));
    std::vector<std::int64_t> seen;
    std::int64_t n_new = 0;
    std::map<std::int64_t, bool> used;
    for (std::int64_t& id : heads.ids)
      if (id < 1 || find_hex(mesh, id) >= 0 || !used.emplace(id, true).second) id = ++next, ++n_new;
    notices.push_back(counted(n_new, "element") + " beside the hexes with tags that others have too: tags from " +
                      std::to_string(next - n_new + 1) + " on are theirs here");
  }
  std::map<int, std::vector<Index>> blocks, sides;
  std::vector<std::string> rest(heads.ids.size());
  OtherField entity{"gmsh:entity", 1, {}, true, true};
  for (std::size_t e = 0; e < heads.ids.size(); ++e) {
    entity.values.push_back(entities[e].id);
    const int dim = gmsh_type(gmsh_type_of(heads.types[heads.type[e]].shape,
                                           static_cast<std::size_t>(heads.types[heads.type[e]].n_nodes)))
                        ->dim;
    for (const int id : groups[e]) {
      if (id <= 0) continue;
      if (dim == 3) blocks[id].push_back(static_cast<Index>(e));
      if (dim == 2) sides[id].push_back(static_cast<Index>(e));
      if (const auto block = line_blocks.find(id); dim == 1 && block != line_blocks.end())
        blocks[block->second].push_back(static_cast<Index>(e));
      else if (dim < 2)
        rest[e] += (rest[e].empty() ? "" : " ") + std::to_string(id);
    }
  }
  for (auto& [id, elements] : blocks) {
    Block& block = group_of_id(mesh.blocks, id);
    if (block.name.empty()) block.name = group_name(3, id);
    heads.sets.push_back({id, std::move(elements)});
  }
  for (auto& [id, elements] : sides) {
    SideSet& set = group_of_id(mesh.side_sets, id);
    if (set.name.empty()) set.name = group_name(2, id);
    heads.sides.push_back({id, elements, std::vector<std::string>(elements.size())});
  }
  heads.fields.push_back(std::move(entity));
  if (std::ranges::any_of(rest, [](const std::string& text) { return !text.empty(); })) heads.rest = std::move(rest);
  mesh.others = other_elements(std::move(heads), std::move(first), std::move(nodes));
}

/// Versions 1 and 2 have an element once for each of its groups.
void GmshOthersFound::merge_copies() {
  std::map<std::pair<std::vector<Index>, Owner>, std::size_t> known;
  OtherHeads kept;
  kept.types = heads.types;
  kept.format = heads.format;
  std::vector<Index> kept_first = {0}, kept_nodes;
  std::vector<Owner> kept_entities;
  std::vector<std::vector<int>> kept_groups;
  for (std::size_t e = 0; e < heads.ids.size(); ++e) {
    const std::vector<Index> own(nodes.begin() + first[e], nodes.begin() + first[e + 1]);
    const auto [at, is_new] = known.emplace(std::pair(own, entities[e]), kept.ids.size());
    if (!is_new && groups[e] != kept_groups[at->second] && groups[e].size() == 1) {
      if (std::ranges::find(kept_groups[at->second], groups[e][0]) == kept_groups[at->second].end())
        kept_groups[at->second].push_back(groups[e][0]);
      continue;
    }
    kept.ids.push_back(heads.ids[e]);
    kept.type.push_back(heads.type[e]);
    kept_nodes.insert(kept_nodes.end(), own.begin(), own.end());
    kept_first.push_back(static_cast<Index>(kept_nodes.size()));
    kept_entities.push_back(entities[e]);
    kept_groups.push_back(groups[e]);
  }
  heads = std::move(kept);
  first = std::move(kept_first), nodes = std::move(kept_nodes);
  entities = std::move(kept_entities), groups = std::move(kept_groups);
}

std::vector<int> gmsh_groups_of(const OtherElements& others, Index element) {
  std::vector<int> groups;
  if (others.heads->rest.empty() || others.heads->format != "gmsh") return groups;
  std::string_view text = others.heads->rest[others.of[element]];
  while (!text.empty()) {
    int id = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), id);
    if (error == std::errc{} && id > 0) groups.push_back(id);
    text.remove_prefix(std::min(text.size(), static_cast<std::size_t>(stop - text.data()) + 1));
  }
  return groups;
}

std::vector<GmshOther> gmsh_others(const Mesh& mesh, std::vector<PlannedGroup>& group_names,
                                   std::vector<std::string>& notices) {
  std::vector<GmshOther> result;
  if (!mesh.others) return result;
  const OtherElements& others = *mesh.others;
  const std::vector<std::int64_t> ids =
      other_ids_in_file(mesh, mesh.hex_ids, std::numeric_limits<std::int64_t>::max(), "is too large", notices);
  const OtherField* entity = nullptr;
  for (const OtherField& field : others.heads->fields)
    if (field.name == "gmsh:entity") entity = &field;
  std::map<std::string, std::int64_t> n_lost;
  std::int64_t n_shortened = 0;
  std::vector<int> place(static_cast<std::size_t>(others.size()), -1);
  for (Index e = 0; e < others.size(); ++e) {
    const OtherType& type = others.type_of(e);
    const auto all = others.nodes_of(e);
    const std::size_t n = type.n_nodes > 0 ? static_cast<std::size_t>(type.n_nodes) : all.size();
    const int number = gmsh_type_of(type.shape, n);
    if (number == 0) {
      ++n_lost[type.name];
      continue;
    }
    n_shortened += all.size() > n;
    GmshOther other;
    other.type = number;
    other.dim = gmsh_type(number)->dim;
    other.tag = ids[e];
    if (entity) other.entity = static_cast<int>(entity->values[others.of[e]]);
    const KnownGmshType* known = known_gmsh_type(number);
    other.nodes.resize(n);
    for (std::size_t i = 0; i < n; ++i)
      other.nodes[known && !known->order.empty() ? static_cast<std::size_t>(known->order[i]) : i] = all[i];
    other.physicals = gmsh_groups_of(others, e);
    place[e] = static_cast<int>(result.size());
    result.push_back(std::move(other));
  }
  // Groups of each dimension have numbers of their own.
  std::map<std::pair<int, int>, int> tag_of;  // dimension and block
  const auto tag_for = [&](int dim, const Block& block) {
    if (dim == 3) return group_tag(mesh.blocks, block);
    const auto known = tag_of.find({dim, block.id});
    if (known != tag_of.end()) return known->second;
    int highest = 0;
    bool taken = block.id < 1;
    for (const PlannedGroup& group : group_names)
      if (group.group.dim == dim) {
        highest = std::max(highest, group.group.id);
        taken = taken || group.group.id == block.id;
      }
    const int tag = taken ? highest + 1 : block.id;
    group_names.push_back({{dim, tag}, block.name, true, {}});
    return tag_of[{dim, block.id}] = tag;
  };
  for (const Block& block : mesh.blocks)
    for (const Index e : others_of_block(mesh, block.id))
      if (place[e] >= 0) {
        GmshOther& other = result[place[e]];
        other.physicals.push_back(tag_for(other.dim, block));
      }
  for (const SideSet& set : mesh.side_sets)
    for (const auto& [e, side] : other_sides_of(mesh, set.id)) {
      if (place[e] < 0) continue;
      GmshOther& other = result[place[e]];
      if (other.dim == 2)
        other.physicals.push_back(group_tag(mesh.side_sets, set));
      else
        ++n_lost["sides in '" + set.name + "'"];
    }
  for (GmshOther& other : result) sort_unique(other.physicals);
  for (const auto& [what, n] : n_lost)
    notices.push_back("left out " + counted(n, "other element or side", "other elements or sides") + " (" + what +
                      "), which Gmsh has nothing like");
  if (n_shortened > 0)
    notices.push_back(counted(n_shortened, "other element") +
                      " written without nodes that say how they are turned, which Gmsh has no place for");
  if (!others.heads->format.empty() && others.heads->format != "gmsh")
    notices.push_back(
        "Gmsh has shapes and groups of other elements, not their types and what else is said of them, and "
        "points, and quads and lines on hexes, are nodes, sides and edges when they are read: " +
        others_text(mesh));
  return result;
}

void plan_gmsh_others(const Mesh& mesh, bool split, GmshPlan& plan, std::vector<std::string>& notices) {
  std::vector<GmshOther> others = gmsh_others(mesh, plan.groups, notices);
  if (others.empty()) return;
  std::ranges::stable_sort(others, {}, [](const GmshOther& other) {
    return std::tuple(other.dim, other.entity, other.physicals, other.type, other.tag);
  });
  std::int64_t n_overlapping = 0;
  std::tuple<int, int, std::vector<int>> last{-1, 0, {}};
  int tag = 0;
  for (const GmshOther& other : others) {
    auto& entities = plan.entities[other.dim];
    const std::tuple key(other.dim, other.entity, other.physicals);
    if (key != last) {
      const auto at = std::ranges::lower_bound(entities, other.entity, {}, &PlannedEntity::tag);
      const bool is_free = other.entity > 0 && (at == entities.end() || at->tag != other.entity);
      const int next = entities.empty() ? 1 : entities.back().tag + 1;
      tag = is_free ? other.entity : next;
      const Owner parent = other.entity > 0 ? Owner{other.dim, other.entity} : Owner{};
      if (is_free)
        entities.insert(at, PlannedEntity{tag, false, {}, {}, {}, {}});
      else
        entities.push_back({tag, true, parent, {}, {}, {}});
      if (split) plan.entity(other.dim, tag).physicals = other.physicals;
      last = key;
    }
    n_overlapping += !split && other.physicals.size() > 1;
    const bool goes_on = !plan.others.empty() && plan.others.back().dim == other.dim &&
                         plan.others.back().entity == tag && plan.others.back().type == other.type;
    if (!goes_on)
      plan.others.push_back(
          {other.dim, tag, other.type, other.physicals.empty() ? 0 : other.physicals.front(), {}, {}});
    plan.others.back().tags.push_back(other.tag);
    plan.others.back().nodes.insert(plan.others.back().nodes.end(), other.nodes.begin(), other.nodes.end());
    for (const Index n : other.nodes) plan.entity(other.dim, tag).box.add(mesh.points[n]);
  }
  if (n_overlapping > 0)
    notices.push_back(counted(n_overlapping, "other element") +
                      " of several groups: version 2.2 says one group of each element, the first");
}

}  // namespace hextwist::io
