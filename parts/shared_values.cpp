#include "hextwist/parts/shared_values.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "hextwist/base/sorted.h"
#include "hextwist/base/text.h"
#include "hextwist/mesh/nodal_fields.h"

namespace hextwist {

std::vector<std::string> disagreement_lines(Disagreements differ, const std::string& name) {
  std::vector<std::string> lines;
  for (auto& [field, ids] : differ) {
    sort_unique(ids);
    if (ids.empty()) continue;
    lines.push_back(name + ": parts have different values of field '" + field + "' at " +
                    counted(std::ssize(ids), "node") + ", the first is node " + std::to_string(ids.front()) +
                    ": the lowest part that has a number there is right");
  }
  return lines;
}

bool settle_value(double& kept, double next) {
  const bool was_none = std::isnan(kept), is_none = std::isnan(next);
  if (is_none && was_none) return false;
  const bool differ = std::bit_cast<std::uint64_t>(kept) != std::bit_cast<std::uint64_t>(next);
  if (was_none) kept = next;
  return differ;
}

void SharedValues::settle(Mesh& part) {
  for (Field& field : part.fields) {
    if (field.on != Field::On::node || ids_.empty()) continue;
    const auto width = static_cast<std::size_t>(field.components);
    Known& known = known_[{field.name, field.components}];
    if (known.values.empty()) {
      known.values.resize(ids_.size() * width, std::numeric_limits<double>::quiet_NaN());
      known.is_there.resize(ids_.size(), 0);
    }
    std::size_t at = 0;
    for (Index n = 0; n < part.n_nodes(); ++n) {
      const std::int64_t id = node_id(part, n);
      while (at < ids_.size() && ids_[at] < id) ++at;
      if (at == ids_.size()) break;
      if (ids_[at] != id) continue;
      bool differs = false;
      for (std::size_t c = 0; c < width; ++c) {
        double &kept = known.values[at * width + c], &value = field.values[static_cast<std::size_t>(n) * width + c];
        if (!known.is_there[at]) {
          kept = value;
          continue;
        }
        const bool was_none = std::isnan(kept), is_other = settle_value(kept, value);
        differs = differs || is_other;
        has_come_late_ = has_come_late_ || (is_other && was_none);
        value = kept;
      }
      known.is_there[at] = 1;
      if (differs) differ_[field.name].push_back(id);
    }
  }
}

Disagreements settle_values(std::span<MeshedModel> parts) {
  if (std::ranges::none_of(parts, has_nodal_fields, &MeshedModel::mesh)) return {};
  std::vector<std::int64_t> all, shared;
  for (const MeshedModel& part : parts)
    for (Index n = 0; n < part.mesh.n_nodes(); ++n) all.push_back(node_id(part.mesh, n));
  std::ranges::sort(all);
  for (std::size_t i = 1; i < all.size(); ++i)
    if (all[i] == all[i - 1] && (shared.empty() || shared.back() != all[i])) shared.push_back(all[i]);
  all = {};
  SharedValues values(std::move(shared));
  while (values.begins_turn())
    for (MeshedModel& part : parts) values.settle(part.mesh);
  return values.differ();
}

}  // namespace hextwist
