#include "hextwist/io/gmsh/plan_internal.h"

#include <limits>
#include <map>
#include <set>
#include <utility>

#include "hextwist/base/large_array.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/others.h"

namespace hextwist::io {
namespace {

constexpr std::array<int, 4> n_element_nodes = {1, 2, 4, 8};

/// Makes the plan in the order of dimensions 3, 2, 1, 0.
class Planner {
 public:
  Planner(const Mesh& mesh, const Association& association, bool split, const Model* model, const FileExtras* extras,
          Index n_corners)
      : mesh_(mesh),
        tags_(association),
        split_(split),
        extras_(extras),
        n_corners_(n_corners),
        directions_(curve_directions(mesh, association, model)) {}

  GmshPlan result() {
    reserve_owned_entities();
    hexes();
    sides();
    lines();
    points();
    nodes();
    number_elements();
    extra_members();
    boxes();
    boundaries();
    for (auto& entities : plan_.entities)
      for (PlannedEntity& entity : entities) sort_unique(entity.physicals);
    return std::move(plan_);
  }

 private:
  /// Entities that own something, and the first tag above them for those that are made here.
  void reserve_owned_entities() {
    std::array<std::set<int>, 4> used;
    Owner last;
    for (const Owner owner : tags_.node_owner) {
      if (owner != last && owner) used[owner.dim].insert(owner.id);
      last = owner;
    }
    int last_volume = 0;
    for (const int volume : tags_.hex_volume) {
      if (volume != last_volume && volume > 0) used[3].insert(volume);
      last_volume = volume;
    }
    used[2].insert(tags_.face_surface.begin(), tags_.face_surface.end());
    used[1].insert(tags_.edge_curve.begin(), tags_.edge_curve.end());
    for (int dim = 0; dim < 4; ++dim) {
      for (const int tag : used[dim]) plan_.entities[dim].push_back({tag, false, {}, {}, {}, {}});
      next_tag_[dim] = used[dim].empty() ? 1 : *used[dim].rbegin() + 1;
    }
  }
  int new_entity(int dim, Owner parent) {
    plan_.entities[dim].push_back({next_tag_[dim], true, parent, {}, {}, {}});
    return next_tag_[dim]++;
  }

  /// Entities for classes of items, and their elements; `append` adds the nodes of an item (not for hexes).
  template <class F>
  void add_classes(int dim, Classes classes, std::span<const int> group_ids, F&& append) {
    std::vector<int> tag(classes.key.size());
    std::set<int> taken;
    for (std::size_t c = 0; c < tag.size(); ++c) {
      const int key = classes.key[c];
      const bool own = key > 0 && (taken.insert(key).second || !split_);
      tag[c] = own ? key : new_entity(dim, key > 0 ? Owner{dim, key} : Owner{});
      for (const int g : classes.groups[c]) plan_.entity(dim, tag[c]).physicals.push_back(group_ids[g]);
    }
    // Items by entity; counting sort keeps their order.
    std::vector<int> order(tag.size());
    for (std::size_t c = 0; c < order.size(); ++c) order[c] = static_cast<int>(c);
    std::ranges::stable_sort(order, {}, [&](int c) { return tag[c]; });
    PlannedElements& elements = plan_.elements[dim];
    std::vector<std::size_t> start(tag.size());
    for (const int c : order) {
      const auto n = static_cast<std::size_t>(classes.count[c]);
      elements.runs.push_back(
          {tag[c], classes.groups[c].empty() ? 0 : group_ids[classes.groups[c][0]], elements.size, n});
      start[c] = elements.size;
      elements.size += n;
    }
    if (tag.size() > 1) {
      resize_for_overwrite(elements.items, elements.size);
      for (std::size_t i = 0; i < elements.size; ++i)
        elements.items[start[classes.of_item[i]]++] = static_cast<Index>(i);
    }
    if (dim < 3) {
      elements.nodes.reserve(elements.size * n_element_nodes[dim]);
      for (std::size_t k = 0; k < elements.size; ++k) append(elements.item(k), elements.nodes);
    }
    groups_of_item_[dim] = std::move(classes);
  }

  template <class Group, class Members>
  void add_group_names(int dim, const std::vector<Group>& groups, Members Group::*members) {
    for (const Group& group : groups)
      plan_.groups.push_back({{dim, group_tag(groups, group)}, group.name, (group.*members).empty(), {}});
  }

  void hexes() {
    std::vector<int> volume;
    resize_for_overwrite(volume, mesh_.hexes.size());
    for (Index h = 0; h < mesh_.n_hexes(); ++h) volume[h] = std::max(0, volume_of(tags_, h));
    std::vector<std::span<const Index>> members;
    for (const Block& block : mesh_.blocks) {
      members.push_back(block.hexes);
      group_ids_[3].push_back(group_tag(mesh_.blocks, block));
    }
    add_group_names(3, mesh_.blocks, &Block::hexes);
    add_classes(3, classify(volume, members), group_ids_[3], [](Index, std::vector<Index>&) {});
  }

  void sides() {
    sides_ = plan_sides(mesh_, tags_);
    for (const SideSet& set : mesh_.side_sets) group_ids_[2].push_back(group_tag(mesh_.side_sets, set));
    add_group_names(2, mesh_.side_sets, &SideSet::sides);
    const std::vector<std::span<const Index>> spans(sides_.members.begin(), sides_.members.end());
    add_classes(2, classify(sides_.surface, spans), group_ids_[2], [&](Index i, std::vector<Index>& nodes) {
      const Quad cycle = face_node_cycle(mesh_.hexes[sides_.sides[i].hex], sides_.sides[i].face);
      nodes.insert(nodes.end(), cycle.begin(), cycle.end());
    });
  }

  void lines() {
    lines_ = plan_lines(mesh_, tags_, extras_, n_corners_);
    std::vector<std::span<const Index>> members;
    for (std::size_t s = 0; s < lines_.is_group.size(); ++s)
      if (lines_.is_group[s]) {
        members.push_back(lines_.members[s]);
        group_ids_[1].push_back(lines_.tag[s]);
      }
    add_classes(1, classify(lines_.curve, members), group_ids_[1], [&](Index i, std::vector<Index>& nodes) {
      const int first = static_cast<std::size_t>(i) < directions_.reversed.size() && directions_.reversed[i];
      for (const int k : {0, 1}) nodes.push_back(lines_.edges[i][k ^ first]);
    });
  }

  /// Points: nodes on vertices, and the nodes of all other node sets.
  void points() {
    std::vector<std::pair<Index, int>> all;
    for (std::size_t n = 0; n < tags_.node_owner.size(); ++n)
      if (tags_.node_owner[n].dim == 0) all.emplace_back(static_cast<Index>(n), tags_.node_owner[n].id);
    for (std::size_t s = 0; s < mesh_.node_sets.size(); ++s)
      for (const Index n : mesh_.node_sets[s].nodes)
        if (!lines_.is_group[s]) all.emplace_back(n, owner(tags_, n).dim == 0 ? owner(tags_, n).id : 0);
    sort_unique(all);
    std::vector<int> vertex;
    std::vector<Index> items;
    for (const auto& [n, id] : all) {
      items.push_back(n);
      vertex.push_back(id);
    }
    std::vector<std::vector<Index>> members;
    for (std::size_t s = 0; s < mesh_.node_sets.size(); ++s) {
      const NodeSet& set = mesh_.node_sets[s];
      plan_.groups.push_back({{lines_.is_group[s], lines_.tag[s]}, set.name, set.nodes.empty(), {}});
      if (lines_.is_group[s]) continue;
      auto& to = members.emplace_back();
      for (const Index n : set.nodes) to.push_back(position_in(items, n));
      group_ids_[0].push_back(lines_.tag[s]);
    }
    const std::vector<std::span<const Index>> spans(members.begin(), members.end());
    add_classes(0, classify(vertex, spans), group_ids_[0],
                [&](Index i, std::vector<Index>& nodes) { nodes.push_back(items[i]); });
  }

  void nodes() {
    const bool all_owned = !tags_.node_owner.empty() &&
                           std::ranges::all_of(tags_.node_owner, [](Owner owner) { return static_cast<bool>(owner); });
    if (all_owned || mesh_.points.empty()) return;
    for (const PlannedEntity& volume : plan_.entities[3])
      if (volume.is_part && !volume.parent) plan_.nobody = volume.tag;
    if (plan_.nobody == 0) plan_.nobody = new_entity(3, {});
  }

  /// Hexes have their own ids; everything else is counted after them.
  void number_elements() {
    std::int64_t next = highest_element_id(mesh_) + 1 + n_others(mesh_);
    for (int dim = 0; dim < 3; ++dim) {
      plan_.elements[dim].first_tag = next;
      next += static_cast<std::int64_t>(plan_.elements[dim].size);
    }
  }

  /// Without splitting, entities are in no group; each element names its first group, these are the rest.
  void extra_members() {
    if (split_) return;
    for (PlannedGroup& group : plan_.groups) {
      const int dim = group.group.dim;
      const auto& ids = group_ids_[dim];
      const Classes& classes = groups_of_item_[dim];
      const int g = static_cast<int>(std::ranges::find(ids, group.group.id) - ids.begin());
      std::vector<char> extra(classes.key.size(), 0);
      for (std::size_t c = 0; c < extra.size(); ++c)
        extra[c] = !classes.groups[c].empty() && classes.groups[c][0] != g &&
                   std::ranges::find(classes.groups[c], g) != classes.groups[c].end();
      if (std::ranges::find(extra, 1) == extra.end()) continue;
      const PlannedElements& elements = plan_.elements[dim];
      for (std::size_t k = 0; k < elements.size; ++k)
        if (extra[classes.of_item[elements.item(k)]]) group.more.push_back(plan_.tag(mesh_, dim, k));
    }
  }

  void boxes() {
    for (int dim = 0; dim < 3; ++dim)
      for (const auto& run : plan_.elements[dim].runs) {
        Box& box = plan_.entity(dim, run.entity).box;
        const auto n = static_cast<std::size_t>(n_element_nodes[dim]);
        for (const Index node : std::span(plan_.elements[dim].nodes).subspan(n * run.first, n * run.n))
          box.add(mesh_.points[node]);
      }
    std::vector<int> seen(mesh_.points.size(), 0);  // by which entity's hexes
    for (const auto& run : plan_.elements[3].runs) {
      Box& box = plan_.entity(3, run.entity).box;
      for (std::size_t k = run.first; k < run.first + run.n; ++k)
        for (const Index node : mesh_.hexes[plan_.elements[3].item(k)])
          if (std::exchange(seen[node], run.entity) != run.entity) box.add(mesh_.points[node]);
    }
    for (std::size_t i = 0; i < tags_.node_owner.size(); ++i)
      if (const Owner owner = tags_.node_owner[i]; owner && owner.dim < 3)
        plan_.entity(owner.dim, owner.id).box.add(mesh_.points[i]);
  }

  template <class Owned, class Bounds>
  void bounds_of_volumes_and_surfaces(Owned&& owned, Bounds&& bounds) {
    const auto& volumes = plan_.elements[3];
    std::vector<int> volume_of_hex(mesh_.hexes.size());
    for (const auto& run : volumes.runs)
      for (std::size_t k = run.first; k < run.first + run.n; ++k) volume_of_hex[volumes.item(k)] = run.entity;
    const auto& quads = plan_.elements[2];
    std::vector<Quad> behind(quads.size);
    for (std::size_t k = 0; k < behind.size(); ++k)
      for (int c = 0; c < 4; ++c) behind[k][c] = quads.nodes[4 * k + 3 - c];
    const auto other = oriented_sides(mesh_, behind);
    SurfaceLoops loops(tags_, directions_);
    for (const auto& run : quads.runs) {
      if (!owned(2, run.entity)) continue;
      for (std::size_t k = run.first; k < run.first + run.n; ++k) {
        const Side side = sides_.sides[quads.item(k)];
        const int front = volume_of_hex[side.hex], back = volume_of_hex[other[k].hex];
        if (owned(3, front) && (front != back || other[k] == side)) bounds(3, front, run.entity);
        if (owned(3, back) && front != back) bounds(3, back, run.entity);
        loops.add(run.entity, Quad{behind[k][3], behind[k][2], behind[k][1], behind[k][0]});
      }
    }
    for (PlannedEntity& surface : plan_.entities[2]) surface.boundary = loops.of(surface.tag);
  }
  /// Which entities bound which, as far as the elements show it; owned entities only.
  void boundaries() {
    const auto owned = [&](int dim, int tag) {
      const PlannedEntity& entity = plan_.entity(dim, tag);
      return !entity.is_part || entity.parent;
    };
    const auto bounds = [&](int dim, int tag, int boundary) {
      auto& list = plan_.entity(dim, tag).boundary;
      if (std::ranges::find(list, boundary) == list.end()) list.push_back(boundary);
    };
    if (plan_.elements[2].size > 0) bounds_of_volumes_and_surfaces(owned, bounds);
    for (std::size_t i = 0; i < tags_.curve_edges.size(); ++i)
      for (const Index n : tags_.curve_edges[i])
        if (const Owner vertex = owner(tags_, n); vertex.dim == 0) bounds(1, tags_.edge_curve[i], vertex.id);
    for (const int dim : {1, 3})
      for (PlannedEntity& entity : plan_.entities[dim]) sort_unique(entity.boundary);
    for (PlannedEntity& curve : plan_.entities[1]) {
      // From one vertex to another, or back to the same.
      if (curve.boundary.size() == 1) curve.boundary.push_back(curve.boundary[0]);
      if (curve.boundary.size() > 2) curve.boundary.clear();
      if (curve.boundary.size() == 2) curve.boundary[1] = -curve.boundary[1];
      if (const auto ends = directions_.ends.find(curve.tag); ends != directions_.ends.end())
        curve.boundary = {ends->second[0], -ends->second[1]};
    }
  }

  const Mesh& mesh_;
  const Association& tags_;
  const bool split_;
  const FileExtras* const extras_;
  const Index n_corners_;
  const CurveDirections directions_;
  GmshPlan plan_;
  std::array<int, 4> next_tag_ = {1, 1, 1, 1};
  std::array<std::vector<int>, 4> group_ids_;
  std::array<Classes, 4> groups_of_item_;
  PlannedSides sides_;
  PlannedLines lines_;
};

}  // namespace

PlannedEntity& GmshPlan::entity(int dim, int tag) {
  return *std::ranges::lower_bound(entities[dim], tag, {}, &PlannedEntity::tag);
}

std::size_t GmshPlan::n_elements() const {
  std::size_t n = 0;
  for (const auto& of_dim : elements) n += of_dim.size;
  for (const PlannedOthers& of_entity : others) n += of_entity.tags.size();
  return n;
}

int GmshPlan::file_tag(int tag) const {
  if (n_parts == 0) return tag;
  constexpr std::int64_t above_whole_entities = std::int64_t{1} << 24;
  const std::int64_t result = above_whole_entities + std::int64_t{tag} * n_parts + part;
  if (tag >= above_whole_entities || result > std::numeric_limits<std::int32_t>::max())
    throw Error("entity " + std::to_string(tag) + " in " + std::to_string(n_parts) +
                " parts: Gmsh has no number for it");
  return static_cast<int>(result);
}

void take_part(GmshPlan& plan, const FilePart& part) {
  plan.n_parts = part.n_parts;
  plan.part = part.number;
  // Beside the hexes: numbers that no other part can have, as a hex has 6 faces, 12 edges and 8 corners.
  constexpr std::int64_t most_beside_hex = 26;
  std::int64_t next = part.highest_id + 1 + part.number * most_beside_hex * part.n_hexes;
  for (int dim = 0; dim < 3; ++dim) {
    plan.elements[dim].first_tag = next;
    next += static_cast<std::int64_t>(plan.elements[dim].size);
  }
}

GmshPlan plan_gmsh(const Mesh& mesh, const Association& association, bool split, const Model* model,
                   const FileExtras* extras, Index n_corners) {
  return Planner(mesh, association, split, model, extras, n_corners).result();
}

}  // namespace hextwist::io
