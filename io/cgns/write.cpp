// CGNS through its library, one zone: blocks are sections of hexes, side sets boundary conditions on sections of quads,
// node sets boundary conditions on nodes, fields solutions.
#include <set>

#include "hextwist/base/replacement.h"
#include "hextwist/io/cgns/cgns_internal.h"
#include "hextwist/io/field_names.h"
#include "hextwist/io/group_names.h"

namespace hextwist::io {
namespace {

constexpr const char* zone_name = "mesh";
constexpr int base = 1, zone = 1;

class CgnsWriter {
 public:
  CgnsWriter(const Replacement& file, const Mesh& mesh, const WriteOptions& options, std::vector<std::string>& notices)
      : replacement_(file),
        mesh_(mesh),
        second_(options.second),
        extras_(options.extras),
        notices_(notices),
        file_(file.temporary(), CG_MODE_WRITE) {
    if (file_.id() < 0) fail();
  }

  void write() {
    const std::size_t n_elements = mesh_.hexes.size() + 2 * 6 * mesh_.hexes.size();
    if (mesh_.points.size() > std::numeric_limits<cgsize_t>::max() / 3 ||
        27 * n_elements > static_cast<std::size_t>(std::numeric_limits<cgsize_t>::max()))
      replacement_.fail("has more nodes or elements than this library of CGNS can number");
    int number = 0;
    check(cg_base_write(file_.id(), "hextwist", 3, 3, &number));
    const std::array<cgsize_t, 3> size = {static_cast<cgsize_t>(mesh_.points.size()),
                                          static_cast<cgsize_t>(mesh_.hexes.size()), 0};
    check(cg_zone_write(file_.id(), base, zone_name, size.data(), CGNS_ENUMV(Unstructured), &number));
    coordinates();
    hexes();
    sides();
    node_sets();
    ids();
    fields(Field::On::node, "NodeFields");
    fields(Field::On::hex, "HexFields");
    if (!file_.close()) fail();
  }

 private:
  [[noreturn]] void fail() const { replacement_.fail("cannot be written (disk full?)"); }
  void check(int status) const {
    if (status != CG_OK) replacement_.fail("cannot be written: " + cgns_error());
  }

  /// A name that a node of the file can have, beside those that there are.
  static std::string name_for(const std::string& wanted, std::set<std::string>& taken) {
    std::string name = fitted(wanted, cgns_name_length);
    const std::string stem = name;
    for (int k = 2; !taken.insert(name).second; ++k) {
      const std::string tail = "_" + std::to_string(k);
      name = std::string(first_letters(stem, cgns_name_length - tail.size())) + tail;
    }
    return name;
  }
  static std::string fitted(const std::string& wanted, std::size_t longest) {
    std::string name = one_line(wanted);
    std::ranges::replace(name, '/', '_');
    if (name.empty() || name == "." || name == ".." || name.front() == ' ') name.insert(0, "_");
    name = std::string(first_letters(name, longest));
    while (name.back() == ' ') name.back() = '_';
    return name;
  }
  template <class Group>
  std::string name_of(const char* kind, const Group& group, std::set<std::string>& taken) {
    const std::string name =
        name_for(group.name.empty() ? std::string(kind) + "_" + std::to_string(group.id) : group.name, taken);
    // Our own reader has the name from the label.
    if (!group.name.empty())
      say_renamed(std::string(kind) + " " + std::to_string(group.id), group.name, name, notices_);
    return name;
  }
  template <class Group>
  static std::string label_of(const char* kind, const Group& group) {
    return std::string(kind) + " " + std::to_string(group.id) + " " + group.name;
  }
  void label(const std::string& text) const { check(cg_descriptor_write(cgns_label, text.c_str())); }

  void coordinates() {
    std::vector<double> values(mesh_.points.size());
    for (int axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = mesh_.points[i][axis];
      int number = 0;
      check(cg_coord_write(file_.id(), base, zone, CGNS_ENUMV(RealDouble),
                           (std::string("Coordinate") + "XYZ"[axis]).c_str(), values.data(), &number));
    }
  }

  void section(const std::string& name, const std::string& text, CGNS_ENUMT(ElementType_t) type, std::size_t n,
               const std::vector<cgsize_t>& connectivity) {
    int number = 0;
    check(cg_section_write(file_.id(), base, zone, name.c_str(), type, static_cast<cgsize_t>(n_elements_ + 1),
                           static_cast<cgsize_t>(n_elements_ + n), 0, connectivity.data(), &number));
    n_elements_ += n;
    if (text.empty()) return;
    check(cg_goto(file_.id(), base, "Zone_t", zone, "Elements_t", number, "end"));
    label(text);
  }

  /// A section for each block, of the hexes that are in no block before it. Blocks that are not their section are
  /// regions as well.
  void hexes() {
    const auto type = !second_                       ? CGNS_ENUMV(HEXA_8)
                      : second_->nodes_per_hex == 20 ? CGNS_ENUMV(HEXA_20)
                                                     : CGNS_ENUMV(HEXA_27);
    std::vector<std::vector<Index>> parts(mesh_.blocks.size() + 1);
    std::vector<std::size_t> part(mesh_.hexes.size(), mesh_.blocks.size());
    for (std::size_t b = mesh_.blocks.size(); b-- > 0;)
      for (const Index h : mesh_.blocks[b].hexes) part[static_cast<std::size_t>(h)] = b;
    for (Index h = 0; h < mesh_.n_hexes(); ++h) parts[part[static_cast<std::size_t>(h)]].push_back(h);
    element_of_hex_.resize(mesh_.hexes.size());
    std::vector<std::string> names;
    for (const Block& block : mesh_.blocks) names.push_back(name_of("block", block, taken_));
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (parts[p].empty()) continue;
      std::vector<cgsize_t> connectivity;
      for (std::size_t i = 0; i < parts[p].size(); ++i) {
        const FileHex hex = file_hex(mesh_, second_, parts[p][i], cgns_middles);
        for (const Index n : hex.all()) connectivity.push_back(n + 1);
        element_of_hex_[static_cast<std::size_t>(parts[p][i])] = static_cast<cgsize_t>(n_elements_ + i + 1);
        order_.push_back(parts[p][i]);
      }
      const bool block = p < mesh_.blocks.size() && parts[p].size() == mesh_.blocks[p].hexes.size();
      if (block)
        section(names[p], label_of("block", mesh_.blocks[p]), type, parts[p].size(), connectivity);
      else
        section(name_for(p < mesh_.blocks.size() ? names[p] + " part" : "hexes", taken_), "part", type, parts[p].size(),
                connectivity);
    }
    for (std::size_t p = 0; p < mesh_.blocks.size(); ++p) {
      const Block& block = mesh_.blocks[p];
      if (!block.hexes.empty() && parts[p].size() == block.hexes.size()) continue;
      std::vector<cgsize_t> members;
      for (const Index h : block.hexes) members.push_back(element_of_hex_[static_cast<std::size_t>(h)]);
      if (members.empty()) {
        notices_.push_back("CGNS has no empty groups: block " + std::to_string(block.id) + " is left out");
        continue;
      }
      std::ranges::sort(members);
      int number = 0;
      check(cg_subreg_ptset_write(file_.id(), base, zone, names[p].c_str(), 3, CGNS_ENUMV(CellCenter),
                                  CGNS_ENUMV(PointList), static_cast<cgsize_t>(members.size()), members.data(),
                                  &number));
      check(cg_goto(file_.id(), base, "Zone_t", zone, "ZoneSubRegion_t", number, "end"));
      label(label_of("block", block));
    }
  }

  void condition(const std::string& name, const std::string& text, CGNS_ENUMT(GridLocation_t) location,
                 const std::vector<cgsize_t>& members, CGNS_ENUMT(BCType_t) type) {
    const bool range =
        location != CGNS_ENUMV(Vertex) && members.back() - members.front() + 1 == static_cast<cgsize_t>(members.size());
    const std::array<cgsize_t, 2> ends = {members.front(), members.back()};
    int number = 0;
    check(cg_boco_write(
        file_.id(), base, zone, name.c_str(), type, range ? CGNS_ENUMV(PointRange) : CGNS_ENUMV(PointList),
        static_cast<cgsize_t>(range ? 2 : members.size()), range ? ends.data() : members.data(), &number));
    check(cg_boco_gridlocation_write(file_.id(), base, zone, number, location));
    check(cg_goto(file_.id(), base, "Zone_t", zone, "ZoneBC_t", 1, "BC_t", number, "end"));
    label(text);
  }

  /// Quads of side sets, each once: a section for those whose first set it is.
  void sides() {
    const PlannedSides plan = plan_sides(mesh_, {});
    const auto type = !second_                       ? CGNS_ENUMV(QUAD_4)
                      : second_->nodes_per_hex == 20 ? CGNS_ENUMV(QUAD_8)
                                                     : CGNS_ENUMV(QUAD_9);
    std::vector<cgsize_t> element(plan.sides.size(), 0);
    for (std::size_t s = 0; s < mesh_.side_sets.size(); ++s) {
      const SideSet& set = mesh_.side_sets[s];
      const std::string name = name_of("sideset", set, conditions_);
      std::vector<cgsize_t> connectivity, members;
      std::size_t n = 0;
      for (const Index i : plan.members[s]) {
        cgsize_t& number = element[static_cast<std::size_t>(i)];
        if (number == 0) {
          number = static_cast<cgsize_t>(n_elements_ + ++n);
          const Side side = plan.sides[static_cast<std::size_t>(i)];
          const Quad q = face_node_cycle(mesh_.hexes[side.hex], side.face);
          for (const Index node : q) connectivity.push_back(node + 1);
          for (std::size_t c = 0; c < 4 && second_; ++c)
            connectivity.push_back(second_->middle_between(q[c], q[(c + 1) % 4]) + 1);
          if (second_ && second_->nodes_per_hex == 27) connectivity.push_back(second_->middle_of(q) + 1);
        }
        members.push_back(number);
      }
      if (members.empty()) {
        notices_.push_back("CGNS has no empty groups: sideset " + std::to_string(set.id) + " is left out");
        continue;
      }
      if (n > 0) section(name_for(name, taken_), "part", type, n, connectivity);
      std::ranges::sort(members);
      condition(name, label_of("sideset", set), CGNS_ENUMV(FaceCenter), members, type_of(set));
    }
  }
  CGNS_ENUMT(BCType_t) type_of(const SideSet& set) const {
    if (extras_)
      if (const auto found = extras_->boundary_types.find(set.id); found != extras_->boundary_types.end())
        for (int t = 0; t < NofValidBCTypes; ++t)
          if (found->second == cg_BCTypeName(static_cast<CGNS_ENUMT(BCType_t)>(t)))
            return static_cast<CGNS_ENUMT(BCType_t)>(t);
    return CGNS_ENUMV(BCTypeUserDefined);
  }

  void node_sets() {
    for (const NodeSet& set : mesh_.node_sets) {
      const std::string name = name_of("nodeset", set, conditions_);
      if (set.nodes.empty()) {
        notices_.push_back("CGNS has no empty groups: nodeset " + std::to_string(set.id) + " is left out");
        continue;
      }
      std::vector<cgsize_t> members;
      for (const Index n : set.nodes) members.push_back(n + 1);
      condition(name, label_of("nodeset", set), CGNS_ENUMV(Vertex), members, CGNS_ENUMV(BCTypeUserDefined));
    }
  }

  /// Where they are not 1, 2, ... in the order of the file.
  void ids() {
    const bool sorted = std::ranges::is_sorted(order_);
    if (mesh_.node_ids.empty() && mesh_.hex_ids.empty() && sorted) return;
    check(cg_goto(file_.id(), base, "Zone_t", zone, "end"));
    check(cg_user_data_write(cgns_label));
    check(cg_goto(file_.id(), base, "Zone_t", zone, cgns_label, 0, "end"));
    const auto write = [&](const char* name, const std::vector<long>& values) {
      const auto n = static_cast<cgsize_t>(values.size());
      check(cg_array_write(name, CGNS_ENUMV(LongInteger), 1, &n, values.data()));
    };
    if (!mesh_.node_ids.empty()) write("NodeId", {mesh_.node_ids.begin(), mesh_.node_ids.end()});
    std::vector<long> of_hexes;
    for (const Index h : order_) of_hexes.push_back(id_of(mesh_.hex_ids, h));
    if (!mesh_.hex_ids.empty() || !sorted) write("HexId", of_hexes);
  }

  /// What component c of n is called: aX aY aZ are a vector in all of the SIDS.
  static std::string scalar_name(const std::string& name, int c, int n) {
    return n == 1 ? name : n == 3 ? name + "XYZ"[c] : component_name(name, c, n);
  }
  /// The name of a field so that all its components have one that no other has.
  std::string field_name(const Field& field, std::set<std::string>& taken) {
    const int n = field.components;
    const std::size_t longest = cgns_name_length - scalar_name("", n - 1, n).size();
    return distinct_field_name(
        field.name, fitted(field.name, longest), longest,
        [&](const std::string& name) {
          for (int c = 0; c < n; ++c)
            if (taken.contains(scalar_name(name, c, n))) return false;
          for (int c = 0; c < n; ++c) taken.insert(scalar_name(name, c, n));
          return true;
        },
        notices_);
  }

  void fields(Field::On on, const char* solution) {
    const auto keep_none = [](int) { return false; };
    std::set<std::string> taken;
    std::vector<Field> scalars;
    for (const Field& field : mesh_.fields) {
      if (field.on != on) continue;
      Field named = field;
      named.name = field_name(field, taken);
      std::vector<Field> parts = split_components({named}, keep_none, notices_);
      for (int c = 0; c < field.components; ++c) {
        Field& scalar = parts[static_cast<std::size_t>(c)];
        scalar.integer = field.integer;
        scalar.name = scalar_name(named.name, c, field.components);
        scalars.push_back(std::move(scalar));
      }
    }
    if (scalars.empty()) return;
    int number = 0, one = 0;
    check(cg_sol_write(file_.id(), base, zone, name_for(solution, taken_).c_str(),
                       on == Field::On::node ? CGNS_ENUMV(Vertex) : CGNS_ENUMV(CellCenter), &number));
    for (const Field& field : scalars) {
      const std::string& name = field.name;
      std::vector<double> values = field.values;
      if (on == Field::On::hex) values = items_at(values, order_);
      if (is_whole(field)) {
        const std::vector<long> numbers(values.begin(), values.end());
        check(cg_field_write(file_.id(), base, zone, number, CGNS_ENUMV(LongInteger), name.c_str(), numbers.data(),
                             &one));
      } else {
        check(
            cg_field_write(file_.id(), base, zone, number, CGNS_ENUMV(RealDouble), name.c_str(), values.data(), &one));
      }
    }
  }

  const Replacement& replacement_;
  const Mesh& mesh_;
  const SecondOrder* second_;
  const FileExtras* extras_;
  std::vector<std::string>& notices_;
  CgnsFile file_;
  std::size_t n_elements_ = 0;
  std::vector<cgsize_t> element_of_hex_;
  std::vector<Index> order_;  // of the hexes in the file
  std::set<std::string> taken_ = {"GridCoordinates", "ZoneBC", "ZoneType", cgns_label}, conditions_;
};

}  // namespace

void write_cgns(const std::filesystem::path& file, const Mesh& mesh, const WriteOptions& options,
                std::vector<std::string>& notices) {
  Replacement replacement(file, options.overwrite);
  if (replacement.direct()) replacement.fail("is not an ordinary file, as CGNS needs");
  CgnsWriter(replacement, mesh, options, notices).write();
  replacement.commit();
}

}  // namespace hextwist::io
