// A mesh as programs in other languages want to see it: flat arrays in the orders that other programs use, which stay
// as they are.
#pragma once

#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "hextwist/sizing/report.h"

namespace hextwist {

/// Holds the mesh that it shows. Arrays that the mesh does not have as they are wanted are made when first asked for.
/// Every member may be called from several threads at once; spans are valid as long as the view.
class MeshView {
 public:
  explicit MeshView(std::shared_ptr<const MeshedModel> meshed) : meshed_(std::move(meshed)) {}
  MeshView(const MeshView&) = delete;

  const MeshedModel& meshed() const { return *meshed_; }
  const Mesh& mesh() const { return meshed_->mesh; }

  /// Corners in the order of VTK, Exodus, Abaqus and Gmsh.
  std::span<const Hex> file_hexes() const;
  std::span<const std::int64_t> node_ids() const;
  std::span<const std::int64_t> hex_ids() const;
  /// Nodes of the faces on surfaces and of the sides of a side set: cycles, counter-clockwise seen from outside.
  std::span<const Quad> surface_quads() const;
  std::span<const Quad> set_quads(std::size_t side_set) const;

  /// Per quad (nodes in any order) the id of the surface that it lies on; 0: on none.
  std::vector<std::int32_t> surfaces_of(std::span<const Quad> quads) const;

 private:
  template <class T>
  struct Lazy {
    std::once_flag once;
    std::vector<T> values;
  };
  std::shared_ptr<const MeshedModel> meshed_;
  mutable Lazy<Hex> hexes_;
  mutable Lazy<std::int64_t> node_ids_, hex_ids_;
  mutable Lazy<Quad> surface_quads_;
  mutable Lazy<std::vector<Quad>> set_quads_;
  mutable Lazy<std::pair<Quad, std::int32_t>> surface_of_quad_;  // nodes ascending; sorted
};

}  // namespace hextwist
