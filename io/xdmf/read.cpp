// XDMF 2 and 3: a uniform grid of hexes with its attributes and sets, at the last of its times; numbers in HDF5 files
// or in place. Further grids of tags (DOLFINx) are blocks and side sets.
#include <map>

#include "hextwist/base/sorted.h"
#include "hextwist/io/apart.h"
#include "hextwist/io/hdf5/hdf5_internal.h"
#include "hextwist/io/hdf5/outside_internal.h"
#include "hextwist/io/xdmf/xml_internal.h"

namespace hextwist::io {
namespace {

struct Kind {
  std::string_view name;
  int in_mixed, vtk, n_nodes;  ///< n_nodes 0: a number before the nodes says how many
};
// Numbers of mixed topologies: XDMF Model and Format, "Topology".
constexpr Kind kinds[] = {{"Polyvertex", 1, 2, 0},        {"Polyline", 2, 4, 0},
                          {"Polygon", 3, 7, 0},           {"Triangle", 4, 5, 3},
                          {"Quadrilateral", 5, 9, 4},     {"Tetrahedron", 6, 10, 4},
                          {"Pyramid", 7, 14, 5},          {"Wedge", 8, 13, 6},
                          {"Hexahedron", 9, 12, 8},       {"Edge_3", 34, 21, 3},
                          {"Quadrilateral_9", 35, 28, 9}, {"Triangle_6", 36, 22, 6},
                          {"Quadrilateral_8", 37, 23, 8}, {"Tetrahedron_10", 38, 24, 10},
                          {"Pyramid_13", 39, 27, 13},     {"Wedge_15", 40, 26, 15},
                          {"Hexahedron_20", 48, 25, 20},  {"Hexahedron_27", 50, 29, 27}};

class XdmfReader {
 public:
  XdmfReader(const std::filesystem::path& file, const Bytes& bytes, std::filesystem::path folder)
      : file_(file), folder_(std::move(folder)), cursor_(bytes) {
    root_ = read_xdmf_tree(cursor_);
  }

  MeshFile result() {
    const XmlElement* domain = root_.child("Domain");
    if (!domain) cursor_.fail_at(root_.tag.at, "there is no Domain");
    find_grids(*domain, false);
    if (!grid_) cursor_.fail_at(domain->tag.at, "there is no grid of hexes");
    included_ = xdmf_includes(cursor_, root_, *grid_, first_ != nullptr);
    topology(*grid_);
    geometry(*grid_);
    for (const XmlElement* child : included_)
      if (child->tag.name == "Attribute") attribute(*child);
    for (const XmlElement& child : grid_->inside)
      if (child.tag.name == "Attribute") attribute(child);
    for (const XmlElement* grid : left_out_)
      if (std::ranges::none_of(included_, [&](const XmlElement* part) { return grid->has(*part); }))
        notes_.push_back("grid '" + std::string(grid->tag["Name"]) + "' is left out");
    const bool ours = add_field_data();
    n_cells_ = contents_.types.size();
    MeshFile out = assemble_vtk(std::move(contents_), cursor_);
    if (!ours) {
      for (const XmlElement& child : grid_->inside)
        if (child.tag.name == "Set") set(child, out);
      for (const XmlElement* tags : tags_) add_tags(*tags, out);
    }
    if (n_times_ > 1) out.notices.push_back("has " + std::to_string(n_times_) + " time steps: the last is read");
    for (const std::string& line : notes_) out.notices.push_back(line);
    return out;
  }

 private:
  static const Kind* kind_of(std::string_view name) {
    const auto found = std::ranges::find_if(kinds, [&](const Kind& kind) { return same_word(kind.name, name); });
    return found == std::end(kinds) ? nullptr : found;
  }

  /// The first grid with hexes; in a series of times the last one. Others are tags, or told.
  void find_grids(const XmlElement& parent, bool in_times) {
    for (const XmlElement& grid : parent.inside) {
      if (grid.tag.name != "Grid") continue;
      const std::string_view type = grid.either("GridType", "Type");
      if (same_word(type, "Collection") || same_word(type, "Tree")) {
        const bool times = same_word(grid.tag["CollectionType"], "Temporal");
        find_grids(grid, times);
        continue;
      }
      if (!type.empty() && !same_word(type, "Uniform"))
        cursor_.fail_at(grid.tag.at, "a grid of type " + shown(type) + " is not read");
      const XmlElement* topology = grid.child("Topology");
      const std::string_view kind = topology ? topology->either("TopologyType", "Type") : "";
      if (topology && (same_word(kind, "Polyhedron") || lower_case(kind).find("mesh") != std::string::npos))
        cursor_.fail_at(topology->tag.at, "a topology of type " + shown(kind) +
                                              "; only unstructured grids of hexes with 8, 20 or 27 nodes are read");
      const bool hexes = topology && (kind.starts_with("Hex") || kind.starts_with("HEX") || same_word(kind, "Mixed"));
      if (in_times) {
        ++n_times_;
        if (topology && !first_) first_ = &grid;
        grid_ = &grid;
      } else if (hexes && !grid_) {
        grid_ = first_ = &grid;
      } else if (topology && grid.child("Attribute")) {
        tags_.push_back(&grid);
      } else {
        left_out_.push_back(&grid);
      }
    }
  }

  /// The topology or geometry of a grid: its own, what it includes, or, where it includes nothing, that of the first of
  /// a series.
  const XmlElement* part(const XmlElement& grid, std::string_view name) const {
    if (const XmlElement* own = grid.child(name)) return own;
    for (const XmlElement* element : included_)
      if (element->tag.name == name) return element;
    return included_.empty() && first_ ? first_->child(name) : nullptr;
  }

  VtkArray values(const XmlElement& parent, std::vector<std::size_t>& sizes) {
    const XmlElement* item = parent.child("DataItem");
    if (!item) cursor_.fail_at(parent.tag.at, std::string(parent.tag.name) + " without a DataItem");
    return item_values(*item, sizes);
  }
  VtkArray item_values(const XmlElement& item, std::vector<std::size_t>& sizes, int depth = 0) {
    const std::string_view type = item.either("ItemType", "Type");
    if (!type.empty() && !same_word(type, "Uniform"))
      cursor_.fail_at(item.tag.at, "a DataItem of type " + shown(type) + " is not read");
    if (const std::string_view reference = item.tag["Reference"]; !reference.empty()) {
      if (depth > 10) cursor_.fail_at(item.tag.at, "references go in a circle");
      const std::string_view path = trimmed(same_word(reference, "XML") ? item.text : reference);
      const XmlElement* found = at_path(path);
      if (!found) cursor_.fail_at(item.tag.at, "the reference " + shown(path) + " leads to nothing that is understood");
      return item_values(*found, sizes, depth + 1);
    }
    sizes.clear();
    Cursor dimensions(item.tag["Dimensions"], cursor_.name);
    std::size_t n = 1;
    while (dimensions.more()) {
      const std::int64_t size = dimensions.integer("a size");
      if (size < 0 || __builtin_mul_overflow(n, static_cast<std::size_t>(size), &n))
        cursor_.fail_at(item.tag.at, "a DataItem has impossible sizes");
      sizes.push_back(static_cast<std::size_t>(size));
    }
    if (sizes.empty()) cursor_.fail_at(item.tag.at, "a DataItem has no sizes");
    const std::string_view format = item.tag["Format"];
    const std::string_view number = item.either("NumberType", "DataType");
    if (same_word(format, "HDF")) {
      const HeavyPlace place = heavy_place(item.text);
      if (place.dataset.empty())
        cursor_.fail_at(item.tag.at, shown(trimmed(item.text)) + " names no dataset of a file");
      VtkArray array = heavy(place.file).array(place.dataset, sizes);
      if (array.size() != n)
        cursor_.fail_at(item.tag.at, "dataset " + shown(place.dataset) + " has " + std::to_string(array.size()) +
                                         " values instead of " + std::to_string(n));
      return array;
    }
    if (!format.empty() && !same_word(format, "XML"))
      cursor_.fail_at(item.tag.at, "a DataItem of format " + shown(format) + " is not read, but HDF and XML");
    VtkArray array;
    array.name = "DataItem";
    Cursor words = cursor_;
    words.at = item.text.data();
    words.end = item.text.data() + item.text.size();
    const bool real = number.empty() || same_word(number, "Float");
    read_vtk_text(words, real ? VtkType::float64 : VtkType::int64, n, array);
    return array;
  }

  /// /Xdmf/Domain/Grid[1]/Topology/DataItem, Grid[@Name="mesh"]: what references are.
  const XmlElement* at_path(std::string_view path) const {
    if (!path.starts_with("/Xdmf")) return nullptr;
    const XmlElement* at = &root_;
    path.remove_prefix(5);
    while (!path.empty()) {
      path.remove_prefix(1);
      // A name may have a slash.
      std::size_t end = 0;
      for (bool quoted = false; end < path.size() && (quoted || path[end] != '/'); ++end)
        if (path[end] == '"' || path[end] == '\'') quoted = !quoted;
      std::string_view step = path.substr(0, end), condition;
      path.remove_prefix(end);
      if (const auto open = step.find('['); open != std::string_view::npos && step.ends_with("]")) {
        condition = step.substr(open + 1, step.size() - open - 2);
        step = step.substr(0, open);
      }
      std::int64_t number = 1;
      std::string_view name;
      if (condition.starts_with("@Name=") && condition.size() > 7)
        name = condition.substr(7, condition.size() - 8);
      else if (!condition.empty())
        std::from_chars(condition.data(), condition.data() + condition.size(), number);
      const XmlElement* next = nullptr;
      for (const XmlElement& child : at->inside)
        if (child.tag.name == step && (name.empty() || child.tag["Name"] == name) && number-- == 1) {
          next = &child;
          break;
        }
      if (!next) return nullptr;
      at = next;
    }
    return at->tag.name == "DataItem" ? at : nullptr;
  }

  const Hdf5Reader& heavy(const std::string& name) {
    const auto known = heavy_.find(name);
    if (known != heavy_.end()) return *known->second;
    const std::filesystem::path path = heavy_file(file_, name, folder_);
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
      throw Error(cursor_.name.data() + std::string(": the file with its data, ") + shown(path.string()) +
                  ", is not there");
    refuse_links_outside(path, folder_);
    return *(heavy_[name] = std::make_unique<Hdf5Reader>(path, path.string()));
  }

  struct Cells {
    VtkArray connectivity, ends, types;
  };
  Cells cells(const XmlElement& topology) {
    Cells result;
    std::vector<std::size_t> sizes;
    result.connectivity = values(topology, sizes);
    if (!result.connectivity.is_integer()) cursor_.fail_at(topology.tag.at, "a topology is not of integers");
    const std::string_view name = topology.either("TopologyType", "Type");
    std::vector<std::int64_t> ends, types;
    const auto n = static_cast<std::int64_t>(result.connectivity.size());
    if (same_word(name, "Mixed")) {
      std::vector<std::int64_t> all(static_cast<std::size_t>(n)), nodes;
      result.connectivity.copy(0, all);
      for (std::size_t at = 0; at < all.size();) {
        const auto kind = std::ranges::find(kinds, all[at++], [](const Kind& k) { return std::int64_t{k.in_mixed}; });
        if (kind == std::end(kinds))
          cursor_.fail_at(topology.tag.at, "cell " + std::to_string(types.size() + 1) + " is of unknown type " +
                                               std::to_string(all[at - 1]));
        // Points and lines always say how many.
        std::int64_t width = kind->n_nodes;
        if (width == 0) width = at < all.size() ? all[at++] : -1;
        if (width < 0 || width > static_cast<std::int64_t>(all.size() - at))
          cursor_.fail_at(topology.tag.at, "the topology ends within cell " + std::to_string(types.size() + 1));
        nodes.insert(nodes.end(), all.begin() + static_cast<std::ptrdiff_t>(at),
                     all.begin() + static_cast<std::ptrdiff_t>(at) + width);
        at += static_cast<std::size_t>(width);
        ends.push_back(std::ssize(nodes));
        types.push_back(kind->vtk);
      }
      set_integers(result.connectivity, nodes);
    } else {
      const Kind* kind = kind_of(name);
      if (!kind || kind->n_nodes == 0)
        cursor_.fail_at(topology.tag.at, "a topology of type " + shown(name) + " is not read");
      if (n % kind->n_nodes != 0)
        cursor_.fail_at(topology.tag.at, "a topology of " + std::to_string(n) + " nodes is not of cells with " +
                                             std::to_string(kind->n_nodes));
      for (std::int64_t c = 1; c <= n / kind->n_nodes; ++c) ends.push_back(c * kind->n_nodes);
      types.assign(ends.size(), kind->vtk);
    }
    if (const std::string_view base = topology.tag["BaseOffset"]; !base.empty() && base != "0")
      cursor_.fail_at(topology.tag.at, "only topologies whose nodes are counted from 0 are read");
    set_integers(result.ends, ends);
    set_integers(result.types, types);
    return result;
  }

  void topology(const XmlElement& grid) {
    const XmlElement* topology = part(grid, "Topology");
    if (!topology) cursor_.fail_at(grid.tag.at, "a grid without a topology");
    Cells all = cells(*topology);
    contents_.connectivity = std::move(all.connectivity);
    contents_.ends = std::move(all.ends);
    contents_.types = std::move(all.types);
  }

  void geometry(const XmlElement& grid) {
    const XmlElement* geometry = part(grid, "Geometry");
    if (!geometry) cursor_.fail_at(grid.tag.at, "a grid without a geometry");
    const std::string_view type = geometry->either("GeometryType", "Type");
    if (!type.empty() && !same_word(type, "XYZ"))
      cursor_.fail_at(geometry->tag.at, "a geometry of type " + shown(type) + " is not read, but XYZ");
    std::vector<std::size_t> sizes;
    const VtkArray points = values(*geometry, sizes);
    if (points.size() % 3 != 0)
      cursor_.fail_at(geometry->tag.at, std::to_string(points.size()) + " coordinates are not three per point");
    contents_.points = vtk_points(points, cursor_);
  }

  void attribute(const XmlElement& attribute) {
    const std::string_view centre = attribute.tag["Center"];
    const std::string name(attribute.tag["Name"]);
    const bool cell = same_word(centre, "Cell");
    if (!cell && !centre.empty() && !same_word(centre, "Node")) {
      notes_.push_back("attribute '" + name + "' is neither of nodes nor of cells: left out");
      return;
    }
    std::vector<std::size_t> sizes;
    VtkArray array = values(attribute, sizes);
    array.name = name;
    array.on = cell ? VtkArray::On::cell : VtkArray::On::node;
    std::size_t width = 1;
    for (std::size_t d = 1; d < sizes.size(); ++d) width *= sizes[d];
    if (width < 1 || width > 1000)
      cursor_.fail_at(attribute.tag.at, "attribute " + shown(name) + " has impossible sizes");
    array.components = static_cast<int>(width);
    contents_.arrays.push_back(std::move(array));
  }

  /// What our own files have beside the grid. False: it is not one of them.
  bool add_field_data() {
    bool ours = false;
    for (const auto& [name, file] : heavy_)
      for (const std::string& link : file->members("/FieldData")) {
        const std::string path = "/FieldData/" + link;
        if (!file->is_numbers(path)) continue;
        const std::string array_name = file->text(path, hdf5_name);
        if (!array_name.starts_with("hextwist:")) continue;
        std::vector<std::size_t> sizes;
        VtkArray array = file->array(path, sizes);
        array.name = array_name;
        array.on = VtkArray::On::file;
        ours = ours || array_name.starts_with("hextwist:made");
        contents_.arrays.push_back(std::move(array));
      }
    return ours;
  }

  void set(const XmlElement& set, MeshFile& out) {
    const std::string_view type = set.either("SetType", "Type");
    const std::string name(set.tag["Name"]);
    const bool node = same_word(type, "Node");
    if ((!node && !same_word(type, "Cell")) || !out.middles.empty() || (!node && n_cells_ != out.mesh.hexes.size())) {
      notes_.push_back("set '" + name + "' of type " + shown(type) + " is left out");
      return;
    }
    std::vector<std::size_t> sizes;
    const VtkArray members = values(set, sizes);
    std::vector<Index> found(members.size());
    if (!members.is_integer()) cursor_.fail_at(set.tag.at, "set " + shown(name) + " is not of integers");
    members.copy_indices(0, found, node ? out.mesh.n_nodes() : out.mesh.n_hexes());
    if (std::ranges::find(found, -1) != found.end())
      cursor_.fail_at(set.tag.at, "set " + shown(name) + " has a member that is not there");
    sort_unique(found);
    if (node)
      out.mesh.node_sets.push_back({free_id(out.mesh.node_sets), name, std::move(found)});
    else
      out.mesh.blocks.push_back({free_id(out.mesh.blocks), name, std::move(found)});
  }

  /// Cells with a number each: blocks and side sets.
  void add_tags(const XmlElement& grid, MeshFile& out) {
    const XmlElement* topology = grid.child("Topology");
    const XmlElement* attribute = grid.child("Attribute");
    const Kind* kind = kind_of(topology->either("TopologyType", "Type"));
    const std::string name(grid.tag["Name"]);
    const bool quads = kind && kind->vtk == 9, hexes = kind && kind->vtk == 12;
    std::vector<std::size_t> sizes;
    if ((!quads && !hexes) || !out.middles.empty()) {
      notes_.push_back("grid '" + name + "' is left out");
      return;
    }
    const Cells tagged = cells(*topology);
    const VtkArray numbers = values(*attribute, sizes);
    const auto width = static_cast<std::size_t>(kind->n_nodes);
    std::vector<Index> nodes(tagged.connectivity.size());
    tagged.connectivity.copy_indices(0, nodes, out.mesh.n_nodes());
    if (!numbers.is_integer() || numbers.size() * width != nodes.size() ||
        std::ranges::find(nodes, -1) != nodes.end()) {
      notes_.push_back("grid '" + name + "' is left out: its tags do not fit");
      return;
    }
    Index n_lost = 0;
    const auto number = [&](std::size_t i) {
      const std::int64_t value = numbers.integer(i);
      return value > 0 && value < std::numeric_limits<int>::max() ? static_cast<int>(value) : 0;
    };
    if (quads) {
      std::vector<Quad> cycles(numbers.size());
      for (std::size_t q = 0; q < cycles.size(); ++q) std::copy_n(&nodes[4 * q], 4, cycles[q].begin());
      const std::vector<Side> sides = oriented_sides(out.mesh, cycles);
      for (std::size_t q = 0; q < sides.size(); ++q) {
        if (sides[q].hex < 0)
          ++n_lost;
        else if (const int id = number(q))
          group_of_id(out.mesh.side_sets, id).sides.push_back(sides[q]);
      }
      for (SideSet& set : out.mesh.side_sets) sort_unique(set.sides);
    } else {
      using Corners = std::array<Index, 8>;
      std::vector<std::pair<Corners, Index>> all;
      for (Index h = 0; h < out.mesh.n_hexes(); ++h) {
        Corners corners = out.mesh.hexes[h];
        std::ranges::sort(corners);
        all.emplace_back(corners, h);
      }
      std::ranges::sort(all);
      for (std::size_t c = 0; c < numbers.size(); ++c) {
        Corners corners;
        std::copy_n(&nodes[8 * c], 8, corners.begin());
        std::ranges::sort(corners);
        const auto found = std::ranges::lower_bound(all, std::pair(corners, Index{0}));
        if (found == all.end() || found->first != corners)
          ++n_lost;
        else if (const int id = number(c))
          group_of_id(out.mesh.blocks, id).hexes.push_back(found->second);
      }
      for (Block& block : out.mesh.blocks) sort_unique(block.hexes);
    }
    if (n_lost > 0)
      notes_.push_back("grid '" + name + "': " + counted(n_lost, "cell") + (n_lost == 1 ? " is" : " are") +
                       " no hex or side of one: left out");
  }

  const std::filesystem::path file_, folder_;
  Cursor cursor_;
  XmlElement root_;
  const XmlElement *grid_ = nullptr, *first_ = nullptr;
  std::vector<const XmlElement*> tags_, left_out_;
  std::vector<const XmlElement*> included_;  // in grid_
  std::int64_t n_times_ = 0;
  std::map<std::string, std::unique_ptr<Hdf5Reader>> heavy_;
  VtkContents contents_;
  std::size_t n_cells_ = 0;  // cells
  std::vector<std::string> notes_;
};

}  // namespace

MeshFile read_xdmf_here(const std::filesystem::path& file, const std::filesystem::path& folder) {
  const Bytes bytes = read_bytes(file);
  return XdmfReader(file, bytes, folder).result();
}

MeshFile read_xdmf(const std::filesystem::path& file, const Fence& fence) {
  // What it names counts for the limits.
  std::uintmax_t heavy = 0;
  if (fence.is_there()) {
    const Bytes bytes = read_bytes(file);
    Cursor cursor(bytes);
    std::vector<std::string> files;
    each_element(read_xdmf_tree(cursor), [&](const XmlElement& element) {
      if (element.tag.name == "DataItem") files.push_back(heavy_place(element.text).file);
    });
    sort_unique(files);
    for (const std::string& name : files) {
      std::error_code error;
      const auto size = name.empty() ? 0 : std::filesystem::file_size(heavy_file(file, name, fence.folder), error);
      if (!error) heavy += size;
    }
  }
  return read_apart(fence, "xdmf", read_xdmf_here, file, heavy);
}

}  // namespace hextwist::io
