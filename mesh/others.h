// Elements beside the hexes: wedges, pyramids, tetrahedra, shells, beams, masses, connectors. They are read, kept and
// written; nothing is computed on them.
//
// What a file says of them never changes and is shared by all meshes that come of it (OtherHeads). What may change is
// which nodes they have, since quads and lines that lie on hexes are cut where these are (refine/others.h).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hextwist/mesh/mesh.h"

namespace HEXTWIST_API hextwist {

/// Where an element has edges and faces: its corners come first, in the order that VTK, Exodus and Abaqus share.
enum class OtherShape : std::uint8_t {
  point,        ///< a mass, a spring to the ground
  line,         ///< a beam, a truss
  triangle,     ///< of a shell, a membrane
  quad,         ///< likewise
  tetrahedron,  ///< base, then tip
  pyramid,      ///< base, then tip
  wedge,        ///< two triangles
  connector,    ///< nodes without edges between them: springs, rigid links
};
/// "point", "line", ... in the singular.
const char* name(OtherShape shape);
/// Corners of a shape; 0 of a connector, which has any number of nodes.
int n_corners(OtherShape shape);

/// What a file calls elements of one kind.
struct OtherType {
  OtherShape shape = OtherShape::point;  ///< corners, edges, faces
  /// Nodes of the shape: its corners, and middle nodes where there are more. What an element has beyond them (a node
  /// that says which way a beam lies) belongs to no edge or face.
  int n_nodes = 1;
  std::string name;  ///< "S4R", "SHELL4", "CQUAD4"; empty where the file has no names
  /// Equal in everything.
  bool operator==(const OtherType&) const = default;
};

/// Other elements of a block, by their place in OtherHeads::ids.
struct OtherSet {
  int id = 0;                   ///< of a block of the mesh (perhaps without hexes), which has the name; gone with it
  std::vector<Index> elements;  ///< ascending
  /// Equal in everything.
  bool operator==(const OtherSet&) const = default;
};

/// Sides of other elements in a side set.
struct OtherSides {
  int id = 0;                      ///< of a side set of the mesh (perhaps without sides of hexes), likewise
  std::vector<Index> elements;     ///< by their place in OtherHeads::ids
  std::vector<std::string> sides;  ///< of each: which, as the file calls it ("SPOS", "S3", "2")
  /// Equal in everything.
  bool operator==(const OtherSides&) const = default;
};

/// Values per element: values[i * components + c], NaN where there is none.
struct OtherField {
  std::string name;            ///< as the file knows it
  int components = 1;          ///< per element
  std::vector<double> values;  ///< of all elements of the file
  bool is_attribute = false;   ///< a property (thickness, section) instead of a result
  bool integer = false;        ///< numbers of things
};

/// What a file says of its other elements, in its order. All lists are per element unless they say otherwise.
struct OtherHeads {
  std::vector<OtherType> types;        ///< of elements of each kind
  std::vector<int> type;               ///< which of `types`
  std::vector<std::int64_t> ids;       ///< each once, none of a hex
  std::vector<OtherSet> sets;          ///< ascending by id
  std::vector<OtherSides> sides;       ///< ascending by id
  std::vector<OtherField> fields;      ///< in any order
  std::vector<std::string> rest;       ///< what the file says of each beyond that, in its own words; may be empty
  std::string format;                  ///< the format that type names and `rest` are of: "abaqus"
  std::vector<std::uint8_t> is_rigid;  ///< 1: pieces of it would not have what is said of it; may be empty
};

/// The other elements of a mesh.
struct OtherElements {
  std::shared_ptr<const OtherHeads> heads;  ///< never null
  std::vector<Index> of;                    ///< per element: that of the file that it is or is a piece of; ascending
  std::vector<Index> first;                 ///< per element, and one more: where its nodes begin
  std::vector<Index> nodes;                 ///< of all elements, one after the other

  /// Number of elements.
  Index size() const { return static_cast<Index>(of.size()); }
  /// Nodes of an element.
  std::span<const Index> nodes_of(Index element) const {
    return {nodes.data() + first[element], static_cast<std::size_t>(first[element + 1] - first[element])};
  }
  /// What the file calls it.
  const OtherType& type_of(Index element) const { return heads->types[heads->type[of[element]]]; }
  /// Is it an element of the file, not a piece of one?
  bool is_whole(Index element) const {
    return (element == 0 || of[element - 1] != of[element]) &&
           (element + 1 == size() || of[element + 1] != of[element]);
  }
  /// Its id; 0 of a piece, which has none before it is written.
  std::int64_t id(Index element) const { return is_whole(element) ? heads->ids[of[element]] : 0; }
};
using OtherElementsPtr = std::shared_ptr<const OtherElements>;  ///< null: there are none

/// The elements that a file has: `of` counts from 0. Throws Error where that does not fit together: it is for readers.
OtherElementsPtr other_elements(OtherHeads heads, std::vector<Index> first, std::vector<Index> nodes);

/// Corners (places in the list of nodes) at the ends of each edge.
std::span<const std::array<std::int8_t, 2>> other_edges(OtherShape shape);
/// Corners around each face, counter-clockwise seen from outside; the fourth -1 of a triangle.
std::span<const std::array<std::int8_t, 4>> other_faces(OtherShape shape);

/// Number of other elements.
Index n_others(const Mesh& mesh);
/// "12 quads (S4), 3 wedges (C3D6)"; empty where there are none.
std::string others_text(const Mesh& mesh);
/// "wedge 301 (C3D6, block 'glue')": for messages about one.
std::string other_text(const Mesh& mesh, Index element);
/// The highest id of a hex or another element, 0 without either: new hexes count on from there.
std::int64_t highest_element_id(const Mesh& mesh);
/// The element with an id of the file, -1 where there is none, or only pieces of it.
Index find_other(const Mesh& mesh, std::int64_t id);
/// Per node: is it of another element? Empty where there are none.
std::vector<std::uint8_t> nodes_of_others(const Mesh& mesh);
/// These nodes (in any order) and those of other elements, ascending.
std::vector<Index> with_nodes_of_others(const Mesh& mesh, std::vector<Index> nodes);
/// The elements by other numbers of their nodes; the same where nothing has another.
OtherElementsPtr renumbered(const OtherElementsPtr& others, std::span<const Index> node_now);

}  // namespace hextwist
