// Tags of XML, as VTK and XDMF have them, and arrays that are written below such tags.
#pragma once

#include <map>
#include <optional>

#include "hextwist/io/format.h"
#include "hextwist/io/vtk/escaped.h"

namespace hextwist::io {

/// One <tag ...>; attributes with their entities replaced.
struct Tag {
  std::string_view name;
  std::map<std::string, std::string, std::less<>> attributes;
  bool closing = false, empty = false;
  const char* at = nullptr;

  std::string_view operator[](std::string_view key) const {
    const auto found = attributes.find(key);
    return found == attributes.end() ? std::string_view{} : std::string_view(found->second);
  }
};

/// The next tag before `end`, comments skipped. Throws Error at what is broken.
std::optional<Tag> next_tag(Cursor& cursor, const char* end);
/// Text with its entities (&amp; &lt; ...) replaced.
std::string unescaped(std::string_view text);
/// Tells the names of fields that this changes, and of groups where they are written so too.
void say_unwritable(const Mesh& mesh, bool groups_too, std::vector<std::string>& notices);

}  // namespace hextwist::io
