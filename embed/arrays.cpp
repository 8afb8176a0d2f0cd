#include "hextwist/embed/arrays.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "hextwist/base/sorted.h"
#include "hextwist/io/field_names.h"
#include "hextwist/io/format.h"
#include "hextwist/mesh/corners.h"

namespace hextwist {
namespace {

/// An array of n items of that width; throws when it is missing.
template <class T>
std::span<const T> items(const T* values, std::int64_t n, int width, const std::string& name) {
  if (n < 0) throw Error(name + ": there can't be " + std::to_string(n));
  if (n > std::numeric_limits<Index>::max())
    throw Error(name + ": " + std::to_string(n) + " are more than the " +
                std::to_string(std::numeric_limits<Index>::max()) + " that a mesh can have");
  if (n > 0 && !values) throw Error(name + ": the array is missing");
  return {values, static_cast<std::size_t>(n) * static_cast<std::size_t>(width)};
}

std::string place(const std::string& name, std::size_t i, int width) {
  return name + "[" + std::to_string(i / static_cast<std::size_t>(width)) + "]";
}

/// Throws at the first that is no position below n.
void check_positions(std::span<const std::int32_t> positions, Index n, int width, const std::string& name,
                     const char* of) {
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (positions[i] < 0 || positions[i] >= n)
      throw Error(place(name, i, width) + ": there is no " + of + " " + std::to_string(positions[i]) +
                  " (positions count from 0, there are " + std::to_string(n) + ")");
}

std::vector<std::int64_t> ids(const std::int64_t* values, std::int64_t n, const std::string& name) {
  if (!values) return {};
  std::vector<std::int64_t> result(values, values + n);
  for (std::size_t i = 0; i < result.size(); ++i)
    if (result[i] < 1 || (i > 0 && result[i] <= result[i - 1]))
      throw Error(place(name, i, 1) + ": ids are positive and ascend, not " + std::to_string(result[i]));
  if (!result.empty() && result.back() > io::highest_readable_id)
    throw Error(place(name, result.size() - 1, 1) + ": id " + std::to_string(result.back()) + " is too large");
  const bool counted = !result.empty() && result.back() == static_cast<std::int64_t>(result.size());
  return counted ? std::vector<std::int64_t>() : result;  // the mesh has none where they are 1, 2, ...
}

std::vector<Quad> quads(std::span<const std::int32_t> nodes) {
  std::vector<Quad> result(nodes.size() / 4);
  for (std::size_t i = 0; i < nodes.size(); ++i) result[i / 4][i % 4] = nodes[i];
  return result;
}

/// Calls take(group, members) for each, ids ascending afterwards.
template <class Group, class F>
void groups(const hextwist_group* given, std::int64_t n, int width, const std::string& name, std::vector<Group>& to,
            F take) {
  std::set<int> seen;
  for (const hextwist_group& group : items(given, n, 1, name)) {
    const std::string one = name + " " + std::to_string(group.id);
    if (group.id < 1) throw Error(one + ": ids are positive");
    if (!seen.insert(group.id).second) throw Error(one + " occurs twice");
    to.push_back({group.id, group.name ? group.name : "", {}});
    take(to.back(), items(group.members, group.n, width, one), one);
  }
  std::ranges::sort(to, {}, &Group::id);
}

void read_groups(const hextwist_arrays& in, Mesh& mesh) {
  groups(in.blocks, in.n_blocks, 1, "block", mesh.blocks, [&](Block& block, auto members, const std::string& name) {
    check_positions(members, mesh.n_hexes(), 1, name, "hex");
    block.hexes.assign(members.begin(), members.end());
    sort_unique(block.hexes);
  });
  groups(in.node_sets, in.n_node_sets, 1, "node set", mesh.node_sets,
         [&](NodeSet& set, auto members, const std::string& name) {
           check_positions(members, mesh.n_nodes(), 1, name, "node");
           set.nodes.assign(members.begin(), members.end());
           sort_unique(set.nodes);
         });
  groups(in.side_sets, in.n_side_sets, 4, "side set", mesh.side_sets,
         [&](SideSet& set, auto members, const std::string& name) {
           check_positions(members, mesh.n_nodes(), 4, name, "node");
           set.sides = io::oriented_sides(mesh, quads(members));
           const auto lost = std::ranges::find(set.sides, -1, &Side::hex);
           if (lost != set.sides.end())
             throw Error(name + "[" + std::to_string(lost - set.sides.begin()) + "] is not a side of a hex");
           sort_unique(set.sides);
         });
}

void read_fields(const hextwist_arrays& in, Mesh& mesh) {
  for (const hextwist_field& given : items(in.fields, in.n_fields, 1, "fields")) {
    const std::string name = given.name ? given.name : "";
    if (name.empty()) throw Error("fields have names");
    if (given.n_components < 1) throw Error("field '" + name + "' has no component");
    const std::int64_t n = given.on_hexes ? in.n_hexes : in.n_nodes;
    const auto values = items(given.values, n, given.n_components, "field '" + name + "'");
    const Field::On on = given.on_hexes ? Field::On::hex : Field::On::node;
    if (std::ranges::any_of(mesh.fields, [&](const Field& field) { return field.name == name && field.on == on; }))
      throw Error("two fields of " + std::string(given.on_hexes ? "hexes" : "nodes") + " are called '" + name + "'");
    mesh.fields.push_back({name, on, given.n_components, {values.begin(), values.end()}, given.is_integer != 0});
    io::check_whole_numbers(mesh.fields.back());
  }
}

void read_owners(const hextwist_arrays& in, MeshFile& file) {
  const Mesh& mesh = file.mesh;
  Association& tags = file.tags;
  if (!in.node_owners && !in.hex_volumes && in.n_curve_edges == 0 && in.n_surface_quads == 0) return;
  tags.node_owner.resize(mesh.points.size());
  tags.node_parameters.resize(mesh.points.size());
  tags.hex_volume.assign(mesh.hexes.size(), 0);
  if (in.node_owners)
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
      const Owner owner{in.node_owners[2 * i], in.node_owners[2 * i + 1]};
      if (owner.dim < -1 || owner.dim > 3)
        throw Error(place("node_owners", i, 1) + ": there is no dimension " + std::to_string(owner.dim));
      if (owner.dim >= 0) tags.node_owner[i] = owner;
    }
  if (in.hex_volumes) tags.hex_volume.assign(in.hex_volumes, in.hex_volumes + in.n_hexes);
  for (std::size_t i = 0; i < tags.hex_volume.size(); ++i)
    if (tags.hex_volume[i] < 0)
      throw Error(place("hex_volumes", i, 1) + ": there is no volume " + std::to_string(tags.hex_volume[i]));

  const auto edges = items(in.curve_edges, in.n_curve_edges, 2, "curve_edges");
  const auto curves = items(in.edge_curves, in.n_curve_edges, 1, "edge_curves");
  check_positions(edges, mesh.n_nodes(), 2, "curve_edges", "node");
  std::vector<std::pair<Edge, int>> on_curves;
  for (std::size_t i = 0; i < curves.size(); ++i)
    on_curves.push_back(
        {{std::min(edges[2 * i], edges[2 * i + 1]), std::max(edges[2 * i], edges[2 * i + 1])}, curves[i]});
  std::ranges::sort(on_curves);
  on_curves.erase(std::ranges::unique(on_curves, {}, [](const auto& each) { return each.first; }).begin(),
                  on_curves.end());
  std::vector<Edge> pairs;
  pairs.reserve(on_curves.size());
  for (const auto& [edge, curve] : on_curves) pairs.push_back(edge);
  const std::vector<char> good = io::are_edges(mesh, pairs);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!good[i]) continue;
    tags.curve_edges.push_back(pairs[i]);
    tags.edge_curve.push_back(on_curves[i].second);
  }
  if (const auto lost = std::ranges::count(good, 0))
    file.notices.push_back(std::to_string(lost) + " of curve_edges are not edges of hexes");

  const auto nodes = items(in.surface_quads, in.n_surface_quads, 4, "surface_quads");
  const auto surfaces = items(in.quad_surfaces, in.n_surface_quads, 1, "quad_surfaces");
  check_positions(nodes, mesh.n_nodes(), 4, "surface_quads", "node");
  const std::vector<Side> sides = find_sides(mesh, quads(nodes));
  std::vector<std::pair<Side, int>> on_surfaces;
  for (std::size_t i = 0; i < sides.size(); ++i)
    if (sides[i].hex >= 0) on_surfaces.emplace_back(sides[i], surfaces[i]);
  if (on_surfaces.size() < sides.size())
    file.notices.push_back(std::to_string(sides.size() - on_surfaces.size()) +
                           " of surface_quads are not sides of hexes");
  std::ranges::sort(on_surfaces);
  on_surfaces.erase(std::ranges::unique(on_surfaces, {}, [](const auto& each) { return each.first; }).begin(),
                    on_surfaces.end());
  for (const auto& [side, surface] : on_surfaces) {
    tags.surface_faces.push_back(side);
    tags.face_surface.push_back(surface);
  }
}

}  // namespace

MeshFile mesh_from_arrays(const hextwist_arrays& in) {
  MeshFile file;
  Mesh& mesh = file.mesh;
  const auto points = items(in.points, in.n_nodes, 3, "points");
  const auto hexes = items(in.hexes, in.n_hexes, 8, "hexes");
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!std::isfinite(points[i])) throw Error(place("points", i, 3) + ": a coordinate is not finite");
  check_positions(hexes, static_cast<Index>(in.n_nodes), 8, "hexes", "node");
  mesh.points.resize(static_cast<std::size_t>(in.n_nodes));
  for (std::size_t i = 0; i < mesh.points.size(); ++i) mesh.points[i] = Vec3(points.data() + 3 * i);
  mesh.hexes.resize(static_cast<std::size_t>(in.n_hexes));
  for (std::size_t h = 0; h < mesh.hexes.size(); ++h)
    for (int c = 0; c < n_hex_corners; ++c) mesh.hexes[h][file_corner[c]] = hexes[8 * h + static_cast<std::size_t>(c)];
  mesh.node_ids = ids(in.node_ids, in.n_nodes, "node_ids");
  mesh.hex_ids = ids(in.hex_ids, in.n_hexes, "hex_ids");
  read_groups(in, mesh);
  read_fields(in, mesh);
  read_owners(in, file);
  return file;
}

}  // namespace hextwist
