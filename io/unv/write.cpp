// I-deas universal files, .unv: nodes (2411), hexes and the quads of side sets (2412), and all sets as groups (2467).
#include <cstdlib>
#include <map>
#include <set>

#include "hextwist/io/group_names.h"
#include "hextwist/io/hex_numbers.h"
#include "hextwist/io/listing.h"
#include "hextwist/io/others.h"
#include "hextwist/io/unv/unv_internal.h"

namespace hextwist::io {
namespace {

/// Right-aligned in a field.
std::string field(std::int64_t number, std::size_t width = 10) {
  const std::string text = std::to_string(number);
  return text.size() < width ? std::string(width - text.size(), ' ') + text : text;
}

/// 25 characters, 17 digits: 1P3D25.16.
std::string real(double value) {
  std::array<char, 40> text{};
  const int n = std::snprintf(text.data(), text.size(), "%25.16E", value);
  std::string result(text.data(), static_cast<std::size_t>(n));
  for (char& c : result)
    if (c == 'E') c = 'D';
  return result;
}

class Groups {
 public:
  Groups(Output& out, std::vector<std::string>& notices) : out_(out), notices_(notices) {}

  /// type: 7 nodes, 8 elements.
  template <class Id>
  void write(const char* kind, int id, const std::string& name, int type, std::size_t n, Id&& member) {
    // Groups of all kinds are numbered together.
    int number = id;
    if (number == 0 || !taken_.insert(number).second) {
      number = taken_.empty() ? 1 : std::max(1, *taken_.rbegin() + 1);
      taken_.insert(number);
      changed_.push_back(std::string(kind) + " " + std::to_string(id) + " is " + std::to_string(number));
    }
    out_ << field(number);
    for (int i = 0; i < 6; ++i) out_ << field(0);
    out_ << field(static_cast<std::int64_t>(n)) << '\n';
    const std::string line = one_line(name);
    std::set<std::string> alike;  // are told apart by their numbers
    out_ << distinct_name(kind, id, name, std::string(trimmed(trimmed(line).substr(0, 40))), 40, alike, notices_)
         << '\n';
    if (n == 0 && !name.empty())
      notices_.push_back(".unv does not say what an empty group is of: " + std::string(kind) + " " +
                         std::to_string(id) + " '" + name + "' will not be read");
    for (std::size_t i = 0; i < n; ++i)
      out_ << field(type) << field(member(i)) << field(0) << field(0) << (i % 2 == 1 || i + 1 == n ? "\n" : "");
  }
  void tell() {
    if (!changed_.empty())
      notices_.push_back("groups of all kinds are numbered together in .unv: " + joined(changed_, ", "));
  }

 private:
  Output& out_;
  std::vector<std::string>& notices_;
  std::set<int> taken_;
  std::vector<std::string> changed_;
};

/// Elements beside the hexes; per element whether it is in the file.
std::vector<std::uint8_t> write_unv_others(Output& out, const Mesh& mesh, std::span<const std::int64_t> node_ids,
                                           const std::vector<std::int64_t>& ids, std::vector<std::string>& notices) {
  std::vector<std::uint8_t> is_written(static_cast<std::size_t>(n_others(mesh)), 0);
  if (!mesh.others) return is_written;
  const OtherElements& others = *mesh.others;
  const bool own = others.heads->format == "unv";
  std::map<std::string, std::int64_t> n_lost;
  for (Index e = 0; e < others.size(); ++e) {
    const OtherType& type = others.type_of(e);
    const UnvOther* as = nullptr;
    int kind = own ? std::atoi(type.name.c_str()) : 0;
    for (const UnvOther& other : unv_others) {
      const bool fits = own ? other.kind == kind
                            : other.shape == type.shape && other.shape != OtherShape::connector &&
                                  static_cast<int>(other.n_nodes) == type.n_nodes && other.kind != 11 &&
                                  (other.shape != OtherShape::triangle || other.kind > 90);
      if (fits && !as) as = &other;
    }
    const bool quad = type.shape == OtherShape::quad && type.n_nodes == 4;
    if (!as && !quad) {
      ++n_lost[type.name];
      continue;
    }
    if (!own) kind = as ? as->kind : unv_quad;
    const auto all = others.nodes_of(e);
    const std::size_t n = type.n_nodes > 0 ? static_cast<std::size_t>(type.n_nodes) : all.size();
    std::string numbers = "1 1 7", beam = "0 0 0";
    if (!own && all.size() > n) beam = std::to_string(id_of(node_ids, all[n])) + " 0 0";  // how it is turned
    if (own && !others.heads->rest.empty()) {
      const std::string& rest = others.heads->rest[others.of[e]];
      numbers = rest.substr(0, rest.find('|'));
      if (rest.find('|') != std::string::npos) beam = rest.substr(rest.find('|') + 1);
    }
    const auto fields = [](const std::string& text) {
      std::string line;
      for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find(' ', at), text.size());
        if (end > at) line += field(std::atoll(text.substr(at, end - at).c_str()));
        at = end + 1;
      }
      return line;
    };
    out << field(ids[e]) << field(kind) << fields(numbers) << field(static_cast<std::int64_t>(n)) << '\n';
    if (kind == 11 || (kind >= 21 && kind <= 24)) out << fields(beam) << '\n';
    for (std::size_t i = 0; i < n; ++i)
      out << field(id_of(node_ids, all[as && as->n_nodes > 0 ? as->place[i] : i]))
          << (i % 8 == 7 || i + 1 == n ? "\n" : "");
    is_written[e] = 1;
  }
  for (const auto& [name, n] : n_lost)
    notices.push_back("left out " + counted(n, "other element of type ", "other elements of type ") + name +
                      ", which .unv has nothing like here");
  return is_written;
}

}  // namespace

void write_unv(Output& out, const Mesh& mesh, const Association&, const WriteOptions& options,
               std::vector<std::string>& notices) {
  constexpr std::int64_t highest_id = 999'999'999;  // with a blank before it
  const std::array<const Field*, 2> columns = {hex_numbers(mesh, unv_property, highest_id),
                                               hex_numbers(mesh, unv_material, highest_id)};
  say_no_other_fields(mesh, columns, "I-deas' universal format", notices);
  constexpr const char* limit = "has more than nine digits";
  const auto node_ids = ids_in_file(mesh.node_ids, "node", "nodes", highest_id, limit, notices);
  const auto hex_ids = ids_in_file(mesh.hex_ids, "hex", "hexes", highest_id, limit, notices);
  const SecondOrder* const second = options.second;

  out << "    -1\n  2411\n";
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    out << field(id_of(node_ids, n)) << field(1) << field(1) << field(11) << '\n';
    for (const double x : mesh.points[n]) out << real(x);
    out << '\n';
  }
  out << "    -1\n    -1\n  2412\n";
  const auto element = [&](std::int64_t id, int kind, Index hex, std::span<const std::int64_t> nodes) {
    out << field(id) << field(kind);
    for (const Field* column : columns)
      out << field(hex >= 0 && column ? static_cast<std::int64_t>(column->values[hex]) : 1);
    out << field(7) << field(std::ssize(nodes)) << '\n';
    for (std::size_t i = 0; i < nodes.size(); ++i)
      out << field(nodes[i]) << (i % 8 == 7 || i + 1 == nodes.size() ? "\n" : "");
  };
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    const FileHex hex = file_hex(mesh, second, h, vtk_middles);
    std::array<std::int64_t, 27> nodes{};
    const auto n = static_cast<std::size_t>(hex.n);
    for (std::size_t i = 0; i < n; ++i) nodes[i] = id_of(node_ids, hex.nodes[second ? unv_place[i] : i]);
    element(id_of(hex_ids, h), second ? unv_hex_20 : unv_hex, h, std::span(nodes).first(n));
  }
  // Quads follow the hexes, each once.
  std::vector<Side> sides;
  for (const SideSet& set : mesh.side_sets) sides.insert(sides.end(), set.sides.begin(), set.sides.end());
  std::ranges::sort(sides);
  sides.erase(std::ranges::unique(sides).begin(), sides.end());
  const std::vector<std::int64_t> other_ids = other_ids_in_file(mesh, hex_ids, highest_id, limit, notices);
  std::int64_t before = mesh.hexes.empty() ? 0 : id_of(hex_ids, mesh.n_hexes() - 1);
  for (const std::int64_t id : other_ids) before = std::max(before, id);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Quad q = face_node_cycle(mesh.hexes[sides[i].hex], sides[i].face);
    std::vector<std::int64_t> nodes;
    for (std::size_t c = 0; c < 4; ++c) {
      nodes.push_back(id_of(node_ids, q[c]));
      if (second) nodes.push_back(id_of(node_ids, second->middle_between(q[c], q[(c + 1) % 4])));
    }
    element(before + 1 + static_cast<std::int64_t>(i), second ? unv_quad_8 : unv_quad, -1, nodes);
  }
  const std::vector<std::uint8_t> is_written = write_unv_others(out, mesh, node_ids, other_ids, notices);
  out << "    -1\n    -1\n  2467\n";
  Groups groups(out, notices);
  for (const Block& block : mesh.blocks) {
    std::vector<Index> others = others_of_block(mesh, block.id);
    std::erase_if(others, [&](Index e) { return !is_written[e]; });
    groups.write("block", block.id, block.name, 8, block.hexes.size() + others.size(), [&](std::size_t i) {
      return i < block.hexes.size() ? id_of(hex_ids, block.hexes[i]) : other_ids[others[i - block.hexes.size()]];
    });
  }
  for (const SideSet& set : mesh.side_sets)
    groups.write("sideset", set.id, set.name, 8, set.sides.size(), [&](std::size_t i) {
      return before + 1 + (std::ranges::lower_bound(sides, set.sides[i]) - sides.begin());
    });
  for (const NodeSet& set : mesh.node_sets)
    groups.write("nodeset", set.id, set.name, 7, set.nodes.size(),
                 [&](std::size_t i) { return id_of(node_ids, set.nodes[i]); });
  groups.tell();
  out << "    -1\n";
}

}  // namespace hextwist::io
