#include "hextwist/io/listing.h"

#include <limits>

#include "hextwist/base/sorted.h"

namespace hextwist::io {
namespace {

using IdRange = std::pair<std::int64_t, std::int64_t>;

/// Ascending, none in another: so that no id is looked at twice, whatever a file says.
std::vector<IdRange> united(std::vector<IdRange> ranges) {
  std::ranges::sort(ranges);
  std::vector<IdRange> result;
  for (const IdRange& range : ranges)
    if (!result.empty() && range.first <= result.back().second)
      result.back().second = std::max(result.back().second, range.second);
    else if (range.first <= range.second)
      result.push_back(range);
  return result;
}

/// Positions of all ids within ranges. ids: ascending; empty: 1 .. n.
void add_within(std::vector<Index>& to, const std::vector<IdRange>& ranges, std::span<const std::int64_t> ids,
                Index n) {
  for (const auto& [first, last] : united(ranges)) {
    std::int64_t begin = std::max<std::int64_t>(first, 1) - 1, end = std::min<std::int64_t>(last, n);
    if (!ids.empty()) {
      begin = std::ranges::lower_bound(ids, first) - ids.begin();
      end = std::ranges::upper_bound(ids, last) - ids.begin();
    }
    for (std::int64_t i = begin; i < end; ++i) to.push_back(static_cast<Index>(i));
  }
}

}  // namespace

void Listing::fail(const char* at, const std::string& what) const {
  if (!at) throw Error(std::string(cursor_.name) + ": " + what);
  cursor_.fail_at(at, what);
}

void Listing::add_node(std::int64_t id, const Vec3& point, const char* at) {
  if (!point.allFinite()) fail(at, "a coordinate of node " + std::to_string(id) + " is not finite");
  node_ids_.push_back(id);
  node_at_.push_back(at);
  out_.mesh.points.push_back(point);
}

void Listing::add_hex(std::int64_t id, int part, std::span<const std::int64_t> nodes, const MiddleOrder& order,
                      const char* at) {
  hexes_.ids.push_back(id);
  hexes_.parts.push_back(part);
  hexes_.at.push_back(at);
  hexes_.nodes.insert(hexes_.nodes.end(), nodes.begin(), nodes.begin() + 8);
  if (std::ranges::all_of(nodes.subspan(8), [](std::int64_t node) { return node == 0; })) return;
  bent_hexes_.push_back(hexes_.ids.size() - 1);
  const std::size_t first = middle_nodes_.size();
  middle_nodes_.resize(first + FoundMiddles::width, 0);
  for (std::size_t i = 8; i < nodes.size(); ++i)
    middle_nodes_[first + static_cast<std::size_t>(order[i - 8])] = nodes[i];
}

void Listing::add_quad(std::int64_t id, int part, std::span<const std::int64_t> corners, const char* at) {
  quads_.ids.push_back(id);
  quads_.parts.push_back(part);
  quads_.at.push_back(at);
  quads_.nodes.insert(quads_.nodes.end(), corners.begin(), corners.begin() + 4);
}

void Listing::drop(std::int64_t id, const std::string& type) {
  ++n_dropped_[type];
  dropped_ids_.push_back(id);
}

void Listing::refuse(std::int64_t id, const std::string& type, const char* at) const {
  fail(at, "element " + std::to_string(id) + " is a " + type + "; only hexes of 8, 20 or 27 nodes are accepted");
}

Index Listing::node(std::int64_t id, std::int64_t element, const char* at) const {
  const Index index = nodes_.find(id);
  if (index < 0)
    fail(at, "element " + std::to_string(element) + " names node " + std::to_string(id) + ", which is not there");
  return index;
}

MeshFile Listing::result(bool parts_count_always) {
  if (hexes_.ids.empty()) {
    std::string others;
    for (std::size_t t = 0; t < others_.heads.types.size(); ++t)
      others += (t == 0 ? ", but " : ", ") +
                counted(std::ranges::count(others_.heads.type, static_cast<int>(t)), "element") + " " +
                others_.heads.types[t].name;
    fail(cursor_.begin == cursor_.end ? nullptr : cursor_.end, "there is no hex in the file" + others);
  }
  nodes_ =
      Ids(std::move(node_ids_), "node", [&](std::size_t item, const std::string& what) { fail(node_at_[item], what); });
  nodes_.sort(out_.mesh.points);
  out_.mesh.node_ids = nodes_.stored();
  assemble_hexes();
  assemble_quads();
  assemble_groups(parts_count_always);
  assemble_others();
  for (const auto& [type, n] : n_dropped_) note("dropped " + counted(n, "element") + " of type " + type);
  if (!bent_hexes_.empty()) assemble_middles();
  return std::move(out_);
}

void Listing::assemble_hexes() {
  Mesh& mesh = out_.mesh;
  hex_ids_ =
      Ids(hexes_.ids, "element", [&](std::size_t item, const std::string& what) { fail(hexes_.at[item], what); });
  mesh.hexes.resize(hexes_.ids.size());
  for (std::size_t h = 0; h < mesh.hexes.size(); ++h)
    for (std::size_t c = 0; c < 8; ++c)
      mesh.hexes[h][file_corner[c]] = node(hexes_.nodes[8 * h + c], hexes_.ids[h], hexes_.at[h]);
  part_of_hex_ = hexes_.parts;
  hex_ids_.sort(mesh.hexes);
  hex_ids_.sort(part_of_hex_);
  mesh.hex_ids = hex_ids_.stored();
}

void Listing::assemble_middles() {
  constexpr MiddleOrder as_it_is = [] {
    MiddleOrder order{};
    for (int i = 0; i < 19; ++i) order[i] = i;
    return order;
  }();
  FoundMiddles found;
  std::array<Index, FoundMiddles::width> nodes{};
  for (std::size_t i = 0; i < bent_hexes_.size(); ++i) {
    const std::size_t hex = bent_hexes_[i];
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const std::int64_t id = middle_nodes_[FoundMiddles::width * i + k];
      nodes[k] = id == 0 ? -1 : node(id, hexes_.ids[hex], hexes_.at[hex]);
    }
    const bool faces = std::ranges::any_of(std::span(nodes).subspan(12), [](Index n) { return n >= 0; });
    const auto place = hex_ids_.place().empty() ? hex : static_cast<std::size_t>(hex_ids_.place()[hex]);
    found.add(place, std::span(nodes).first(faces ? 19 : 12), as_it_is);
  }
  found.finish(hexes_.ids.size());
  take_middles(out_, found);
}

void Listing::assemble_quads() {
  std::vector<Quad> cycles(quads_.ids.size());
  for (std::size_t q = 0; q < cycles.size(); ++q) {
    for (std::size_t c = 0; c < 4; ++c) cycles[q][c] = node(quads_.nodes[4 * q + c], quads_.ids[q], quads_.at[q]);
    quad_of_id_.emplace_back(quads_.ids[q], static_cast<Index>(q));
  }
  std::ranges::sort(quad_of_id_);
  quad_sides_ = oriented_sides(out_.mesh, cycles);
  auto lost = std::ranges::count(quad_sides_, -1, &Side::hex);
  for (auto& [q, kept] : kept_quads_) {
    if (quad_sides_[q].hex >= 0) continue;
    --lost;
    add_other({OtherShape::quad, 4, kept.first}, quads_.ids[q], quads_.parts[q],
              std::span(quads_.nodes).subspan(4 * q, 4), std::move(kept.second), false, quads_.at[q]);
  }
  if (lost > 0) note("dropped " + counted(lost, "quad") + (lost == 1 ? " that is" : " that are") + " no side of a hex");
}

void Listing::assemble_groups(bool parts_count_always) {
  Mesh& mesh = out_.mesh;
  bool quads_grouped = false;
  std::vector<std::uint8_t> is_grouped(quad_sides_.size(), 0);
  std::int64_t n_missing = 0, first_missing = 0;
  const auto missing = [&](std::int64_t id) {
    if (n_missing++ == 0) first_missing = id;
  };
  std::ranges::sort(dropped_ids_);
  const auto put = [](auto& groups, const Group& from, const char* kind) -> auto& {
    const auto taken = [&](int id) {
      return std::ranges::find(groups, id, [](const auto& g) { return g.id; }) != groups.end();
    };
    const int own = from.is_own ? -1 : generated_id(from.name, kind);
    const bool generated = own >= 0 && !taken(own);
    const int id = generated ? own : from.id;
    auto& group = group_of_id(groups, taken(id) ? free_id(groups) : id);
    if (!generated) group.name = from.name;
    return group;
  };
  // Those that say their ids first, so that nobody else has these.
  std::ranges::stable_partition(groups_, [](const Group& group) {
    return !group.is_own && std::ranges::any_of(std::array{"block", "nodeset", "sideset"},
                                                [&](const char* kind) { return generated_id(group.name, kind) >= 0; });
  });
  // Sides by corners, of all groups at once.
  std::vector<Quad> cycles;
  std::int64_t n_lost = 0;
  for (const Group& from : groups_)
    for (const auto& corners : from.quads) {
      Quad& cycle = cycles.emplace_back();
      for (std::size_t c = 0; c < 4; ++c) cycle[c] = nodes_.find(corners[c]);
      if (const auto none = std::ranges::find(cycle, -1); none != cycle.end()) {
        missing(corners[static_cast<std::size_t>(none - cycle.begin())]);
        cycles.pop_back();
      }
    }
  const std::vector<Side> sides_of_cycles = oriented_sides(mesh, cycles);
  auto next_side = sides_of_cycles.begin();
  for (const Group& from : groups_) {
    std::vector<Index> members, hexes;
    std::vector<Side> sides;
    std::int64_t n_inwards = 0;
    for (const auto& corners : from.quads) {
      if (!std::ranges::all_of(corners, [&](std::int64_t id) { return nodes_.find(id) >= 0; })) continue;
      if (next_side->hex >= 0) {
        const Quad& cycle = cycles[static_cast<std::size_t>(next_side - sides_of_cycles.begin())];
        n_inwards +=
            from.has_normals && !turn_the_same_way(cycle, face_node_cycle(mesh.hexes[next_side->hex], next_side->face));
        sides.push_back(*next_side);
      } else {
        ++n_lost;
      }
      ++next_side;
    }
    if (n_inwards > 0)
      note(counted(n_inwards, "side") + " of set " + std::to_string(from.id) + (n_inwards == 1 ? " turns" : " turn") +
           " into the hex: here it is the other way, outwards");
    add_within(members, from.node_ranges, mesh.node_ids, mesh.n_nodes());
    add_within(hexes, from.element_ranges, mesh.hex_ids, mesh.n_hexes());
    if (!from.hexes_only)
      for (const auto& [first, last] : united(from.element_ranges))
        for (auto q = std::ranges::lower_bound(quad_of_id_, std::pair(first, Index{0}));
             q != quad_of_id_.end() && q->first <= last; ++q) {
          is_grouped[q->second] = 1;
          if (quad_sides_[q->second].hex >= 0) sides.push_back(quad_sides_[q->second]);
        }
    for (const std::int64_t id : from.nodes)
      if (const Index n = nodes_.find(id); n >= 0)
        members.push_back(n);
      else
        missing(id);
    for (const std::int64_t id : from.elements) {
      if (const Index h = hex_ids_.find(id); h >= 0) {
        hexes.push_back(h);
      } else if (const auto q = std::ranges::lower_bound(quad_of_id_, std::pair(id, Index{0}));
                 !from.hexes_only && q != quad_of_id_.end() && q->first == id) {
        is_grouped[q->second] = 1;
        if (quad_sides_[q->second].hex >= 0) sides.push_back(quad_sides_[q->second]);
      } else if (!std::ranges::binary_search(dropped_ids_, id)) {
        missing(id);
      }
    }
    for (const auto& [id, face] : from.sides)
      if (const Index h = hex_ids_.find(id); h >= 0)
        sides.push_back({h, face});
      else
        missing(id);
    for (const auto& [id, corners] : from.opposite) {
      const Index h = hex_ids_.find(id);
      if (h < 0) {
        missing(id);
        continue;
      }
      int face = -1;
      for (int f = 0; f < n_hex_faces; ++f) {
        const Quad q = face_nodes(mesh.hexes[h], f);
        const Index a = nodes_.find(corners[0]), b = nodes_.find(corners[1]);
        for (const auto& [i, j] : {std::pair(0, 3), std::pair(3, 0), std::pair(1, 2), std::pair(2, 1)})
          if (q[i] == a && q[j] == b) face = f;
      }
      face < 0 ? missing(corners[0]) : sides.push_back({h, face});
    }
    sort_unique(members), sort_unique(hexes), sort_unique(sides);
    groups_have_hexes_ = groups_have_hexes_ || !hexes.empty();
    quads_grouped = quads_grouped || !sides.empty();
    if (!members.empty() || from.empty_node_set) put(mesh.node_sets, from, "nodeset").nodes = std::move(members);
    if (!hexes.empty() || from.empty_block) put(mesh.blocks, from, "block").hexes = std::move(hexes);
    if (!sides.empty() || from.empty_side_set) put(mesh.side_sets, from, "sideset").sides = std::move(sides);
  }
  if (n_lost > 0)
    note("dropped " + counted(n_lost, "side") + " of sets that" + (n_lost == 1 ? " is" : " are") + " no side of a hex");
  if (n_missing > 0)
    note("groups name " + counted(n_missing, "node or element", "nodes or elements") +
         " that are not there; the first is " + std::to_string(first_missing));
  const auto name = [&](int part) {
    const auto found = part_names_.find(part);
    return found == part_names_.end() ? "" : found->second;
  };
  const auto group_of = [&](int part) {
    Group group{part, name(part)};
    group.is_own = true;
    return group;
  };
  if (!groups_have_hexes_ || parts_count_always) {
    std::map<int, std::vector<Index>> of_part;
    for (Index h = 0; h < mesh.n_hexes(); ++h)
      if (part_of_hex_[h] > 0) of_part[part_of_hex_[h]].push_back(h);
    for (auto& [part, hexes] : of_part) {
      // A group of the same id and name that has all of it is the whole of a block that overlaps others.
      const Index same = position_in(mesh.blocks, part, &Block::id);
      if (same >= 0 && mesh.blocks[same].name == name(part) && std::ranges::includes(mesh.blocks[same].hexes, hexes))
        continue;
      put(mesh.blocks, group_of(part), "block").hexes = std::move(hexes);
    }
  }
  if (quads_grouped && !parts_count_always) {
    std::int64_t n_left_out = 0;
    for (std::size_t q = 0; q < is_grouped.size(); ++q) n_left_out += !is_grouped[q] && quad_sides_[q].hex >= 0;
    if (n_left_out > 0) note(counted(n_left_out, "quad") + " in no group left out, as others are in groups");
  }
  if (!quads_grouped || parts_count_always) {
    std::map<int, std::vector<Side>> of_part;
    for (std::size_t q = 0; q < quad_sides_.size(); ++q)
      if (quads_.parts[q] > 0 && quad_sides_[q].hex >= 0) of_part[quads_.parts[q]].push_back(quad_sides_[q]);
    for (auto& [part, sides] : of_part) {
      sort_unique(sides);
      put(mesh.side_sets, group_of(part), "sideset").sides = std::move(sides);
    }
  }
}

std::vector<int> first_block_of_hexes(const Mesh& mesh, const char* format, std::vector<std::string>& notices) {
  std::vector<int> block(mesh.hexes.size(), -1);
  Index n_more = 0;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
    for (const Index h : mesh.blocks[b].hexes)
      if (block[h] < 0)
        block[h] = static_cast<int>(b);
      else
        ++n_more;
  if (n_more > 0)
    notices.push_back("blocks overlap, and a hex is in one only in " + std::string(format) + ": " +
                      counted(n_more, "hex", "hexes") + (n_more == 1 ? " is" : " are") +
                      " in the first of their blocks");
  return block;
}

const char* degenerate_hex(std::span<const std::int64_t> corners) {
  std::array<std::int64_t, 8> sorted{};
  std::ranges::copy(corners.first(8), sorted.begin());
  std::ranges::sort(sorted);
  switch (std::ranges::unique(sorted).begin() - sorted.begin()) {
    case 8:
      return nullptr;
    case 6:
      return "wedge (a hex with repeated nodes)";
    case 5:
      return "pyramid (a hex with repeated nodes)";
    case 4:
      return "tetrahedron (a hex with repeated nodes)";
    default:
      return "hex with repeated nodes";
  }
}

int generated_id(const std::string& name, std::string_view kind) {
  if (!name.starts_with(kind) || name.size() < kind.size() + 2 || name[kind.size()] != '_') return -1;
  int id = -1;
  const auto [stop, error] = std::from_chars(name.data() + kind.size() + 1, name.data() + name.size(), id);
  return error == std::errc{} && stop == name.data() + name.size() ? id : -1;
}

std::string plain_name(const std::string& name, std::size_t longest) {
  std::string plain;
  for (const char c : name.substr(0, longest))
    plain += std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' || c == '.' ? c : '_';
  return plain;
}

}  // namespace hextwist::io
