// One process of several that have their mesh in parts: parts_call MESH CAD|- SEED COMMAND ...
//
// Each takes the hexes that chance gives it, in any order, as arrays, and has them refined. What all have together is
// compared with what a session makes of the whole mesh, and the stars of shared nodes with the ids.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <map>
#include <random>

#include "hextwist/io/io.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/parts/mpi/parts_call.h"
#include "hextwist/parts/mpi/ranks.h"
#include "hextwist/session/session.h"

namespace hextwist {
namespace {

MeshPart some_of(const Mesh& whole, int rank, int size, unsigned seed) {
  std::mt19937 chance(seed), order(seed + static_cast<unsigned>(rank));
  std::vector<Index> own;
  for (Index h = 0; h < whole.n_hexes(); ++h) {
    auto at = static_cast<int>(chance() % static_cast<unsigned>(size));
    if (at == 1 && seed % 3 == 0) at = 0;  // then rank 1 has nothing
    if (at == rank) own.push_back(h);
  }
  std::ranges::shuffle(own, order);
  std::vector<Index> nodes;
  for (const Index h : own) nodes.insert(nodes.end(), whole.hexes[h].begin(), whole.hexes[h].end());
  std::ranges::sort(nodes);
  nodes.erase(std::ranges::unique(nodes).begin(), nodes.end());
  std::ranges::shuffle(nodes, order);
  std::map<Index, Index> place;
  std::vector<double> points;
  std::vector<std::int64_t> node_ids, hex_ids;
  for (const Index n : nodes) {
    place[n] = static_cast<Index>(node_ids.size());
    node_ids.push_back(node_id(whole, n));
    points.insert(points.end(), whole.points[n].data(), whole.points[n].data() + 3);
  }
  std::vector<Index> hexes;
  for (const Index h : own) {
    hex_ids.push_back(hex_id(whole, h));
    for (const int corner : file_corner) hexes.push_back(place[whole.hexes[h][corner]]);
  }
  return {mesh_of_arrays(points, hexes, node_ids, hex_ids), {}, {}};
}

struct Node {
  std::int64_t id;
  double at[3];
  bool operator==(const Node& other) const { return std::memcmp(this, &other, sizeof(Node)) == 0; }
};
std::vector<Node> nodes_of(const Mesh& mesh) {
  std::vector<Node> list;
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    list.push_back({node_id(mesh, n), {mesh.points[n].x(), mesh.points[n].y(), mesh.points[n].z()}});
  return list;
}
/// Id, and ids of the corners.
std::vector<std::array<std::int64_t, 9>> hexes_of(const Mesh& mesh) {
  std::vector<std::array<std::int64_t, 9>> list;
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    list.push_back({hex_id(mesh, h)});
    for (int c = 0; c < 8; ++c) list.back()[c + 1] = node_id(mesh, mesh.hexes[h][c]);
  }
  return list;
}

template <class T>
std::vector<std::vector<T>> everywhere(Ranks& ranks, const std::vector<T>& mine) {
  std::vector<std::vector<T>> all;
  for (const auto& bytes : ranks.everywhere(std::as_bytes(std::span(mine)))) {
    all.emplace_back(bytes.size() / sizeof(T));
    if (!bytes.empty()) std::memcpy(all.back().data(), bytes.data(), bytes.size());
  }
  return all;
}

void require(bool holds, const char* what) {
  if (!holds) throw Error(what);
}

void check(Ranks& ranks, const MeshPart& part, const Mesh& serial) {
  const auto nodes = everywhere(ranks, nodes_of(part.mesh));
  const auto hexes = everywhere(ranks, hexes_of(part.mesh));
  const auto shared = everywhere(ranks, part.shared);
  std::vector<Node> all_nodes;
  std::vector<std::array<std::int64_t, 9>> all_hexes;
  std::map<std::int64_t, std::pair<int, Index>> lowest;  // by id: the first rank that has it
  for (int rank = 0; rank < ranks.size(); ++rank) {
    all_hexes.insert(all_hexes.end(), hexes[rank].begin(), hexes[rank].end());
    std::size_t at = 0;
    for (std::size_t n = 0; n < nodes[rank].size(); ++n) {
      const auto [first, is_new] = lowest.try_emplace(nodes[rank][n].id, rank, static_cast<Index>(n));
      if (is_new) {
        all_nodes.push_back(nodes[rank][n]);
        continue;
      }
      require(at < shared[rank].size(), "a shared node is missing");
      const SharedNode& leaf = shared[rank][at++];
      require(leaf.node == static_cast<Index>(n), "shared nodes are not those that lower ranks have");
      require(leaf.rank == first->second.first && leaf.there == first->second.second, "a star has another root");
    }
    require(at == shared[rank].size(), "a node is said to be shared that is not");
  }
  std::ranges::sort(all_nodes, {}, &Node::id);
  std::ranges::sort(all_hexes);
  require(all_nodes == nodes_of(serial), "nodes differ from those of the whole");
  require(all_hexes == hexes_of(serial), "hexes differ from those of the whole");
}

void run(Ranks& ranks, const std::vector<std::string>& words) {
  Session session;
  if (words[1] != "-") session.import_cad(words[1]);
  session.import_mesh(words[0]);
  MeshPart part =
      some_of(session.meshed().mesh, ranks.rank(), ranks.size(), static_cast<unsigned>(std::stoul(words[2])));
  const std::vector<std::string> commands(words.begin() + 3, words.end());
  PartsOptions options;
  if (words[1] != "-") options.cad = words[1];
  options.n_rings = 4;
  options.rebalance = ranks.size() != 3;
  const MeshPart made = refine_parts(MPI_COMM_WORLD, std::move(part), commands, options);
  for (const std::string& command : commands) session.run(command);
  ranks.together([&] { check(ranks, made, session.meshed().mesh); });
  if (ranks.is_first())
    std::printf("%d hexes in %d parts are those of one\n", session.meshed().mesh.n_hexes(), ranks.size());
}

}  // namespace
}  // namespace hextwist

int main(int argc, char** argv) {
  hextwist::Ranks ranks(argc, argv);
  try {
    hextwist::run(ranks, {argv + 1, argv + argc});
    return 0;
  } catch (const std::exception& error) {
    if (ranks.is_first()) std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
