// What it takes to make one mesh from another, without copies of what is the same.
//
// An array is told from another by the pieces that differ. That finds nodes that moved (the same places), hexes that
// were split (gone from the middle, children at the end) and members that joined a set; where nothing fits, the array
// is kept whole.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "hextwist/mesh/meshed_model.h"

namespace hextwist {

/// How to make the array `to` from the array `from`. Items are compared bit by bit.
template <class T>
class ArrayDelta {
 public:
  ArrayDelta() = default;
  ArrayDelta(const std::vector<T>& from, const std::vector<T>& to);
  /// Precondition: the `from` it was made with.
  std::vector<T> apply(const std::vector<T>& from) const;
  bool empty() const { return same_; }
  /// Of memory held.
  std::size_t bytes() const { return pieces_.capacity() * sizeof(Piece) + fresh_.capacity() * sizeof(T); }

  /// First n_fresh new items, then n_kept of `from`, beginning at first.
  struct Piece {
    std::size_t n_fresh, first, n_kept;
  };

 private:
  bool same_ = true;
  std::vector<Piece> pieces_;
  std::vector<T> fresh_;
};

/// A list of blocks, sets or fields.
template <class Group, class Item>
struct GroupsDelta {
  struct Entry {
    Group group;      ///< without its items
    Index from = -1;  ///< whose items those of `items` are made from; -1: of nothing
    ArrayDelta<Item> items;
  };
  bool same = true;
  std::vector<Entry> entries;
};

/// The groups of a mesh: their own arrays only.
struct SetsDelta {
  GroupsDelta<Block, Index> blocks;
  GroupsDelta<NodeSet, Index> node_sets;
  GroupsDelta<SideSet, Side> side_sets;
};
SetsDelta sets_delta(const Mesh& from, const Mesh& to);
/// The three lists of `to`; the rest of the result is empty.
Mesh sets_after(const SetsDelta& delta, const Mesh& from);

/// Everything of a MeshedModel but its model, which is kept.
struct MeshedDelta {
  ArrayDelta<Vec3> points;
  ArrayDelta<Hex> hexes;
  ArrayDelta<std::int64_t> node_ids, hex_ids;
  SetsDelta sets;
  GroupsDelta<Field, double> fields;
  ArrayDelta<Owner> node_owner;
  ArrayDelta<Parameters> node_parameters;
  ArrayDelta<Edge> curve_edges;
  ArrayDelta<int> edge_curve;
  ArrayDelta<Side> surface_faces;
  ArrayDelta<int> face_surface, hex_volume;
  std::shared_ptr<const Model> model;

  static MeshedDelta between(const MeshedModel& from, const MeshedModel& to);
  /// Precondition: the `from` it was made with.
  MeshedModel apply(const MeshedModel& from) const;
  std::size_t bytes() const;
};

/// Bytes in the arrays of a mesh and its association.
std::size_t bytes_of(const MeshedModel& meshed);

std::size_t bytes_of(const Association& association);
std::size_t bytes_of(const SetsDelta& delta);
template <class T>
std::size_t bytes_of(const std::vector<T>& array) {
  return array.size() * sizeof(T);
}

}  // namespace hextwist
