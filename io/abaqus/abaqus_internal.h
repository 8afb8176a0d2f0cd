// Abaqus input files: what the keywords say, before it becomes a mesh.
#pragma once

#include <map>
#include <memory>
#include <optional>

#include "hextwist/io/middles.h"
#include "hextwist/mesh/others.h"

namespace hextwist::io {

/// Faces S1..S6 of a C3D8 by their nodes (Abaqus Elements Guide, "Three-dimensional solid element library").
inline constexpr std::array<int, 6> abaqus_face = {
    face_of_file_corners({1, 2, 3, 4}), face_of_file_corners({5, 8, 7, 6}), face_of_file_corners({1, 5, 6, 2}),
    face_of_file_corners({2, 6, 7, 3}), face_of_file_corners({3, 7, 8, 4}), face_of_file_corners({4, 8, 5, 1})};

/// CalculiX reads 20 characters of a number and takes the rest for blanks; Abaqus as many.
inline constexpr std::size_t abaqus_number_width = 20;

/// What a type is to us. Names: C3D8R, AC3D20, S4R, T3D2, MASS, ...
struct AbaqusElement {
  enum Kind {
    hex,      ///< of 8, 20 or 27 nodes
    other,    ///< kept beside the hexes
    unknown,  ///< likewise, by its nodes alone
    refused
  } kind;
  OtherShape shape;  ///< of `other`
  int n_nodes;       ///< 0: any number
};
AbaqusElement abaqus_element(std::string_view type);
/// A line with a middle node, which stands between its ends in these files.
inline bool is_bent_line(const OtherType& type) {
  return type.shape == OtherShape::line && type.n_nodes == 3;
}

/// A name or number as it stands in a set or surface; the instance it belongs to, where it says so.
struct AbaqusMember {
  std::string text;
  const char* at;
};

/// *NSET, *ELSET, *SURFACE. Ids are plain numbers; everything else is resolved when all is read.
struct AbaqusSet {
  enum Kind { nodes, elements, surface, node_surface } kind;
  std::string name;  ///< as written
  const char* at;
  std::string instance = {};  ///< of assembly sets
  std::vector<std::int64_t> ids = {};
  std::vector<std::array<std::int64_t, 3>> ranges = {};                    ///< first, last, step of GENERATE
  std::vector<AbaqusMember> members = {};                                  ///< names of sets, or Instance.17
  std::vector<std::pair<AbaqusMember, std::string>> surface_members = {};  ///< set or element, face label
  std::string elset = {};    ///< of node sets: the nodes of these elements as well
  std::string combine = {};  ///< of surfaces: UNION, INTERSECTION or DIFFERENCE of the members, which are surfaces
};

/// Words of a card that name parts of the mesh.
struct AbaqusNamed {
  enum Kind {
    nodes,
    node_set,  ///< not by number
    elements,
    surface,
    faces  ///< elements, a comma, and a face of theirs
  } kind;
  std::size_t begin, end;  ///< in the card's text
  bool by_keyword;
};
/// "A, P2NU": the elements, and the label of their face: P, 2 and NU.
struct AbaqusFaceLoad {
  std::string elements, before, behind;
  int face = 0;         ///< 1 to 6
  std::size_t end = 0;  ///< of the elements, with their quotes
  std::string label(int of_face) const { return before + std::to_string(of_face) + behind; }
};
AbaqusFaceLoad abaqus_face_load(const std::string& text);
/// Whether data lines of a card may name faces of elements so.
bool has_faces(std::string_view keyword);

/// A card that is no mesh, with its data lines.
struct AbaqusRawCard {
  std::string keyword, text;
  std::vector<AbaqusNamed> named;
  const char* at;
};

/// What stands between *PART and *END PART, *INSTANCE and *END INSTANCE, *ASSEMBLY and *END ASSEMBLY, or outside of
/// all: a name space of its own.
struct AbaqusScope {
  enum Kind { model, part, instance, assembly } kind = model;
  std::string name;
  const char* at = nullptr;
  std::vector<std::int64_t> node_ids;
  std::vector<Vec3> points;
  std::vector<Run> node_runs;
  std::vector<std::int64_t> hex_ids, hex_nodes;
  std::vector<std::pair<std::size_t, std::vector<std::int64_t>>> hex_middles;  ///< hex, what follows its corners
  std::vector<const char*> hex_at;
  std::vector<std::pair<std::size_t, std::string>> hex_types;  ///< from which hex on
  std::vector<std::int64_t> other_ids;                         ///< shells, beams, masses, ...
  std::vector<const char*> other_at;
  std::vector<std::size_t> other_first;                           ///< per element: where its nodes begin
  std::vector<std::int64_t> other_nodes;                          ///< 0: named otherwise
  std::vector<std::pair<std::size_t, std::string>> other_types;   ///< from which element on
  std::vector<std::pair<std::size_t, AbaqusMember>> named_nodes;  ///< place in other_nodes, "Instance.17"
  std::vector<AbaqusSet> sets;
  std::vector<AbaqusRawCard> cards;
};

struct AbaqusInstance {
  const AbaqusScope* part;
  const AbaqusScope* own;  ///< what stands in *INSTANCE; its name is the instance's
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Vec3 shift = Vec3::Zero();
};

struct AbaqusContents {
  std::vector<std::unique_ptr<Bytes>> sources;       ///< the file and what it includes; positions point into these
  std::vector<std::unique_ptr<AbaqusScope>> scopes;  ///< first: outside of parts and the assembly
  const AbaqusScope* assembly = nullptr;
  std::vector<AbaqusInstance> instances;
  /// From comments of our own: kind, name of the set in upper case -> id and real name.
  std::map<std::pair<std::string, std::string>, std::pair<int, std::string>> real_names;
  std::map<std::string, std::int64_t> n_dropped;  ///< elements, by type
  std::string heading;
  std::vector<std::string> notices;
  bool ours = false;
  std::int64_t n_normals = 0, first_normal = 0;    ///< nodes with more than coordinates
  std::array<std::int64_t, 2> announced = {0, 0};  ///< nodes and hexes, where a comment of ours says so

  [[noreturn]] void fail(const char* at, const std::string& what) const;
  /// "file:line"
  std::string where(const char* at) const;
  /// The file that it points into.
  const Bytes* source(const char* at) const;
};

/// A scope as it stands in the mesh; two for an instance, its part and what it has itself.
struct AbaqusPlaced {
  std::string name;  ///< of the instance; sets are name.set; empty: outside of parts
  std::array<const AbaqusScope*, 2> scopes = {nullptr, nullptr};
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Vec3 shift = Vec3::Zero();
  /// Its own ids, lowest and highest, and what is added to them in the mesh. No other place has ids between.
  struct Numbers {
    std::int64_t low = 1, high = 0, shift = 0;
    /// In the mesh; 0 for what is not between.
    std::int64_t operator()(std::int64_t id) const { return id >= low && id <= high ? id + shift : 0; }
  };
  Numbers nodes = {}, elements = {};
  std::vector<char> repeated_nodes = {},
                    repeated_hexes = {};  ///< of the second scope: the first has the same; empty: none
};

/// The mesh without its sets, and how to find parts of it.
struct AbaqusParts {
  std::vector<AbaqusPlaced> placed;  ///< the model itself, then instances, then the assembly if there is one
  Ids nodes, hexes;
  Ids others;  ///< in the order of the mesh's other elements
  std::vector<int> type_of_hex;
  std::vector<std::string> types;
  FoundMiddles middles;
  std::vector<std::uint8_t> is_middle;  ///< per node; empty: none is
};
AbaqusParts place_abaqus(const AbaqusContents& contents, MeshFile& out);
/// Types by blocks, which refinements carry. A type whose hexes are no block gets one.
void set_element_types(const AbaqusParts& parts, MeshFile& out);
/// Sets, types and cards.
void add_abaqus_sets(const AbaqusContents& contents, const AbaqusParts& parts, MeshFile& out);
/// The value of a parameter in the first line of a card, in upper case; empty where it is not there.
std::string parameter_of(std::string_view card, std::string_view parameter);
/// What of a card is of the elements that are there, in words; empty: nothing.
std::string what_does_not_follow(const AbaqusRawCard& card);
/// Which words of a card name parts of the mesh, and of what kind.
void find_names(AbaqusRawCard& card);
/// Cards of a place as they are in a file without parts: systems of coordinates stand where the place does, and have
/// the name of the place before their own where another place has that name for another one.
class AbaqusCardsOfPlaces {
 public:
  std::vector<AbaqusRawCard> of(const AbaqusContents& contents, const AbaqusPlaced& placed,
                                std::vector<std::string>& notices);

 private:
  std::map<std::string, std::string> systems_;  // by name in upper case
};
/// Whether a card belongs to the one before it, as it has no name of its own.
bool belongs_to_last(const AbaqusRawCard& card);
/// The line of a text that a place is in, with its end.
std::pair<std::size_t, std::size_t> line_around(std::string_view text, std::size_t at);
/// Takes lines out of a card.
void cut_out(AbaqusCard& card, std::size_t begin, std::size_t end);
/// Cards that speak of single nodes or elements in a way that no refinement could follow.
bool depends_on_numbers(std::string_view keyword);

std::string upper_case(std::string_view text);

}  // namespace hextwist::io
