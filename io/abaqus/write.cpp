// Abaqus .inp: nodes, C3D8 elements, sets and surfaces, without parts, as Abaqus and CalculiX both read it. Comments
// keep ids and names that Abaqus has no room for. Fields and owners are left out.
#include <set>

#include "hextwist/io/abaqus/abaqus_internal.h"

namespace hextwist::io {
namespace {

/// Labels: letters, digits, '_' and '-', beginning with a letter, unique whatever the case, at most 80 characters.
class Labels {
 public:
  std::string make(const char* kind, int id, const std::string& name) {
    std::string label;
    for (const char c : name.substr(0, 60))
      label += std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' ? c : '_';
    if (label.empty() || !std::isalpha(static_cast<unsigned char>(label[0])))
      label = upper_case(kind) + "_" + std::to_string(id) + (label.empty() ? "" : "_" + label);
    while (!taken_.insert(upper_case(label)).second) label += "_" + std::to_string(id);
    return label;
  }

 private:
  std::set<std::string> taken_ = {"NALL", "EALL"};
};

std::string one_line(std::string name) {
  for (char& c : name)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  return name;
}

/// CalculiX reads 20 characters of a number and takes the rest for blanks; Abaqus as many.
constexpr std::size_t number_width = 20;
/// The highest id that Abaqus takes; CalculiX reads ten characters of one into 32 bits.
constexpr std::int64_t highest_id = 999'999'999;

/// Ids as the file has them: those of the mesh, or counted from 1 where they are too large.
std::span<const std::int64_t> ids_in_file(const std::vector<std::int64_t>& ids, const char* kind,
                                          std::vector<std::string>& notices) {
  if (ids.empty() || ids.back() <= highest_id) return ids;
  notices.push_back(std::string(kind) + " id " + std::to_string(ids.back()) + " is more than Abaqus takes: " + kind +
                    (kind[0] == 'n' ? "s" : "es") + " are counted from 1 in the file");
  return {};
}

/// Numbers, sixteen in a line, as many as Abaqus takes.
template <class Id>
void write_ids(Output& out, std::size_t n, Id&& id) {
  for (std::size_t i = 0; i < n; ++i) out << id(i) << (i % 16 == 15 || i + 1 == n ? "\n" : ", ");
}

}  // namespace

void write_abaqus(Output& out, const Mesh& mesh, const Association&, const WriteOptions&,
                  std::vector<std::string>& notices) {
  say_no_fields(mesh, "Abaqus", notices);
  const auto node_ids = ids_in_file(mesh.node_ids, "node", notices);
  const auto hex_ids = ids_in_file(mesh.hex_ids, "hex", notices);
  out << "*HEADING\nhextwist\n** hextwist mesh\n";
  Labels labels;
  const auto begin = [&](const char* kind, const char* keyword, const auto& group) {
    const std::string label = labels.make(kind, group.id, group.name);
    out << "** hextwist " << kind << ' ' << group.id << ' ' << label << ' ' << one_line(group.name) << '\n'
        << keyword << label << '\n';
  };
  out << "*NODE, NSET=NALL\n";
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    const Vec3& p = mesh.points[n];
    out << id_of(node_ids, n);
    for (const double x : p) (out << ", ").number(x, number_width);
    out << '\n';
  }
  out << "*ELEMENT, TYPE=C3D8, ELSET=EALL\n";
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    out << id_of(hex_ids, h);
    for (const int c : file_corner) out << ", " << id_of(node_ids, mesh.hexes[h][c]);
    out << '\n';
  }
  for (const Block& block : mesh.blocks) {
    begin("block", "*ELSET, ELSET=", block);
    write_ids(out, block.hexes.size(), [&](std::size_t i) { return id_of(hex_ids, block.hexes[i]); });
  }
  for (const NodeSet& set : mesh.node_sets) {
    begin("nodeset", "*NSET, NSET=", set);
    write_ids(out, set.nodes.size(), [&](std::size_t i) { return id_of(node_ids, set.nodes[i]); });
  }
  std::array<int, 6> number{};
  for (int s = 0; s < 6; ++s) number[abaqus_face[s]] = s + 1;
  for (const SideSet& set : mesh.side_sets) {
    begin("sideset", "*SURFACE, TYPE=ELEMENT, NAME=", set);
    for (const Side& side : set.sides) out << id_of(hex_ids, side.hex) << ", S" << number[side.face] << '\n';
  }
}

}  // namespace hextwist::io
