// ANSYS archives, .cdb: NBLOCK, EBLOCK, CMBLOCK, and which types of elements there are.
#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "hextwist/io/ansys/ansys_internal.h"
#include "hextwist/io/hex_numbers.h"

namespace hextwist::io {
namespace {

constexpr int ansys_hexes[] = {5,   30,  45,  46,  62,  64,  65,  69,  70,  73,  80,  89,  90,  95,  96,  97,  107, 117,
                               120, 122, 147, 162, 164, 185, 186, 190, 191, 215, 220, 226, 231, 236, 239, 278, 279};
constexpr int ansys_quads[] = {28, 41, 43, 57, 63, 93, 99, 131, 132, 143, 152, 154, 157, 163, 181, 281};
constexpr int ansys_tetrahedra[] = {72, 87, 92, 98, 119, 123, 148, 168, 187, 221, 227, 232, 237, 240, 285, 291};

bool starts_with_letter(std::string_view line) {
  return !line.empty() && std::isalpha(static_cast<unsigned char>(line.front()));
}

class AnsysReader {
 public:
  explicit AnsysReader(const Bytes& bytes) : cursor_(bytes), listing_(cursor_) {}

  MeshFile result() {
    while (cursor_.at < cursor_.end) {
      at_ = cursor_.at;
      const std::string_view line = trimmed(cursor_.line());
      if (line.starts_with('!')) {
        comment(line);
        continue;
      }
      if (!starts_with_letter(line) && !line.starts_with('/') && !line.starts_with('*')) continue;
      command(line);
    }
    if (n_blocks_ == 0) cursor_.fail_at(cursor_.end, "there is no EBLOCK in the file");
    elements();
    groups();
    if (n_others_ > 0)
      listing_.note(counted(n_others_, "other command") + " left out (the first: " + first_other_ + ")");
    turned_.tell(listing_, "directions of degrees of freedom (rotations in NBLOCK)", "node");
    if (n_empty_ > 0)
      listing_.note(counted(n_empty_, "empty component") + " left out (the first: " + first_empty_ + ")");
    if (n_geometric_ > 0)
      listing_.note(counted(n_geometric_, "component") +
                    " of points, lines, areas or volumes of a model left out (the first: " + first_geometric_ + ")");
    MeshFile file = listing_.result(false);
    columns(file.mesh);
    return file;
  }

 private:
  /// Words between commas, in upper case but for what is not a keyword.
  void split(std::string_view line) {
    words_.clear();
    for (bool more = true; more;) {
      const auto comma = line.find(',');
      words_.push_back(trimmed(line.substr(0, comma)));
      more = comma != std::string_view::npos;
      if (more) line.remove_prefix(comma + 1);
    }
  }
  std::string_view word(std::size_t i) const { return i < words_.size() ? words_[i] : std::string_view(); }
  std::int64_t integer(std::string_view text, const char* what) const {
    std::int64_t value = 0;
    if (!integer_in_field(text, value))
      cursor_.fail_at(at_, "expected " + std::string(what) + ", found " + shown(text));
    return value;
  }
  int small(std::string_view text, const char* what) const {
    const std::int64_t value = integer(text, what);
    if (value < 0 || value > std::numeric_limits<int>::max())
      cursor_.fail_at(at_, std::string(what) + " " + std::to_string(value) + " is not between 0 and 2147483647");
    return static_cast<int>(value);
  }

  void command(std::string_view line) {
    split(line.substr(0, line.find('!')));
    const std::string_view name = word(0);
    if (same_word(name, "ET")) return type(small(word(1), "a number of a type"), word(2));
    if (same_word(name, "ETBLOCK")) return types();
    if (same_word(name, "NBLOCK")) return nodes();
    if (same_word(name, "EBLOCK")) return element_block();
    if (same_word(name, "CMBLOCK")) return component();
    if (same_word(name, "EN") || same_word(name, "E") || same_word(name, "N"))
      cursor_.fail_at(at_,
                      "nodes and elements are read from NBLOCK and EBLOCK only: write the file with CDWRITE and "
                      "its option BLOCKED");
    if (same_word(name, "/INPUT") || same_word(name, "CDREAD"))
      cursor_.fail_at(at_, std::string(name) + " is not followed: nodes or elements would be missing");
    if (same_word(name, "KEYOP") || same_word(name, "KEYOPT")) {
      std::int64_t of = 0, value = 0;
      if (integer_in_field(word(1), of) && (!integer_in_field(word(3), value) || value != 0))
        options_.try_emplace(of, line.substr(0, 40));
      return;
    }
    if (line.starts_with('/') || same_word(name, "FINISH") || same_word(name, "NUMOFF") || same_word(name, "*SET") ||
        same_word(name, "SHPP"))
      return;
    if (n_others_++ == 0) first_other_ = std::string(name.substr(0, 30));
  }

  void type(int number, std::string_view name) {
    while (starts_with_letter(name)) name.remove_prefix(1);
    type_of_[number] = small(name, "a type of elements");
  }

  /// The next line of a block; false at its end, which is a line "-1", or at the end of the file.
  bool row(std::string_view& line) {
    if (cursor_.at == cursor_.end) return false;
    at_ = cursor_.at;
    line = cursor_.line();
    return trimmed(line) != "-1";
  }
  /// Throws Error at the end of the file.
  std::string_view row_of(const char* block) {
    std::string_view line;
    if (cursor_.at == cursor_.end) cursor_.fail("the file ends inside of " + std::string(block));
    row(line);
    return line;
  }

  AnsysFormat format(const char* block) {
    const std::string text = lower_case(trimmed(row_of(block)));
    AnsysFormat result;
    const auto wrong = [&] {
      cursor_.fail_at(at_, "expected the format of " + std::string(block) + ", like (19i9), found " + shown(text));
    };
    if (!text.starts_with('(') || !text.ends_with(')')) wrong();
    const char* at = text.data() + 1;
    const char* const end = text.data() + text.size() - 1;
    while (at < end) {
      std::size_t n = 1, width = 0;
      if (std::isdigit(static_cast<unsigned char>(*at))) at = std::from_chars(at, end, n).ptr;
      const char kind = at < end ? *at++ : ' ';
      at = std::from_chars(at, end, width).ptr;
      while (at < end && *at != ',') ++at;
      at += at < end;
      if (n < 1 || n > 100 || width < 1 || width > 100) wrong();
      if (kind == 'i' && result.n_reals == 0) {
        result.n_integers = n;
        result.integer_width = width;
      } else if ((kind == 'e' || kind == 'f' || kind == 'g' || kind == 'd') && result.n_reals == 0) {
        result.n_reals = n;
        result.real_width = width;
      } else if (kind != 'a') {
        wrong();
      }
    }
    if (result.n_integers == 0) wrong();
    return result;
  }
  static std::string_view field(std::string_view line, std::size_t from, std::size_t width) {
    return from < line.size() ? line.substr(from, width) : std::string_view();
  }

  void types() {
    const AnsysFormat fields = format("ETBLOCK");
    std::string_view line;
    while (row(line))
      type_of_[small(field(line, 0, fields.integer_width), "a number of a type")] =
          small(field(line, fields.integer_width, fields.integer_width), "a type of elements");
  }

  void nodes() {
    const AnsysFormat fields = format("NBLOCK");
    if (fields.n_reals < 3) cursor_.fail_at(at_, "the format of NBLOCK has no three coordinates");
    const std::size_t first = fields.n_integers * fields.integer_width;
    for (std::string_view line = row_of("NBLOCK"); trimmed(line) != "-1"; line = row_of("NBLOCK")) {
      if (starts_with_letter(trimmed(line))) return;  // N,R5.3,LOC,-1
      Vec3 point = Vec3::Zero();
      const std::int64_t id = integer(field(line, 0, fields.integer_width), "a node id");
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::string_view text = field(line, first + axis * fields.real_width, fields.real_width);
        if (!real_in_field(text, point[static_cast<Index>(axis)]))
          cursor_.fail_at(
              at_, "node " + std::to_string(id) + " has " + shown(trimmed(text)) + " where a coordinate should stand");
      }
      for (std::size_t i = 3; i < std::min<std::size_t>(6, fields.n_reals); ++i) {
        double angle = 0;
        if (real_in_field(field(line, first + i * fields.real_width, fields.real_width), angle) && angle == 0) continue;
        turned_.add(id);
        break;
      }
      listing_.add_node(id, point, at_);
    }
  }

  /// Kept until the types are known.
  struct Element {
    std::int64_t id;
    int type;
    std::array<int, 4> columns;  ///< as ansys_columns
    std::size_t first, n;        ///< of nodes_
    const char* at;
  };

  void element_block() {
    ++n_blocks_;
    const bool solid = same_word(word(2), "SOLID");
    const AnsysFormat fields = format("EBLOCK");
    if (!solid) {
      // Another layout, for contacts and loads on surfaces; what type they are of stands elsewhere.
      for (std::string_view line = row_of("EBLOCK"); trimmed(line) != "-1"; line = row_of("EBLOCK")) ++n_unnamed_;
      return;
    }
    std::int64_t next_id = 1;
    const std::size_t width = fields.integer_width;
    for (std::string_view line = row_of("EBLOCK"); trimmed(line) != "-1"; line = row_of("EBLOCK")) {
      const auto number = [&](std::size_t i, const char* what) { return integer(field(line, i * width, width), what); };
      Element element{
          number(10, "an element id"),
          small(field(line, width, width), "a type"),
          {small(field(line, 0, width), "a material"), small(field(line, 2 * width, width), "real constants"),
           small(field(line, 3 * width, width), "a section"),
           small(field(line, 4 * width, width), "a coordinate system")},
          nodes_.size(),
          0,
          at_};
      if (element.id == 0) element.id = next_id;
      next_id = element.id + 1;
      const std::int64_t n = number(8, "a number of nodes");
      if (n < 1 || n > 27)
        cursor_.fail_at(at_, "element " + std::to_string(element.id) + " has " + std::to_string(n) + " nodes");
      element.n = static_cast<std::size_t>(n);
      for (std::size_t i = 0, column = 11; i < element.n; ++i, ++column) {
        if (column == fields.n_integers) {
          line = row_of("EBLOCK");
          column = 0;
        }
        nodes_.push_back(number(column, "a node"));
      }
      elements_.push_back(element);
    }
  }

  void elements() {
    // Bodies differ by material; where all are of one, by the type of their elements.
    const Element* first = nullptr;
    bool materials_differ = false, types_differ = false;
    for (const Element& element : elements_) {
      if (shape(element) != AnsysShape::hex) continue;
      if (!first) first = &element;
      materials_differ = materials_differ || first->columns[0] != element.columns[0];
      types_differ = types_differ || first->type != element.type;
    }
    const bool by_type = types_differ && !materials_differ;
    std::set<int> types;
    for (const Element& element : elements_)
      if (shape(element) == AnsysShape::hex) types.insert(element.type);
    say_types(types);
    for (const Element& element : elements_) {
      const std::span nodes = std::span(nodes_).subspan(element.first, element.n);
      switch (shape(element)) {
        case AnsysShape::hex:
          hex(element, by_type ? element.type : element.columns[0], nodes);
          break;
        case AnsysShape::tetrahedron:
          listing_.refuse(element.id, "tetrahedron", element.at);
        case AnsysShape::quad:
          if (element.n >= 4 && nodes[2] != nodes[3]) {
            listing_.add_quad(element.id, element.type, nodes, element.at);
            break;
          }
          [[fallthrough]];
        case AnsysShape::other:
          listing_.drop(element.id, type_text(element));
      }
    }
    if (n_unnamed_ > 0)
      listing_.note("left out " + counted(n_unnamed_, "line") + " of EBLOCK without SOLID, which say no type");
  }

  /// Hexes are written as of one type, SOLID185 or SOLID186, without key options.
  void say_types(const std::set<int>& of_hexes) {
    std::set<std::string> others;
    for (const int type : of_hexes)
      if (const auto found = type_of_.find(type);
          found != type_of_.end() && found->second != ansys_solid_8 && found->second != ansys_solid_20)
        others.insert("SOLID" + std::to_string(found->second));
    if (!others.empty())
      listing_.note("hexes of type " + joined(std::vector(others.begin(), others.end()), ", ") +
                    " are SOLID185 or SOLID186 when they are written");
    if (of_hexes.size() > 1)
      listing_.note("hexes of " + std::to_string(of_hexes.size()) + " types are of one when they are written");
    std::erase_if(options_, [&](const auto& option) { return !of_hexes.contains(static_cast<int>(option.first)); });
    if (!options_.empty())
      listing_.note("key options of " + counted(std::ssize(options_), "type") +
                    " of hexes left out (the first: " + std::string(options_.begin()->second) + ")");
  }

  /// What hexes have that is neither their block nor what they would be written with anyway.
  void columns(Mesh& mesh) const {
    std::vector<std::int64_t> ids;
    std::array<std::vector<int>, 4> numbers;
    for (const Element& element : elements_) {
      if (shape(element) != AnsysShape::hex) continue;
      ids.push_back(element.id);
      for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i].push_back(element.columns[i]);
    }
    const AnsysMaterials materials = ansys_materials(mesh);
    add_hex_numbers(mesh, ansys_columns[0], ids, numbers[0], [&](Index h) { return materials.of_hex[h]; });
    for (std::size_t i = 1; i < numbers.size(); ++i)
      add_hex_numbers(mesh, ansys_columns[i], ids, numbers[i], [&](Index) { return i < 3 ? 1 : 0; });
  }

  /// Of a type that was not defined, by the number of nodes.
  AnsysShape shape(const Element& element) const {
    const auto found = type_of_.find(element.type);
    if (found != type_of_.end()) return ansys_shape(found->second);
    if (element.n == 8 || element.n == 20) return AnsysShape::hex;
    return element.n == 10 ? AnsysShape::tetrahedron : AnsysShape::other;
  }
  std::string type_text(const Element& element) const {
    const auto found = type_of_.find(element.type);
    return found == type_of_.end() ? "unknown" : std::to_string(found->second);
  }

  void hex(const Element& element, int part, std::span<const std::int64_t> nodes) {
    if (nodes.size() != 8 && nodes.size() != 20)
      cursor_.fail_at(element.at, "element " + std::to_string(element.id) + " has " + std::to_string(nodes.size()) +
                                      " nodes, where a hex has 8 or 20");
    if (const char* type = degenerate_hex(nodes)) listing_.refuse(element.id, type, element.at);
    listing_.add_hex(element.id, part, nodes, ansys_middles, element.at);
  }

  void component() {
    if (std::ranges::any_of(std::array{"KP", "LINE", "AREA", "VOLU"},
                            [&](const char* kind) { return same_word(word(2).substr(0, 4), kind); })) {
      if (n_geometric_++ == 0) first_geometric_ = std::string(word(1));
      const std::size_t n = cursor_.check_count(integer(word(3), "a number of members"), 1, "members of a component");
      const std::size_t in_line = std::max<std::size_t>(format("CMBLOCK").n_integers, 1);
      for (std::size_t i = 0; i < n; i += in_line) row_of("CMBLOCK");
      return;
    }
    Listing::Group& group = listing_.add_group(0, std::string(word(1)));
    const bool of_nodes = word(2).size() >= 4 && same_word(word(2).substr(0, 4), "NODE");
    if (!of_nodes && !(word(2).size() >= 4 && same_word(word(2).substr(0, 4), "ELEM")))
      cursor_.fail_at(at_, "component " + shown(word(1)) + " is neither of nodes nor of elements");
    const std::int64_t n = integer(word(3), "a number of members");
    const std::size_t size = cursor_.check_count(n, 1, "members of component " + group.name);
    if (size == 0) {
      if (n_empty_++ == 0) first_empty_ = group.name;
    }
    const AnsysFormat fields = format("CMBLOCK");
    auto& members = of_nodes ? group.nodes : group.elements;
    auto& ranges = of_nodes ? group.node_ranges : group.element_ranges;
    std::string_view line;
    std::int64_t last = 0;
    for (std::size_t i = 0, column = fields.n_integers; i < size; ++i, ++column) {
      if (column == fields.n_integers) {
        line = row_of("CMBLOCK");
        column = 0;
      }
      const std::int64_t member = integer(field(line, column * fields.integer_width, fields.integer_width), "a member");
      if (member > 0) {
        members.push_back(last = member);
      } else if (last > 0 && member < -last) {  // up to there
        ranges.emplace_back(last + 1, -member);
        last = 0;
      } else {
        cursor_.fail_at(
            at_, "component " + group.name + " has the member " + std::to_string(member) + ", which ends no range");
      }
    }
    names_.push_back({&group, of_nodes, comment_});
    comment_ = {};
  }

  /// Of our own: "! hextwist sideset 3 name", of the component that follows.
  struct OwnName {
    std::string kind;
    int id = -1;
    std::string name;
  };
  void comment(std::string_view text) {
    constexpr std::string_view mark = "! hextwist ";
    if (!text.starts_with(mark)) return;
    text.remove_prefix(mark.size());
    OwnName own;
    own.kind = std::string(text.substr(0, text.find(' ')));
    if (own.kind != "block" && own.kind != "nodeset" && own.kind != "sideset") return;
    text.remove_prefix(std::min(own.kind.size() + 1, text.size()));
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), own.id);
    if (error != std::errc{} || own.id < 0) cursor_.fail_at(at_, own.kind + " without an id between 0 and 2147483647");
    text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
    own.name = std::string(trimmed(text));
    comment_ = own;
  }

  /// Those that we named have their ids; others are numbered as they come, above all those.
  void groups() {
    int next = 0;
    for (const Component& component : names_) next = std::max(next, component.own.id);
    for (const Component& component : names_) {
      Listing::Group& group = *component.group;
      if (component.own.id >= 0) {
        group.id = component.own.id;
        group.name = component.own.name;
        group.is_own = true;
      } else {
        if (next == std::numeric_limits<int>::max()) cursor_.fail_at(cursor_.end, "there are too many components");
        group.id = ++next;
      }
    }
  }

  struct Component {
    Listing::Group* group;
    bool of_nodes;
    OwnName own;
  };

  Cursor cursor_;
  Listing listing_;
  const char* at_ = nullptr;
  std::vector<std::string_view> words_;
  std::map<int, int> type_of_;                        // SOLID185, by the number that elements name
  std::map<std::int64_t, std::string_view> options_;  // the first that is not 0, by the same
  std::vector<Element> elements_;
  std::vector<std::int64_t> nodes_;
  std::vector<Component> names_;
  OwnName comment_;
  std::int64_t n_blocks_ = 0, n_unnamed_ = 0, n_others_ = 0, n_empty_ = 0, n_geometric_ = 0;
  std::string first_other_, first_empty_, first_geometric_;
  Losses turned_;
};

}  // namespace

AnsysShape ansys_shape(int type) {
  if (std::ranges::find(ansys_hexes, type) != std::end(ansys_hexes)) return AnsysShape::hex;
  if (std::ranges::find(ansys_quads, type) != std::end(ansys_quads)) return AnsysShape::quad;
  if (std::ranges::find(ansys_tetrahedra, type) != std::end(ansys_tetrahedra)) return AnsysShape::tetrahedron;
  return AnsysShape::other;
}

MeshFile read_ansys(const Bytes& bytes) {
  return AnsysReader(bytes).result();
}

}  // namespace hextwist::io
