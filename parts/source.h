// The parts of a mesh on disk: files that it is split into, or what a file of the whole is divided into, slice by
// slice.
#pragma once

#include "hextwist/io/slice.h"
#include "hextwist/parts/files.h"
#include "hextwist/parts/on_disk_internal.h"

namespace hextwist {

/// "what.e: is read in slices without 2 more time steps"; empty: nothing is lost.
std::string lost_text(const MeshSlice& slice, const std::filesystem::path& file);

/// The first hex that is in two blocks, -1 where there is none.
Index in_two_blocks(const Mesh& mesh);

class PartSource {
 public:
  /// Any part of a split mesh. Throws Error where the name is none of such a file.
  PartSource(const std::filesystem::path& any_part, const Fence& fence);
  /// A file of the whole, read in slices no larger than a part, or of 100,000 hexes; what each part has of each slice
  /// is put aside, so that there is one slice in memory, and 40 bytes for each hex of the whole while it is divided.
  /// Not by SCOTCH. Nothing where such a file is not read in slices (io/slice.h), its blocks overlap, or, to be joined
  /// again, slices leave something out: why is told. Throws Error as well for what is not to be refined
  /// (refuse_more()).
  static std::optional<PartSource> divide(const std::filesystem::path& file, int n_parts, PartitionBy by,
                                          const Aside& aside, const Fence& fence, PartUse use, Unsliced& why);

  int n_parts() const { return n_parts_; }
  const std::filesystem::path& whole() const { return whole_; }
  /// What messages call a part.
  std::string name(int part) const;
  /// first: as in read_one_part().
  Mesh read(int part, PartHead& first, std::vector<std::string>& notices) const;
  /// Nodes of no hex may be missing from the parts.
  bool is_divided() const { return aside_ != nullptr; }
  /// What parts keep of a file that is divided.
  const std::shared_ptr<const FileResults>& results() const { return results_; }
  /// Id, where nodes of no hex may be missing; else 0.
  std::int64_t highest_node() const { return highest_node_; }

 private:
  PartSource() = default;
  std::filesystem::path whole_;
  int n_parts_ = 0, n_slices_ = 0;
  Fence fence_;
  const Aside* aside_ = nullptr;  // where the pieces of a file that was divided are
  std::int64_t n_nodes_ = 0, n_hexes_ = 0, highest_node_ = 0;
  std::vector<std::string> notices_;
  std::shared_ptr<const FileResults> results_;
};

}  // namespace hextwist
