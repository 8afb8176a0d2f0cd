// Exodus II through its library.
//
// Element blocks divide the hexes. A hex in several of our blocks goes to the element block of the smallest, so that a
// block which covers all others does not swallow them; a block that lost hexes that way is written whole as an element
// set of the same id and name. Hexes in no block go to an element block of their own that readers of ours recognise by
// its name.
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "hextwist/base/large_array.h"
#include "hextwist/base/sorted.h"
#include "hextwist/base/text.h"
#include "hextwist/io/exodus/write_internal.h"
#include "hextwist/io/field_names.h"
#include "hextwist/io/file_part.h"
#include "hextwist/io/others.h"

namespace hextwist::io {
namespace {

using Ints = std::vector<int>;
using Of = FileResults::Of;

std::string named(const char* kind, std::int64_t id, const std::string& name) {
  return std::string(kind) + " " + std::to_string(id) + (name.empty() ? "" : " '" + name + "'");
}

constexpr Index nobody = -1;

/// Per hex the block that is its element block. sizes: of the blocks, in the whole.
std::vector<Index> element_blocks(const Mesh& mesh, std::span<const std::int64_t> sizes) {
  std::vector<Index> block_of_hex(mesh.hexes.size(), nobody);
  // The smallest last, of equal ones the first.
  std::vector<Index> order(mesh.blocks.size());
  std::iota(order.rbegin(), order.rend(), 0);
  std::ranges::stable_sort(order, std::ranges::greater{}, [&](Index b) { return sizes[b]; });
  for (const Index b : order)
    for (const Index h : mesh.blocks[b].hexes) block_of_hex[h] = b;
  return block_of_hex;
}

BlockCounts counts_of(const Mesh& mesh, std::span<const std::int64_t> sizes, std::vector<Index>& block_of_hex) {
  BlockCounts counts;
  counts.hexes.assign(sizes.begin(), sizes.end());
  if (sizes.empty())
    for (const Block& block : mesh.blocks) counts.hexes.push_back(std::ssize(block.hexes));
  counts.own.assign(mesh.blocks.size(), 0);
  block_of_hex = element_blocks(mesh, counts.hexes);
  for (const Index b : block_of_hex) ++(b == nobody ? counts.rest : counts.own[b]);
  return counts;
}

class ExodusWriter {
 public:
  /// of_whole: null unless it is a part of one.
  ExodusWriter(const Replacement& file, const Mesh& mesh, const SecondOrder* second, const FilePart* of_whole,
               std::vector<std::string>& notices)
      : out_(file), mesh_(mesh), second_(second), of_whole_(of_whole), notices_(notices), values_(mesh, notices) {
    divide();
    say_exodus_names(mesh_, notices_);
    if (!of_whole_) say_whole_numbers(mesh_, "Exodus", notices_);
    create();
  }

  void write() {
    sizes();
    if (of_whole_) write_exodus_part(target(), *of_whole_, globals(), elements_of_hexes());
    nodes();
    blocks();
    sets();
    const ExodusTarget to = target();
    values_.write_properties(to);
    values_.write_records(to);
    values_.write_results(to);
    out_.close();
  }

 private:
  void check(int status) const { out_.check(status); }

  std::int64_t in_file(Of of, int id) const { return values_.extras().in_file(of, id); }

  void divide() {
    const std::vector<Block>& blocks = mesh_.blocks;
    std::vector<Index> block_of_hex;
    if (of_whole_) {
      counts_ = of_whole_->blocks;
      block_of_hex = element_blocks(mesh_, counts_.hexes);
    } else {
      counts_ = counts_of(mesh_, {}, block_of_hex);
    }
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      const Block& block = blocks[b];
      ExodusPart part{block.id, in_file(Of::block, block.id), block.name, block.hexes};
      if (counts_.own[b] < counts_.hexes[b]) {
        std::ranges::copy_if(block.hexes, std::back_inserter(part.own),
                             [&](Index h) { return block_of_hex[h] == static_cast<Index>(b); });
        part.hexes = part.own;
        whole_.push_back(&block);
        if (!of_whole_) tell_overlap(block, part.own.size(), block_of_hex);
      }
      part.in_whole = counts_.own[b];
      if (block.hexes.empty() && !others_of_block(mesh_, block.id).empty()) continue;
      if (counts_.own[b] > 0 || counts_.hexes[b] == 0) parts_.push_back(std::move(part));
    }
    const int id = free_id(blocks);
    ExodusPart rest{id, id, exodus_rest_block, {}};
    for (Index h = 0; h < mesh_.n_hexes(); ++h)
      if (block_of_hex[h] == nobody) rest.own.push_back(h);
    rest.hexes = rest.own;
    rest.in_whole = counts_.rest;
    if (!blocks.empty() && !of_whole_) say_rest_block(std::ssize(rest.hexes), id, notices_);
    if (counts_.rest > 0) parts_.push_back(std::move(rest));
    if (mesh_.others) divide_others();
  }

  /// Element blocks of other elements: of the smallest block that each is in, one for each type. The first of a block
  /// without hexes is it.
  void divide_others() {
    const OtherElements& others = *mesh_.others;
    constexpr std::int64_t highest = std::numeric_limits<std::int64_t>::max();
    other_ids_ = other_ids_in_file(mesh_, mesh_.hex_ids, highest, "is too large", notices_);
    std::vector<int> block_of(static_cast<std::size_t>(others.size()), -1);
    std::vector<std::pair<std::size_t, const Block*>> by_size;
    for (const Block& block : mesh_.blocks) {
      const std::size_t n = others_of_block(mesh_, block.id).size();
      if (n > 0) by_size.emplace_back(n, &block);
    }
    std::ranges::stable_sort(by_size, std::ranges::greater{}, &std::pair<std::size_t, const Block*>::first);
    for (const auto& [n, block] : by_size)
      for (const Index e : others_of_block(mesh_, block->id)) block_of[e] = block->id;
    int next_id = 0;
    for (const ExodusPart& part : parts_) next_id = std::max(next_id, part.id);
    for (const Block& block : mesh_.blocks) next_id = std::max(next_id, block.id);
    std::map<std::pair<int, std::string>, std::size_t> part_of;  // by block and type
    std::map<std::string, std::int64_t> n_lost;
    std::int64_t n_shortened = 0, n_connectors = 0;
    for (Index e = 0; e < others.size(); ++e) {
      const OtherType& type = others.type_of(e);
      const std::string name = others.heads->format == "exodus" ? type.name : exodus_type(type);
      if (name.empty()) {
        ++n_lost[type.name];
        continue;
      }
      n_connectors += type.shape == OtherShape::connector;
      n_shortened += std::ssize(others.nodes_of(e)) > type.n_nodes;
      const std::pair key(block_of[e], name + "/" + std::to_string(type.n_nodes));
      auto at = part_of.find(key);
      if (at == part_of.end()) {
        const Index b = position_in(mesh_.blocks, block_of[e], &Block::id);
        const bool is_it = b >= 0 && mesh_.blocks[b].hexes.empty() &&
                           std::ranges::find(parts_, block_of[e], &ExodusPart::id) == parts_.end();
        const int id = is_it ? block_of[e] : ++next_id;
        if (id < 0) throw Error("no id is left for a block of other elements");
        const std::string called = b >= 0 ? mesh_.blocks[b].name : exodus_rest_block;
        ExodusPart part{id, is_it ? in_file(Of::block, id) : id, called, {}};
        part.type = name;
        if (!is_it)
          notices_.push_back("other elements of type " + (type.name.empty() ? name : type.name) +
                             (b < 0 ? " that are in no block" : " of block " + std::to_string(block_of[e])) +
                             " are in element block " + std::to_string(id));
        at = part_of.emplace(key, parts_.size()).first;
        parts_.push_back(std::move(part));
      }
      parts_[at->second].others.push_back(e);
    }
    for (const auto& [type, n] : n_lost)
      notices_.push_back(counted(n, "other element of type " + type, "other elements of type " + type) +
                         " left out: Exodus has nothing like them");
    if (n_connectors > 0)
      notices_.push_back(counted(n_connectors, "connector") +
                         " written as BAR2, which are cut where they lie on edges");
    if (n_shortened > 0)
      notices_.push_back(counted(n_shortened, "other element") +
                         " written without nodes that say how they are turned, which Exodus has no place for");
    say_values_of_others(mesh_, "Exodus", notices_);
    // Blocks that are in several element blocks, or in those of others, are sets as well.
    for (const Block& block : mesh_.blocks) {
      const std::vector<Index> all = others_of_block(mesh_, block.id);
      if (all.empty() || std::ranges::find(whole_, &block) != whole_.end()) continue;
      const auto part = std::ranges::find(parts_, block.id, &ExodusPart::id);
      if (part == parts_.end() || part->others != all || !block.hexes.empty()) whole_.push_back(&block);
    }
  }

  /// What elements of another format are called; empty where there is nothing like them.
  static std::string exodus_type(const OtherType& type) {
    const auto with = [&](const char* name, std::initializer_list<int> known) {
      return std::ranges::find(known, type.n_nodes) != known.end() ? name + std::to_string(type.n_nodes) : "";
    };
    switch (type.shape) {
      case OtherShape::point:
        return "SPHERE";
      case OtherShape::line:
        return with("BAR", {2, 3});
      case OtherShape::triangle:
        return with("TRISHELL", {3, 6});
      case OtherShape::quad:
        return with("SHELL", {4, 8, 9});
      case OtherShape::tetrahedron:
        return with("TETRA", {4, 10});
      case OtherShape::pyramid:
        return with("PYRAMID", {5, 13});
      case OtherShape::wedge:
        return with("WEDGE", {6, 15});
      case OtherShape::connector:
        return with("BAR", {2});
    }
    return "";
  }

  void tell_overlap(const Block& block, std::size_t n_own, std::span<const Index> block_of_hex) {
    std::vector<std::size_t> n_in(mesh_.blocks.size(), 0);
    for (const Index h : block.hexes) ++n_in[block_of_hex[h]];
    std::string where;
    for (std::size_t b = 0; b < n_in.size(); ++b)
      if (const Block& other = mesh_.blocks[b]; n_in[b] > 0 && other.id != block.id)
        where += (where.empty() ? "" : ", ") + std::to_string(n_in[b]) + " in " +
                 named("element block", in_file(Of::block, other.id), other.name);
    notices_.push_back(named("block", block.id, block.name) + " overlaps others, which element blocks can't: of its " +
                       std::to_string(block.hexes.size()) + " hexes " +
                       (n_own == 0 ? "none is" : std::to_string(n_own) + " are") + " in an element block of its own, " +
                       where + "; all of it is " + named("element set", in_file(Of::block, block.id), block.name));
  }

  void create() {
    const std::int64_t highest = of_whole_ ? of_whole_->highest_id
                                           : std::max({mesh_.points.empty() ? 0 : node_id(mesh_, mesh_.n_nodes() - 1),
                                                       mesh_.hexes.empty() ? 0 : hex_id(mesh_, mesh_.n_hexes() - 1),
                                                       other_ids_.empty() ? 0 : std::ranges::max(other_ids_)});
    out_.create(highest > highest_narrow_id || values_.are_wide(), mesh_.hexes.size(),
                second_ ? second_->nodes_per_hex : 8);
  }

  void sizes() {
    std::size_t longest = 32;
    const auto measure = [&](const auto& groups) {
      for (const auto& group : groups) longest = std::max(longest, group.name.size());
    };
    measure(parts_), measure(mesh_.blocks), measure(mesh_.node_sets), measure(mesh_.side_sets);
    longest = std::max(longest, values_.longest_name());
    ex_init_params init{};
    init.num_nodes = mesh_.n_nodes();
    for (const ExodusPart& part : parts_) init.num_elem += std::ssize(part.hexes) + std::ssize(part.others);
    init.num_elem_blk = std::ssize(parts_);
    init.num_node_sets = std::ssize(mesh_.node_sets);
    init.num_side_sets = std::ssize(mesh_.side_sets);
    init.num_elem_sets = std::ssize(whole_);
    out_.put_sizes(init, values_.extras().title, longest);
  }

  void nodes() {
    // All of x, then y, then z, as they lie in the file: the library buffers one place only.
    std::vector<double> values(exodus_piece);
    for (int axis = 0; axis < 3; ++axis)
      in_pieces(mesh_.points.size(), [&](std::size_t first, std::size_t n) {
        for (std::size_t i = 0; i < n; ++i) values[i] = mesh_.points[first + i][axis];
        out_.put_coordinates(axis, first, std::span(values).first(n));
      });
    out_.put_coordinate_names(values_.extras().coordinate_names);
    out_.put_map(EX_NODE_MAP, mesh_.points.size(),
                 [&](std::size_t n) { return id_of(mesh_.node_ids, static_cast<Index>(n)); });
  }

  void blocks() {
    const int nodes_per_hex = second_ ? second_->nodes_per_hex : 8;
    const std::string type = "HEX" + std::to_string(nodes_per_hex);
    std::vector<Index> nodes(exodus_piece * static_cast<std::size_t>(nodes_per_hex));
    for (const ExodusPart& part : parts_) {
      if (!part.others.empty()) {
        other_block(part);
        continue;
      }
      const std::vector<std::string> attributes = values_.attributes(part);
      out_.put_block(part, type, std::ssize(part.hexes), nodes_per_hex, std::ssize(attributes));
      in_pieces(part.hexes.size(), [&](std::size_t first, std::size_t size) {
        Index* to = nodes.data();
        for (std::size_t i = 0; i < size; ++i) {
          if (!second_) {
            for (const Index node : in_file_order(mesh_.hexes[part.hexes[first + i]])) *to++ = node + 1;
            continue;
          }
          const FileHex hex = file_hex(mesh_, second_, part.hexes[first + i], exodus_middles);
          for (const Index node : hex.all()) *to++ = node + 1;
        }
        check(ex_put_partial_elem_conn(out_.file(), part.in_file, exodus_position(first), exodus_position(size - 1),
                                       nodes.data()));
      });
      for (std::size_t a = 0; a < attributes.size(); ++a)
        check(ex_put_one_attr(out_.file(), EX_ELEM_BLOCK, part.in_file, static_cast<int>(a) + 1,
                              values_.attribute(part, attributes[a]).data()));
      put_attribute_names(part, attributes);
    }
    // Parts follow each other.
    std::size_t part = 0, before = 0;
    std::size_t n_elements = 0;
    for (const ExodusPart& one : parts_) n_elements += one.size();
    out_.put_map(EX_ELEM_MAP, n_elements, [&](std::size_t element) {
      while (element - before == parts_[part].size()) before += parts_[part++].size();
      const ExodusPart& of = parts_[part];
      return of.others.empty() ? id_of(mesh_.hex_ids, of.hexes[element - before])
                               : other_ids_[of.others[element - before]];
    });
  }

  void other_block(const ExodusPart& part) {
    const OtherElements& others = *mesh_.others;
    const OtherType& type = others.type_of(part.others.front());
    std::vector<const OtherField*> attributes;
    for (const OtherField& field : others.heads->fields)
      if (field.is_attribute && field.components == 1 &&
          std::ranges::any_of(part.others, [&](Index e) { return !std::isnan(field.values[others.of[e]]); }))
        attributes.push_back(&field);
    out_.put_block(part, part.type, std::ssize(part.others), type.n_nodes, std::ssize(attributes));
    Ints nodes;
    for (const Index e : part.others) {
      const std::size_t first = nodes.size();
      for (const Index n : others.nodes_of(e).first(static_cast<std::size_t>(type.n_nodes))) nodes.push_back(n + 1);
      if (type.shape == OtherShape::wedge && type.n_nodes == 15)
        std::swap_ranges(&nodes[first + 9], &nodes[first + 12], &nodes[first + 12]);
    }
    check(ex_put_conn(out_.file(), EX_ELEM_BLOCK, part.in_file, nodes.data(), nullptr, nullptr));
    std::vector<std::string> names;
    for (std::size_t a = 0; a < attributes.size(); ++a) {
      std::vector<double> values;
      for (const Index e : part.others) values.push_back(attributes[a]->values[others.of[e]]);
      check(ex_put_one_attr(out_.file(), EX_ELEM_BLOCK, part.in_file, static_cast<int>(a) + 1, values.data()));
      names.push_back(exodus_name(attributes[a]->name));
    }
    put_attribute_names(part, names);
  }
  void put_attribute_names(const ExodusPart& part, const std::vector<std::string>& names) const {
    if (names.empty()) return;
    check(ex_put_attr_names(out_.file(), EX_ELEM_BLOCK, part.in_file, TextsWritten(names).pointers.data()));
  }

  ExodusTarget target() {
    return {out_.file(), mesh_, parts_, [this](int status) { check(status); }, notices_};
  }
  ExodusGlobals globals() const {
    ExodusGlobals result;
    for (const ExodusPart& part : parts_) {
      result.block_ids.push_back(part.in_file);
      result.block_counts.push_back(part.in_whole);
    }
    const auto sets = [&](Of of, const auto& all, const std::vector<std::int64_t>& members, int factors_each,
                          std::vector<std::int64_t>& ids, std::vector<std::int64_t>& factors) {
      for (std::size_t s = 0; s < all.size(); ++s) {
        ids.push_back(in_file(of, all[s].id));
        factors.push_back(values_.has_factors(all[s]) ? factors_each * members[s] : 0);
      }
    };
    sets(Of::node_set, mesh_.node_sets, of_whole_->node_sets, 1, result.node_set_ids, result.node_factors);
    sets(Of::side_set, mesh_.side_sets, of_whole_->side_sets, 4, result.side_set_ids, result.side_factors);
    return result;
  }

  static bool is_number(const std::string& text) {
    return !text.empty() && std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
  }
  /// Per hex its 1-based place in the file.
  Ints elements_of_hexes() const {
    Ints element_of_hex;
    resize_for_overwrite(element_of_hex, mesh_.hexes.size());
    int element = 0;
    for (const ExodusPart& part : parts_)
      for (std::size_t i = 0; i < part.size(); ++i, ++element)
        if (part.others.empty()) element_of_hex[part.hexes[i]] = element + 1;
    return element_of_hex;
  }
  /// The same of other elements, 0 where they are not in the file.
  Ints elements_of_others() const {
    Ints element_of(static_cast<std::size_t>(n_others(mesh_)), 0);
    int element = 0;
    for (const ExodusPart& part : parts_) {
      element += static_cast<int>(part.hexes.size());
      for (const Index e : part.others) element_of[e] = ++element;
    }
    return element_of;
  }
  /// Nodes of a side as the library counts them for distribution factors.
  static std::size_t n_nodes_of_side(const OtherType& type, const std::string& side) {
    const bool shell = lower_case(type.name).starts_with("shell") || lower_case(type.name).starts_with("trishell");
    const std::size_t n = static_cast<std::size_t>(std::max(std::atoi(side.c_str()), 1));
    const bool second = type.n_nodes > n_corners(type.shape);
    switch (type.shape) {
      case OtherShape::triangle:
      case OtherShape::quad:
        return shell && n <= 2 ? static_cast<std::size_t>(type.n_nodes) : second ? 3 : 2;
      case OtherShape::tetrahedron:
        return second ? 6 : 3;
      case OtherShape::pyramid:
        return n <= 4 ? (second ? 6 : 3) : (second ? 8 : 4);
      case OtherShape::wedge:
        return n <= 3 ? (second ? 8 : 4) : (second ? 6 : 3);
      default:
        return 1;
    }
  }

  void sets() {
    const Ints element_of_hex = mesh_.side_sets.empty() && whole_.empty() ? Ints() : elements_of_hexes();
    const Ints element_of_other = elements_of_others();
    for (const NodeSet& set : mesh_.node_sets) {
      Ints members;
      for (const Index n : set.nodes) members.push_back(n + 1);
      out_.put_set(EX_NODE_SET, in_file(Of::node_set, set.id), set.name, members, {}, values_.factors(set));
    }
    for (const SideSet& set : mesh_.side_sets) {
      Ints members, sides;
      for (const Side& side : set.sides) {
        members.push_back(element_of_hex[side.hex]);
        sides.push_back(exodus_side_of(side.face));
      }
      std::vector<double> factors = values_.factors(set);
      if (second_) factors = with_middle_factors(factors, second_->nodes_per_hex == 20 ? 8 : 9);
      const bool alike = std::ranges::adjacent_find(factors, std::ranges::not_equal_to{}) == factors.end();
      std::int64_t n_lost = 0;
      bool has_others = false;
      for (const auto& [element, side] : other_sides_of(mesh_, set.id)) {
        const int number =
            is_number(side) ? std::atoi(side.c_str())
            : side == "SPOS" || (side.empty() && mesh_.others->type_of(element).shape == OtherShape::quad) ? 1
            : side == "SNEG"                                                                               ? 2
                                                                                                           : 0;
        if (element_of_other[element] == 0 || number == 0) {
          ++n_lost;
          continue;
        }
        has_others = true;
        members.push_back(element_of_other[element]);
        sides.push_back(number);
        if (!factors.empty() && alike)
          factors.insert(factors.end(), n_nodes_of_side(mesh_.others->type_of(element), side), factors[0]);
      }
      if (n_lost > 0)
        notices_.push_back("side set " + std::to_string(set.id) + ": left out " +
                           counted(n_lost, "side of another element", "sides of other elements"));
      if (has_others && !alike) {
        factors.clear();
        notices_.push_back("side set " + std::to_string(set.id) +
                           ": left out its distribution factors, as it has sides of other elements");
      }
      out_.put_set(EX_SIDE_SET, in_file(Of::side_set, set.id), set.name, members, sides, factors);
    }
    for (const Block* block : whole_) {
      Ints members;
      for (const Index h : block->hexes) members.push_back(element_of_hex[h]);
      for (const Index e : others_of_block(mesh_, block->id))
        if (element_of_other[e] > 0) members.push_back(element_of_other[e]);
      out_.put_set(EX_ELEM_SET, in_file(Of::block, block->id), block->name, members, {}, {});
    }
  }

  ExodusOutput out_;
  const Mesh& mesh_;
  const SecondOrder* second_;
  const FilePart* of_whole_;
  std::vector<std::string>& notices_;
  ExodusValues values_;
  BlockCounts counts_;
  std::vector<ExodusPart> parts_;
  std::vector<const Block*> whole_;  // written as element sets
  std::vector<std::int64_t> other_ids_;
};

}  // namespace

void write_exodus(const std::filesystem::path& file, const Mesh& mesh, const WriteOptions& options,
                  std::vector<std::string>& notices) {
  Replacement replacement(file, options.overwrite);
  ExodusWriter(replacement, mesh, options.second, nullptr, notices).write();
  replacement.commit();
}

}  // namespace hextwist::io

namespace hextwist {

BlockCounts block_counts(const Mesh& mesh, std::span<const std::int64_t> sizes) {
  std::vector<Index> block_of_hex;
  return io::counts_of(mesh, sizes, block_of_hex);
}

void write_part(const Replacement& to, const Mesh& mesh, const FilePart& part, std::vector<std::string>& notices) {
  io::ExodusWriter(to, mesh, nullptr, &part, notices).write();
}

}  // namespace hextwist
