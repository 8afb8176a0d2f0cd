// An XDMF file as a tree of elements, and the files that it names.
#pragma once

#include <filesystem>

#include "hextwist/io/vtk/tags_internal.h"

namespace hextwist::io {

struct XmlElement {
  Tag tag;
  std::string_view text;  ///< before the first element inside of it
  std::vector<XmlElement> inside;

  const XmlElement* child(std::string_view name) const;
  /// Is that one of the elements right inside of it?
  bool has(const XmlElement& element) const {
    return &element >= inside.data() && &element < inside.data() + inside.size();
  }
  /// Attributes whose name has changed between versions: the first that is there.
  std::string_view either(std::string_view a, std::string_view b) const { return tag[a].empty() ? tag[b] : tag[a]; }
};

/// The root element. Throws Error.
XmlElement read_xdmf_tree(Cursor& cursor);

/// Calls f(element) for it and all inside of it, in the order of the file.
template <class F>
void each_element(const XmlElement& element, F&& f) {
  f(element);
  for (const XmlElement& child : element.inside) each_element(child, f);
}

/// What an element includes (XInclude) of other places of the same file: by a path of names with conditions,
/// `//Grid[@Name= "mesh"]/*[self::Topology or self::Geometry]`. Throws Error at those where there is nothing, and at
/// places that are said otherwise, unless these are to be passed over.
std::vector<const XmlElement*> xdmf_includes(const Cursor& cursor, const XmlElement& root, const XmlElement& element,
                                             bool odd_ones_too);

/// Where a data item has its numbers: "mesh.h5:/Mesh/geometry". dataset empty: the text is no such place.
struct HeavyPlace {
  std::string file, dataset;
};
HeavyPlace heavy_place(std::string_view text);
/// Of a file that an XDMF file names. Throws Error where it is not below the folder (Fence::folder).
std::filesystem::path heavy_file(const std::filesystem::path& xdmf, const std::string& name,
                                 const std::filesystem::path& folder);

}  // namespace hextwist::io
