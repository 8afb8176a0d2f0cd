// CGNS through its library: unstructured and structured zones, joined where the file says that they are; sections of
// hexes are blocks, boundary conditions sets, solutions fields.
#include <limits>
#include <numeric>

#include "hextwist/base/sorted.h"
#include "hextwist/base/union_find.h"
#include "hextwist/io/apart.h"
#include "hextwist/io/cgns/zones_internal.h"
#include "hextwist/io/hdf5/outside_internal.h"

namespace hextwist::io {
namespace {

/// Joined nodes of two zones lie at one place, to this part of the size of the mesh.
constexpr double joined_tolerance = 1e-6;

class CgnsReader {
 public:
  explicit CgnsReader(const std::filesystem::path& path)
      : name_(path.string()),
        file_(path, CG_MODE_READ),
        listing_(cursor_),
        in_{file_.id(), name_, std::filesystem::file_size(path)} {
    if (file_.id() < 0) in_.fail("cannot be opened as CGNS (damaged or another format): " + cgns_error());
  }

  MeshFile result() {
    base();
    nodes();
    std::int64_t first_element = 0;
    for (CgnsZone& zone : zones_) {
      zone.first_element = first_element;
      elements(zone);
      first_element += zone.n_elements;
    }
    regions();
    for (CgnsZone& zone : zones_) conditions(zone);
    groups();
    MeshFile out = listing_.result(false);
    for (const Set& set : side_sets_)
      if (!set.type.empty() && std::ranges::find(out.mesh.side_sets, set.id, &SideSet::id) != out.mesh.side_sets.end())
        out.extras.boundary_types[set.id] = set.type;
    fields(out);
    for (const std::string& line : in_.notes) out.notices.push_back(line);
    return out;
  }

 private:
  void base() {
    int n = 0;
    in_.check(cg_nbases(in_.file, &n), "bases");
    for (int b = 1; b <= n && in_.base == 0; ++b) {
      CgnsName name{};
      int cells = 0, space = 0;
      in_.check(cg_base_read(in_.file, b, name.data(), &cells, &space), "a base");
      if (cells == 3 && space == 3) in_.base = b;
    }
    if (in_.base == 0) in_.fail("there is no base of three dimensions");
    if (n > 1) in_.notes.push_back("of " + std::to_string(n) + " bases base " + std::to_string(in_.base) + " is read");
    int n_zones = 0;
    in_.check(cg_nzones(in_.file, in_.base, &n_zones), "zones");
    if (n_zones < 1) in_.fail("there is no zone in the file");
    std::int64_t first_node = 0;
    for (int z = 1; z <= n_zones; ++z) {
      zones_.push_back(cgns_zone(in_, z, first_node));
      first_node += zones_.back().n_nodes;
    }
  }

  /// Nodes of all zones, those that are joined once: number_of_[zone's first node + i] is the id of node i.
  void nodes() {
    std::vector<Vec3> points;
    for (const CgnsZone& zone : zones_) {
      const std::vector<Vec3> some = cgns_points(in_, zone);
      points.insert(points.end(), some.begin(), some.end());
    }
    Box box;
    for (const Vec3& point : points) box.add(point);
    std::vector<Index> same = singletons(static_cast<Index>(points.size()));
    bool joined = false;
    for (const CgnsZone& zone : zones_)
      for (const auto& [a, b] : cgns_joined_nodes(in_, zone, zones_)) {
        const double apart = (points[a] - points[b]).norm();
        if (!(apart <= joined_tolerance * box.diagonal()))
          in_.fail("zone " + shown(zone.name) + " is joined to another by nodes that are " + short_number(apart, 6) +
                   " apart");
        join(same, static_cast<Index>(a), static_cast<Index>(b));
        joined = true;
      }
    if (zones_.size() > 1 && !joined)
      in_.notes.push_back("the " + std::to_string(zones_.size()) +
                          " zones are not joined in the file: nodes at the same place stay apart");
    const std::vector<std::int64_t> ids =
        zones_.size() == 1 ? cgns_ids(in_, zones_[0], "NodeId") : std::vector<std::int64_t>();
    number_of_.resize(points.size());
    std::vector<std::int64_t> number_of_root(joined ? points.size() : 0, 0);
    std::int64_t next = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (joined) {
        auto& of_root = number_of_root[static_cast<std::size_t>(find_root(same, static_cast<Index>(i)))];
        number_of_[i] = of_root;
        if (of_root > 0) continue;
        of_root = ++next;
      } else {
        ++next;
      }
      number_of_[i] = ids.size() == points.size() ? ids[i] : next;
      listing_.add_node(number_of_[i], points[i], nullptr);
    }
  }
  std::int64_t node(const CgnsZone& zone, std::int64_t i) const {
    return number_of_[static_cast<std::size_t>(zone.first_node + i)];
  }

  void elements(CgnsZone& zone) {
    if (zone.structured) return cells(zone);
    zone.n_elements = 0;
    for (const CgnsSection& section : zone.sections) zone.n_elements = std::max(zone.n_elements, section.end);
    zone.id_of_element.assign(static_cast<std::size_t>(zone.n_elements) + 1, 0);
    zone.in_condition.assign(zone.id_of_element.size(), 0);
    zone.is_hex.assign(zone.id_of_element.size(), 0);
    const std::vector<std::int64_t> ids =
        zones_.size() == 1 ? cgns_ids(in_, zone, "HexId") : std::vector<std::int64_t>();
    const std::int64_t above = ids.empty() ? 0 : std::ranges::max(ids);
    std::size_t next_hex = 0;
    std::vector<std::int64_t> nodes;
    for (CgnsSection& section : zone.sections) {
      cgns_elements(in_, zone, section, [&](std::int64_t number, const CgnsType& type, std::span<const cgsize_t> of) {
        std::int64_t id = zone.first_element + number + above;
        if (type.what == CgnsType::hex && next_hex < ids.size()) id = ids[next_hex];
        if (type.what == CgnsType::other) return listing_.drop(id, type.name);
        nodes.clear();
        for (const cgsize_t i : of) {
          if (i < 1 || i > zone.n_nodes)
            in_.fail("element " + std::to_string(number) + " of section " + shown(section.name) + " names node " +
                     std::to_string(i) + " of " + std::to_string(zone.n_nodes));
          nodes.push_back(node(zone, i - 1));
        }
        if (zone.id_of_element[static_cast<std::size_t>(number)] != 0)
          in_.fail("element " + std::to_string(number) + " of zone " + shown(zone.name) + " occurs twice");
        zone.id_of_element[static_cast<std::size_t>(number)] = id;
        if (type.what == CgnsType::quad) {
          section.quads = true;
          return listing_.add_quad(id, 0, nodes, nullptr);
        }
        section.hexes = true;
        zone.is_hex[static_cast<std::size_t>(number)] = 1;
        ++next_hex;
        zone.hex_ids.push_back(id);
        listing_.add_hex(id, 0, nodes, cgns_middles, nullptr);
      });
    }
  }

  /// Of a structured zone.
  void cells(CgnsZone& zone) {
    const auto& [ni, nj, nk] = zone.cells;
    zone.n_elements = ni * nj * nk;
    for (std::int64_t k = 0, id = zone.first_element; k < nk; ++k)
      for (std::int64_t j = 0; j < nj; ++j)
        for (std::int64_t i = 0; i < ni; ++i) {
          std::array<std::int64_t, 8> nodes;
          for (std::size_t c = 0; c < 8; ++c) {
            const int bits = file_corner[c];
            nodes[c] = node(zone, zone.node_at({i + (bits & 1), j + (bits >> 1 & 1), k + (bits >> 2 & 1)}));
          }
          zone.hex_ids.push_back(++id);
          listing_.add_hex(id, 0, nodes, cgns_middles, nullptr);
        }
  }

  struct Set {
    std::string name;
    int id = -1;  // -1: any
    std::vector<std::int64_t> nodes = {}, elements = {};
    std::vector<std::pair<std::int64_t, int>> sides = {};
    bool block = false, node_set = false, side_set = false;  // even without members
    std::string type = {};                                   // of a boundary condition
  };
  /// The set of this name, with members of another zone.
  Set& set_of(std::vector<Set>& sets, const CgnsLabel& label) {
    const auto same =
        std::ranges::find_if(sets, [&](const Set& set) { return set.name == label.name && set.id == label.id; });
    return same != sets.end() ? *same : sets.emplace_back(Set{label.name, label.id});
  }

  void add_elements(const CgnsZone& zone, const std::vector<cgsize_t>& numbers, const std::string& what, Set& set) {
    for (const cgsize_t number : numbers) {
      if (number < 1 || number > zone.n_elements)
        in_.fail(what + " names element " + std::to_string(number) + " of " + std::to_string(zone.n_elements));
      const std::int64_t id = zone.structured ? zone.hex_ids[static_cast<std::size_t>(number - 1)]
                                              : zone.id_of_element[static_cast<std::size_t>(number)];
      if (id != 0) set.elements.push_back(id);
    }
  }
  void add_nodes(const CgnsZone& zone, const std::vector<cgsize_t>& numbers, const std::string& what, Set& set) {
    for (const cgsize_t number : numbers) {
      if (number < 1 || number > zone.n_nodes)
        in_.fail(what + " names node " + std::to_string(number) + " of " + std::to_string(zone.n_nodes));
      set.nodes.push_back(node(zone, number - 1));
    }
  }

  /// Sections of hexes, and regions of cells, are blocks; regions of nodes and faces sets.
  void regions() {
    for (CgnsZone& zone : zones_) {
      const auto n_with_hexes = std::ranges::count(zone.sections, true, &CgnsSection::hexes);
      for (const CgnsSection& section : zone.sections) {
        if (!section.hexes || section.label.kind == "part") continue;
        CgnsLabel label = section.label;
        if (label.kind.empty() && n_with_hexes == 1 && (zones_.size() > 1 || !zone.family.empty()))
          label.name = zone.family.empty() ? zone.name : zone.family;
        else if (label.kind.empty() && zones_.size() > 1)
          label.name = zone.name + " " + section.name;
        Set& set = set_of(blocks_, label);
        set.block = true;
        for (auto e = static_cast<std::size_t>(section.start); e <= static_cast<std::size_t>(section.end); ++e)
          if (zone.is_hex[e]) set.elements.push_back(zone.id_of_element[e]);
      }
      if (zone.structured) {
        Set& set = set_of(blocks_, {"", -1, zone.family.empty() ? zone.name : zone.family});
        set.block = true;
        set.elements.insert(set.elements.end(), zone.hex_ids.begin(), zone.hex_ids.end());
      }
      for (CgnsRegion& region : cgns_regions(in_, zone)) {
        const std::string what = "region " + shown(region.name);
        if (region.location == CGNS_ENUMV(Vertex)) {
          Set& set = set_of(node_sets_, region.label);
          set.node_set = true;
          add_nodes(zone, region.points, what, set);
        } else {
          Set& set = set_of(blocks_, region.label);
          set.block = region.label.kind == "block";
          add_elements(zone, region.points, what, set);
        }
      }
    }
  }

  void conditions(CgnsZone& zone) {
    for (CgnsRegion& condition : cgns_conditions(in_, zone)) {
      const std::string what = "boundary condition " + shown(condition.name);
      std::vector<std::pair<std::int64_t, int>> sides;
      if (zone.structured && cgns_sides(in_, zone, condition, what, sides)) {
        Set& set = set_of(side_sets_, condition.label);
        set.side_set = true;
        set.sides.insert(set.sides.end(), sides.begin(), sides.end());
        set.type = condition.type;
      } else if (condition.location == CGNS_ENUMV(Vertex)) {
        Set& set = set_of(node_sets_, condition.label);
        set.node_set = true;
        add_nodes(zone, condition.points, what, set);
        if (!condition.type.empty())
          in_.notes.push_back(what + " of nodes is a node set: its type " + condition.type + " is left out");
      } else {
        Set& set = set_of(side_sets_, condition.label);
        set.side_set = condition.label.kind == "sideset";
        add_elements(zone, condition.points, what, set);
        if (!condition.type.empty()) set.type = condition.type;
        for (const cgsize_t number : condition.points)
          if (!zone.structured) zone.in_condition[static_cast<std::size_t>(number)] = 1;
      }
    }
    // Quads of which no condition speaks.
    for (const CgnsSection& section : zone.sections) {
      if (!section.quads || section.label.kind == "part") continue;
      std::vector<std::int64_t> ids;
      for (auto e = static_cast<std::size_t>(section.start); e <= static_cast<std::size_t>(section.end); ++e)
        if (zone.id_of_element[e] != 0 && !zone.is_hex[e] && !zone.in_condition[e])
          ids.push_back(zone.id_of_element[e]);
      if (ids.empty()) continue;
      Set& set = set_of(side_sets_, section.label);
      set.elements.insert(set.elements.end(), ids.begin(), ids.end());
    }
  }

  void groups() {
    const auto add = [&](std::vector<Set>& sets, const char* kind) {
      int next = 0;
      for (const Set& set : sets) next = std::max({next, set.id, generated_id(set.name, kind)});
      for (Set& set : sets) {
        const bool is_own = set.id >= 0;
        if (!is_own) set.id = generated_id(set.name, kind) >= 0 ? generated_id(set.name, kind) : ++next;
        Listing::Group& group = listing_.add_group(set.id, set.name);
        group.nodes = std::move(set.nodes);
        group.elements = std::move(set.elements);
        group.sides = std::move(set.sides);
        group.is_own = is_own;
        group.empty_block = set.block;
        group.empty_node_set = set.node_set;
        group.empty_side_set = set.side_set;
      }
    };
    add(blocks_, "block");
    add(node_sets_, "nodeset");
    add(side_sets_, "sideset");
  }

  /// Scalars that are called aX, aY, aZ are a vector, as in all of the SIDS.
  static void name_vectors(std::vector<Field>& fields) {
    for (std::size_t i = 0; i + 2 < fields.size(); ++i) {
      const std::string stem = fields[i].name.substr(0, std::max<std::size_t>(1, fields[i].name.size()) - 1);
      bool vector = !stem.empty();
      for (std::size_t c = 0; c < 3; ++c)
        vector = vector && fields[i + c].name == stem + "XYZ"[c] && fields[i + c].on == fields[i].on;
      if (!vector) continue;
      for (std::size_t c = 0; c < 3; ++c) fields[i + c].name = stem + "_" + "xyz"[c];
    }
  }

  void fields(MeshFile& out) {
    std::vector<Field> fields;
    for (const CgnsZone& zone : zones_)
      for (const CgnsValues& values : cgns_solutions(in_, zone)) {
        const bool node = values.on == Field::On::node;
        auto field = std::ranges::find_if(
            fields, [&](const Field& other) { return other.name == values.name && other.on == values.on; });
        if (field == fields.end()) {
          fields.push_back({values.name, values.on, 1, {}, values.integer});
          field = fields.end() - 1;
          field->values.assign(node ? out.mesh.points.size() : out.mesh.hexes.size(),
                               values.integer ? 0 : std::numeric_limits<double>::quiet_NaN());
        }
        field->integer = field->integer && values.integer;
        if (!node && zone.hex_ids.size() != values.values.size()) {
          out.notices.push_back("field '" + values.name + "' of zone " + shown(zone.name) + " has " +
                                std::to_string(values.values.size()) + " values for " +
                                counted(std::ssize(zone.hex_ids), "hex", "hexes") + ": left out");
          continue;
        }
        for (std::size_t i = 0; i < values.values.size(); ++i) {
          const Index item = node ? find_node(out.mesh, this->node(zone, static_cast<std::int64_t>(i)))
                                  : find_hex(out.mesh, zone.hex_ids[i]);
          if (item >= 0) field->values[item] = values.values[i];  // else a middle node
        }
      }
    name_vectors(fields);
    std::vector<Field> merged = merge_components(std::move(fields));
    out.mesh.fields = std::move(merged);
  }

  const std::string name_;
  const CgnsFile file_;
  const Cursor cursor_{"", name_};
  Listing listing_;
  CgnsPlace in_;
  std::vector<CgnsZone> zones_;
  std::vector<std::int64_t> number_of_;
  std::vector<Set> blocks_, node_sets_, side_sets_;
};

}  // namespace

MeshFile read_cgns_here(const std::filesystem::path& file, const std::filesystem::path& folder) {
  refuse_links_outside(file, folder);
  return CgnsReader(file).result();
}

MeshFile read_cgns(const std::filesystem::path& file, const Fence& fence) {
  return read_apart(fence, "cgns", read_cgns_here, file);
}

}  // namespace hextwist::io
