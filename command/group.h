// Named collections of entities of any kind, for use in ranges: `curve in group "fillets"`, `refine curve in fillets`.
//
// A group knows its members by id (edges and faces by the ids of their nodes), so they survive what other commands do
// to the mesh; members that are no longer there, such as hexes that were split, count no longer.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "hextwist/mesh/entity.h"

namespace hextwist {

struct Group {
  int id = 0;
  std::string name;
  /// Per kind: ids, ascending. Of edges and faces: four node ids each, ascending, the last repeated where there are
  /// only two. Groups have no groups.
  std::array<std::vector<std::array<std::int64_t, 4>>, n_entity_kinds> members;
};

}  // namespace hextwist
