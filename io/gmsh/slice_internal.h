// .msh in slices: what is read of a file in one walk over it.
#pragma once

#include "hextwist/base/ranked_bits.h"
#include "hextwist/io/gmsh/gmsh.h"
#include "hextwist/io/slice.h"

namespace hextwist::io {

/// A number for some nodes, in any order.
using NodesKey = std::uint64_t;

/// What has to be known of the whole.
struct GmshWhole {
  std::vector<Owner> groups;          ///< physical groups that have elements, ascending
  std::vector<NodesKey> inner_quads;  ///< those between two hexes, ascending
};

struct GmshSlice {
  enum class Walk {
    lower,  ///< quads, lines and points; how many nodes and hexes there are
    hexes,  ///< whether all quads and lines are sides and edges of hexes
    nodes,  ///< nodes of the slice's hexes
    all     ///< what the slice has
  };
  Walk walk = Walk::lower;
  bool is_possible = true;          ///< false: the file can't be read so
  Unsliced why;                     ///< then
  std::int64_t highest_id = 0;      ///< that has a bit: no more bytes of these than the file has
  std::int64_t begin = 0, end = 0;  ///< the slice: hexes in the order of the file
  std::int64_t n_nodes = 0, n_hexes = 0, highest_node = 0;
  RankedBits nodes;  ///< ids: of `lower` those of quads and lines, else those of the slice
  /// Walks over the whole: keys of quads and lines (ascending after the first), and how many hexes have each.
  std::array<std::vector<NodesKey>, 2> keys;
  std::array<std::vector<std::uint8_t>, 2> n_having;
  RankedBits hex_tags;                    ///< of all hexes, or of the slice's
  std::map<int, int> physical_of_volume;  ///< versions 1 and 2
  GmshWhole whole;

  /// It can't be read so; what stands against it is said of the first.
  void refuse(const std::string& what, bool may_be_split) {
    if (is_possible) why = {what, may_be_split};
    is_possible = false;
  }
};

/// Whether a node is kept in this walk, which has come to it.
bool keeps_node_of_slice(GmshSlice& slice, std::int64_t id);

/// An element of version 1 or 2, of a kept type. Where slices can't be read: nothing.
void add_sliced_gmsh_element(GmshContents& contents, const Cursor& cursor, Owner entity, int physical, std::int64_t tag,
                             std::span<std::int64_t> nodes, const char* at);

/// Whether a value of a node or element is kept in this walk.
bool keeps_of_slice(const GmshContents& contents, Field::On on, std::int64_t tag);

/// Of the nodes with these ids.
NodesKey nodes_key(std::span<const std::int64_t> ids);

std::optional<SlicedFile> gmsh_in_slices(const std::filesystem::path& file, Unsliced& why);
MeshSlice read_gmsh_slice(const SlicedFile& file, int number, int n);

}  // namespace hextwist::io
