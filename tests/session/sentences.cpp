#include "session/sentences.h"

#include <algorithm>
#include <cmath>

#include "hextwist/command/select/criterion.h"

namespace hextwist::test {
std::string Sentences::sentence(const CommandSpec& command) {
  command_ = &command;
  after_range_ = false;
  std::string text;
  sequence(compile_pattern(command.syntax), text);
  return text;
}

/// Not planned; and not a kind right behind a range, where it would be one more kind after `in`.
bool Sentences::usable(const Pattern& choice) const {
  const PatternNode& first = choice.front();
  if (first.kind == PatternNode::Kind::word) return !first.planned && !(after_range_ && entity_kind(first.name));
  if (first.kind == PatternNode::Kind::one_of)
    return std::ranges::any_of(first.choices, [&](const Pattern& inner) { return usable(inner); });
  return true;
}

void Sentences::sequence(const Pattern& pattern, std::string& text) {
  for (const PatternNode& each : pattern) node(each, text);
}

void Sentences::node(const PatternNode& node, std::string& text) {
  switch (node.kind) {
    case PatternNode::Kind::word:
      text += (text.empty() ? "" : " ") + node.name;
      for (int k = 0; k < n_entity_kinds; ++k)
        if (node.name == hextwist::name(static_cast<EntityKind>(k))) kind_ = static_cast<EntityKind>(k);
      after_range_ = false;
      break;
    case PatternNode::Kind::argument:
      value(*std::ranges::find(command_->arguments, node.name, &ArgumentSpec::name), text);
      break;
    case PatternNode::Kind::one_of: {
      std::vector<const Pattern*> choices;
      for (const Pattern& choice : node.choices)
        if (usable(choice)) choices.push_back(&choice);
      sequence(*choices.at(static_cast<std::size_t>(below(static_cast<int>(choices.size())))), text);
      break;
    }
    case PatternNode::Kind::options: {
      std::vector<const Pattern*> choices;
      for (const Pattern& choice : node.choices) choices.push_back(&choice);
      std::ranges::shuffle(choices, random_);
      for (const Pattern* choice : choices)
        if (one_in(3) && usable(*choice)) sequence(*choice, text);
      break;
    }
    case PatternNode::Kind::repeated:
      do {
        after_range_ = false;
        const std::size_t from = text.size();
        sequence(node.choices.front(), text);
        // Kinds behind `in` would belong there.
        if (text.find(" in ", from) != std::string::npos || text.find(" common_to ", from) != std::string::npos) break;
      } while (one_in(3));
  }
}

void Sentences::value(const ArgumentSpec& argument, std::string& text) {
  std::string said = value_text ? value_text(*command_, argument) : "";
  using Kind = ArgumentSpec::Kind;
  if (said.empty()) switch (argument.kind) {
      case Kind::range:
        said = range(kind_);
        break;
      case Kind::integer: {
        const double low = std::max(argument.min, -1e6), high = std::min({argument.max, 1e9, low + 20});
        said = std::to_string(static_cast<long>(low) + below(static_cast<int>(high - low) + 1));
        break;
      }
      case Kind::number: {
        const double low = std::max(argument.min, -1e3), high = std::min(argument.max, low + 2e3);
        const double at = low + (high - low) * (1 + below(998)) / 1000;
        said = one_in(2) ? std::to_string(at) : std::to_string(std::clamp(std::ceil(at), low, high));
        break;
      }
      case Kind::string:
        said = "\"" + name() + "\"";
        break;
      case Kind::file:
        said = one_in(2) ? "\"a file of " + name() + ".msh\"" : "dir/" + name() + ".e";
        break;
      case Kind::word:
        said = name();
    }
  text += " " + said;
  after_range_ = argument.kind == Kind::range;
}

std::string Sentences::name() {
  static const std::vector<std::string> names = {"inlet", "rim2", "part_a", "wall", "left"};
  return names[static_cast<std::size_t>(below(static_cast<int>(names.size())))];
}

std::string Sentences::item(EntityKind kind) {
  const auto id = [&] { return std::to_string(1 + below(max_id)); };
  switch (below(8)) {
    case 0: {
      const int first = 1 + below(max_id);
      std::string text = std::to_string(first) + " to " + std::to_string(first + below(max_id));
      if (one_in(2)) text += (one_in(2) ? " by " : " step ") + id();
      return text;
    }
    case 1:
      if (has_names(kind) && plain_names) return (one_in(2) ? "\"" : "'*") + name() + "\"";
      return id();
    case 2:
      return "(at " + std::to_string(below(9) - 4) + (one_in(2) ? ", " : " ") + "0.5 -1e-1" +
             (one_in(3) ? " ordinal " + std::to_string(1 + below(2)) : "") + ")";
    default:
      return id();
  }
}

std::string Sentences::range(EntityKind kind, int depth, bool whole) {
  const bool leaf = depth >= max_depth;
  std::string text;
  if (leaf || !one_in(4)) {
    if (one_in(4)) {
      text = "all";
    } else {
      for (int n = 1 + below(3); n > 0; --n) {
        std::string next = item(kind);
        if (next.starts_with("'")) next.back() = '\'';
        text += (text.empty() ? "" : one_in(5) ? ", " : " ") + next;
      }
    }
    if (one_in(5)) {
      text += " except ";
      if (!leaf && one_in(3)) {
        const std::string word = std::string(hextwist::name(kind)) + " ";
        text += one_in(2) ? "(" + word + range(kind, depth + 1) + ")" : word + range(kind, depth + 1, whole);
      } else {
        text += std::to_string(1 + below(max_id));
      }
    }
  }
  // A plain term leaves `with` to the range around it, unless it begins with that.
  const bool bare = text.empty();
  const int n_filters = leaf ? 0 : bare ? 1 + below(2) : below(2);
  for (int i = 0; i < n_filters; ++i) {
    if (!text.empty()) text += " ";
    if (one_in(3) && (whole || (bare && i == 0))) {
      text += "with " + criterion(kind);
      continue;
    }
    text += one_in(3) ? "common_to" : "in";
    for (int n = one_in(3) ? 2 : 1; n > 0; --n) text += " " + term(depth + 1);
  }
  return text;
}

std::string Sentences::term(int depth) {
  const EntityKind kind = any_kind();
  const std::string word = std::string(hextwist::name(kind)) + " ";
  if (!one_in(3)) return word + range(kind, depth, false);
  const std::string inside = word + range(kind, depth);
  return one_in(2) && plain_names ? "(\"" + name() + "\" " + inside + ")" : "(" + inside + ")";
}

std::string Sentences::number(EntityKind kind, int depth) {
  if (depth < 2 && one_in(5)) {
    static const std::vector<std::string> signs = {" + ", " - ", "-", " * ", "*", " / ", "/"};
    return (one_in(2) ? "(" : "(-") + number(kind, depth + 1) + signs[static_cast<std::size_t>(below(7))] +
           number(kind, depth + 1) + ")";
  }
  if (one_in(3)) return std::to_string(below(9) - 4) + (one_in(2) ? ".5" : "");
  std::vector<const AttributeSpec*> known;
  for (const AttributeSpec& spec : attributes())
    if ((spec.kinds >> static_cast<int>(kind) & 1) && !spec.is_truth) known.push_back(&spec);
  const AttributeSpec& spec = *known[static_cast<std::size_t>(below(static_cast<int>(known.size())))];
  std::string text(spec.word);
  if (spec.attribute == Attribute::quality) return text + (one_in(2) ? " shape" : " scaled jacobian");
  if (one_in(6)) text += " of " + std::string(hextwist::name(kind)) + " " + std::to_string(1 + below(max_id));
  return text;
}

std::string Sentences::criterion(EntityKind kind, int depth) {
  if (depth < 3 && one_in(3)) {
    const std::string left = criterion(kind, depth + 1), right = criterion(kind, depth + 1);
    switch (below(4)) {
      case 0:
        return left + " and " + right;
      case 1:
        return left + " or with " + right;
      case 2:
        return "(" + left + " or " + right + ")";
      default:
        return "not " + left;
    }
  }
  if (one_in(5)) {
    std::vector<const AttributeSpec*> known;
    for (const AttributeSpec& spec : attributes())
      if ((spec.kinds >> static_cast<int>(kind) & 1) && spec.is_truth && spec.attribute != Attribute::name)
        known.push_back(&spec);
    if (!known.empty()) {
      const std::string word(known[static_cast<std::size_t>(below(static_cast<int>(known.size())))]->word);
      return one_in(2) ? word : word + " = " + (one_in(2) ? "true" : "no");
    }
    if (has_names(kind)) return "name " + std::string(one_in(2) ? "<> " : "") + "\"" + name() + "*\"";
  }
  static const std::vector<std::string> signs = {" < ", " <= ", " > ", ">=", " = ", "==", "<>"};
  const auto sign = static_cast<std::size_t>(below(7));
  std::string text = number(kind, depth) + signs[sign] + number(kind, depth);
  if (sign >= 4 && one_in(3)) text += " tolerance 1e-3";
  return text;
}

}  // namespace hextwist::test
