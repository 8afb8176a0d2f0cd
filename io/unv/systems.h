// Coordinate systems of I-deas universal files: datasets 2420, and 18 before it.
#pragma once

#include <map>
#include <optional>

#include "hextwist/io/listing.h"

namespace hextwist::io {

/// What is known of the systems in which nodes are given. Places in a system that is Cartesian and not turned are moved
/// by its origin; those in any other are refused, since files differ in what its matrix and angles mean.
class UnvSystems {
 public:
  explicit UnvSystems(const Cursor& cursor) : cursor_(cursor) {}

  /// origin: of one that is Cartesian and not turned; none: `what` it is instead, "cylindrical".
  void add(int number, std::optional<Vec3> origin, const std::string& what);
  /// A node's place in the global system. export: the system that it is given in. Throws Error as above.
  Vec3 global(int number, std::int64_t node, const Vec3& point, const char* at);
  /// Of a node: the system of its displacements, which is not kept.
  void displacement(int number, std::int64_t node) { displacements_[number].add(node); }
  /// Tells what is left out. Throws Error for nodes whose system came behind them and moves them.
  void finish(Listing& listing) const;

 private:
  struct System {
    std::optional<Vec3> origin;
    std::string what;
  };
  [[noreturn]] void refuse(int number, std::int64_t node, const std::string& what, const char* at) const;
  const Cursor& cursor_;
  std::map<int, System> systems_;
  std::map<int, std::pair<std::int64_t, const char*>> used_;  // before they were known: by a first node
  std::map<int, Losses> displacements_;
};

}  // namespace hextwist::io
