// Lines of journals for full meshers and their displays that are no commands here.
//
// What only shows, logs or sets up a display is skipped; what would have made geometry, a mesh or loads is refused,
// with what to do instead. Commands of our own go first: a line is looked up here when it is none.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "hextwist/command/syntax.h"
#include "hextwist/command/token.h"

namespace hextwist {

struct Foreign {
  bool is_skipped = false;  ///< false: refused
  std::string said;         ///< the words that it was known by
  /// Why, or what to do instead; of a line that is skipped it may be empty.
  std::string_view text;
};

/// nullopt: the line is none of these.
std::optional<Foreign> foreign_line(const Statement& statement);

/// parse(), also of lines of other programs: one that is skipped is returned. Throws CommandError for what is refused.
std::optional<Foreign> parse_or_skip(const Statement& statement, Command& command);
/// What is to be said of a line that is skipped.
std::string skipped_text(const Foreign& foreign);

}  // namespace hextwist
