// Nastran .bdf: GRID, CHEXA, elements beside them, PLOAD4 and SET1. Properties are blocks.
#include <limits>
#include <map>
#include <set>

#include "hextwist/base/text.h"
#include "hextwist/io/nastran/nastran_internal.h"
#include "hextwist/io/nastran/others.h"

namespace hextwist::io {
namespace {

/// Elements that have no place here.
constexpr std::string_view dropped[] = {"CQUAD", "RBE3", "RBE1", "RSPLINE", "CELAS3", "CELAS4", "CDAMP3", "CMASS3"};

class NastranReader {
 public:
  explicit NastranReader(const Bytes& bytes) : cursor_(bytes), listing_(cursor_) {}

  MeshFile result() {
    to_bulk_data();
    NastranCards cards(cursor_);
    while (!ended_) {
      const NastranCard card = cards.next([&](std::string_view text, const char* at) { comment(text, at); });
      if (card.name.empty()) break;
      read(card);
    }
    if (!ended_ && had_bulk_) cursor_.fail_at(cursor_.end, "the file ends before ENDDATA");
    if (!ended_) listing_.note(cursor_.where(cursor_.end) + ": there is no ENDDATA; the file may be cut short");
    groups();
    listing_.set_format("nastran");
    defaults();
    left_out(cards.overfull());
    if (n_other_ > 0) listing_.note(counted(n_other_, "other card") + " left out (the first: " + first_other_ + ")");
    return listing_.result(true);
  }

 private:
  /// Behind the executive and case control sections, where the file has them.
  void to_bulk_data() {
    const char* start = cursor_.at;
    std::int64_t n = 0;
    std::string first;
    while (cursor_.at < cursor_.end) {
      const std::string_view text = trimmed(cursor_.line());
      const std::string line = lower_case(text);
      if (line.starts_with("begin") && line.find("bulk") != std::string::npos) {
        had_bulk_ = true;
        if (n > 0)
          listing_.note(counted(n, "line") + " of executive and case control left out (the first: " + first + ")");
        return;
      }
      if (!line.empty() && line[0] != '$' && n++ == 0) first = shown(text);
    }
    cursor_.at = start;
  }

  std::int64_t integer(const NastranCard& card, std::size_t field, const char* what, bool may_be_blank = false) const {
    const std::string& text = card[field];
    std::int64_t value = 0;
    if ((text.empty() && !may_be_blank) || !integer_in_field(text, value))
      cursor_.fail_at(
          card.at, card.name + " has " + (text.empty() ? "nothing" : shown(text)) + " where " + what + " should stand");
    return value;
  }
  int id(const NastranCard& card, std::size_t field, const char* what) const {
    const std::int64_t value = integer(card, field, what);
    if (value < 0 || value > std::numeric_limits<int>::max())
      cursor_.fail_at(card.at, std::string(what) + " " + std::to_string(value) + " is not between 0 and 2147483647");
    return static_cast<int>(value);
  }
  /// "1.5", "1.5E-3", "1.5D-3", "1.5-3"; blank is 0.
  double real(const NastranCard& card, std::size_t field) const {
    double value = 0;
    if (!real_in_field(card[field], value))
      cursor_.fail_at(card.at, card.name + " has " + shown(card[field]) + " where a number should stand");
    return value;
  }

  void read(const NastranCard& card) {
    if (card.name == "GRID") return grid(card);
    if (card.name == "CHEXA") return hex(card);
    if (const NastranOther* other = nastran_other(card.name)) return beside(card, *other);
    if (card.name == "PLOAD4") return pressure(card);
    if (card.name == "SET1") return set(card);
    if (card.name == "ENDDATA") {
      ended_ = true;
      return;
    }
    if (card.name == "INCLUDE" || card.name.starts_with("INCLUDE"))
      cursor_.fail_at(card.at, "INCLUDE is not supported: nodes or elements would be missing");
    if (std::ranges::find(dropped, card.name) != std::end(dropped))
      return listing_.drop(integer(card, 0, "an element id"), card.name);
    if (card.name == "GRDSET") {
      defaults_ = card;
      return;
    }
    if (card.name == "PSOLID") return solid(card);
    if (n_other_++ == 0) first_other_ = card.name;
  }

  void grid(const NastranCard& card) {
    const std::int64_t node = integer(card, 0, "a node id");
    if (card[1].empty() && !without_system_.at)
      without_system_ = {node, card.at};
    else if (const std::int64_t system = integer(card, 1, "a coordinate system", true); system != 0)
      refuse_system(node, system, card.at, "");
    for (std::size_t i = 0; i < 3; ++i) {
      if (card[5 + i].empty())
        blank_[i].add(node);
      else if (says_something(card[5 + i]))
        lost_[i].add(node);
    }
    listing_.add_node(node, Vec3(real(card, 2), real(card, 3), real(card, 4)), card.at);
  }
  static bool says_something(const std::string& field) { return field.find_first_not_of('0') != std::string::npos; }
  [[noreturn]] void refuse_system(std::int64_t node, std::int64_t system, const char* at,
                                  const std::string& why) const {
    cursor_.fail_at(at, "node " + std::to_string(node) + " is in coordinate system " + std::to_string(system) + why +
                            "; only the basic one (0) is read");
  }

  /// What blank fields of nodes are, and what is left out of what nodes say.
  void defaults() {
    if (const std::int64_t system = integer(defaults_, 1, "a coordinate system", true); system != 0)
      if (without_system_.at) refuse_system(without_system_.node, system, without_system_.at, " by GRDSET");
    constexpr std::array what = {"coordinate systems of displacements (CD)", "constraints (PS)",
                                 "superelements (SEID)"};
    for (std::size_t i = 0; i < what.size(); ++i) {
      if (says_something(defaults_[5 + i])) lost_[i].add(blank_[i]);
      lost_[i].tell(listing_, what[i], "node");
    }
    const auto tell = [&](std::int64_t n, const char* kind, const std::string& first, const char* why) {
      if (n > 0) listing_.note(counted(n, kind) + " " + why + " (the first: " + first + ")");
    };
    tell(n_tied_, "RBE2", first_tied_, "with nodes named one by one: those that a refinement adds are not among them");
    tell(n_turned_, "material angle", first_turned_,
         "counted from the first edge, which is another one in pieces of a transition");
    tell(n_pressures_, "PLOAD4", first_pressure_,
         "with another pressure than 1 all over: the sides are kept, not the pressure");
    tell(n_solids_, "PSOLID", first_solid_, "with another material than 1, or more: the properties are kept alone");
  }

  /// Its name is a comment, as all of the kind.
  void solid(const NastranCard& card) {
    bool usual = card[1] == "1";
    for (std::size_t i = 2; i < card.fields.size(); ++i) usual = usual && !says_something(card[i]);
    if (!usual && n_solids_++ == 0) first_solid_ = card[0];
  }

  void left_out(const NastranCards::Overfull& overfull) {
    if (overfull.n == 0) return;
    listing_.note(cursor_.where(overfull.at) + ": " + overfull.name + " has " + shown(overfull.text) +
                  " behind its last field, where the mark of a continuation stands, and none follows: left out" +
                  (overfull.n > 1 ? " (the first of " + std::to_string(overfull.n) + " such cards)" : ""));
  }

  void hex(const NastranCard& card) {
    const std::int64_t element = integer(card, 0, "an element id");
    std::vector<std::int64_t> nodes;
    for (std::size_t i = 0; i < 20; ++i) {
      if (i < 8 && card[2 + i].empty())
        cursor_.fail_at(card.at, "element " + std::to_string(element) + " has " + std::to_string(i) + " of 8 corners");
      nodes.push_back(integer(card, 2 + i, "a node", i >= 8));
    }
    const int part = card[1].empty() ? 0 : id(card, 1, "a property");
    parts_of_hexes_.insert(part);
    listing_.add_hex(element, part, nodes, nastran_middles, card.at);
  }

  /// Kept with all its fields.
  void beside(const NastranCard& card, const NastranOther& of) {
    const std::int64_t element = integer(card, 0, "an element id");
    int part = of.property == 0 || card[of.property].empty() ? 0 : id(card, of.property, "a property");
    if (const auto found = block_of_other_.find(element); found != block_of_other_.end() && part == 0)
      part = found->second;
    std::vector<std::int64_t> nodes;
    std::size_t n = of.n_nodes[0];
    if (of.shape == OtherShape::connector) {
      for (const std::size_t field : nastran_node_fields(card)) nodes.push_back(integer(card, field, "a node"));
      n = 0;
    } else {
      for (std::size_t i = of.n_nodes[0]; i < of.n_nodes[1]; ++i)
        if (!card[of.first + i].empty()) n = of.n_nodes[1];
      nodes.resize(n);
      for (std::size_t i = 0; i < n; ++i) nodes[i] = integer(card, of.first + nastran_place(of, n, i), "a node");
      // A node that says how a bar is turned stands where the first number of a vector may.
      const bool turned = (of.name == "CBAR" || of.name == "CBEAM") && card[4].find('.') == std::string::npos &&
                          !card[4].empty() && card[5].empty() && card[6].empty();
      if (turned) nodes.push_back(integer(card, 4, "a node"));
    }
    if (of.name == "RBE2" && nodes.size() > 2 && n_tied_++ == 0) first_tied_ = card[0];
    const std::size_t angle = of.first + of.n_nodes[0];
    if ((of.name == "CQUAD4" || of.name == "CQUADR" || of.name == "CTRIA3" || of.name == "CTRIAR") &&
        card[angle].find_first_not_of("0.+- ") != std::string::npos && card[angle].find('.') != std::string::npos &&
        n_turned_++ == 0)
      first_turned_ = std::string(of.name) + " " + card[0];
    const OtherType type{of.shape, static_cast<int>(n), std::string(of.name)};
    listing_.add_other(type, element, part, nodes, joined(card.fields, ","), is_rigid_card(card), card.at);
  }

  /// On a face of a solid, which two opposite corners name. Those on shells are no side of a hex by themselves.
  void pressure(const NastranCard& card) {
    if (card[6].empty() || card[7].empty() || same_word(card[6], "THRU")) {
      if (n_other_++ == 0) first_other_ = card.name;
      return;
    }
    bool usual = real(card, 2) == 1;
    for (std::size_t i = 3; i < card.fields.size(); ++i)
      if (i < 6 ? !card[i].empty() && real(card, i) != 1 : i > 7 && says_something(card[i])) usual = false;
    if (!usual && n_pressures_++ == 0)
      first_pressure_ = "set " + card[0] + ", element " + card[1] + ", " + shown(card[2]);
    side_sets_[id(card, 0, "a set")].push_back(
        {integer(card, 1, "an element"), {integer(card, 6, "a node"), integer(card, 7, "a node")}});
  }

  void set(const NastranCard& card) {
    std::vector<std::int64_t>& nodes = node_sets_[id(card, 0, "a set")];
    for (std::size_t i = 1; i < card.fields.size(); ++i) {
      if (card[i].empty()) continue;
      if (!same_word(card[i], "THRU")) {
        nodes.push_back(integer(card, i, "a node"));
        continue;
      }
      const std::int64_t last = integer(card, i + 1, "a node");
      if (i == 1 || last < nodes.back() || last - nodes.back() > static_cast<std::int64_t>(cursor_.end - cursor_.begin))
        cursor_.fail_at(card.at, "SET1 has a range that cannot be");
      while (nodes.back() < last) nodes.push_back(nodes.back() + 1);
      ++i;
    }
  }

  /// Of our own: "$ hextwist block 3 name", "$ hextwist others 3 101 102".
  void comment(std::string_view text, const char* at) {
    constexpr std::string_view mark = "$ hextwist ";
    if (!text.starts_with(mark)) return;
    text = trimmed(text.substr(mark.size()));
    const auto word = text.substr(0, text.find(' '));
    if (word != "block" && word != "nodeset" && word != "sideset" && word != "others") return;
    std::string_view rest = text.substr(std::min(word.size() + 1, text.size()));
    int group = 0;
    const auto [stop, error] = std::from_chars(rest.data(), rest.data() + rest.size(), group);
    if (error != std::errc{} || group < 0)
      cursor_.fail_at(at, std::string(word) + " without an id between 0 and 2147483647");
    rest.remove_prefix(static_cast<std::size_t>(stop - rest.data()));
    if (word == "others") {  // of block 2: their ids
      while (!(rest = trimmed(rest)).empty()) {
        std::int64_t element = 0;
        const auto [end, wrong] = std::from_chars(rest.data(), rest.data() + rest.size(), element);
        if (wrong != std::errc{}) cursor_.fail_at(at, "expected an element id, found " + shown(rest));
        block_of_other_[element] = group;
        rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
      }
      return;
    }
    names_[{std::string(word), group}] = std::string(trimmed(rest));
    if (word == "block") listing_.name_part(group, std::string(trimmed(rest)));
  }

  void groups() {
    const auto name = [&](const char* kind, int group) {
      const auto found = names_.find({kind, group});
      return found == names_.end() ? "" : found->second;
    };
    // Our comments tell of empty ones too.
    for (const auto& [which, text] : names_) {
      if (which.first == "nodeset") node_sets_[which.second];
      if (which.first == "sideset") side_sets_[which.second];
      if (which.first == "block" && !parts_of_hexes_.contains(which.second)) {
        Listing::Group& empty = listing_.add_group(which.second, text);
        empty.is_own = empty.empty_block = true;
      }
    }
    for (auto& [group, nodes] : node_sets_) {
      Listing::Group& set = listing_.add_group(group, name("nodeset", group));
      set.is_own = set.empty_node_set = true;
      set.nodes = std::move(nodes);
    }
    for (auto& [group, sides] : side_sets_) {
      Listing::Group& set = listing_.add_group(group, name("sideset", group));
      set.is_own = set.empty_side_set = true;
      set.opposite = std::move(sides);
    }
  }

  Cursor cursor_;
  Listing listing_;
  std::map<int, std::vector<std::int64_t>> node_sets_;
  std::map<int, std::vector<std::pair<std::int64_t, std::array<std::int64_t, 2>>>> side_sets_;
  std::map<std::pair<std::string, int>, std::string> names_;
  std::set<int> parts_of_hexes_;
  std::map<std::int64_t, int> block_of_other_;  // of elements without a property, by our comments
  std::int64_t n_other_ = 0, n_pressures_ = 0, n_solids_ = 0, n_tied_ = 0, n_turned_ = 0;
  std::string first_tied_, first_turned_;
  std::string first_pressure_, first_solid_;
  NastranCard defaults_{"GRDSET", {}, nullptr};
  struct {
    std::int64_t node = 0;
    const char* at = nullptr;
  } without_system_;                    // the first node that leaves it to GRDSET
  std::array<Losses, 3> lost_, blank_;  // of CD, PS, SEID
  std::string first_other_;
  bool ended_ = false, had_bulk_ = false;
};

}  // namespace

MeshFile read_nastran(const Bytes& bytes) {
  return NastranReader(bytes).result();
}

}  // namespace hextwist::io
