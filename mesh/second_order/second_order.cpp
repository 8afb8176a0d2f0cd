#include "hextwist/mesh/second_order/second_order.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "hextwist/base/large_array.h"
#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/base/text.h"
#include "hextwist/mesh/second_order/middle_nodes.h"
#include "hextwist/mesh/second_order/middles_internal.h"

namespace hextwist {
namespace {

using detail::Displacements;

/// How much of a displacement is left after a hex was found wanting so often.
constexpr std::array<double, 4> left = {1, 0.5, 0.25, 0};

class Maker {
 public:
  Maker(const Mesh& mesh, const Association& association, const Model* model, int nodes_per_hex)
      : mesh_(mesh), association_(association), model_(model) {
    assert(nodes_per_hex == 20 || nodes_per_hex == 27);
    out_.nodes_per_hex = nodes_per_hex;
    out_.n_corners = mesh.n_nodes();
  }

  SecondOrder result() {
    out_.edges = edges(mesh_);
    out_.faces = faces(mesh_);
    displace();
    straighten();
    place();
    sets_and_fields();
    return std::move(out_);
  }

 private:
  bool has_faces() const { return out_.nodes_per_hex == 27; }

  void displace() {
    const std::size_t n_edges = out_.edges.nodes.size(), n_faces = out_.faces.nodes.size();
    d_.edge.assign(n_edges, Vec3::Zero());
    d_.face.assign(n_faces, Vec3::Zero());
    d_.edge_parameters.resize(n_edges);
    d_.face_parameters.resize(n_faces);
    d_.edge_far.assign(n_edges, 0);
    d_.face_far.assign(n_faces, 0);
    edge_left_.assign(n_edges, 0);
    face_left_.assign(n_faces, 0);
    detail::find_owners(mesh_, association_, out_.edges, out_.faces, d_);
    if (!model_ || association_.empty()) return;
    detail::displace_edges(mesh_, association_, *model_, out_.edges, d_);
    if (has_faces()) detail::displace_faces(mesh_, association_, *model_, out_.edges, out_.faces, d_);
  }

  Vec3 edge_point(Index e) const {
    return detail::halfway(mesh_, out_.edges.nodes[e]) + left[edge_left_[e]] * d_.edge[e];
  }
  Vec3 face_point(Index f) const {
    return detail::blended(mesh_, out_.edges, out_.faces.sides[f][0], [&](Index e) { return edge_point(e); }) +
           left[face_left_[f]] * d_.face[f];
  }
  bool is_curved(Index h) const {
    return std::ranges::any_of(out_.edges.of_hex[h],
                               [&](Index e) { return edge_left_[e] < 3 && !d_.edge[e].isZero(0); }) ||
           std::ranges::any_of(out_.faces.of_hex[h],
                               [&](Index f) { return face_left_[f] < 3 && !d_.face[f].isZero(0); });
  }
  QuadraticHex hex_now(Index h) const {
    QuadraticHex hex;
    for (int c = 0; c < n_hex_corners; ++c) hex[quadratic_corner(c)] = mesh_.points[mesh_.hexes[h][c]];
    for (int e = 0; e < n_hex_edges; ++e) hex[quadratic_edge(e)] = edge_point(out_.edges.of_hex[h][e]);
    blend_faces(hex);
    if (!has_faces()) return hex;
    for (int f = 0; f < n_hex_faces; ++f) hex[quadratic_face(f)] = face_point(out_.faces.of_hex[h][f]);
    blend_centre(hex);
    return hex;
  }

  void straighten() {
    std::vector<Index> open = indices_where(mesh_.n_hexes(), [&](Index h) { return is_curved(h); });
    std::vector<std::uint8_t> level(mesh_.hexes.size(), 0);
    while (!open.empty()) {
      const std::vector<Index> bad = indices_where(static_cast<Index>(open.size()),
                                                   [&](Index i) { return !is_positive_everywhere(hex_now(open[i])); });
      std::vector<std::uint8_t> changed(out_.edges.nodes.size(), 0);
      for (const Index i : bad) {
        const Index h = open[i];
        level[h] = std::min<std::uint8_t>(level[h] + 1, 3);
        for (const Index e : out_.edges.of_hex[h])
          if (level[h] > edge_left_[e]) edge_left_[e] = level[h], changed[e] = 1;
        for (const Index f : out_.faces.of_hex[h]) face_left_[f] = std::max(face_left_[f], level[h]);
      }
      if (bad.empty()) break;
      // Whoever has one of these edges is looked at again; who is straight by now is as good as the mesh is.
      open = indices_where(mesh_.n_hexes(), [&](Index h) {
        return std::ranges::any_of(out_.edges.of_hex[h], [&](Index e) { return changed[e] != 0; }) && is_curved(h);
      });
    }
    for (Index h = 0; h < mesh_.n_hexes(); ++h)
      if (level[h] > 0) out_.straightened.push_back(h);
  }

  void add_node(const Vec3& point, Owner owner, Parameters at, double off) {
    if (owner.dim == 1 || owner.dim == 2) {
      out_.n_off += off > 0;
      if (off > out_.farthest) out_.farthest = off, out_.worst = out_.mesh.n_nodes();
    }
    out_.mesh.points.push_back(point);
    if (association_.empty()) return;
    out_.association.node_owner.push_back(owner);
    out_.association.node_parameters.push_back(off > 0 ? Parameters{} : at);
  }

  void place() {
    out_.mesh = mesh_;
    out_.association = association_;
    const std::size_t n_edges = out_.edges.nodes.size(), n_faces = has_faces() ? out_.faces.nodes.size() : 0;
    const std::size_t n_hexes = has_faces() ? mesh_.hexes.size() : 0;
    const std::size_t n = mesh_.points.size() + n_edges + n_faces + n_hexes;
    if (n > static_cast<std::size_t>(std::numeric_limits<Index>::max()))
      throw Error("the mesh of second order would have " + std::to_string(n) + " nodes, more than can be counted here");
    out_.mesh.points.reserve(n);
    for (std::size_t e = 0; e < n_edges; ++e)
      add_node(edge_point(static_cast<Index>(e)), d_.edge_owner[e], d_.edge_parameters[e],
               d_.edge_far[e] + (1 - left[edge_left_[e]]) * d_.edge[e].norm());
    for (std::size_t f = 0; f < n_faces; ++f) {
      // Edges that were straightened have taken the face with them.
      double off = d_.face_far[f] + (1 - left[face_left_[f]]) * d_.face[f].norm();
      const Side side = out_.faces.sides[f][0];
      for (int j = 0; j < 4; ++j) {
        const Index e = out_.edges.of_hex[side.hex][face_edge(side.face, j)];
        off += 0.5 * (1 - left[edge_left_[e]]) * d_.edge[e].norm();
      }
      add_node(face_point(static_cast<Index>(f)), d_.face_owner[f], d_.face_parameters[f], off);
    }
    for (std::size_t h = 0; h < n_hexes; ++h)
      add_node(hex_now(static_cast<Index>(h))[quadratic_centre], {3, volume(static_cast<Index>(h))}, {}, 0);
    auto& ids = out_.mesh.node_ids;
    if (!ids.empty())
      for (std::int64_t id = ids.back(); ids.size() < out_.mesh.points.size();) ids.push_back(++id);
  }
  int volume(Index h) const { return association_.hex_volume.empty() ? 0 : association_.hex_volume[h]; }

  /// f(middle node, the corners around it).
  template <class F>
  void each_middle(F&& f) const {
    for (std::size_t e = 0; e < out_.edges.nodes.size(); ++e)
      f(out_.edge_middle(static_cast<Index>(e)), std::span<const Index>(out_.edges.nodes[e]));
    if (!has_faces()) return;
    for (std::size_t k = 0; k < out_.faces.nodes.size(); ++k)
      f(out_.face_middle(static_cast<Index>(k)), std::span<const Index>(out_.faces.nodes[k]));
    for (Index h = 0; h < mesh_.n_hexes(); ++h) f(out_.hex_middle(h), std::span<const Index>(mesh_.hexes[h]));
  }

  void sets_and_fields() {
    for (NodeSet& set : out_.mesh.node_sets) {
      std::vector<std::uint8_t> member(mesh_.points.size(), 0);
      for (const Index n : set.nodes) member[n] = 1;
      // What a set of whole curves, surfaces or volumes is meant to hold lies on those, not across.
      int most = 3;
      if (!set.meant.empty()) most = std::ranges::max(set.meant, {}, &Owner::dim).dim;
      each_middle([&](Index middle, std::span<const Index> corners) {
        if (!std::ranges::all_of(corners, [&](Index n) { return member[n] != 0; })) return;
        const Owner owner = association_.empty() ? Owner{} : out_.association.node_owner[middle];
        if (owner.dim > most) return;
        if (owner.dim == most && !set.meant.empty() && std::ranges::find(set.meant, owner) == set.meant.end()) return;
        set.nodes.push_back(middle);
      });
    }
    for (Field& field : out_.mesh.fields) {
      if (field.on != Field::On::node) continue;
      const auto width = static_cast<std::size_t>(field.components);
      field.values.reserve(width * out_.mesh.points.size());
      each_middle([&](Index, std::span<const Index> corners) {
        for (std::size_t c = 0; c < width; ++c) {
          double sum = 0;
          for (const Index n : corners) sum += field.values[n * width + c];
          field.values.push_back(field.integer ? field.values[corners[0] * width + c]
                                               : sum / static_cast<double>(corners.size()));
        }
      });
    }
  }

  const Mesh& mesh_;
  const Association& association_;
  const Model* model_;
  SecondOrder out_;
  Displacements d_;
  std::vector<std::uint8_t> edge_left_, face_left_;  // positions in `left`
};

}  // namespace

Quad ascending(Quad nodes) {
  std::ranges::sort(nodes);
  return nodes;
}

Index SecondOrder::middle_between(Index a, Index b) const {
  const Index edge = find_edge(edges, a, b);
  return edge < 0 ? -1 : edge_middle(edge);
}
Index SecondOrder::middle_of(const Quad& corners) const {
  const Index face = find_face(faces, corners);
  return face < 0 ? -1 : face_middle(face);
}
std::array<Index, 19> SecondOrder::middles(Index hex) const {
  std::array<Index, 19> result{};
  for (int e = 0; e < n_hex_edges; ++e) result[e] = edge_middle(edges.of_hex[hex][e]);
  for (int f = 0; f < n_hex_faces; ++f) result[n_hex_edges + f] = face_middle(faces.of_hex[hex][f]);
  result[18] = hex_middle(hex);
  return result;
}

SecondOrder second_order(const Mesh& mesh, const Association& association, const Model* model, int nodes_per_hex) {
  return Maker(mesh, association, model, nodes_per_hex).result();
}

MiddleNodes middle_nodes(const SecondOrder& mesh) {
  MiddleNodes out;
  out.nodes_per_hex = mesh.nodes_per_hex;
  out.edges = mesh.edges.nodes;
  for (std::size_t e = 0; e < out.edges.size(); ++e)
    out.edge_points.push_back(mesh.mesh.points[mesh.edge_middle(static_cast<Index>(e))]);
  if (mesh.nodes_per_hex == 20) return out;
  std::vector<std::pair<Quad, Index>> order;
  for (std::size_t f = 0; f < mesh.faces.nodes.size(); ++f)
    order.emplace_back(ascending(mesh.faces.nodes[f]), mesh.face_middle(static_cast<Index>(f)));
  std::ranges::sort(order);
  for (const auto& [quad, middle] : order) {
    out.faces.push_back(quad);
    out.face_points.push_back(mesh.mesh.points[middle]);
  }
  return out;
}

MiddleNodes skin_middles(const MeshedModel& meshed) {
  if (!meshed.model || meshed.model->count(2) == 0 || meshed.model->type({2, 1}) != "quadratic facets") return {};
  return middle_nodes(second_order(meshed.mesh, meshed.association, meshed.model.get(), 27));
}

std::string straightened_text(const SecondOrder& mesh) {
  std::string text;
  if (const auto n = std::ssize(mesh.straightened); n > 0)
    text = counted(n, "hex", "hexes") + (n == 1 ? " was" : " were") + " straightened, as " + (n == 1 ? "it" : "they") +
           " would not have been positive everywhere with all middle nodes in place (hex " +
           std::to_string(hex_id(mesh.mesh, mesh.straightened.front())) + (n == 1 ? ")" : ", ...)");
  if (mesh.worst >= 0)
    text += (text.empty() ? "" : "; ") + counted(mesh.n_off, "middle node") + (mesh.n_off == 1 ? " is" : " are") +
            " off the model, node " + std::to_string(node_id(mesh.mesh, mesh.worst)) + " the farthest, by " +
            short_number(mesh.farthest);
  return text;
}

QuadraticHex quadratic_hex(const SecondOrder& mesh, Index hex) {
  QuadraticHex result;
  const auto middles = mesh.middles(hex);
  for (int c = 0; c < n_hex_corners; ++c) result[quadratic_corner(c)] = mesh.mesh.points[mesh.mesh.hexes[hex][c]];
  for (int e = 0; e < n_hex_edges; ++e) result[quadratic_edge(e)] = mesh.mesh.points[middles[e]];
  blend_faces(result);
  if (mesh.nodes_per_hex == 20) return result;
  for (int f = 0; f < n_hex_faces; ++f)
    result[quadratic_face(f)] = mesh.mesh.points[middles[static_cast<std::size_t>(n_hex_edges) + f]];
  result[quadratic_centre] = mesh.mesh.points[middles[18]];
  return result;
}

}  // namespace hextwist
