// Abaqus .inp: nodes, elements, sets and surfaces, without parts, as Abaqus and CalculiX both read it, and the cards of
// the file that was read. Comments keep ids and names that Abaqus has no room for. Fields and owners are left out.
#include <limits>
#include <map>
#include <set>

#include "hextwist/io/abaqus/abaqus_internal.h"
#include "hextwist/io/others.h"

namespace hextwist::io {
namespace {

/// Labels of one kind of set: letters, digits, '_' and '-', beginning with a letter, unique whatever the case, at most
/// 80 characters.
class Labels {
 public:
  const std::string& make(const char* kind, int id, const std::string& name, std::vector<std::string>& changed) {
    std::string label;
    for (const char c : name.substr(0, 60))
      label += std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' ? c : '_';
    if (label.empty() || !std::isalpha(static_cast<unsigned char>(label[0])))
      label = upper_case(kind) + "_" + std::to_string(id) + (label.empty() ? "" : "_" + label);
    while (!taken_.insert(upper_case(label)).second) label += "_" + std::to_string(id);
    if (!name.empty() && label != name) changed.push_back("'" + name + "' is " + label);
    return of_id_[id] = label;
  }
  /// One that no set has.
  std::string another(std::string label) {
    while (!taken_.insert(upper_case(label)).second) label += "_";
    return label;
  }
  bool has(const char* label) const { return taken_.contains(label); }
  const std::string* of(std::int64_t id) const {
    const auto at = id > std::numeric_limits<int>::max() ? of_id_.end() : of_id_.find(static_cast<int>(id));
    return at == of_id_.end() ? nullptr : &at->second;
  }

 private:
  std::set<std::string> taken_;
  std::map<int, std::string> of_id_;
};
/// By Reference::Kind.
using AllLabels = std::array<Labels, 3>;

/// The highest id that Abaqus takes; CalculiX reads ten characters of one into 32 bits.
constexpr std::int64_t highest_id = 999'999'999;

/// Numbers, sixteen in a line, as many as Abaqus takes.
template <class Id>
void write_ids(Output& out, std::size_t n, Id&& id) {
  for (std::size_t i = 0; i < n; ++i) out << id(i) << (i % 16 == 15 || i + 1 == n ? "\n" : ", ");
}

/// The type of the same elements with so many nodes: C3D8R is C3D20R. What can't have them stays as it is.
std::string with_nodes(const std::string& type, int n_nodes) {
  for (const std::string_view solid : {"C3D", "AC3D", "DC3D"}) {
    if (!type.starts_with(solid)) continue;
    std::size_t end = solid.size();
    while (end < type.size() && std::isdigit(static_cast<unsigned char>(type[end]))) ++end;
    std::string rest = type.substr(end);
    if (n_nodes > 8 && rest == "I") rest.clear();  // incompatible modes are of 8 nodes
    return std::string(solid) + std::to_string(n_nodes) + rest;
  }
  return type;
}

/// Hexes by their element type, C3D8 where nothing says otherwise.
std::vector<std::pair<std::string, std::vector<Index>>> hexes_by_type(const Mesh& mesh, const FileExtras& extras,
                                                                      std::vector<std::string>& notices) {
  const auto usual = extras.element_types.find(0);
  std::vector<std::string> types = {usual == extras.element_types.end() ? "C3D8" : usual->second};
  std::vector<int> type_of_hex(mesh.hexes.size(), -1);
  Index n_unclear = 0;
  for (const auto& [id, type] : extras.element_types) {
    if (id == 0) continue;
    const auto block = std::ranges::find(mesh.blocks, id, &Block::id);
    if (block == mesh.blocks.end()) {
      notices.push_back("block " + std::to_string(id) + ", of elements " + type + ", is gone: its hexes are " +
                        types[0]);
      continue;
    }
    const auto number = static_cast<int>(std::ranges::find(types, type) - types.begin());
    if (number == std::ssize(types)) types.push_back(type);
    for (const Index h : block->hexes)
      if (type_of_hex[h] < 0)
        type_of_hex[h] = number;
      else
        n_unclear += type_of_hex[h] != number;
  }
  if (n_unclear > 0)
    notices.push_back(counted(n_unclear, "hex", "hexes") +
                      " of several blocks with different element types: the first counts");
  std::vector<std::pair<std::string, std::vector<Index>>> result;
  for (const std::string& type : types) result.push_back({type, {}});
  for (Index h = 0; h < mesh.n_hexes(); ++h) result[std::max(type_of_hex[h], 0)].second.push_back(h);
  std::erase_if(result, [](const auto& one) { return one.second.empty(); });
  return result;
}

/// What elements of another format are called: empty where there is nothing like them.
std::string usual_abaqus_type(const OtherType& type) {
  const int n = type.n_nodes;
  switch (type.shape) {
    case OtherShape::point:
      return "MASS";
    case OtherShape::line:
      return n == 2 ? "B31" : n == 3 ? "B32" : "";
    case OtherShape::triangle:
      return n == 3 ? "S3" : n == 6 ? "STRI65" : "";
    case OtherShape::quad:
      return n == 4 ? "S4" : n == 8 ? "S8R" : n == 9 ? "S9R5" : "";
    case OtherShape::tetrahedron:
      return n == 4 ? "C3D4" : n == 10 ? "C3D10" : "";
    case OtherShape::pyramid:
      return n == 5 ? "C3D5" : "";
    case OtherShape::wedge:
      return n == 6 ? "C3D6" : n == 15 ? "C3D15" : "";
    case OtherShape::connector:
      return n == 2 ? "CONN3D2" : "";
  }
  return "";
}

/// Elements beside the hexes, by type; per element whether it is in the file.
void write_abaqus_others(Output& out, const Mesh& mesh, std::span<const std::int64_t> node_ids,
                         const std::vector<std::int64_t>& ids, std::vector<std::string>& notices) {
  const OtherElements& others = *mesh.others;
  const bool own = others.heads->format == "abaqus";
  for (std::size_t t = 0; t < others.heads->types.size(); ++t) {
    const OtherType& type = others.heads->types[t];
    const std::string name = own ? type.name : usual_abaqus_type(type);
    std::int64_t n = 0;
    for (Index e = 0; e < others.size(); ++e) {
      if (others.heads->type[others.of[e]] != static_cast<int>(t)) continue;
      if (n++ == 0 && !name.empty()) out << "*ELEMENT, TYPE=" << name << '\n';
      if (name.empty()) continue;
      std::vector<Index> nodes(others.nodes_of(e).begin(), others.nodes_of(e).end());
      if (is_bent_line(type)) std::swap(nodes[1], nodes[2]);
      out << ids[e];
      for (std::size_t i = 0; i < nodes.size(); ++i)
        out << (i > 0 && i % 15 == 0 ? ",\n" : ", ") << id_of(node_ids, nodes[i]);
      out << '\n';
    }
    if (n > 0 && name.empty())
      notices.push_back(counted(n, std::string("other element of type ") + type.name,
                                std::string("other elements of type ") + type.name) +
                        " left out: Abaqus has nothing like them");
    if (n > 0 && !own && !name.empty())
      notices.push_back(counted(n, hextwist::name(type.shape)) + " written as " + name + ", which need a section");
  }
}

/// Elements of a side set with a face of the same number, and what they are called.
struct FacesOfLoad {
  int face;
  std::string label;
};
using FacesOfLoads = std::map<std::int64_t, std::vector<FacesOfLoad>>;  ///< by the id of the side set

/// Element sets for the loads on faces, since these are said of elements there.
FacesOfLoads write_faces_of_loads(Output& out, const Mesh& mesh, const FileExtras& extras,
                                  std::span<const std::int64_t> hex_ids, const std::array<int, 6>& number,
                                  AllLabels& labels) {
  FacesOfLoads result;
  for (const AbaqusCard& card : extras.cards)
    for (const auto& reference : card.references)
      if (reference.kind == AbaqusCard::Reference::faces) result[reference.id];
  for (auto& [id, faces] : result) {
    const auto set = std::ranges::find(mesh.side_sets, id, &SideSet::id);
    if (set == mesh.side_sets.end()) continue;
    std::array<std::vector<std::int64_t>, 7> elements;
    for (const Side& side : set->sides) elements[number[side.face]].push_back(id_of(hex_ids, side.hex));
    for (int face = 1; face <= 6; ++face) {
      if (elements[face].empty()) continue;
      const std::string label = labels[AbaqusCard::Reference::block].another(
          *labels[AbaqusCard::Reference::side_set].of(id) + "_E" + std::to_string(face));
      out << "** hextwist faces " << id << ' ' << label << "\n*ELSET, ELSET=" << label << '\n';
      write_ids(out, elements[face].size(), [&](std::size_t i) { return elements[face][i]; });
      faces.push_back({face, label});
    }
  }
  return result;
}

/// What is written for what.
struct IdsInFile {
  std::span<const std::int64_t> nodes, hexes;
  const std::vector<std::int64_t>& others;
};

/// Cards with the labels that their sets have now, without those and the lines that are about nothing any more.
void write_cards(Output& out, const Mesh& mesh, const FileExtras& extras, const AllLabels& labels,
                 const FacesOfLoads& loads, const IdsInFile& ids, std::vector<std::string>& notices) {
  using Reference = AbaqusCard::Reference;
  for (AbaqusCard card : extras.cards) {
    const std::string keyword = upper_case(card.text.substr(0, card.text.find_first_of(",\r\n")));
    bool whole = true;
    std::size_t n_lines = 0;
    // From the end, so that places before stay.
    for (std::size_t k = card.references.size(); k-- > 0;) {
      if (k >= card.references.size()) continue;  // its line is gone
      const Reference at = card.references[k];
      std::string now;
      if (at.kind == Reference::faces) {
        const auto [begin, end] = line_around(card.text, at.begin);
        const AbaqusFaceLoad load = abaqus_face_load(card.text.substr(at.begin, at.end - at.begin));
        for (const FacesOfLoad& of : loads.at(at.id))
          now += card.text.substr(begin, at.begin - begin) + of.label + ", " + load.label(of.face) +
                 card.text.substr(at.end, end - at.end);
        if (!now.empty()) {
          card.text.replace(begin, end - begin, now);
          continue;
        }
      }
      if (at.kind == Reference::node)
        if (const Index n = find_node(mesh, at.id); n >= 0) now = std::to_string(id_of(ids.nodes, n));
      if (at.kind == Reference::hex) {
        if (const Index h = find_hex(mesh, at.id); h >= 0)
          now = std::to_string(id_of(ids.hexes, h));
        else if (const Index e = find_other(mesh, at.id); e >= 0)
          now = std::to_string(ids.others[e]);
      }
      if (at.kind <= Reference::side_set)
        if (const std::string* label = labels[at.kind].of(at.id)) now = *label;
      if (!now.empty()) {
        card.text.replace(at.begin, at.end - at.begin, now);
        continue;
      }
      whole = whole && !at.by_keyword;
      const auto [begin, end] = line_around(card.text, at.begin);
      if (!at.by_keyword) cut_out(card, begin, end), ++n_lines;
    }
    if (!whole)
      notices.push_back(card.where + ": " + keyword + " is left out: what it is about is gone, or was cut");
    else if (n_lines > 0)
      notices.push_back(card.where + ": " + counted(static_cast<std::int64_t>(n_lines), "line") + " of " + keyword +
                        " left out: what they are about is gone, or was cut");
    const bool is_empty = n_lines > 0 && card.text.find('\n') + 1 == card.text.size();
    if (whole && !is_empty) out << card.text;
  }
}

}  // namespace

void write_abaqus(Output& out, const Mesh& mesh, const Association&, const WriteOptions& options,
                  std::vector<std::string>& notices) {
  static const FileExtras nothing;
  const FileExtras& extras = options.extras ? *options.extras : nothing;
  say_no_fields(mesh, "Abaqus", notices);
  constexpr const char* limit = "is more than Abaqus takes";
  const auto node_ids = ids_in_file(mesh.node_ids, "node", "nodes", highest_id, limit, notices);
  const auto hex_ids = ids_in_file(mesh.hex_ids, "hex", "hexes", highest_id, limit, notices);
  AllLabels labels;
  std::vector<std::string> changed;
  for (const Block& block : mesh.blocks)
    labels[AbaqusCard::Reference::block].make("block", block.id, block.name, changed);
  for (const NodeSet& set : mesh.node_sets)
    labels[AbaqusCard::Reference::node_set].make("nodeset", set.id, set.name, changed);
  for (const SideSet& set : mesh.side_sets)
    labels[AbaqusCard::Reference::side_set].make("sideset", set.id, set.name, changed);
  if (!changed.empty())
    notices.push_back("names that Abaqus cannot have are others in the file: " +
                      joined(std::span(changed).first(std::min(changed.size(), std::size_t{3})), ", ") +
                      (changed.size() > 3 ? " and " + std::to_string(changed.size() - 3) + " more" : ""));

  out << "*HEADING\n" << (extras.heading.empty() ? "hextwist\n" : extras.heading);
  out << "** hextwist mesh " << mesh.points.size() << ' ' << mesh.hexes.size() << '\n';
  out << (labels[AbaqusCard::Reference::node_set].has("NALL") ? "*NODE\n" : "*NODE, NSET=NALL\n");
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    const Vec3& p = mesh.points[n];
    out << id_of(node_ids, n);
    for (const double x : p) (out << ", ").number(x, abaqus_number_width);
    out << '\n';
  }
  for (const auto& [named, hexes] : hexes_by_type(mesh, extras, notices)) {
    const int n_nodes = options.second ? options.second->nodes_per_hex : 8;
    const std::string type = with_nodes(named, n_nodes);
    if (type == named && n_nodes > 8 && !named.starts_with("C3D" + std::to_string(n_nodes)))
      throw Error("elements of type " + named + " have no middle nodes: export with order 1");
    out << "*ELEMENT, TYPE=" << type << (labels[AbaqusCard::Reference::block].has("EALL") ? "\n" : ", ELSET=EALL\n");
    for (const Index h : hexes) {
      out << id_of(hex_ids, h);
      const FileHex nodes = file_hex(mesh, options.second, h, abaqus_middles);
      for (int c = 0; c < nodes.n; ++c)  // sixteen numbers in a line
        out << (c > 0 && c % 15 == 0 ? ",\n" : ", ") << id_of(node_ids, nodes.nodes[c]);
      out << '\n';
    }
  }
  const std::vector<std::int64_t> other_ids = other_ids_in_file(mesh, hex_ids, highest_id, limit, notices);
  if (mesh.others) write_abaqus_others(out, mesh, node_ids, other_ids, notices);
  const auto begin = [&](const char* kind, const char* keyword, const auto& group, AbaqusCard::Reference::Kind which) {
    const std::string& label = *labels[which].of(group.id);
    out << "** hextwist " << kind << ' ' << group.id << ' ' << label << ' ' << one_line(group.name) << '\n'
        << keyword << label << '\n';
  };
  for (const Block& block : mesh.blocks) {
    begin("block", "*ELSET, ELSET=", block, AbaqusCard::Reference::block);
    write_ids(out, block.hexes.size(), [&](std::size_t i) { return id_of(hex_ids, block.hexes[i]); });
    const std::vector<Index> others = others_of_block(mesh, block.id);
    write_ids(out, others.size(), [&](std::size_t i) { return other_ids[others[i]]; });
  }
  for (const NodeSet& set : mesh.node_sets) {
    begin("nodeset", "*NSET, NSET=", set, AbaqusCard::Reference::node_set);
    write_ids(out, set.nodes.size(), [&](std::size_t i) { return id_of(node_ids, set.nodes[i]); });
    if (const std::string& label = *labels[AbaqusCard::Reference::node_set].of(set.id);
        std::ranges::binary_search(extras.node_surfaces, set.id))
      out << "*SURFACE, TYPE=NODE, NAME=" << label << '\n' << label << ", 1.\n";
  }
  std::array<int, 6> number{};
  for (int s = 0; s < 6; ++s) number[abaqus_face[s]] = s + 1;
  for (const SideSet& set : mesh.side_sets) {
    begin("sideset", "*SURFACE, TYPE=ELEMENT, NAME=", set, AbaqusCard::Reference::side_set);
    for (const Side& side : set.sides) out << id_of(hex_ids, side.hex) << ", S" << number[side.face] << '\n';
    for (const auto& [element, side] : other_sides_of(mesh, set.id))
      out << other_ids[element] << (side.empty() ? "" : ", ") << side << '\n';
  }
  const FacesOfLoads loads = write_faces_of_loads(out, mesh, extras, hex_ids, number, labels);
  write_cards(out, mesh, extras, labels, loads, {node_ids, hex_ids, other_ids}, notices);
  out << "** hextwist end\n";
}

}  // namespace hextwist::io
