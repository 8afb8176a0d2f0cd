// Expressions in braces within commands: `refine curve {id} size {h / 2}`, `import mesh "part_{n}.msh"`, `#{h = 0.5}`.
//
// What stands between braces is replaced by its value, also within quotes; `\{` within quotes is a brace. A line may be
// expressions alone; behind `#` they are evaluated when they stand right there.
#pragma once

#include <optional>

#include "hextwist/command/expression.h"
#include "hextwist/command/token.h"

namespace hextwist {

struct Expanded {
  /// The command with values instead of braces; each token knows where its text came from. nullopt: there was no
  /// command, only expressions.
  std::optional<Statement> statement;
  std::vector<std::string> lines;  ///< of expressions alone: "h = 0.5"
};

/// True if anything in the statement is to be replaced.
bool has_braces(const Statement& statement);

/// The value of so many bytes of its source. Throws CommandError pointing into them.
Value value_within(const Statement& statement, std::size_t offset, std::size_t length, Variables& variables);

/// Throws CommandError pointing into the braces; the variables are then as they were.
Expanded expand(const Statement& statement, Variables& variables);

}  // namespace hextwist
