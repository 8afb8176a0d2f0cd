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
  Index hex = -1;
  std::int32_t face = 0;

  auto operator<=>(const Side&) const = default;
};

/// Named groups. Ids are not negative and unique per kind; members ascending, each once. Groups of a kind may overlap,
/// and nothing need belong to any.
struct Block {
  int id = 0;
  std::string name;
  std::vector<Index> hexes;
  bool operator==(const Block&) const = default;
};
struct NodeSet {
  int id = 0;
  std::string name;
  std::vector<Index> nodes;
  /// Curves, surfaces, volumes that it is meant to hold all nodes of (association/meant.h), ascending: what is new on
  /// them joins it.
  std::vector<Owner> meant = {};
  bool operator==(const NodeSet&) const = default;
};
struct SideSet {
  int id = 0;
  std::string name;
  std::vector<Side> sides;
  bool operator==(const SideSet&) const = default;
};

/// Values per node or per hex: values[i * components + c].
struct Field {
  enum class On { node, hex };
  std::string name;
  On on = On::node;
  int components = 1;
  std::vector<double> values;
  /// Classes, flags, numbers of things: what is new gets the value of something near, never one between two.
  bool integer = false;
  bool operator==(const Field&) const = default;
};

struct FileResults;  // io/results.h

struct Mesh {
  std::vector<Vec3> points;
  std::vector<Hex> hexes;
  /// Ids as users know them, strictly ascending; empty: index + 1.
  std::vector<std::int64_t> node_ids;
  std::vector<std::int64_t> hex_ids;
  std::vector<Block> blocks;
  std::vector<NodeSet> node_sets;
  std::vector<SideSet> side_sets;
  std::vector<Field> fields;
  /// What the file said for which there is no array here (time steps, ...), null where that is nothing; and, for
  /// finding it, the hex of the file (0-based) that each hex lies in.
  std::shared_ptr<const FileResults> results;
  std::vector<Index> file_hexes;

  Index n_nodes() const { return static_cast<Index>(points.size()); }
  Index n_hexes() const { return static_cast<Index>(hexes.size()); }
  bool operator==(const Mesh&) const = default;
};

/// Id of a node or hex as the user knows it.
std::int64_t node_id(const Mesh& mesh, Index node);
std::int64_t hex_id(const Mesh& mesh, Index hex);
/// Index of an id, -1 when there is none. Logarithmic.
Index find_node(const Mesh& mesh, std::int64_t id);
Index find_hex(const Mesh& mesh, std::int64_t id);

/// Box of all points.
Box box(const Mesh& mesh);
/// Volume of one hex (trilinear map, exact) and of the whole mesh.
double volume(const Mesh& mesh, Index hex);
double volume(const Mesh& mesh);

}  // namespace hextwist
