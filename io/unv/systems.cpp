#include "hextwist/io/unv/systems.h"

namespace hextwist::io {

void UnvSystems::add(int number, std::optional<Vec3> origin, const std::string& what) {
  systems_[number] = {origin, what};
}

void UnvSystems::refuse(int number, std::int64_t node, const std::string& what, const char* at) const {
  cursor_.fail_at(at, "node " + std::to_string(node) + " is in coordinate system " + std::to_string(number) +
                          ", which " + what + "; only Cartesian ones that are not turned are read");
}

Vec3 UnvSystems::global(int number, std::int64_t node, const Vec3& point, const char* at) {
  const auto found = systems_.find(number);
  if (found == systems_.end()) {
    used_.try_emplace(number, node, at);
    return point;
  }
  if (!found->second.origin) refuse(number, node, found->second.what, at);
  return point + *found->second.origin;
}

void UnvSystems::finish(Listing& listing) const {
  for (const auto& [number, first] : used_) {
    const auto found = systems_.find(number);
    if (found == systems_.end()) {
      if (number > 1)  // 0 and 1 are the global one
        listing.note("node " + std::to_string(first.first) + " is in coordinate system " + std::to_string(number) +
                     ", which the file does not define: such nodes are read as they stand");
      continue;
    }
    if (!found->second.origin) refuse(number, first.first, found->second.what, first.second);
    if (*found->second.origin != Vec3::Zero())
      refuse(number, first.first, "is defined behind it and has an origin of its own", first.second);
  }
  Losses turned;
  for (const auto& [number, nodes] : displacements_)
    if (const auto found = systems_.find(number); found != systems_.end() && !found->second.origin) turned.add(nodes);
  turned.tell(listing, "coordinate systems of displacements", "node");
}

}  // namespace hextwist::io
