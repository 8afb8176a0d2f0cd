// What a request for sizes wishes for, and what of a mesh is to be cut for it.
#pragma once

#include <memory>
#include <optional>

#include "hextwist/refine/plans/combine.h"
#include "hextwist/sizing/fields/size_field.h"
#include "hextwist/sizing/loop.h"
#include "hextwist/sizing/target_distance.h"

namespace hextwist {

class SizeWish {
 public:
  /// Precondition: the request is for sizes.
  SizeWish(const MeshedModel& input, const Request& request) : SizeWish(input, request, box(input.mesh).diagonal()) {}
  /// diagonal: of the box around the whole mesh, which the input is a part of.
  SizeWish(const MeshedModel& input, const Request& request, double diagonal);

  const SizeField& field() const { return *field_; }
  /// It holds for all of the mesh, not for the hexes of the target alone.
  bool is_everywhere() const { return is_everywhere_; }
  /// Where it holds, a byte per hex: everywhere, or in the hexes of the target.
  std::vector<std::uint8_t> zone(const Mesh& mesh, std::span<const Index> region) const;
  /// It is the same at all places.
  bool is_constant() const { return is_constant_; }

  /// Hexes of the zone (a byte per hex) whose size is above the wish by more than sqrt(3), ascending.
  std::vector<Index> too_large(const Mesh& mesh, std::span<const std::uint8_t> in_zone) const;
  /// Nodes of edges on the target that are longer than the wish by more than sqrt(3): there it is to be met to the
  /// edge, however the rest of their hexes may be. Two for each edge.
  std::vector<Index> nodes_too_far_apart(const Mesh& mesh, std::span<const std::uint8_t> in_zone) const;
  /// Per node: marked, so that all edges between marked nodes are to be cut in three. Empty: nothing is.
  std::vector<std::uint8_t> marks(const Mesh& mesh, std::span<const Index> too_large,
                                  std::span<const Index> too_far_apart) const;
  /// So many more hexes the wish takes at the very least. by_threes: nothing else cuts them.
  double least_more(const Mesh& mesh, std::span<const Index> too_large, bool by_threes = false) const;
  /// Throws Error when the hexes that the wish takes at the very least cannot fit into memory: sooner than the pass
  /// that would find out. n_outside: hexes that the mesh is without.
  void check_fits(const Mesh& mesh, std::span<const Index> too_large, Index n_outside, bool by_threes = false) const;

 private:
  std::vector<std::uint8_t> at_target(std::span<const Vec3> points) const;
  std::vector<Index> at_points(const Mesh& mesh, std::span<const Index> hexes) const;
  void mark_wishing_nodes(const Mesh& mesh, std::span<const Index> hexes, std::span<std::uint8_t> marked) const;

  SizeFieldPtr field_;
  bool is_everywhere_, is_constant_;
  int dimension_;       // of the target
  double most_pieces_;  // of an edge
  bool is_point_;
  double close_;
  std::optional<TargetDistance> distance_;
};

/// Of a state whose request is for sizes: the wish, the hexes of the target (what is to be said of it goes to the
/// report), and the target of the combination; in a part those of the whole.
std::shared_ptr<const SizeWish> size_wish(const State& state);
std::vector<Index> size_region(State& state);
CombinationTarget size_target(State& state);
/// Hexes that the mesh of a state is without.
Index n_outside(const State& state);

}  // namespace hextwist
