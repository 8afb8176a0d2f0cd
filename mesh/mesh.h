// The mesh is arrays: points, hexes, blocks, sets, fields. Functions over them live one topic per header.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hextwist/base/types.h"
#include "hextwist/geom/owner.h"

namespace HEXTWIST_API hextwist {

/// Corner c lies at (c & 1, c >> 1 & 1, c >> 2 & 1) of the unit cube (see corners.h). Positive volume when that
/// frame is right-handed.
using Hex = std::array<Index, 8>;

/// One of the six sides of a hex: face 2 * axis + side (see corners.h).
struct Side {
  Index hex = -1;         ///< -1: no side
  std::int32_t face = 0;  ///< 0 .. 5

  /// By hex, then by face.
  auto operator<=>(const Side&) const = default;
};

/// Named groups: of hexes. Ids are not negative and unique per kind; members ascending, each once. Groups of a kind may
/// overlap, and nothing need belong to any.
struct Block {
  int id = 0;                ///< as commands and files know it; 0 occurs in Exodus files
  std::string name;          ///< "": none; names need not be unique
  std::vector<Index> hexes;  ///< 0-based
  /// Equal in everything.
  bool operator==(const Block&) const = default;
};
/// Named groups: of nodes. Ids and members as in Block.
struct NodeSet {
  int id = 0;                ///< unique among the node sets
  std::string name;          ///< "": none
  std::vector<Index> nodes;  ///< 0-based
  /// Curves, surfaces, volumes that it is meant to hold all nodes of (association/meant.h), ascending: what is new on
  /// them joins it.
  std::vector<Owner> meant = {};
  /// Equal in everything.
  bool operator==(const NodeSet&) const = default;
};
/// Named groups: of sides of hexes. Ids and members as in Block. Of a face between two hexes it may hold either side or
/// both.
struct SideSet {
  int id = 0;               ///< unique among the side sets
  std::string name;         ///< "": none
  std::vector<Side> sides;  ///< ascending by (hex, face)
  /// Equal in everything.
  bool operator==(const SideSet&) const = default;
};

/// Values per node or per hex: values[i * components + c].
struct Field {
  /// What the values are of.
  enum class On {
    node,  ///< one value per node
    hex,   ///< one value per hex
  };
  std::string name;            ///< as commands and files know it
  On on = On::node;            ///< which of them it is of
  int components = 1;          ///< 1 scalar, 3 vector, 6 or 9 tensor, ...
  std::vector<double> values;  ///< n x components, in the units of whoever made them; NaN is allowed
  /// Classes, flags, numbers of things: what is new gets the value of something near, never one between two.
  bool integer = false;
  /// Equal in everything; NaN differs from itself.
  bool operator==(const Field&) const = default;
};

struct FileResults;    // io/results.h
struct OtherElements;  // others.h

/// Hexes on nodes, with groups and fields. Plain data: a copy shares nothing but `others` and `results`. Functions want
/// hexes that name existing nodes and ids that ascend; what else makes a mesh sound is for validate() to say.
struct Mesh {
  std::vector<Vec3> points;  ///< per node, model units
  std::vector<Hex> hexes;    ///< per hex its nodes, 0-based, in the order of corners.h
  /// Ids as users know them, strictly ascending; empty: index + 1.
  std::vector<std::int64_t> node_ids;
  std::vector<std::int64_t> hex_ids;  ///< the same of hexes
  std::vector<Block> blocks;          ///< ascending by id
  std::vector<NodeSet> node_sets;     ///< ascending by id
  std::vector<SideSet> side_sets;     ///< ascending by id
  std::vector<Field> fields;          ///< of nodes and of hexes, in any order
  /// Elements beside the hexes (others.h), null where there are none. Their nodes are among `points`, their ids differ
  /// from those of hexes.
  std::shared_ptr<const OtherElements> others;
  /// What the file said for which there is no array here (time steps, ...), null where that is nothing.
  std::shared_ptr<const FileResults> results;
  /// Where `results` have its values: per hex the hex of the file (0-based) that it lies in. Empty: not known.
  std::vector<Index> file_hexes;

  /// Number of nodes, those of no hex too.
  Index n_nodes() const { return static_cast<Index>(points.size()); }
  /// Number of hexes; 0: no mesh.
  Index n_hexes() const { return static_cast<Index>(hexes.size()); }
  /// Equal in everything; others and results when they are the same object.
  bool operator==(const Mesh&) const = default;
};

/// Id of a node as the user knows it. The node has to exist.
std::int64_t node_id(const Mesh& mesh, Index node);
/// Id of a hex as the user knows it. The hex has to exist.
std::int64_t hex_id(const Mesh& mesh, Index hex);
/// Index of a node by its id, -1 when there is none. Logarithmic.
Index find_node(const Mesh& mesh, std::int64_t id);
/// Index of a hex by its id, -1 when there is none. Logarithmic.
Index find_hex(const Mesh& mesh, std::int64_t id);

/// Places of the corners of a hex, which has to exist.
inline std::array<Vec3, 8> corners_of(const Mesh& mesh, Index hex) {
  std::array<Vec3, 8> corners;
  for (std::size_t c = 0; c < corners.size(); ++c) corners[c] = mesh.points[mesh.hexes[hex][c]];
  return corners;
}
/// Box of all points.
Box box(const Mesh& mesh);
/// Box of the corners of one hex.
Box box(const Mesh& mesh, Index hex);
/// Volume of one hex (trilinear map, exact), model units cubed; negative where it is inside out.
double volume(const Mesh& mesh, Index hex);
/// Volume of all hexes, summed in a fixed order: the same bits for any number of threads.
double volume(const Mesh& mesh);

}  // namespace hextwist
