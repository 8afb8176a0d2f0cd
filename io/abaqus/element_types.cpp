// Which elements Abaqus and CalculiX call what (Abaqus Elements Guide, "Abaqus/Standard Element Index"; CalculiX
// CrunchiX User's Manual, "Element Types").
#include <algorithm>

#include "hextwist/io/abaqus/abaqus_internal.h"

namespace hextwist::io {
namespace {

struct ElementStart {
  std::string_view name;
  OtherShape shape;
  int n_nodes;  ///< 0: the first number behind the start of the name
};

/// The longest start that fits decides. Names go on with digits and letters that say how the element is integrated.
constexpr ElementStart element_starts[] = {
    {"S3", OtherShape::triangle, 3},
    {"STRI3", OtherShape::triangle, 3},
    {"STRI65", OtherShape::triangle, 6},
    {"S4", OtherShape::quad, 4},
    {"S6", OtherShape::triangle, 6},
    {"S8", OtherShape::quad, 8},
    {"S9", OtherShape::quad, 9},
    {"DS3", OtherShape::triangle, 3},
    {"DS4", OtherShape::quad, 4},
    {"DS6", OtherShape::triangle, 6},
    {"DS8", OtherShape::quad, 8},
    {"M3D3", OtherShape::triangle, 3},
    {"M3D4", OtherShape::quad, 4},
    {"M3D6", OtherShape::triangle, 6},
    {"M3D8", OtherShape::quad, 8},
    {"M3D9", OtherShape::quad, 9},
    {"SFM3D3", OtherShape::triangle, 3},
    {"SFM3D4", OtherShape::quad, 4},
    {"SFM3D6", OtherShape::triangle, 6},
    {"SFM3D8", OtherShape::quad, 8},
    {"R3D3", OtherShape::triangle, 3},
    {"R3D4", OtherShape::quad, 4},
    {"CPS3", OtherShape::triangle, 3},
    {"CPS4", OtherShape::quad, 4},
    {"CPS6", OtherShape::triangle, 6},
    {"CPS8", OtherShape::quad, 8},
    {"CPE3", OtherShape::triangle, 3},
    {"CPE4", OtherShape::quad, 4},
    {"CPE6", OtherShape::triangle, 6},
    {"CPE8", OtherShape::quad, 8},
    {"CAX3", OtherShape::triangle, 3},
    {"CAX4", OtherShape::quad, 4},
    {"CAX6", OtherShape::triangle, 6},
    {"CAX8", OtherShape::quad, 8},
    {"DC2D3", OtherShape::triangle, 3},
    {"DC2D4", OtherShape::quad, 4},
    {"DC2D6", OtherShape::triangle, 6},
    {"DC2D8", OtherShape::quad, 8},
    {"ACIN3D3", OtherShape::triangle, 3},
    {"ACIN3D4", OtherShape::quad, 4},
    {"B21", OtherShape::line, 2},
    {"B22", OtherShape::line, 3},
    {"B23", OtherShape::line, 2},
    {"B31", OtherShape::line, 2},
    {"B32", OtherShape::line, 3},
    {"B33", OtherShape::line, 2},
    {"PIPE31", OtherShape::line, 2},
    {"PIPE32", OtherShape::line, 3},
    {"ELBOW31", OtherShape::line, 2},
    {"ELBOW32", OtherShape::line, 3},
    {"FRAME3D", OtherShape::line, 2},
    {"T2D2", OtherShape::line, 2},
    {"T3D2", OtherShape::line, 2},
    {"T3D3", OtherShape::line, 3},
    {"RB3D2", OtherShape::line, 2},
    {"DC1D2", OtherShape::line, 2},
    {"DC1D3", OtherShape::line, 3},
    {"MASS", OtherShape::point, 1},
    {"ROTARYI", OtherShape::point, 1},
    {"HEATCAP", OtherShape::point, 1},
    {"SPRING1", OtherShape::point, 1},
    {"DASHPOT1", OtherShape::point, 1},
    {"CAPACITY", OtherShape::point, 1},
    {"SPRING2", OtherShape::connector, 2},
    {"SPRINGA", OtherShape::connector, 2},
    {"DASHPOT2", OtherShape::connector, 2},
    {"DASHPOTA", OtherShape::connector, 2},
    {"CONN3D2", OtherShape::connector, 2},
    {"CONN2D2", OtherShape::connector, 2},
    {"JOINTC", OtherShape::connector, 2},
    {"JOINT3D", OtherShape::connector, 2},
    {"GAPUNI", OtherShape::connector, 2},
    {"GAPCYL", OtherShape::connector, 2},
    {"GAPSPHER", OtherShape::connector, 2},
    {"DGAP", OtherShape::connector, 2},
    {"GASKET", OtherShape::connector, 2},
    {"DCOUP3D", OtherShape::connector, 1},
    {"D", OtherShape::connector, 3},
    {"ITSCYL", OtherShape::connector, 1},
    {"ITSUNI", OtherShape::connector, 1},
};

/// Digits of a name from there on as a number; 0 where there is none.
int digits_at(std::string_view name, std::size_t at) {
  int n = 0;
  for (; at < name.size() && name[at] >= '0' && name[at] <= '9' && n < 1000; ++at) n = 10 * n + (name[at] - '0');
  return n;
}

AbaqusElement solid_of(int n) {
  using enum AbaqusElement::Kind;
  switch (n) {
    case 8:
    case 20:
    case 27:
      return {hex, {}, n};
    case 4:
    case 10:
      return {other, OtherShape::tetrahedron, n};
    case 5:
    case 13:
      return {other, OtherShape::pyramid, n};
    case 6:
    case 15:
      return {other, OtherShape::wedge, n};
    default:
      return {refused, {}, n};
  }
}

}  // namespace

AbaqusElement abaqus_element(std::string_view type) {
  using enum AbaqusElement::Kind;
  for (const std::string_view solid : {"C3D", "AC3D", "DC3D", "DCC3D", "Q3D", "F3D", "FC3D", "EC3D", "CIN3D", "COH3D"})
    if (type.starts_with(solid)) {
      const int n = digits_at(type, solid.size());
      if (type.ends_with('V')) return {refused, {}, n};  // a varying number of nodes
      if ((solid == "CIN3D" && n != 8) || (solid == "COH3D" && n != 8 && n != 6)) return {refused, {}, n};
      return solid_of(n);
    }
  for (const std::string_view shell : {"SC", "CSS"})  // continuum shells
    if (type.starts_with(shell) && (digits_at(type, shell.size()) == 6 || digits_at(type, shell.size()) == 8))
      return solid_of(digits_at(type, shell.size()));
  const ElementStart* best = nullptr;
  for (const ElementStart& start : element_starts) {
    const bool whole = start.name.size() == 1;  // "D", a network of fluids, is not the start of all names with a D
    if (whole ? type != start.name : !type.starts_with(start.name)) continue;
    if (!best || start.name.size() > best->name.size()) best = &start;
  }
  return best ? AbaqusElement{other, best->shape, best->n_nodes} : AbaqusElement{unknown, OtherShape::connector, 0};
}

void set_element_types(const AbaqusParts& parts, MeshFile& out) {
  auto& of_block = out.extras.element_types;
  const auto n_types = parts.types.size();
  for (const std::string& type : parts.types)
    if (type.starts_with("SC8") || type.starts_with("CSS8") || type.starts_with("COH3D8"))
      out.notices.push_back("elements of type " + type +
                            " have a thickness direction; that of hexes that a refinement makes may be another one");
  if (n_types == 1) {
    if (parts.types[0] != "C3D8") of_block[0] = parts.types[0];
    return;
  }
  std::vector<char> covered(parts.type_of_hex.size(), 0);
  for (const Block& block : out.mesh.blocks) {
    const auto type = [&](Index h) { return parts.type_of_hex[h]; };
    if (block.hexes.empty()) continue;
    const int first = type(block.hexes[0]);
    if (!std::ranges::all_of(block.hexes, [&](Index h) { return type(h) == first; })) continue;
    of_block[block.id] = parts.types[first];
    for (const Index h : block.hexes) covered[h] = 1;
  }
  std::vector<std::vector<Index>> rest(n_types);
  for (std::size_t h = 0; h < covered.size(); ++h)
    if (!covered[h]) rest[parts.type_of_hex[h]].push_back(static_cast<Index>(h));
  const auto most = std::ranges::max_element(rest, {}, [](const auto& hexes) { return hexes.size(); });
  const auto usual = static_cast<std::size_t>(most - rest.begin());
  if (parts.types[usual] != "C3D8") of_block[0] = parts.types[usual];
  for (std::size_t t = 0; t < n_types; ++t) {
    if (t == usual || rest[t].empty()) continue;
    Block block{free_id(out.mesh.blocks), parts.types[t], std::move(rest[t])};
    out.notices.push_back("elements of type " + block.name + " that are in no set of their own are block " +
                          std::to_string(block.id) + " '" + block.name + "'");
    of_block[block.id] = block.name;
    out.mesh.blocks.push_back(std::move(block));
  }
}

}  // namespace hextwist::io
