// Nastran .bdf: GRID in large fields (16 characters of a number), CHEXA by blocks as PSOLID, node sets as SET1, sides
// as PLOAD4, which does nothing before a load case asks for it. Comments keep the names.
#include <map>

#include "hextwist/base/text.h"
#include "hextwist/io/nastran/nastran_internal.h"
#include "hextwist/io/nastran/others.h"
#include "hextwist/io/others.h"

namespace hextwist::io {
namespace {

constexpr std::int64_t highest_number = 99'999'999;  // eight characters

/// Fields of eight characters, eight in a line.
class SmallFields {
 public:
  SmallFields(Output& out, const char* name) : out_(out) {
    line_ = name;
    line_.resize(8, ' ');
  }
  void add(const std::string& field) {
    if (n_ == 8) next();
    line_ += std::string(8 - std::min<std::size_t>(8, field.size()), ' ') + field;
    ++n_;
  }
  void add(std::int64_t number) { add(std::to_string(number)); }
  void finish() { out_ << line_ << '\n'; }

 private:
  void next() {
    out_ << line_ << "+\n";
    line_ = "+       ";
    n_ = 0;
  }
  Output& out_;
  std::string line_;
  int n_ = 0;
};

std::string large(const std::string& field) {
  return std::string(16 - std::min<std::size_t>(16, field.size()), ' ') + field;
}

/// A card in small fields, or in large ones where a field does not fit.
void write_nastran_card(Output& out, std::string_view name, std::span<const std::string> fields) {
  const bool small = std::ranges::all_of(fields, [](const std::string& field) { return field.size() <= 8; });
  const std::size_t width = small ? 8 : 16, per_line = small ? 8 : 4;
  std::string line = std::string(name) + (small ? "" : "*");
  line.resize(8, ' ');
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (i > 0 && i % per_line == 0) {
      out << line << "+\n";
      line = small ? "+       " : "*       ";
    }
    line += std::string(width - std::min(width, fields[i].size()), ' ') + fields[i];
  }
  while (line.size() > 8 && line.back() == ' ') line.pop_back();
  out << line << '\n';
}

/// What elements of another format are called; empty where there is nothing like them.
std::string usual_card(const OtherType& type) {
  switch (type.shape) {
    case OtherShape::point:
      return "CONM2";
    case OtherShape::line:
      return type.n_nodes == 2 ? "CBAR" : "";
    case OtherShape::triangle:
      return type.n_nodes == 3 ? "CTRIA3" : type.n_nodes == 6 ? "CTRIA6" : "";
    case OtherShape::quad:
      return type.n_nodes == 4 ? "CQUAD4" : type.n_nodes == 8 ? "CQUAD8" : "";
    case OtherShape::tetrahedron:
      return type.n_nodes == 4 || type.n_nodes == 10 ? "CTETRA" : "";
    case OtherShape::pyramid:
      return type.n_nodes == 5 || type.n_nodes == 13 ? "CPYRAM" : "";
    case OtherShape::wedge:
      return type.n_nodes == 6 || type.n_nodes == 15 ? "CPENTA" : "";
    case OtherShape::connector:
      return "";
  }
  return "";
}

std::vector<std::string> nastran_fields_of(const std::string& rest) {
  std::vector<std::string> fields(1);
  for (const char c : rest)
    if (c == ',')
      fields.emplace_back();
    else
      fields.back() += c;
  return fields;
}

void write_nastran_others(Output& out, const Mesh& mesh, std::span<const std::int64_t> node_ids,
                          const std::vector<std::int64_t>& ids, std::vector<std::string>& notices) {
  const OtherElements& others = *mesh.others;
  const bool own = others.heads->format == "nastran";
  const bool same_nodes = node_ids.data() == mesh.node_ids.data();
  std::map<std::string, std::int64_t> n_lost, n_made;
  std::vector<int> block_of(static_cast<std::size_t>(others.size()), 0);
  std::vector<std::uint8_t> not_there(block_of.size(), 0);
  for (const Block& block : mesh.blocks)
    for (const Index e : others_of_block(mesh, block.id))
      if (block_of[e] == 0 && block.id > 0)
        block_of[e] = block.id;
      else
        not_there[e] = 1;
  if (const auto n = std::ranges::count(not_there, 1))
    notices.push_back(counted(n, "other element") + " of several blocks, or of block 0: only in the first above 0");
  std::map<int, std::vector<std::int64_t>> without_property;  // by block
  std::vector<std::pair<std::string, std::vector<std::string>>> cards;
  for (Index e = 0; e < others.size(); ++e) {
    const OtherType& type = others.type_of(e);
    const std::string name = own ? type.name : usual_card(type);
    const NastranOther* card = nastran_other(name);
    if (!card) {
      ++n_lost[type.name];
      continue;
    }
    if (card->property == 0 && block_of[e] > 0) without_property[block_of[e]].push_back(ids[e]);
    std::vector<std::string> fields = own && !others.heads->rest.empty()
                                          ? nastran_fields_of(others.heads->rest[others.of[e]])
                                          : std::vector<std::string>();
    const auto set = [&](std::size_t field, const std::string& text) {
      fields.resize(std::max(fields.size(), field + 1));
      fields[field] = text;
    };
    set(0, std::to_string(ids[e]));
    if (card->property > 0 && block_of[e] > 0) set(card->property, std::to_string(block_of[e]));
    const auto nodes = others.nodes_of(e);
    const auto n = static_cast<std::size_t>(type.n_nodes);
    for (std::size_t i = 0; i < n && card->shape != OtherShape::connector; ++i)
      set(card->first + nastran_place(*card, n, i), std::to_string(id_of(node_ids, nodes[i])));
    if (card->shape == OtherShape::connector && !same_nodes) {
      const NastranCard as_it_was{name, fields, nullptr};
      std::vector<std::size_t> of_nodes = nastran_node_fields(as_it_was);
      const bool has_direction = as_it_was[4].empty() || as_it_was[4].find('.') != std::string::npos;
      if ((name == "CBUSH" || name == "CGAP") && !has_direction) of_nodes.push_back(4);  // a node to turn to
      for (const std::size_t field : of_nodes) {
        const auto id = std::strtoll(fields[field].c_str(), nullptr, 10);
        if (const Index node = find_node(mesh, id); node >= 0) set(field, std::to_string(id_of(node_ids, node)));
      }
    }
    const bool bar = name == "CBAR" || name == "CBEAM";
    if (bar && nodes.size() > n) set(4, std::to_string(id_of(node_ids, nodes[n])));
    if (bar && !own && nodes.size() == n) set(4, "0."), set(5, "0."), set(6, "1.");
    for (std::string& field : fields)
      if (field.size() > 16) {
        double value = 0;
        const auto [stop, error] = std::from_chars(field.data(), field.data() + field.size(), value);
        if (error == std::errc{} && stop == field.data() + field.size()) field = nastran_real(value, 16);
      }
    if (!own) ++n_made[name];
    cards.emplace_back(name, std::move(fields));
  }
  // Before the cards, since these have no room for it: masses, springs, rigid elements.
  for (const auto& [block, elements] : without_property)
    for (std::size_t i = 0; i < elements.size(); ++i)
      out << (i % 6 == 0 ? "$ hextwist others " + std::to_string(block) : "") << ' ' << elements[i]
          << (i % 6 == 5 || i + 1 == elements.size() ? "\n" : "");
  for (const auto& [name, fields] : cards) write_nastran_card(out, name, fields);
  for (const auto& [type, n] : n_lost)
    notices.push_back("left out " + counted(n, "other element of type ", "other elements of type ") + type +
                      ", which Nastran has nothing like here");
  for (const auto& [name, n] : n_made)
    notices.push_back(counted(n, "other element") + " written as " + name +
                      ": properties and the like are yours to add");
}

/// "$ hextwist block 3 name".
void write_label(Output& out, const char* kind, int id, const std::string& name, std::vector<std::string>& notices) {
  const std::string line = one_line(name), written(trimmed(line));
  say_renamed(std::string(kind) + " " + std::to_string(id), name, written, notices);
  out << "$ hextwist " << kind << ' ' << id << ' ' << written << '\n';
}

}  // namespace

void write_nastran(Output& out, const Mesh& mesh, const Association&, const WriteOptions& options,
                   std::vector<std::string>& notices) {
  say_no_fields(mesh, "Nastran's bulk data", notices);
  constexpr const char* limit = "has more than eight digits";
  const auto node_ids = ids_in_file(mesh.node_ids, "node", "nodes", highest_number, limit, notices);
  const auto hex_ids = ids_in_file(mesh.hex_ids, "hex", "hexes", highest_number, limit, notices);
  if (mesh.n_nodes() > highest_number) throw Error("more nodes than eight digits can count");
  const std::vector<int> block_of_hex = first_block_of_hexes(mesh, "Nastran", notices);
  // A property has a positive id.
  const auto property = [&](int block) { return block < 0 ? 0 : mesh.blocks[static_cast<std::size_t>(block)].id; };
  int nobody = 0;
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    if (property(block_of_hex[h]) == 0) nobody = std::max(1, free_id(mesh.blocks));
  if (nobody > highest_number) throw Error("all properties are taken, none is left for hexes outside of blocks");
  if (nobody > 0 && !mesh.blocks.empty())
    notices.push_back("hexes in no block, or in block 0, are of property " + std::to_string(nobody));

  const auto check_ids = [](const char* kind, const auto& groups) {
    for (const auto& group : groups)
      if (group.id > highest_number)
        throw Error(std::string(kind) + " id " + std::to_string(group.id) + " has more than eight digits");
  };
  check_ids("block", mesh.blocks), check_ids("nodeset", mesh.node_sets), check_ids("sideset", mesh.side_sets);
  out << "$ hextwist mesh " << mesh.points.size() << ' ' << mesh.hexes.size() << "\nBEGIN BULK\n";
  for (const Block& block : mesh.blocks)
    if (block.id > 0) {
      write_label(out, "block", block.id, block.name, notices);
      if (block.hexes.empty() && !others_of_block(mesh, block.id).empty()) continue;  // the property is no solid's
      SmallFields card(out, "PSOLID");
      card.add(block.id);
      card.add(1);
      card.finish();
    }
  if (nobody > 0) out << "PSOLID  " << std::string(8 - std::to_string(nobody).size(), ' ') << nobody << "       1\n";
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    const Vec3& p = mesh.points[n];
    out << "GRID*   " << large(std::to_string(id_of(node_ids, n))) << large("") << large(nastran_real(p.x(), 16))
        << large(nastran_real(p.y(), 16)) << "\n*       " << large(nastran_real(p.z(), 16)) << '\n';
  }
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    SmallFields card(out, "CHEXA");
    card.add(id_of(hex_ids, h));
    const int own = property(block_of_hex[h]);
    card.add(own > 0 ? own : nobody);
    const FileHex nodes = file_hex(mesh, options.second, h, nastran_middles);
    for (const Index n : nodes.all()) card.add(id_of(node_ids, n));
    card.finish();
  }
  if (mesh.others)
    write_nastran_others(out, mesh, node_ids, other_ids_in_file(mesh, hex_ids, highest_number, limit, notices),
                         notices);
  for (const NodeSet& set : mesh.node_sets) {
    write_label(out, "nodeset", set.id, set.name, notices);
    SmallFields card(out, "SET1");
    card.add(set.id);
    for (const Index n : set.nodes) card.add(id_of(node_ids, n));
    card.finish();
  }
  for (const SideSet& set : mesh.side_sets) {
    write_label(out, "sideset", set.id, set.name, notices);
    for (const Side& side : set.sides) {
      const Quad q = face_nodes(mesh.hexes[side.hex], side.face);
      SmallFields card(out, "PLOAD4");
      card.add(set.id);
      card.add(id_of(hex_ids, side.hex));
      card.add("1.");
      for (int blank = 0; blank < 3; ++blank) card.add("");
      card.add(id_of(node_ids, q[0]));
      card.add(id_of(node_ids, q[3]));
      card.finish();
    }
  }
  out << "ENDDATA\n";
}

}  // namespace hextwist::io
