// Exodus II through its library.
//
// Element blocks divide the hexes. A hex in several of our blocks goes to the element block of the first; a block that
// lost hexes that way is written whole as an element set of the same id and name. Hexes in no block go to an element
// block of their own that readers of ours recognise by its name.
#include <exodusII.h>

#include <limits>
#include <utility>

#include "hextwist/base/large_array.h"
#include "hextwist/io/exodus/exodus_internal.h"

namespace hextwist::io {
namespace {

using Ints = std::vector<int>;

struct Divided {
  int id;
  std::string name;
  std::span<const Index> hexes;
  std::vector<Index> own;  // what `hexes` is where it is no list of the mesh
};

class Writer {
 public:
  Writer(const Replacement& file, const Mesh& mesh)
      : replacement_(file), mesh_(mesh), fields_(split_components(mesh.fields, [](int) { return false; })) {
    divide();
    create();
  }

  void write() {
    sizes();
    nodes();
    blocks();
    sets();
    fields();
    const int id = std::exchange(id_, -1);
    if (ex_close(id) < 0) fail();
  }

  ~Writer() {
    if (id_ >= 0) ex_close(id_);
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

 private:
  [[noreturn]] void fail() const { replacement_.fail("cannot be written (disk full?)"); }
  void check(int status) const {
    if (status < 0) fail();
  }

  void divide() {
    std::vector<char> taken(mesh_.hexes.size(), 0);
    for (const Block& block : mesh_.blocks) {
      Divided part{block.id, block.name, block.hexes, {}};
      if (std::ranges::any_of(block.hexes, [&](Index h) { return taken[h] != 0; })) {
        std::ranges::copy_if(block.hexes, std::back_inserter(part.own), [&](Index h) { return taken[h] == 0; });
        part.hexes = part.own;
        whole_.push_back(&block);
      }
      for (const Index h : part.hexes) taken[h] = 1;
      if (!part.hexes.empty() || block.hexes.empty()) parts_.push_back(std::move(part));
    }
    Divided rest{free_id(mesh_.blocks), exodus_rest_block, {}, {}};
    for (Index h = 0; h < mesh_.n_hexes(); ++h)
      if (!taken[h]) rest.own.push_back(h);
    rest.hexes = rest.own;
    if (!rest.hexes.empty()) parts_.push_back(std::move(rest));
  }

  void create() {
    const std::int64_t highest = std::max(mesh_.points.empty() ? 0 : node_id(mesh_, mesh_.n_nodes() - 1),
                                          mesh_.hexes.empty() ? 0 : hex_id(mesh_, mesh_.n_hexes() - 1));
    wide_ = highest > std::numeric_limits<std::int32_t>::max();
    // One variable of a 64-bit offset file holds at most 4 GiB; beyond that, and for wide ids, HDF5.
    const bool large = mesh_.hexes.size() > (std::size_t{1} << 32) / 32 - 1;
    int mode = EX_CLOBBER | (wide_ || large ? EX_NETCDF4 | EX_NOCLASSIC : EX_LARGE_MODEL);
    if (wide_) mode |= EX_ALL_INT64_DB | EX_MAPS_INT64_API;
    int memory = 8, disk = 8;
    ex_opts(0);
    id_ = ex_create(replacement_.temporary().c_str(), mode, &memory, &disk);
    if (id_ < 0) fail();
  }

  void sizes() {
    std::size_t longest = 32;
    const auto measure = [&](const auto& groups) {
      for (const auto& group : groups) longest = std::max(longest, group.name.size());
    };
    measure(parts_), measure(mesh_.blocks), measure(mesh_.node_sets), measure(mesh_.side_sets), measure(fields_);
    check(ex_set_max_name_length(id_, static_cast<int>(std::min<std::size_t>(longest, 255))));
    ex_init_params init{};
    std::strncpy(init.title, "hextwist", sizeof init.title - 1);
    init.num_dim = 3;
    init.num_nodes = mesh_.n_nodes();
    init.num_elem = mesh_.n_hexes();
    init.num_elem_blk = std::ssize(parts_);
    init.num_node_sets = std::ssize(mesh_.node_sets);
    init.num_side_sets = std::ssize(mesh_.side_sets);
    init.num_elem_sets = std::ssize(whole_);
    check(ex_put_init_ext(id_, &init));
  }

  void nodes() {
    // All of x, then y, then z, as they lie in the file: the library buffers one place only.
    std::vector<double> values(exodus_piece);
    for (int axis = 0; axis < 3; ++axis)
      in_pieces(mesh_.points.size(), [&](std::size_t first, std::size_t n) {
        for (std::size_t i = 0; i < n; ++i) values[i] = mesh_.points[first + i][axis];
        std::array<const double*, 3> x{};
        x[axis] = values.data();
        check(ex_put_partial_coord(id_, exodus_position(first), exodus_position(n - 1), x[0], x[1], x[2]));
      });
    std::array<std::string, 3> names = {"x", "y", "z"};
    std::array<char*, 3> pointers = {names[0].data(), names[1].data(), names[2].data()};
    check(ex_put_coord_names(id_, pointers.data()));
    put_map(EX_NODE_MAP, mesh_.points.size(),
            [&](std::size_t n) { return id_of(mesh_.node_ids, static_cast<Index>(n)); });
  }
  /// 1-based, as the library counts.
  /// id(0) .. id(n_items - 1).
  template <class F>
  void put_map(ex_entity_type type, std::size_t n_items, F&& id) {
    const auto put = [&]<class T>(std::vector<T> ids) {
      in_pieces(n_items, [&](std::size_t first, std::size_t n) {
        for (std::size_t i = 0; i < n; ++i) ids[i] = static_cast<T>(id(first + i));
        check(ex_put_partial_id_map(id_, type, exodus_position(first), exodus_position(n - 1), ids.data()));
      });
    };
    wide_ ? put(std::vector<std::int64_t>(exodus_piece)) : put(Ints(exodus_piece));
  }

  void blocks() {
    std::vector<Hex> nodes(exodus_piece);
    for (const Divided& part : parts_) {
      const auto n = std::ssize(part.hexes);
      check(ex_put_block(id_, EX_ELEM_BLOCK, part.id, "HEX8", n, 8, 0, 0, 0));
      put_name(EX_ELEM_BLOCK, part.id, part.name);
      in_pieces(part.hexes.size(), [&](std::size_t first, std::size_t size) {
        for (std::size_t i = 0; i < size; ++i) {
          nodes[i] = in_file_order(mesh_.hexes[part.hexes[first + i]]);
          for (Index& node : nodes[i]) ++node;
        }
        check(ex_put_partial_elem_conn(id_, part.id, exodus_position(first), exodus_position(size - 1), nodes.data()));
      });
    }
    // Parts follow each other.
    std::size_t part = 0, before = 0;
    put_map(EX_ELEM_MAP, mesh_.hexes.size(), [&](std::size_t element) {
      while (element - before == parts_[part].hexes.size()) before += parts_[part++].hexes.size();
      return id_of(mesh_.hex_ids, parts_[part].hexes[element - before]);
    });
  }

  void put_name(ex_entity_type type, int id, const std::string& name) {
    if (!name.empty()) check(ex_put_name(id_, type, id, name.substr(0, 255).c_str()));
  }
  void put_set(ex_entity_type type, int id, const std::string& name, const Ints& members, const Ints& sides) {
    check(ex_put_set_param(id_, type, id, std::ssize(members), 0));
    if (!members.empty()) check(ex_put_set(id_, type, id, members.data(), sides.empty() ? nullptr : sides.data()));
    put_name(type, id, name);
  }

  /// Per hex its 1-based place in the file.
  Ints elements_of_hexes() const {
    Ints element_of_hex;
    resize_for_overwrite(element_of_hex, mesh_.hexes.size());
    int element = 0;
    for (const Divided& part : parts_)
      for (const Index h : part.hexes) element_of_hex[h] = ++element;
    return element_of_hex;
  }

  void sets() {
    const Ints element_of_hex = mesh_.side_sets.empty() && whole_.empty() ? Ints() : elements_of_hexes();
    for (const NodeSet& set : mesh_.node_sets) {
      Ints members;
      for (const Index n : set.nodes) members.push_back(n + 1);
      put_set(EX_NODE_SET, set.id, set.name, members, {});
    }
    std::array<int, 6> side_of_face{};
    for (int side = 0; side < 6; ++side) side_of_face[exodus_face[side]] = side + 1;
    for (const SideSet& set : mesh_.side_sets) {
      Ints members, sides;
      for (const Side& side : set.sides) {
        members.push_back(element_of_hex[side.hex]);
        sides.push_back(side_of_face[side.face]);
      }
      put_set(EX_SIDE_SET, set.id, set.name, members, sides);
    }
    for (const Block* block : whole_) {
      Ints members;
      for (const Index h : block->hexes) members.push_back(element_of_hex[h]);
      put_set(EX_ELEM_SET, block->id, block->name, members, {});
    }
  }

  void fields() {
    if (fields_.empty()) return;
    const double time = 0;
    std::array<std::vector<const Field*>, 2> of;
    for (const Field& field : fields_) of[field.on == Field::On::hex].push_back(&field);
    for (int hex = 0; hex < 2; ++hex) {
      if (of[hex].empty()) continue;
      const auto type = hex ? EX_ELEM_BLOCK : EX_NODAL;
      check(ex_put_variable_param(id_, type, static_cast<int>(of[hex].size())));
      for (std::size_t v = 0; v < of[hex].size(); ++v)
        check(ex_put_variable_name(id_, type, static_cast<int>(v + 1), of[hex][v]->name.substr(0, 255).c_str()));
    }
    if (!of[1].empty()) {
      std::vector<int> everywhere(parts_.size() * of[1].size(), 1);
      check(ex_put_truth_table(id_, EX_ELEM_BLOCK, static_cast<int>(parts_.size()), static_cast<int>(of[1].size()),
                               everywhere.data()));
    }
    check(ex_put_time(id_, 1, &time));
    std::vector<double> values;
    for (std::size_t v = 0; v < of[0].size(); ++v)
      check(ex_put_var(id_, 1, EX_NODAL, static_cast<int>(v + 1), 1, mesh_.n_nodes(), of[0][v]->values.data()));
    for (std::size_t v = 0; v < of[1].size(); ++v)
      for (const Divided& part : parts_) {
        if (part.hexes.empty()) continue;
        values.clear();
        for (const Index h : part.hexes) values.push_back(of[1][v]->values[h]);
        check(ex_put_var(id_, 1, EX_ELEM_BLOCK, static_cast<int>(v + 1), part.id, std::ssize(values), values.data()));
      }
  }

  const Replacement& replacement_;
  const Mesh& mesh_;
  std::vector<Field> fields_;
  std::vector<Divided> parts_;
  std::vector<const Block*> whole_;  // written as element sets
  int id_ = -1;
  bool wide_ = false;  // ids beyond 32 bits
};

}  // namespace

void write_exodus(const std::filesystem::path& file, const Mesh& mesh, const WriteOptions& options) {
  Replacement replacement(file, options.overwrite);
  if (replacement.direct()) replacement.fail("is not an ordinary file, as Exodus II needs");
  Writer(replacement, mesh).write();
  replacement.commit();
}

}  // namespace hextwist::io
