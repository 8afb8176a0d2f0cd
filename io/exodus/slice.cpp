// Exodus II in slices: of each array what the slice has, in pieces.
#include "hextwist/io/exodus/reader_internal.h"

namespace hextwist::io {

Unsliced ExodusReader::against_slices(std::int64_t& highest_node) const {
  if (init_.num_elem == 0) return {"no elements"};
  const std::vector<ex_block> blocks = element_blocks();
  for (const ex_block& block : blocks) {
    if (block.num_entry == 0) continue;
    const std::string in_block = " (element block " + std::to_string(block.id) + ")";
    if (!has_hexes(lower_case(block.topology), block.num_nodes_per_entry))
      return {"elements of type " + std::string(block.topology) + in_block};
    if (block.num_nodes_per_entry != 8)
      return {"hexes of " + std::to_string(block.num_nodes_per_entry) + " nodes" + in_block};
  }
  for (const std::int64_t id : ids(EX_ELEM_SET, init_.num_elem_sets))
    if (std::ranges::find(blocks, id, &ex_block::id) != blocks.end())
      return {"blocks that overlap (element set " + std::to_string(id) + " is more of an element block)"};
  for (const auto& [type, n] : {std::pair{EX_ELEM_BLOCK, init_.num_elem_blk},
                                {EX_ELEM_SET, init_.num_elem_sets},
                                {EX_NODE_SET, init_.num_node_sets},
                                {EX_SIDE_SET, init_.num_side_sets}})
    for (const std::int64_t id : ids(type, n))
      if (!fits(id)) return {"a block or set of the id " + std::to_string(id), true};
  std::int64_t highest_hex = 0;
  if (occur_once(EX_NODE_MAP, init_.num_nodes, highest_node) && occur_once(EX_ELEM_MAP, init_.num_elem, highest_hex))
    return {};
  return {"ids that are out of order, and far apart or there twice", true};
}

bool ExodusReader::occur_once(ex_entity_type map, std::int64_t n, std::int64_t& highest) const {
  std::int64_t low = std::numeric_limits<std::int64_t>::max(), high = 0, last = 0;
  bool ascend = true;
  for_id_map(map, 0, n, [&](std::size_t, std::span<const std::int64_t> ids) {
    for (const std::int64_t id : ids) {
      ascend = ascend && id > last;
      last = id;
      low = std::min(low, id);
      high = std::max(high, id);
    }
  });
  highest = high;
  if (ascend) return true;
  if (low < 1 || (high - low) / 64 > n) return false;
  std::vector<bool> is_there(static_cast<std::size_t>(high - low + 1), false);
  bool once = true;
  for_id_map(map, 0, n, [&](std::size_t, std::span<const std::int64_t> ids) {
    for (const std::int64_t id : ids) {
      once = once && !is_there[static_cast<std::size_t>(id - low)];
      is_there[static_cast<std::size_t>(id - low)] = true;
    }
  });
  return once;
}

void ExodusReader::find_nodes_of_slice() {
  is_here_ = RankedBits(size(init_.num_nodes, "nodes"));
  Ints nodes(exodus_piece * n_hex_corners);
  std::int64_t first = 0;
  for (const ex_block& block : element_blocks()) {
    const Range here = in_slice(first, block.num_entry);
    in_pieces(static_cast<std::size_t>(here.n), [&](std::size_t begin, std::size_t n) {
      check(ex_get_partial_conn(file_.id, EX_ELEM_BLOCK, block.id, here.first - first + exodus_position(begin),
                                static_cast<std::int64_t>(n), nodes.data(), nullptr, nullptr),
            "nodes of element block " + std::to_string(block.id));
      for (const int position : std::span(nodes).first(n * n_hex_corners))
        if (position >= 1 && position <= init_.num_nodes) is_here_.set(position - 1);  // others are refused later
    });
    first += block.num_entry;
  }
  is_here_.finish();
  positions_ = is_here_.list();
}

int ExodusReader::values_in_slice(int step, int variable, std::vector<double>& values) const {
  std::vector<double> piece(exodus_piece);
  int status = 0;
  std::size_t at = 0;
  in_pieces(static_cast<std::size_t>(init_.num_nodes), [&](std::size_t first, std::size_t n) {
    if (status != 0) return;
    status = ex_get_partial_var(file_.id, step, EX_NODAL, variable, 1, exodus_position(first),
                                static_cast<std::int64_t>(n), piece.data());
    for (; at < positions_.size() && static_cast<std::size_t>(positions_[at]) < first + n; ++at)
      values[at] = piece[static_cast<std::size_t>(positions_[at]) - first];
  });
  return status;
}

MeshSlice ExodusReader::slice() {
  MeshSlice slice;
  slice.file = result();
  std::vector<std::string> lost;
  const auto group = [this](ex_entity_type type, std::int64_t id) { return group_id(type, id); };
  slice.file.mesh.results =
      read_extras_of_whole({file_.id, name_, name_length_, init_, blocks_, hex_of_element_, nodes_, group, wide_ids_},
                           slice.file.notices, lost);
  slice.left_out = joined(lost, ", ");
  return slice;
}

std::optional<SlicedFile> exodus_in_slices(const std::filesystem::path& file, const Fence& fence, Unsliced& why) {
  // Behind the fence all of the file would be handed over for each slice.
  if (fence.is_there() && !is_classic_netcdf(read_bytes(file))) {
    why = {"the form of HDF5 (NetCDF-4), which is read behind a fence", true};
    return std::nullopt;
  }
  const ExodusReader reader(file, file.string());
  std::int64_t highest_node = 0;
  why = reader.against_slices(highest_node);
  if (!why.what.empty()) return std::nullopt;
  return SlicedFile{file, reader.sizes().num_nodes, reader.sizes().num_elem, highest_node};
}

MeshSlice read_exodus_slice(const SlicedFile& file, int number, int n) {
  ExodusReader reader(file.file, file.file.string(), number, n);
  if (reader.sizes().num_nodes != file.n_nodes || reader.sizes().num_elem != file.n_hexes)
    throw Error(file.file.string() + ": was changed while it was read");
  return reader.slice();
}

}  // namespace hextwist::io
