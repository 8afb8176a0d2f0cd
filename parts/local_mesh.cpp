#include "hextwist/parts/local_mesh.h"

#include <algorithm>
#include <functional>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/base/text.h"
#include "hextwist/mesh/arrays.h"
#include "hextwist/patch/patch.h"
#include "hextwist/sizing/size_report.h"

namespace hextwist {

std::size_t array_bytes(const LocalMesh& local) {
  return bytes_of_arrays(local.meshed);
}

std::int64_t n_own_hexes(const LocalMesh& local) {
  return std::ranges::count_if(local.base_of, [&](Index b) { return local.base.ring[b] == 0; });
}

Box own_box(const LocalMesh& local) {
  Box box;
  for (Index h = 0; h < local.meshed.mesh.n_hexes(); ++h)
    if (local.is_own(h))
      for (const Index n : local.meshed.mesh.hexes[h]) box.add(local.meshed.mesh.points[n]);
  return box;
}

void SizeCounts::add(const SizeCounts& more) {
  met.add(more.met);
  unmet += more.unmet;
}

std::string text_of(const SizeCounts& counts) {
  if (counts.met.n_hexes == 0) return {};
  return "actual / wished size of " + counted(counts.met.n_hexes, "hex", "hexes") + ": " + text_of_sizes(counts.met) +
         (counts.unmet > 0 ? ", " + std::to_string(counts.unmet) + " still too large" : "");
}

void trim(LocalMesh& local, int n_rings, GlobalIds& ids) {
  local.n_rings = std::min(local.n_rings, n_rings);
  const Index n = local.meshed.mesh.n_hexes();
  const std::vector<Index> stay =
      indices_where(n, [&](Index h) { return local.base.ring[local.base_of[h]] <= n_rings; });
  if (std::ssize(stay) < n) {
    Patch patch = take_patch(local.meshed, stay);
    local.base_of = items_at(local.base_of, patch.hexes);
    local.meshed = std::move(patch.meshed);
    ids.node = items_at(ids.node, patch.nodes);
    ids.hex = items_at(ids.hex, patch.hexes);
  }
  // All else rests on this: rules of refining compare numbers, which must be in the order of those of the whole.
  const auto ascend = [](const std::vector<std::int64_t>& list) {
    return (list.empty() || list[0] > 0) && std::ranges::adjacent_find(list, std::greater_equal()) == list.end();
  };
  if (!ascend(ids.node) || !ascend(ids.hex)) throw Error("a part has come out of the order of ids");
}

}  // namespace hextwist
