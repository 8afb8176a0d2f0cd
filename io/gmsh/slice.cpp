// .msh in slices, in walks over the file: one for what is below hexes, one that finds the hexes it lies on, and for
// each slice one for the nodes of its hexes and one for all that they need.
#include "hextwist/io/gmsh/slice_internal.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "hextwist/base/mixed.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/corners.h"

namespace hextwist::io {
namespace {

using GmshWalk = GmshSlice::Walk;

bool has_bit(const GmshSlice& slice, std::int64_t id) {
  return id >= 1 && id <= slice.highest_id;
}
bool has_id(const GmshSlice& slice, const RankedBits& bits, std::int64_t id) {
  return has_bit(slice, id) && bits.has_any(static_cast<Index>(id));
}

/// Elements of all versions, in one of the walks.
class SlicedElements {
 public:
  SlicedElements(GmshContents& contents, const Cursor& cursor)
      : contents_(contents), slice_(*contents.slice), cursor_(cursor) {}

  /// What follows is of this entity (and, in versions 1 and 2, of this group) and stands there.
  void begin(int dim, int entity, const char* at) {
    entity_ = entity;
    at_ = at;
    if (slice_.walk != GmshWalk::lower) return;
    const auto found = contents_.entity_physicals.find({dim, entity_});
    if (found == contents_.entity_physicals.end()) return;
    for (const int id : found->second) slice_.whole.groups.push_back({dim, id});
  }
  void begin(int dim, int entity, int physical, std::int64_t tag, const char* at) {
    begin(dim, entity, at);
    physical_ = physical;
    if (slice_.walk != GmshWalk::lower) return;
    const Owner group{dim, physical};
    if (physical != 0 && (slice_.whole.groups.empty() || slice_.whole.groups.back() != group))
      slice_.whole.groups.push_back(group);
    // A hex that is in two groups is in the file twice.
    if (dim == 3 && slice_.physical_of_volume.try_emplace(entity, physical).first->second != physical)
      slice_.refuse("a volume in several physical groups (element " + std::to_string(tag) + ")", true);
  }

  void add(int dim, std::int64_t tag, std::span<std::int64_t> nodes, const char* at) {
    const bool is_here = dim < 3 || (slice_.n_hexes >= slice_.begin && slice_.n_hexes < slice_.end);
    slice_.n_hexes += dim == 3;
    switch (slice_.walk) {
      case GmshWalk::lower:
        if (dim == 3)
          add_tag(tag);
        else if (dim > 0)
          add_key(dim, nodes);
        return;
      case GmshWalk::hexes:
        if (dim == 3) find_keys(nodes);
        return;
      case GmshWalk::nodes:
        if (dim == 3 && is_here)
          for (const std::int64_t id : nodes)
            if (has_bit(slice_, id)) slice_.nodes.set_more(static_cast<Index>(id));  // others are refused later
        return;
      case GmshWalk::all:
        break;
    }
    if (!is_here || (dim < 3 && !takes(dim, nodes))) return;
    GmshElements& elements = contents_.elements[dim];
    if (at_) elements.runs.push_back({elements.tags.size(), std::exchange(at_, nullptr)});
    elements.entity.push_back(entity_);
    if (contents_.version != 41) elements.physical.push_back(physical_);
    if (dim == 3) add_tag(tag);
    add_gmsh_element(contents_, cursor_, dim, tag, nodes, at);
  }

 private:
  void add_tag(std::int64_t tag) {
    if (!has_bit(slice_, tag) || slice_.hex_tags.has_any(static_cast<Index>(tag)))
      slice_.refuse("tags that are far apart or there twice (element " + std::to_string(tag) + ")", true);
    else
      slice_.hex_tags.set_more(static_cast<Index>(tag));
  }
  void add_key(int dim, std::span<const std::int64_t> nodes) {
    slice_.keys[dim - 1].push_back(nodes_key(nodes));
    for (const std::int64_t id : nodes)
      if (has_bit(slice_, id))
        slice_.nodes.set_more(static_cast<Index>(id));
      else
        slice_.refuse("ids that are far apart (node " + std::to_string(id) + ")", true);
  }
  void find_keys(std::span<const std::int64_t> nodes) {
    std::array<bool, n_hex_corners> is_near{};
    int n_near = 0;
    for (std::size_t c = 0; c < nodes.size(); ++c) {
      is_near[c] = has_id(slice_, slice_.nodes, nodes[c]);
      n_near += is_near[c];
    }
    if (n_near < 2) return;
    Hex order;  // where our corners are in the file
    for (int c = 0; c < n_hex_corners; ++c) order[c] = c;
    order = in_file_order(order);
    const auto find = [&](int dim, std::span<const int> corners) {
      std::array<std::int64_t, 4> ids{};
      for (std::size_t k = 0; k < corners.size(); ++k) {
        const auto c = static_cast<std::size_t>(order[corners[k]]);
        if (!is_near[c]) return;
        ids[k] = nodes[c];
      }
      const std::vector<NodesKey>& keys = slice_.keys[dim - 1];
      const NodesKey key = nodes_key(std::span(ids).first(corners.size()));
      for (auto at = std::ranges::lower_bound(keys, key); at != keys.end() && *at == key; ++at) {
        std::uint8_t& n = slice_.n_having[dim - 1][static_cast<std::size_t>(at - keys.begin())];
        n = static_cast<std::uint8_t>(std::min(n + 1, 2));
      }
    };
    for (int e = 0; e < n_hex_edges; ++e) find(1, std::array{edge_corner(e, 0), edge_corner(e, 1)});
    for (int f = 0; f < n_hex_faces; ++f)
      find(2, std::array{face_corner(f, 0), face_corner(f, 1), face_corner(f, 2), face_corner(f, 3)});
  }

  /// Whether the slice has it. Of a line with one node here only that counts, for a group's nodes: it stands twice.
  bool takes(int dim, std::span<std::int64_t> nodes) const {
    const auto is_here = [&](std::int64_t id) { return contents_.nodes.find(id) >= 0; };
    if (dim != 1) return std::ranges::all_of(nodes, is_here);
    if (!is_here(nodes[0])) nodes[0] = nodes[1];
    if (!is_here(nodes[1])) nodes[1] = nodes[0];
    return is_here(nodes[0]);
  }

  GmshContents& contents_;
  GmshSlice& slice_;
  const Cursor& cursor_;
  int entity_ = 0, physical_ = 0;
  const char* at_ = nullptr;  // of what begins
};

/// Walks over a file that is not read in one walk.
GmshContents walk_gmsh(const Bytes& bytes, GmshSlice& slice, GmshWalk kind) {
  Cursor cursor(bytes);
  slice.highest_id =
      std::min<std::int64_t>(8 * static_cast<std::int64_t>(bytes.size), std::numeric_limits<Index>::max() - 1);
  GmshContents contents;
  contents.slice = &slice;
  slice.walk = kind;
  slice.n_hexes = 0;
  read_gmsh_sections(contents, cursor);
  return contents;
}

}  // namespace

bool keeps_node_of_slice(GmshSlice& slice, std::int64_t id) {
  slice.highest_node = std::max(slice.highest_node, id);
  return slice.walk == GmshWalk::all && has_id(slice, slice.nodes, id);
}

bool keeps_of_slice(const GmshContents& contents, Field::On on, std::int64_t tag) {
  GmshSlice& slice = *contents.slice;
  const bool is_here = on == Field::On::node ? contents.nodes.find(tag) >= 0 : has_id(slice, slice.hex_tags, tag);
  // What has values of other elements, too, is told where all is read.
  if (slice.walk == GmshWalk::lower && on == Field::On::hex && !is_here)
    slice.refuse("values of elements other than hexes (element " + std::to_string(tag) + ")", true);
  return slice.walk == GmshWalk::all && is_here;
}

NodesKey nodes_key(std::span<const std::int64_t> ids) {
  std::array<std::int64_t, 4> sorted{};
  std::ranges::copy(ids, sorted.begin());
  std::sort(sorted.begin(), sorted.begin() + std::ssize(ids));
  NodesKey key = 0;
  for (std::size_t k = 0; k < ids.size(); ++k) key = mixed(key + static_cast<NodesKey>(sorted[k]));
  return key;
}

void read_sliced_gmsh_nodes(GmshContents& contents, GmshSource& source) {
  GmshSlice& slice = *contents.slice;
  Cursor& cursor = source.cursor;
  const bool is_read = slice.walk == GmshWalk::all;
  std::vector<std::int64_t> ids;
  std::vector<Run> runs;
  for_each_gmsh_node_block(
      source, [&](std::size_t n) { slice.n_nodes = static_cast<std::int64_t>(n); },
      [&](const GmshBlock& block) {
        const auto width = static_cast<std::size_t>(3 + (block.kind ? block.dim : 0));
        if (cursor.binary && !is_read) {
          const std::size_t bytes = block.size * (8 + 8 * width);
          if (bytes > cursor.left()) cursor.fail_truncated("nodes");
          const char* const end = cursor.at + bytes;
          for (std::size_t i = 0; i < block.size && slice.walk == GmshWalk::lower; ++i)
            slice.highest_node = std::max(slice.highest_node, source.large("a node id"));
          cursor.at = end;
          return;
        }
        std::vector<bool> is_here(block.size, false);
        for (std::size_t i = 0; i < block.size; ++i) {
          cursor.skip_text_blanks();
          const char* before = cursor.at;
          const std::int64_t id = source.large("a node id");
          is_here[i] = keeps_node_of_slice(slice, id);
          if (!is_here[i]) continue;
          if (i == 0 || !is_here[i - 1]) runs.push_back({ids.size(), before});
          ids.push_back(id);
        }
        for (std::size_t i = 0; i < block.size; ++i) {
          std::array<double, 3> point{};
          source.coordinates(point);
          for (std::size_t k = 3; k < width; ++k) source.real("a parameter");
          if (is_here[i]) contents.points.emplace_back(point[0], point[1], point[2]);
        }
      });
  if (!is_read) return;
  contents.nodes = Ids(std::move(ids), "node", cursor, runs);
  contents.nodes.sort(contents.points);
}

void read_sliced_gmsh_elements(GmshContents& contents, GmshSource& source) {
  Cursor& cursor = source.cursor;
  SlicedElements elements(contents, cursor);
  for_each_gmsh_element_block(
      source, [](std::size_t) {},
      [&](const GmshBlock& block) {
        const char* first = cursor.at;
        const std::int64_t first_tag = source.large("an element");
        const int dim =
            check_gmsh_type(contents, cursor, first, block.kind, first_tag, static_cast<std::int64_t>(block.size));
        cursor.at = first;
        const GmshType& type = *gmsh_type(block.kind);
        if (contents.slice->is_possible)
          elements.begin(dim, block.dim == type.dim ? std::max(block.entity, 0) : 0, first);
        std::array<std::int64_t, most_gmsh_nodes> ids;
        const auto nodes = std::span(ids).first(static_cast<std::size_t>(type.n_nodes));
        for (std::size_t i = 0; i < block.size; ++i) {
          cursor.skip_text_blanks();
          const char* at = cursor.at;
          const auto tag = source.large("an element");
          source.large_ones(nodes, "a node");
          if (contents.slice->is_possible) elements.add(dim, tag, nodes, at);
        }
      });
}

void add_sliced_gmsh_element(GmshContents& contents, const Cursor& cursor, Owner entity, int physical, std::int64_t tag,
                             std::span<std::int64_t> nodes, const char* at) {
  if (!contents.slice->is_possible) return;
  SlicedElements elements(contents, cursor);
  elements.begin(entity.dim, entity.id, physical, tag, at);
  elements.add(entity.dim, tag, nodes, at);
}

std::optional<SlicedFile> gmsh_in_slices(const std::filesystem::path& path, Unsliced& why) {
  const Bytes bytes = read_bytes(path);
  GmshSlice slice;
  const GmshContents contents = walk_gmsh(bytes, slice, GmshWalk::lower);
  why = slice.why;
  if (slice.is_possible && slice.n_hexes == 0) why = {"no hexes"};
  if (contents.n_partitions > 0) why = {"partitions", true};
  if (!why.what.empty()) return std::nullopt;
  for (std::size_t k = 0; k < slice.keys.size(); ++k) {
    std::ranges::sort(slice.keys[k]);
    slice.n_having[k].assign(slice.keys[k].size(), 0);
  }
  if (!slice.keys[0].empty() || !slice.keys[1].empty()) walk_gmsh(bytes, slice, GmshWalk::hexes);
  for (const auto& n_having : slice.n_having)
    if (std::ranges::find(n_having, 0) != n_having.end()) {
      why = {"quads or lines that are on no hex"};
      return std::nullopt;
    }
  for (std::size_t q = 0; q < slice.keys[1].size(); ++q)
    if (slice.n_having[1][q] > 1) slice.whole.inner_quads.push_back(slice.keys[1][q]);
  sort_unique(slice.whole.inner_quads);
  sort_unique(slice.whole.groups);
  return SlicedFile{path, slice.n_nodes, slice.n_hexes, slice.highest_node,
                    std::make_shared<const GmshWhole>(std::move(slice.whole))};
}

MeshSlice read_gmsh_slice(const SlicedFile& file, int number, int n) {
  const Bytes bytes = read_bytes(file.file);
  GmshSlice slice;
  slice.whole = *file.gmsh;
  slice.begin = file.n_hexes * number / n;
  slice.end = file.n_hexes * (number + 1) / n;
  walk_gmsh(bytes, slice, GmshWalk::nodes);
  if (slice.n_hexes != file.n_hexes || slice.n_nodes != file.n_nodes || !slice.is_possible)
    throw Error(file.file.string() + ": was changed while it was read");
  GmshContents contents = walk_gmsh(bytes, slice, GmshWalk::all);
  MeshSlice result;
  if (slice.begin == slice.end) return result;
  const Cursor cursor(bytes);
  result.file = assemble_gmsh(std::move(contents), cursor);
  return result;
}

}  // namespace hextwist::io
