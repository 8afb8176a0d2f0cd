// What a viewer needs to know of a mesh on its model, as blocks of arrays that can be loaded one by one.
//
//   skin      "meta" (JSON, see scene_meta.cpp) and what is seen at first: faces on surfaces, with ids and owners
//   cad       the true surfaces and curves of the CAD in between the nodes
//   inside    all nodes and hexes: what cuts, sheets and columns are made of
//   sets      members of blocks, sets and groups
//   c0, c1..  a value per hex or node each: metrics, fields, levels, ...
//
// Positions are relative to the middle of the mesh (meta.origin), so that single precision is enough to draw them.
// Nodes, hexes, edges and faces go by their positions, 0-based; ids are said where they are something else.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hextwist/command/select/selection.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/session/state.h"
#include "hextwist/session/view/pack.h"

namespace hextwist {

struct HandedHexes;  // refine/levels/handed.h

/// What lies on the side of a plane that `normal` points to is taken away.
struct SceneCut {
  Vec3 normal = Vec3::UnitX();  ///< of length 1
  double distance = 0;          ///< normal . x of the plane
  bool whole = false;           ///< hexes by their centroids: none is cut
};

/// Where a viewer begins: what is picked, what is shown alone, which colours, from where it looks.
struct SceneStart {
  bool has_range = false;
  EntityKind kind = EntityKind::hex;
  std::vector<Index> positions = {};
  std::string colour = {};  ///< one of scene_colours(); empty: what tells hexes apart
  std::optional<SceneCut> cut = {};
  std::optional<EntityKind> labels = {};  ///< ids of these are shown
  bool shows_cad = false;                 ///< its true surfaces, not the mesh
  Vec3 view = Vec3(1, -1, 0.7);
};

struct SceneSource {
  Selector selector;
  const SessionState& state;
  std::string title;
  std::function<const Mesh&()> before = {};  ///< as it was before the last change; empty: that is not known
};

/// Values that can give the colours.
struct Channel {
  enum class What { volume, block, level, cut, changed, size, metric, field };
  What what = What::metric;
  std::string name;       ///< as users know it: "shape", "error", "error z"
  std::string group;      ///< "mesh", "quality", "fields"
  bool is_class = false;  ///< numbers of things
  bool on_nodes = false;
  Metric metric = Metric::shape;                          ///< of What::metric
  Index field = 0;                                        ///< of What::field
  int component = 0;                                      ///< of it; its length: -1
  std::shared_ptr<const HandedHexes> pieces = nullptr;    ///< of levels and cuts
  std::vector<std::pair<int, std::string>> classes = {};  ///< what the numbers are called, where they have names
};
std::vector<Channel> channels(const SceneSource& source);
/// What the channel of a metric is called: as the metric, but for those of hexes that would be taken for CAD.
std::string channel_name(Metric metric);
/// Per hex the number of its class; per hex or node the value.
std::vector<std::uint32_t> classes_of(const SceneSource& source, const Channel& channel);
std::vector<double> values_of(const SceneSource& source, const Channel& channel);
/// All that can give the colours: names of channels, and "none", "surface", "sheet", "owner", "nodeset", "sideset",
/// "group" where there are any.
std::vector<std::string> scene_colours(const SceneSource& source);
/// Per hex the smallest of the sheets through it.
std::vector<Index> smallest_sheets(const SceneSource& source);

/// left_out: names of channels, and "inside", that are not to be had.
std::string scene_meta(const SceneSource& source, const std::vector<Channel>& channels, const SceneStart& start,
                       const std::vector<std::string>& left_out);
PackedBlock skin_block(const SceneSource& source, const std::string& meta);
PackedBlock cad_block(const SceneSource& source);
PackedBlock inside_block(const SceneSource& source);
PackedBlock sets_block(const SceneSource& source);
/// One array "value": f32 per hex or node, or u32 for classes. Of meshes that are large, values have four digits.
PackedBlock channel_block(const SceneSource& source, const Channel& channel);

/// Box of the mesh, of the model where there is none; what every position is relative to: its middle.
Box scene_box(const SceneSource& source);
Vec3 scene_origin(const SceneSource& source);

/// What has the colour of a group: what its members are made of.
struct GroupShape {
  std::vector<Index> hexes, faces, nodes;  ///< ascending
};
GroupShape shape_of(const Selector& selector, const Group& group);

/// Surfaces of a model without a mesh on it, and its curves in straight pieces.
struct CadSurface {
  std::vector<Vec3> points, normals;
  std::vector<std::array<std::int32_t, 3>> triangles;
};
CadSurface cad_surface(const Model& model, int surface);
std::vector<Vec3> cad_curve(const Model& model, int curve);

}  // namespace hextwist
