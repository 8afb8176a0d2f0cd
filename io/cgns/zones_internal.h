// What a CGNS file says of a zone, as read_cgns() takes it.
#pragma once

#include <functional>

#include "hextwist/io/cgns/cgns_internal.h"

namespace hextwist::io {

/// Where the library is in a file.
struct CgnsPlace {
  int file = -1;
  std::string name;  ///< of the file
  std::uintmax_t size = 0;
  int base = 0;
  std::vector<std::string> notes = {};

  [[noreturn]] void fail(const std::string& what) const { throw Error(name + ": " + what); }
  void check(int status, const std::string& what) const;
  /// A number of items that a file of this size can hold (HDF5 packs a thousandfold at most).
  std::int64_t count(std::int64_t n, const std::string& what) const;
};

/// What a node of the file is in the mesh.
struct CgnsLabel {
  std::string kind;  ///< "block", "nodeset", "sideset", "part": in our own files
  int id = -1;       ///< -1: any
  std::string name;
};

struct CgnsSection {
  int number = 0;  ///< as the library counts
  std::string name;
  CgnsLabel label;
  CGNS_ENUMT(ElementType_t) type{};
  std::int64_t start = 0, end = 0;    ///< its elements
  bool hexes = false, quads = false;  ///< found to have some
};

struct CgnsZone {
  int number = 0;
  std::string name, family;
  bool structured = false;
  std::int64_t n_nodes = 0, n_cells = 0, first_node = 0;
  std::array<std::int64_t, 3> nodes{}, cells{};  ///< per direction of a structured zone
  std::vector<CgnsSection> sections;             ///< ascending by their elements
  // What the reader makes of it.
  std::int64_t n_elements = 0, first_element = 0;
  std::vector<std::int64_t> id_of_element;  ///< by number; 0: neither hex nor quad
  std::vector<std::int64_t> hex_ids;        ///< in the order of the cells
  std::vector<char> is_hex;                 ///< by number
  std::vector<char> in_condition;           ///< by number: elements that a boundary condition names

  std::int64_t node_at(const std::array<std::int64_t, 3>& at) const {
    return at[0] + nodes[0] * (at[1] + nodes[1] * at[2]);
  }
};
CgnsZone cgns_zone(const CgnsPlace& in, int number, std::int64_t first_node);
std::vector<Vec3> cgns_points(const CgnsPlace& in, const CgnsZone& zone);
/// Ids that our own files keep; empty where there are none.
std::vector<std::int64_t> cgns_ids(const CgnsPlace& in, const CgnsZone& zone, const char* name);

/// Pairs of nodes, counted over all zones, that are one by 1-to-1 connectivity; notes of other connectivities.
std::vector<std::pair<std::int64_t, std::int64_t>> cgns_joined_nodes(CgnsPlace& in, const CgnsZone& zone,
                                                                     const std::vector<CgnsZone>& zones);

struct CgnsType {
  enum What { hex, quad, other } what = other;
  const char* name = "";
};
/// Calls f for each element. Throws Error at other solids.
void cgns_elements(
    const CgnsPlace& in, const CgnsZone& zone, const CgnsSection& section,
    const std::function<void(std::int64_t number, const CgnsType& type, std::span<const cgsize_t> nodes)>& f);

/// A ZoneSubRegion_t or BC_t.
struct CgnsRegion {
  std::string name;
  CgnsLabel label;
  std::string type;  ///< of a boundary condition; empty: nothing that must be kept
  CGNS_ENUMT(GridLocation_t) location{};
  bool range = false;  ///< points are the two ends, of a structured zone
  /// Nodes or elements; of structured zones three numbers each.
  std::vector<cgsize_t> points;
};
std::vector<CgnsRegion> cgns_regions(CgnsPlace& in, const CgnsZone& zone);
std::vector<CgnsRegion> cgns_conditions(CgnsPlace& in, const CgnsZone& zone);
/// Sides of a condition's range of nodes or faces; false where it has none: nodes, inside of the zone or along lines.
/// A condition on nodes of a structured zone that is not sides has them in `points`, counted from 1, afterwards.
bool cgns_sides(const CgnsPlace& in, const CgnsZone& zone, CgnsRegion& condition, const std::string& what,
                std::vector<std::pair<std::int64_t, int>>& sides);

/// Values of a solution: the last of a name counts.
struct CgnsValues {
  std::string name;
  Field::On on = Field::On::node;
  bool integer = false;
  std::vector<double> values;  ///< per node or cell of the zone
};
std::vector<CgnsValues> cgns_solutions(CgnsPlace& in, const CgnsZone& zone);

}  // namespace hextwist::io
