// What reading and writing of Exodus II share.
#pragma once

#include <exodusII.h>

#include "hextwist/io/file_part.h"
#include "hextwist/io/middles.h"
#include "hextwist/io/results.h"
#include "hextwist/io/slice.h"

namespace hextwist::io {

/// Corners of sides 1..6 of a hex, in the order of the library (Schoof and Yarberry, "EXODUS II: a finite element data
/// model", 1994).
inline constexpr std::array<std::array<int, 4>, 6> exodus_side = {
    {{1, 2, 6, 5}, {2, 3, 7, 6}, {3, 4, 8, 7}, {1, 5, 8, 4}, {1, 4, 3, 2}, {5, 6, 7, 8}}};
inline constexpr std::array<int, 6> exodus_face = {
    face_of_file_corners(exodus_side[0]), face_of_file_corners(exodus_side[1]), face_of_file_corners(exodus_side[2]),
    face_of_file_corners(exodus_side[3]), face_of_file_corners(exodus_side[4]), face_of_file_corners(exodus_side[5])};
/// The number of the side, from 1, that is our face.
constexpr int exodus_side_of(int face) {
  return static_cast<int>(std::ranges::find(exodus_face, face) - exodus_face.begin()) + 1;
}
/// Our corners of a face in that order.
constexpr std::array<int, 4> exodus_cycle(int face) {
  std::array<int, 4> corners{};
  for (int side = 0; side < 6; ++side)
    if (exodus_face[side] == face)
      for (int k = 0; k < 4; ++k) corners[k] = file_corner[exodus_side[side][k] - 1];
  return corners;
}

/// The library's calls for many numbers are made in pieces of so many nodes or hexes: what they need stays in the
/// cache, and no array is there twice.
inline constexpr std::size_t exodus_piece = std::size_t{1} << 13;
template <class F>
void in_pieces(std::size_t n, F&& f) {
  for (std::size_t first = 0; first < n; first += exodus_piece) f(first, std::min(exodus_piece, n - first));
}

/// The library counts from 1.
inline std::int64_t exodus_position(std::size_t i) {
  return static_cast<std::int64_t>(i) + 1;
}

/// A file that is open, and what its positions and ids are here.
struct ExodusSource {
  struct Block {
    std::int64_t id, first, n;  ///< elements that are read, 0-based
    bool hexes;
    std::int64_t skipped, n_in_file;  ///< of a slice: elements of the block before those that are read, and all
  };
  int file;
  const std::string& name;
  std::size_t name_length;
  const ex_init_params& init;
  std::span<const Block> blocks;
  std::span<const Index> hex_of_element;  ///< -1 for others
  const Ids& nodes;
  std::function<int(ex_entity_type, std::int64_t)> group;  ///< id here
  const std::vector<FileResults::WideId>& wide_ids;
};
/// What the file has beyond mesh, groups and fields of its last step; null where that is nothing. What can't be kept is
/// said.
std::shared_ptr<const FileResults> read_extras(const ExodusSource& source, const Mesh& mesh,
                                               std::vector<std::string>& notices);
/// The same of what has no node, hex or side of its own. lost: names the rest.
std::shared_ptr<const FileResults> read_extras_of_whole(const ExodusSource& source, std::vector<std::string>& notices,
                                                        std::vector<std::string>& lost);

bool is_classic_netcdf(const Bytes& file);
/// Throws Error unless all that the header announces lies within the file: then the library takes no more memory than a
/// small multiple of its size.
void check_classic_netcdf(const Bytes& file);

/// What Nemesis says. Throws Error naming the file.
PartHead read_exodus_head(const std::filesystem::path& file);

std::optional<SlicedFile> exodus_in_slices(const std::filesystem::path& file, const Fence& fence, Unsliced& why);
MeshSlice read_exodus_slice(const SlicedFile& file, int number, int n);

/// Name of the element block for hexes that are in no block.
inline constexpr const char* exodus_rest_block = "hextwist_no_block";

/// Distribution factors of sides of 8 or 9 nodes (`each`) from those of their corners, four a side: means of the
/// corners at middle nodes.
std::vector<double> with_middle_factors(std::span<const double> of_corners, int each);

}  // namespace hextwist::io
