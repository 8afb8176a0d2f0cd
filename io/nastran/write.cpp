// Nastran .bdf: GRID in large fields (16 characters of a number), CHEXA by blocks as PSOLID, node sets as SET1, sides
// as PLOAD4, which does nothing before a load case asks for it. Comments keep the names.
#include "hextwist/io/nastran/nastran_internal.h"

namespace hextwist::io {
namespace {

constexpr std::int64_t highest_id = 99'999'999;  // eight characters

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

}  // namespace

void write_nastran(Output& out, const Mesh& mesh, const Association&, const WriteOptions& options,
                   std::vector<std::string>& notices) {
  say_no_fields(mesh, "Nastran's bulk data", notices);
  constexpr const char* limit = "has more than eight digits";
  const auto node_ids = ids_in_file(mesh.node_ids, "node", "nodes", highest_id, limit, notices);
  const auto hex_ids = ids_in_file(mesh.hex_ids, "hex", "hexes", highest_id, limit, notices);
  if (mesh.n_nodes() > highest_id) throw Error("more nodes than eight digits can count");
  const std::vector<int> block_of_hex = first_block_of_hexes(mesh, "Nastran", notices);
  // A property has a positive id.
  const auto property = [&](int block) { return block < 0 ? 0 : mesh.blocks[static_cast<std::size_t>(block)].id; };
  int nobody = 0;
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    if (property(block_of_hex[h]) == 0) nobody = std::max(1, free_id(mesh.blocks));
  if (nobody > highest_id) throw Error("all properties are taken, none is left for hexes outside of blocks");
  if (nobody > 0 && !mesh.blocks.empty())
    notices.push_back("hexes in no block, or in block 0, are of property " + std::to_string(nobody));

  const auto check_ids = [](const char* kind, const auto& groups) {
    for (const auto& group : groups)
      if (group.id > highest_id)
        throw Error(std::string(kind) + " id " + std::to_string(group.id) + " has more than eight digits");
  };
  check_ids("block", mesh.blocks), check_ids("nodeset", mesh.node_sets), check_ids("sideset", mesh.side_sets);
  out << "$ hextwist mesh " << mesh.points.size() << ' ' << mesh.hexes.size() << "\nBEGIN BULK\n";
  for (const Block& block : mesh.blocks)
    if (block.id > 0) {
      out << "$ hextwist block " << block.id << ' ' << one_line(block.name) << '\n';
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
  for (const NodeSet& set : mesh.node_sets) {
    out << "$ hextwist nodeset " << set.id << ' ' << one_line(set.name) << '\n';
    SmallFields card(out, "SET1");
    card.add(set.id);
    for (const Index n : set.nodes) card.add(id_of(node_ids, n));
    card.finish();
  }
  for (const SideSet& set : mesh.side_sets) {
    out << "$ hextwist sideset " << set.id << ' ' << one_line(set.name) << '\n';
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
