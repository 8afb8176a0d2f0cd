#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "hextwist/base/mixed.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/mesh/smooth/named_internal.h"
#include "hextwist/mesh/topology.h"

namespace hextwist {
namespace {

constexpr double flat_sine = 1e-5;

/// Sets of names as numbers: equal for equal sets, whatever the order in which they are added up.
using Label = std::uint64_t;
Label label_of(std::uint64_t kind, std::uint64_t number) {
  return mixed(mixed(kind) + number);
}

/// Per hex a number that is the same for hexes of the same blocks and values of fields; empty when all are.
class Signatures {
 public:
  explicit Signatures(const Mesh& mesh) : n_hexes_(mesh.hexes.size()) {}

  void add(const Block& block) {
    if (block.hexes.size() == n_hexes_ || block.hexes.empty()) return;
    begin();
    std::vector<Index> with_block(n_, -1);  // per signature before
    for (const Index h : block.hexes) {
      Index& now = with_block[of_hex_[h]];
      if (now < 0) now = n_++;
      of_hex_[h] = now;
    }
  }
  void add(const Field& field) {
    const auto width = static_cast<std::size_t>(field.components);
    if (field.on != Field::On::hex || field.values.size() != n_hexes_ * width) return;
    begin();
    const auto value = [&](Index h) {
      return std::span(field.values).subspan(static_cast<std::size_t>(h) * width, width);
    };
    const auto before = [&](Index a, Index b) {
      if (of_hex_[a] != of_hex_[b]) return of_hex_[a] < of_hex_[b];
      return std::ranges::lexicographical_compare(value(a), value(b));
    };
    std::vector<Index> order(n_hexes_);
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, before);
    std::vector<Index> now(n_hexes_, 0);
    n_ = 1;
    for (std::size_t i = 1; i < order.size(); ++i) now[order[i]] = before(order[i - 1], order[i]) ? n_++ : n_ - 1;
    of_hex_ = std::move(now);
  }
  std::vector<Index> take() { return std::move(of_hex_); }

 private:
  void begin() {
    if (of_hex_.empty()) of_hex_.assign(n_hexes_, 0);
  }
  std::size_t n_hexes_;
  Index n_ = 1;
  std::vector<Index> of_hex_;
};

/// A face inside the mesh, once per hex.
struct Use {
  std::array<Index, 4> key;  ///< nodes, ascending
  Side side;
  auto operator<=>(const Use&) const = default;
};
struct NamedEdge {
  Edge nodes;
  Label label;
  auto operator<=>(const NamedEdge&) const = default;
};

class Finder {
 public:
  Finder(const Mesh& mesh, const Association& association, std::span<const std::uint8_t> may_move)
      : mesh_(mesh), association_(association), may_move_(may_move) {}

  Holds run(std::span<const std::string> keep_jumps) {
    Signatures signatures(mesh_);
    for (const Block& block : mesh_.blocks) signatures.add(block);
    for (const Field& field : mesh_.fields)
      if (std::ranges::find(keep_jumps, field.name) != keep_jumps.end()) signatures.add(field);
    signature_ = signatures.take();
    collect_node_sets();
    collect_sides();
    if (signature_.empty() && sides_.empty() && sets_.empty()) return std::move(holds_);
    local_ = touching_hexes(mesh_.hexes, may_move_);
    const std::vector<Use> uses = face_uses();
    for (std::size_t begin = 0; begin + 1 < uses.size(); ++begin)
      if (uses[begin].key == uses[begin + 1].key) take_face(uses[begin].side, uses[begin + 1].side);
    hold_rims();
    hold_lines();
    return std::move(holds_);
  }

 private:
  bool on_model(Index node) const {
    return !association_.empty() && association_.node_owner[node].dim >= 0 && association_.node_owner[node].dim < 3;
  }
  bool is_owned(Side side) const { return std::ranges::binary_search(association_.surface_faces, side); }
  /// Node sets with a node inside that may move, but not all nodes of the mesh.
  void collect_node_sets() {
    for (const NodeSet& set : mesh_.node_sets)
      if (set.nodes.size() < mesh_.points.size() &&
          std::ranges::any_of(set.nodes, [&](Index n) { return may_move_[n] && !on_model(n); }))
        sets_.push_back(&set);
    std::vector<std::pair<Index, Index>> pairs;
    for (std::size_t s = 0; s < sets_.size(); ++s)
      for (const Index n : sets_[s]->nodes) pairs.emplace_back(n, static_cast<Index>(s));
    std::ranges::sort(pairs);
    if (pairs.empty()) return;
    sets_of_.first.assign(mesh_.points.size() + 1, 0);
    for (const auto& [node, set] : pairs) ++sets_of_.first[node + 1];
    for (std::size_t n = 1; n < sets_of_.first.size(); ++n) sets_of_.first[n] += sets_of_.first[n - 1];
    for (const auto& [node, set] : pairs) sets_of_.items.push_back(set);
  }
  std::span<const Index> sets_of(Index node) const { return sets_.empty() ? std::span<const Index>() : sets_of_[node]; }
  bool in_set(Index node, Index set) const { return std::ranges::binary_search(sets_of(node), set); }
  bool is_all_in(Index hex, Index set) const {
    return std::ranges::all_of(mesh_.hexes[hex], [&](Index n) { return in_set(n, set); });
  }
  void collect_sides() {
    std::vector<NamedEdge> on_cad;
    for (std::size_t s = 0; s < mesh_.side_sets.size(); ++s)
      for (const Side side : mesh_.side_sets[s].sides) {
        if (!has_marked_corner(mesh_.hexes[side.hex], may_move_)) continue;
        if (!is_owned(side)) {
          sides_.emplace_back(side, label_of(1, s));
          continue;
        }
        const auto cycle = face_node_cycle(mesh_.hexes[side.hex], side.face);
        for (int k = 0; k < 4; ++k) {
          const auto [low, high] = std::minmax(cycle[k], cycle[(k + 1) & 3]);
          on_cad.push_back({{low, high}, label_of(1, s)});
        }
      }
    std::ranges::sort(sides_);
    hold_rims_on_cad(std::move(on_cad));
  }
  /// Edges of faces in side sets: where one ends within a surface of the CAD.
  void hold_rims_on_cad(std::vector<NamedEdge> edges) {
    std::ranges::sort(edges);
    for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
      while (end < edges.size() && edges[end] == edges[begin]) ++end;
      const auto [a, b] = edges[begin].nodes;
      if (end - begin > 1 || std::ranges::binary_search(association_.curve_edges, Edge{a, b})) continue;
      hold_along(a, b);
      hold_along(b, a);
    }
  }

  /// All faces of the hexes around that can be named, sorted.
  std::vector<Use> face_uses() const {
    // Of nodes: between blocks, on a side that is named.
    enum : std::uint8_t { between = 1, on_side = 2 };
    std::vector<std::uint8_t> mark(mesh_.points.size(), 0);
    if (!signature_.empty()) {
      std::vector<Index> seen(mesh_.points.size(), -1);
      for (const Index h : local_)
        for (const Index n : mesh_.hexes[h])
          if (seen[n] < 0)
            seen[n] = signature_[h];
          else if (seen[n] != signature_[h])
            mark[n] |= between;
    }
    for (const auto& [side, label] : sides_)
      for (const Index n : face_nodes(mesh_.hexes[side.hex], side.face)) mark[n] |= on_side;
    std::vector<Use> uses;
    for (const Index h : local_)
      for (int f = 0; f < n_hex_faces; ++f) {
        auto nodes = face_nodes(mesh_.hexes[h], f);
        std::uint8_t common = between | on_side;
        bool may_move = false, in_sets = !sets_.empty();
        for (const Index n : nodes) {
          common &= mark[n];
          may_move |= may_move_[n] != 0;
          in_sets = in_sets && !sets_of(n).empty();
        }
        if (!may_move || !(common || in_sets)) continue;
        std::ranges::sort(nodes);
        uses.push_back({nodes, {h, f}});
      }
    std::ranges::sort(uses);
    return uses;
  }

  /// What a face between two hexes is called; 0: nothing.
  Label label(Side a, Side b) const {
    Label sum = 0;
    if (!signature_.empty() && signature_[a.hex] != signature_[b.hex]) {
      const auto [low, high] = std::minmax(signature_[a.hex], signature_[b.hex]);
      sum += label_of(2, static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint64_t>(high));
    }
    for (const Side side : {a, b})
      for (auto at = std::ranges::lower_bound(sides_, std::pair(side, Label{0})); at != sides_.end(); ++at) {
        if (at->first != side) break;
        sum += at->second;
      }
    const auto nodes = face_nodes(mesh_.hexes[a.hex], a.face);
    for (const Index set : sets_of(nodes[0]))
      if (in_set(nodes[1], set) && in_set(nodes[2], set) && in_set(nodes[3], set) &&
          !(is_all_in(a.hex, set) && is_all_in(b.hex, set)))
        sum += label_of(3, static_cast<std::uint64_t>(set));
    return sum;
  }

  void take_face(Side a, Side b) {
    const Label name = label(a, b);
    if (name == 0) return;
    if (is_owned(a) || is_owned(b)) return;
    const auto cycle = face_node_cycle(mesh_.hexes[a.hex], a.face);
    for (int k = 0; k < 4; ++k) {
      const Index node = cycle[k], next = cycle[(k + 1) & 3], before = cycle[(k + 3) & 3];
      const Vec3 x = mesh_.points[node];
      Vec3 along = mesh_.points[next] - x, across = mesh_.points[before] - x;
      Vec3 normal = along.cross(across);
      const double size = normal.norm();
      if (size > 0) hold(node, normal / size);
      // The corner across lies in the plane too, unless the face bends.
      const Vec3 diagonal = mesh_.points[cycle[(k + 2) & 3]] - x;
      if (!(std::abs(diagonal.dot(normal)) <= flat_sine * size * diagonal.norm())) fix(node);
      edges_.push_back({{std::min(node, next), std::max(node, next)}, name});
      on_face_.push_back(node);
    }
  }
  /// Edges that do not have exactly two faces of one name, one after the other along the rim.
  void hold_rims() {
    std::ranges::sort(edges_);
    for (std::size_t begin = 0, end = 0; begin < edges_.size(); begin = end) {
      while (end < edges_.size() && edges_[end].nodes == edges_[begin].nodes) ++end;
      if (end - begin == 2 && edges_[begin].label == edges_[begin + 1].label) continue;
      const auto [a, b] = edges_[begin].nodes;
      if (on_model(a) && on_model(b)) continue;
      hold_along(a, b);
      hold_along(b, a);
    }
  }
  /// Nodes of node sets on no face of theirs.
  void hold_lines() {
    if (sets_.empty()) return;
    sort_unique(on_face_);
    std::vector<Edge> lines;
    std::vector<Index> alone;
    for (const Index h : local_)
      for (const Index n : mesh_.hexes[h])
        if (may_move_[n] && !on_model(n) && !sets_of(n).empty() && !std::ranges::binary_search(on_face_, n))
          alone.push_back(n);
    sort_unique(alone);
    std::vector<Index> inside;  // in a hex all of whose nodes are in one of its sets
    for (const Index h : local_)
      for (const Index set : sets_of(mesh_.hexes[h][0]))
        if (is_all_in(h, set)) inside.insert(inside.end(), mesh_.hexes[h].begin(), mesh_.hexes[h].end());
    alone = difference(alone, sorted_unique(std::move(inside)));
    if (alone.empty()) return;
    for (const Index h : local_)
      for (int e = 0; e < n_hex_edges; ++e) {
        const Index a = mesh_.hexes[h][edge_corner(e, 0)], b = mesh_.hexes[h][edge_corner(e, 1)];
        if (intersection(sets_of_node(a), sets_of_node(b)).empty()) continue;
        lines.push_back({a, b});
        lines.push_back({b, a});
      }
    sort_unique(lines);
    for (const Index n : alone) {
      const auto neighbours = std::ranges::equal_range(lines, n, {}, [](const Edge& edge) { return edge[0]; });
      if (neighbours.size() != 2) fix(n);
      for (const Edge& edge : neighbours) hold_along(n, edge[1]);
    }
  }
  std::vector<Index> sets_of_node(Index node) const {
    const auto sets = sets_of(node);
    return {sets.begin(), sets.end()};
  }

  void hold(Index node, const Vec3& direction) {
    if (!may_move_[node]) return;
    if (holds_.of_node.empty()) holds_.of_node.assign(mesh_.points.size(), -1);
    Index& at = holds_.of_node[node];
    if (at < 0) {
      at = static_cast<Index>(holds_.list.size());
      holds_.list.emplace_back();
    }
    holds_.list[at].add(direction);
  }
  void hold_along(Index node, Index towards) {
    const Vec3 along = (mesh_.points[towards] - mesh_.points[node]).normalized(), one = along.unitOrthogonal();
    hold(node, one);
    hold(node, along.cross(one));
  }
  void fix(Index node) {
    for (int axis = 0; axis < 3; ++axis) hold(node, Vec3::Unit(axis));
  }

  const Mesh& mesh_;
  const Association& association_;
  std::span<const std::uint8_t> may_move_;
  std::vector<Index> signature_;  ///< per hex
  std::vector<const NodeSet*> sets_;
  CompressedRows sets_of_;                     ///< per node, where there are sets
  std::vector<std::pair<Side, Label>> sides_;  ///< named ones, ascending
  std::vector<Index> local_;                   ///< hexes around nodes that may move
  std::vector<NamedEdge> edges_;               ///< of named faces
  std::vector<Index> on_face_;                 ///< nodes of named faces
  Holds holds_;
};

}  // namespace

void Hold::add(const Vec3& direction) {
  Vec3 rest = direction;
  for (int i = 0; i < n; ++i) rest -= normal[i].dot(direction) * normal[i];
  const double sine = rest.norm();
  if (n < 3 && sine > flat_sine) normal[n++] = rest / sine;
}

Holds named_holds(const Mesh& mesh, const Association& association, std::span<const std::uint8_t> may_move,
                  std::span<const std::string> keep_jumps) {
  return Finder(mesh, association, may_move).run(keep_jumps);
}

}  // namespace hextwist
