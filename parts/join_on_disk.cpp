#include "hextwist/parts/join_on_disk.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "hextwist/base/interrupt.h"
#include "hextwist/base/sorted.h"
#include "hextwist/base/text.h"
#include "hextwist/io/pieces.h"
#include "hextwist/mesh/arrays.h"
#include "hextwist/mesh/nodal_fields.h"
#include "hextwist/parts/id_set.h"
#include "hextwist/parts/join.h"
#include "hextwist/parts/shared_values.h"
#include "hextwist/parts/source.h"

namespace hextwist {
namespace {

using LongIds = std::vector<std::int64_t>;

constexpr int no_block = std::numeric_limits<int>::min();

class Joining {
 public:
  Joining(const SplitName& split, const Fence& fence) : split_(split), fence_(fence) {}

  /// False: what is read so far can't be joined so.
  bool look_at_all() {
    for (int p = 0; p < split_.n_parts; ++p) {
      check_interrupt();
      if (!look_at(p, read(p, notices_))) return false;
    }
    if (hexes_.size() == 0) return false;
    if (twice_ >= 0) tell_twice();
    for (const IdSet* ids : {&nodes_, &hexes_})
      if (ids->size() > std::numeric_limits<Index>::max())
        throw Error("the parts have " + std::to_string(ids->size()) + " nodes or hexes together, more than 2147483647");
    check_counts(split_, head_, nodes_.size(), hexes_.size());
    return true;
  }

  std::vector<std::string> write(const std::filesystem::path& to) {
    WholeOfPieces whole = of_all();
    IdSet::Walk nodes(nodes_);
    whole.next_node_id = [&] { return nodes.next(); };
    auto block = blocks_in_order_.begin();
    IdSet::Walk hexes(**block);
    whole.next_hex_id = [&] {
      for (;;) {
        if (const std::int64_t id = hexes.next(); id >= 0) return id;
        hexes = IdSet::Walk(**++block);
      }
    };
    const std::ptrdiff_t n_of_reading = std::ssize(notices_);
    PiecewiseFile file(to, whole, notices_);
    SharedValues shared(sorted_unique(std::move(shared_)));
    std::vector<bool> is_there(static_cast<std::size_t>(nodes_.size()), false);
    for (int p = 0; p < split_.n_parts; ++p) {
      check_interrupt();
      std::vector<std::string> told_before;
      Mesh part = read(p, told_before);
      shared.settle(part);
      const std::vector<Index> node = nodes_.places(part.node_ids), hex = places_of_hexes(part.hex_ids);
      if (sizes_[static_cast<std::size_t>(p)] != std::pair(part.n_nodes(), part.n_hexes()) ||
          std::ranges::find(node, -1) != node.end() || std::ranges::find(hex, -1) != hex.end())
        throw Error(name(p) + ": was changed while it was read");
      std::vector<std::uint8_t> is_known;
      for (const Index n : node) is_known.push_back(is_there[n]);
      compare_points(p, part, node, is_known, file);
      file.put(part, node, hex, is_known);
      for (const Index n : node) is_there[n] = true;
    }
    file.commit();
    const std::vector<std::string> differ = disagreement_lines(shared.differ(), split_.name.string());
    notices_.insert(notices_.begin() + n_of_reading, differ.begin(), differ.end());
    notices_.push_back(joined_text(hexes_.size(), nodes_.size(), split_.n_parts));
    return std::move(notices_);
  }

 private:
  std::string name(int p) const { return part_name(split_.name, split_.n_parts, p).string(); }
  Mesh read(int p, std::vector<std::string>& notices) {
    Mesh part = read_one_part(split_, p, head_, notices, fence_);
    need_ids(part);
    return part;
  }

  /// Per hex the place of its block in the mesh, -1 where it has none.
  static std::vector<int> blocks_of(const Mesh& mesh) {
    std::vector<int> block(mesh.hexes.size(), -1);
    for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
      for (const Index h : mesh.blocks[b].hexes) block[h] = static_cast<int>(b);
    return block;
  }

  bool look_at(int p, const Mesh& part) {
    sizes_.emplace_back(part.n_nodes(), part.n_hexes());
    constexpr std::int64_t highest = std::int64_t{1} << 40;
    const LongIds &node_ids = part.node_ids, &hex_ids = part.hex_ids;
    for (const LongIds* ids : {&node_ids, &hex_ids})
      if (!ids->empty() && (ids->front() < 0 || ids->back() > highest)) return false;
    if (in_two_blocks(part) >= 0) return false;
    const std::vector<int> block = blocks_of(part);
    const bool has_nodal = has_nodal_fields(part);
    for (const std::int64_t id : node_ids)
      if (!nodes_.add(id) && has_nodal) shared_.push_back(id);
    std::vector<IdSet*> of_block;
    for (const Block& one : part.blocks) of_block.push_back(&in_block_[one.id]);
    IdSet& rest = in_block_[no_block];
    for (Index h = 0; h < part.n_hexes(); ++h) {
      if (!hexes_.add(hex_ids[h]) && twice_ < 0) {
        twice_ = hex_ids[h];
        second_ = p;
      }
      (block[h] < 0 ? rest : *of_block[static_cast<std::size_t>(block[h])]).add(hex_ids[h]);
    }
    if (nodes_.is_sparse() || hexes_.is_sparse()) return false;
    for (const NodeSet& set : part.node_sets)
      for (const Index n : set.nodes) node_sets_[set.id].push_back(node_ids[n]);
    for (const SideSet& set : part.side_sets)
      for (const Side& side : set.sides) side_sets_[set.id].emplace_back(hex_ids[side.hex], side.face);
    for (const Field& field : part.fields) {
      const auto [at, is_new] = components_.emplace(std::pair(field.on, field.name), field.components);
      if (!is_new && at->second != field.components) return false;
      if (field.on == Field::On::hex) look_for_values(part, block, field);
    }
    copy_heads(part, heads_.emplace_back().mesh);
    join_results(results_, part.results);
    return true;
  }
  void look_for_values(const Mesh& part, const std::vector<int>& block, const Field& field) {
    const auto n = static_cast<std::size_t>(field.components);
    std::vector<std::uint8_t> has((part.blocks.size() + 1) * n, 0);  // of hexes in no block first
    for (std::size_t h = 0; h < block.size(); ++h)
      for (std::size_t c = 0; c < n; ++c)
        has[static_cast<std::size_t>(block[h] + 1) * n + c] |= !std::isnan(field.values[h * n + c]);
    for (std::size_t i = 0; i < has.size(); ++i) {
      const int id = i < n ? no_block : part.blocks[i / n - 1].id;
      if (has[i]) has_values_.push_back({id, field.name, static_cast<int>(i % n)});
    }
  }

  WholeOfPieces of_all() {
    WholeOfPieces whole;
    whole.heads = join(heads_, [](std::size_t) { return std::string(); }).mesh;
    whole.heads.results = results_;
    whole.n_nodes = nodes_.size();
    whole.highest_id = std::max(nodes_.highest(), hexes_.highest());
    std::vector<int> block_ids;
    for (const Block& block : whole.heads.blocks) {
      block_ids.push_back(block.id);
      whole.in_block.push_back(in_block_[block.id].size());
    }
    whole.in_no_block = in_block_[no_block].size();
    if (whole.in_no_block > 0) block_ids.push_back(no_block);
    std::int64_t first = 0;
    for (const int id : block_ids) {
      first_[id] = first;
      first += in_block_[id].size();
      blocks_in_order_.push_back(&in_block_[id]);
    }
    sort_unique(has_values_);
    for (const int id : block_ids)
      for (const Field& field : whole.heads.fields)
        for (int c = 0; field.on == Field::On::hex && c < field.components; ++c)
          whole.has_values.push_back(position_in(has_values_, HasValues{id, field.name, c}) >= 0);
    for (NodeSet& set : whole.heads.node_sets) set.nodes = nodes_.places(sorted_unique(std::move(node_sets_[set.id])));
    for (SideSet& set : whole.heads.side_sets) {
      const auto sides = sorted_unique(std::move(side_sets_[set.id]));
      LongIds ids;
      for (const auto& [id, face] : sides) ids.push_back(id);
      const std::vector<Index> places = places_of_hexes(ids);
      for (std::size_t i = 0; i < sides.size(); ++i) set.sides.push_back({places[i], sides[i].second});
    }
    return whole;
  }

  /// ids ascend, and may be there several times.
  std::vector<Index> places_of_hexes(std::span<const std::int64_t> ids) const {
    std::vector<Index> result(ids.size(), -1);
    for (const auto& [block, first] : first_) {
      const std::vector<Index> places = in_block_.at(block).places(ids);
      for (std::size_t i = 0; i < ids.size(); ++i)
        if (places[i] >= 0) result[i] = static_cast<Index>(first + places[i]);
    }
    return result;
  }

  void compare_points(int p, const Mesh& part, std::span<const Index> places, std::span<const std::uint8_t> is_known,
                      const PiecewiseFile& file) {
    std::vector<Index> here, known;
    for (std::size_t n = 0; n < places.size(); ++n)
      if (is_known[n]) {
        here.push_back(static_cast<Index>(n));
        known.push_back(places[n]);
      }
    const std::vector<Vec3> points = file.points(known);
    for (std::size_t i = 0; i < here.size(); ++i)
      if (points[i] != part.points[here[i]]) {
        const std::int64_t id = part.node_ids[here[i]];
        throw Error("node " + std::to_string(id) + " is at one place in " + name(last_with(p, &Mesh::node_ids, id)) +
                    " and at another in " + name(p));
      }
  }
  [[noreturn]] void tell_twice() {
    throw Error("hex " + std::to_string(twice_) + " is in " + name(last_with(second_, &Mesh::hex_ids, twice_)) +
                " and in " + name(second_));
  }
  /// The last part before p that has this node or hex.
  int last_with(int p, LongIds Mesh::*ids, std::int64_t id) {
    std::vector<std::string> ignored;
    while (--p > 0)
      if (std::ranges::binary_search(read(p, ignored).*ids, id)) break;
    return p;
  }

  struct HasValues {
    int block;
    std::string field;
    int component;
    auto operator<=>(const HasValues&) const = default;
  };

  const SplitName& split_;
  const Fence& fence_;
  PartHead head_;
  std::vector<std::string> notices_;
  std::vector<std::pair<Index, Index>> sizes_;  // of the parts
  std::vector<MeshedModel> heads_;
  std::shared_ptr<const FileResults> results_;  // of the whole
  IdSet nodes_, hexes_;
  LongIds shared_;  // nodes that parts before had, of parts with nodal fields
  std::map<int, IdSet> in_block_;
  std::map<int, std::int64_t> first_;  // places of the hexes of each block
  std::vector<const IdSet*> blocks_in_order_;
  std::map<int, LongIds> node_sets_;
  std::map<int, std::vector<std::pair<std::int64_t, int>>> side_sets_;
  std::map<std::pair<Field::On, std::string>, int> components_;
  std::vector<HasValues> has_values_;
  std::int64_t twice_ = -1;  // a hex of two parts
  int second_ = -1;
};

}  // namespace

std::optional<std::vector<std::string>> join_on_disk(const SplitName& parts, const std::filesystem::path& to,
                                                     const Fence& fence) {
  if (!is_written_in_pieces(to)) return std::nullopt;
  Joining joining(parts, fence);
  if (!joining.look_at_all()) return std::nullopt;
  return joining.write(to);
}

}  // namespace hextwist
