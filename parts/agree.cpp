#include "hextwist/parts/agree.h"

#include <algorithm>

#include "hextwist/base/sorted.h"
#include "hextwist/base/text.h"

namespace hextwist {

Verdict verdict_of(int alike, int n_rings, const std::string& by_whole, bool have_all) {
  if (have_all) {
    if (alike < n_rings) throw Error("parts can't be brought to agree about hexes between them");
    return Verdict::right;
  }
  if (!by_whole.empty()) return Verdict::needs_all;
  return alike < least_rings ? Verdict::too_narrow : Verdict::right;
}

int rings_to_keep(int alike, bool have_all) {
  return have_all ? alike : alike - 1;
}

std::string depends_on_far(int n_rings) {
  return "what is made depends on places more than " + counted(n_rings, "ring") + " of hexes away";
}

int first_rings(int wished, int depth, std::size_t n_commands) {
  const std::size_t lost = std::min<std::size_t>(n_commands, most_rings) - 1;
  return std::min(std::max(wished, least_rings) + depth + static_cast<int>(lost), most_rings);
}

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
