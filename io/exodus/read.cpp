// Exodus II through its library.
//
// Element blocks are blocks. Element sets are blocks as well: one with the id of an element block that lies wholly in
// it is that block (blocks that overlap are written so), any other one gets an id of its own if its id is taken.
// Blocks of anything but hexes are other elements (mesh/others.h), with their attributes. Ids that no int holds are
// replaced, with a note, and are there again when the mesh is written.
#include <numeric>

#include "hextwist/base/fenced.h"
#include "hextwist/io/exodus/reader_internal.h"

namespace hextwist::io {

ExodusReader::ExodusReader(const std::filesystem::path& path, std::string name, int number, int of)
    : name_(std::move(name)), is_slice_(of > 0) {
  Bytes bytes = read_bytes(path);
  bytes.name = name_;
  const bool classic = is_classic_netcdf(bytes);
  if (classic) check_classic_netcdf(bytes);
  most_items_ = static_cast<std::int64_t>(classic ? bytes.size / 4 : 300 * bytes.size);
  ex_opts(0);  // no messages on the terminal
  int memory = 8, disk = 0;
  float version = 0;
  file_.id = ex_open(path.c_str(), EX_READ, &memory, &disk, &version);
  if (file_.id < 0) fail("cannot be opened as Exodus II (damaged or another format)");
  // Positions fit an Index, whatever the file stores; the library refuses those that do not.
  ex_set_int64_status(file_.id, EX_IDS_INT64_API | EX_MAPS_INT64_API | EX_INQ_INT64_API);
  const auto length = ex_inquire_int(file_.id, EX_INQ_DB_MAX_USED_NAME_LENGTH);
  if (length > 0) ex_set_max_name_length(file_.id, static_cast<int>(std::min<std::int64_t>(length, NC_MAX_NAME)));
  // A file can claim any length; the library hands over no more than was set.
  name_length_ = static_cast<std::size_t>(std::clamp<std::int64_t>(length, 256, 4096));
  check(ex_get_init_ext(file_.id, &init_), "the sizes");
  const auto n = static_cast<std::int64_t>(size(init_.num_elem, "elements"));
  begin_ = is_slice_ ? n * number / of : 0;
  end_ = is_slice_ ? n * (number + 1) / of : n;
}

MeshFile ExodusReader::result() {
  number_groups(EX_ELEM_BLOCK, FileResults::Of::block, init_.num_elem_blk, "element block");
  number_groups(EX_ELEM_SET, FileResults::Of::block, init_.num_elem_sets, "element set");
  number_groups(EX_NODE_SET, FileResults::Of::node_set, init_.num_node_sets, "node set");
  number_groups(EX_SIDE_SET, FileResults::Of::side_set, init_.num_side_sets, "side set");
  if (is_slice_) find_nodes_of_slice();
  nodes();
  blocks();
  side_sets();
  node_sets();
  element_sets();
  finish_others();
  fields(EX_NODAL, Field::On::node);
  fields(EX_ELEM_BLOCK, Field::On::hex);
  out_.mesh.fields = merge_components(std::move(out_.mesh.fields));
  if (is_slice_) return std::move(out_);
  const auto group = [this](ex_entity_type type, std::int64_t id) { return group_id(type, id); };
  out_.mesh.results =
      read_extras({file_.id, name_, name_length_, init_, blocks_, hex_of_element_, nodes_, group, wide_ids_}, out_.mesh,
                  out_.notices);
  if (out_.mesh.results && out_.mesh.results->mesh) {
    out_.mesh.file_hexes.resize(out_.mesh.hexes.size());
    std::iota(out_.mesh.file_hexes.begin(), out_.mesh.file_hexes.end(), 0);
  }
  if (middles_.any()) take_middles(out_, middles_);
  return std::move(out_);
}

void ExodusReader::number_groups(ex_entity_type type, FileResults::Of of, std::int64_t n, const char* kind) {
  const Int64s all = ids(type, n);
  if (std::ranges::all_of(all, fits)) return;
  const ex_entity_type kept_as = type == EX_ELEM_SET ? EX_ELEM_BLOCK : type;
  Int64s taken = all;
  if (kept_as == EX_ELEM_BLOCK)
    for (const auto& [also, m] : {std::pair{EX_ELEM_BLOCK, init_.num_elem_blk}, {EX_ELEM_SET, init_.num_elem_sets}})
      for (const std::int64_t id : ids(also, m)) taken.push_back(id);
  for (const FileResults::WideId& wide : wide_ids_)
    if (wide.of == of) taken.push_back(wide.id);
  int next = 1;
  for (const std::int64_t id : all) {
    if (fits(id) || number_of_wide_.contains({kept_as, id})) continue;
    while (std::ranges::find(taken, next) != taken.end()) ++next;
    taken.push_back(next);
    number_of_wide_[{kept_as, id}] = next;
    wide_ids_.push_back({of, next, id});
    out_.notices.push_back(std::string(kind) + " " + std::to_string(id) + " has the id " + std::to_string(next) +
                           " here, where ids go from 0 to " + std::to_string(std::numeric_limits<int>::max()) +
                           "; Exodus files are written with its own");
  }
}

void ExodusReader::nodes() {
  if (init_.num_dim != 3) fail("has " + std::to_string(init_.num_dim) + " dimensions instead of 3");
  const auto n_in_file = size(init_.num_nodes, "nodes");
  const std::size_t n = is_slice_ ? positions_.size() : n_in_file;
  /// Of those that are read the first at a position or behind it, and the position of one.
  const auto read_before = [&](std::size_t position) {
    return is_slice_ ? static_cast<std::size_t>(std::ranges::lower_bound(positions_, static_cast<Index>(position)) -
                                                positions_.begin())
                     : position;
  };
  const auto position_of = [&](std::size_t i) { return is_slice_ ? static_cast<std::size_t>(positions_[i]) : i; };
  Int64s map;
  resize_for_overwrite(map, n);
  if (is_slice_)
    for_id_map(EX_NODE_MAP, 0, init_.num_nodes, [&](std::size_t first, std::span<const std::int64_t> ids) {
      for (std::size_t i = read_before(first); i < read_before(first + ids.size()); ++i)
        map[i] = ids[position_of(i) - first];
    });
  else if (n)
    check(ex_get_id_map(file_.id, EX_NODE_MAP, map.data()), "the node id map");
  resize_for_overwrite(out_.mesh.points, n);
  std::vector<double> x(exodus_piece), y(exodus_piece), z(exodus_piece);
  in_pieces(n_in_file, [&](std::size_t first, std::size_t size) {
    const std::size_t begin = read_before(first), end = read_before(first + size);
    if (begin == end) return;
    check(
        ex_get_partial_coord(file_.id, exodus_position(first), exodus_position(size - 1), x.data(), y.data(), z.data()),
        "coordinates");
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t i = position_of(k) - first;
      Vec3& point = out_.mesh.points[k];
      point = Vec3(x[i], y[i], z[i]);
      if (!point.allFinite()) fail("a coordinate of node " + std::to_string(map[k]) + " is not finite");
    }
  });
  // The library takes the file's first variable for none, so x = 0 where that is what is first.
  if (init_.num_elem > 0 && n > 0 && std::ranges::all_of(out_.mesh.points, [](const Vec3& p) { return p.x() == 0; }))
    fail(
        "x is 0 at all nodes, or the file's first variable, which the Exodus library can't read: copy it with "
        "'ncks' or 'io_shell'");
  nodes_ = Ids(std::move(map), "node", [&](std::size_t, const std::string& what) { fail(what); });
  nodes_.sort(out_.mesh.points);
  out_.mesh.node_ids = nodes_.stored();
}

std::vector<ex_block> ExodusReader::element_blocks() const {
  std::vector<ex_block> blocks;
  std::int64_t n = 0;
  for (const std::int64_t id : ids(EX_ELEM_BLOCK, init_.num_elem_blk)) {
    ex_block& block = blocks.emplace_back();
    block.id = id;
    block.type = EX_ELEM_BLOCK;
    check(ex_get_block_param(file_.id, &block), "element block " + std::to_string(id));
    n += static_cast<std::int64_t>(size(block.num_entry, "elements"));
    if (n > init_.num_elem) fail("the blocks have more elements than the file says");
  }
  return blocks;
}

void ExodusReader::blocks() {
  const auto n_elements = static_cast<std::size_t>(end_ - begin_);
  Int64s map;
  resize_for_overwrite(map, n_elements);
  if (is_slice_)
    for_id_map(EX_ELEM_MAP, begin_, end_, [&](std::size_t first, std::span<const std::int64_t> ids) {
      std::ranges::copy(ids, map.begin() + static_cast<std::ptrdiff_t>(first));
    });
  else if (n_elements)
    check(ex_get_id_map(file_.id, EX_ELEM_MAP, map.data()), "the element id map");
  reserve_large(out_.mesh.hexes, n_elements);
  resize_large(hex_of_element_, n_elements, Index{-1});
  heads_.format = "exodus";
  std::int64_t first = 0;
  for (const ex_block& block : element_blocks()) {
    const Range here = in_slice(first, block.num_entry);
    read_block(block, std::span(map).subspan(here.first - begin_, here.n), here.first - begin_, here.first - first);
    first += block.num_entry;
  }
  if (out_.mesh.hexes.empty() && !is_slice_) fail("there is no hex in the file" + only_others());
  if (out_.mesh.hexes.size() < map.size()) {
    std::size_t n_kept = 0;
    for (std::size_t e = 0; e < map.size(); ++e)
      if (hex_of_element_[e] >= 0)
        map[n_kept++] = map[e];
      else if (const Index other = other_of(static_cast<std::int64_t>(e)); other >= 0)
        heads_.ids[other] = map[e];
    map.resize(n_kept);
  }
  hexes_ = Ids(std::move(map), "element", [&](std::size_t, const std::string& what) { fail(what); });
  middles_.finish(out_.mesh.hexes.size());
  if (middles_.any()) hexes_.sort(middles_.nodes, FoundMiddles::width);
  hexes_.sort(out_.mesh.hexes);
  out_.mesh.hex_ids = hexes_.stored();
  if (!hexes_.place().empty())
    for (Index& hex : hex_of_element_)
      if (hex >= 0) hex = hexes_.place()[hex];
  for (const FileBlock& block : blocks_) {
    if (!block.hexes) continue;
    const std::string name = group_name(EX_ELEM_BLOCK, block.id);
    if (name == exodus_rest_block) continue;
    Block& to = group_of_id(out_.mesh.blocks, group_id(EX_ELEM_BLOCK, block.id));
    to.name = name;
    grow_large(to.hexes, static_cast<std::size_t>(block.n));
    to.hexes.insert(to.hexes.end(), hex_of_element_.begin() + block.first,
                    hex_of_element_.begin() + block.first + block.n);
    sort_unique(to.hexes);
  }
  other_blocks();
}

void ExodusReader::read_block(const ex_block& block, std::span<const std::int64_t> map, std::int64_t first,
                              std::int64_t skipped) {
  const std::string name = "element block " + std::to_string(block.id);
  const std::string type = lower_case(block.topology);
  const auto starts = [&](std::string_view word) { return type.starts_with(word); };
  const auto n_nodes = block.num_nodes_per_entry;
  const bool hexes = map.empty() ? is_unnamed(type) || starts("hex") || is_slice_ : has_hexes(type, n_nodes);
  blocks_.push_back({block.id, first, std::ssize(map), hexes, skipped, block.num_entry});
  if (map.empty()) return;
  const int type_of_others = hexes ? -1 : other_type(block.topology, type, static_cast<int>(n_nodes));
  if (!hexes && type_of_others < 0)
    fail(name + ": element " + std::to_string(map[0]) + " is of type " + block.topology + " with " +
         std::to_string(n_nodes) + " nodes; only hexes of 8, 20 or 27 nodes, and spheres, bars, triangles, shells, " +
         "tetrahedra, pyramids and wedges beside them are accepted");
  if (!hexes) {
    if (other_of_element_.empty()) other_of_element_.resize(hex_of_element_.size(), -1);
    const OtherType& of = heads_.types[type_of_others];
    swaps_ = of.shape == OtherShape::wedge && of.n_nodes == 15;
  }
  Ints nodes(exodus_piece * static_cast<std::size_t>(n_nodes));
  in_pieces(map.size(), [&](std::size_t begin, std::size_t size) {
    check(ex_get_partial_conn(file_.id, EX_ELEM_BLOCK, block.id, skipped + exodus_position(begin),
                              exodus_position(size - 1), nodes.data(), nullptr, nullptr),
          "nodes of " + name);
    const auto used = std::span(nodes).first(size * static_cast<std::size_t>(n_nodes));
    indices(used, [&](std::size_t i) { return map[begin + i / static_cast<std::size_t>(n_nodes)]; });
    const std::size_t first_element = static_cast<std::size_t>(first) + begin;
    if (hexes) {
      const std::size_t n_before = out_.mesh.hexes.size();
      resize_for_overwrite(out_.mesh.hexes, n_before + size);
      for (std::size_t k = 0; k < size; ++k) {
        Hex hex;
        const std::size_t width = static_cast<std::size_t>(n_nodes);
        std::copy_n(&nodes[width * k], 8, hex.begin());
        out_.mesh.hexes[n_before + k] = in_file_order(hex);
        if (n_nodes > 8) middles_.add(n_before + k, std::span(nodes).subspan(width * k + 8, width - 8), exodus_middles);
        hex_of_element_[first_element + k] = static_cast<Index>(n_before + k);
      }
    } else {
      for (std::size_t k = 0; k < size; ++k) {
        other_of_element_[first_element + k] = static_cast<Index>(heads_.ids.size());
        heads_.ids.push_back(0);  // when the map is sorted out
        heads_.type.push_back(type_of_others);
        const auto width = static_cast<std::ptrdiff_t>(n_nodes);
        const auto own = nodes.begin() + width * static_cast<std::ptrdiff_t>(k);
        if (swaps_) std::swap_ranges(own + 9, own + 12, own + 12);
        other_nodes_.insert(other_nodes_.end(), own, own + width);
        other_first_.push_back(static_cast<Index>(other_nodes_.size()));
      }
    }
  });
}

void ExodusReader::fields(ex_entity_type type, Field::On on) {
  int n = 0;
  check(ex_get_variable_param(file_.id, type, &n), "fields");
  const auto n_steps = ex_inquire_int(file_.id, EX_INQ_TIME);
  if (n <= 0 || n_steps <= 0) return;
  for (int v = 1; v <= n; ++v) {
    std::string name(name_length_ + 1, '\0');
    check(ex_get_variable_name(file_.id, type, v, name.data()), "names of fields");
    Field field{std::string(trimmed(name.c_str())), on, 1, {}};
    const int step = static_cast<int>(n_steps);
    if (on == Field::On::node) {
      field.values.resize(out_.mesh.points.size());
      const int status = is_slice_ ? values_in_slice(step, v, field.values)
                                   : ex_get_var(file_.id, step, type, v, 1, init_.num_nodes, field.values.data());
      check(status, "field " + field.name);
      if (status != 0) {  // the library's warning
        out_.notices.push_back("field '" + field.name + "' is named in the file, which has no values of it: left out");
        continue;
      }
      nodes_.sort(field.values);
    } else {
      field.values.assign(out_.mesh.hexes.size(), std::numeric_limits<double>::quiet_NaN());
      bool any = false;
      for (const FileBlock& block : blocks_) {
        if (!block.hexes || block.n_in_file == 0) continue;
        // A slice that has nothing of the block asks whether there are any as well: all slices have the same fields.
        std::vector<double> values(static_cast<std::size_t>(std::max<std::int64_t>(block.n, 1)));
        if (ex_get_partial_var(file_.id, step, type, v, block.id, block.n == 0 ? 1 : block.skipped + 1,
                               std::ssize(values), values.data()) != 0)
          continue;  // not on this block
        any = true;
        for (std::int64_t i = 0; i < block.n; ++i) field.values[hex_of_element_[block.first + i]] = values[i];
      }
      if (!any) continue;
    }
    out_.mesh.fields.push_back(std::move(field));
  }
}

MeshFile read_exodus(const std::filesystem::path& file, const Fence& fence) {
  if (!fence.is_there() || is_classic_netcdf(read_bytes(file))) return ExodusReader(file, file.string()).result();
  const Handover plain;
  read_fenced(fence, fenced_hdf5, file, {}, plain);
  return ExodusReader(plain.path(), file.string()).result();
}

}  // namespace hextwist::io
