#include "hextwist/base/fence.h"
#include "hextwist/io/xdmf/xml_internal.h"

namespace hextwist::io {
namespace {

constexpr int deepest = 50;

/// What is inside of an element whose tag has been read.
void read_inside(Cursor& cursor, XmlElement& element, int depth) {
  if (element.tag.empty) return;
  if (depth > deepest) cursor.fail_at(element.tag.at, "elements are nested too deeply");
  const char* from = cursor.at;
  for (;;) {
    const auto tag = next_tag(cursor, cursor.end);
    if (!tag) cursor.fail_truncated("the end of " + shown(element.tag.name));
    if (element.inside.empty() && element.text.empty()) element.text = {from, tag->at};
    if (tag->closing) {
      if (tag->name != element.tag.name)
        cursor.fail_at(tag->at,
                       "expected the end of " + shown(element.tag.name) + ", found that of " + shown(tag->name));
      return;
    }
    if (tag->name.starts_with('!') || tag->name.starts_with('?')) continue;
    XmlElement& child = element.inside.emplace_back();
    child.tag = *tag;
    read_inside(cursor, child, depth + 1);
  }
}

/// The text before a slash that is neither in quotes nor in brackets; both are taken away.
std::string_view cut_step(std::string_view& text) {
  std::size_t end = 0;
  char quote = 0;
  for (int depth = 0; end < text.size() && (text[end] != '/' || quote || depth > 0); ++end) {
    const char c = text[end];
    if (quote)
      quote = c == quote ? 0 : quote;
    else if (c == '"' || c == '\'')
      quote = c;
    else
      depth += c == '[' ? 1 : c == ']' ? -1 : 0;
  }
  const std::string_view step = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return step;
}

/// One of "Grid", "Grid[2]", "Grid[@Name='mesh']", "*[self::Topology or self::Geometry]".
struct PathStep {
  std::string_view name, attribute, value;
  std::vector<std::string_view> kinds;
  std::int64_t number = 0;  ///< 0: all
};
std::optional<PathStep> path_step(std::string_view text) {
  PathStep step;
  const auto open = text.find('[');
  step.name = trimmed(text.substr(0, open));
  if (step.name.empty()) return {};
  if (open == std::string_view::npos) return step;
  text = trimmed(text);
  if (!text.ends_with(']')) return {};
  std::string_view condition = trimmed(text.substr(open + 1, text.size() - open - 2));
  if (condition.starts_with('@')) {
    const auto equals = condition.find('=');
    if (equals == std::string_view::npos) return {};
    step.attribute = trimmed(condition.substr(1, equals - 1));
    step.value = trimmed(condition.substr(equals + 1));
    if (step.value.size() < 2 || step.value.front() != step.value.back() ||
        (step.value[0] != '"' && step.value[0] != '\'') || step.value.find(step.value[0], 1) != step.value.size() - 1)
      return {};
    step.value = step.value.substr(1, step.value.size() - 2);
    return step;
  }
  constexpr std::string_view self = "self::";
  if (!condition.starts_with(self)) {
    const auto [stop, error] = std::from_chars(condition.data(), condition.data() + condition.size(), step.number);
    return error == std::errc{} && stop == condition.data() + condition.size() && step.number > 0 ? std::optional(step)
                                                                                                  : std::nullopt;
  }
  for (;;) {
    if (!condition.starts_with(self)) return {};
    condition.remove_prefix(self.size());
    const auto end = std::min(condition.find_first_of(" \t\r\n"), condition.size());
    step.kinds.push_back(condition.substr(0, end));
    condition = trimmed(condition.substr(end));
    if (condition.empty()) return step;
    if (!condition.starts_with("or ")) return {};
    condition = trimmed(condition.substr(3));
  }
}

/// Elements inside of one that a step names are added.
void add_inside(const XmlElement& from, const PathStep& step, std::vector<const XmlElement*>& to) {
  std::int64_t n = 0;
  for (const XmlElement& child : from.inside)
    if ((step.name == "*" || child.tag.name == step.name) &&
        (step.attribute.empty() || child.tag[step.attribute] == step.value) &&
        (step.kinds.empty() || std::ranges::find(step.kinds, child.tag.name) != step.kinds.end()) &&
        (step.number == 0 || ++n == step.number))
      to.push_back(&child);
}

/// What an XPointer names; nothing where it is not of the kind that is understood.
std::optional<std::vector<const XmlElement*>> at_pointer(const XmlElement& root, std::string_view pointer) {
  constexpr std::string_view scheme = "xpointer(";
  pointer = trimmed(pointer);
  if (pointer.starts_with(scheme) && pointer.ends_with(')'))
    pointer = trimmed(pointer.substr(scheme.size(), pointer.size() - scheme.size() - 1));
  if (!pointer.starts_with('/')) return {};
  std::vector<const XmlElement*> at;
  bool first = true;
  while (!pointer.empty()) {
    const bool anywhere = first && pointer.starts_with("//");
    if (first) pointer.remove_prefix(anywhere ? 2 : 1);
    const auto step = path_step(cut_step(pointer));
    if (!step) return {};
    std::vector<const XmlElement*> next;
    if (first) {
      if (step->name == root.tag.name && step->attribute.empty() && step->kinds.empty() && step->number <= 1)
        next.push_back(&root);
      if (anywhere) each_element(root, [&](const XmlElement& element) { add_inside(element, *step, next); });
    } else {
      for (const XmlElement* element : at) add_inside(*element, *step, next);
    }
    at = std::move(next);
    first = false;
  }
  return at;
}

}  // namespace

const XmlElement* XmlElement::child(std::string_view name) const {
  const auto found = std::ranges::find(inside, name, [](const XmlElement& element) { return element.tag.name; });
  return found == inside.end() ? nullptr : &*found;
}

XmlElement read_xdmf_tree(Cursor& cursor) {
  XmlElement root;
  while (const auto tag = next_tag(cursor, cursor.end)) {
    if (tag->name.starts_with('!') || tag->name.starts_with('?')) continue;
    if (tag->name != "Xdmf" || tag->closing)
      cursor.fail_at(tag->at, "not an XDMF file: it begins with " + shown(tag->name));
    root.tag = *tag;
    read_inside(cursor, root, 0);
    return root;
  }
  cursor.fail_at(cursor.begin, "not an XDMF file");
}

std::vector<const XmlElement*> xdmf_includes(const Cursor& cursor, const XmlElement& root, const XmlElement& element,
                                             bool odd_ones_too) {
  std::vector<const XmlElement*> result;
  for (const XmlElement& include : element.inside) {
    if (include.tag.name != "include" && !include.tag.name.ends_with(":include")) continue;
    if (const std::string_view other = include.tag["href"]; !other.empty())
      cursor.fail_at(include.tag.at, "includes a part of " + shown(other) + ", and only the file itself is read");
    const std::string_view pointer = include.tag["xpointer"];
    const auto found = at_pointer(root, pointer);
    if (!found && odd_ones_too) continue;
    if (!found) cursor.fail_at(include.tag.at, "the include " + shown(pointer) + " is not understood");
    if (found->empty()) cursor.fail_at(include.tag.at, "the include " + shown(pointer) + " leads to nothing");
    result.insert(result.end(), found->begin(), found->end());
  }
  return result;
}

HeavyPlace heavy_place(std::string_view raw) {
  const std::string whole = unescaped(trimmed(raw));
  const std::string_view text = whole;
  const auto colon = text.rfind(":/");
  if (colon == std::string_view::npos || colon == 0) {
    // Some leave the slash out.
    const auto other = text.rfind(':');
    if (other == std::string_view::npos || other == 0 || other + 1 == text.size()) return {};
    return {std::string(text.substr(0, other)), "/" + std::string(text.substr(other + 1))};
  }
  return {std::string(text.substr(0, colon)), std::string(text.substr(colon + 1))};
}

std::filesystem::path heavy_file(const std::filesystem::path& xdmf, const std::string& name,
                                 const std::filesystem::path& folder) {
  const std::filesystem::path file = xdmf.parent_path() / name;
  if (!folder.empty() && !is_below(folder, file))
    throw Error(xdmf.string() + ": names " + shown(name) + ", and files may be read below " + folder.string() +
                " only");
  return file;
}

}  // namespace hextwist::io
