#include "hextwist/parts/mpi/parts_call.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "hextwist/command/error_at.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/parts/mpi/refine.h"
#include "hextwist/refine/split.h"

namespace hextwist {
namespace {

/// Positions of ids, ascending by id. what: "node" or "hex".
std::vector<Index> by_id(std::span<const std::int64_t> ids, const char* what) {
  std::vector<Index> order(ids.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](Index i) { return ids[i]; });
  if (!order.empty() && ids[order[0]] < 1)
    throw Error(std::string("a ") + what + " has the id " + std::to_string(ids[order[0]]) + "; ids begin with 1");
  for (std::size_t i = 1; i < order.size(); ++i)
    if (ids[order[i]] == ids[order[i - 1]])
      throw Error("two " + std::string(what == std::string("hex") ? "hexes" : "nodes") + " of this part have the id " +
                  std::to_string(ids[order[i]]));
  return order;
}

/// Who else has the nodes: lists of both sides are in the same order.
std::vector<SharedNode> stars(Ranks& ranks, const FilePart& part) {
  std::vector<std::vector<Index>> to(static_cast<std::size_t>(ranks.size()));
  for (const FilePart::SharedNodes& with : part.nodes)
    if (with.part > ranks.rank()) to[with.part] = with.nodes;
  const std::vector<std::vector<Index>> there = ranks.exchange(to);
  std::vector<SharedNode> shared;
  for (const FilePart::SharedNodes& with : part.nodes)  // ascending ranks
    for (std::size_t i = 0; with.part < ranks.rank() && i < with.nodes.size(); ++i)
      shared.push_back({with.nodes[i], with.part, there[with.part][i]});
  std::ranges::stable_sort(shared, {}, &SharedNode::node);
  const auto rest = std::ranges::unique(shared, {}, &SharedNode::node);
  shared.erase(rest.begin(), rest.end());
  return shared;
}

}  // namespace

Mesh mesh_of_arrays(std::span<const double> points, std::span<const Index> hexes,
                    std::span<const std::int64_t> node_ids, std::span<const std::int64_t> hex_ids) {
  if (points.size() != 3 * node_ids.size() || hexes.size() != 8 * hex_ids.size())
    throw Error(std::to_string(node_ids.size()) + " nodes and " + std::to_string(hex_ids.size()) +
                " hexes need 3 numbers each and 8 nodes each: there are " + std::to_string(points.size()) + " and " +
                std::to_string(hexes.size()));
  checked_count(std::ssize(node_ids));
  checked_count(std::ssize(hex_ids));
  const std::vector<Index> nodes = by_id(node_ids, "node"), order = by_id(hex_ids, "hex");
  std::vector<Index> place(nodes.size());
  Mesh mesh;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double* const at = &points[3 * static_cast<std::size_t>(nodes[i])];
    place[nodes[i]] = static_cast<Index>(i);
    mesh.points.emplace_back(at[0], at[1], at[2]);
    mesh.node_ids.push_back(node_ids[nodes[i]]);
  }
  for (const Index h : order) {
    Hex hex;
    for (std::size_t c = 0; c < 8; ++c) {
      const Index n = hexes[8 * static_cast<std::size_t>(h) + c];
      if (n < 0 || n >= std::ssize(place))
        throw Error("hex " + std::to_string(hex_ids[h]) + " has node " + std::to_string(n) + " of " +
                    std::to_string(place.size()) + " (from 0)");
      hex[file_corner[c]] = place[n];
    }
    mesh.hexes.push_back(hex);
    mesh.hex_ids.push_back(hex_ids[h]);
  }
  return mesh;
}

MeshPart refine_parts(MPI_Comm communicator, MeshPart part, std::span<const std::string> commands,
                      const PartsOptions& options) {
  Ranks ranks(MPI_Comm_c2f(communicator));
  const auto say = [&](const std::string& line) {
    if (ranks.is_first() && options.say) options.say(line);
  };
  std::optional<PartCommands> wanted;
  ranks.together([&] {
    try {
      wanted.emplace(commands);
    } catch (const CommandError& error) {
      throw Error(error.message());
    }
  });
  RankPart own = take_in_ranks(ranks, std::move(part.mesh), options.cad, say);
  OwnPart made = take_part(ranks, refine_in_ranks(ranks, own, *wanted, {options.n_rings, options.rebalance}, say));
  MeshPart result{std::move(made.mesh), std::move(made.association), {}};
  result.shared = stars(ranks, made.file);
  return result;
}

}  // namespace hextwist
