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

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hextwist/command/select/selection.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/session/state.h"
#include "hextwist/session/view/pack.h"

namespace hextwist {

struct HandedHexes;  // refine/levels/handed.h

/// Where a viewer begins: what is picked, what is shown alone, which colours, from where it looks.
struct SceneStart {
  bool has_range = false;
  EntityKind kind = EntityKind::hex;
  std::vector<Index> positions = {};
  std::string colour = {};  ///< name of a channel; empty: what tells hexes apart
  Vec3 view = Vec3(1, -1, 0.7);
};

struct SceneSource {
  Selector selector;
  const SessionState& state;
  std::string title;
};

/// Values that can give the colours.
struct Channel {
  enum class What { volume, block, level, cut, size, metric, field };
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

/// left_out: names of channels, and "inside", that are not to be had.
std::string scene_meta(const SceneSource& source, const std::vector<Channel>& channels, const SceneStart& start,
                       const std::vector<std::string>& left_out);
PackedBlock skin_block(const SceneSource& source, const std::string& meta);
PackedBlock cad_block(const SceneSource& source);
PackedBlock inside_block(const SceneSource& source);
PackedBlock sets_block(const SceneSource& source);
/// One array "value": f32 per hex or node, or u32 for classes. Of meshes that are large, values have four digits.
PackedBlock channel_block(const SceneSource& source, const Channel& channel);

/// What every position is relative to.
Vec3 scene_origin(const Mesh& mesh);

}  // namespace hextwist
