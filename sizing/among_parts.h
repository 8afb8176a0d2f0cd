// What a part of a mesh has to ask of the others while all of them are refined for sizes side by side.
//
// What is cut for sizes is found hex by hex. What is decided over the whole mesh (which technique comes nearer, whether
// all that is too large touches the target) is decided by numbers of each part's own hexes, summed over all parts.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "hextwist/refine/levels/cells.h"

namespace hextwist {

class State;
struct RefineResult;

/// Numbers of a part, or of all of them.
struct PartNumbers {
  std::array<std::int64_t, 6> sum{};
  double least = std::numeric_limits<double>::infinity();
};

class AmongParts {
 public:
  AmongParts() = default;
  AmongParts(const AmongParts&) = delete;
  AmongParts& operator=(const AmongParts&) = delete;
  virtual ~AmongParts() = default;

  double diagonal = 0;            ///< of the box around the whole mesh
  Index n_outside = 0;            ///< hexes of others that are not here
  std::vector<Index> region;      ///< hexes of the target that are here, ascending
  std::vector<std::uint8_t> own;  ///< per hex of the input: it is this part's own
  int taken = 0;                  ///< set: the number of the technique whose result was taken
  std::string by_whole;           ///< set: why only the whole mesh will do; what is made is of no use then

  /// These of the hexes, which come of the input: origin[hex], or themselves where that is empty.
  std::vector<Index> own_among(std::span<const Index> hexes, std::span<const Index> origin) const {
    std::vector<Index> mine;
    std::ranges::copy_if(hexes, std::back_inserter(mine),
                         [&](Index h) { return own[origin.empty() ? h : origin[h]] != 0; });
    return mine;
  }

  /// All parts call this alike: sums and the least of all. Throws where that can't be had.
  virtual PartNumbers all(const PartNumbers& mine) = 0;
  /// A technique is tried from here; returns its number.
  virtual int begin(State& tried) = 0;
  /// What came of the last one that was begun. Not called where it was given up.
  virtual void end(const RefineResult& made) = 0;
  /// Have two of them cut this part's own hexes in the same passes in the same way?
  virtual bool is_same(int a, int b) const = 0;
  /// Cells that are wished to be cut by now.
  virtual void wished(const LevelMarks& marks) = 0;
};

}  // namespace hextwist
