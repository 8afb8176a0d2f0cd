// A Gmsh model's mesh into a session and back, entity by entity, as plain arrays: no Gmsh is needed to compile this.
// What talks to Gmsh is gmsh.h (C++) and the Python module hextwist.gmsh; this decides which element goes where.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "hextwist/session/session.h"

namespace HEXTWIST_API hextwist {

/// One entity with the part of the mesh that is classified on it, as gmsh::model::mesh::getNodes() (boundary left out,
/// parametric coordinates asked for) and getElements() give them and addNodes() and addElements() take them.
struct GmshEntity {
  int dim = 0;                                          ///< 0 point, 1 curve, 2 surface, 3 volume
  int tag = 0;                                          ///< in Gmsh
  std::vector<std::size_t> node_tags;                   ///< of the nodes inside of it, not on its boundary
  std::vector<double> coord;                            ///< 3 per node
  std::vector<double> parametric;                       ///< dim per node, or none
  std::vector<int> element_types;                       ///< Gmsh's numbers: 15 point, 1 line, 3 quad, 5 hex
  std::vector<std::vector<std::size_t>> element_tags;   ///< per type: one per element
  std::vector<std::vector<std::size_t>> element_nodes;  ///< per type: 1, 2, 4, 8 node tags per element, in Gmsh's order
};

/// A physical group.
struct GmshGroup {
  int dim = 0;                ///< of its entities
  int tag = 0;                ///< in Gmsh, positive; becomes the id of the block or set where that is free
  std::string name;           ///< "": none
  std::vector<int> entities;  ///< their tags in Gmsh
};

/// A model of Gmsh as plain arrays.
struct GmshModel {
  std::vector<GmshEntity> entities;  ///< all of the model, those without mesh too
  std::vector<GmshGroup> groups;     ///< all physical groups of the model
};

/// What has to be known to bring the mesh back: made by take_gmsh(), read by put_gmsh(), of use to nobody else but for
/// tag_of and on_cad.
struct GmshLink {
  std::shared_ptr<const Model> model;        ///< of the session
  std::array<std::vector<int>, 4> tag_of;    ///< per dimension, at id - 1: tag of the entity in Gmsh, 0: of none
  bool on_cad = false;                       ///< false: on the skin of the mesh
  std::vector<std::size_t> other_nodes;      ///< tags of nodes that have nothing to do with hexes, ascending
  std::size_t last_node = 0;                 ///< highest tag of a node in the model
  std::size_t last_element = 0;              ///< highest tag of an element in the model
  std::size_t last_hex = 0;                  ///< highest tag of a hex
  std::int64_t last_own_node = 0;            ///< highest tag of a node of a hex
  std::vector<std::array<int, 2>> entities;  ///< (dim, tag) of those that are replaced
  /// Elements as they were, to keep their tags: nodes (ids, sorted, 0 where there are fewer than four) and tag,
  /// ascending.
  std::array<std::vector<std::pair<std::array<std::int64_t, 4>, std::size_t>>, 3> elements;
  std::array<std::vector<char>, 3> turned;  ///< per curve and surface, at id - 1: do its elements run against it?
};

/// Makes the mesh of a Gmsh model that of the session, on the CAD in `brep` (what Gmsh writes of its OpenCASCADE
/// model), or, where that is empty, on a model of its own skin that is divided as the elements are classified. Physical
/// groups become blocks, side sets and node sets.
///
/// Ids in commands are Gmsh's tags: of nodes and hexes always; of vertices, curves, surfaces and volumes where the tags
/// are 1 .. n. Where they have gaps, a tag up to n is the id, and the others take the ids that are left; all of
/// those can be named: `curve tag17`. The session's notices say which.
/// Throws Error, the session as it was: no hexes, other volume elements (or of second order), elements on the boundary
/// that are no sides or edges of hexes, entities that the CAD does not have.
GmshLink take_gmsh(Session& session, const GmshModel& gmsh, const std::filesystem::path& brep);

/// The mesh of the session as it is to stand in Gmsh: every entity that had a part of it (GmshLink::entities), and with
/// what. Nodes and elements that were there keep their tags; new ones get tags above all that were in use. Quads
/// and lines turn the way those of their entity did.
/// Nodes on curves and surfaces of CAD have their parameters.
/// Throws Error when the session's mesh is on another model by now.
std::vector<GmshEntity> put_gmsh(const Session& session, const GmshLink& link);

}  // namespace hextwist
