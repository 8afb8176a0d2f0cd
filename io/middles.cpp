#include "hextwist/io/middles.h"

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/io/results.h"
#include "hextwist/mesh/others.h"

namespace hextwist::io {
namespace {

/// The middle node of an edge or face that hexes around agree on; -1 none.
class Agreed {
 public:
  Agreed(std::size_t n, const Mesh& mesh, const char* what) : node_(n, -1), hex_(n, -1), mesh_(mesh), what_(what) {}

  void add(Index item, Index node, Index hex) {
    if (node < 0) return;
    if (node_[item] >= 0 && node_[item] != node)
      throw Error("hexes " + std::to_string(hex_id(mesh_, hex_[item])) + " and " + std::to_string(hex_id(mesh_, hex)) +
                  " have different middle nodes on a common " + what_ + ", " +
                  std::to_string(node_id(mesh_, node_[item])) + " and " + std::to_string(node_id(mesh_, node)));
    node_[item] = node;
    hex_[item] = hex;
  }
  const std::vector<Index>& nodes() const { return node_; }

 private:
  std::vector<Index> node_, hex_;
  const Mesh& mesh_;
  const char* what_;
};

/// What the file has for all its nodes at all times, without the middle ones.
std::shared_ptr<const FileResults> without(const FileResults& results, std::span<const Index> kept,
                                           std::span<const Index> now) {
  auto out = std::make_shared<FileResults>(results);
  if (results.mesh) {
    auto mesh = std::make_shared<Mesh>(*results.mesh);
    mesh->points = items_at(results.mesh->points, kept);
    for (Hex& hex : mesh->hexes)
      for (Index& node : hex) node = now[node];
    out->mesh = std::move(mesh);
  }
  using Values = std::vector<double>;
  for (TimedValues& values : out->on_nodes)
    for (auto& at : values.at) at = std::make_shared<const Values>(items_at(*at, kept));
  for (SetExtras& set : out->node_sets) {
    if (set.nodes.empty()) continue;
    const std::vector<Index> members =
        indices_where(static_cast<Index>(set.nodes.size()), [&](Index i) { return now[set.nodes[i]] >= 0; });
    set.nodes = items_at(set.nodes, members);
    for (Index& node : set.nodes) node = now[node];
    if (set.factors.size() > 1) set.factors = items_at(set.factors, members);
    for (TimedValues& values : set.variables)
      for (auto& at : values.at) at = std::make_shared<const Values>(items_at(*at, members));
  }
  return out;
}

}  // namespace

void FoundMiddles::add(std::size_t hex, std::span<const Index> in_file, const MiddleOrder& order) {
  const std::size_t first = width * hex;
  nodes.resize(std::max(nodes.size(), first + width), -1);
  for (std::size_t i = 0; i < in_file.size(); ++i) nodes[first + static_cast<std::size_t>(order[i])] = in_file[i];
  nodes_per_hex = std::max(nodes_per_hex, 8 + static_cast<int>(in_file.size()));
}

namespace {

/// Middle nodes are made anew when a file is written: in sets that have both ends of their edge, with values halfway.
void say_what_middles_had(const Mesh& mesh, const Edges& edges, std::span<const Index> middle_of_edge,
                          std::vector<std::string>& notices) {
  const auto say = [&](std::vector<std::string> names, const std::string& what) {
    constexpr std::size_t most = 3;
    if (names.empty()) return;
    const std::size_t n_more = names.size() - std::min(names.size(), most);
    names.resize(names.size() - n_more);
    notices.push_back(what + ": " + joined(names, ", ") +
                      (n_more > 0 ? " and " + std::to_string(n_more) + " more" : ""));
  };
  std::vector<std::string> losing, gaining, bent;
  std::vector<std::uint8_t> in_set(mesh.points.size(), 0);
  for (const NodeSet& set : mesh.node_sets) {
    for (const Index n : set.nodes) in_set[n] = 1;
    bool loses = false, gains = false;
    for (std::size_t e = 0; e < edges.nodes.size(); ++e) {
      if (middle_of_edge[e] < 0) continue;
      const bool has = in_set[middle_of_edge[e]] != 0, will = in_set[edges.nodes[e][0]] && in_set[edges.nodes[e][1]];
      loses = loses || (has && !will);
      gains = gains || (will && !has);
    }
    for (const Index n : set.nodes) in_set[n] = 0;
    const std::string name = set.name.empty() ? std::to_string(set.id) : "'" + set.name + "'";
    if (loses) losing.push_back(name);
    if (gains) gaining.push_back(name);
  }
  for (const Field& field : mesh.fields) {
    if (field.on != Field::On::node) continue;
    const auto width = static_cast<std::size_t>(field.components);
    bool is_halfway = true;
    for (std::size_t e = 0; e < edges.nodes.size() && is_halfway; ++e)
      for (std::size_t c = 0; c < width && is_halfway && middle_of_edge[e] >= 0; ++c) {
        const auto at = [&](Index n) { return field.values[static_cast<std::size_t>(n) * width + c]; };
        const double a = at(edges.nodes[e][0]), b = at(edges.nodes[e][1]);
        is_halfway = !(std::abs(at(middle_of_edge[e]) - (a + b) / 2) > 1e-9 * (std::abs(a) + std::abs(b)));
      }
    if (!is_halfway) bent.push_back("'" + field.name + "'");
  }
  say(std::move(losing), "node sets that lose middle nodes, since they have one end of the edge at most");
  say(std::move(gaining), "node sets that have the middle nodes of all their edges, where the file leaves some out");
  say(std::move(bent), "values at middle nodes are halfway between those at corners, and were others in the file, of");
}

}  // namespace

void take_middles(MeshFile& file, const FoundMiddles& found) {
  Mesh& mesh = file.mesh;
  const Edges mesh_edges = edges(mesh);
  const Faces mesh_faces = faces(mesh);
  std::vector<std::uint8_t> is_corner(mesh.points.size(), 0), is_middle(mesh.points.size(), 0);
  for (const Hex& hex : mesh.hexes)
    for (const Index node : hex) is_corner[node] = 1;
  Agreed of_edge(mesh_edges.nodes.size(), mesh, "edge"), of_face(mesh_faces.nodes.size(), mesh, "face");
  Index n_straight = 0;
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    const auto middles =
        std::span(found.nodes).subspan(FoundMiddles::width * static_cast<std::size_t>(h), FoundMiddles::width);
    n_straight += middles[0] < 0;
    for (const Index node : middles) {
      if (node < 0) continue;
      if (is_corner[node])
        throw Error("node " + std::to_string(node_id(mesh, node)) + " is a middle node of hex " +
                    std::to_string(hex_id(mesh, h)) + " and a corner of another hex: they do not fit together");
      is_middle[node] = 1;
    }
    for (int e = 0; e < n_hex_edges; ++e) of_edge.add(mesh_edges.of_hex[h][e], middles[e], h);
    for (int f = 0; f < n_hex_faces; ++f)
      of_face.add(mesh_faces.of_hex[h][f], middles[static_cast<std::size_t>(n_hex_edges + f)], h);
  }
  for (Index e = 0; e < n_others(mesh); ++e)
    for (const Index node : mesh.others->nodes_of(e))
      if (is_middle[node])
        throw Error(other_text(mesh, e) + " has node " + std::to_string(node_id(mesh, node)) +
                    ", which is a middle node of a hex: those are made anew here, and other elements can't have them");
  if (n_straight > 0)
    file.notices.push_back(counted(n_straight, "hex", "hexes") +
                           " without middle nodes beside others that have some: " +
                           "taken as straight where no neighbour bends " + (n_straight == 1 ? "it" : "them"));

  const std::vector<Index> kept = indices_where(mesh.n_nodes(), [&](Index n) { return is_middle[n] == 0; });
  std::vector<Index> now(mesh.points.size(), -1);
  for (std::size_t i = 0; i < kept.size(); ++i) now[kept[i]] = static_cast<Index>(i);

  say_what_middles_had(mesh, mesh_edges, of_edge.nodes(), file.notices);

  MiddleNodes& middles = file.middles;
  middles.nodes_per_hex = file.extras.nodes_per_hex[0] = found.nodes_per_hex;
  for (std::size_t e = 0; e < mesh_edges.nodes.size(); ++e) {
    if (of_edge.nodes()[e] < 0) continue;
    // Ascending as before, since the order of what is left is kept.
    middles.edges.push_back({now[mesh_edges.nodes[e][0]], now[mesh_edges.nodes[e][1]]});
    middles.edge_points.push_back(mesh.points[of_edge.nodes()[e]]);
  }
  std::vector<std::pair<Quad, Vec3>> quads;
  for (std::size_t f = 0; f < mesh_faces.nodes.size(); ++f) {
    if (of_face.nodes()[f] < 0) continue;
    Quad quad = mesh_faces.nodes[f];
    for (Index& node : quad) node = now[node];
    quads.emplace_back(ascending(quad), mesh.points[of_face.nodes()[f]]);
  }
  std::ranges::sort(quads, {}, &std::pair<Quad, Vec3>::first);
  for (const auto& [quad, point] : quads) {
    middles.faces.push_back(quad);
    middles.face_points.push_back(point);
  }

  // Nodes as their users know them; ids of those that are left stay.
  std::vector<std::int64_t> ids;
  for (const Index n : kept) ids.push_back(node_id(mesh, n));
  mesh.node_ids = ids.empty() || ids.back() == std::ssize(ids) ? std::vector<std::int64_t>{} : std::move(ids);
  mesh.points = items_at(mesh.points, kept);
  for (Hex& hex : mesh.hexes)
    for (Index& node : hex) node = now[node];
  mesh.others = renumbered(mesh.others, now);
  for (NodeSet& set : mesh.node_sets) {
    std::erase_if(set.nodes, [&](Index n) { return now[n] < 0; });
    for (Index& node : set.nodes) node = now[node];
  }
  for (Field& field : mesh.fields)
    if (field.on == Field::On::node)
      field.values = items_at(field.values, kept, static_cast<std::size_t>(field.components));
  if (mesh.results) mesh.results = without(*mesh.results, kept, now);
  Association& tags = file.tags;
  if (!tags.node_owner.empty()) tags.node_owner = items_at(tags.node_owner, kept);
  if (!tags.node_parameters.empty()) tags.node_parameters = items_at(tags.node_parameters, kept);
  for (Edge& edge : tags.curve_edges) edge = {now[edge[0]], now[edge[1]]};
  for (PeriodicPairs& pairs : file.extras.periodic)
    std::erase_if(pairs.nodes,
                  [&](const auto& pair) { return find_node(mesh, pair[0]) < 0 || find_node(mesh, pair[1]) < 0; });
}

FileHex file_hex(const Mesh& mesh, const SecondOrder* second, Index hex, const MiddleOrder& order) {
  FileHex result;
  const Hex corners = in_file_order(mesh.hexes[hex]);
  std::ranges::copy(corners, result.nodes.begin());
  if (!second) return result;
  result.n = second->nodes_per_hex;
  const auto middles = second->middles(hex);
  for (int i = 8; i < result.n; ++i) result.nodes[i] = middles[order[i - 8]];
  return result;
}

}  // namespace hextwist::io
