// MED through its library: blocks and side sets are groups of elements, node sets groups of nodes; who is in the same
// groups is a family.
#include <algorithm>
#include <cstdint>
#include <limits>

#include "hextwist/base/replacement.h"
#include "hextwist/base/sorted.h"
#include "hextwist/io/field_names.h"
#include "hextwist/io/group_names.h"
#include "hextwist/io/med/med_internal.h"
#include "hextwist/io/others.h"

namespace hextwist::io {
namespace {

constexpr const char* mesh_name = "mesh";

class MedWriter {
 public:
  MedWriter(const Replacement& file, const Mesh& mesh, const SecondOrder* second, std::vector<std::string>& notices)
      : replacement_(file), mesh_(mesh), second_(second), notices_(notices), file_(file.temporary(), MED_ACC_CREAT) {
    if (file_.id() < 0) fail();
  }

  void write() {
    check(MEDmeshCr(file_.id(), mesh_name, 3, 3, MED_UNSTRUCTURED_MESH,
                    med_text("hextwist", MED_COMMENT_SIZE + 1).c_str(), med_text("", MED_SNAME_SIZE + 1).c_str(),
                    MED_SORT_DTIT, MED_CARTESIAN, axes("x", "y", "z").c_str(), axes("", "", "").c_str()));
    check(MEDfamilyCr(file_.id(), mesh_name, "FAMILLE_ZERO", 0, 0, ""));
    name_groups();
    nodes();
    hexes();
    quads();
    others();
    fields();
    if (!file_.close()) fail();
  }

 private:
  [[noreturn]] void fail() const { replacement_.fail("cannot be written (disk full?)"); }
  void check(med_err status) const {
    if (status < 0) fail();
  }
  static std::string axes(const char* x, const char* y, const char* z) {
    std::string result;
    for (const char* name : {x, y, z}) {
      std::string text(name);
      text.resize(MED_SNAME_SIZE, ' ');
      result += text;
    }
    return result;
  }

  /// Names of groups have 80 characters, readers cut blanks around them. Who is in no family is not in the file.
  template <class Groups, class Has>
  std::vector<std::string> names(const char* kind, const Groups& groups, Has&& has_members) {
    std::vector<std::string> result;
    std::set<std::string> taken;
    for (const auto& group : groups) {
      if (!has_members(group)) {
        notices_.push_back("MED has no empty groups: " + std::string(kind) + " " + std::to_string(group.id) +
                           (group.name.empty() ? "" : " '" + group.name + "'") + " is left out");
        result.emplace_back();
        continue;
      }
      const std::string line = one_line(group.name);
      result.push_back(distinct_name(kind, group.id, group.name,
                                     std::string(trimmed(first_letters(trimmed(line), MED_LNAME_SIZE))), MED_LNAME_SIZE,
                                     taken, notices_));
    }
    return result;
  }

  void name_groups() {
    node_set_names_ = names("nodeset", mesh_.node_sets, [](const NodeSet& set) { return !set.nodes.empty(); });
    block_names_ = names("block", mesh_.blocks, [&](const Block& block) {
      return !block.hexes.empty() ||
             std::ranges::any_of(others_of_block(mesh_, block.id), [&](Index e) { return has_kind(e); });
    });
    side_set_names_ = names("sideset", mesh_.side_sets, [](const SideSet& set) { return !set.sides.empty(); });
    // Readers number groups in the order of their names, whatever they are of.
    std::vector<std::string> all;
    for (const auto* list : {&node_set_names_, &block_names_, &side_set_names_})
      std::ranges::copy_if(*list, std::back_inserter(all), [](const std::string& name) { return !name.empty(); });
    sort_unique(all);
    NewIds ids;
    const auto add = [&](const char* kind, const auto& groups, const std::vector<std::string>& own) {
      std::vector<std::string> sorted = own;
      std::erase(sorted, "");
      std::ranges::sort(sorted);
      std::vector<int> wishes;
      for (const std::string& name : sorted) wishes.push_back(static_cast<int>(position_in(all, name)) + 1);
      const std::vector<int> when_read = ids_by_name(kind, sorted, wishes);
      for (std::size_t g = 0; g < groups.size(); ++g)
        if (const Index at = position_in(sorted, own[g]); at >= 0)
          ids.add(kind, groups[g].id, groups[g].name, when_read[static_cast<std::size_t>(at)]);
    };
    add("block", mesh_.blocks, block_names_);
    add("nodeset", mesh_.node_sets, node_set_names_);
    add("sideset", mesh_.side_sets, side_set_names_);
    ids.tell("MED", notices_);
  }
  /// Has the file elements like this one?
  bool has_kind(Index e) const {
    return std::ranges::any_of(med_others, [&](const MedOther& type) {
      return is_of(*mesh_.others, e, type) && (type.type != MED_QUAD4 || !second_);
    });
  }

  /// Families for the classes of items; their numbers per item. sign: 1 of nodes, -1 of elements.
  std::vector<med_int> families(std::size_t n, const std::vector<std::span<const Index>>& members,
                                const std::vector<std::string>& group_names, int sign) {
    const Classes classes = classify(std::vector<int>(n, 0), members);
    std::vector<med_int> number(classes.groups.size(), 0);
    for (std::size_t c = 0; c < classes.groups.size(); ++c) {
      if (classes.groups[c].empty()) continue;
      number[c] = sign * ++n_families_;
      std::string text;
      for (const int group : classes.groups[c])
        text += med_text(group_names[static_cast<std::size_t>(group)], MED_LNAME_SIZE);
      check(MEDfamilyCr(file_.id(), mesh_name, ("FAM_" + std::to_string(number[c])).c_str(), number[c],
                        static_cast<med_int>(classes.groups[c].size()), (text + '\0').c_str()));
    }
    std::vector<med_int> result(n);
    for (std::size_t i = 0; i < n; ++i) result[i] = number[static_cast<std::size_t>(classes.of_item[i])];
    return result;
  }

  void entities(med_entity_type entity, med_geometry_type type, const std::vector<med_int>& family,
                const std::vector<std::int64_t>& ids) {
    const auto n = static_cast<med_int>(family.size());
    if (std::ranges::any_of(family, [](med_int f) { return f != 0; }))
      check(MEDmeshEntityFamilyNumberWr(file_.id(), mesh_name, MED_NO_DT, MED_NO_IT, entity, type, n, family.data()));
    if (ids.empty()) return;
    if (ids.back() > std::numeric_limits<med_int>::max()) {
      notices_.push_back("id " + std::to_string(ids.back()) +
                         " is too large for MED: ids are counted from 1 in the file");
      return;
    }
    const std::vector<med_int> numbers(ids.begin(), ids.end());
    check(MEDmeshEntityNumberWr(file_.id(), mesh_name, MED_NO_DT, MED_NO_IT, entity, type, n, numbers.data()));
  }

  void nodes() {
    const auto n = static_cast<med_int>(mesh_.points.size());
    check(MEDmeshNodeCoordinateWr(file_.id(), mesh_name, MED_NO_DT, MED_NO_IT, 0, MED_FULL_INTERLACE, n,
                                  coordinates(std::span(mesh_.points)).data()));
    std::vector<std::span<const Index>> members;
    for (const NodeSet& set : mesh_.node_sets) members.emplace_back(set.nodes);
    entities(MED_NODE, MED_NONE, families(mesh_.points.size(), members, node_set_names_, 1), mesh_.node_ids);
  }

  void elements(med_geometry_type type, std::size_t n, const std::vector<med_int>& connectivity) {
    check(MEDmeshElementConnectivityWr(file_.id(), mesh_name, MED_NO_DT, MED_NO_IT, 0, MED_CELL, type, MED_NODAL,
                                       MED_FULL_INTERLACE, static_cast<med_int>(n), connectivity.data()));
  }

  void hexes() {
    type_ = !second_ ? MED_HEXA8 : second_->nodes_per_hex == 20 ? MED_HEXA20 : MED_HEXA27;
    std::vector<med_int> connectivity;
    for (Index h = 0; h < mesh_.n_hexes(); ++h) {
      const FileHex hex = file_hex(mesh_, second_, h, med_middles);
      for (int i = 0; i < hex.n; ++i)
        connectivity.push_back(hex.nodes[i < 8 ? med_corner[i] : static_cast<std::size_t>(i)] + 1);
    }
    elements(type_, mesh_.hexes.size(), connectivity);
    std::vector<std::span<const Index>> members;
    for (const Block& block : mesh_.blocks) members.emplace_back(block.hexes);
    entities(MED_CELL, type_, families(mesh_.hexes.size(), members, block_names_, -1), mesh_.hex_ids);
  }

  void quads() {
    const PlannedSides plan = plan_sides(mesh_, {});
    const std::vector<Index> beside = other_quads();
    if (plan.sides.empty() && beside.empty()) return;
    const med_geometry_type type = !second_ ? MED_QUAD4 : second_->nodes_per_hex == 20 ? MED_QUAD8 : MED_QUAD9;
    std::vector<med_int> connectivity;
    for (const Side& side : plan.sides) {
      const Quad q = face_node_cycle(mesh_.hexes[side.hex], side.face);
      // Round the other way, as the hexes are.
      const Quad turned{q[0], q[3], q[2], q[1]};
      for (const Index node : turned) connectivity.push_back(node + 1);
      if (!second_) continue;
      for (std::size_t c = 0; c < 4; ++c)
        connectivity.push_back(second_->middle_between(turned[c], turned[(c + 1) % 4]) + 1);
      if (second_->nodes_per_hex == 27) connectivity.push_back(second_->middle_of(q) + 1);
    }
    for (const Index e : beside)
      for (const std::size_t i : {0, 3, 2, 1}) connectivity.push_back(mesh_.others->nodes_of(e)[i] + 1);
    elements(type, plan.sides.size() + beside.size(), connectivity);
    const std::vector<std::span<const Index>> members(plan.members.begin(), plan.members.end());
    std::vector<med_int> family = families(plan.sides.size(), members, side_set_names_, -1);
    if (!beside.empty()) {
      const std::vector<med_int> more = families_of_others(beside, 0);
      family.insert(family.end(), more.begin(), more.end());
    }
    entities(MED_CELL, type, family, {});
  }

  /// Beside the quads that are sides: of a kind MED has elements in one list.
  void others() {
    if (!mesh_.others) return;
    const OtherElements& all = *mesh_.others;
    std::vector<std::uint8_t> is_written(static_cast<std::size_t>(all.size()), 0);
    std::int64_t n_shortened = 0;
    for (const MedOther& type : med_others) {
      if (type.type == MED_QUAD4) continue;  // with the sides
      std::vector<med_int> connectivity;
      std::vector<Index> written;
      for (Index e = 0; e < all.size(); ++e) {
        if (!is_of(all, e, type)) continue;
        const auto nodes = all.nodes_of(e);
        n_shortened += nodes.size() > type.n_nodes;
        for (std::size_t i = 0; i < type.n_nodes; ++i) connectivity.push_back(nodes[type.order[i]] + 1);
        written.push_back(e);
        is_written[e] = 1;
      }
      if (written.empty()) continue;
      elements(type.type, written.size(), connectivity);
      entities(MED_CELL, type.type, families_of_others(written, 0), {});
    }
    for (const Index e : other_quads()) is_written[e] = 1;
    if (const auto n = std::ranges::count(is_written, 0))
      notices_.push_back("left out " + counted(n, "other element") + ", which MED has nothing like here");
    if (n_shortened > 0)
      notices_.push_back(counted(n_shortened, "other element") +
                         " written without nodes that say how they are turned, which MED has no place for");
  }
  static bool is_of(const OtherElements& all, Index e, const MedOther& type) {
    const OtherType& of = all.type_of(e);
    return of.shape == type.shape && of.n_nodes == static_cast<int>(type.n_nodes);
  }
  std::vector<Index> other_quads() const {
    std::vector<Index> quads;
    for (Index e = 0; e < n_others(mesh_); ++e)
      if (mesh_.others->type_of(e).shape == OtherShape::quad && mesh_.others->type_of(e).n_nodes == 4 && !second_)
        quads.push_back(e);
    return quads;
  }
  /// Families of elements behind `before` others that are in no block.
  std::vector<med_int> families_of_others(const std::vector<Index>& written, std::size_t before) {
    std::vector<std::vector<Index>> lists;
    for (const Block& block : mesh_.blocks) {
      std::vector<Index>& list = lists.emplace_back();
      for (const Index e : others_of_block(mesh_, block.id))
        if (const Index at = position_in(written, e); at >= 0) list.push_back(static_cast<Index>(before) + at);
    }
    const std::vector<std::span<const Index>> members(lists.begin(), lists.end());
    return families(before + written.size(), members, block_names_, -1);
  }

  void fields() {
    say_values_of_others(mesh_, "MED", notices_);
    std::set<std::string> taken;
    for (const Field& field : mesh_.fields) {
      const std::string name = distinct_field_name(
          field.name, link_name(field.name), MED_NAME_SIZE - 4,
          [&](const std::string& wanted) { return taken.insert(wanted).second; }, notices_);
      std::string components, units;
      for (int c = 1; c <= field.components; ++c) {
        std::string text = std::to_string(c);
        text.resize(MED_SNAME_SIZE, ' ');
        components += text;
        units += std::string(MED_SNAME_SIZE, ' ');
      }
      const auto put = [&](med_field_type type, const auto& values) {
        check(MEDfieldCr(file_.id(), name.c_str(), type, field.components, components.c_str(), units.c_str(),
                         med_text("", MED_SNAME_SIZE + 1).c_str(), mesh_name));
        const bool node = field.on == Field::On::node;
        check(MEDfieldValueWr(file_.id(), name.c_str(), MED_NO_DT, MED_NO_IT, 0, node ? MED_NODE : MED_CELL,
                              node ? med_geometry_type{MED_NONE} : type_, MED_FULL_INTERLACE, MED_ALL_CONSTITUENT,
                              static_cast<med_int>(node ? mesh_.points.size() : mesh_.hexes.size()),
                              reinterpret_cast<const unsigned char*>(values.data())));
      };
      if (!is_whole(field))
        put(MED_FLOAT64, field.values);
      else if (std::ranges::all_of(field.values, fits_in_32_bits))
        put(MED_INT32, std::vector<std::int32_t>(field.values.begin(), field.values.end()));
      else
        put(MED_INT64, std::vector<std::int64_t>(field.values.begin(), field.values.end()));
    }
  }

  static bool fits_in_32_bits(double value) {
    return value == std::clamp<double>(value, std::numeric_limits<std::int32_t>::min(),
                                       std::numeric_limits<std::int32_t>::max());
  }

  const Replacement& replacement_;
  const Mesh& mesh_;
  const SecondOrder* second_;
  std::vector<std::string>& notices_;
  MedFile file_;
  med_geometry_type type_ = MED_HEXA8;
  med_int n_families_ = 0;
  std::vector<std::string> node_set_names_, block_names_, side_set_names_;  // empty: not in the file
};

}  // namespace

void write_med(const std::filesystem::path& file, const Mesh& mesh, const WriteOptions& options,
               std::vector<std::string>& notices) {
  Replacement replacement(file, options.overwrite);
  if (replacement.direct()) replacement.fail("is not an ordinary file, as MED needs");
  MedWriter(replacement, mesh, options.second, notices).write();
  replacement.commit();
}

}  // namespace hextwist::io
