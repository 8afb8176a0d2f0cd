// The skin of a mesh that is in parts, as the model of the whole: the one that a single process would have made of it.
//
// Every part knows the faces of its own hexes. Those that no other part has are the skin. They are brought together,
// which takes memory that goes with the skin, and make the model; each part then finds its own nodes in it.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "hextwist/mesh/meshed_model.h"

namespace hextwist {

/// A face of a hex of some part; nodes and hexes by ids.
struct SkinFace {
  std::array<std::int64_t, 4> nodes{};  ///< cyclic, seen from outside of the hex
  std::array<std::array<double, 3>, 4> points{};
  std::int64_t hex = 0;
  std::int32_t face = 0;
  std::int32_t volume = 0;  ///< of the hex
  std::int32_t front = 0;   ///< of the hex on the other side, 0: there is none
};

/// Volumes are the blocks where each hex of all parts is in exactly one block.
bool has_block_each(const Mesh& part);
/// Per hex. block_sizes: of the whole; empty: all hexes are one volume.
std::vector<int> volumes_of_blocks(const Mesh& part, std::span<const std::int64_t> block_sizes);

/// open: faces that only one hex of the part has; walls: those between volumes within it. The part has its ids.
void find_faces(const Mesh& part, std::span<const int> hex_volume, std::vector<SkinFace>& open,
                std::vector<SkinFace>& walls);
/// Of the open faces of several parts those that are on the skin or between volumes.
std::vector<SkinFace> skin_among(std::vector<SkinFace> open);

/// The model and who owns what of the skin.
struct WholeSkin {
  std::shared_ptr<const Model> model;
  struct Quad {
    std::int64_t hex;
    std::int32_t face, surface;
  };
  std::vector<Quad> quads;                         ///< ascending by hex and face
  std::vector<std::int64_t> nodes;                 ///< ascending ids
  std::vector<Owner> node_owner;                   ///< per node
  std::vector<std::array<std::int32_t, 2>> edges;  ///< on curves, positions among nodes
  std::vector<int> edge_curve;
  std::vector<std::array<std::int32_t, 4>> quad_nodes;  ///< per quad, cyclic, positions among nodes
  std::vector<std::array<std::int32_t, 2>> quad_volumes;
};
/// quads: of all parts, any order.
WholeSkin make_skin_model(std::vector<SkinFace> quads);

/// Gives a part its model and association. The part has its ids.
void put_on_skin(const WholeSkin& skin, std::vector<int> hex_volume, MeshedModel& part);

/// What a node set has to say of the nodes inside volumes: bit 0: some of them are in the set, bit 1: some are not.
std::vector<std::int64_t> inner_members(const MeshedModel& part, const NodeSet& set, int n_volumes);
/// What the set is meant to hold. members: ids of its nodes on the skin, ascending; inner: as above, of all parts.
std::vector<Owner> meant_on_skin(const WholeSkin& skin, std::span<const std::int64_t> members,
                                 std::span<const std::int64_t> inner);

}  // namespace hextwist
