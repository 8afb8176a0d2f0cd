// A mesh file that is written piece after piece, in any order: for meshes that are larger than the memory.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hextwist/mesh/mesh.h"

namespace hextwist {

/// The whole that the pieces make up. Places of its hexes are those in the file: blocks follow each other, in each the
/// hexes ascend by id, those in no block come last.
struct WholeOfPieces {
  /// Groups and fields, without values. Blocks have no hexes, sets have all members: places of nodes (ascending), and
  /// sides of hexes by their places (in the order that they have in the file).
  Mesh heads;
  std::int64_t n_nodes = 0;
  std::vector<std::int64_t> in_block;  ///< hexes of each block; none is in two
  std::int64_t in_no_block = 0;
  /// For each block, and for the hexes in none if there are any: whether it has a value of each component of each field
  /// of hexes.
  std::vector<std::uint8_t> has_values;
  std::int64_t highest_id = 0;
  /// Ids of nodes and of hexes by place; asked for in this order.
  std::function<std::int64_t()> next_node_id, next_hex_id;
};

/// Exodus, with what write_mesh() makes of the same mesh in memory. Every node and hex of the whole is put at least
/// once.
class PiecewiseFile {
 public:
  /// The whole stays where it is meanwhile. Tells what can't be kept. Throws Error naming the file, as all functions
  /// do.
  PiecewiseFile(const std::filesystem::path& file, const WholeOfPieces& whole, std::vector<std::string>& notices);
  ~PiecewiseFile();
  /// is_known: per node of the piece, whether a piece before had it; where this one lacks a field, what that one said
  /// stays.
  void put(const Mesh& piece, std::span<const Index> node_places, std::span<const Index> hex_places,
           std::span<const std::uint8_t> is_known);
  /// Of nodes that were put; places ascend.
  std::vector<Vec3> points(std::span<const Index> places) const;
  /// The file is there from now on.
  void commit();

 private:
  class Writer;
  std::unique_ptr<Writer> writer_;
};
/// Whether files of that name can be written so.
bool is_written_in_pieces(const std::filesystem::path& file);

}  // namespace hextwist
