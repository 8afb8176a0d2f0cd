// MEDIT's .mesh, text (P. Frey, "Medit: an interactive mesh visualization software", INRIA RT-0253, 2001).
//
// HexahedraQ2 (27 nodes), QuadrilateralsQ2 and EdgesP2 with the order of their nodes (L. Marechal, "The LibMeshb
// library", "GmfSetHONodesOrdering").
//
// References of hexes are blocks, of quads side sets, of vertices node sets; the nodes of edges with a reference are a
// node set, too. Corners, RequiredVertices, Ridges and RequiredEdges are node sets of these names,
// RequiredQuadrilaterals a side set. In files of our own, comments say which references are owners and which are groups
// (references_internal.h).
#include "hextwist/io/medit/references_internal.h"

#include "hextwist/base/sorted.h"

namespace hextwist::io {
namespace {

/// Items with so many node numbers, and a reference.
struct Elements {
  std::vector<Index> nodes;
  std::vector<int> references;
};

/// Sections that are skipped, with the number of values per item.
struct Skipped {
  std::string_view name;
  int n_values;
};
constexpr Skipped skipped[] = {{"Normals", 3},
                               {"Tangents", 3},
                               {"NormalAtVertices", 2},
                               {"TangentAtVertices", 2},
                               {"NormalAtTriangleVertices", 3},
                               {"NormalAtQuadrilateralVertices", 3},
                               {"TangentAtEdges", 3},
                               {"RequiredTriangles", 1},
                               {"Triangles", 4}};

class MeditReader {
 public:
  explicit MeditReader(const Bytes& bytes) : cursor_(bytes) {}

  MeshFile result() {
    header();
    std::string_view word = keyword();
    for (; !word.empty() && !same_word(word, "End"); word = keyword()) section(word);
    if (word.empty() && !done()) cursor_.fail_at(cursor_.end, "the file ends without hexes");
    if (word.empty())
      out_.notices.push_back(cursor_.where(cursor_.end) + ": there is no End; the file may be cut short");
    if (hexes_.references.empty() && quadratic_hexes_.references.empty())
      cursor_.fail_at(cursor_.end, "there is no hex in the file");
    quadratic();
    assemble();
    if (found_.any()) {
      found_.finish(out_.mesh.hexes.size());
      take_middles(out_, found_);
    }
    return std::move(out_);
  }

 private:
  bool done() const {
    return !out_.mesh.points.empty() && !(hexes_.references.empty() && quadratic_hexes_.references.empty());
  }

  /// Skips blanks and comments.
  void skip() {
    while (cursor_.more() && *cursor_.at == '#') {
      ++cursor_.at;
      comments_.add(cursor_.line(), cursor_);
    }
  }
  std::string_view keyword() {
    skip();
    start_ = cursor_.at;
    return cursor_.word();
  }
  void header() {
    // Binary files begin with the number 1, in either byte order.
    const std::string_view first(cursor_.begin, std::min<std::size_t>(4, cursor_.left()));
    const bool binary = first == std::string_view("\1\0\0\0", 4) || first == std::string_view("\0\0\0\1", 4);
    if (!same_word(keyword(), "MeshVersionFormatted"))
      cursor_.fail_at(start_, binary ? "a binary MEDIT file (.meshb), only text is read"
                                     : "not a MEDIT file: it does not begin with MeshVersionFormatted");
    cursor_.small("the version");
    if (!same_word(keyword(), "Dimension")) cursor_.fail_at(start_, "expected Dimension");
    if (const int dim = cursor_.small("the dimension"); dim != 3)
      cursor_.fail_at(start_, "dimension " + std::to_string(dim) + " instead of 3");
  }
  std::size_t count(std::string_view what, std::size_t n_values) {
    skip();
    return cursor_.check_count(cursor_.integer("the number of " + std::string(what)), 2 * n_values, what);
  }

  void section(std::string_view word) {
    if (!std::isalpha(static_cast<unsigned char>(word[0])))
      cursor_.fail_at(start_, "expected a keyword, found " + shown(word));
    const std::string once = lower_case(word);
    if (std::ranges::find(seen_, once) != seen_.end()) cursor_.fail_at(start_, "a second section " + std::string(word));
    seen_.push_back(once);
    if (same_word(word, "Vertices")) return vertices();
    if (same_word(word, "Hexahedra")) return elements(hexes_, 8, "hex");
    if (same_word(word, "Quadrilaterals")) return elements(quads_, 4, "quad");
    if (same_word(word, "Edges")) return elements(edges_, 2, "edge");
    if (same_word(word, "HexahedraQ2") || same_word(word, "HexahedraP2")) {
      quadratic_at_ = start_;
      return elements(quadratic_hexes_, 27, "hex");
    }
    if (same_word(word, "QuadrilateralsQ2")) return elements(quadratic_quads_, 9, "quad");
    if (same_word(word, "EdgesP2")) return elements(quadratic_edges_, 3, "edge");
    if (same_word(word, "HexahedraQ2Ordering") || same_word(word, "HexahedraP2Ordering"))
      return ordering(hex_order_, 27, 3);
    if (same_word(word, "QuadrilateralsQ2Ordering")) return ordering(quad_order_, 9, 2);
    if (same_word(word, "EdgesP2Ordering")) return ordering(edge_order_, 3, 1);
    if (same_word(word, "Corners")) return list(corners_, "corner");
    if (same_word(word, "RequiredVertices")) return list(required_vertices_, "vertex");
    if (same_word(word, "Ridges")) return list(ridges_, "edge");
    if (same_word(word, "RequiredEdges")) return list(required_edges_, "edge");
    if (same_word(word, "RequiredQuadrilaterals")) return list(required_quads_, "quad");
    for (const Skipped& other : skipped)
      if (same_word(word, other.name)) {
        const auto n = count(other.name, other.n_values);
        for (std::size_t i = 0; i < n * other.n_values; ++i) cursor_.real("a value");
        if (n && other.name == "Triangles")
          out_.notices.push_back("dropped " + std::to_string(n) + " triangles");
        else if (n)
          out_.notices.push_back("left out " + counted(static_cast<std::int64_t>(n), "entry", "entries") + " of " +
                                 std::string(other.name));
        return;
      }
    for (const std::string_view volume : {"Tetrahedra", "Prisms", "Pyramids", "Pentahedra"})
      if (lower_case(word).starts_with(lower_case(volume)) || (lower_case(word).starts_with("hexahedra"))) {
        if (count(word, 1) == 0) return;
        skip();
        cursor_.fail("element 1 of " + std::string(word) + " is no 8-node hex; only those are accepted");
      }
    // Something else: its count, then numbers up to the next keyword.
    const std::string name(word);
    count(name, 0);
    out_.notices.push_back("skipped section " + name);
    for (skip(); cursor_.more() && !std::isalpha(static_cast<unsigned char>(*cursor_.at)); skip()) cursor_.word();
  }

  void vertices() {
    const auto n = count("vertices", 4);
    out_.mesh.points.resize(n);
    vertex_references_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      skip();
      const char* at = cursor_.at;
      for (double& x : out_.mesh.points[i]) {
        x = cursor_.real("a coordinate");
        if (!std::isfinite(x))
          cursor_.fail_at(at, "a coordinate of vertex " + std::to_string(i + 1) + " is not finite");
      }
      vertex_references_[i] = cursor_.small("a reference");
    }
    n_nodes_ = static_cast<Index>(n);
  }

  void elements(Elements& elements, int n_nodes, const char* kind) {
    const auto n = count(std::string(kind) + (kind == std::string_view("hex") ? "es" : "s"),
                         static_cast<std::size_t>(n_nodes) + 1);
    if (n_nodes_ < 0 && n > 0) cursor_.fail_at(start_, "elements before vertices");
    elements.nodes.reserve(elements.nodes.size() + n * n_nodes);
    for (std::size_t i = 0; i < n; ++i) {
      skip();
      const char* at = cursor_.at;
      for (int c = 0; c < n_nodes; ++c) {
        const auto node = cursor_.integer("a vertex");
        if (node < 1 || node > n_nodes_)
          cursor_.fail_at(at, std::string(kind) + " " + std::to_string(elements.references.size() + 1) +
                                  " names vertex " + std::to_string(node) + " of " + std::to_string(n_nodes_));
        elements.nodes.push_back(static_cast<Index>(node - 1));
      }
      elements.references.push_back(cursor_.small("a reference"));
    }
  }

  /// Per node of an element its place on axes from 0 to 2; kept as the number x + 3 y + 9 z.
  void ordering(std::vector<int>& order, std::size_t n_nodes, int n_axes) {
    const auto n = count("nodes", static_cast<std::size_t>(n_axes));
    if (n != n_nodes)
      cursor_.fail_at(start_, "an order of " + std::to_string(n) + " nodes instead of " + std::to_string(n_nodes));
    for (std::size_t i = 0; i < n; ++i) {
      skip();
      const char* at = cursor_.at;
      int place = 0;
      for (int axis = 0, step = 1; axis < n_axes; ++axis, step *= 3) {
        const int x = cursor_.small("the place of a node");
        if (x < 0 || x > 2) cursor_.fail_at(at, "the place " + std::to_string(x) + " of a node is not 0, 1 or 2");
        place += step * x;
      }
      if (std::ranges::find(order, place) != order.end()) cursor_.fail_at(at, "two nodes at one place");
      order.push_back(place);
    }
  }

  /// Elements of second order become elements of first order, and middle nodes of hexes.
  void quadratic() {
    const auto corners = [](const Elements& from, std::size_t width, const std::vector<int>& order,
                            std::initializer_list<int> places, Elements& to) {
      for (std::size_t i = 0; i < from.references.size(); ++i) {
        std::size_t next = 0;
        for (const int place : places) {
          // Without an order, corners come first.
          const auto at =
              order.empty() ? next : static_cast<std::size_t>(std::ranges::find(order, place) - order.begin());
          to.nodes.push_back(from.nodes[width * i + at]);
          ++next;
        }
        to.references.push_back(from.references[i]);
      }
    };
    if (!quadratic_hexes_.references.empty() && hex_order_.empty())
      cursor_.fail_at(quadratic_at_,
                      "in which order the 27 nodes of a hex are is not said: HexahedraQ2Ordering is missing");
    const std::size_t n_before = hexes_.references.size();
    corners(quadratic_hexes_, 27, hex_order_, {0, 2, 8, 6, 18, 20, 26, 24}, hexes_);
    corners(quadratic_quads_, 9, quad_order_, {0, 2, 8, 6}, quads_);
    corners(quadratic_edges_, 3, edge_order_, {0, 2}, edges_);
    constexpr MiddleOrder as_it_is = [] {
      MiddleOrder order{};
      for (int i = 0; i < 19; ++i) order[i] = i;
      return order;
    }();
    std::array<Index, FoundMiddles::width> middles{};
    for (std::size_t i = 0; i < quadratic_hexes_.references.size(); ++i) {
      for (std::size_t k = 0; k < hex_order_.size(); ++k)
        if (const int middle = middle_at(hex_order_[k]); middle >= 0)
          middles[static_cast<std::size_t>(middle)] = quadratic_hexes_.nodes[27 * i + k];
      found_.add(n_before + i, middles, as_it_is);
    }
    quadratic_hexes_ = {};
  }

  /// The middle (MiddleOrder's number) at a place x + 3 y + 9 z; -1: a corner.
  static int middle_at(int place) {
    const std::array<int, 3> at = {place % 3, place / 3 % 3, place / 9};
    int low = 0, n_ones = 0, axis_of_one = 0, other = 0;
    for (int axis = 0; axis < 3; ++axis)
      if (at[axis] == 1) {
        ++n_ones;
        axis_of_one = axis;
      } else {
        other = axis;
        if (at[axis] == 2) low |= 1 << axis;
      }
    if (n_ones == 0) return -1;
    if (n_ones == 1) return edge_between(low, low | 1 << axis_of_one);
    return n_ones == 2 ? 12 + 2 * other + (at[other] == 2) : 18;
  }

  void list(std::vector<Index>& items, const char* kind) {
    const auto n = count("entries", 1);
    for (std::size_t i = 0; i < n; ++i) {
      skip();
      const char* at = cursor_.at;
      const int item = cursor_.small(kind);
      if (item < 1) cursor_.fail_at(at, std::string(kind) + " " + std::to_string(item));
      items.push_back(item - 1);
    }
  }

  static constexpr ReferenceKinds kinds[] = {
      {"nodeset", "vertex"}, {"edgeset", "curve"}, {"sideset", "surface"}, {"block", "volume"}};

  /// Members of each group of a kind; member(i) adds element i.
  template <class Member, class F>
  void each_group(int dim, const std::vector<int>& references, F&& member,
                  const std::function<void(int, const std::string&, std::vector<Member>&&)>& done) {
    auto groups = comments_.groups(kinds[dim], references);
    if (const auto n = std::ranges::count_if(references, [](int reference) { return reference < 0; }))
      out_.notices.push_back("negative references (" + std::string(kinds[dim].group) + "s) of " +
                             counted(n, "element") + " left out");
    std::map<int, std::vector<int>> groups_of_reference;
    std::map<int, std::vector<Member>> members;
    for (const auto& [id, entry] : groups) {
      members[id];
      for (const int reference : entry.references) groups_of_reference[reference].push_back(id);
    }
    int last = 0;
    std::vector<std::vector<Member>*> current;
    for (std::size_t i = 0; i < references.size(); ++i) {
      if (references[i] == 0) continue;
      if (references[i] != last) {
        current.clear();
        for (const int id : groups_of_reference[references[i]]) current.push_back(&members[id]);
        last = references[i];
      }
      for (auto* group : current) member(i, *group);
    }
    for (auto& [id, items] : members) {
      sort_unique(items);
      done(id, groups[id].name, std::move(items));
    }
  }
  std::vector<int> entities(int dim, const std::vector<int>& references) const {
    const auto entity_of = comments_.entities(kinds[dim]);
    std::vector<int> result(references.size(), 0);
    for (std::size_t i = 0; i < references.size() && !entity_of.empty(); ++i)
      if (const auto at = entity_of.find(references[i]); at != entity_of.end()) result[i] = at->second;
    return result;
  }

  void assemble() {
    Mesh& mesh = out_.mesh;
    Association& tags = out_.tags;
    mesh.hexes.resize(hexes_.references.size());
    for (std::size_t h = 0; h < mesh.hexes.size(); ++h)
      for (int c = 0; c < 8; ++c) mesh.hexes[h][file_corner[c]] = hexes_.nodes[8 * h + c];
    each_group<Index>(
        3, hexes_.references, [](std::size_t i, auto& group) { group.push_back(static_cast<Index>(i)); },
        [&](int id, const std::string& name, auto&& items) {
          mesh.blocks.push_back({id, name, std::move(items)});
        });
    tags.hex_volume = entities(3, hexes_.references);
    tags.node_owner.resize(mesh.points.size());
    tags.node_parameters.resize(mesh.points.size());
    derive_owners(tags.node_owner, 3, hexes_.nodes, tags.hex_volume);
    quads();
    edges();
    vertex_groups();
    tidy(tags);
  }

  void quads() {
    Mesh& mesh = out_.mesh;
    std::vector<Quad> cycles(quads_.references.size());
    for (std::size_t i = 0; i < cycles.size(); ++i)
      for (int k = 0; k < 4; ++k) cycles[i][k] = quads_.nodes[4 * i + k];
    const auto sides = oriented_sides(mesh, cycles);
    if (const auto lost = std::ranges::count(sides, -1, &Side::hex))
      out_.notices.push_back("dropped " + counted(lost, "quad") + (lost == 1 ? " that is" : " that are") +
                             " no side of a hex");
    each_group<Side>(
        2, quads_.references,
        [&](std::size_t i, auto& group) {
          if (sides[i].hex >= 0) group.push_back(sides[i]);
        },
        [&](int id, const std::string& name, auto&& items) {
          mesh.side_sets.push_back({id, name, std::move(items)});
        });
    const auto surface = entities(2, quads_.references);
    std::vector<Side> owned;
    for (std::size_t i = 0; i < sides.size(); ++i)
      if (sides[i].hex >= 0 && surface[i] > 0) {
        owned.push_back(sides[i]);
        out_.tags.face_surface.push_back(surface[i]);
      }
    out_.tags.surface_faces = lower_sides(mesh, owned);
    derive_owners(out_.tags.node_owner, 2, quads_.nodes, surface);
    if (required_quads_.empty()) return;
    SideSet set{free_id(mesh.side_sets), "RequiredQuadrilaterals", {}};
    for (const Index i : required_quads_)
      if (i < std::ssize(sides) && sides[i].hex >= 0) set.sides.push_back(sides[i]);
    sort_unique(set.sides);
    mesh.side_sets.push_back(std::move(set));
  }

  void edges() {
    const auto curve = entities(1, edges_.references);
    std::vector<Edge> pairs(edges_.references.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto [a, b] = std::minmax(edges_.nodes[2 * i], edges_.nodes[2 * i + 1]);
      pairs[i] = {a, b};
    }
    const auto good = are_edges(out_.mesh, pairs);
    for (std::size_t i = 0; i < pairs.size(); ++i)
      if (good[i] && curve[i] > 0) {
        out_.tags.curve_edges.push_back(pairs[i]);
        out_.tags.edge_curve.push_back(curve[i]);
      }
    derive_owners(out_.tags.node_owner, 1, edges_.nodes, curve);
  }

  void vertex_groups() {
    auto& sets = out_.mesh.node_sets;
    each_group<Index>(
        0, vertex_references_, [](std::size_t i, auto& group) { group.push_back(static_cast<Index>(i)); },
        [&](int id, const std::string& name, auto&& items) {
          sets.push_back({id, name, std::move(items)});
        });
    std::vector<Index> all(vertex_references_.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<Index>(i);
    derive_owners(out_.tags.node_owner, 0, all, entities(0, vertex_references_));
    if (comments_.ours) return;
    const auto add = [&](const std::string& name, std::vector<Index> nodes, int id) {
      sort_unique(nodes);
      if (nodes.empty()) return;
      const bool taken = id == 0 || std::ranges::find(sets, id, &NodeSet::id) != sets.end();
      NodeSet& set = group_of_id(sets, taken ? free_id(sets) : id);
      set.name = name;
      set.nodes = std::move(nodes);
    };
    const auto edge_nodes = [&](const std::vector<Index>& items) {
      std::vector<Index> nodes;
      for (const Index i : items)
        if (i < std::ssize(edges_.references))
          for (int k = 0; k < 2; ++k) nodes.push_back(edges_.nodes[2 * i + k]);
      return nodes;
    };
    std::map<int, std::vector<Index>> by_reference;
    for (std::size_t i = 0; i < edges_.references.size(); ++i)
      if (edges_.references[i] > 0) by_reference[edges_.references[i]].push_back(static_cast<Index>(i));
    for (const auto& [reference, items] : by_reference)
      add("edges " + std::to_string(reference), edge_nodes(items), reference);
    const auto known = [&](std::vector<Index> nodes) {
      std::erase_if(nodes, [&](Index n) { return n >= n_nodes_; });
      return nodes;
    };
    add("Corners", known(corners_), 0);
    add("RequiredVertices", known(required_vertices_), 0);
    add("Ridges", edge_nodes(ridges_), 0);
    add("RequiredEdges", edge_nodes(required_edges_), 0);
  }

  Cursor cursor_;
  const char* start_ = nullptr;  // of the keyword at hand
  MeshFile out_;
  std::vector<std::string> seen_;  // sections, each of which a file has once
  ReferenceComments comments_;
  Index n_nodes_ = -1;
  std::vector<int> vertex_references_;
  Elements hexes_, quads_, edges_;
  Elements quadratic_hexes_, quadratic_quads_, quadratic_edges_;
  std::vector<int> hex_order_, quad_order_, edge_order_;  // per node its place x + 3 y + 9 z
  const char* quadratic_at_ = nullptr;
  FoundMiddles found_;
  std::vector<Index> corners_, required_vertices_, ridges_, required_edges_, required_quads_;
};

}  // namespace

MeshFile read_medit(const Bytes& bytes) {
  return MeditReader(bytes).result();
}

}  // namespace hextwist::io
