// Cells and arrays of VTK become a mesh.
//
// Hexes and voxels are hexes; quads with a group that are sides of these are sides, all else other elements
// (mesh/others.h). Arrays are fields, but those that write_vtu() makes itself ("hextwist:made") turn back
// into ids, owners and groups. In other people's files, an integer cell array of a well-known name gives blocks
// (positive values on hexes) and side sets (on quads).
#include <limits>
#include <map>

#include "hextwist/base/large_array.h"
#include "hextwist/base/sorted.h"
#include "hextwist/io/vtk/vtk_internal.h"

namespace hextwist::io {

namespace {

/// Cell types below dimension 3 that are dropped where nothing else is known of them.
constexpr int lower_types[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 21, 22, 23, 28, 30, 34, 35, 36, 68, 69, 70, 75, 76, 77};
/// Quads of second order, by their corners.
constexpr std::pair<int, std::size_t> curved_quads[] = {{23, 8}, {28, 9}, {70, 9}};
constexpr int vtk_pixel = 8, vtk_quad = 9, vtk_voxel = 11, vtk_hex = 12, vtk_hex_20 = 25, vtk_hex_27 = 29,
              vtk_lagrange_hex = 72;

std::string type_name(std::int64_t type) {
  constexpr std::pair<int, const char*> names[] = {
      {10, "tetrahedron"},   {13, "wedge"},           {14, "pyramid"},           {24, "quadratic tetrahedron"},
      {25, "quadratic hex"}, {26, "quadratic wedge"}, {27, "quadratic pyramid"}, {29, "triquadratic hex"},
      {42, "polyhedron"},    {72, "Lagrange hex"}};
  for (const auto& [number, name] : names)
    if (number == type) return name;
  return "cell of type " + std::to_string(type);
}

class VtkAssembly {
 public:
  VtkAssembly(VtkContents&& contents, const Cursor& cursor) : in_(std::move(contents)), cursor_(cursor) {}

  MeshFile result() {
    out_.notices = std::move(in_.notices);
    cells();
    ours();
    say_file_arrays(in_.arrays, out_.notices);
    if (made_.empty()) {
      groups();
      global_ids();
    }
    fields();
    others();
    middles_.finish(out_.mesh.hexes.size());
    if (middles_.any()) take_middles(out_, middles_);
    return std::move(out_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw Error(std::string(cursor_.name) + ": " + what); }

  void cells() {
    out_.mesh.points = std::move(in_.points);
    const std::size_t n_cells = in_.types.size(), n_numbers = in_.connectivity.size();
    reserve_large(out_.mesh.hexes, std::min(n_cells, n_numbers / 8));
    // In pieces that stay in the cache, so that one loop does for all types of numbers.
    constexpr std::size_t piece = 1024;
    std::vector<std::int64_t> types, ends;
    std::vector<Index> nodes;
    std::int64_t begin = 0;
    for (std::size_t first = 0; first < n_cells; first += piece) {
      const std::size_t n = std::min(piece, n_cells - first);
      types.resize(n), ends.resize(n);
      in_.types.copy(first, types);
      in_.ends.copy(first, ends);
      const std::int64_t start = begin;
      for (std::size_t k = 0; k < n; begin = ends[k++])
        if (ends[k] < begin || ends[k] > static_cast<std::int64_t>(n_numbers))
          fail("the nodes of cell " + std::to_string(first + k + 1) + " do not fit: they end at " +
               std::to_string(ends[k]) + " of " + std::to_string(n_numbers));
      nodes.resize(static_cast<std::size_t>(begin - start));
      in_.connectivity.copy_indices(static_cast<std::size_t>(start), nodes, out_.mesh.n_nodes());
      for (std::size_t k = 0, from = 0; k < n; ++k) {
        const auto to = static_cast<std::size_t>(ends[k] - start);
        cell(first + k, types[k], std::span(nodes).subspan(from, to - from), static_cast<std::size_t>(start) + from);
        from = to;
      }
    }
    if (out_.mesh.hexes.empty()) {
      std::string others;
      for (const OtherType& type : heads_.types)
        others += (others.empty() ? ", but " : ", ") +
                  counted(std::ranges::count(heads_.type, static_cast<int>(&type - heads_.types.data())),
                          name(type.shape), type.shape == OtherShape::tetrahedron ? "tetrahedra" : "");
      cursor_.fail_at(cursor_.end, "there is no hex in the file" + others);
    }
    for (const auto& [type, n] : n_dropped_)
      out_.notices.push_back("dropped " + std::to_string(n) + " cells of type " + std::to_string(type) +
                             ", which have no place here");
  }

  /// `at`: where its nodes stand in the connectivity.
  void cell(std::size_t i, std::int64_t type, std::span<const Index> nodes, std::size_t at) {
    const bool hex = type == vtk_hex || type == vtk_voxel;
    const bool curved_quad =
        std::ranges::find(curved_quads, std::pair(static_cast<int>(type), nodes.size())) != std::end(curved_quads);
    const bool quad = type == vtk_quad || type == vtk_pixel || curved_quad;
    for (const auto& [known, n] : {std::pair(vtk_hex_20, std::size_t{20}), {vtk_hex_27, std::size_t{27}}})
      if (type == known && nodes.size() != n)
        fail("cell " + std::to_string(i + 1) + " has " + std::to_string(nodes.size()) + " nodes instead of " +
             std::to_string(n));
    if ((type == vtk_hex_20 && nodes.size() == 20) || (type == vtk_hex_27 && nodes.size() == 27) ||
        (type == vtk_lagrange_hex && (nodes.size() == 27 || nodes.size() == 8)))
      return second_order_hex(i, type, nodes, at);
    if (hex && nodes.size() == 8) {
      check(i, nodes, at);
      Hex corners;
      std::ranges::copy(nodes, corners.begin());
      return add_hex(i, type == vtk_voxel ? corners : in_file_order(corners));
    }
    const std::string name = "cell " + std::to_string(i + 1);
    const std::optional<OtherType> other = hex ? std::nullopt : vtk_other(type, nodes.size());
    if (!hex && !other && std::ranges::find(lower_types, type) == std::end(lower_types))
      fail(name + " is a " + type_name(type) + " of " + std::to_string(nodes.size()) +
           " nodes; only hexes of 8, 20 or 27 nodes and usual elements beside them are accepted");
    if (hex || (quad && !curved_quad && nodes.size() != 4))
      fail(name + " has " + std::to_string(nodes.size()) + " nodes instead of " + (hex ? "8" : "4"));
    constexpr std::pair<int, std::size_t> sizes[] = {{1, 1}, {3, 2}, {5, 3}, {21, 3}, {22, 6}, {23, 8}, {28, 9}};
    for (const auto& [known, n] : sizes)
      if (known == type && nodes.size() != n)
        fail(name + " has " + std::to_string(nodes.size()) + " nodes instead of " + std::to_string(n) +
             ", which cells of type " + std::to_string(type) + " have");
    if (only_hexes_)  // up to here
      for (std::size_t h = 0; h < i; ++h) hex_cells_.push_back(h);
    only_hexes_ = false;
    const bool many_points = type == 2 && !nodes.empty();  // a connector of ours
    if (!other && !many_points) {
      ++n_dropped_[type];
      return;
    }
    check(i, nodes, at);
    std::vector<Index> own(nodes.begin(), nodes.end());
    if (type == vtk_pixel) std::swap(own[2], own[3]);
    if (other && other->shape == OtherShape::quad) {
      quads_.push_back({own[0], own[1], own[2], own[3]});
      quad_cells_.push_back(heads_.type.size());
    }
    const OtherType of = other.value_or(OtherType{OtherShape::connector, 0, ""});
    const auto known = std::ranges::find(heads_.types, of);
    if (known == heads_.types.end()) heads_.types.push_back(of);
    heads_.type.push_back(static_cast<int>(std::ranges::find(heads_.types, of) - heads_.types.begin()));
    other_cells_.push_back(i);
    other_nodes_.insert(other_nodes_.end(), own.begin(), own.end());
    other_first_.push_back(static_cast<Index>(other_nodes_.size()));
  }
  void second_order_hex(std::size_t i, std::int64_t type, std::span<const Index> nodes, std::size_t at) {
    check(i, nodes, at);
    Hex corners;
    std::ranges::copy(nodes.first(8), corners.begin());
    add_hex(i, in_file_order(corners));
    if (nodes.size() == 8) return;
    std::vector<Index> middles(nodes.begin() + 8, nodes.end());
    if (type == vtk_lagrange_hex && in_.old_lagrange) std::swap(middles[10], middles[11]);
    middles_.add(out_.mesh.hexes.size() - 1, middles, vtk_middles);
  }
  void add_hex(std::size_t i, const Hex& hex) {
    out_.mesh.hexes.push_back(hex);
    if (!only_hexes_) hex_cells_.push_back(i);
  }
  std::size_t cell_of_hex(std::size_t hex) const { return only_hexes_ ? hex : hex_cells_[hex]; }
  void check(std::size_t i, std::span<const Index> nodes, std::size_t at) const {
    Index all = 0;
    for (const Index node : nodes) all |= node;
    if (all >= 0) return;
    const auto wrong =
        at + static_cast<std::size_t>(std::ranges::find_if(nodes, [](Index n) { return n < 0; }) - nodes.begin());
    fail("cell " + std::to_string(i + 1) + " names point " + std::to_string(in_.connectivity.integer(wrong)) + " of " +
         std::to_string(out_.mesh.n_nodes()) + " (counted from 0)");
  }

  const VtkArray* find(VtkArray::On on, std::string_view name) const {
    for (const VtkArray& array : in_.arrays)
      if (array.on == on && array.name == name) return &array;
    return nullptr;
  }
  bool is_made(std::string_view name) const { return std::ranges::find(made_, name) != made_.end(); }
  /// An array of ours by its usual name; null where it is not there.
  const VtkArray* find_made(VtkArray::On on, std::string_view usual) const {
    const auto name = std::ranges::find_if(made_, [&](const std::string& made) { return io::is_made(made, usual); });
    return name == made_.end() ? nullptr : find(on, *name);
  }

  /// What write_vtu() says beyond fields. Such arrays may have been edited by other programs: all is checked.
  void ours() {
    Mesh& mesh = out_.mesh;
    Association& tags = out_.tags;
    for (const VtkArray& array : in_.arrays)
      for (std::string& name : made_names(array.on, array.name)) made_.push_back(std::move(name));
    if (made_.empty()) return;
    const auto n_nodes = mesh.points.size(), n_hexes = mesh.hexes.size(), n_cells = in_.types.size();
    if (!only_hexes_ && cell_of_hex(n_hexes - 1) != n_hexes - 1)
      fail("groups cannot be kept: there are other cells between the hexes");
    const auto column = [&](VtkArray::On on, const char* name, std::size_t n) {
      const VtkArray* array = find_made(on, name);
      return array && array->is_integer() && array->size() == n ? array : nullptr;
    };
    mesh.node_ids = ids(column(VtkArray::On::node, "node_id", n_nodes), "node");
    const VtkArray* hex_id = column(VtkArray::On::cell, "hex_id", n_cells);
    mesh.hex_ids = ids(hex_id, "hex", n_hexes);
    for (std::size_t e = 0; hex_id && e < other_cells_.size(); ++e) heads_.ids.push_back(hex_id->integer(n_hexes + e));
    const VtkArray* dim = column(VtkArray::On::node, "owner_dim", n_nodes);
    const VtkArray* id = column(VtkArray::On::node, "owner_id", n_nodes);
    const VtkArray* volume = column(VtkArray::On::cell, "volume", n_cells);
    if ((dim && id) || volume || find(VtkArray::On::file, "hextwist:curve_edges") ||
        find(VtkArray::On::file, "hextwist:surface_faces")) {
      tags.node_owner.resize(n_nodes);
      tags.node_parameters.resize(n_nodes);
      tags.hex_volume.resize(n_hexes);
    }
    for (std::size_t i = 0; dim && id && i < n_nodes; ++i)
      if (const auto d = dim->integer(i); d >= 0 && d <= 3)
        tags.node_owner[i] = {static_cast<int>(d), static_cast<int>(id->integer(i))};
    for (std::size_t i = 0; volume && i < n_hexes; ++i) tags.hex_volume[i] = static_cast<int>(volume->integer(i));
    for (const VtkArray& array : in_.arrays)
      if (array.on == VtkArray::On::file && array.name.starts_with("hextwist:") && array.is_integer())
        group(array, std::string_view(array.name).substr(9));
    sort_unique(mesh.blocks, &Block::id);
    sort_unique(mesh.node_sets, &NodeSet::id);
    sort_unique(mesh.side_sets, &SideSet::id);
    tidy(tags);
  }

  /// Arrays that the file calls ids are, where a mesh can have them: positive and ascending.
  void global_ids() {
    for (VtkArray& array : in_.arrays) {
      if (!array.global_ids || array.on == VtkArray::On::file) continue;
      const bool node = array.on == VtkArray::On::node;
      const std::size_t n = node ? out_.mesh.points.size() : out_.mesh.hexes.size();
      const bool fits = array.is_integer() && array.components == 1 && array.size() == (node ? n : in_.types.size());
      std::vector<std::int64_t> found;
      for (std::size_t i = 0; fits && i < n; ++i) found.push_back(array.integer(node ? i : cell_of_hex(i)));
      array.global_ids = !found.empty() && found[0] > 0 && found.back() <= highest_readable_id &&
                         std::ranges::adjacent_find(found, std::ranges::greater_equal{}) == found.end();
      if (!array.global_ids)
        out_.notices.push_back("array '" + array.name +
                               "' of ids is kept as a field: it is not positive and ascending; " +
                               (node ? "nodes" : "hexes") + " are counted from 1");
      else if (found.back() != std::ssize(found))
        (node ? out_.mesh.node_ids : out_.mesh.hex_ids) = std::move(found);
    }
  }

  /// Ids of nodes or hexes, empty where they are 1..n.
  std::vector<std::int64_t> ids(const VtkArray* array, const char* kind) const {
    return ids(array, kind, array ? array->size() : 0);
  }
  /// Of the first n items.
  std::vector<std::int64_t> ids(const VtkArray* array, const char* kind, std::size_t n) const {
    if (!array || n == 0) return {};
    if (array->integer(0) < 1) fail(std::string(kind) + " ids are not positive");
    std::vector<std::int64_t> result;
    array->visit([&](auto numbers) {
      for (std::size_t i = 1; i < n; ++i)
        if (numbers[i] <= numbers[i - 1]) fail(std::string(kind) + " ids are not ascending");
      if (static_cast<std::size_t>(numbers[n - 1]) == n) return;
      if (array->integer(n - 1) > highest_readable_id || array->integer(n - 1) < 1)
        fail(std::string(kind) + " id " + std::to_string(numbers[n - 1]) + " is too large");
      reserve_large(result, n);
      for (std::size_t i = 0; i < n; ++i) result.push_back(static_cast<std::int64_t>(numbers[i]));
    });
    return result;
  }

  /// Rows of as many columns as there are bounds: each number at least 0 and less than its column's bound.
  std::vector<Index> rows(const VtkArray& array, std::initializer_list<std::int64_t> bounds) const {
    std::vector<Index> result;
    array.visit([&](auto numbers) {
      const std::size_t n = numbers.size() / bounds.size();
      reserve_large(result, n * bounds.size());
      for (std::size_t i = 0, k = 0; i < n; ++i)
        for (const std::int64_t bound : bounds) {
          const auto value = static_cast<std::int64_t>(numbers[k++]);
          if (value < 0 || value >= bound) fail("'" + array.name + "' has an entry " + std::to_string(value));
          result.push_back(static_cast<Index>(value));
        }
    });
    return result;
  }
  std::vector<Side> sides(const VtkArray& array) const {
    const auto items = rows(array, {out_.mesh.n_hexes(), n_hex_faces});
    std::vector<Side> result;
    for (std::size_t i = 0; i < items.size(); i += 2) result.push_back({items[i], items[i + 1]});
    return result;
  }

  void group(const VtkArray& array, std::string_view what) {
    Mesh& mesh = out_.mesh;
    constexpr std::int64_t any = std::numeric_limits<int>::max();
    if (what == "curve_edges") {
      const auto items = rows(array, {mesh.n_nodes(), mesh.n_nodes(), any});
      for (std::size_t i = 0; i < items.size(); i += 3) {
        out_.tags.curve_edges.push_back({items[i], items[i + 1]});
        out_.tags.edge_curve.push_back(items[i + 2]);
      }
      return;
    }
    if (what == "surface_faces") {
      const auto items = rows(array, {mesh.n_hexes(), n_hex_faces, any});
      for (std::size_t i = 0; i < items.size(); i += 3) {
        out_.tags.surface_faces.push_back({items[i], items[i + 1]});
        out_.tags.face_surface.push_back(items[i + 2]);
      }
      return;
    }
    // "block 3 name"
    const auto blank = std::min(what.find(' '), what.size());
    const std::string_view kind = what.substr(0, blank);
    std::string_view rest = what.substr(std::min(blank + 1, what.size()));
    int id = 0;
    const auto [stop, error] = std::from_chars(rest.data(), rest.data() + rest.size(), id);
    if (kind.starts_with("other_")) return group_of_others(array, kind, what.substr(std::min(blank + 1, what.size())));
    if (kind != "block" && kind != "nodeset" && kind != "sideset") return;
    if (error != std::errc{} || id < 0) fail("'" + array.name + "' has no id between 0 and 2147483647");
    rest.remove_prefix(static_cast<std::size_t>(stop - rest.data()));
    const std::string name(rest.substr(std::min<std::size_t>(1, rest.size())));
    if (kind == "block" || kind == "nodeset") {
      std::vector<Index> items = rows(array, {kind == "block" ? mesh.n_hexes() : mesh.n_nodes()});
      sort_unique(items);
      if (kind == "block")
        mesh.blocks.push_back({id, name, std::move(items)});
      else
        mesh.node_sets.push_back({id, name, std::move(items)});
    } else if (kind == "sideset") {
      std::vector<Side> items = sides(array);
      sort_unique(items);
      mesh.side_sets.push_back({id, name, std::move(items)});
    }
  }

  /// What write_vtu() says of other elements; `rest` is what stands behind the kind.
  void group_of_others(const VtkArray& array, std::string_view kind, std::string_view rest) {
    const auto n = static_cast<std::int64_t>(other_cells_.size());
    const auto number = [&] {
      int value = 0;
      const auto [stop, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
      if (error != std::errc{} || value < 0) fail("'" + array.name + "' has no number where one is expected");
      rest.remove_prefix(static_cast<std::size_t>(stop - rest.data()));
      if (rest.starts_with(' ')) rest.remove_prefix(1);
      return value;
    };
    if (kind == "other_type") {  // shape, nodes, name
      const int shape = number(), n_nodes = number();
      if (shape > static_cast<int>(OtherShape::connector) || n_nodes < 0 || n_nodes > 27)
        fail("'" + array.name + "' is no element");
      const OtherType type{static_cast<OtherShape>(shape), n_nodes, std::string(rest)};
      for (const Index e : rows(array, {n})) {
        const Index has = other_first_[e + 1] - other_first_[e];
        if (has < std::max(n_nodes, n_corners(type.shape)) && !(type.shape == OtherShape::connector))
          fail("'" + array.name + "' does not fit cell " + std::to_string(other_cells_[e] + 1));
        heads_.type[e] = static_cast<int>(heads_.types.size());
      }
      heads_.types.push_back(type);
    } else if (kind == "other_format") {
      heads_.format = std::string(rest);
    } else if (kind == "other_block") {
      const int id = number();
      heads_.sets.push_back({id, sorted_unique(rows(array, {n}))});
    } else if (kind == "other_sides") {
      const int id = number();
      auto list = std::ranges::find(heads_.sides, id, &OtherSides::id);
      if (list == heads_.sides.end()) {
        heads_.sides.push_back({id, {}, {}});
        list = heads_.sides.end() - 1;
      }
      for (const Index e : rows(array, {n})) {
        list->elements.push_back(e);
        list->sides.emplace_back(rest);
      }
    } else if (kind == "other_rigid") {
      heads_.is_rigid.assign(static_cast<std::size_t>(n), 0);
      for (const Index e : rows(array, {n})) heads_.is_rigid[e] = 1;
    } else if (kind == "other_nodes") {
      const auto items = rows(array, {n, out_.mesh.n_nodes()});
      for (std::size_t i = 0; i < items.size(); i += 2) more_nodes_.emplace_back(items[i], items[i + 1]);
    } else if (kind == "other_field") {
      only_others_.emplace_back(rest);
    }
  }

  /// Middle nodes of hexes are made anew, so that lines, triangles and quads on these can't keep theirs.
  void only_corners() {
    std::vector<Index> nodes, first = {0};
    std::int64_t n_changed = 0;
    for (std::size_t e = 0; e < other_cells_.size(); ++e) {
      const OtherType type = heads_.types[heads_.type[e]];
      auto end = other_nodes_.begin() + other_first_[e + 1];
      const bool flat =
          type.shape == OtherShape::line || type.shape == OtherShape::triangle || type.shape == OtherShape::quad;
      if (flat && type.n_nodes > n_corners(type.shape)) {
        ++n_changed;
        end = other_nodes_.begin() + other_first_[e] + n_corners(type.shape);
        const OtherType straight{type.shape, n_corners(type.shape), type.name};
        const auto at = std::ranges::find(heads_.types, straight);
        heads_.type[e] = static_cast<int>(at - heads_.types.begin());
        if (at == heads_.types.end()) heads_.types.push_back(straight);
      }
      nodes.insert(nodes.end(), other_nodes_.begin() + other_first_[e], end);
      first.push_back(static_cast<Index>(nodes.size()));
    }
    other_nodes_ = std::move(nodes), other_first_ = std::move(first);
    if (n_changed > 0)
      out_.notices.push_back(counted(n_changed, "line, triangle or quad", "lines, triangles and quads") +
                             " of second order beside hexes of second order: kept by their corners");
  }

  void others() {
    if (other_cells_.empty()) return;
    const std::size_t n = other_cells_.size();
    if (!more_nodes_.empty()) {  // one more each
      std::vector<Index> nodes, first = {0};
      for (std::size_t e = 0; e < n; ++e) {
        nodes.insert(nodes.end(), other_nodes_.begin() + other_first_[e], other_nodes_.begin() + other_first_[e + 1]);
        for (const auto& [element, node] : more_nodes_)
          if (element == static_cast<Index>(e)) nodes.push_back(node);
        first.push_back(static_cast<Index>(nodes.size()));
      }
      other_nodes_ = std::move(nodes), other_first_ = std::move(first);
    }
    if (middles_.any()) only_corners();
    if (heads_.format.empty()) heads_.format = "vtk";
    if (heads_.ids.size() != n) {  // behind the hexes
      heads_.ids.clear();
      const std::int64_t last = hex_id(out_.mesh, out_.mesh.n_hexes() - 1);
      for (std::size_t e = 0; e < n; ++e) heads_.ids.push_back(last + 1 + static_cast<std::int64_t>(e));
    }
    const Ids ids(heads_.ids, "cell", [&](std::size_t, const std::string& what) { fail(what); });
    for (const std::int64_t id : heads_.ids)
      if (find_hex(out_.mesh, id) >= 0) fail("cell id " + std::to_string(id) + " occurs twice");
    for (const OtherSet& set : heads_.sets)
      if (position_in(out_.mesh.blocks, set.id, &Block::id) < 0) group_of_id(out_.mesh.blocks, set.id);
    for (const OtherSides& sides : heads_.sides)
      if (position_in(out_.mesh.side_sets, sides.id, &SideSet::id) < 0) group_of_id(out_.mesh.side_sets, sides.id);
    // Without those that are sides.
    if (std::ranges::count(is_side_, 1) > 0) {
      std::vector<Index> keep = indices_where(static_cast<Index>(n), [&](Index e) { return !is_side_[e]; });
      std::vector<Index> now(n, -1), nodes, first = {0};
      for (std::size_t i = 0; i < keep.size(); ++i) {
        now[keep[i]] = static_cast<Index>(i);
        nodes.insert(nodes.end(), other_nodes_.begin() + other_first_[keep[i]],
                     other_nodes_.begin() + other_first_[keep[i] + 1]);
        first.push_back(static_cast<Index>(nodes.size()));
      }
      heads_.type = items_at(heads_.type, keep);
      heads_.ids = items_at(heads_.ids, keep);
      for (OtherField& field : heads_.fields)
        field.values = items_at(field.values, keep, static_cast<std::size_t>(field.components));
      for (OtherSet& set : heads_.sets) {
        std::erase_if(set.elements, [&](Index e) { return now[e] < 0; });
        for (Index& e : set.elements) e = now[e];
      }
      other_nodes_ = std::move(nodes), other_first_ = std::move(first);
    }
    out_.mesh.others = other_elements(std::move(heads_), std::move(other_first_), std::move(other_nodes_));
  }

  void groups() {
    const auto sides = oriented_sides(out_.mesh, quads_);
    is_side_.assign(other_cells_.size(), 0);
    for (const std::string_view name : vtk_group_arrays) {
      const VtkArray* array = find(VtkArray::On::cell, name);
      if (!array || array->components != 1 || array->size() != in_.types.size()) continue;
      const auto value = [&](std::size_t cell) { return vtk_group(array->real(cell)); };
      std::map<int, std::vector<Index>> blocks;
      std::map<int, std::vector<Side>> sets;
      const bool zero_is_none = name.find(':') != std::string_view::npos;  // with Gmsh and MEDIT
      Index n_without = 0;
      for (std::size_t h = 0; h < out_.mesh.hexes.size(); ++h)
        n_without += value(cell_of_hex(h)) == 0 && (array->real(cell_of_hex(h)) != 0 || !zero_is_none);
      if (n_without > 0)
        out_.notices.push_back(std::string(name) + " of " + counted(n_without, "hex", "hexes") +
                               " is not an id of a block (1 to 2147483646): they are in none, the values are a field");
      for (std::size_t h = 0; h < out_.mesh.hexes.size(); ++h)
        if (const int id = value(cell_of_hex(h))) blocks[id].push_back(static_cast<Index>(h));
      for (std::size_t q = 0; q < quad_cells_.size(); ++q)
        if (const int id = value(other_cells_[quad_cells_[q]]); id && sides[q].hex >= 0) {
          sets[id].push_back(sides[q]);
          is_side_[quad_cells_[q]] = 1;
        }
      // Solids count with hexes. Numbers of what has less dimensions may be others: those that no hex has are blocks.
      std::map<int, std::vector<Index>> of_others;
      for (std::size_t e = 0; e < other_cells_.size(); ++e) {
        const OtherShape shape = heads_.types[heads_.type[e]].shape;
        const bool solid =
            shape == OtherShape::tetrahedron || shape == OtherShape::pyramid || shape == OtherShape::wedge;
        if (const int id = value(other_cells_[e]); id && !is_side_[e] && (solid || !blocks.contains(id)))
          of_others[id].push_back(static_cast<Index>(e));
      }
      for (auto& [id, elements] : of_others) {
        blocks[id];
        heads_.sets.push_back({id, std::move(elements)});
      }
      for (auto& [id, items] : blocks) out_.mesh.blocks.push_back({id, "", std::move(items)});
      for (auto& [id, items] : sets) {
        sort_unique(items);
        out_.mesh.side_sets.push_back({id, "", std::move(items)});
      }
      break;
    }
  }

  void fields() {
    for (const VtkArray& array : in_.arrays) {
      if (array.on == VtkArray::On::file || is_made(array.name) || (array.global_ids && made_.empty())) continue;
      const bool node = array.on == VtkArray::On::node;
      const auto width = static_cast<std::size_t>(array.components);
      const std::size_t n = node ? out_.mesh.points.size() : in_.types.size();
      if (array.size() != n * width) {
        out_.notices.push_back("dropped array '" + array.name + "', which has " + std::to_string(array.size()) +
                               " values instead of " + std::to_string(n * width));
        continue;
      }
      if (!node && !other_cells_.empty()) field_of_others(array);
      if (!node && std::ranges::find(only_others_, array.name) != only_others_.end()) continue;
      Field field{array.name, node ? Field::On::node : Field::On::hex, array.components, {}, array.is_integer()};
      const std::size_t n_kept = node ? n : out_.mesh.hexes.size();
      reserve_large(field.values, n_kept * width);
      std::int64_t n_rounded = 0;
      array.visit([&](auto numbers) {
        for (std::size_t i = 0; i < n_kept; ++i)
          for (std::size_t c = 0; c < width; ++c) {
            const auto number = numbers[(node ? i : cell_of_hex(i)) * width + c];
            n_rounded += !is_exact_double(number);
            field.values.push_back(static_cast<double>(number));
          }
      });
      say_rounded(array.name, n_rounded, out_.notices);
      out_.mesh.fields.push_back(std::move(field));
    }
  }

  void field_of_others(const VtkArray& array) {
    OtherField field{array.name, array.components, {}, false, array.is_integer()};
    const auto width = static_cast<std::size_t>(array.components);
    std::int64_t n_rounded = 0;
    array.visit([&](auto numbers) {
      for (const std::size_t cell : other_cells_)
        for (std::size_t c = 0; c < width; ++c) {
          n_rounded += !is_exact_double(numbers[cell * width + c]);
          field.values.push_back(static_cast<double>(numbers[cell * width + c]));
        }
    });
    say_rounded(array.name, n_rounded, out_.notices);
    Index n_left_out = 0;  // what has become a side has no values
    for (std::size_t e = 0; e < is_side_.size(); ++e)
      n_left_out += is_side_[e] && std::ranges::find(vtk_group_arrays, array.name) == std::end(vtk_group_arrays) &&
                    !std::isnan(field.values[e * width]);
    if (n_left_out > 0)
      out_.notices.push_back("field '" + array.name + "': " + counted(n_left_out, "value") +
                             " left out, of quads that " + "are sides of hexes");
    if (std::ranges::any_of(field.values, [](double x) { return !std::isnan(x); }))
      heads_.fields.push_back(std::move(field));
  }

  VtkContents in_;
  const Cursor& cursor_;
  MeshFile out_;
  bool only_hexes_ = true;
  std::vector<std::size_t> hex_cells_;   // where there are other cells
  std::vector<std::size_t> quad_cells_;  // by their place among others
  std::vector<std::size_t> other_cells_;
  std::vector<std::uint8_t> is_side_;  // per other
  OtherHeads heads_;
  std::vector<Index> other_first_ = {0}, other_nodes_;
  std::vector<std::pair<Index, Index>> more_nodes_;  // that VTK has no place for
  std::vector<std::string> only_others_;             // arrays that are no fields of hexes
  std::map<std::int64_t, std::int64_t> n_dropped_;   // by cell type
  std::vector<Quad> quads_;
  std::vector<std::string> made_;
  FoundMiddles middles_;
};

}  // namespace

MeshFile assemble_vtk(VtkContents&& contents, const Cursor& cursor) {
  return VtkAssembly(std::move(contents), cursor).result();
}

}  // namespace hextwist::io
