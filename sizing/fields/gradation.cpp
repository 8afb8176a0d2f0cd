#include "hextwist/sizing/fields/gradation.h"

#include <cmath>
#include <queue>

namespace hextwist {
namespace {

/// Per node the nodes that edges lead to.
CompressedRows neighbours(const Edges& edges, std::size_t n_nodes) {
  CompressedRows lists;
  lists.first.assign(n_nodes + 1, 0);
  for (const Edge& edge : edges.nodes)
    for (const Index n : edge) ++lists.first[static_cast<std::size_t>(n) + 1];
  for (std::size_t n = 0; n < n_nodes; ++n) lists.first[n + 1] += lists.first[n];
  lists.items.resize(2 * edges.nodes.size());
  std::vector<Index> next(lists.first.begin(), lists.first.end() - 1);
  for (const Edge& edge : edges.nodes)
    for (int end = 0; end < 2; ++end) lists.items[next[edge[end]]++] = edge[1 - end];
  return lists;
}

}  // namespace

void limit_gradation(const Edges& edges, std::span<const Vec3> points, double slope, std::span<double> sizes) {
  const CompressedRows next_to = neighbours(edges, points.size());
  struct Entry {
    double size;
    Index node;
    bool operator>(const Entry& other) const { return size != other.size ? size > other.size : node > other.node; }
  };
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  const auto reach = [&](Index from, Index to) { return sizes[from] + slope * (points[to] - points[from]).norm(); };
  // Only nodes that lower a neighbour need to be looked at.
  for (Index n = 0; n < static_cast<Index>(points.size()); ++n)
    for (const Index m : next_to[n])
      if (reach(n, m) < sizes[m]) {
        open.push({sizes[n], n});
        break;
      }
  while (!open.empty()) {
    const auto [size, n] = open.top();
    open.pop();
    if (size > sizes[n]) continue;
    for (const Index m : next_to[n])
      if (const double limit = reach(n, m); limit < sizes[m]) {
        sizes[m] = limit;
        open.push({limit, m});
      }
  }
}

}  // namespace hextwist
