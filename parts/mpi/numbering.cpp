#include "hextwist/parts/mpi/numbering.h"

#include <algorithm>

#include "hextwist/base/types.h"

namespace hextwist {
namespace {

/// When the passes of this rank are made, among those of all. Passes that enclose come before one that trisects: ranks
/// that had fewer of the former wait.
std::vector<std::int64_t> turns(Ranks& ranks, const std::vector<PassRecord>& records, std::int64_t& n_turns) {
  using Kind = PassRecord::Kind;
  const auto first_other = std::ranges::find_if(records, [](const auto& r) { return r.kind != Kind::enclose; });
  const std::int64_t n_enclose = first_other - records.begin();
  const bool is_simple = std::all_of(first_other, records.end(), [](const auto& r) { return r.kind != Kind::enclose; });
  const bool has_any = !records.empty();
  const std::int64_t n_rest = std::ssize(records) - n_enclose;
  const std::int64_t most_enclose = ranks.largest(n_enclose), most_rest = ranks.largest(n_rest);
  // A rank that has only passes of one kind may have done without the others; in other orders nobody can tell.
  const bool fits = !has_any || (is_simple && (n_rest == most_rest || n_rest == 0));
  const bool is_regular_order = ranks.least(fits) != 0;
  const std::int64_t most = ranks.largest(std::ssize(records));
  const bool is_same = ranks.least(!has_any || std::ssize(records) == most) != 0;
  if (!is_regular_order && !is_same)
    throw Error(
        "the passes of this refinement depend on places far from each other, so parts can't make them alone; "
        "run it with one rank");
  std::vector<std::int64_t> turn;
  for (std::int64_t i = 0; i < std::ssize(records); ++i)
    turn.push_back(!is_regular_order || i < n_enclose ? i : most_enclose + i - n_enclose);
  n_turns = is_regular_order ? most_enclose + most_rest : most;
  return turn;
}

/// Numbers nodes at old nodes: those on edges or in faces. Returns how many there are in the whole.
std::int64_t number_at_nodes(Ranks& ranks, const std::vector<BroughtBy>& rows, std::int64_t next, GlobalIds& ids) {
  std::vector<KeyCounts> asked;
  for (const BroughtBy& row : rows) asked.push_back({ids.node[row.old], {row.n, 0}});
  const Starts starts = starts_by_key(ranks, asked, "node");
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (Index k = 0; k < rows[i].n; ++k) ids.node[rows[i].first + k] = next + starts.before[i][0] + k;
  return starts.total[0];
}

/// Local hexes that passes have made and the ids that they have in the end, where those between are left out.
void number_survivors(Ranks& ranks, std::int64_t before, GlobalIds& ids) {
  std::vector<KeyCounts> asked;
  for (const std::int64_t id : ids.hex)
    if (id > before) asked.push_back({id, {1, 0}});
  const Starts starts = starts_by_key(ranks, asked, "hex");
  std::size_t i = 0;
  for (std::int64_t& id : ids.hex)
    if (id > before) id = before + 1 + starts.before[i++][0];
  ids.highest_hex = before + starts.total[0];
}

}  // namespace

void number(Ranks& ranks, const std::vector<PassRecord>& records, bool by_levels, GlobalIds& ids) {
  std::int64_t n_turns = 0;
  const std::vector<std::int64_t> turn = turns(ranks, records, n_turns);
  const std::int64_t highest_before = ids.highest_hex;
  static const PassRecord none;
  std::size_t at = 0;
  for (std::int64_t t = 0; t < n_turns; ++t) {
    const bool is_mine = at < records.size() && turn[at] == t;
    const PassRecord& record = is_mine ? records[at++] : none;
    if (is_mine) ids.node.resize(static_cast<std::size_t>(record.n_nodes), -1);
    std::int64_t next = ids.highest_node + 1;
    const std::int64_t n_on_edges = number_at_nodes(ranks, record.edges, next, ids);
    const std::int64_t n_in_faces = number_at_nodes(ranks, record.faces, next + n_on_edges, ids);
    next += n_on_edges + n_in_faces;
    std::vector<KeyCounts> asked;
    for (const BroughtBy& row : record.hexes) asked.push_back({ids.hex[row.old], {row.n, row.n_children}});
    const Starts starts = starts_by_key(ranks, asked, "hex");
    if (is_mine) {
      std::vector<std::int64_t> hex(static_cast<std::size_t>(record.n_hexes), -1);
      for (const auto& [before, after] : record.kept) hex[after] = ids.hex[before];
      for (std::size_t i = 0; i < record.hexes.size(); ++i) {
        const BroughtBy& row = record.hexes[i];
        for (Index k = 0; k < row.n; ++k) ids.node[row.first + k] = next + starts.before[i][0] + k;
        for (Index k = 0; k < row.n_children; ++k)
          hex[row.first_child + k] = ids.highest_hex + 1 + starts.before[i][1] + k;
      }
      ids.hex = std::move(hex);
    }
    ids.highest_node += n_on_edges + n_in_faces + starts.total[0];
    ids.highest_hex += starts.total[1];
  }
  if (by_levels) number_survivors(ranks, highest_before, ids);
}

}  // namespace hextwist
