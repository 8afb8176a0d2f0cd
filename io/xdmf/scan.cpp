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
