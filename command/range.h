// Ranges as written: `1 3 to 17 by 2 except 5 in volume 2`. What they mean is decided in selection.h.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hextwist/command/entity.h"
#include "hextwist/command/token.h"

namespace hextwist {

/// One id, one span of ids, a name, or everything.
struct RangeItem {
  enum class Kind { id, span, name, all };
  Kind kind = Kind::all;
  std::int64_t first = 0, last = 0, step = 1;  ///< of an id (first) or a span
  std::string name;
  Token token;       ///< where it starts
  Token last_token;  ///< of a span: its end
};

struct RangeTerm;

/// (items minus except) that lie in any of `in`. No items: all.
/// `except` and `in` belong to the list of ids before them: in `hex in volume all except 5` it is volume 5.
struct Range {
  std::vector<RangeItem> items;
  std::vector<RangeItem> except;
  std::vector<RangeTerm> in;
  Token token;  ///< where the range starts
};

/// A kind of entity and which of them: `volume 2`.
struct RangeTerm {
  EntityKind kind = EntityKind::hex;
  Range range;
};

/// The range as the language writes it; parsing that gives the same range.
std::string to_string(const Range& range);

}  // namespace hextwist
