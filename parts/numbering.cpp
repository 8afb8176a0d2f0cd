#include "hextwist/parts/numbering.h"

#include <algorithm>

#include "hextwist/base/types.h"

namespace hextwist {
namespace {

std::vector<Run> runs_at(std::span<const BroughtBy> rows, std::span<const std::int64_t> ids) {
  std::vector<Run> runs;
  for (const BroughtBy& row : rows) add_key(runs, ids[row.old], {row.n, row.n_children});
  return runs;
}

/// Calls use(row, counts of all keys below that of the row).
template <class Use>
void for_each_start(std::span<const BroughtBy> rows, std::span<const Run> runs, std::span<const Counts> before,
                    const Use& use) {
  std::size_t i = 0;
  for (std::size_t r = 0; r < runs.size(); ++r)
    for (std::int64_t k = 0; k < runs[r].n; ++k)
      use(rows[i++], Counts{before[r][0] + k * runs[r].each[0], before[r][1] + k * runs[r].each[1]});
}

}  // namespace

const PassRecord* pass_at(std::span<const PassRecord> records, const Turn& turn) {
  const auto found = std::ranges::find(records, turn, &PassRecord::turn);
  return found == records.end() ? nullptr : &*found;
}

RunLists brought_by(const PassRecord& record, const GlobalIds& ids) {
  return {runs_at(record.edges, ids.node), runs_at(record.faces, ids.node), runs_at(record.hexes, ids.hex)};
}

void number_pass(const PassRecord* record, const RunLists& runs, const PassSums& sums, GlobalIds& ids) {
  std::array<std::int64_t, n_bringers> next{};  // ids of what the bringers of a kind bring start here
  next[0] = ids.highest_node + 1;
  for (std::size_t k = 1; k < n_bringers; ++k) next[k] = next[k - 1] + sums.total[k - 1][0];
  if (record) {
    ids.node.resize(static_cast<std::size_t>(record->n_nodes), -1);
    const std::array<std::span<const BroughtBy>, n_bringers> rows = {record->edges, record->faces, record->hexes};
    for (std::size_t k = 0; k < n_bringers; ++k)
      for_each_start(rows[k], runs[k], sums.before[k], [&](const BroughtBy& row, const Counts& before) {
        for (Index i = 0; i < row.n; ++i) ids.node[row.first + i] = next[k] + before[0] + i;
      });
    std::vector<std::int64_t> hex(static_cast<std::size_t>(record->n_hexes), -1);
    for (const auto& [before, after] : record->kept) hex[after] = ids.hex[before];
    for_each_start(rows[2], runs[2], sums.before[2], [&](const BroughtBy& row, const Counts& before) {
      for (Index i = 0; i < row.n_children; ++i) hex[row.first_child + i] = ids.highest_hex + 1 + before[1] + i;
    });
    ids.hex = std::move(hex);
  }
  for (const Counts& total : sums.total) ids.highest_node += total[0];
  ids.highest_hex += sums.total[2][1];
}

std::vector<Run> survivors(std::int64_t before, const GlobalIds& ids) {
  std::vector<std::int64_t> there;
  for (const std::int64_t id : ids.hex)
    if (id > before) there.push_back(id);
  std::ranges::sort(there);
  std::vector<Run> runs;
  for (const std::int64_t id : there) add_key(runs, id, {1, 0});
  return runs;
}

void number_survivors(std::int64_t before, std::span<const Run> runs, std::span<const Counts> starts,
                      std::int64_t n_in_whole, GlobalIds& ids) {
  for (std::int64_t& id : ids.hex) {
    if (id <= before) continue;
    const auto run = std::ranges::upper_bound(runs, id, {}, &Run::first) - 1;
    id = before + 1 + starts[static_cast<std::size_t>(run - runs.begin())][0] + id - run->first;
  }
  ids.highest_hex = before + n_in_whole;
}

}  // namespace hextwist
