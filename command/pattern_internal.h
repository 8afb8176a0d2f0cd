// Compiled syntax text: see syntax.h for the notation.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hextwist {

struct PatternNode {
  enum class Kind { word, argument, one_of, options, repeated };
  Kind kind = Kind::word;
  std::string name;                               ///< of a word or argument
  bool planned = false;                           ///< of a word: an error of its own
  bool hidden = false;                            ///< of a word: an old spelling, understood in full only
  std::vector<std::vector<PatternNode>> choices;  ///< of one_of and options: sequences; of repeated: one
};
using Pattern = std::vector<PatternNode>;

/// Precondition: well-formed text; asserts otherwise.
Pattern compile_pattern(std::string_view syntax);

/// The same in text, planned parts left out.
std::string to_string(const Pattern& pattern);

}  // namespace hextwist
