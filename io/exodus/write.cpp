// Exodus II through its library.
//
// Element blocks divide the hexes. A hex in several of our blocks goes to the element block of the smallest, so that a
// block which covers all others does not swallow them; a block that lost hexes that way is written whole as an element
// set of the same id and name. Hexes in no block go to an element block of their own that readers of ours recognise by
// its name.
#include <limits>
#include <numeric>
#include <utility>

#include "hextwist/base/large_array.h"
#include "hextwist/base/text.h"
#include "hextwist/io/exodus/write_internal.h"
#include "hextwist/io/file_part.h"

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
      : replacement_(file),
        mesh_(mesh),
        second_(second),
        of_whole_(of_whole),
        notices_(notices),
        values_(mesh, notices) {
    if (mesh.results) extras_ = mesh.results.get();
    divide();
    tell_names();
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
    const int id = std::exchange(id_, -1);
    if (ex_close(id) < 0) fail();
  }

  ~ExodusWriter() {
    if (id_ >= 0) ex_close(id_);
  }
  ExodusWriter(const ExodusWriter&) = delete;
  ExodusWriter& operator=(const ExodusWriter&) = delete;

 private:
  [[noreturn]] void fail() const { replacement_.fail("cannot be written (disk full?)"); }
  void check(int status) const {
    if (status < 0) fail();
  }

  std::int64_t in_file(Of of, int id) const { return extras_ ? extras_->in_file(of, id) : id; }

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
      if (counts_.own[b] > 0 || counts_.hexes[b] == 0) parts_.push_back(std::move(part));
    }
    const int id = free_id(blocks);
    ExodusPart rest{id, id, exodus_rest_block, {}};
    for (Index h = 0; h < mesh_.n_hexes(); ++h)
      if (block_of_hex[h] == nobody) rest.own.push_back(h);
    rest.hexes = rest.own;
    rest.in_whole = counts_.rest;
    if (!rest.hexes.empty() && !blocks.empty() && !of_whole_)
      notices_.push_back(std::to_string(rest.own.size()) + " hexes that are in no block are in " +
                         named("element block", id, rest.name));
    if (counts_.rest > 0) parts_.push_back(std::move(rest));
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

  void tell_names() {
    const auto tell = [&](const auto& groups, const char* kind) {
      for (const auto& group : groups)
        say_renamed(kind + std::to_string(group.id), group.name, exodus_name(group.name), notices_);
    };
    tell(mesh_.blocks, "block "), tell(mesh_.node_sets, "nodeset "), tell(mesh_.side_sets, "sideset ");
  }

  void create() {
    const std::int64_t highest = of_whole_ ? of_whole_->highest_id
                                           : std::max(mesh_.points.empty() ? 0 : node_id(mesh_, mesh_.n_nodes() - 1),
                                                      mesh_.hexes.empty() ? 0 : hex_id(mesh_, mesh_.n_hexes() - 1));
    constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
    wide_ =
        highest > most ||
        (extras_ && (!extras_->wide_ids.empty() || std::ranges::any_of(extras_->properties, [](const auto& property) {
           return std::ranges::any_of(property.values, [](const auto& value) { return std::abs(value.second) > most; });
         })));
    // One variable of a 64-bit offset file holds at most 4 GiB; beyond that, and for wide ids, HDF5.
    const std::size_t bytes_per_hex = 4 * static_cast<std::size_t>(second_ ? second_->nodes_per_hex : 8);
    const bool large = mesh_.hexes.size() > (std::size_t{1} << 32) / bytes_per_hex - 1;
    int mode = EX_CLOBBER | (wide_ || large ? EX_NETCDF4 | EX_NOCLASSIC : EX_LARGE_MODEL);
    if (wide_) mode |= EX_ALL_INT64_DB | EX_MAPS_INT64_API | EX_IDS_INT64_API;
    int memory = 8, disk = 8;
    ex_opts(0);
    id_ = ex_create(replacement_.temporary().c_str(), mode, &memory, &disk);
    if (id_ < 0) fail();
  }

  void sizes() {
    std::size_t longest = 32;
    const auto measure = [&](const auto& groups) {
      for (const auto& group : groups) longest = std::max(longest, group.name.size());
    };
    measure(parts_), measure(mesh_.blocks), measure(mesh_.node_sets), measure(mesh_.side_sets);
    longest = std::max(longest, values_.longest_name());
    check(ex_set_max_name_length(id_, static_cast<int>(std::min<std::size_t>(longest, 255))));
    ex_init_params init{};
    const bool has_title = extras_ && !extras_->title.empty();
    std::strncpy(init.title, has_title ? extras_->title.c_str() : "hextwist", sizeof init.title - 1);
    init.num_dim = 3;
    init.num_nodes = mesh_.n_nodes();
    init.num_elem = mesh_.n_hexes();
    init.num_elem_blk = std::ssize(parts_);
    init.num_node_sets = std::ssize(mesh_.node_sets);
    init.num_side_sets = std::ssize(mesh_.side_sets);
    init.num_elem_sets = std::ssize(whole_);
    check(ex_put_init_ext(id_, &init));
  }

  void nodes() {
    // All of x, then y, then z, as they lie in the file: the library buffers one place only.
    std::vector<double> values(exodus_piece);
    for (int axis = 0; axis < 3; ++axis)
      in_pieces(mesh_.points.size(), [&](std::size_t first, std::size_t n) {
        for (std::size_t i = 0; i < n; ++i) values[i] = mesh_.points[first + i][axis];
        std::array<const double*, 3> x{};
        x[axis] = values.data();
        check(ex_put_partial_coord(id_, exodus_position(first), exodus_position(n - 1), x[0], x[1], x[2]));
      });
    std::array<std::string, 3> names = {"x", "y", "z"};
    if (extras_ && extras_->coordinate_names.size() == 3) std::ranges::copy(extras_->coordinate_names, names.begin());
    std::array<char*, 3> pointers = {names[0].data(), names[1].data(), names[2].data()};
    check(ex_put_coord_names(id_, pointers.data()));
    put_map(EX_NODE_MAP, mesh_.points.size(),
            [&](std::size_t n) { return id_of(mesh_.node_ids, static_cast<Index>(n)); });
  }
  /// 1-based, as the library counts.
  /// id(0) .. id(n_items - 1).
  template <class F>
  void put_map(ex_entity_type type, std::size_t n_items, F&& id) {
    const auto put = [&]<class T>(std::vector<T> ids) {
      in_pieces(n_items, [&](std::size_t first, std::size_t n) {
        for (std::size_t i = 0; i < n; ++i) ids[i] = static_cast<T>(id(first + i));
        check(ex_put_partial_id_map(id_, type, exodus_position(first), exodus_position(n - 1), ids.data()));
      });
    };
    wide_ ? put(std::vector<std::int64_t>(exodus_piece)) : put(Ints(exodus_piece));
  }

  void blocks() {
    const int nodes_per_hex = second_ ? second_->nodes_per_hex : 8;
    const std::string type = "HEX" + std::to_string(nodes_per_hex);
    std::vector<Index> nodes(exodus_piece * static_cast<std::size_t>(nodes_per_hex));
    for (const ExodusPart& part : parts_) {
      const auto n = std::ssize(part.hexes);
      std::vector<std::string> attributes = values_.attributes(part);
      check(
          ex_put_block(id_, EX_ELEM_BLOCK, part.in_file, type.c_str(), n, nodes_per_hex, 0, 0, std::ssize(attributes)));
      put_name(EX_ELEM_BLOCK, part.in_file, part.name);
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
        check(ex_put_partial_elem_conn(id_, part.in_file, exodus_position(first), exodus_position(size - 1),
                                       nodes.data()));
      });
      std::vector<char*> names;
      for (std::size_t a = 0; a < attributes.size(); ++a) {
        check(ex_put_one_attr(id_, EX_ELEM_BLOCK, part.in_file, static_cast<int>(a) + 1,
                              values_.attribute(part, attributes[a]).data()));
        attributes[a].resize(257);
        names.push_back(attributes[a].data());
      }
      if (!names.empty()) check(ex_put_attr_names(id_, EX_ELEM_BLOCK, part.in_file, names.data()));
    }
    // Parts follow each other.
    std::size_t part = 0, before = 0;
    put_map(EX_ELEM_MAP, mesh_.hexes.size(), [&](std::size_t element) {
      while (element - before == parts_[part].hexes.size()) before += parts_[part++].hexes.size();
      return id_of(mesh_.hex_ids, parts_[part].hexes[element - before]);
    });
  }

  void put_name(ex_entity_type type, std::int64_t id, const std::string& name) {
    if (!name.empty()) check(ex_put_name(id_, type, id, exodus_name(name).c_str()));
  }
  void put_set(ex_entity_type type, std::int64_t id, const std::string& name, const Ints& members, const Ints& sides,
               const std::vector<double>& factors) {
    check(ex_put_set_param(id_, type, id, std::ssize(members), std::ssize(factors)));
    if (!members.empty()) check(ex_put_set(id_, type, id, members.data(), sides.empty() ? nullptr : sides.data()));
    if (!factors.empty()) check(ex_put_set_dist_fact(id_, type, id, factors.data()));
    put_name(type, id, name);
  }

  ExodusTarget target() {
    return {id_, mesh_, parts_, [this](int status) { check(status); }, notices_};
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

  /// Per hex its 1-based place in the file.
  Ints elements_of_hexes() const {
    Ints element_of_hex;
    resize_for_overwrite(element_of_hex, mesh_.hexes.size());
    int element = 0;
    for (const ExodusPart& part : parts_)
      for (const Index h : part.hexes) element_of_hex[h] = ++element;
    return element_of_hex;
  }

  void sets() {
    const Ints element_of_hex = mesh_.side_sets.empty() && whole_.empty() ? Ints() : elements_of_hexes();
    for (const NodeSet& set : mesh_.node_sets) {
      Ints members;
      for (const Index n : set.nodes) members.push_back(n + 1);
      put_set(EX_NODE_SET, in_file(Of::node_set, set.id), set.name, members, {}, values_.factors(set));
    }
    std::array<int, 6> side_of_face{};
    for (int side = 0; side < 6; ++side) side_of_face[exodus_face[side]] = side + 1;
    for (const SideSet& set : mesh_.side_sets) {
      Ints members, sides;
      for (const Side& side : set.sides) {
        members.push_back(element_of_hex[side.hex]);
        sides.push_back(side_of_face[side.face]);
      }
      put_set(EX_SIDE_SET, in_file(Of::side_set, set.id), set.name, members, sides, values_.factors(set));
    }
    for (const Block* block : whole_) {
      Ints members;
      for (const Index h : block->hexes) members.push_back(element_of_hex[h]);
      put_set(EX_ELEM_SET, in_file(Of::block, block->id), block->name, members, {}, {});
    }
  }

  const Replacement& replacement_;
  const Mesh& mesh_;
  const SecondOrder* second_;
  const FilePart* of_whole_;
  std::vector<std::string>& notices_;
  ExodusValues values_;
  const FileResults* extras_ = nullptr;
  BlockCounts counts_;
  std::vector<ExodusPart> parts_;
  std::vector<const Block*> whole_;  // written as element sets
  int id_ = -1;
  bool wide_ = false;  // ids beyond 32 bits
};

}  // namespace

void write_exodus(const std::filesystem::path& file, const Mesh& mesh, const WriteOptions& options,
                  std::vector<std::string>& notices) {
  Replacement replacement(file, options.overwrite);
  if (replacement.direct()) replacement.fail("is not an ordinary file, as Exodus II needs");
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
  if (to.direct()) to.fail("is not an ordinary file, as Exodus II needs");
  io::ExodusWriter(to, mesh, nullptr, &part, notices).write();
}

}  // namespace hextwist
