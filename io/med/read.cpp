// MED (SALOME, code_aster) through its library: groups by families, nodal and element fields of the last step.
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <utility>

#include "hextwist/base/sorted.h"
#include "hextwist/io/apart.h"
#include "hextwist/io/med/med_internal.h"

namespace hextwist::io {
namespace {

struct GeoType {
  med_geometry_type type;
  int n_nodes;
  const char* name;
};
constexpr GeoType refused[] = {{310, 10, "tetrahedron of 10 nodes"},
                               {313, 13, "pyramid of 13 nodes"},
                               {315, 15, "wedge of 15 nodes"},
                               {318, 18, "wedge of 18 nodes"},
                               {312, 12, "hexagonal prism"}};
constexpr GeoType dropped[] = {{103, 3, "SEG3"}, {104, 4, "SEG4"}, {206, 6, "TRIA6"}, {207, 7, "TRIA7"}};
constexpr GeoType hexes[] = {{MED_HEXA8, 8, ""}, {MED_HEXA20, 20, ""}, {MED_HEXA27, 27, ""}};
constexpr GeoType quads[] = {{MED_QUAD4, 4, ""}, {MED_QUAD8, 8, ""}, {MED_QUAD9, 9, ""}};

/// Values as a file has them, as doubles. get: fills an array of n of them; what it can't is none.
using MedGet = std::function<bool(unsigned char*)>;
template <class Number>
std::vector<double> med_values(std::size_t n, const MedGet& get, std::int64_t& n_rounded) {
  std::vector<Number> values(n);
  if (!get(reinterpret_cast<unsigned char*>(values.data()))) return {};
  n_rounded += std::ranges::count_if(values, [](Number x) { return !is_exact_double(x); });
  return {values.begin(), values.end()};
}

/// How values of a type are read; nothing: of no type that is known.
struct MedNumbers {
  std::vector<double> (*read)(std::size_t n, const MedGet& get, std::int64_t& n_rounded) = nullptr;
  bool integer = false;
};
MedNumbers numbers_of(med_field_type type) {
  switch (type) {
    case MED_FLOAT64:
      return {med_values<double>};
    case MED_FLOAT32:
      return {med_values<float>};
    case MED_INT32:
      return {med_values<std::int32_t>, true};
    case MED_INT64:
      return {med_values<std::int64_t>, true};
    case MED_INT:
      return {med_values<med_int>, true};
    default:
      return {};
  }
}

/// Whether names or units of components say more than our writer's numbers do.
bool says_something(std::string_view of_components) {
  return std::ranges::any_of(of_components, [](char c) { return c != '\0' && c != ' ' && (c < '0' || c > '9'); });
}

class MedReader {
 public:
  explicit MedReader(const std::filesystem::path& path)
      : name_(path.string()), most_(std::filesystem::file_size(path)), file_(path, MED_ACC_RDONLY), listing_(cursor_) {
    if (file_.id() < 0) fail("cannot be opened as MED (damaged or another format)");
  }

  MeshFile result() {
    mesh();
    families();
    nodes();
    for (const GeoType& type : refused)
      if (const std::int64_t n = count(MED_CELL, type.type); n > 0)
        fail("element 1 of " + std::to_string(n) + " of its kind is a " + type.name +
             "; only hexes of 8, 20 or 27 nodes, and straight elements beside them, are accepted");
    if (count(MED_CELL, MED_POLYHEDRON) > 0) fail("there are polyhedra; only hexes of 8, 20 or 27 nodes are accepted");
    for (const GeoType& type : hexes) elements(type, true);
    for (const GeoType& type : quads) elements(type, false);
    listing_.set_format("med");
    for (const MedOther& type : med_others)
      if (type.shape != OtherShape::quad) others(type);
    for (const GeoType& type : dropped)
      for (std::int64_t i = count(MED_CELL, type.type); i > 0; --i) listing_.drop(0, type.name);
    groups();
    MeshFile out = listing_.result(false);
    fields(out);
    return out;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw Error(name_ + ": " + what); }

  void mesh() {
    const med_int n = MEDnMesh(file_.id());
    if (n < 1) fail("there is no mesh in the file");
    const med_int n_axes = MEDmeshnAxis(file_.id(), 1);
    if (n_axes != 3) fail("has " + std::to_string(n_axes) + " dimensions instead of 3");
    std::array<char, MED_NAME_SIZE + 1> mesh{};
    std::array<char, MED_COMMENT_SIZE + 1> description{};
    std::array<char, MED_SNAME_SIZE + 1> unit{};
    std::array<char, 3 * MED_SNAME_SIZE + 1> axes{}, units{};
    med_int space = 0, dimension = 0, n_steps = 0;
    med_mesh_type type = MED_UNDEF_MESH_TYPE;
    med_sorting_type sorting = MED_SORT_UNDEF;
    med_axis_type axis = MED_UNDEF_AXIS_TYPE;
    if (MEDmeshInfo(file_.id(), 1, mesh.data(), &space, &dimension, &type, description.data(), unit.data(), &sorting,
                    &n_steps, &axis, axes.data(), units.data()) < 0)
      fail("its mesh cannot be read (damaged file)");
    mesh_ = mesh.data();
    if (type != MED_UNSTRUCTURED_MESH) fail("mesh " + shown(mesh_) + " is structured; only unstructured ones are read");
    if (axis != MED_CARTESIAN) fail("mesh " + shown(mesh_) + " has no Cartesian coordinates");
    if (n > 1) listing_.note("of " + std::to_string(n) + " meshes in the file the first is read, '" + mesh_ + "'");
    if (n_steps > 1) listing_.note("the mesh has " + std::to_string(n_steps) + " steps: the first is read");
  }

  /// How many entities there are; a damaged file must not become a huge allocation (HDF5 packs a thousandfold at most).
  std::int64_t count(med_entity_type entity, med_geometry_type type, med_data_type data = MED_CONNECTIVITY) const {
    med_bool changed = MED_FALSE, moved = MED_FALSE;
    const med_int n = MEDmeshnEntity(file_.id(), mesh_.c_str(), MED_NO_DT, MED_NO_IT, entity, type, data,
                                     data == MED_CONNECTIVITY ? MED_NODAL : MED_NO_CMODE, &changed, &moved);
    if (n > 0 && static_cast<std::uintmax_t>(n) > 300 * most_)
      fail("impossible number of entities: " + std::to_string(n));
    if (n > std::numeric_limits<Index>::max()) fail("too many entities: " + std::to_string(n));
    return std::max<std::int64_t>(n, 0);
  }

  std::vector<med_int> numbers(med_entity_type entity, med_geometry_type type, std::int64_t n,
                               med_data_type data) const {
    std::vector<med_int> result(static_cast<std::size_t>(n), 0);
    if (count(entity, type, data) != n) return {};
    const auto read = data == MED_NUMBER ? MEDmeshEntityNumberRd : MEDmeshEntityFamilyNumberRd;
    if (n > 0 && read(file_.id(), mesh_.c_str(), MED_NO_DT, MED_NO_IT, entity, type, result.data()) < 0) return {};
    return result;
  }

  void families() {
    const med_int n = MEDnFamily(file_.id(), mesh_.c_str());
    for (int i = 1; i <= n; ++i) {
      const med_int n_groups = MEDnFamilyGroup(file_.id(), mesh_.c_str(), i);
      if (n_groups < 0 || static_cast<std::uintmax_t>(n_groups) > most_)
        fail("its families cannot be read (damaged file)");
      std::array<char, MED_NAME_SIZE + 1> family{};
      std::string text(static_cast<std::size_t>(n_groups) * MED_LNAME_SIZE + 1, '\0');
      med_int number = 0;
      if (MEDfamilyInfo(file_.id(), mesh_.c_str(), i, family.data(), &number, text.data()) < 0)
        fail("family " + std::to_string(i) + " cannot be read (damaged file)");
      for (med_int g = 0; g < n_groups; ++g) {
        const std::string name(
            trimmed(std::string(text.substr(static_cast<std::size_t>(g) * MED_LNAME_SIZE, MED_LNAME_SIZE).c_str())));
        groups_of_family_[number].push_back(name);
      }
    }
  }

  void nodes() {
    med_bool changed = MED_FALSE, moved = MED_FALSE;
    const std::int64_t n = MEDmeshnEntity(file_.id(), mesh_.c_str(), MED_NO_DT, MED_NO_IT, MED_NODE, MED_NONE,
                                          MED_COORDINATE, MED_NO_CMODE, &changed, &moved);
    if (n < 1) fail("there are no nodes");
    if (static_cast<std::uintmax_t>(n) > 300 * most_ || n > std::numeric_limits<Index>::max())
      fail("impossible number of nodes: " + std::to_string(n));
    std::vector<med_float> coordinates(3 * static_cast<std::size_t>(n));
    if (MEDmeshNodeCoordinateRd(file_.id(), mesh_.c_str(), MED_NO_DT, MED_NO_IT, MED_FULL_INTERLACE,
                                coordinates.data()) < 0)
      fail("coordinates cannot be read (damaged file)");
    node_ids_ = numbers(MED_NODE, MED_NONE, n, MED_NUMBER);
    const std::vector<med_int> family = numbers(MED_NODE, MED_NONE, n, MED_FAMILY_NUMBER);
    if (node_ids_.empty())
      for (std::int64_t i = 1; i <= n; ++i) node_ids_.push_back(static_cast<med_int>(i));
    for (std::size_t i = 0; i < node_ids_.size(); ++i) {
      listing_.add_node(node_ids_[i], Vec3(coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]),
                        nullptr);
      if (!family.empty() && family[i] != 0) nodes_of_family_[family[i]].push_back(node_ids_[i]);
    }
  }

  void elements(const GeoType& type, bool hex) {
    const std::int64_t n = count(MED_CELL, type.type);
    if (n == 0) return;
    const auto width = static_cast<std::size_t>(type.n_nodes);
    std::vector<med_int> connectivity(width * static_cast<std::size_t>(n));
    if (MEDmeshElementConnectivityRd(file_.id(), mesh_.c_str(), MED_NO_DT, MED_NO_IT, MED_CELL, type.type, MED_NODAL,
                                     MED_FULL_INTERLACE, connectivity.data()) < 0)
      fail("elements cannot be read (damaged file)");
    // Numbers of elements are per kind; hexes of one kind keep theirs, all else is counted on.
    std::vector<med_int> ids = hex && next_ == 0 ? numbers(MED_CELL, type.type, n, MED_NUMBER) : std::vector<med_int>();
    const std::vector<med_int> family = numbers(MED_CELL, type.type, n, MED_FAMILY_NUMBER);
    if (ids.empty())
      for (std::int64_t i = 0; i < n; ++i) ids.push_back(static_cast<med_int>(next_ + i + 1));
    std::vector<std::int64_t> nodes(width);
    for (std::size_t e = 0; e < ids.size(); ++e) {
      for (std::size_t i = 0; i < width; ++i) {
        const med_int position = connectivity[width * e + i];
        if (position < 1 || position > std::ssize(node_ids_))
          fail("element " + std::to_string(ids[e]) + " names node " + std::to_string(position) + " of " +
               std::to_string(node_ids_.size()));
        nodes[hex && i < 8    ? med_corner[i]
              : !hex && i < 4 ? (4 - i) % 4
                              : i] = node_ids_[static_cast<std::size_t>(position - 1)];
      }
      if (hex)
        listing_.add_hex(ids[e], 0, nodes, med_middles, nullptr);
      else
        listing_.add_quad(ids[e], 0, nodes, nullptr);
      if (type.type == MED_QUAD4) listing_.keep_quad("QUAD4", "");
      if (!family.empty() && family[e] != 0) elements_of_family_[family[e]].push_back(ids[e]);
      if (hex) hex_ids_[type.type].push_back(ids[e]);
    }
    next_ = std::max<std::int64_t>(next_, *std::ranges::max_element(ids));
  }

  void others(const MedOther& type) {
    const std::int64_t n = count(MED_CELL, type.type);
    if (n == 0) return;
    std::vector<med_int> connectivity(type.n_nodes * static_cast<std::size_t>(n));
    if (MEDmeshElementConnectivityRd(file_.id(), mesh_.c_str(), MED_NO_DT, MED_NO_IT, MED_CELL, type.type, MED_NODAL,
                                     MED_FULL_INTERLACE, connectivity.data()) < 0)
      fail("elements cannot be read (damaged file)");
    const std::vector<med_int> family = numbers(MED_CELL, type.type, n, MED_FAMILY_NUMBER);
    std::vector<std::int64_t> nodes(type.n_nodes);
    for (std::size_t e = 0; e < static_cast<std::size_t>(n); ++e) {
      const std::int64_t id = ++next_;
      for (std::size_t i = 0; i < type.n_nodes; ++i) {
        const med_int position = connectivity[type.n_nodes * e + i];
        if (position < 1 || position > std::ssize(node_ids_))
          fail("element " + std::to_string(id) + " (" + type.name + ") names node " + std::to_string(position) +
               " of " + std::to_string(node_ids_.size()));
        nodes[type.order[i]] = node_ids_[static_cast<std::size_t>(position - 1)];
      }
      listing_.add_other({type.shape, static_cast<int>(type.n_nodes), type.name}, id, 0, nodes, "", false, nullptr);
      if (!family.empty() && family[e] != 0) elements_of_family_[family[e]].push_back(id);
    }
  }

  void groups() {
    // In the order of their names: families come in any.
    std::map<std::string, std::pair<std::vector<std::int64_t>, std::vector<std::int64_t>>> members;
    for (const auto& [family, names] : groups_of_family_)
      for (const std::string& name : names) {
        auto& [of_nodes, of_elements] = members[name];
        if (const auto found = nodes_of_family_.find(family); found != nodes_of_family_.end())
          of_nodes.insert(of_nodes.end(), found->second.begin(), found->second.end());
        if (const auto found = elements_of_family_.find(family); found != elements_of_family_.end())
          of_elements.insert(of_elements.end(), found->second.begin(), found->second.end());
      }
    int id = 0;
    for (auto& [name, both] : members) {
      Listing::Group& group = listing_.add_group(++id, name);
      group.nodes = std::move(both.first);
      group.elements = std::move(both.second);
    }
  }

  void fields(MeshFile& out) {
    const med_int n = MEDnField(file_.id());
    std::vector<std::string> named;
    for (int f = 1; f <= n; ++f) {
      const med_int n_components = MEDfieldnComponent(file_.id(), f);
      if (n_components < 1 || n_components > 1000) continue;
      std::array<char, MED_NAME_SIZE + 1> field{}, mesh{};
      std::string components(static_cast<std::size_t>(n_components) * MED_SNAME_SIZE + 1, '\0'), units = components;
      std::array<char, MED_SNAME_SIZE + 1> time{};
      med_bool local = MED_FALSE;
      med_field_type type = MED_FLOAT64;
      med_int n_steps = 0;
      if (MEDfieldInfo(file_.id(), f, field.data(), mesh.data(), &local, &type, components.data(), units.data(),
                       time.data(), &n_steps) < 0)
        fail("field " + std::to_string(f) + " cannot be read (damaged file)");
      if (mesh_ != mesh.data() || n_steps < 1) continue;
      const MedNumbers numbers = numbers_of(type);
      if (!numbers.read) {
        out.notices.push_back("field '" + std::string(field.data()) + "' is of numbers of an unknown kind: left out");
        continue;
      }
      if (says_something(components) || says_something(units)) named.push_back("'" + std::string(field.data()) + "'");
      if (n_steps > 1)
        out.notices.push_back("field '" + std::string(field.data()) + "' has " + std::to_string(n_steps) +
                              " steps: the last is read");
      med_int step = MED_NO_DT, iteration = MED_NO_IT;
      med_float at = 0;
      MEDfieldComputingStepInfo(file_.id(), field.data(), static_cast<int>(n_steps), &step, &iteration, &at);
      std::int64_t n_rounded = 0;
      const auto read = [&](med_entity_type entity, med_geometry_type geo, std::size_t n_items) {
        if (MEDfieldnValue(file_.id(), field.data(), step, iteration, entity, geo) != static_cast<med_int>(n_items))
          return std::vector<double>();
        return numbers.read(
            n_items * static_cast<std::size_t>(n_components),
            [&](unsigned char* values) {
              return MEDfieldValueRd(file_.id(), field.data(), step, iteration, entity, geo, MED_FULL_INTERLACE,
                                     MED_ALL_CONSTITUENT, values) >= 0;
            },
            n_rounded);
      };
      const auto width = static_cast<std::size_t>(n_components);
      const auto put = [&](Field::On on, std::span<const std::int64_t> ids, const std::vector<double>& values) {
        if (values.empty()) return false;
        const std::size_t n_items = on == Field::On::node ? out.mesh.points.size() : out.mesh.hexes.size();
        std::vector<Field>& fields = out.mesh.fields;
        if (fields.empty() || fields.back().name != field.data() || fields.back().on != on) {
          fields.push_back({field.data(), on, static_cast<int>(n_components), {}, numbers.integer});
          fields.back().values.assign(n_items * width, std::numeric_limits<double>::quiet_NaN());
        }
        Field& result = fields.back();  // of all kinds of hexes
        for (std::size_t i = 0; i < ids.size(); ++i) {
          const Index item = on == Field::On::node ? find_node(out.mesh, ids[i]) : find_hex(out.mesh, ids[i]);
          if (item < 0) continue;  // a middle node
          for (std::size_t c = 0; c < width; ++c) result.values[item * width + c] = values[i * width + c];
        }
        return true;
      };
      const std::vector<std::int64_t> node_ids(node_ids_.begin(), node_ids_.end());
      bool any = put(Field::On::node, node_ids, read(MED_NODE, MED_NONE, node_ids.size()));
      for (const auto& [geo, ids] : hex_ids_) any |= put(Field::On::hex, ids, read(MED_CELL, geo, ids.size()));
      say_rounded(field.data(), n_rounded, out.notices);
      std::int64_t n_lost = 0;
      const auto lose = [&](med_entity_type entity, med_geometry_type geo) {
        n_lost += std::max<std::int64_t>(0, MEDfieldnValue(file_.id(), field.data(), step, iteration, entity, geo));
      };
      for (const GeoType& geo : quads) lose(MED_CELL, geo.type);
      for (const GeoType& geo : dropped) lose(MED_CELL, geo.type);
      for (const MedOther& geo : med_others)
        if (geo.shape != OtherShape::quad) lose(MED_CELL, geo.type);
      for (const GeoType& geo : hexes) lose(MED_NODE_ELEMENT, geo.type);
      if (any && n_lost > 0)
        out.notices.push_back("field '" + std::string(field.data()) + "': " + counted(n_lost, "value") +
                              " left out, which " + (n_lost == 1 ? "is" : "are") + " not of a node or hex");
      if (!any)
        out.notices.push_back("field '" + std::string(field.data()) + "' has no value per node or hex: left out");
    }
    for (Field& field : out.mesh.fields)  // no whole number says that there is none
      field.integer = field.integer && std::ranges::none_of(field.values, [](double x) { return std::isnan(x); });
    if (!named.empty())
      out.notices.push_back("names and units of the components of " + counted(std::ssize(named), "field") +
                            " are left out: " + joined(named, ", "));
  }

  const std::string name_;
  const std::uintmax_t most_;
  const MedFile file_;
  const Cursor cursor_{"", name_};
  Listing listing_;
  std::string mesh_;
  std::vector<med_int> node_ids_;
  std::map<med_geometry_type, std::vector<std::int64_t>> hex_ids_;
  std::map<med_int, std::vector<std::string>> groups_of_family_;
  std::map<med_int, std::vector<std::int64_t>> nodes_of_family_, elements_of_family_;
  std::int64_t next_ = 0;
};

}  // namespace

MeshFile read_med_here(const std::filesystem::path& file, const std::filesystem::path&) {
  const Bytes bytes = read_bytes(file);
  if (!std::string_view(bytes.data.get(), bytes.size).starts_with("\x89HDF"))
    throw Error(file.string() + ": not a MED file: it is not HDF5");
  return MedReader(file).result();
}

MeshFile read_med(const std::filesystem::path& file, const Fence& fence) {
  return read_apart(fence, "med", read_med_here, file);
}

}  // namespace hextwist::io
