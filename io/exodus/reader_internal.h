// The reader of Exodus II, whose parts are in several files.
#pragma once

#include <limits>
#include <map>

#include "hextwist/base/large_array.h"
#include "hextwist/base/ranked_bits.h"
#include "hextwist/base/sorted.h"
#include "hextwist/base/text.h"
#include "hextwist/io/exodus/exodus_internal.h"
#include "hextwist/mesh/others.h"

namespace hextwist::io {

class ExodusReader {
  using Int64s = std::vector<std::int64_t>;
  using Ints = std::vector<int>;

 public:
  /// path: where the bytes of the file are. of: slice `number` of so many is read; 0: the whole.
  ExodusReader(const std::filesystem::path& path, std::string name, int number = 0, int of = 0);
  const ex_init_params& sizes() const { return init_; }
  /// Are there only hexes of 8 nodes, each id once, and groups that each slice sees alike? Else what it has.
  /// highest_node: id.
  Unsliced against_slices(std::int64_t& highest_node) const;
  MeshFile result();
  MeshSlice slice();

 private:
  struct Handle {
    int id = -1;
    ~Handle() {
      if (id >= 0) ex_close(id);
    }
  };
  using FileBlock = ExodusSource::Block;

  [[noreturn]] void fail(const std::string& what) const { throw Error(name_ + ": " + what); }
  void check(int status, const std::string& what) const {
    if (status < 0) fail(what + " cannot be read (damaged file)");
  }
  /// A number of items, each at least four bytes in the file (HDF5 files can be compressed, at most about a
  /// thousandfold): a damaged one must not become a huge allocation.
  std::size_t size(std::int64_t n, const std::string& what) const {
    if (n < 0 || n > std::min<std::int64_t>(most_items_, std::numeric_limits<Index>::max()))
      fail("impossible number of " + what + ": " + std::to_string(n));
    return static_cast<std::size_t>(n);
  }
  Int64s ids(ex_entity_type type, std::int64_t n) const {
    Int64s result(size(n, "groups"));
    if (n > 0) check(ex_get_ids(file_.id, type, result.data()), "ids of groups");
    return result;
  }
  std::string group_name(ex_entity_type type, std::int64_t id) const {
    std::string name(name_length_ + 1, '\0');
    if (ex_get_name(file_.id, type, id, name.data()) < 0) return "";
    name.resize(std::strlen(name.c_str()));
    return std::string(trimmed(name));
  }
  static bool fits(std::int64_t id) { return id >= 0 && id <= std::numeric_limits<int>::max(); }
  static bool has_hexes(const std::string& type, std::int64_t n_nodes) {
    const bool sized = n_nodes == 8 || n_nodes == 20 || n_nodes == 27;
    return sized && (type.starts_with("hex") || is_unnamed(type));
  }
  static bool is_unnamed(const std::string& type) { return type.empty() || type == "null" || type == "unknown"; }
  /// Calls use(first, ids) for pieces of an id map.
  template <class Use>
  void for_id_map(ex_entity_type map, std::int64_t begin, std::int64_t end, const Use& use) const {
    Int64s piece(exodus_piece);
    in_pieces(static_cast<std::size_t>(end - begin), [&](std::size_t first, std::size_t n) {
      check(ex_get_partial_id_map(file_.id, map, begin + exodus_position(first), static_cast<std::int64_t>(n),
                                  piece.data()),
            map == EX_NODE_MAP ? "the node id map" : "the element id map");
      use(first, std::span<const std::int64_t>(piece).first(n));
    });
  }
  /// Are ids positive and all different? False as well where that is not known without room for them: out of order and
  /// far apart.
  bool occur_once(ex_entity_type map, std::int64_t n, std::int64_t& highest) const;
  /// The id here of a group of the file.
  int group_id(ex_entity_type type, std::int64_t id) const {
    return fits(id) ? static_cast<int>(id) : number_of_wide_.at({type == EX_ELEM_SET ? EX_ELEM_BLOCK : type, id});
  }
  /// Ids here for those that do not fit, the lowest that no other group of this kind has.
  void number_groups(ex_entity_type type, FileResults::Of of, std::int64_t n, const char* kind);
  /// What lies in the slice of elements first .. first + n - 1.
  struct Range {
    std::int64_t first, n;
  };
  Range in_slice(std::int64_t first, std::int64_t n) const {
    const std::int64_t begin = std::clamp(begin_, first, first + n), end = std::clamp(end_, first, first + n);
    return {begin, end - begin};
  }
  bool is_elsewhere(std::int64_t element) const { return element - 1 < begin_ || element - 1 >= end_; }

  void find_nodes_of_slice();
  void nodes();
  /// Index of the node at a 1-based position in the file; -1 where a slice does not have it.
  Index node(std::int64_t position, const std::string& who) const {
    if (position < 1 || position > init_.num_nodes)
      fail(who + " names node " + std::to_string(position) + " of " + std::to_string(init_.num_nodes));
    const Index at = is_slice_ ? is_here_.find(static_cast<Index>(position - 1)) : static_cast<Index>(position - 1);
    return at < 0 || nodes_.place().empty() ? at : nodes_.place()[at];
  }

  /// Throws Error where they have more elements than the file says.
  std::vector<ex_block> element_blocks() const;
  void blocks();
  /// ", but 12 SHELL4 (element block 3)"
  std::string only_others() const;
  void other_blocks();
  void other_attributes(const FileBlock& block);
  /// Adds the other elements when all is said of them.
  void finish_others();
  /// Turns positions of nodes into indices. element(i): the id of the element that number i belongs to.
  template <class Element>
  void indices(std::span<int> positions, const Element& element) const {
    const auto n = static_cast<unsigned>(init_.num_nodes);
    unsigned highest = 0;
    for (int& position : positions) {
      const unsigned index = static_cast<unsigned>(position) - 1;
      highest = std::max(highest, index);
      position = static_cast<int>(index);
    }
    if (highest >= n && !positions.empty())
      for (std::size_t i = 0; i < positions.size(); ++i)
        if (static_cast<unsigned>(positions[i]) >= n)
          node(std::int64_t{positions[i]} + 1, "element " + std::to_string(element(i)));
    if (is_slice_)
      for (int& position : positions) position = is_here_.find(position);
    if (!nodes_.place().empty())
      for (int& position : positions) position = nodes_.place()[position];
  }

  /// map: ids of what is read, from element `skipped` of the block on, which are elements first, ... of all that is
  /// read.
  void read_block(const ex_block& block, std::span<const std::int64_t> map, std::int64_t first, std::int64_t skipped);
  /// Members and, for side sets, side numbers.
  std::pair<Ints, Ints> set(ex_entity_type type, std::int64_t id) const;
  Index hex(std::int64_t element, const std::string& who) const {
    if (element < 1 || element > init_.num_elem)
      fail(who + " names element " + std::to_string(element) + " of " + std::to_string(init_.num_elem));
    return is_elsewhere(element) ? -1 : hex_of_element_[element - 1 - begin_];
  }

  Index other_of(std::int64_t element) const { return other_of_element_.empty() ? -1 : other_of_element_[element]; }

  /// Of a block, by the start of its name and its number of nodes; -1: unknown.
  int other_type(const char* name, const std::string& lower, int n_nodes);
  /// Whether pieces of an element have this side whole: the two faces of a shell.
  static bool is_face_of_shell(const OtherType& type, int side) {
    return type.shape == OtherShape::quad && lower_case(type.name).starts_with("shell") && side <= 2;
  }

  void side_sets();
  void node_sets();
  void element_sets();
  /// Of a nodal variable; returns what the library does.
  int values_in_slice(int step, int variable, std::vector<double>& values) const;
  void fields(ex_entity_type type, Field::On on);

  std::string name_;
  Handle file_;
  bool is_slice_;
  std::int64_t begin_ = 0, end_ = 0;  // elements that are read
  RankedBits is_here_;                // of a slice: nodes that are read, by their positions
  std::vector<Index> positions_;      // these
  std::int64_t most_items_ = 0;
  std::size_t name_length_ = 256;
  ex_init_params init_{};
  MeshFile out_;
  Ids nodes_, hexes_;
  FoundMiddles middles_;
  std::vector<FileBlock> blocks_;
  std::map<std::pair<ex_entity_type, std::int64_t>, int> number_of_wide_;
  std::vector<FileResults::WideId> wide_ids_;
  std::vector<Index> hex_of_element_;    // -1 for others
  std::vector<Index> other_of_element_;  // the same; empty where there are none
  OtherHeads heads_;
  std::vector<Index> other_first_ = {0}, other_nodes_;
  bool swaps_ = false;  // middle nodes of wedges: around, then upwards
};

}  // namespace hextwist::io
