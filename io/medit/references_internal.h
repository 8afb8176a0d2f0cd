// One number per element, as MEDIT has it, for elements that lie on a CAD entity and in any number of groups.
//
// Where one number can say it, it is the id of the group (or of the entity, if there are no groups). Everything else is
// said by comments that other programs skip:
//   # hextwist <kind> <id> <n> <reference>... <name to the end of the line>
#pragma once

#include <map>

#include "hextwist/io/middles.h"

namespace hextwist::io {

/// Middle nodes of HexahedraQ2 as they are written, beside the section HexahedraQ2Ordering that says so: the lower
/// ring, the upper ring, the pillars; faces below, above, front, right, back, left; the centre.
inline constexpr MiddleOrder medit_middles = middle_order(
    ring_ring_pillars, {{{1, 2, 3, 4}, {5, 6, 7, 8}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 4, 8, 7}, {4, 1, 5, 8}}});

/// Names of the kinds in comments.
struct ReferenceKinds {
  const char* group;   ///< "block", "sideset", ...
  const char* entity;  ///< "volume", "surface", ...
};

struct NamedGroup {
  int id;
  std::string name;
};

/// The reference of each class, and writes the comments that explain them.
std::vector<int> write_references(Output& out, const ReferenceKinds& kinds, const Classes& classes,
                                  std::span<const NamedGroup> groups, std::vector<std::string>& notices);

/// What comments of a file say: by kind and id.
struct ReferenceComments {
  struct Entry {
    std::string name;
    std::vector<int> references;
  };
  bool ours = false;  ///< the file was written by write_references()
  std::map<std::string, std::map<int, Entry>> entries;

  /// Takes in a comment line (without '#').
  void add(std::string_view comment, const Cursor& cursor);

  /// Groups of a kind and their references: those of comments, and one per positive reference that no comment
  /// mentions.
  std::map<int, Entry> groups(const ReferenceKinds& kinds, std::vector<int> references) const;
  /// Entity of each reference, 0 none.
  std::map<int, int> entities(const ReferenceKinds& kinds) const;
};

}  // namespace hextwist::io
