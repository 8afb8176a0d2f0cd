// LS-DYNA keyword files, .k: nodes with 16 characters of a coordinate, hexes by blocks as *PART, all sets. What a part
// is made of and what happens to it is for others to add.
#include "hextwist/io/group_names.h"
#include "hextwist/io/lsdyna/lsdyna_internal.h"

namespace hextwist::io {
namespace {

constexpr std::int64_t highest_dyna_id = 99'999'999;  // eight characters

/// A name on a line of its own, which no reader takes for a keyword or a comment.
std::string dyna_title(const char* kind, int id, const std::string& name, std::vector<std::string>& notices) {
  std::string line = one_line(name);
  line = std::string(trimmed(first_letters(trimmed(line), 70)));
  if (line.starts_with('*') || line.starts_with('$')) line[0] = '_';
  say_renamed(std::string(kind) + " " + std::to_string(id), name, line, notices);
  return line;
}

class DynaWriter {
 public:
  DynaWriter(Output& out, const Mesh& mesh, const WriteOptions& options, std::vector<std::string>& notices)
      : out_(out), mesh_(mesh), second_(options.second), notices_(notices) {}

  void write() {
    say_no_fields(mesh_, "LS-DYNA's input", notices_);
    constexpr const char* limit = "has more than eight digits";
    node_ids_ = ids_in_file(mesh_.node_ids, "node", "nodes", highest_dyna_id, limit, notices_);
    hex_ids_ = ids_in_file(mesh_.hex_ids, "hex", "hexes", highest_dyna_id, limit, notices_);
    if (mesh_.n_nodes() > highest_dyna_id) throw Error("more nodes than eight digits can count");
    const auto check = [](const char* kind, const auto& groups) {
      for (const auto& group : groups)
        if (group.id > highest_dyna_id)
          throw Error(std::string(kind) + " id " + std::to_string(group.id) + " has more than eight digits");
    };
    check("block", mesh_.blocks), check("nodeset", mesh_.node_sets), check("sideset", mesh_.side_sets);
    out_ << "*KEYWORD\n*TITLE\n" << lsdyna_title << "\n";
    parts();
    nodes();
    hexes();
    sets();
    out_ << "*END\n";
  }

 private:
  /// A part has a positive id, and a hex is in one of them.
  void parts() {
    block_of_hex_.assign(mesh_.hexes.size(), -1);
    for (std::size_t b = 0; b < mesh_.blocks.size(); ++b) {
      bool whole = mesh_.blocks[b].id > 0 && !mesh_.blocks[b].hexes.empty();
      for (const Index h : mesh_.blocks[b].hexes)
        if (block_of_hex_[h] >= 0)
          whole = false;
        else if (mesh_.blocks[b].id > 0)
          block_of_hex_[h] = static_cast<int>(b);
      if (!whole) as_sets_.push_back(b);
    }
    if (std::ranges::find(block_of_hex_, -1) != block_of_hex_.end()) nobody_ = std::max(1, free_id(mesh_.blocks));
    if (nobody_ > highest_dyna_id) throw Error("all parts are taken, none is left for hexes outside of blocks");
    if (nobody_ > 0 && !mesh_.blocks.empty())
      notices_.push_back("hexes in no block, or in block 0 alone, are of part " + std::to_string(nobody_));
    const auto part = [&](int id, const std::string& name) {
      out_ << "*PART\n"
           << name << "\n$#     pid     secid       mid     eosid      hgid      grav    adpopt      tmid\n"
           << Right{id, 10} << Right{1, 10} << Right{1, 10};
      for (int i = 0; i < 5; ++i) out_ << Right{0, 10};
      out_ << '\n';
    };
    // What a title can't hold is told once, of parts here.
    for (const Block& block : mesh_.blocks) titles_.push_back(dyna_title("block", block.id, block.name, notices_));
    for (std::size_t b = 0; b < mesh_.blocks.size(); ++b)
      if (mesh_.blocks[b].id > 0) part(mesh_.blocks[b].id, titles_[b]);
    if (nobody_ > 0) part(nobody_, "");
    // The formulation is the element's: one point, or the one of 20 nodes.
    out_ << "*SECTION_SOLID\n$#   secid    elform\n" << Right{1, 10} << Right{second_ ? 23 : 1, 10} << '\n';
  }

  void nodes() {
    out_ << "*NODE\n$#   nid               x               y               z\n";
    for (Index n = 0; n < mesh_.n_nodes(); ++n) {
      out_ << Right{id_of(node_ids_, n), 8};
      for (const double x : mesh_.points[n]) {
        const NumberText number(x, 16);
        for (std::size_t i = number.size; i < 16; ++i) out_ << ' ';
        out_ << number.text();
      }
      out_ << '\n';
    }
  }

  void hexes() {
    out_ << (second_ ? "*ELEMENT_SOLID_H20\n" : "*ELEMENT_SOLID\n");
    for (Index h = 0; h < mesh_.n_hexes(); ++h) {
      const int block = block_of_hex_[h];
      out_ << Right{id_of(hex_ids_, h), 8}
           << Right{block < 0 ? nobody_ : mesh_.blocks[static_cast<std::size_t>(block)].id, 8};
      const FileHex hex = file_hex(mesh_, second_, h, lsdyna_middles);
      if (second_) out_ << '\n';
      for (int i = 0; i < hex.n; ++i)
        out_ << (second_ && i == 10 ? "\n" : "") << Right{id_of(node_ids_, hex.nodes[static_cast<std::size_t>(i)]), 8};
      out_ << '\n';
    }
  }

  template <class Id>
  void list(const char* keyword, int id, const std::string& name, std::size_t n, Id&& member) {
    out_ << '*' << keyword << (name.empty() ? "\n" : "_TITLE\n");
    if (!name.empty()) out_ << name << '\n';
    out_ << Right{id, 10} << '\n';
    for (std::size_t i = 0; i < n; ++i) out_ << Right{member(i), 10} << (i % 8 == 7 || i + 1 == n ? "\n" : "");
  }

  void sets() {
    for (const std::size_t b : as_sets_) {
      const Block& block = mesh_.blocks[b];
      list("SET_SOLID", block.id, titles_[b], block.hexes.size(),
           [&](std::size_t i) { return id_of(hex_ids_, block.hexes[i]); });
    }
    for (const NodeSet& set : mesh_.node_sets)
      list("SET_NODE_LIST", set.id, dyna_title("nodeset", set.id, set.name, notices_), set.nodes.size(),
           [&](std::size_t i) { return id_of(node_ids_, set.nodes[i]); });
    for (const SideSet& set : mesh_.side_sets) {
      list("SET_SEGMENT", set.id, dyna_title("sideset", set.id, set.name, notices_), 0, [](std::size_t) { return 0; });
      for (const Side& side : set.sides) {
        for (const Index n : face_node_cycle(mesh_.hexes[side.hex], side.face)) out_ << Right{id_of(node_ids_, n), 10};
        out_ << '\n';
      }
    }
  }

  Output& out_;
  const Mesh& mesh_;
  const SecondOrder* const second_;
  std::vector<std::string>& notices_;
  std::span<const std::int64_t> node_ids_, hex_ids_;
  std::vector<int> block_of_hex_;
  std::vector<std::size_t> as_sets_;  // blocks that share hexes with those before them, or have none
  std::vector<std::string> titles_;   // of blocks
  int nobody_ = 0;
};

}  // namespace

void write_lsdyna(Output& out, const Mesh& mesh, const Association&, const WriteOptions& options,
                  std::vector<std::string>& notices) {
  DynaWriter(out, mesh, options, notices).write();
}

}  // namespace hextwist::io
