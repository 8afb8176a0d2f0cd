#include "support/others.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <set>

#include "hextwist/mesh/corners.h"

namespace hextwist::test {
namespace {

using Nodes = std::vector<Index>;

constexpr double tiny = 1e-9;

Nodes ascending(Nodes nodes) {
  std::ranges::sort(nodes);
  return nodes;
}

/// Cycles of the faces of hexes with how many have each, and edges.
struct HexSkin {
  std::map<Nodes, std::pair<Nodes, int>> faces;
  std::set<Nodes> edges;

  explicit HexSkin(const Mesh& mesh) {
    for (const Hex& hex : mesh.hexes) {
      for (int f = 0; f < n_hex_faces; ++f) {
        const auto cycle = face_node_cycle(hex, f);
        const Nodes nodes(cycle.begin(), cycle.end());
        auto& face = faces[ascending(nodes)];
        face.first = nodes;
        ++face.second;
      }
      for (int e = 0; e < n_hex_edges; ++e) edges.insert(ascending({hex[edge_corner(e, 0)], hex[edge_corner(e, 1)]}));
    }
  }
};

/// Ends of edges, and faces, of an element: written down again, by its number of corners and dimension.
std::vector<Nodes> edges_of(OtherShape shape, std::span<const Index> n) {
  const auto pick = [&](std::initializer_list<std::pair<int, int>> pairs) {
    std::vector<Nodes> result;
    for (const auto& [a, b] : pairs) result.push_back({n[a], n[b]});
    return result;
  };
  switch (shape) {
    case OtherShape::line:
      return pick({{0, 1}});
    case OtherShape::triangle:
      return pick({{0, 1}, {1, 2}, {0, 2}});
    case OtherShape::quad:
      return pick({{0, 1}, {1, 2}, {2, 3}, {0, 3}});
    case OtherShape::tetrahedron:
      return pick({{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}});
    case OtherShape::pyramid:
      return pick({{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}});
    case OtherShape::wedge:
      return pick({{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}});
    default:
      return {};
  }
}
std::vector<Nodes> faces_of(OtherShape shape, std::span<const Index> n) {
  const auto pick = [&](std::initializer_list<std::initializer_list<int>> lists) {
    std::vector<Nodes> result;
    for (const auto& list : lists) {
      result.emplace_back();
      for (const int i : list) result.back().push_back(n[i]);
    }
    return result;
  };
  switch (shape) {
    case OtherShape::triangle:
      return pick({{0, 1, 2}});
    case OtherShape::quad:
      return pick({{0, 1, 2, 3}});
    case OtherShape::tetrahedron:
      return pick({{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}});
    case OtherShape::pyramid:
      return pick({{0, 1, 2, 3}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}});
    case OtherShape::wedge:
      return pick({{0, 1, 2}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}});
    default:
      return {};
  }
}

bool inside_edge(const Vec3& a, const Vec3& b, const Vec3& p) {
  const Vec3 along = b - a;
  const double t = (p - a).dot(along) / along.squaredNorm();
  return t > 1e-6 && t < 1 - 1e-6 && (a + t * along - p).norm() < tiny;
}
bool inside_triangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  const Vec3 normal = (b - a).cross(c - a);
  const double area = normal.squaredNorm();
  if (!(area > 0) || std::abs((p - a).dot(normal)) > tiny * std::sqrt(area)) return false;
  const double u = (c - b).cross(p - b).dot(normal) / area, v = (a - c).cross(p - c).dot(normal) / area;
  return u > -1e-6 && v > -1e-6 && u + v < 1 + 1e-6;
}
bool inside_face(const Mesh& mesh, const Nodes& face, const Vec3& p) {
  for (std::size_t i = 1; i + 1 < face.size(); ++i)
    if (inside_triangle(mesh.points[face[0]], mesh.points[face[i]], mesh.points[face[i + 1]], p)) return true;
  return false;
}

Vec3 area_of(const Mesh& mesh, std::span<const Index> cycle) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < 4; ++i)
    sum += (mesh.points[cycle[i]] - mesh.points[cycle[0]]).cross(mesh.points[cycle[i + 1]] - mesh.points[cycle[0]]) / 2;
  return sum;
}

}  // namespace

Mesh with_others(Mesh mesh, std::mt19937& random, const Glue& glue) {
  const HexSkin skin(mesh);
  const Vec3 middle = (box(mesh).min + box(mesh).max) / 2;
  std::uniform_real_distribution<double> jitter(0.05, 0.2);
  const auto one_in = [&](int n) { return random() % static_cast<unsigned>(n) == 0; };
  OtherHeads heads;
  heads.format = "abaqus";
  heads.types = {{OtherShape::point, 1, "MASS"}, {OtherShape::line, 2, "B31"},         {OtherShape::triangle, 3, "S3"},
                 {OtherShape::quad, 4, "S4"},    {OtherShape::tetrahedron, 4, "C3D4"}, {OtherShape::pyramid, 5, "C3D5"},
                 {OtherShape::wedge, 6, "C3D6"}, {OtherShape::connector, 2, "SPRINGA"}};
  std::vector<Index> first = {0}, nodes;
  const auto add = [&](int type, const Nodes& of) {
    heads.type.push_back(type);
    nodes.insert(nodes.end(), of.begin(), of.end());
    first.push_back(static_cast<Index>(nodes.size()));
  };
  const auto outside = [&](const Nodes& around) {  // a new node off these
    Vec3 sum = Vec3::Zero();
    for (const Index n : around) sum += mesh.points[n];
    sum /= static_cast<double>(around.size());
    const Vec3 away = (sum - middle).normalized();
    mesh.points.push_back(sum + 0.4 * away + Vec3(jitter(random), jitter(random), jitter(random)));
    return mesh.n_nodes() - 1;
  };
  const auto low = [&](const Nodes& at) {
    return !glue.only_below || std::ranges::all_of(at, [&](Index n) { return mesh.points[n].z() == 0; });
  };
  std::set<Nodes> outer_edges;
  for (const auto& [key, face] : skin.faces) {
    Nodes cycle = face.first;
    std::ranges::rotate(cycle, cycle.begin() + static_cast<std::ptrdiff_t>(random() % 4));
    if (random() % 2) std::ranges::reverse(cycle);
    if (one_in(glue.skin_one_in)) add(3, cycle);
    if (face.second == 2) continue;
    for (int i = 0; i < 4; ++i) outer_edges.insert(ascending({cycle[i], cycle[(i + 1) % 4]}));
    if (!one_in(glue.rigid_one_in) || !low(cycle)) continue;
    cycle = face.first;
    if (random() % 2) {
      add(5, {cycle[0], cycle[1], cycle[2], cycle[3], outside(cycle)});
    } else {
      const Index a = outside({cycle[0], cycle[1]}), b = outside({cycle[3], cycle[2]});
      add(6, {cycle[0], cycle[1], a, cycle[3], cycle[2], b});
    }
  }
  for (const Nodes& edge : outer_edges) {
    if (!one_in(4 * glue.rigid_one_in) || !low(edge)) continue;
    const Index a = outside(edge);
    switch (random() % 3) {
      case 0:
        add(2, {edge[0], edge[1], a});
        break;
      case 1:
        add(3, {edge[0], edge[1], outside({edge[1], a}), a});
        break;
      default:
        add(4, {edge[0], edge[1], a, outside({edge[0], a})});
    }
  }
  for (const Nodes& edge : skin.edges)
    if (one_in(2 * glue.skin_one_in)) {
      Nodes line = edge;
      if (random() % 2) std::ranges::reverse(line);
      if (random() % 3 == 0) line.push_back(outside(edge));  // how it is turned
      add(1, line);
    }
  const auto any = [&] { return static_cast<Index>(random() % mesh.points.size()); };
  for (int i = 0; i < 5; ++i) {
    add(0, {any()});
    const Index a = any();
    add(7, {a, (a + 1) % mesh.n_nodes()});
    const Index b = outside({a});
    add(1, {b, outside({b})});  // a beam by itself
  }
  const auto n = static_cast<Index>(heads.type.size());
  const bool below = random() % 2;
  for (Index e = 0; e < n; ++e) heads.ids.push_back(below ? 2 * e + 1 : 2 * mesh.n_hexes() + 3 * e);
  if (below)
    for (Index h = 0; h < mesh.n_hexes(); ++h) mesh.hex_ids.push_back(2 * n + 2 + h);
  mesh.blocks = {{3, "mixed", {}}, {5, "others", {}}};
  heads.sets = {{3, {}}, {5, {}}};
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    if (h % 3 == 0) mesh.blocks[0].hexes.push_back(h);
  for (Index e = 0; e < n; ++e)
    for (OtherSet& set : heads.sets)
      if (random() % 2) set.elements.push_back(e);
  mesh.others = other_elements(std::move(heads), std::move(first), std::move(nodes));
  return mesh;
}

testing::AssertionResult others_kept(const Mesh& before, const Mesh& after) {
  if (!before.others)
    return after.others ? testing::AssertionFailure() << "others came from nowhere" : testing::AssertionSuccess();
  if (!after.others) return testing::AssertionFailure() << "all others are gone";
  const OtherElements &old = *before.others, &now = *after.others;
  std::map<Index, std::vector<Index>> pieces, was;
  for (Index e = 0; e < now.size(); ++e) pieces[now.of[e]].push_back(e);
  for (Index e = 0; e < old.size(); ++e) was[old.of[e]].push_back(e);
  if (pieces.size() != was.size())
    return testing::AssertionFailure() << was.size() << " elements have become " << pieces.size();
  const auto fail = [&](Index of) {
    return testing::AssertionFailure() << "element " << old.heads->ids[of] << " of type "
                                       << old.heads->types[old.heads->type[of]].name << ' ';
  };
  for (const auto& [of, list] : was) {
    const auto found = pieces.find(of);
    if (found == pieces.end()) return fail(of) << "is gone";
    const std::vector<Index>& parts = found->second;
    const OtherShape shape = old.heads->types[old.heads->type[of]].shape;
    if (parts.size() == list.size()) {
      for (std::size_t i = 0; i < parts.size(); ++i) {
        const auto a = old.nodes_of(list[i]), b = now.nodes_of(parts[i]);
        if (a.size() != b.size()) return fail(of) << "has another number of nodes";
        for (std::size_t c = 0; c < a.size(); ++c)
          if (before.points[a[c]] != after.points[b[c]]) return fail(of) << "has moved";
      }
      if (parts.size() == 1 && now.id(parts[0]) != old.id(list[0])) return fail(of) << "has another id";
      continue;
    }
    if (shape == OtherShape::quad) {
      Vec3 area_before = Vec3::Zero(), area_after = Vec3::Zero();
      double sum = 0;
      for (const Index e : list) area_before += area_of(before, old.nodes_of(e));
      for (const Index e : parts) {
        const Vec3 area = area_of(after, now.nodes_of(e));
        area_after += area;
        sum += area.norm();
        if (!(area.dot(area_before) > 0)) return fail(of) << "has a piece that turns the other way";
      }
      if ((area_after - area_before).norm() > tiny || std::abs(sum - area_before.norm()) > tiny)
        return fail(of) << "has pieces of another area";
    } else if (shape == OtherShape::line) {
      const auto whole = old.nodes_of(list.front()), last = old.nodes_of(list.back());
      Vec3 at = before.points[whole[0]];
      for (const Index e : parts) {
        const auto piece = now.nodes_of(e);
        if (after.points[piece[0]] != at) return fail(of) << "has pieces that do not follow each other";
        at = after.points[piece[1]];
        if (piece.size() != whole.size() || (piece.size() > 2 && after.points[piece[2]] != before.points[whole[2]]))
          return fail(of) << "has a piece without its third node";
      }
      if (at != before.points[last[1]]) return fail(of) << "ends elsewhere";
    } else {
      return fail(of) << "was cut into " << parts.size();
    }
  }
  return testing::AssertionSuccess();
}

testing::AssertionResult others_conformal(const Mesh& before, const Mesh& after) {
  const HexSkin old_skin(before), skin(after);
  const OtherElements &old = *before.others, &now = *after.others;
  std::map<Index, Index> first_old;
  for (Index e = old.size() - 1; e >= 0; --e) first_old[old.of[e]] = e;
  std::set<Index> used, theirs;
  for (const Hex& hex : after.hexes) used.insert(hex.begin(), hex.end());
  for (Index e = 0; e < now.size(); ++e) {
    const OtherType& type = now.type_of(e);
    const auto nodes = now.nodes_of(e);
    if (edges_of(type.shape, nodes).empty()) continue;
    theirs.insert(nodes.begin(), nodes.begin() + type.n_nodes);
  }
  used.insert(theirs.begin(), theirs.end());
  for (Index e = 0; e < now.size(); ++e) {
    const OtherShape shape = now.type_of(e).shape;
    const auto nodes = now.nodes_of(e), was = old.nodes_of(first_old.at(now.of[e]));
    const auto fail = [&] {
      return testing::AssertionFailure() << "element " << now.heads->ids[now.of[e]] << " of type "
                                         << now.type_of(e).name << ' ';
    };
    const std::vector<Nodes> edges = edges_of(shape, nodes), old_edges = edges_of(shape, was);
    const std::vector<Nodes> faces = faces_of(shape, nodes), old_faces = faces_of(shape, was);
    for (std::size_t i = 0; i < edges.size(); ++i) {
      if (shape != OtherShape::quad && old_skin.edges.contains(ascending(old_edges[i])) &&
          !skin.edges.contains(ascending(edges[i])))
        return fail() << "has an edge that is no edge of a hex any more";
      for (const Index n : used)
        if (n != edges[i][0] && n != edges[i][1] &&
            inside_edge(after.points[edges[i][0]], after.points[edges[i][1]], after.points[n]))
          return fail() << "has node " << n << " inside an edge";
    }
    for (std::size_t i = 0; i < faces.size(); ++i) {
      if (old_skin.faces.contains(ascending(old_faces[i])) && !skin.faces.contains(ascending(faces[i])))
        return fail() << "has a face that is no face of a hex any more";
      for (const Index n : used)
        if (std::ranges::find(faces[i], n) == faces[i].end() && inside_face(after, faces[i], after.points[n]))
          return fail() << "has node " << n << " inside a face";
    }
  }
  for (const Index n : theirs) {
    for (const Nodes& edge : skin.edges)
      if (n != edge[0] && n != edge[1] && inside_edge(after.points[edge[0]], after.points[edge[1]], after.points[n]))
        return testing::AssertionFailure() << "node " << n << " of another element lies inside an edge of a hex";
    for (const auto& [key, face] : skin.faces)
      if (!std::ranges::binary_search(key, n) && inside_face(after, face.first, after.points[n]))
        return testing::AssertionFailure() << "node " << n << " of another element lies inside a face of a hex";
  }
  return testing::AssertionSuccess();
}

bool has_node_in_rigid_edge(const Mesh& with, const Mesh& mesh) {
  const HexSkin skin(with);
  const OtherElements& others = *with.others;
  for (Index e = 0; e < others.size(); ++e) {
    const OtherShape shape = others.type_of(e).shape;
    const auto nodes = others.nodes_of(e);
    if (shape == OtherShape::line ||
        (shape == OtherShape::quad && skin.faces.contains(ascending({nodes[0], nodes[1], nodes[2], nodes[3]}))))
      continue;
    for (const Nodes& edge : edges_of(shape, nodes))
      for (const Vec3& p : mesh.points)
        if (inside_edge(with.points[edge[0]], with.points[edge[1]], p)) return true;
  }
  return false;
}

}  // namespace hextwist::test
