// Which lines are run, how often and from where: loops, conditions and inclusion, as APREPRO has them.
//
//   {loop(3)}            the lines up to {endloop}, so many times
//   {if(n > 2)}          or {ifdef(n)} (n has a value other than 0), {ifndef(n)}; {elseif(...)}, {else}, {endif}
//   {include("a.jou")}   the lines of that file; {cinclude(...)} does nothing where it is not there
//
// Each stands alone on its line, also behind `#`. Case does not matter.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "hextwist/command/token.h"

namespace hextwist {

enum class Flow {
  none,
  loop,
  endloop,
  when,
  when_defined,
  when_undefined,
  otherwise_when,
  otherwise,
  endif,
  include,
  include_if_there,
  ignored,
  unknown
};

struct FlowLine {
  Flow kind = Flow::none;
  /// What stands between its parentheses: bytes into the source, and their number. 0: there are none.
  std::size_t offset = 0, length = 0;
};

/// What a statement says about the flow; none: it is a command or an expression.
FlowLine flow_of(const Statement& statement);

/// Is it a word that begins such a line: "loop", "endif", ...?
bool is_flow_word(std::string_view word);

/// Per statement the position that ends what it opens, or continues its condition: of loop its endloop, of if its
/// elseif, else or endif; of all others 0. Throws CommandError for the first that is opened and not closed, or closed
/// and not opened.
std::vector<std::size_t> flow_ends(std::span<const Statement> statements);

/// Is something opened here that more lines must close? A backslash at the end asks for more, too.
bool wants_more(std::string_view text);

}  // namespace hextwist
