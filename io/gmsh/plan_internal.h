// What a Gmsh file of a mesh will hold: entities, elements and physical groups, before they are put in a format.
#pragma once

#include <map>

#include "hextwist/io/file_part.h"
#include "hextwist/io/middles.h"

namespace hextwist::io {

/// An entity of the file. Gmsh puts whole entities in physical groups; where a block or set takes a part of a volume
/// or surface only, that is written as an entity of its own, and `parent` says what it is part of. Entities that
/// merely carry a group have no parent.
struct PlannedEntity {
  int tag = 0;
  bool is_part = false;
  Owner parent;
  std::vector<int> physicals;
  std::vector<int> boundary;  ///< tags of the dimension below, with signs as Gmsh has them
  Box box;
  bool operator<(const PlannedEntity& other) const { return tag < other.tag; }
};

/// Elements of one dimension, grouped by entity, entities ascending.
struct PlannedElements {
  /// Neighbours on one entity with the same first group, 0 none. Never empty.
  struct Run {
    int entity = 0;
    int physical = 0;
    std::size_t first = 0, n = 0;
  };
  std::vector<Run> runs;
  std::size_t size = 0;
  std::vector<Index> items;    ///< which hex, side, curve edge or point each of them is; empty: 0, 1, 2, ...
  std::vector<Index> nodes;    ///< of those that are no hexes, Gmsh's order
  std::int64_t first_tag = 1;  ///< of those that are no hexes: they are counted from here

  Index item(std::size_t k) const { return items.empty() ? static_cast<Index>(k) : items[k]; }
};

struct PlannedGroup {
  Owner group;  ///< dimension and id
  std::string name;
  bool empty = false;
  std::vector<std::int64_t> more;  ///< versions before 4: members whose own physical tag is another group
};

/// Elements beside the hexes, of one type on one entity.
struct PlannedOthers {
  int dim = 0, entity = 0, type = 0;
  int physical = 0;                     ///< the first group, 0 none
  std::vector<std::int64_t> tags = {};  ///< ascending
  std::vector<Index> nodes = {};        ///< of all, Gmsh's order
};

struct GmshPlan {
  std::array<std::vector<PlannedEntity>, 4> entities;
  std::array<PlannedElements, 4> elements;
  std::vector<PlannedGroup> groups;
  std::vector<PlannedOthers> others;
  int nobody = 0;             ///< volume entity for nodes without owner, 0 when there are none
  int n_parts = 0, part = 0;  ///< the file is one of so many, from 0; 0: the file is all

  /// Of an entity that has nodes or elements. In a part that is what the part has of the entity, with a tag that no
  /// other part and no whole entity has.
  int file_tag(int tag) const;
  PlannedEntity& entity(int dim, int tag);
  std::size_t n_elements() const;
  /// Tag of element k of a dimension; hexes have their own ids.
  std::int64_t tag(const Mesh& mesh, int dim, std::size_t k) const {
    return dim == 3 ? id_of(mesh.hex_ids, elements[3].item(k)) : elements[dim].first_tag + static_cast<std::int64_t>(k);
  }
};

/// Which way line elements and curves run: with the CAD where there is a model, else with the parameters of nodes, else
/// any way, but all along a curve the same.
struct CurveDirections {
  std::vector<char> reversed;              ///< per curve edge: from its second node to its first
  std::map<int, std::array<int, 2>> ends;  ///< per curve that is one chain between vertices: first and last
};
CurveDirections curve_directions(const Mesh& mesh, const Association& association, const Model* model);

/// Lines of a file: those on curves, then others that groups have; and which node sets are groups of lines.
struct PlannedLines {
  std::vector<Edge> edges;
  std::vector<int> curve;                   ///< per line, 0 none
  std::vector<char> is_group;               ///< per node set
  std::vector<std::vector<Index>> members;  ///< per node set: its lines
  std::vector<int> tag;                     ///< per node set: of its physical group
};
/// A node set is a group of lines where it is exactly the nodes of some whole curves, and where it came from such a
/// group (FileExtras::curve_groups) and lines between its nodes have all of them.
PlannedLines plan_lines(const Mesh& mesh, const Association& association, const FileExtras* extras, Index n_corners);

/// Curves around surfaces, negative where the loop runs against them; a seam occurs both ways.
class SurfaceLoops {
 public:
  SurfaceLoops(const Association& association, const CurveDirections& directions)
      : tags_(association), directions_(directions) {}
  /// Counts in a quad of a surface.
  void add(int surface, const Quad& cycle);
  std::vector<int> of(int surface) const;

 private:
  const Association& tags_;
  const CurveDirections& directions_;
  std::map<int, std::vector<int>> curves_;
  std::map<int, int> turns_;
};

/// Nodes of an element of a dimension in Gmsh's order: corners, and middle nodes where `second` is not null.
FileHex gmsh_nodes(const Mesh& mesh, const PlannedElements& elements, int dim, std::size_t k,
                   const SecondOrder* second);

/// Pairs of nodes on periodic entities of a mesh, from those of the file before it was refined.
struct PlannedPeriodic {
  int dim, entity, of;
  std::vector<double> affine;
  std::vector<std::array<Index, 2>> nodes;
};
std::vector<PlannedPeriodic> plan_periodic(const Mesh& mesh, const Association& association,
                                           const std::vector<PeriodicPairs>& before, std::vector<std::string>& notices);

/// Takes elements out of the plan that are in no physical group. Returns, ascending, the nodes that are left.
std::vector<Index> keep_groups_only(GmshPlan& plan, const Mesh& mesh, bool split, const SecondOrder* second);

/// Of the physical group that a block or set becomes: its id, another one for 0, which is no group in these files.
template <class Group>
int group_tag(const std::vector<Group>& groups, const Group& group) {
  return group.id > 0 ? group.id : free_id(groups);
}

/// split: divide volumes and surfaces so that every entity is wholly in or out of each group (version 4.1).
GmshPlan plan_gmsh(const Mesh& mesh, const Association& association, bool split, const Model* model,
                   const FileExtras* extras, Index n_corners);
/// Makes it the plan of a part.
void take_part(GmshPlan& plan, const FilePart& part);

}  // namespace hextwist::io
