// What a Gmsh file says becomes a mesh: hexes, blocks, side sets, node sets, owners, fields.
//
// Physical groups of dimension 3 are blocks, of dimension 2 side sets, of dimension 1 and 0 node sets (those of
// dimension 1 whose id is taken get the next free one). Tags of quads, lines and points are not kept, so they may
// repeat (deal.II gives all lines the same).
#include <limits>
#include <map>
#include <utility>

#include "hextwist/base/large_array.h"
#include "hextwist/base/sorted.h"
#include "hextwist/io/gmsh/gmsh.h"
#include "hextwist/io/gmsh/others.h"
#include "hextwist/io/gmsh/slice_internal.h"
#include "hextwist/mesh/corners.h"

namespace hextwist::io {
namespace {

/// One element can be in the file once per physical group (versions 1 and 2): for each element the first with the same
/// nodes and entity, in order of tags. Empty when no element repeats another.
std::vector<Index> first_copies(const GmshElements& elements, std::span<const Hex> hexes) {
  const auto n = elements.tags.size();
  if (elements.physical.empty() || n < 2) return {};
  std::vector<Index> order(n);
  for (std::size_t i = 0; i < n; ++i) order[i] = static_cast<Index>(i);
  const auto compare = [&](Index a, Index b) { return hexes[a] <=> hexes[b]; };
  std::ranges::sort(order, [&](Index a, Index b) {
    const auto c = compare(a, b);
    return c != 0 ? c < 0 : elements.tags[a] < elements.tags[b];
  });
  std::vector<Index> first(n);
  bool any = false;
  for (std::size_t i = 0; i < n; ++i) {
    first[order[i]] = order[i];
    if (i == 0 || compare(order[i - 1], order[i]) != 0) continue;
    const Index original = first[order[i - 1]];
    if (elements.entity[original] != elements.entity[order[i]]) continue;
    if (elements.physical[original] == elements.physical[order[i]]) continue;
    first[order[i]] = original;
    any = true;
  }
  return any ? first : std::vector<Index>{};
}

class GmshAssembly {
 public:
  GmshAssembly(GmshContents&& contents, const Cursor& cursor) : in_(std::move(contents)), cursor_(cursor) {}

  MeshFile result() {
    nodes();
    hexes();
    blocks();
    quads();
    lines_and_points();
    others();
    fields();
    for (const auto& [name, n] : in_.n_dropped)
      notice("dropped " + std::to_string(n) + " elements of type " + name + ", which have no place here");
    if (in_.n_ghosts > 0) notice("left out " + counted(in_.n_ghosts, "element") + " of other partitions (ghosts)");
    if (in_.has_groups_between)
      notice("what lies between partitions is in no group here; in the file it is in those of what was divided");
    tidy(file_.tags);
    file_.extras.periodic = std::move(in_.periodic);
    if (in_.middles.any()) take_middles(file_, in_.middles);
    return std::move(file_);
  }

 private:
  void notice(const std::string& text) { file_.notices.push_back(text); }

  /// Physical groups that element i of a dimension is in, by its entity or its own tag.
  template <class F>
  void each_group(int dim, std::size_t i, F&& f) const {
    const GmshElements& elements = in_.elements[dim];
    if (!elements.physical.empty()) {
      if (elements.physical[i] != 0) f(elements.physical[i]);  // 0: none
      return;
    }
    const auto found = in_.entity_physicals.find({dim, elements.entity[i]});
    if (found == in_.entity_physicals.end()) return;
    for (const int id : found->second) f(id);
  }
  std::string group_name(int dim, int id) const {
    const auto found = in_.physical_names.find({dim, id});
    return found == in_.physical_names.end() ? "" : found->second;
  }
  /// Members of all groups of a dimension, including those that have a name only. `member` maps an element to one.
  template <class Member, class F>
  std::map<int, std::vector<Member>> members(int dim, F&& member) {
    std::map<int, std::vector<Member>> groups;
    for (const auto& [group, name] : in_.physical_names)
      if (group.dim == dim && group.id > 0) groups[group.id];
    if (in_.slice)
      for (const Owner group : in_.slice->whole.groups)
        if (group.dim == dim) groups[group.id];
    const auto& elements = in_.elements[dim];
    const auto& key = elements.physical.empty() ? elements.entity : elements.physical;
    for (std::size_t i = 0, end = 0; i < key.size(); i = end) {
      while (end < key.size() && key[end] == key[i]) ++end;
      each_group(dim, i, [&](int id) {
        grow_large(groups[id], end - i);
        for (std::size_t k = i; k < end; ++k) member(k, groups[id]);
      });
    }
    for (const auto& [group, tags] : in_.more_members) {
      if (group.dim != dim || group.id <= 0) continue;
      auto& to = groups[group.id];
      for (const std::int64_t tag : tags)
        if (const auto i = element_of_tag(dim, tag); i >= 0) member(static_cast<std::size_t>(i), to);
    }
    for (auto& [id, items] : groups) sort_unique(items);
    if (const auto zero = groups.find(0); zero != groups.end()) {
      // Ids are positive here.
      const int id = groups.rbegin()->first < std::numeric_limits<int>::max() ? groups.rbegin()->first + 1 : 0;
      if (id < 1) cursor_.fail("physical group 0 of dimension " + std::to_string(dim) + ": there is no id left for it");
      notice("physical group 0 of dimension " + std::to_string(dim) + " is " + std::to_string(id) + " here");
      in_.physical_names[{dim, id}] = group_name(dim, 0);
      auto items = std::move(zero->second);
      groups.erase(zero);
      groups[id] = std::move(items);
    }
    return groups;
  }
  /// Position in the file's order.
  std::int64_t element_of_tag(int dim, std::int64_t tag) const {
    if (tag_order_[dim].empty() && !in_.elements[dim].tags.empty()) {
      for (std::size_t i = 0; i < in_.elements[dim].tags.size(); ++i)
        tag_order_[dim].emplace_back(in_.elements[dim].tags[i], static_cast<Index>(i));
      std::ranges::sort(tag_order_[dim]);
    }
    const auto at = std::ranges::lower_bound(tag_order_[dim], std::pair(tag, Index{0}));
    return at != tag_order_[dim].end() && at->first == tag ? at->second : -1;
  }

  void nodes() {
    file_.mesh.points = std::move(in_.points);
    file_.mesh.node_ids = in_.nodes.stored();
    owned_by_entities_ = !in_.node_entity.empty();
    Owner last, owner;
    for (Owner& of_node : in_.node_entity) {
      if (of_node != last) owner = in_.owner(of_node);
      last = std::exchange(of_node, owner);
    }
    file_.tags.node_owner = std::move(in_.node_entity);
    file_.tags.node_owner.resize(file_.mesh.points.size());
    file_.tags.node_parameters = std::move(in_.node_parameters);
    resize_large(file_.tags.node_parameters, file_.mesh.points.size());
  }

  void hexes() {
    GmshElements& elements = in_.elements[3];
    if (elements.tags.empty()) cursor_.fail_at(cursor_.end, "there is no hex in the file" + only_others());
    // Drop repetitions, remembering to which hex they go.
    const auto first = first_copies(elements, in_.hexes);
    std::vector<std::int64_t> tags;
    std::vector<Run> runs;
    std::vector<Index> kept;
    if (first.empty()) {
      tags = elements.tags;
      runs = elements.runs;
    } else {
      for (std::size_t i = 0; i < first.size(); ++i)
        if (first[i] == static_cast<Index>(i)) {
          tags.push_back(elements.tags[i]);
          kept.push_back(static_cast<Index>(i));
        }
    }
    hex_ids_ = Ids(std::move(tags), "element", cursor_, runs);
    const auto n = static_cast<std::size_t>(hex_ids_.size());
    resize_large(hex_of_element_, elements.tags.size());
    resize_for_overwrite(file_.tags.hex_volume, n);
    int last = -1, volume = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t i = first.empty() ? k : static_cast<std::size_t>(kept[k]);
      const Index h = hex_ids_.place().empty() ? static_cast<Index>(k) : hex_ids_.place()[k];
      hex_of_element_[i] = h;
      if (elements.entity[i] != last) {
        const Owner owner = in_.owner({3, elements.entity[i]});
        volume = owner.dim == 3 ? owner.id : 0;
        last = elements.entity[i];
      }
      file_.tags.hex_volume[h] = volume;
    }
    for (std::size_t i = 0; i < first.size(); ++i) hex_of_element_[i] = hex_of_element_[first[i]];
    derive_node_owners(3);
    in_.middles.finish(in_.hexes.size());
    std::size_t n_kept = 0;
    for (const Index i : kept) in_.hexes[n_kept++] = in_.hexes[i];
    if (!first.empty()) in_.hexes.resize(n);
    hex_ids_.sort(in_.hexes);
    if (in_.middles.any()) {
      if (!first.empty()) in_.middles.nodes = items_at(in_.middles.nodes, kept, FoundMiddles::width);
      hex_ids_.sort(in_.middles.nodes, FoundMiddles::width);
    }
    file_.mesh.hexes = std::move(in_.hexes);
    file_.mesh.hex_ids = hex_ids_.stored();
  }

  void derive_node_owners(int dim) {
    if (owned_by_entities_) return;
    std::vector<int> ids;
    for (const int entity : in_.elements[dim].entity) {
      const Owner owner = in_.owner({dim, entity});
      ids.push_back(owner.dim == dim ? owner.id : 0);
    }
    derive_owners(file_.tags.node_owner, dim, in_.nodes_of(dim), ids);
  }

  void blocks() {
    for (auto& [id, hexes] :
         members<Index>(3, [&](std::size_t i, std::vector<Index>&group) { group.push_back(hex_of_element_[i]); }))
      file_.mesh.blocks.push_back({id, group_name(3, id), std::move(hexes)});
  }

  void quads() {
    const GmshElements& elements = in_.elements[2];
    std::vector<Quad> cycles(elements.tags.size());
    for (std::size_t i = 0; i < cycles.size(); ++i)
      for (int k = 0; k < 4; ++k) cycles[i][k] = elements.nodes[4 * i + k];
    std::vector<Side> lower;
    auto sides = oriented_sides(file_.mesh, cycles, &lower);
    if (in_.slice) leave_out_sides_elsewhere(cycles, sides);
    for (std::size_t i = 0; i < sides.size(); ++i)
      if (sides[i].hex < 0) beside(2, i);
    for (auto& [id, set] : members<Side>(2, [&](std::size_t i, std::vector<Side>&group) {
           if (sides[i].hex >= 0) group.push_back(sides[i]);
         }))
      file_.mesh.side_sets.push_back({id, group_name(2, id), std::move(set)});
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const Owner owner = in_.owner({2, elements.entity[i]});
      if (sides[i].hex < 0 || owner.dim != 2) continue;
      file_.tags.surface_faces.push_back(lower[i]);
      file_.tags.face_surface.push_back(owner.id);
    }
    derive_node_owners(2);
  }

  /// A quad between two hexes is a side of the one it turns outwards from, which may be in another slice.
  void leave_out_sides_elsewhere(std::span<const Quad> cycles, std::span<Side> sides) const {
    for (std::size_t i = 0; i < sides.size(); ++i) {
      if (sides[i].hex < 0) continue;
      std::array<std::int64_t, 4> ids{};
      for (std::size_t k = 0; k < ids.size(); ++k) ids[k] = node_id(file_.mesh, cycles[i][k]);
      const Quad outward = face_node_cycle(file_.mesh.hexes[sides[i].hex], sides[i].face);
      if (!turn_the_same_way(cycles[i], outward) &&
          std::ranges::binary_search(in_.slice->whole.inner_quads, nodes_key(ids)))
        sides[i] = {};
    }
  }

  void lines_and_points() {
    const GmshElements& lines = in_.elements[1];
    std::vector<Edge> edges;
    for (std::size_t i = 0; i < lines.tags.size(); ++i)
      edges.push_back(
          {std::min(lines.nodes[2 * i], lines.nodes[2 * i + 1]), std::max(lines.nodes[2 * i], lines.nodes[2 * i + 1])});
    const auto good = are_edges(file_.mesh, edges);
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const Owner owner = in_.owner({1, lines.entity[i]});
      if (!good[i]) {
        beside(1, i);
      } else if (owner.dim == 1) {
        file_.tags.curve_edges.push_back(edges[i]);
        file_.tags.edge_curve.push_back(owner.id);
      }
    }
    derive_node_owners(1);
    derive_node_owners(0);
    std::array<std::map<int, std::vector<Index>>, 2> groups;
    groups[0] =
        members<Index>(0, [&](std::size_t i, std::vector<Index>& group) { group.push_back(in_.elements[0].nodes[i]); });
    const auto lines_of =
        members<std::size_t>(1, [](std::size_t i, std::vector<std::size_t>& group) { group.push_back(i); });
    for (const auto& [id, of_group] : lines_of) {
      std::vector<Index>& nodes = groups[1][id];
      for (const std::size_t i : of_group) {
        nodes.insert(nodes.end(), {lines.nodes[2 * i], lines.nodes[2 * i + 1]});
        if (in_.middles.any() && i < in_.line_middles.size() && in_.line_middles[i] >= 0)
          nodes.push_back(in_.line_middles[i]);
      }
      sort_unique(nodes);
    }
    if (!in_.slice) find_line_blocks(lines_of, good);

    auto& sets = file_.mesh.node_sets;
    for (const int dim : {0, 1})
      for (auto& [id, nodes] : groups[dim]) {
        if (dim == 1 && line_blocks_.contains(id)) continue;
        const bool taken = std::ranges::find(sets, id, &NodeSet::id) != sets.end();
        NodeSet& set = group_of_id(sets, taken ? free_id(sets) : id);
        set.name = group_name(dim, id);
        set.nodes = std::move(nodes);
        if (dim == 1) file_.extras.curve_groups[set.id] = id;
        if (taken)
          notice("physical curve group " + std::to_string(id) + " is node set " + std::to_string(set.id) +
                 ": a physical point group has its id");
      }
  }

  /// A block of lines is written as a group of these, and as one of dimension 3 that has nothing and the same name.
  void find_line_blocks(const std::map<int, std::vector<std::size_t>>& lines, const std::vector<char>& is_edge) {
    for (const auto& [id, of_group] : lines) {
      if (of_group.empty() || std::ranges::any_of(of_group, [&](std::size_t i) { return is_edge[i] != 0; })) continue;
      const std::string name = group_name(1, id);
      const auto block = std::ranges::find_if(file_.mesh.blocks, [&, id = id](const Block& b) {
        return b.hexes.empty() && b.name == name && (!name.empty() || b.id == id);
      });
      if (block != file_.mesh.blocks.end()) line_blocks_[id] = block->id;
    }
  }

  std::vector<int> groups_of(int dim, int list, std::size_t i) const {
    const GmshElements& elements = in_.elements[list];
    if (!elements.physical.empty()) return {elements.physical[i]};
    const auto found = in_.entity_physicals.find({dim, elements.entity[i]});
    return found == in_.entity_physicals.end() ? std::vector<int>() : found->second;
  }
  /// A line or quad that lies on no hex. Of second order only its corners are known.
  void beside(int dim, std::size_t i) {
    if (in_.slice) return;  // it is on a hex of another one
    const GmshElements& elements = in_.elements[dim];
    if (in_.middles.any()) {
      ++n_bent_[dim];
      return;
    }
    const auto n = static_cast<std::size_t>(gmsh_corners[dim]);
    others_.add(gmsh_kept[dim], elements.tags[i], in_.owner({dim, elements.entity[i]}), groups_of(dim, dim, i),
                std::span(elements.nodes).subspan(n * i, n));
  }
  void others() {
    const GmshElements& elements = in_.elements[gmsh_beside];
    for (std::size_t i = 0; i < elements.tags.size(); ++i) {
      const int dim = gmsh_type(in_.other_types[i])->dim;
      others_.add(in_.other_types[i], elements.tags[i], in_.owner({dim, elements.entity[i]}),
                  groups_of(dim, gmsh_beside, i),
                  std::span(elements.nodes)
                      .subspan(static_cast<std::size_t>(in_.other_first[i]),
                               static_cast<std::size_t>(in_.other_first[i + 1] - in_.other_first[i])));
    }
    for (const auto& [dim, what] : {std::pair(1, "line"), {2, "quad"}})
      if (n_bent_[dim] > 0)
        notice("dropped " + counted(n_bent_[dim], what) + (n_bent_[dim] == 1 ? " that is no " : " that are no ") +
               (dim == 1 ? "edge" : "side") + " of a hex");
    others_.finish(
        file_.mesh, [this](int dim, int id) { return group_name(dim, id); }, line_blocks_, file_.notices);
  }
  std::string only_others() const {
    std::map<std::string, std::int64_t> n;
    for (const int type : in_.other_types) ++n[gmsh_type(type)->name];
    std::string text;
    for (const auto& [name, count] : n) text += (text.empty() ? ", but " : ", ") + std::to_string(count) + " " + name;
    return text;
  }

  void fields() {
    // The last step of each field.
    std::vector<const GmshData*> last;
    std::map<const GmshData*, int> n_steps;
    for (const GmshData& data : in_.data) {
      const auto same = std::ranges::find_if(last, [&](const GmshData* other) {
        return other->field.name == data.field.name && other->field.on == data.field.on;
      });
      if (same == last.end()) {
        n_steps[last.emplace_back(&data)] = 1;
        continue;
      }
      const int n = n_steps[*same] + 1;
      if (data.step >= (*same)->step) *same = &data;
      n_steps[*same] = n;
    }
    if (!in_.of_corners.empty())
      notice("left out $ElementNodeData, values per element and node, of " +
             counted(std::ssize(in_.of_corners), "field") + ", '" + in_.of_corners[0] + "'" +
             (in_.of_corners.size() > 1 ? " the first" : ""));
    std::vector<Field> fields;
    for (const GmshData* data : last) {
      Field field{data->field.name, data->field.on, data->field.components, {}};
      const bool node = field.on == Field::On::node;
      const std::size_t n = node ? file_.mesh.points.size() : file_.mesh.hexes.size();
      const auto width = static_cast<std::size_t>(field.components);
      field.values.assign(n * width, std::numeric_limits<double>::quiet_NaN());
      std::int64_t found = 0;
      for (std::size_t i = 0; i < data->tags.size(); ++i) {
        const Index at = node ? in_.nodes.find(data->tags[i]) : hex_ids_.find(data->tags[i]);
        if (at < 0) continue;
        ++found;
        for (std::size_t c = 0; c < width; ++c) field.values[at * width + c] = data->field.values[i * width + c];
      }
      if (n_steps[data] > 1)
        notice("field '" + field.name + "' has " + std::to_string(n_steps[data]) + " steps: the last is read");
      if (const auto n_lost = static_cast<std::int64_t>(data->tags.size()) - found; found && n_lost > 0 && !in_.slice)
        notice("field '" + field.name + "': " + counted(n_lost, "value") + " left out, which " +
               (n_lost == 1 ? "is" : "are") + " not of a " + (node ? "node" : "hex"));
      if (found || in_.slice)
        fields.push_back(std::move(field));
      else
        notice("dropped field '" + field.name + "', which has no value on a " + (node ? "node" : "hex"));
    }
    file_.mesh.fields = merge_components(std::move(fields));
  }

  GmshContents in_;
  const Cursor& cursor_;
  MeshFile file_;
  GmshOthersFound others_;
  std::map<int, int> line_blocks_;                  // by physical group of lines
  std::array<std::int64_t, 3> n_bent_ = {0, 0, 0};  // per dimension: of second order, on no hex
  Ids hex_ids_;
  bool owned_by_entities_ = false;     // nodes; else by the elements around them
  std::vector<Index> hex_of_element_;  // file order
  mutable std::array<std::vector<std::pair<std::int64_t, Index>>, 4> tag_order_;
};

}  // namespace

MeshFile assemble_gmsh(GmshContents&& contents, const Cursor& cursor) {
  return GmshAssembly(std::move(contents), cursor).result();
}

}  // namespace hextwist::io
