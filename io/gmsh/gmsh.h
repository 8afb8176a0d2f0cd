// Gmsh files of all versions: what their sections say, before and after it becomes a mesh.
#pragma once

#include <map>
#include <optional>

#include "hextwist/io/middles.h"

namespace hextwist::io {

/// An element type of Gmsh.
struct GmshType {
  int dim;
  int n_nodes;
  const char* name;
};
/// nullptr for an unknown type.
const GmshType* gmsh_type(int type);
inline constexpr int most_gmsh_nodes = 56;  ///< of the known types
inline constexpr int gmsh_line = 1, gmsh_quad = 3, gmsh_hex = 5, gmsh_point = 15;
inline constexpr std::array<int, 4> gmsh_kept = {gmsh_point, gmsh_line, gmsh_quad, gmsh_hex};  // per dimension
/// Lines, quads and hexes of second order: kept by their corners, which come first.
inline constexpr std::array<int, 5> gmsh_second_order = {8, 10, 16, 12, 17};
inline constexpr std::array<int, 4> gmsh_corners = {1, 2, 4, 8};  // per dimension

/// Elements of one kept type, in file order.
struct GmshElements {
  std::vector<std::int64_t> tags;
  std::vector<Index> nodes;   ///< indices, ids ascending; Gmsh's order; not of hexes
  std::vector<int> entity;    ///< tag of the entity, 0 none
  std::vector<int> physical;  ///< versions 1 and 2: physical group, 0 none
  std::vector<Run> runs;
};

struct GmshData {
  Field field;  ///< name, kind (hex: element data), components; values in file order
  double time = 0;
  int step = 0;
  std::vector<std::int64_t> tags;
};

struct GmshSlice;  // gmsh/slice_internal.h

/// What the sections say. Entities and physical groups are (dim, tag).
struct GmshContents {
  int version = 0;             ///< 1, 22, 41
  GmshSlice* slice = nullptr;  ///< what is read of nodes and elements; null: all
  Ids nodes;
  std::vector<Vec3> points;
  std::vector<Owner> node_entity;                      ///< 4.1 only
  std::vector<Parameters> node_parameters;             ///< 4.1 only, empty when there are none
  std::array<GmshElements, 5> elements;                ///< per dimension; and other elements (gmsh/others.h)
  std::vector<int> other_types;                        ///< of elements[4]
  std::vector<Index> other_first = {0};                ///< of elements[4]: where the nodes of each begin
  int last_type = 0;                                   ///< that check_gmsh_type() was asked about
  std::vector<Index> line_middles;                     ///< of elements[1]: middle nodes, -1; may be shorter
  std::vector<Hex> hexes;                              ///< nodes of elements[3], in our corner order
  FoundMiddles middles;                                ///< of these
  std::map<Owner, std::vector<int>> entity_physicals;  ///< 4.1 only
  std::map<Owner, std::string> physical_names;
  std::map<Owner, Owner> parents;   ///< of entities that are parts of others, or only carry a group ("nobody")
  int n_partitions = 0;             ///< into which Gmsh has divided the mesh, 0: it has not
  std::vector<int> partitions;      ///< those that volumes of the file are in, ascending
  std::vector<int> ghosts;          ///< volumes that hold hexes of other partitions
  std::int64_t n_ghosts = 0;        ///< elements of these, which were left out
  bool has_groups_between = false;  ///< partitions: entities there have the groups of what they divide
  std::vector<std::pair<Owner, std::vector<std::int64_t>>> more_members;  ///< element tags of physical groups
  std::vector<GmshData> data;
  std::vector<std::string> of_corners;  ///< fields with values per element and node, which are left out
  std::vector<PeriodicPairs> periodic;
  std::map<std::string, std::int64_t> n_dropped;  ///< elements of other types, by name
  std::vector<std::string> notices;

  /// Nodes of all elements of a dimension, one after the other. Hexes are in our corner order.
  std::span<const Index> nodes_of(int dim) const {
    static_assert(sizeof(Hex) == 8 * sizeof(Index));
    if (dim < 3) return elements[dim].nodes;
    return {reinterpret_cast<const Index*>(hexes.data()), 8 * hexes.size()};
  }
  /// The CAD entity that an entity of the file stands for.
  Owner owner(Owner entity) const {
    constexpr int most_parents = 4;  // a partition's part of a group's part of a volume
    for (int i = 0; i < most_parents && entity.id > 0; ++i) {
      const auto parent = parents.find(entity);
      if (parent == parents.end()) break;
      entity = parent->second;
    }
    return entity.id > 0 ? entity : Owner{};
  }
};

/// Values of a section, as text or as the machine stores them.
struct GmshSource {
  Cursor& cursor;
  int integer(std::string_view what) { return cursor.binary ? cursor.raw<std::int32_t>(what) : cursor.small(what); }
  std::int64_t large(std::string_view what) {
    return cursor.binary ? cursor.raw<std::int64_t>(what) : cursor.integer(what);
  }
  double real(std::string_view what) { return cursor.binary ? cursor.raw<double>(what) : cursor.real(what); }
  void large_ones(std::span<std::int64_t> to, std::string_view what) {
    if (cursor.binary) return cursor.raw_all(to, what);
    for (std::int64_t& value : to) value = cursor.integer(what);
  }
  /// Refuses what is not finite.
  void coordinates(std::span<double> to) {
    const char* from = cursor.at;
    if (cursor.binary) cursor.raw_all(to, "a coordinate");
    for (std::size_t i = 0; i < to.size(); ++i) {
      if (cursor.binary) {
        if (!std::isfinite(to[i])) cursor.fail_at(from + i * sizeof(double), "a coordinate is not finite");
        continue;
      }
      cursor.skip_blanks();
      from = cursor.at;
      to[i] = cursor.real("a coordinate");
      if (!std::isfinite(to[i])) cursor.fail_at(from, "a coordinate is not finite");
    }
  }
};

/// Where elements of a type go: GmshContents::elements[4].
inline constexpr int gmsh_beside = 4;
/// Refuses what has a volume and is not known; counts what else there is. Returns the dimension of a point, line, quad
/// or hex, gmsh_beside of another one that is to be kept, else -1.
int check_gmsh_type(GmshContents& contents, const Cursor& cursor, const char* at, int type, std::int64_t tag,
                    std::int64_t count);
/// Adds an element of a kept type by the ids of its nodes.
void add_gmsh_element(GmshContents& contents, const Cursor& cursor, int dim, std::int64_t tag,
                      std::span<const std::int64_t> node_ids, const char* at);

/// What stands before the nodes, or the elements, of an entity of version 4.1.
struct GmshBlock {
  int dim = 0, entity = 0;
  int kind = 0;  ///< of nodes: whether they have parameters; of elements: their type
  std::size_t size = 0;
  const char* at = nullptr;  ///< of the header
};
/// Calls begin(number of all) and use(block), which reads what the block has.
void for_each_gmsh_node_block(GmshSource& source, const std::function<void(std::size_t)>& begin,
                              const std::function<void(const GmshBlock&)>& use);
void for_each_gmsh_element_block(GmshSource& source, const std::function<void(std::size_t)>& begin,
                                 const std::function<void(const GmshBlock&)>& use);
// The same sections where contents.slice is given.
void read_sliced_gmsh_nodes(GmshContents& contents, GmshSource& source);
void read_sliced_gmsh_elements(GmshContents& contents, GmshSource& source);
/// Sections of a file, all that are known.
void read_gmsh_sections(GmshContents& contents, Cursor& cursor);

// Sections, the cursor at the first thing after the line with the name.
void read_gmsh_nodes_1(GmshContents& contents, GmshSource& source, bool parametric);
void read_gmsh_elements_1(GmshContents& contents, GmshSource& source);
void read_gmsh_elements_2(GmshContents& contents, GmshSource& source);
void read_gmsh_entities_4(GmshContents& contents, GmshSource& source, bool partitioned);
void read_gmsh_nodes_4(GmshContents& contents, GmshSource& source);
void read_gmsh_elements_4(GmshContents& contents, GmshSource& source);
void read_gmsh_data(GmshContents& contents, GmshSource& source, Field::On on);
void read_gmsh_parts(GmshContents& contents, Cursor& cursor);
void read_gmsh_periodic(GmshContents& contents, GmshSource& source);

/// Into how many partitions Gmsh has divided a mesh, and which of them the hexes of this file are in. n 0: it has not.
struct GmshPartition {
  int n = 0;
  std::vector<int> partitions;  ///< ascending, from 1
};
GmshPartition gmsh_partition(const Bytes& bytes);

/// Sections to a mesh.
MeshFile assemble_gmsh(GmshContents&& contents, const Cursor& cursor);

}  // namespace hextwist::io
