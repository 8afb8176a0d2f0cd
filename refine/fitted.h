// Where the nodes of a template lie in a face or hex of these proportions. A template is made in the unit square or
// cube; in a face that is long or flat its nodes go where SplitTable::fit_face says, by the face alone, so that both
// hexes at it agree, and nodes inside a hex follow those of its faces.
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "hextwist/refine/templates/split_table.h"

namespace hextwist {

/// Room for the places of one face.
using FacePlaces = std::array<std::array<double, 2>, max_fitted_face_nodes>;

/// (u, v) of the nodes of a face with this code and these corners (bit frame): those of the pattern itself, or what has
/// been written to `room`.
inline std::span<const std::array<double, 2>> fitted_places(const SplitTable& table, std::uint16_t code,
                                                            const std::array<Vec3, 4>& corner, FacePlaces& room) {
  const auto& at = table.face[code].at;
  if (!table.fit_face || at.empty()) return at;
  const double first = (corner[1] - corner[0]).norm() + (corner[3] - corner[2]).norm();
  const double second = (corner[2] - corner[0]).norm() + (corner[3] - corner[1]).norm();
  if (!(first > 0 && second > 0)) return at;
  std::ranges::copy(at, room.begin());
  table.fit_face(code, second / first, std::span(room).first(at.size()));
  return std::span(room).first(at.size());
}

/// How far the nodes inside the faces of a hex have gone from their places in the unit cube.
class FittedHex {
 public:
  FittedHex(const SplitTable& table, const HexTemplate& of, const Hex& hex, std::span<const Vec3> points) : of_(of) {
    if (of.follow.empty() || points.empty()) return;
    FacePlaces room;
    for (int f = 0; f < n_hex_faces; ++f) {
      const auto& pattern = table.face[of.face_code[f]].at;
      std::array<Vec3, 4> corner;
      for (int k = 0; k < 4; ++k) corner[k] = points[hex[face_corner(f, k)]];
      const auto at = fitted_places(table, of.face_code[f], corner, room);
      const int low = f >> 1 == 0 ? 1 : 0, high = f >> 1 == 2 ? 1 : 2;
      for (std::size_t s = 0; s < at.size(); ++s) {
        Vec3& shift = shift_[n_++] = Vec3::Zero();
        shift[low] = at[s][0] - pattern[s][0];
        shift[high] = at[s][1] - pattern[s][1];
      }
    }
  }
  /// Place in the unit cube of a node inside.
  Vec3 operator[](std::size_t s) const {
    Vec3 at = of_.inside[s];
    for (std::size_t j = 0; j < n_; ++j) at += of_.follow[s * n_ + j].cwiseProduct(shift_[j]);
    return at;
  }

 private:
  const HexTemplate& of_;
  std::array<Vec3, n_hex_faces * max_fitted_face_nodes> shift_;
  std::size_t n_ = 0;
};

}  // namespace hextwist
