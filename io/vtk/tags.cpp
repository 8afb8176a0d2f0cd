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

/// A reference by number (&#9; &#x3b1;) at the beginning of a text: adds the character in UTF-8. The length of the
/// reference, 0: there is none.
std::size_t add_character(std::string_view text, std::string& to) {
  if (!text.starts_with("&#")) return 0;
  const bool hex = text.substr(2, 1) == "x";
  const char* const from = text.data() + (hex ? 3 : 2);
  const char* const end = text.data() + text.size();
  std::uint32_t code = 0;
  const auto [stop, error] = from < end ? std::from_chars(from, end, code, hex ? 16 : 10) : std::from_chars_result{};
  if (from >= end || error != std::errc{} || stop == end || *stop != ';' || code == 0 || code > 0x10ffff) return 0;
  const auto put = [&](std::uint32_t byte) { to += static_cast<char>(byte); };
  const auto rest = [&](int shift) { put(0x80 | (code >> shift & 0x3f)); };
  if (code < 0x80) {
    put(code);
  } else if (code < 0x800) {
    put(0xc0 | code >> 6), rest(0);
  } else if (code < 0x10000) {
    put(0xe0 | code >> 12), rest(6), rest(0);
  } else {
    put(0xf0 | code >> 18), rest(12), rest(6), rest(0);
  }
  return static_cast<std::size_t>(stop + 1 - text.data());
}

}  // namespace

std::string unescaped(std::string_view text) {
  constexpr std::pair<std::string_view, char> entities[] = {
      {"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}};
  std::string result;
  while (!text.empty()) {
    if (const std::size_t length = add_character(text, result); length > 0) {
      text.remove_prefix(length);
      continue;
    }
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
      case '\t':
      case '\n':
      case '\r':
        result += "&#" + std::to_string(static_cast<int>(c)) + ";";
        break;
      default:
        result += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    }
  return result;
}

void say_unwritable(const Mesh& mesh, bool groups_too, std::vector<std::string>& notices) {
  const auto say = [&](const std::string& what, const std::string& name) {
    say_renamed(what, name, unescaped(escaped(name)), notices);
  };
  const auto groups = [&](const char* kind, const auto& all) {
    for (const auto& group : all) say(std::string(kind) + " " + std::to_string(group.id), group.name);
  };
  for (const Field& field : mesh.fields) say("field", field.name);
  if (!groups_too) return;
  groups("block", mesh.blocks);
  groups("nodeset", mesh.node_sets);
  groups("sideset", mesh.side_sets);
}

}  // namespace hextwist::io
