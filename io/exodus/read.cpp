// Exodus II through its library.
//
// Element blocks are blocks. Element sets are blocks as well: one with the id of an element block that lies wholly in
// it is that block (blocks that overlap are written so), any other one gets an id of its own if its id is taken.
// Blocks of anything but hexes are other elements (mesh/others.h), with their attributes. Ids that no int holds are
// replaced, with a note, and are there again when the mesh is written.
#include <limits>
#include <map>
#include <numeric>
#include <optional>

#include "hextwist/base/fenced.h"
#include "hextwist/base/large_array.h"
#include "hextwist/base/sorted.h"
#include "hextwist/base/text.h"
#include "hextwist/io/exodus/exodus_internal.h"
#include "hextwist/mesh/others.h"

namespace hextwist::io {
namespace {

using Int64s = std::vector<std::int64_t>;
using Ints = std::vector<int>;

class ExodusReader {
 public:
  /// path: where the bytes of the file are.
  ExodusReader(const std::filesystem::path& path, std::string name) : name_(std::move(name)) {
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
  }

  MeshFile result() {
    number_groups(EX_ELEM_BLOCK, FileResults::Of::block, init_.num_elem_blk, "element block");
    number_groups(EX_ELEM_SET, FileResults::Of::block, init_.num_elem_sets, "element set");
    number_groups(EX_NODE_SET, FileResults::Of::node_set, init_.num_node_sets, "node set");
    number_groups(EX_SIDE_SET, FileResults::Of::side_set, init_.num_side_sets, "side set");
    nodes();
    blocks();
    side_sets();
    node_sets();
    element_sets();
    finish_others();
    fields(EX_NODAL, Field::On::node);
    fields(EX_ELEM_BLOCK, Field::On::hex);
    out_.mesh.fields = merge_components(std::move(out_.mesh.fields));
    const auto group = [this](ex_entity_type type, std::int64_t id) { return group_id(type, id); };
    out_.mesh.results =
        read_extras({file_.id, name_, name_length_, init_, blocks_, hex_of_element_, nodes_, group, wide_ids_},
                    out_.mesh, out_.notices);
    if (out_.mesh.results && out_.mesh.results->mesh) {
      out_.mesh.file_hexes.resize(out_.mesh.hexes.size());
      std::iota(out_.mesh.file_hexes.begin(), out_.mesh.file_hexes.end(), 0);
    }
    if (middles_.any()) take_middles(out_, middles_);
    return std::move(out_);
  }

 private:
  struct Handle {
    int id = -1;
    ~Handle() {
      if (id >= 0) ex_close(id);
    }
  };
  using FileBlock = ExodusSource::Block;

  [[noreturn]] void fail(const std::string& what) const { throw Error(name_ + ": " + what); }
  void check(int status, const std::string& what) const {
    if (status < 0) fail(what + " cannot be read (damaged file)");
  }
  /// A number of items, each at least four bytes in the file (HDF5 files can be compressed, at most about a
  /// thousandfold): a damaged one must not become a huge allocation.
  std::size_t size(std::int64_t n, const std::string& what) const {
    if (n < 0 || n > std::min<std::int64_t>(most_items_, std::numeric_limits<Index>::max()))
      fail("impossible number of " + what + ": " + std::to_string(n));
    return static_cast<std::size_t>(n);
  }
  Int64s ids(ex_entity_type type, std::int64_t n) const {
    Int64s result(size(n, "groups"));
    if (n > 0) check(ex_get_ids(file_.id, type, result.data()), "ids of groups");
    return result;
  }
  std::string group_name(ex_entity_type type, std::int64_t id) const {
    std::string name(name_length_ + 1, '\0');
    if (ex_get_name(file_.id, type, id, name.data()) < 0) return "";
    name.resize(std::strlen(name.c_str()));
    return std::string(trimmed(name));
  }
  static bool fits(std::int64_t id) { return id >= 0 && id <= std::numeric_limits<int>::max(); }
  /// The id here of a group of the file.
  int group_id(ex_entity_type type, std::int64_t id) const {
    return fits(id) ? static_cast<int>(id) : number_of_wide_.at({type == EX_ELEM_SET ? EX_ELEM_BLOCK : type, id});
  }
  /// Ids here for those that do not fit, the lowest that no other group of this kind has.
  void number_groups(ex_entity_type type, FileResults::Of of, std::int64_t n, const char* kind) {
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

  void nodes() {
    if (init_.num_dim != 3) fail("has " + std::to_string(init_.num_dim) + " dimensions instead of 3");
    const auto n = size(init_.num_nodes, "nodes");
    Int64s map;
    resize_for_overwrite(map, n);
    if (n) check(ex_get_id_map(file_.id, EX_NODE_MAP, map.data()), "the node id map");
    resize_for_overwrite(out_.mesh.points, n);
    std::vector<double> x(exodus_piece), y(exodus_piece), z(exodus_piece);
    in_pieces(n, [&](std::size_t first, std::size_t size) {
      check(ex_get_partial_coord(file_.id, exodus_position(first), exodus_position(size - 1), x.data(), y.data(),
                                 z.data()),
            "coordinates");
      for (std::size_t i = 0; i < size; ++i) {
        Vec3& point = out_.mesh.points[first + i];
        point = Vec3(x[i], y[i], z[i]);
        if (!point.allFinite()) fail("a coordinate of node " + std::to_string(map[first + i]) + " is not finite");
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
  /// Index of the node at a 1-based position in the file.
  Index node(std::int64_t position, const std::string& who) const {
    if (position < 1 || position > nodes_.size())
      fail(who + " names node " + std::to_string(position) + " of " + std::to_string(nodes_.size()));
    return nodes_.place().empty() ? static_cast<Index>(position - 1) : nodes_.place()[position - 1];
  }

  void blocks() {
    const auto n_elements = size(init_.num_elem, "elements");
    Int64s map;
    resize_for_overwrite(map, n_elements);
    if (n_elements) check(ex_get_id_map(file_.id, EX_ELEM_MAP, map.data()), "the element id map");
    reserve_large(out_.mesh.hexes, n_elements);
    resize_large(hex_of_element_, n_elements, Index{-1});
    heads_.format = "exodus";
    std::int64_t first = 0;
    for (const std::int64_t id : ids(EX_ELEM_BLOCK, init_.num_elem_blk)) {
      ex_block block{};
      block.id = id;
      block.type = EX_ELEM_BLOCK;
      check(ex_get_block_param(file_.id, &block), "element block " + std::to_string(id));
      const auto n = static_cast<std::int64_t>(size(block.num_entry, "elements"));
      if (first + n > init_.num_elem) fail("the blocks have more elements than the file says");
      read_block(block, std::span(map).subspan(first, n), first);
      first += n;
    }
    if (out_.mesh.hexes.empty()) fail("there is no hex in the file" + only_others());
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

  /// ", but 12 SHELL4 (element block 3)"
  std::string only_others() const {
    std::string text;
    for (const FileBlock& block : blocks_)
      if (block.n > 0)
        text += (text.empty() ? ", but " : ", ") + std::to_string(block.n) + " " +
                heads_.types[heads_.type[other_of(block.first)]].name + " (element block " + std::to_string(block.id) +
                ")";
    return text;
  }

  void other_blocks() {
    if (heads_.ids.empty()) return;
    const Ids ids(heads_.ids, "element", [&](std::size_t, const std::string& what) { fail(what); });
    for (const std::int64_t id : heads_.ids)
      if (hexes_.find(id) >= 0) fail("element id " + std::to_string(id) + " occurs twice");
    for (const FileBlock& block : blocks_) {
      if (block.hexes || block.n == 0) continue;
      const int id = group_id(EX_ELEM_BLOCK, block.id);
      const std::string name = group_name(EX_ELEM_BLOCK, block.id);
      other_attributes(block);
      if (name == exodus_rest_block) continue;
      group_of_id(out_.mesh.blocks, id).name = name;
      OtherSet set{id, std::vector<Index>(static_cast<std::size_t>(block.n))};
      std::iota(set.elements.begin(), set.elements.end(), other_of(block.first));
      heads_.sets.push_back(std::move(set));
    }
  }

  void other_attributes(const FileBlock& block) {
    int n = 0;
    if (ex_get_attr_param(file_.id, EX_ELEM_BLOCK, block.id, &n) < 0 || n <= 0) return;
    const std::size_t length = std::max<std::size_t>(name_length_, MAX_STR_LENGTH) + 1;
    std::vector<std::string> names(size(n, "attributes"), std::string(length, '\0'));
    std::vector<char*> pointers;
    for (std::string& name : names) pointers.push_back(name.data());
    check(ex_get_attr_names(file_.id, EX_ELEM_BLOCK, block.id, pointers.data()), "names of attributes");
    for (std::size_t a = 0; a < names.size(); ++a) {
      OtherField field{std::string(trimmed(names[a].c_str())), 1, {}, true, false};
      if (field.name.empty()) field.name = "attribute_" + std::to_string(a + 1);
      std::vector<double> of_block(static_cast<std::size_t>(block.n));
      check(ex_get_one_attr(file_.id, EX_ELEM_BLOCK, block.id, static_cast<int>(a) + 1, of_block.data()),
            "attribute " + field.name);
      field.values.assign(heads_.ids.size(), std::numeric_limits<double>::quiet_NaN());
      std::ranges::copy(of_block, field.values.begin() + other_of(block.first));
      heads_.fields.push_back(std::move(field));
    }
  }

  /// Adds the other elements when all is said of them.
  void finish_others() {
    if (heads_.ids.empty()) return;
    std::vector<std::string> lost;
    int n = 0;
    if (ex_get_variable_param(file_.id, EX_ELEM_BLOCK, &n) >= 0 && n > 0 && ex_inquire_int(file_.id, EX_INQ_TIME) > 0)
      for (int v = 1; v <= n; ++v)
        for (const FileBlock& block : blocks_) {
          if (block.hexes || block.n == 0) continue;
          std::vector<double> values(static_cast<std::size_t>(block.n));
          if (ex_get_var(file_.id, 1, EX_ELEM_BLOCK, v, block.id, block.n, values.data()) != 0) continue;
          lost.push_back(std::to_string(block.id));
        }
    sort_unique(lost);
    if (!lost.empty())
      out_.notices.push_back("dropped the variables of other elements (element block" +
                             std::string(lost.size() == 1 ? " " : "s ") + joined(lost, ", ") + ")");
    out_.mesh.others = other_elements(std::move(heads_), std::move(other_first_), std::move(other_nodes_));
  }

  /// Turns positions of nodes into indices. element(i): the id of the element that number i belongs to.
  template <class Element>
  void indices(std::span<int> positions, const Element& element) const {
    const auto n = static_cast<unsigned>(nodes_.size());
    unsigned highest = 0;
    for (int& position : positions) {
      const unsigned index = static_cast<unsigned>(position) - 1;
      highest = std::max(highest, index);
      position = static_cast<int>(index);
    }
    if (highest >= n && !positions.empty())
      for (std::size_t i = 0; i < positions.size(); ++i)
        if (static_cast<unsigned>(positions[i]) >= n)
          node(std::int64_t{positions[i]} + 1, "element " + std::to_string(element(i)));
    if (!nodes_.place().empty())
      for (int& position : positions) position = nodes_.place()[position];
  }

  void read_block(const ex_block& block, std::span<const std::int64_t> map, std::int64_t first) {
    const std::string name = "element block " + std::to_string(block.id);
    const std::string type = lower_case(block.topology);
    const auto starts = [&](std::string_view word) { return type.starts_with(word); };
    const auto n_nodes = block.num_nodes_per_entry;
    const bool unnamed = type.empty() || type == "null" || type == "unknown";
    const bool sized = n_nodes == 8 || n_nodes == 20 || n_nodes == 27;
    const bool hexes = map.empty() ? unnamed || starts("hex") : sized && (starts("hex") || unnamed);
    blocks_.push_back({block.id, first, std::ssize(map), hexes});
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
      check(ex_get_partial_conn(file_.id, EX_ELEM_BLOCK, block.id, exodus_position(begin), exodus_position(size - 1),
                                nodes.data(), nullptr, nullptr),
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
          if (n_nodes > 8)
            middles_.add(n_before + k, std::span(nodes).subspan(width * k + 8, width - 8), exodus_middles);
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

  /// Members and, for side sets, side numbers.
  std::pair<Ints, Ints> set(ex_entity_type type, std::int64_t id) const {
    const std::string name = "set " + std::to_string(id);
    int n = 0, n_factors = 0;
    check(ex_get_set_param(file_.id, type, id, &n, &n_factors), name);
    std::pair<Ints, Ints> result;
    result.first.resize(size(n, "members"));
    result.second.resize(type == EX_SIDE_SET ? result.first.size() : 0);
    if (n > 0)
      check(ex_get_set(file_.id, type, id, result.first.data(), type == EX_SIDE_SET ? result.second.data() : nullptr),
            name);
    return result;
  }
  Index hex(std::int64_t element, const std::string& who) const {
    if (element < 1 || element > std::ssize(hex_of_element_))
      fail(who + " names element " + std::to_string(element) + " of " + std::to_string(hex_of_element_.size()));
    return hex_of_element_[element - 1];
  }

  Index other_of(std::int64_t element) const { return other_of_element_.empty() ? -1 : other_of_element_[element]; }

  /// Of a block, by the start of its name and its number of nodes; -1: unknown.
  int other_type(const char* name, const std::string& lower, int n_nodes) {
    const auto starts = [&](std::string_view word) { return lower.starts_with(word); };
    const auto one_of = [&](std::initializer_list<int> known) {
      return std::ranges::find(known, n_nodes) != known.end();
    };
    std::optional<OtherShape> shape;
    if (starts("sphere") || starts("circle") || starts("point") || n_nodes == 1)
      shape = n_nodes == 1 ? std::optional(OtherShape::point) : std::nullopt;
    else if (starts("bar") || starts("beam") || starts("truss") || starts("edge") || starts("rod") || starts("line"))
      shape = one_of({2, 3}) ? std::optional(OtherShape::line) : std::nullopt;
    else if (starts("tri") || (starts("shell") && one_of({3, 6, 7})))
      shape = one_of({3, 4, 6, 7}) ? std::optional(OtherShape::triangle) : std::nullopt;
    else if (starts("quad") || starts("shell"))
      shape = one_of({4, 5, 8, 9}) ? std::optional(OtherShape::quad) : std::nullopt;
    else if (starts("tet"))
      shape = one_of({4, 5, 8, 10, 11, 14, 15}) ? std::optional(OtherShape::tetrahedron) : std::nullopt;
    else if (starts("pyr"))
      shape = one_of({5, 13, 14, 18, 19}) ? std::optional(OtherShape::pyramid) : std::nullopt;
    else if (starts("wedge"))
      shape = one_of({6, 15, 16, 18, 20, 21}) ? std::optional(OtherShape::wedge) : std::nullopt;
    if (!shape) return -1;
    const OtherType type{*shape, n_nodes, name};
    const auto place = std::ranges::find(heads_.types, type) - heads_.types.begin();
    if (place == std::ssize(heads_.types)) heads_.types.push_back(type);
    return static_cast<int>(place);
  }
  /// Whether pieces of an element have this side whole: the two faces of a shell.
  static bool is_face_of_shell(const OtherType& type, int side) {
    return type.shape == OtherShape::quad && lower_case(type.name).starts_with("shell") && side <= 2;
  }

  void side_sets() {
    for (const std::int64_t id : ids(EX_SIDE_SET, init_.num_side_sets)) {
      const std::string who = "side set " + std::to_string(id);
      SideSet& to = group_of_id(out_.mesh.side_sets, group_id(EX_SIDE_SET, id));
      to.name = group_name(EX_SIDE_SET, id);
      const auto [elements, sides] = set(EX_SIDE_SET, id);
      std::int64_t dropped = 0;
      std::vector<std::pair<Index, int>> others;
      for (std::size_t i = 0; i < elements.size(); ++i) {
        const Index h = hex(elements[i], who);
        if (h >= 0 && (sides[i] < 1 || sides[i] > 6)) fail(who + " names side " + std::to_string(sides[i]));
        const Index other = h < 0 ? other_of(elements[i] - 1) : -1;
        if (h >= 0)
          to.sides.push_back({h, exodus_face[sides[i] - 1]});
        else if (other >= 0)
          others.emplace_back(other, sides[i]);
        else
          ++dropped;
      }
      sort_unique(to.sides);
      sort_unique(others);
      if (!others.empty()) {
        OtherSides& list = heads_.sides.emplace_back();
        list.id = to.id;
        for (const auto& [element, side] : others) {
          list.elements.push_back(element);
          list.sides.push_back(std::to_string(side));
          if (is_face_of_shell(heads_.types[heads_.type[element]], side)) continue;
          heads_.is_rigid.resize(heads_.ids.size(), 0);
          heads_.is_rigid[element] = 1;
        }
      }
      if (dropped)
        out_.notices.push_back(who + ": dropped " + std::to_string(dropped) + " sides that are not sides of a hex");
    }
  }

  void node_sets() {
    for (const std::int64_t id : ids(EX_NODE_SET, init_.num_node_sets)) {
      NodeSet& to = group_of_id(out_.mesh.node_sets, group_id(EX_NODE_SET, id));
      to.name = group_name(EX_NODE_SET, id);
      for (const std::int64_t n : set(EX_NODE_SET, id).first)
        to.nodes.push_back(node(n, "node set " + std::to_string(id)));
      sort_unique(to.nodes);
    }
  }

  void element_sets() {
    for (const std::int64_t id : ids(EX_ELEM_SET, init_.num_elem_sets)) {
      Block group{group_id(EX_ELEM_SET, id), group_name(EX_ELEM_SET, id), {}};
      std::vector<Index> others;
      for (const std::int64_t element : set(EX_ELEM_SET, id).first) {
        if (const Index h = hex(element, "element set " + std::to_string(id)); h >= 0) group.hexes.push_back(h);
        if (const Index other = other_of(element - 1); other >= 0) others.push_back(other);
      }
      sort_unique(group.hexes);
      sort_unique(others);
      auto& blocks = out_.mesh.blocks;
      const auto same = std::ranges::find(blocks, group.id, &Block::id);
      const bool whole =
          same != blocks.end() && same->name == group.name && std::ranges::includes(group.hexes, same->hexes);
      if (same != blocks.end() && !whole) {
        group.id = free_id(blocks);
        out_.notices.push_back("element set " + std::to_string(id) + " is block " + std::to_string(group.id) +
                               ": an element block has its id");
      }
      group_of_id(blocks, group.id) = group;
      if (others.empty()) continue;
      const auto known = std::ranges::find(heads_.sets, group.id, &OtherSet::id);
      if (known == heads_.sets.end())
        heads_.sets.push_back({group.id, std::move(others)});
      else
        known->elements = union_of(known->elements, others);
    }
  }

  void fields(ex_entity_type type, Field::On on) {
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
        const int status = ex_get_var(file_.id, step, type, v, 1, init_.num_nodes, field.values.data());
        check(status, "field " + field.name);
        if (status != 0) {  // the library's warning
          out_.notices.push_back("field '" + field.name +
                                 "' is named in the file, which has no values of it: left out");
          continue;
        }
        nodes_.sort(field.values);
      } else {
        field.values.assign(out_.mesh.hexes.size(), std::numeric_limits<double>::quiet_NaN());
        bool any = false;
        for (const FileBlock& block : blocks_) {
          if (!block.hexes || block.n == 0) continue;
          std::vector<double> values(static_cast<std::size_t>(block.n));
          if (ex_get_var(file_.id, step, type, v, block.id, block.n, values.data()) != 0)
            continue;  // not on this block
          any = true;
          for (std::int64_t i = 0; i < block.n; ++i) field.values[hex_of_element_[block.first + i]] = values[i];
        }
        if (!any) continue;
      }
      out_.mesh.fields.push_back(std::move(field));
    }
  }

  std::string name_;
  Handle file_;
  std::int64_t most_items_ = 0;
  std::size_t name_length_ = 256;
  ex_init_params init_{};
  MeshFile out_;
  Ids nodes_, hexes_;
  FoundMiddles middles_;
  std::vector<FileBlock> blocks_;
  std::map<std::pair<ex_entity_type, std::int64_t>, int> number_of_wide_;
  std::vector<FileResults::WideId> wide_ids_;
  std::vector<Index> hex_of_element_;    // -1 for others
  std::vector<Index> other_of_element_;  // the same; empty where there are none
  OtherHeads heads_;
  std::vector<Index> other_first_ = {0}, other_nodes_;
  bool swaps_ = false;  // middle nodes of wedges: around, then upwards
};

}  // namespace

MeshFile read_exodus(const std::filesystem::path& file, const Fence& fence) {
  if (!fence.is_there() || is_classic_netcdf(read_bytes(file))) return ExodusReader(file, file.string()).result();
  const Handover plain;
  read_fenced(fence, fenced_hdf5, file, {}, plain);
  return ExodusReader(plain.path(), file.string()).result();
}

}  // namespace hextwist::io
