// I-deas universal files, .unv: nodes (2411), hexes and the quads of side sets (2412), and all sets as groups (2467).
#include <set>

#include "hextwist/io/listing.h"
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
    std::string line = name.empty() ? std::string(kind) + "_" + std::to_string(id) : one_line(name);
    if (line.size() > 40) line.resize(40);
    say_renamed(std::string(kind) + " " + std::to_string(id), name, name.empty() ? name : line, notices_);
    out_ << line << '\n';
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

}  // namespace

void write_unv(Output& out, const Mesh& mesh, const Association&, const WriteOptions& options,
               std::vector<std::string>& notices) {
  say_no_fields(mesh, "I-deas' universal format", notices);
  constexpr std::int64_t highest_id = 999'999'999;  // with a blank before it
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
  const auto element = [&](std::int64_t id, int kind, std::span<const std::int64_t> nodes) {
    out << field(id) << field(kind) << field(1) << field(1) << field(7) << field(std::ssize(nodes)) << '\n';
    for (std::size_t i = 0; i < nodes.size(); ++i)
      out << field(nodes[i]) << (i % 8 == 7 || i + 1 == nodes.size() ? "\n" : "");
  };
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    const FileHex hex = file_hex(mesh, second, h, vtk_middles);
    std::array<std::int64_t, 27> nodes{};
    const auto n = static_cast<std::size_t>(hex.n);
    for (std::size_t i = 0; i < n; ++i) nodes[i] = id_of(node_ids, hex.nodes[second ? unv_place[i] : i]);
    element(id_of(hex_ids, h), second ? unv_hex_20 : unv_hex, std::span(nodes).first(n));
  }
  // Quads follow the hexes, each once.
  std::vector<Side> sides;
  for (const SideSet& set : mesh.side_sets) sides.insert(sides.end(), set.sides.begin(), set.sides.end());
  std::ranges::sort(sides);
  sides.erase(std::ranges::unique(sides).begin(), sides.end());
  const std::int64_t before = mesh.hexes.empty() ? 0 : id_of(hex_ids, mesh.n_hexes() - 1);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Quad q = face_node_cycle(mesh.hexes[sides[i].hex], sides[i].face);
    std::vector<std::int64_t> nodes;
    for (std::size_t c = 0; c < 4; ++c) {
      nodes.push_back(id_of(node_ids, q[c]));
      if (second) nodes.push_back(id_of(node_ids, second->middle_between(q[c], q[(c + 1) % 4])));
    }
    element(before + 1 + static_cast<std::int64_t>(i), second ? unv_quad_8 : unv_quad, nodes);
  }
  out << "    -1\n    -1\n  2467\n";
  Groups groups(out, notices);
  for (const Block& block : mesh.blocks)
    groups.write("block", block.id, block.name, 8, block.hexes.size(),
                 [&](std::size_t i) { return id_of(hex_ids, block.hexes[i]); });
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
