// I-deas universal files, .unv: datasets 2411 (nodes; 781 and 15 before it), 2412 (elements) and 2467 (groups; 2477,
// 2452 and 2435 are alike). Source: the descriptions of the datasets by the University of Cincinnati's SDRL.
#include <limits>

#include "hextwist/io/hex_numbers.h"
#include "hextwist/io/unv/systems.h"
#include "hextwist/io/unv/unv_internal.h"

namespace hextwist::io {
namespace {

class UnvReader {
 public:
  explicit UnvReader(const Bytes& bytes) : cursor_(bytes), listing_(cursor_), systems_(cursor_) {}

  MeshFile result() {
    while (cursor_.more()) {
      const char* at = cursor_.at;
      if (cursor_.integer("the mark of a dataset, -1,") != -1)
        cursor_.fail_at(at, "expected -1, the mark of a dataset");
      cursor_.line();
      const int dataset = cursor_.small("the number of a dataset");
      cursor_.line();
      if (dataset == 2411 || dataset == 781 || dataset == 15)
        nodes(dataset == 15);
      else if (dataset == 2412)
        elements();
      else if (dataset == 2467 || dataset == 2477 || dataset == 2452 || dataset == 2435)
        groups(dataset);
      else if (dataset == 2420)
        systems();
      else if (dataset == 18)
        old_systems();
      else if (dataset == 164)
        units();
      else
        skip(dataset);
    }
    if (!skipped_.empty()) listing_.note("left out datasets " + joined(skipped_, ", "));
    listing_.set_format("unv");
    systems_.finish(listing_);
    with_sets_.tell(listing_, "numbers of constraint sets, load sets and the like", "group");
    MeshFile file = listing_.result(false);
    const auto usual = [](Index) { return 1; };
    if (listing_.groups_have_hexes())  // else they are blocks
      add_hex_numbers(file.mesh, unv_property, hex_ids_, properties_, usual);
    add_hex_numbers(file.mesh, unv_material, hex_ids_, materials_, usual);
    return file;
  }

 private:
  /// The next integer. Fields are ten characters wide, so that those of ten digits may touch.
  std::int64_t integer(const char* what) {
    constexpr std::ptrdiff_t width = 10;
    cursor_.skip_blanks();
    const char* stop = cursor_.at;
    while (stop < cursor_.end && !Cursor::blank(*stop)) ++stop;
    if (stop - cursor_.at <= width) return cursor_.integer(what);
    const char* line = cursor_.at;
    while (line > cursor_.begin && line[-1] != '\n') --line;
    const std::string_view field(cursor_.at, static_cast<std::size_t>(width - (cursor_.at - line) % width));
    std::int64_t value = 0;
    if (!integer_in_field(field, value)) return cursor_.integer(what);
    cursor_.at += field.size();
    return value;
  }
  int small(const char* what) {
    const std::int64_t value = integer(what);
    if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max())
      cursor_.fail(std::string(what) + " " + std::to_string(value) + " is too large");
    return static_cast<int>(value);
  }

  /// At the line that ends a dataset, which is taken.
  bool ends() {
    cursor_.skip_blanks();
    const std::string_view rest(cursor_.at, cursor_.left());
    if (rest.empty()) cursor_.fail("the file ends inside of a dataset");
    if (!rest.starts_with("-1")) return false;
    if (rest.size() > 2 && !Cursor::blank(rest[2])) return false;
    // A line of its own: nothing of a dataset begins with -1 and ends there.
    const auto line = rest.substr(0, rest.find('\n'));
    if (trimmed(line) != "-1") return false;
    cursor_.line();
    return true;
  }

  void skip(int dataset) {
    if (dataset != 151) skipped_.push_back(dataset);
    while (!ends()) cursor_.line();
  }

  /// A code and what it means, in words; metres are 1.
  void units() {
    if (ends()) return;
    const int code = small("a code of units");
    const std::string words(trimmed(cursor_.line().substr(0, 20)));
    if (code != 1)
      listing_.note("its units are " + (words.empty() ? "of code " + std::to_string(code) : words) +
                    " (dataset 164): lengths stay as they are");
    while (!ends()) cursor_.line();
  }

  /// in_one_line: dataset 15.
  void nodes(bool in_one_line) {
    while (!ends()) {
      const char* at = cursor_.at;
      const std::int64_t id = integer("a node id");
      const int system = small("a coordinate system"), displacements = small("a coordinate system");
      if (in_one_line)
        small("a colour");
      else
        cursor_.line();
      Vec3 point;
      for (double& x : point) x = cursor_.real("a coordinate");
      cursor_.line();
      listing_.add_node(id, systems_.global(system, id, point, at), at);
      systems_.displacement(displacements, id);
    }
  }

  /// Rows of axes, and one of the origin.
  void systems() {
    if (ends()) return;
    cursor_.line();  // of the part
    cursor_.line();  // its name
    while (!ends()) {
      const int number = small("a coordinate system"), type = small("the type of a coordinate system");
      cursor_.line();
      cursor_.line();
      std::array<Vec3, 4> rows;
      for (Vec3& row : rows)
        for (double& x : row) x = cursor_.real("a number of the matrix of a coordinate system");
      cursor_.line();
      constexpr double rounded = 1e-12;  // of axes that somebody has computed
      bool straight = true;
      for (Index axis = 0; axis < 3; ++axis)
        straight = straight && (rows[static_cast<std::size_t>(axis)] - Vec3::Unit(axis)).norm() <= rounded;
      add_system(number, type, straight, rows[3]);
    }
  }
  /// The origin, a point on the x axis, one in the half of the plane x z.
  void old_systems() {
    while (!ends()) {
      const int number = small("a coordinate system"), type = small("the type of a coordinate system");
      const int reference = small("the reference of a coordinate system");
      cursor_.line();
      cursor_.line();
      std::array<Vec3, 3> points;
      for (Vec3& point : points)
        for (double& x : point) x = cursor_.real("a coordinate");
      cursor_.line();
      const Vec3 x = points[1] - points[0], xz = points[2] - points[0];
      const bool straight = x.x() > 0 && x.y() == 0 && x.z() == 0 && xz.y() == 0 && xz.z() > 0;
      if (reference > 1)
        systems_.add(number, {}, "is defined in another");
      else
        add_system(number, type, straight, points[0]);
    }
  }
  void add_system(int number, int type, bool straight, const Vec3& origin) {
    if (type == 0 && straight) return systems_.add(number, origin, "");
    systems_.add(number, {}, type == 0 ? "is turned" : type == 1 ? "is cylindrical" : "is spherical");
  }

  void elements() {
    while (!ends()) {
      const char* at = cursor_.at;
      const std::int64_t id = integer("an element id");
      const int kind = small("an element's descriptor"), part = small("a physical property");
      const int material = small("a material"), colour = small("a colour");
      const std::size_t n =
          cursor_.check_count(integer("the number of nodes"), 2, "nodes of element " + std::to_string(id));
      cursor_.line();
      // Beams have a line of their own.
      std::string rest = std::to_string(part) + " " + std::to_string(material) + " " + std::to_string(colour);
      if (kind == 11 || (kind >= 21 && kind <= 24)) rest += "|" + std::string(trimmed(cursor_.line()));
      std::vector<std::int64_t> nodes(n);
      for (std::int64_t& node : nodes) node = integer("a node");
      cursor_.line();
      element(id, kind, std::max(part, 0), material, nodes, std::move(rest), at);
    }
  }

  void element(std::int64_t id, int kind, int part, int material, std::vector<std::int64_t>& nodes, std::string rest,
               const char* at) {
    const auto expect = [&](std::size_t n) {
      if (nodes.size() != n)
        cursor_.fail_at(at, "element " + std::to_string(id) + " has " + std::to_string(nodes.size()) +
                                " nodes instead of " + std::to_string(n));
    };
    if (kind == unv_hex || kind == unv_hex_20) {
      hex_ids_.push_back(id);
      properties_.push_back(part);
      materials_.push_back(material);
    }
    if (kind == unv_hex) {
      expect(8);
      return listing_.add_hex(id, part, nodes, vtk_middles, at);
    }
    if (kind == unv_hex_20) {
      expect(20);
      std::array<std::int64_t, 20> sorted{};
      for (std::size_t i = 0; i < 20; ++i) sorted[unv_place[i]] = nodes[i];
      return listing_.add_hex(id, part, sorted, vtk_middles, at);
    }
    for (const UnvOther& other : unv_others) {
      if (kind != other.kind) continue;
      if (other.n_nodes > 0) expect(other.n_nodes);
      std::vector<std::int64_t> sorted = nodes;
      for (std::size_t i = 0; i < other.n_nodes; ++i) sorted[other.place[i]] = nodes[i];
      return listing_.add_other({other.shape, static_cast<int>(other.n_nodes), std::to_string(kind)}, id, part, sorted,
                                std::move(rest), false, at);
    }
    for (const auto& [other, name] : unv_refused)
      if (kind == other) listing_.refuse(id, name, at);
    const bool quad = std::ranges::find(unv_quads, kind) != std::end(unv_quads);
    const bool quad_8 = std::ranges::find(unv_quads_8, kind) != std::end(unv_quads_8);
    if (!quad && !quad_8) return listing_.drop(id, std::to_string(kind));
    expect(quad ? 4 : 8);
    if (quad_8)
      for (std::size_t c = 0; c < 4; ++c) nodes[c] = nodes[2 * c];
    listing_.add_quad(id, part, std::span(nodes).first(4), at);
    if (quad) listing_.keep_quad(std::to_string(kind), std::move(rest));
  }

  void groups(int dataset) {
    while (!ends()) {
      const char* at = cursor_.at;
      const std::int64_t id = integer("a group");
      if (id < 0 || id > std::numeric_limits<int>::max())
        cursor_.fail_at(at, "group " + std::to_string(id) + " is not between 0 and 2147483647");
      bool names_sets = false;
      for (int i = 0; i < 6; ++i) names_sets = integer("a number of the group") != 0 || names_sets;
      if (names_sets) with_sets_.add(id);
      const std::size_t n =
          cursor_.check_count(integer("the number of members"), 4, "members of group " + std::to_string(id));
      cursor_.line();
      Listing::Group& group = listing_.add_group(static_cast<int>(id), std::string(trimmed(cursor_.line())));
      for (std::size_t i = 0; i < n; ++i) {
        const int type = small("the type of a member");
        const std::int64_t tag = integer("a member");
        for (int k = 0; k < (dataset == 2435 ? 0 : 2); ++k) integer("a number of the member");
        if (type == 7) group.nodes.push_back(tag);
        if (type == 8) group.elements.push_back(tag);
        if (type != 7 && type != 8 && n_strange_++ == 0)
          listing_.note("group " + std::to_string(id) + " has members of type " + std::to_string(type) +
                        ", which are neither nodes nor elements: left out");
      }
      if (n > 0) cursor_.line();
      if (n > 0) continue;
      group.empty_block = generated_id(group.name, "block") >= 0;
      group.empty_node_set = generated_id(group.name, "nodeset") >= 0;
      group.empty_side_set = generated_id(group.name, "sideset") >= 0;
      if (!group.empty_block && !group.empty_node_set && !group.empty_side_set)
        listing_.note("group " + std::to_string(id) + " '" + group.name + "' is empty: left out");
    }
  }

  Cursor cursor_;
  Listing listing_;
  UnvSystems systems_;
  Losses with_sets_;
  std::vector<std::int64_t> hex_ids_;
  std::vector<int> properties_, materials_;  // of hexes
  std::vector<int> skipped_;
  int n_strange_ = 0;
};

}  // namespace

MeshFile read_unv(const Bytes& bytes) {
  return UnvReader(bytes).result();
}

}  // namespace hextwist::io
