#include "hextwist/io/vtk/tags_internal.h"

#include <algorithm>

namespace hextwist::io {
namespace {

Tag parse(std::string_view text, const char* at, const Cursor& cursor) {
  Tag tag;
  tag.at = at;
  if (text.starts_with('/')) {
    tag.closing = true;
    text.remove_prefix(1);
  }
  if (text.ends_with('/')) {
    tag.empty = true;
    text.remove_suffix(1);
  }
  std::size_t end = 0;
  while (end < text.size() && !Cursor::blank(text[end])) ++end;
  tag.name = text.substr(0, end);
  text = trimmed(text.substr(end));
  while (!text.empty()) {
    const auto equals = text.find('=');
    if (equals == std::string_view::npos) break;
    const std::string key(trimmed(text.substr(0, equals)));
    text = trimmed(text.substr(equals + 1));
    if (text.empty() || (text[0] != '"' && text[0] != '\'')) cursor.fail_at(at, "a broken tag");
    const auto close = text.find(text[0], 1);
    if (close == std::string_view::npos) cursor.fail_at(at, "a broken tag");
    tag.attributes[key] = unescaped(text.substr(1, close - 1));
    text = trimmed(text.substr(close + 1));
  }
  return tag;
}

}  // namespace

std::string unescaped(std::string_view text) {
  constexpr std::pair<std::string_view, char> entities[] = {
      {"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}};
  std::string result;
  while (!text.empty()) {
    const auto* found = std::ranges::find_if(entities, [&](const auto& e) { return text.starts_with(e.first); });
    const bool known = found != std::end(entities);
    result += known ? found->second : text[0];
    text.remove_prefix(known ? found->first.size() : 1);
  }
  return result;
}

std::optional<Tag> next_tag(Cursor& cursor, const char* end) {
  for (;;) {
    const auto* open = static_cast<const char*>(std::memchr(cursor.at, '<', static_cast<std::size_t>(end - cursor.at)));
    if (!open) return {};
    const std::string_view rest(open, end);
    if (rest.starts_with("<!--")) {
      const auto close = rest.find("-->");
      if (close == std::string_view::npos) return {};
      cursor.at = open + close + 3;
      continue;
    }
    const auto close = rest.find('>');
    if (close == std::string_view::npos) cursor.fail_at(open, "the file ends inside a tag");
    cursor.at = open + close + 1;
    return parse(rest.substr(1, close - 1), open, cursor);
  }
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    }
  return result;
}

}  // namespace hextwist::io
