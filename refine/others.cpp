#include "hextwist/refine/others.h"

#include <algorithm>
#include <utility>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/refine/templates/split_table.h"

namespace hextwist {
namespace {

/// Shapes without middle nodes of which nothing is said that their pieces would not have.
bool is_first_order(const OtherElements& others, Index element) {
  const OtherType& type = others.type_of(element);
  const OtherHeads& heads = *others.heads;
  return type.n_nodes == n_corners(type.shape) && (heads.is_rigid.empty() || !heads.is_rigid[others.of[element]]);
}

Quad corners_of_quad(std::span<const Index> nodes) {
  return {nodes[0], nodes[1], nodes[2], nodes[3]};
}

/// Quads that may be cut along, and the sides that they are; hex -1 where they are none.
struct QuadsOnSides {
  std::vector<Index> element;
  std::vector<Side> side;
};
QuadsOnSides quads_on_sides(const Mesh& mesh) {
  const OtherElements& others = *mesh.others;
  QuadsOnSides result;
  std::vector<Quad> quads;
  for (Index e = 0; e < others.size(); ++e) {
    if (others.type_of(e).shape != OtherShape::quad || !is_first_order(others, e)) continue;
    result.element.push_back(e);
    quads.push_back(corners_of_quad(others.nodes_of(e)));
  }
  if (!quads.empty()) result.side = find_sides(mesh, quads);
  return result;
}

/// The same face the other way round, from the same corner.
Quad turned_over(const Quad& cycle) {
  return {cycle[0], cycle[3], cycle[2], cycle[1]};
}

/// A cycle from the corner at which its first edge comes nearest to a direction.
Quad begun_along(const Quad& cycle, const Vec3& direction, std::span<const Vec3> points) {
  int best = 0;
  double most = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < 4; ++i) {
    const Vec3 edge = points[cycle[(i + 1) % 4]] - points[cycle[i]];
    const double length = edge.norm();
    const double along = length > 0 ? edge.dot(direction) / length : -std::numeric_limits<double>::max();
    if (along > most) most = along, best = i;
  }
  return {cycle[best], cycle[(best + 1) % 4], cycle[(best + 2) % 4], cycle[(best + 3) % 4]};
}

}  // namespace

RigidEdges rigid_edges(const Mesh& mesh) {
  RigidEdges result;
  if (!mesh.others) return result;
  const OtherElements& others = *mesh.others;
  const QuadsOnSides quads = quads_on_sides(mesh);
  std::vector<std::uint8_t> follows(static_cast<std::size_t>(others.size()), 0);
  for (std::size_t i = 0; i < quads.element.size(); ++i) follows[quads.element[i]] = quads.side[i].hex >= 0;
  std::vector<std::pair<Edge, Index>> all;
  for (Index e = 0; e < others.size(); ++e) {
    const OtherShape shape = others.type_of(e).shape;
    if (follows[e] || (shape == OtherShape::line && is_first_order(others, e))) continue;
    const auto nodes = others.nodes_of(e);
    for (const auto& [a, b] : other_edges(shape))
      all.push_back({{std::min(nodes[a], nodes[b]), std::max(nodes[a], nodes[b])}, e});
  }
  std::ranges::sort(all);
  for (const auto& [edge, element] : all) {
    if (!result.edges.empty() && result.edges.back() == edge) continue;
    result.edges.push_back(edge);
    result.element.push_back(element);
  }
  return result;
}

void check_others(const Mesh& mesh, const SplitTable& table, std::span<const std::uint16_t> codes) {
  if (!mesh.others) return;
  const RigidEdges rigid = rigid_edges(mesh);
  if (rigid.edges.empty()) return;
  std::vector<std::uint8_t> is_end(mesh.points.size(), 0);
  for (const Edge& edge : rigid.edges) is_end[edge[0]] = is_end[edge[1]] = 1;
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    if (codes[h] == 0) continue;
    const Hex& hex = mesh.hexes[h];
    if (std::ranges::count_if(hex, [&](Index n) { return is_end[n] != 0; }) < 2) continue;
    const HexTemplate& of = table.hex(codes[h]);
    for (int e = 0; e < n_hex_edges; ++e) {
      if (table.edge[of.edge_code[e]].at.empty()) continue;
      const Index a = hex[edge_corner(e, 0)], b = hex[edge_corner(e, 1)];
      const Index at = position_in(rigid.edges, Edge{std::min(a, b), std::max(a, b)});
      if (at < 0) continue;
      throw BlockedByOther("hex " + std::to_string(hex_id(mesh, h)) + " would be cut at the edge between nodes " +
                           std::to_string(node_id(mesh, a)) + " and " + std::to_string(node_id(mesh, b)) + ", which " +
                           other_text(mesh, rigid.element[at]) +
                           " shares and which is not cut; 'stop_at other' ends one layer before");
    }
  }
}

OtherElementsPtr carried_others(const Mesh& before, const Split& split, std::span<const Vec3> points,
                                std::span<const Hex> hexes) {
  if (!before.others || split.lineage.hexes.empty()) return before.others;
  const OtherElements& old = *before.others;
  const QuadsOnSides quads = quads_on_sides(before);
  auto now = std::make_shared<OtherElements>();
  now->heads = old.heads;
  now->first.push_back(0);
  bool is_cut = false;
  const auto add = [&](Index e, std::span<const Index> corners) {
    const auto nodes = old.nodes_of(e);
    now->of.push_back(old.of[e]);
    now->nodes.insert(now->nodes.end(), corners.begin(), corners.end());
    now->nodes.insert(now->nodes.end(), nodes.begin() + std::ssize(corners), nodes.end());
    now->first.push_back(static_cast<Index>(now->nodes.size()));
  };
  std::size_t next_quad = 0;
  for (Index e = 0; e < old.size(); ++e) {
    const auto nodes = old.nodes_of(e);
    if (next_quad < quads.element.size() && quads.element[next_quad] == e) {
      const Side side = quads.side[next_quad++];
      const CutHex* cut =
          side.hex >= 0 && split.is_cut(side.hex) ? &split.lineage.hexes[split.cut_index(side.hex)] : nullptr;
      const std::vector<ChildSide>* children = cut ? &split.lineage.table->hex(cut->code).side[side.face] : nullptr;
      if (children && children->size() > 1) {
        is_cut = true;
        const Quad quad = corners_of_quad(nodes);
        const bool outward = turn_the_same_way(quad, face_node_cycle(before.hexes[side.hex], side.face));
        const Vec3 direction = before.points[quad[1]] - before.points[quad[0]];
        for (const ChildSide& child : *children) {
          Quad cycle = face_node_cycle(hexes[cut->first_child + child.child], child.face);
          if (!outward) cycle = turned_over(cycle);
          add(e, begun_along(cycle, direction, points));
        }
        continue;
      }
    } else if (old.type_of(e).shape == OtherShape::line && is_first_order(old, e)) {
      const Edge edge = {std::min(nodes[0], nodes[1]), std::max(nodes[0], nodes[1])};
      if (find_cut_edge(split.lineage, edge)) {
        is_cut = true;
        std::vector<Edge> pieces;
        Index at = edge[0];
        for_each_child_edge(split.lineage, edge, [&](const Edge& piece) {
          const Index to = piece[0] == at ? piece[1] : piece[0];
          pieces.push_back({at, to});
          at = to;
        });
        const bool backwards = nodes[0] > nodes[1];
        if (backwards) std::ranges::reverse(pieces);
        for (Edge& piece : pieces) {
          if (backwards) std::swap(piece[0], piece[1]);
          add(e, piece);
        }
        continue;
      }
    }
    add(e, nodes);
  }
  if (!is_cut) return before.others;
  return now;
}

std::vector<Index> with_inner_nodes(const Mesh& mesh, const Association& association, std::vector<Index> nodes) {
  if (!mesh.others) return nodes;
  const OtherElements& others = *mesh.others;
  for (Index e = 0; e < others.size(); ++e) {
    const OtherShape shape = others.type_of(e).shape;
    if (shape != OtherShape::quad && shape != OtherShape::line) continue;
    for (const Index n : others.nodes_of(e))
      if (association.node_owner.empty() || association.node_owner[n].dim == 3) nodes.push_back(n);
  }
  return sorted_unique(std::move(nodes));
}

}  // namespace hextwist
