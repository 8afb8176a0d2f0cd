// LS-DYNA keyword files, .k: *NODE, *ELEMENT_SOLID, *ELEMENT_SHELL, *PART and sets of nodes, solids and segments.
#include "hextwist/io/lsdyna/lsdyna_internal.h"

namespace hextwist::io {
namespace {

class DynaReader {
 public:
  explicit DynaReader(const Bytes& bytes) : cursor_(bytes), cards_(cursor_), listing_(cursor_) {}

  MeshFile result() {
    bool ended = false;
    while (!ended && !cards_.next_keyword().empty()) ended = read(cards_.keyword());
    if (!ended) listing_.note(cursor_.where(cursor_.end) + ": there is no *END; the file may be cut short");
    held_.tell(listing_, "constraints (TC, RC)", "node");
    made_of_.tell(listing_, "sections, materials and the like (SECID 1 and MID 1 are written)", "part");
    attributes_.tell(listing_, "attributes (A1 to A4, DA1 to DA4)", "set");
    if (n_other_ > 0)
      listing_.note(counted(n_other_, "other keyword") + " left out: *" + joined(others_, ", *") +
                    (others_.size() == most_named ? ", ..." : ""));
    tell_sets_from_parts();
    return listing_.result(true);
  }

 private:
  static constexpr std::size_t most_named = 5;

  /// Parts and sets are numbered each for itself, and both are blocks here: sets come behind all parts, so that hexes
  /// stay in their parts. In files of ours a set is the part of that number.
  void tell_sets_from_parts() {
    if (ours_) return;
    std::ranges::stable_sort(solid_sets_, {}, &Listing::Group::id);
    int next = highest_part_;
    for (const Listing::Group* set : solid_sets_) next = std::max(next, set->id);
    std::string moved;
    for (Listing::Group* set : solid_sets_) {
      if (set->id > highest_part_ || next == std::numeric_limits<int>::max()) continue;
      moved += (moved.empty() ? "" : ", ") + std::to_string(set->id) + " is " + std::to_string(next + 1);
      set->id = ++next;
    }
    if (!moved.empty()) listing_.note("sets of solids are blocks behind those of parts: " + moved);
  }

  /// Is this the end?
  bool read(const std::string& name) {
    if (name == "END") return true;
    if (name == "KEYWORD" || name.starts_with("KEYWORD_") || name == "COMMENT") return false;
    if (name == "TITLE") {
      std::string title;
      cards_.next_title(title);
      ours_ = title == lsdyna_title;
      return false;
    }
    if (name == "SECTION_SOLID" && ours_) return false;
    if (name == "NODE")
      nodes();
    else if (name.starts_with("ELEMENT_SOLID"))
      solids(name.substr(13));
    else if (name == "ELEMENT_SHELL" || name == "ELEMENT_SHELL_THICKNESS" || name == "ELEMENT_SHELL_BETA")
      shells(name != "ELEMENT_SHELL");
    else if (name.starts_with("ELEMENT_TSHELL"))
      refuse_first("thick shell");
    else if (name == "PART" || name.starts_with("PART_"))
      part(name);
    else if (name.starts_with("SET_") && set(name))
      return false;
    else if (name == "INCLUDE" || name.starts_with("INCLUDE_"))
      include();
    else if (name == "NODE_TRANSFORM" || name == "NODE_MERGE" || name.starts_with("NODE_MERGE_"))
      cursor_.fail_at(cards_.keyword_at(),
                      "*" + name + " changes the nodes and is not read: the mesh would be another");
    else if (name.starts_with("ELEMENT_"))
      drop(name);
    else
      leave_out(name);
    return false;
  }

  void leave_out(const std::string& name) {
    ++n_other_;
    if (others_.size() < most_named && std::ranges::find(others_, name) == others_.end()) others_.push_back(name);
  }

  void include() {
    std::string file;
    cards_.next_title(file);
    cursor_.fail_at(cards_.keyword_at(), "*" + cards_.keyword() + " of " + shown(file) +
                                             " is not followed: nodes or elements would be missing");
  }

  void nodes() {
    DynaCard card;
    while (cards_.next(card, dyna_node)) {
      const std::int64_t node = cards_.integer(card, 0, "a node id");
      listing_.add_node(node, Vec3(cards_.real(card, 1), cards_.real(card, 2), cards_.real(card, 3)), card.at);
      if (card.any(4, 5)) held_.add(node);
    }
  }

  /// Of other elements of a kind that hexes may have to be.
  void refuse_first(const char* type) {
    DynaCard card;
    if (cards_.next(card, dyna_element)) listing_.refuse(cards_.integer(card, 0, "an element id"), type, card.at);
  }

  /// Beams, masses, springs: how many cards one has is not known here, so lines are not counted.
  void drop(const std::string& name) {
    DynaCard card;
    if (cards_.next(card, dyna_element)) leave_out(name);
  }

  void solids(const std::string& option) {
    const bool quadratic = option == "_H20";
    if (!quadratic && !option.empty() && option != "_ORTHO" && option != "_H8TOH20") {
      if (option == "_H27")
        cursor_.fail_at(cards_.keyword_at(),
                        "*ELEMENT_SOLID_H27 is not read: in which order its middle nodes are is not known here");
      const std::string type = "*ELEMENT_SOLID" + option;
      return refuse_first(type.c_str());
    }
    if (option == "_H8TOH20") listing_.note("*ELEMENT_SOLID_H8TOH20: hexes are read with their 8 nodes");
    if (option == "_ORTHO") listing_.note("directions of materials (*ELEMENT_SOLID_ORTHO) left out");
    DynaCard card;
    while (cards_.next(card, dyna_element)) {
      const char* const at = card.at;
      const std::int64_t element = cards_.integer(card, 0, "an element id");
      const int own_part = part_id(card, 1);
      std::array<std::int64_t, 20> nodes{};
      std::size_t n = 0;
      const auto take = [&](std::size_t from, std::size_t most) {
        for (std::size_t i = from; i < most && n < nodes.size(); ++i) nodes[n++] = cards_.integer(card, i, "a node");
      };
      const auto more = [&] {
        if (cards_.next(card, dyna_element)) return;
        cursor_.fail_at(at, "element " + std::to_string(element) + " has " + std::to_string(n) + " of " +
                                (quadratic ? "20" : "8") + " nodes");
      };
      if (card.filled() > 2) {  // id, part and nodes in one card; of 20 nodes others do so, with more below
        take(2, card.filled());
        while (quadratic && n < 20) {
          more();
          take(0, card.filled());
        }
      } else {
        more();
        take(0, 10);
        if (quadratic) {
          more();
          take(0, 10);
        }
      }
      for (int i = 0; option == "_ORTHO" && i < 2; ++i)
        if (!cards_.next(card, dyna_element))
          cursor_.fail_at(at, "element " + std::to_string(element) + " lacks the directions of its material");
      solid(element, own_part, std::span(nodes).first(quadratic ? 20 : std::min<std::size_t>(n, 10)), at);
    }
  }

  void solid(std::int64_t element, int own_part, std::span<const std::int64_t> nodes, const char* at) {
    std::size_t n = nodes.size();
    while (n > 0 && nodes[n - 1] == 0) --n;
    if (n == 10 && nodes[8] != nodes[7]) listing_.refuse(element, "tetrahedron of 10 nodes", at);
    if (n < 8) {
      if (n == 4) listing_.refuse(element, "tetrahedron", at);
      if (n == 6) listing_.refuse(element, "wedge", at);
      cursor_.fail_at(at, "element " + std::to_string(element) + " has " + std::to_string(n) + " of 8 corners");
    }
    if (const char* type = degenerate_hex(nodes)) listing_.refuse(element, type, at);
    listing_.add_hex(element, own_part, nodes.first(nodes.size() == 20 ? 20 : 8), lsdyna_middles, at);
  }

  /// Quads are sides of hexes by their part; triangles repeat their last node, or leave it out.
  void shells(bool card_more) {
    DynaCard card;
    while (cards_.next(card, dyna_element)) {
      const char* const at = card.at;
      const std::int64_t element = cards_.integer(card, 0, "an element id");
      const int own_part = part_id(card, 1);
      std::array<std::int64_t, 4> nodes{};
      for (std::size_t i = 0; i < 4; ++i) nodes[i] = cards_.integer(card, 2 + i, "a node");
      if (nodes[3] == 0 || nodes[3] == nodes[2])
        listing_.drop(element, "*ELEMENT_SHELL with three corners");
      else
        listing_.add_quad(element, own_part, nodes, at);
      const bool quadratic = card.filled() > 6;
      for (int i = 0; card_more && i < (quadratic ? 2 : 1); ++i)
        if (!cards_.next(card, dyna_set)) return;
    }
  }

  int part_id(const DynaCard& card, std::size_t field) {
    const int id = cards_.id(card, field, "a part");
    highest_part_ = std::max(highest_part_, id);
    return id;
  }

  void part(const std::string& name) {
    std::string title;
    DynaCard card;
    while (cards_.next_title(title) && cards_.next(card, dyna_set)) {
      const int number = part_id(card, 0);
      listing_.name_part(number, title);
      if ((card.any(1, 1) && card[1] != "1") || (card.any(2, 2) && card[2] != "1") || card.any(3, 7) || name != "PART")
        made_of_.add(number);
      if (name != "PART") return;  // of others, cards follow that belong to it
    }
  }

  /// False: a kind that is not read.
  bool set(std::string name) {
    bool titled = false, ranges = false;
    const auto take = [&](std::string_view option, bool& is_there) {
      if (!name.ends_with(option)) return false;
      name.resize(name.size() - option.size());
      return is_there = true;
    };
    while (take("_TITLE", titled) || take("_GENERATE", ranges)) continue;
    const bool column = name == "SET_NODE_COLUMN";
    const bool of_nodes = name == "SET_NODE" || name == "SET_NODE_LIST" || column;
    const bool of_solids = name == "SET_SOLID" || name == "SET_SOLID_LIST";
    const bool of_segments = name == "SET_SEGMENT";
    if ((!of_nodes && !of_solids && !of_segments) || (ranges && of_segments)) return false;
    std::string title;
    DynaCard card;
    if (titled && !cards_.next_title(title)) return true;
    if (!cards_.next(card, dyna_set)) return true;
    Listing::Group& group = listing_.add_group(cards_.id(card, 0, "a set"), title);
    bool attributed = !of_solids && card.any(1, 4);
    while (cards_.next(card, dyna_set)) {
      attributed = attributed || (of_segments && card.any(4, 7)) || (column && card.any(1, 4));
      if (of_segments) {
        std::array<std::int64_t, 4> corners{};
        for (std::size_t i = 0; i < 4; ++i) corners[i] = cards_.integer(card, i, "a node");
        group.quads.push_back(corners);
        continue;
      }
      auto& members = of_nodes ? group.nodes : group.elements;
      auto& spans = of_nodes ? group.node_ranges : group.element_ranges;
      const char* const what = of_nodes ? "a node" : "an element";
      for (std::size_t i = 0; i < (column ? 1 : card.filled()); i += ranges ? 2 : 1) {
        const std::int64_t first = cards_.integer(card, i, what);
        if (first == 0) continue;
        if (ranges)
          spans.emplace_back(first, cards_.integer(card, i + 1, what));
        else
          members.push_back(first);
      }
    }
    if (attributed) attributes_.add(group.id);
    group.hexes_only = group.is_own = true;
    group.has_normals = of_segments;
    if (of_solids) solid_sets_.push_back(&group);
    group.empty_node_set = of_nodes, group.empty_block = of_solids, group.empty_side_set = of_segments;
    return true;
  }

  Cursor cursor_;
  DynaCards cards_;
  Listing listing_;
  bool ours_ = false;
  std::int64_t n_other_ = 0;
  Losses held_, made_of_, attributes_;
  std::vector<std::string> others_;
  std::vector<Listing::Group*> solid_sets_;
  int highest_part_ = 0;
};

}  // namespace

MeshFile read_lsdyna(const Bytes& bytes) {
  return DynaReader(bytes).result();
}

}  // namespace hextwist::io
