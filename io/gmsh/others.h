// Elements beside the hexes (mesh/others.h) in Gmsh's files.
#pragma once

#include <functional>
#include <map>

#include "hextwist/io/gmsh/gmsh.h"
#include "hextwist/io/gmsh/plan_internal.h"
#include "hextwist/mesh/others.h"

namespace hextwist::io {

/// Of a type that is kept beside the hexes, but for lines and quads, of which some are.
bool is_gmsh_other(int type);

/// Those of a file, as they are found.
struct GmshOthersFound {
  OtherHeads heads;
  std::vector<Index> first = {0}, nodes;
  std::vector<Owner> entities;           ///< per element
  std::vector<std::vector<int>> groups;  ///< per element: its physical groups

  void add(int type, std::int64_t tag, Owner entity, std::vector<int> physicals, std::span<const Index> nodes_in_file);
  /// Gives them to the mesh, whose hexes and groups are there.
  /// line_blocks: blocks of lines, by their physical group of dimension 1.
  void finish(Mesh& mesh, const std::function<std::string(int dim, int id)>& group_name,
              const std::map<int, int>& line_blocks, std::vector<std::string>& notices);

 private:
  void merge_copies();
};

/// Physical groups of dimensions 0 and 1 that an element was in, in the file of Gmsh that it came from.
std::vector<int> gmsh_groups_of(const OtherElements& others, Index element);

/// One to be written.
struct GmshOther {
  int type = 0, dim = 0, entity = 0;
  std::int64_t tag = 0;
  std::vector<int> physicals = {};  ///< ascending
  std::vector<Index> nodes = {};    ///< in Gmsh's order
};
/// All that Gmsh can have. Adds names of groups that nothing else of the mesh is in; says what is left out.
std::vector<GmshOther> gmsh_others(const Mesh& mesh, std::vector<PlannedGroup>& group_names,
                                   std::vector<std::string>& notices);

/// Puts them on entities of the plan. split: every entity is wholly in or out of each group (version 4.1).
void plan_gmsh_others(const Mesh& mesh, bool split, GmshPlan& plan, std::vector<std::string>& notices);

}  // namespace hextwist::io
