// A mesh as many text formats list it: nodes and elements by ids, elements in numbered parts, groups of ids.
//
// A reader of such a format turns its lines into calls of this and has a mesh in the end; what the ids mean, what does
// not fit and what is no hex is the same for all of them.
#pragma once

#include <deque>
#include <map>

#include "hextwist/io/middles.h"
#include "hextwist/mesh/others.h"

namespace hextwist::io {

class Listing {
 public:
  /// Places (`at` below) are where an item stands in the file, for messages; null where that is not text.
  explicit Listing(const Cursor& cursor) : cursor_(cursor) {}

  void add_node(std::int64_t id, const Vec3& point, const char* at);
  /// nodes: 8 corners in the order of the files and, as `order` has them, middle nodes; 0: there is none. part: the
  /// block that it is in where no group has hexes, 0 none.
  void add_hex(std::int64_t id, int part, std::span<const std::int64_t> nodes, const MiddleOrder& order,
               const char* at);
  /// The same for a quad, by its corners in cyclic order: a side of a hex, in the side set of its part.
  void add_quad(std::int64_t id, int part, std::span<const std::int64_t> corners, const char* at);
  /// An element beside the hexes: its nodes (those of the shape in the order of mesh/others.h, then others that it
  /// names) and what else the file says of it. part: of a block, 0 none. rigid: OtherHeads::is_rigid.
  void add_other(const OtherType& type, std::int64_t id, int part, std::span<const std::int64_t> nodes,
                 std::string rest, bool rigid, const char* at);
  /// Of the quad added last: an element of this name where it is no side of a hex.
  void keep_quad(const std::string& name, std::string rest) {
    kept_quads_[quads_.ids.size() - 1] = {name, std::move(rest)};
  }
  /// Whose words `rest` and the names of types are.
  void set_format(const char* format) { others_.heads.format = format; }
  /// What has no place, counted and told in the end.
  void drop(std::int64_t id, const std::string& type);
  /// Throws Error: a tetrahedron, say.
  [[noreturn]] void refuse(std::int64_t id, const std::string& type, const char* at) const;

  /// Members by id: of nodes a node set; of hexes a block; of quads, and of hexes with a face, a side set.
  struct Group {
    int id;
    std::string name;
    std::vector<std::int64_t> nodes = {}, elements = {};
    std::vector<std::pair<std::int64_t, int>> sides = {};                             ///< hex and face (corners.h)
    std::vector<std::pair<std::int64_t, std::array<std::int64_t, 2>>> opposite = {};  ///< hex, two opposite corners
    std::vector<std::array<std::int64_t, 4>> quads = {};                              ///< sides by their corners
    /// All between a first and a last id that are there.
    std::vector<std::pair<std::int64_t, std::int64_t>> node_ranges = {}, element_ranges = {};
    bool hexes_only = false;   ///< elements are no quads
    bool has_normals = false;  ///< of quads: what is said of them is of one side of theirs
    bool is_own = false;       ///< id and name are its own, even where others call unnamed groups so ("block_5")
    bool empty_block = false, empty_node_set = false, empty_side_set = false;  ///< is one, even if without members
  };
  Group& add_group(int id, const std::string& name) { return groups_.emplace_back(Group{id, name}); }
  /// Names of blocks and side sets that parts become.
  void name_part(int part, const std::string& name) { part_names_[part] = name; }
  void note(const std::string& line) { out_.notices.push_back(line); }

  /// parts_count_always: parts are blocks and side sets even where groups have hexes or quads.
  MeshFile result(bool parts_count_always);
  /// After result().
  bool groups_have_hexes() const { return groups_have_hexes_; }

 private:
  struct Elements {
    std::vector<std::int64_t> ids, nodes;
    std::vector<int> parts;
    std::vector<const char*> at;
  };
  [[noreturn]] void fail(const char* at, const std::string& what) const;
  Index node(std::int64_t id, std::int64_t element, const char* at) const;
  void assemble_hexes();
  void assemble_middles();
  void assemble_quads();
  void assemble_others();
  void assemble_groups(bool parts_count_always);

  const Cursor& cursor_;
  MeshFile out_;
  std::vector<std::int64_t> node_ids_;
  std::vector<const char*> node_at_;
  Elements hexes_, quads_;
  struct Others {
    OtherHeads heads;
    std::vector<std::int64_t> nodes;
    std::vector<std::size_t> first = {0};
    std::vector<int> parts;
    std::vector<const char*> at;
  } others_;
  std::map<std::size_t, std::pair<std::string, std::string>> kept_quads_;  // by their place: name and rest
  std::vector<std::size_t> bent_hexes_;     // those with middle nodes, as they were added
  std::vector<std::int64_t> middle_nodes_;  // of each, as MiddleOrder counts them; 0: there is none
  std::map<std::string, std::int64_t> n_dropped_;
  std::vector<std::int64_t> dropped_ids_;
  std::deque<Group> groups_;
  std::map<int, std::string> part_names_;
  Ids nodes_, hex_ids_;
  std::vector<std::pair<std::int64_t, Index>> quad_of_id_;  // ascending
  std::vector<Side> quad_sides_;
  std::vector<int> part_of_hex_;
  bool groups_have_hexes_ = false;
};

/// Items of which something is left out, for one line in the end.
struct Losses {
  std::int64_t n = 0, first = 0;  ///< how many, and the lowest id

  void add(std::int64_t id) { first = n++ == 0 ? id : std::min(first, id); }
  void add(const Losses& others) {
    if (others.n > 0) first = n == 0 ? others.first : std::min(first, others.first);
    n += others.n;
  }
  /// "constraints (PS) of 3 nodes left out; the first is 5", where there are any.
  void tell(Listing& listing, const std::string& what, const char* kind) const {
    if (n > 0) listing.note(what + " of " + counted(n, kind) + " left out; the first is " + std::to_string(first));
  }
};

/// For writers of formats where a hex is in one group only: per hex the position of its first block, -1 none; a notice
/// where hexes are in several.
std::vector<int> first_block_of_hexes(const Mesh& mesh, const char* format, std::vector<std::string>& notices);
/// What a hex with repeated corners is, by how many different ones it has; null where none is repeated.
const char* degenerate_hex(std::span<const std::int64_t> corners);
/// What writers call groups without a name, "block_3": its id; -1 for all else.
int generated_id(const std::string& name, std::string_view kind);
/// A name on one line, of letters that every program takes.
std::string plain_name(const std::string& name, std::size_t longest);

}  // namespace hextwist::io
