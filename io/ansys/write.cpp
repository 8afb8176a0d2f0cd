// ANSYS archives, .cdb: NBLOCK, EBLOCK of SOLID185 or SOLID186 by materials, the sides of side sets as SURF154, all
// sets as components. Comments keep ids and names.
#include <cstdio>

#include "hextwist/base/sorted.h"
#include "hextwist/io/ansys/ansys_internal.h"
#include "hextwist/io/group_names.h"
#include "hextwist/io/hex_numbers.h"

namespace hextwist::io {
namespace {

constexpr std::int64_t highest_ansys_id = 99'999'999;  // nine characters and a blank
constexpr std::size_t longest_component_name = 32;

class AnsysWriter {
 public:
  AnsysWriter(Output& out, const Mesh& mesh, const WriteOptions& options, std::vector<std::string>& notices)
      : out_(out), mesh_(mesh), second_(options.second), notices_(notices) {}

  void write() {
    for (std::size_t i = 0; i < columns_.size(); ++i)
      columns_[i] = hex_numbers(mesh_, ansys_columns[i], highest_ansys_id);
    say_no_other_fields(mesh_, columns_, "ANSYS' archive", notices_);
    constexpr const char* limit = "has more than eight digits";
    node_ids_ = ids_in_file(mesh_.node_ids, "node", "nodes", highest_ansys_id, limit, notices_);
    hex_ids_ = ids_in_file(mesh_.hex_ids, "hex", "hexes", highest_ansys_id, limit, notices_);
    for (const SideSet& set : mesh_.side_sets) sides_.insert(sides_.end(), set.sides.begin(), set.sides.end());
    sort_unique(sides_);
    last_hex_ = mesh_.hexes.empty() ? 0 : id_of(hex_ids_, mesh_.n_hexes() - 1);
    if (mesh_.n_nodes() > highest_ansys_id || last_hex_ + std::ssize(sides_) > highest_ansys_id)
      throw Error("more nodes or elements than eight digits can count");
    out_ << "/COM,hextwist mesh\n/PREP7\nET,1," << (second_ ? ansys_solid_20 : ansys_solid_8) << '\n';
    // Without middle nodes where the hexes have none.
    if (!sides_.empty()) out_ << "ET,2," << ansys_surface << '\n' << (second_ ? "" : "KEYOP,2,4,1\n");
    nodes();
    elements();
    components();
    out_ << "FINISH\n";
  }

 private:
  void nodes() {
    const std::int64_t last = mesh_.points.empty() ? 0 : id_of(node_ids_, mesh_.n_nodes() - 1);
    out_ << "NBLOCK,6,SOLID," << Right{last, 10} << ',' << Right{mesh_.n_nodes(), 10} << "\n(3i9,6e21.13e3)\n";
    for (Index n = 0; n < mesh_.n_nodes(); ++n) {
      out_ << Right{id_of(node_ids_, n), 9} << Right{0, 9} << Right{0, 9};
      for (const double x : mesh_.points[n]) real(x);
      out_ << '\n';
    }
    out_ << "N,R5.3,LOC,       -1,\n";
  }

  /// 21 characters, an exponent of three digits: E21.13E3.
  void real(double value) {
    std::array<char, 40> text{};
    const int n = std::snprintf(text.data(), text.size(), "%.13E", value);
    std::string number(text.data(), static_cast<std::size_t>(n));
    const auto exponent = number.find('E') + 2;
    number.insert(exponent, 3 - std::min<std::size_t>(3, number.size() - exponent), '0');
    out_ << std::string(21 - std::min<std::size_t>(21, number.size()), ' ') << number;
  }

  /// columns: material, real constants, section, coordinate system.
  void element(const std::array<std::int64_t, 4>& columns, int type, std::int64_t id,
               std::span<const std::int64_t> nodes) {
    const std::array<std::int64_t, 11> head = {columns[0], type, columns[1],        columns[2], columns[3], 0,
                                               0,          0,    std::ssize(nodes), 0,          id};
    for (const std::int64_t number : head) out_ << Right{number, 9};
    for (std::size_t i = 0; i < nodes.size(); ++i) out_ << (i == 8 ? "\n" : "") << Right{nodes[i], 9};
    out_ << '\n';
  }

  void elements() {
    const AnsysMaterials materials = ansys_materials(mesh_);
    for (const Block& block : mesh_.blocks)
      if (block.id > highest_ansys_id)
        throw Error("block id " + std::to_string(block.id) + " has more than eight digits");
    if (materials.nobody > highest_ansys_id)
      throw Error("all materials are taken, none is left for hexes outside of blocks");
    if (materials.nobody > 0 && !mesh_.blocks.empty() && !columns_[0])
      notices_.push_back("hexes in no block, or in block 0, are of material " + std::to_string(materials.nobody));
    out_ << "EBLOCK,19,SOLID," << Right{last_hex_ + std::ssize(sides_), 10} << ','
         << Right{mesh_.n_hexes() + std::ssize(sides_), 10} << "\n(19i9)\n";
    std::array<std::int64_t, 20> nodes{};
    for (Index h = 0; h < mesh_.n_hexes(); ++h) {
      const FileHex hex = file_hex(mesh_, second_, h, ansys_middles);
      for (std::size_t i = 0; i < static_cast<std::size_t>(hex.n); ++i) nodes[i] = id_of(node_ids_, hex.nodes[i]);
      std::array<std::int64_t, 4> columns = {materials.of_hex[h], 1, 1, 0};
      for (std::size_t i = 0; i < columns.size(); ++i)
        if (columns_[i]) columns[i] = static_cast<std::int64_t>(columns_[i]->values[h]);
      element(columns, 1, id_of(hex_ids_, h), std::span(nodes).first(static_cast<std::size_t>(hex.n)));
    }
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      const Quad q = face_node_cycle(mesh_.hexes[sides_[i].hex], sides_[i].face);
      for (std::size_t c = 0; c < 4; ++c) {
        nodes[c] = id_of(node_ids_, q[c]);
        if (second_) nodes[4 + c] = id_of(node_ids_, second_->middle_between(q[c], q[(c + 1) % 4]));
      }
      element({1, 1, 1, 0}, 2, last_hex_ + 1 + static_cast<std::int64_t>(i), std::span(nodes).first(second_ ? 8 : 4));
    }
    out_ << "       -1\n";
  }

  /// Upper case, beginning with a letter, unlike all others.
  std::string component_name(const char* kind, int id, const std::string& name) {
    std::string result = name.empty() ? std::string(kind) + "_" + std::to_string(id) : name;
    for (char& c : result)
      c = std::isalnum(static_cast<unsigned char>(c)) ? static_cast<char>(std::toupper(static_cast<unsigned char>(c)))
                                                      : '_';
    if (!std::isalpha(static_cast<unsigned char>(result[0]))) result.insert(0, "C");
    if (result.size() > longest_component_name) result.resize(longest_component_name);
    return distinct_name(kind, id, name, result, longest_component_name, names_, notices_);
  }

  /// ids: ascending. Runs of three and more are their first and, negative, their last.
  void component(const char* kind, int id, const std::string& name, const char* of,
                 const std::vector<std::int64_t>& ids) {
    const std::string known = component_name(kind, id, name);
    if (ids.empty()) {
      notices_.push_back(std::string(kind) + " " + std::to_string(id) +
                         " is empty and left out: components have members");
      return;
    }
    std::vector<std::int64_t> members;
    for (std::size_t i = 0; i < ids.size();) {
      std::size_t last = i;
      while (last + 1 < ids.size() && ids[last + 1] == ids[last] + 1) ++last;
      members.push_back(ids[i]);
      if (last > i + 1)
        members.push_back(-ids[last]);
      else if (last > i)
        members.push_back(ids[last]);
      i = last + 1;
    }
    const std::string line = one_line(name), own(trimmed(line));
    say_renamed(std::string(kind) + " " + std::to_string(id), name, own, notices_);
    out_ << "! hextwist " << kind << ' ' << id << ' ' << own << "\nCMBLOCK," << known << ',' << of << ','
         << Right{std::ssize(members), 8} << "\n(8i10)\n";
    for (std::size_t i = 0; i < members.size(); ++i)
      out_ << Right{members[i], 10} << (i % 8 == 7 || i + 1 == members.size() ? "\n" : "");
  }

  void components() {
    std::vector<std::int64_t> ids;
    const auto all = [&](const char* kind, const auto& set, const char* of, const auto& items, auto&& id_of_item) {
      ids.clear();
      for (const auto& item : items) ids.push_back(id_of_item(item));
      component(kind, set.id, set.name, of, ids);
    };
    for (const Block& block : mesh_.blocks)
      all("block", block, "ELEM", block.hexes, [&](Index h) { return id_of(hex_ids_, h); });
    for (const SideSet& set : mesh_.side_sets)
      all("sideset", set, "ELEM", set.sides,
          [&](const Side& side) { return last_hex_ + 1 + position_in(sides_, side); });
    for (const NodeSet& set : mesh_.node_sets)
      all("nodeset", set, "NODE", set.nodes, [&](Index n) { return id_of(node_ids_, n); });
  }

  Output& out_;
  const Mesh& mesh_;
  const SecondOrder* const second_;
  std::vector<std::string>& notices_;
  std::span<const std::int64_t> node_ids_, hex_ids_;
  std::vector<Side> sides_;  // of all side sets, each once
  std::int64_t last_hex_ = 0;
  std::set<std::string> names_ = {"ALL", "STAT", "DEFA"};  // those that CM does not permit are taken
  std::array<const Field*, 4> columns_{};                  // as ansys_columns; null: as usual
};

}  // namespace

AnsysMaterials ansys_materials(const Mesh& mesh) {
  std::vector<std::string> overlap;  // not told: components have all of a block
  AnsysMaterials result{first_block_of_hexes(mesh, "", overlap), 0};
  for (int& block : result.of_hex) block = block < 0 ? 0 : mesh.blocks[static_cast<std::size_t>(block)].id;
  if (std::ranges::find(result.of_hex, 0) == result.of_hex.end()) return result;
  result.nobody = std::max(1, free_id(mesh.blocks));
  std::ranges::replace(result.of_hex, 0, result.nobody);
  return result;
}

void write_ansys(Output& out, const Mesh& mesh, const Association&, const WriteOptions& options,
                 std::vector<std::string>& notices) {
  AnsysWriter(out, mesh, options, notices).write();
}

}  // namespace hextwist::io
