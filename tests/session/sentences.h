// Random sentences of the command language, made from the language's own tables: whatever is added there is tried here.
#pragma once

#include <functional>
#include <random>
#include <string>

#include "hextwist/command/pattern_internal.h"
#include "hextwist/command/syntax.h"

namespace hextwist::test {

class Sentences {
 public:
  /// Text for a value; "" leaves it to the generator.
  using ValueText = std::function<std::string(const CommandSpec&, const ArgumentSpec&)>;

  explicit Sentences(unsigned seed) : random_(seed) {}

  std::mt19937& random() { return random_; }
  /// Of all values: what is not wanted at random.
  ValueText value_text;
  int max_id = 12;          ///< ids in ranges are 1 .. this
  int max_depth = 3;        ///< of ranges within ranges
  bool plain_names = true;  ///< names of entities that need not exist

  /// A sentence of the command that follows its syntax.
  std::string sentence(const CommandSpec& command);
  /// A range of a kind, without the kind; not whole: as it may stand behind `in` without parentheses.
  std::string range(EntityKind kind, int depth = 0, bool whole = true);
  std::string criterion(EntityKind kind, int depth = 0);

  int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
  bool one_in(int n) { return below(n) == 0; }

 private:
  std::mt19937 random_;
  const CommandSpec* command_ = nullptr;
  EntityKind kind_ = EntityKind::hex;
  bool after_range_ = false;

  void sequence(const Pattern& pattern, std::string& text);
  void node(const PatternNode& node, std::string& text);
  void value(const ArgumentSpec& argument, std::string& text);
  bool usable(const Pattern& choice) const;
  std::string item(EntityKind kind);
  std::string term(int depth);
  std::string number(EntityKind kind, int depth);
  std::string name();
  EntityKind any_kind() { return static_cast<EntityKind>(below(n_entity_kinds)); }
};

}  // namespace hextwist::test
