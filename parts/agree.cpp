#include "hextwist/parts/agree.h"

#include "hextwist/base/sorted.h"

namespace hextwist {

HaloMade made_of_halo(const LocalMesh& local, std::span<const std::uint64_t> digest, int n_parts) {
  HaloMade made;
  made.of.resize(static_cast<std::size_t>(n_parts));
  made.ring.resize(made.of.size());
  for (std::size_t i = 0; i < local.base.hex.size(); ++i) {
    const std::uint8_t r = local.base.ring[i];
    if (r == 0 || r > local.n_rings) continue;
    made.of[local.base.owner[i]].push_back({local.base.hex[i], digest[i]});
    made.ring[local.base.owner[i]].push_back(r);
  }
  return made;
}

std::vector<std::uint8_t> is_same(std::span<const Made> theirs, const BaseHexes& base,
                                  std::span<const std::uint64_t> digest) {
  std::vector<std::uint8_t> same;
  same.reserve(theirs.size());
  for (const Made& each : theirs) {
    const Index mine = position_in(base.hex, each.hex);
    same.push_back(mine >= 0 && digest[mine] == each.digest);
  }
  return same;
}

}  // namespace hextwist
