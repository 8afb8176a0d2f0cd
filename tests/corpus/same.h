// Whether a mesh that was written and read back is the one that it was.
#pragma once

#include <limits>
#include <span>
#include <string>

#include "hextwist/mesh/mesh.h"

namespace hextwist::corpus {

struct FileKind {
  const char* name;                                                    ///< of the file
  const char* options;                                                 ///< of `export mesh`
  bool bits = true;                                                    ///< of coordinates
  std::int64_t highest_id = std::numeric_limits<std::int64_t>::max();  ///< ids beyond are not kept
  bool group_ids = true;
  bool fields = false;
};
std::span<const FileKind> file_kinds();

/// What differs, empty when nothing does: places, hexes, ids, members of blocks and sets that are not empty, fields.
std::string difference(const Mesh& written, const Mesh& back, const FileKind& kind);

/// Nodes at one place: cracks and contact, along which both sides may be cut differently.
bool has_doubled_nodes(const Mesh& mesh);

}  // namespace hextwist::corpus
