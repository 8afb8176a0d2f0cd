// MFEM's mesh files, v1.0 to v1.3, text: attributes are blocks and side sets, nodes of degree 2 the middle nodes.
#include <set>

#include "hextwist/base/sorted.h"
#include "hextwist/io/mfem/mfem_internal.h"

namespace hextwist::io {
namespace {

class MfemReader {
 public:
  explicit MfemReader(const Bytes& bytes) : cursor_(bytes) {}

  MeshFile result() {
    header();
    keyword("dimension");
    if (const int dimension = cursor_.small("a dimension"); dimension != 3)
      cursor_.fail("dimension " + std::to_string(dimension) + " instead of 3");
    keyword("elements");
    elements(true);
    if (sets_) keyword("attribute_sets"), named_sets(block_names_);
    keyword("boundary");
    elements(false);
    if (sets_) keyword("bdr_attribute_sets"), named_sets(side_names_);
    keyword("vertices");
    const std::size_t n = cursor_.check_count(cursor_.integer("a number of vertices"), 1, "vertices");
    n_vertices_ = static_cast<Index>(n);
    if (hexes_.empty()) cursor_.fail_at(cursor_.end, "there is no hex in the file");
    corners();
    comments();
    if (Cursor ahead = cursor_; ahead.word() == "nodes") {
      cursor_ = ahead;
      nodes();
    } else {
      if (const int width = cursor_.small("a number of coordinates"); width != 3)
        cursor_.fail("vertices have " + std::to_string(width) + " coordinates instead of 3");
      points(n, true);
    }
    groups();
    if (middles_.any()) take_middles(out_, middles_);
    return std::move(out_);
  }

 private:
  void header() {
    const std::string_view line = trimmed(cursor_.line());
    constexpr std::string_view mesh = "MFEM mesh v1.";
    if (line.starts_with("MFEM NC mesh"))
      cursor_.fail_at(cursor_.begin, "a non-conforming mesh (" + shown(line) + "): only conforming ones are read");
    if (line.starts_with("MFEM NURBS mesh")) cursor_.fail_at(cursor_.begin, "a NURBS mesh: only plain ones are read");
    if (line != "MFEM mesh v1.0" && line != "MFEM mesh v1.2" && line != "MFEM mesh v1.3")
      cursor_.fail_at(cursor_.begin, line.starts_with(mesh)
                                         ? shown(line) + " is not read, but v1.0, v1.2 and v1.3"
                                         : "not a mesh of MFEM: it does not begin with 'MFEM mesh v1.0'");
    sets_ = line == "MFEM mesh v1.3";
  }

  void comments() {
    while (cursor_.more() && *cursor_.at == '#') {
      const char* at = cursor_.at;
      const std::string_view line = cursor_.line();
      Cursor here = cursor_;
      here.at = at;
      comments_.add(line.substr(1), here);
    }
  }
  void keyword(std::string_view expected) {
    comments();
    const char* at = cursor_.at;
    const std::string_view word = cursor_.word();
    if (word != expected) cursor_.fail_at(at, "expected " + std::string(expected) + ", found " + shown(word));
  }

  void elements(bool volume) {
    const std::size_t n = cursor_.check_count(cursor_.integer("a number of elements"), 4, "elements");
    constexpr std::array<int, 8> n_nodes = {1, 2, 3, 4, 4, 8, 6, 5};
    constexpr std::array<const char*, 8> names = {"point",       "segment", "triangle", "square",
                                                  "tetrahedron", "cube",    "wedge",    "pyramid"};
    std::array<std::int64_t, 8> n_dropped{};
    for (std::size_t i = 0; i < n; ++i) {
      cursor_.skip_blanks();
      const char* at = cursor_.at;
      const int attribute = cursor_.small("an attribute"), kind = cursor_.small("a kind of geometry");
      const std::string element = (volume ? "element " : "boundary element ") + std::to_string(i + 1);
      if (kind < 0 || kind > 7) cursor_.fail_at(at, element + " is of unknown geometry " + std::to_string(kind));
      if (kind > mfem_square && (!volume || kind != mfem_cube))
        cursor_.fail_at(at, element + " is a " + names[kind] + "; only hexes of 8 or 27 nodes are accepted");
      std::array<Index, 8> nodes{};
      for (int k = 0; k < n_nodes[kind]; ++k) {
        const std::int64_t node = cursor_.integer("a vertex");
        if (node < 0 || node > std::numeric_limits<Index>::max())
          cursor_.fail_at(at, element + " names vertex " + std::to_string(node));
        nodes[k] = static_cast<Index>(node);
        highest_ = std::max(highest_, nodes[k]);
        if (nodes[k] == highest_) at_highest_ = at;
      }
      if (kind == mfem_cube) {
        hexes_.push_back(in_file_order(nodes));
        attributes_.push_back(attribute);
      } else if (kind == mfem_square && !volume) {
        quads_.push_back({nodes[0], nodes[1], nodes[2], nodes[3]});
        quad_attributes_.push_back(attribute);
      } else {
        ++n_dropped[kind];
      }
    }
    for (std::size_t kind = 0; kind < n_dropped.size(); ++kind)
      if (n_dropped[kind] > 0)
        out_.notices.push_back("dropped " + counted(n_dropped[kind], volume ? "element" : "boundary element") +
                               " of geometry " + names[kind]);
  }

  struct NamedSet {
    std::string name;
    std::vector<int> attributes;
  };
  void named_sets(std::vector<NamedSet>& sets) {
    const std::size_t n = cursor_.check_count(cursor_.integer("a number of sets"), 3, "sets");
    for (std::size_t i = 0; i < n; ++i) {
      NamedSet& set = sets.emplace_back();
      cursor_.skip_blanks();
      if (cursor_.at < cursor_.end && *cursor_.at == '"') {
        for (++cursor_.at; cursor_.at < cursor_.end && *cursor_.at != '"'; ++cursor_.at) {
          if (*cursor_.at == '\\' && cursor_.at + 1 < cursor_.end) ++cursor_.at;
          set.name += *cursor_.at;
        }
        if (cursor_.at == cursor_.end) cursor_.fail_truncated("the end of a name");
        ++cursor_.at;
      } else {
        set.name = cursor_.word();
      }
      set.attributes.resize(cursor_.check_count(cursor_.integer("a number of attributes"), 1, "attributes"));
      for (int& attribute : set.attributes) attribute = cursor_.small("an attribute");
    }
  }

  void corners() {
    if (highest_ >= n_vertices_)
      cursor_.fail_at(at_highest_, "an element names vertex " + std::to_string(highest_) + " of " +
                                       std::to_string(n_vertices_) + " (counted from 0)");
    out_.mesh.hexes = std::move(hexes_);
  }

  /// rows: x y z of each in turn; else all x, then all y, then all z.
  void points(std::size_t n, bool rows) {
    cursor_.check_count(static_cast<std::int64_t>(n), 6, "points");
    auto& points = out_.mesh.points;
    points.resize(n);
    for (std::size_t i = 0; i < 3 * n; ++i) {
      cursor_.skip_blanks();
      const char* at = cursor_.at;
      double& x = rows ? points[i / 3][static_cast<int>(i % 3)] : points[i % n][static_cast<int>(i / n)];
      x = cursor_.real("a coordinate");
      if (!std::isfinite(x)) cursor_.fail_at(at, "a coordinate is not finite");
    }
  }

  /// A grid function of the nodes.
  void nodes() {
    const auto after = [&](std::string_view what) {
      comments();
      const char* at = cursor_.at;
      const std::string_view line = cursor_.line();
      if (!line.starts_with(what)) cursor_.fail_at(at, "expected " + std::string(what) + ", found " + shown(line));
      return trimmed(line.substr(what.size()));
    };
    after("FiniteElementSpace");
    const std::string collection(after("FiniteElementCollection:"));
    const char* at = cursor_.at;
    if (const auto width = after("VDim:"); width != "3")
      cursor_.fail_at(at, "nodes have " + std::string(width) + " components instead of 3");
    const std::string_view ordering = after("Ordering:");
    if (ordering != "0" && ordering != "1") cursor_.fail_at(at, "unknown ordering " + shown(ordering));
    const bool rows = ordering == "1";
    comments();
    int degree = 0;
    if (collection == "Linear" || collection == "H1_3D_P1")
      degree = 1;
    else if (collection == "Quadratic" || collection == "H1_3D_P2")
      degree = 2;
    else if (collection == "Cubic")
      degree = 3;
    else if (collection.starts_with("H1_3D_P"))
      std::from_chars(collection.data() + 7, collection.data() + collection.size(), degree);
    if (degree < 1 || degree > 100)
      cursor_.fail_at(at, "nodes of collection " + shown(collection) + " are not read, but of H1_3D_P1 and H1_3D_P2");
    out_.mesh.points.resize(static_cast<std::size_t>(n_vertices_));  // for what follows
    const Edges edges = hextwist::edges(out_.mesh);
    const Faces faces = hextwist::faces(out_.mesh);
    const std::int64_t inside = degree - 1;
    const std::int64_t n = n_vertices_ + inside * std::ssize(edges.nodes) + inside * inside * std::ssize(faces.nodes) +
                           inside * inside * inside * out_.mesh.n_hexes();
    points(cursor_.check_count(n, 6, "nodes"), rows);
    if (degree > 2) {
      out_.notices.push_back("nodes of degree " + std::to_string(degree) +
                             " are left out but for the corners: hexes are straight");
      out_.mesh.points.resize(static_cast<std::size_t>(n_vertices_));
    }
    if (degree != 2) return;
    const std::vector<Index> edge = mfem_edges(edges), face = mfem_faces(faces);
    const Index first_edge = n_vertices_, first_face = first_edge + static_cast<Index>(edge.size()),
                first_hex = first_face + static_cast<Index>(face.size());
    constexpr MiddleOrder as_they_are = [] {
      MiddleOrder order{};
      for (int i = 0; i < 19; ++i) order[i] = i;
      return order;
    }();
    for (Index h = 0; h < out_.mesh.n_hexes(); ++h) {
      std::array<Index, FoundMiddles::width> of{};
      for (int e = 0; e < n_hex_edges; ++e) of[e] = first_edge + edge[edges.of_hex[h][e]];
      for (int f = 0; f < n_hex_faces; ++f) of[n_hex_edges + f] = first_face + face[faces.of_hex[h][f]];
      of.back() = first_hex + h;
      middles_.add(static_cast<std::size_t>(h), of, as_they_are);
    }
    middles_.finish(out_.mesh.hexes.size());
  }

  /// Groups of our comments, or one per attribute; then the named sets of attributes.
  template <class Group, class Member>
  void groups_of(std::vector<Group>& groups, std::vector<Member> Group::*members, const ReferenceKinds& kinds,
                 const std::vector<int>& attributes, const std::vector<Member>& items,
                 const std::vector<NamedSet>& sets) {
    for (const auto& [id, entry] : comments_.groups(kinds, attributes)) {
      Group& group = groups.emplace_back();
      group.id = id;
      group.name = entry.name;
      add(group.*members, entry.references, attributes, items);
    }
    for (const NamedSet& set : sets) {
      std::vector<Member> found;
      add(found, set.attributes, attributes, items);
      if (std::ranges::any_of(groups,
                              [&](const Group& group) { return group.name == set.name && group.*members == found; }))
        continue;
      const auto same = std::ranges::find_if(
          groups, [&](const Group& group) { return group.name.empty() && group.*members == found; });
      if (!comments_.ours && same != groups.end() && !found.empty()) {
        same->name = set.name;
        continue;
      }
      if (comments_.ours) continue;  // its name stands in a comment, where all of it fits
      Group& group = group_of_id(groups, free_id(groups));
      group.name = set.name;
      group.*members = std::move(found);
    }
  }
  template <class Member>
  static void add(std::vector<Member>& to, const std::vector<int>& some, const std::vector<int>& attributes,
                  const std::vector<Member>& items) {
    const std::set<int> wanted(some.begin(), some.end());
    for (std::size_t i = 0; i < items.size(); ++i)
      if (wanted.contains(attributes[i])) to.push_back(items[i]);
    sort_unique(to);
  }

  void groups() {
    std::vector<Index> hexes(out_.mesh.hexes.size());
    for (std::size_t h = 0; h < hexes.size(); ++h) hexes[h] = static_cast<Index>(h);
    groups_of(out_.mesh.blocks, &Block::hexes, mfem_blocks, attributes_, hexes, block_names_);
    const std::vector<Side> found = oriented_sides(out_.mesh, quads_);
    std::vector<Side> sides;
    std::vector<int> attributes;
    for (std::size_t q = 0; q < found.size(); ++q)
      if (found[q].hex >= 0) sides.push_back(found[q]), attributes.push_back(quad_attributes_[q]);
    if (const auto lost = std::ssize(found) - std::ssize(sides))
      out_.notices.push_back("dropped " + counted(lost, "square") + (lost == 1 ? " that is" : " that are") +
                             " no side of a hex");
    groups_of(out_.mesh.side_sets, &SideSet::sides, mfem_side_sets, attributes, sides, side_names_);
    for (const auto* list : {&attributes_, &quad_attributes_})
      if (const auto n = std::ranges::count_if(*list, [](int attribute) { return attribute < 1; }))
        out_.notices.push_back("attributes below 1 of " + counted(n, "element") + " are no " +
                               (list == &attributes_ ? "blocks" : "side sets"));
  }

  Cursor cursor_;
  MeshFile out_;
  bool sets_ = false;
  ReferenceComments comments_;
  std::vector<Hex> hexes_;
  std::vector<Quad> quads_;
  std::vector<int> attributes_, quad_attributes_;
  std::vector<NamedSet> block_names_, side_names_;
  Index n_vertices_ = 0, highest_ = -1;
  const char* at_highest_ = nullptr;
  FoundMiddles middles_;
};

}  // namespace

MeshFile read_mfem(const Bytes& bytes) {
  return MfemReader(bytes).result();
}

}  // namespace hextwist::io
