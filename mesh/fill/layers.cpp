#include "hextwist/mesh/fill/layers_internal.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <deque>
#include <set>

#include "hextwist/base/memory.h"

namespace hextwist::fill {
namespace {

int place_in(const Quad& quad, Index node) {
  return static_cast<int>(std::ranges::find(quad, node) - quad.begin());
}

}  // namespace

QuadsAtEdge quads_at_edges(const std::vector<Quad>& quads) {
  QuadsAtEdge result;
  for (std::size_t q = 0; q < quads.size(); ++q)
    for (int k = 0; k < 4; ++k) result[edge_of(quads[q][k], quads[q][(k + 1) % 4])].push_back(static_cast<Index>(q));
  return result;
}

Index other_neighbour(const Quad& quad, Index node, Index but) {
  const int k = place_in(quad, node);
  return quad[(k + 1) % 4] == but ? quad[(k + 3) % 4] : quad[(k + 1) % 4];
}

void orient_alike(std::vector<Quad>& quads) {
  const QuadsAtEdge at_edge = quads_at_edges(quads);
  std::vector<char> seen(quads.size());
  const auto leads = [&](Index q, Index a, Index b) { return quads[q][(place_in(quads[q], a) + 1) % 4] == b; };
  for (std::size_t start = 0; start < quads.size(); ++start) {
    if (seen[start]++) continue;
    std::deque<Index> next{static_cast<Index>(start)};
    while (!next.empty()) {
      const Index q = next.front();
      next.pop_front();
      for (int k = 0; k < 4; ++k) {
        const Index a = quads[q][k], b = quads[q][(k + 1) % 4];
        for (const Index other : at_edge.at(edge_of(a, b))) {
          if (other == q || seen[other]++) continue;
          if (leads(other, a, b)) std::swap(quads[other][1], quads[other][3]);
          next.push_back(other);
        }
      }
    }
  }
}

std::vector<Edge> rim_edges(const std::vector<Quad>& quads, const QuadsAtEdge& at_edge) {
  std::vector<Edge> rim;
  for (const Quad& quad : quads)
    for (int k = 0; k < 4; ++k)
      if (at_edge.at(edge_of(quad[k], quad[(k + 1) % 4])).size() == 1) rim.push_back({quad[k], quad[(k + 1) % 4]});
  return rim;
}

void add_column(Columns& columns, const std::vector<Index>& column, const std::string& volume) {
  if (const auto [at, is_new] = columns.try_emplace(column.front(), column); !is_new && at->second != column)
    throw Error(volume + "its sides do not fit together");
}

std::size_t height_of(const Columns& columns) {
  if (columns.empty()) return 0;
  const std::size_t n = columns.begin()->second.size();
  return std::ranges::all_of(columns, [&](const auto& entry) { return entry.second.size() == n; }) ? n : 0;
}

Inside::Inside(const std::vector<Quad>& quads, const std::vector<Edge>& rim) : rim_(rim) {
  for (const auto& [a, b] : rim) {
    if (slot_.try_emplace(a, std::ssize(slot_)).second) rim_nodes_.push_back(a);
    if (slot_.try_emplace(b, std::ssize(slot_)).second) rim_nodes_.push_back(b);
  }
  for (const Quad& quad : quads)
    for (const Index node : quad)
      if (slot_.try_emplace(node, std::ssize(slot_)).second) inner_.push_back(node);
  std::vector<Eigen::Triplet<double>> entries, to_rim;
  const auto n_rim = std::ssize(rim_nodes_);
  std::set<Edge> seen;
  for (const Quad& quad : quads)
    for (int k = 0; k < 4; ++k) {
      const Index a = quad[k], b = quad[(k + 1) % 4];
      if (!seen.insert(edge_of(a, b)).second) continue;
      for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
        const auto row = slot_.at(from) - n_rim, column = slot_.at(to) - n_rim;
        if (row < 0) continue;
        entries.emplace_back(row, row, 1.0);
        if (column >= 0)
          entries.emplace_back(row, column, -1.0);
        else
          to_rim.emplace_back(row, slot_.at(to), 1.0);
      }
    }
  const auto n = std::ssize(inner_);
  Eigen::SparseMatrix<double> laplacian(n, n);
  laplacian.setFromTriplets(entries.begin(), entries.end());
  of_rim_.resize(n, n_rim);
  of_rim_.setFromTriplets(to_rim.begin(), to_rim.end());
  if (n > 0) solver_.compute(laplacian);
}

std::vector<Vec3> Inside::moved(const std::vector<Vec3>& from, const std::vector<Vec3>& from_inner,
                                const std::vector<Vec3>& to) const {
  if (inner_.empty()) return {};
  const auto n = std::ssize(rim_nodes_);
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();
  for (Index i = 0; i < n; ++i) {
    a += from[i] / static_cast<double>(n);
    b += to[i] / static_cast<double>(n);
  }
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero(), square = Eigen::Matrix3d::Zero();
  for (Index i = 0; i < n; ++i) {
    cross += (to[i] - b) * (from[i] - a).transpose();
    square += (from[i] - a) * (from[i] - a).transpose();
  }
  // A flat rim says nothing of what lies above it: normals go to normals.
  const Vec3 area = vector_area(from), area_to = vector_area(to);
  if (area.norm() > 0 && area_to.norm() > 0) {
    const Vec3 up = area.normalized() * std::sqrt(area.norm()),
               up_to = area_to.normalized() * std::sqrt(area_to.norm());
    cross += static_cast<double>(n) * up_to * up.transpose();
    square += static_cast<double>(n) * up * up.transpose();
  }
  const Eigen::Matrix3d map = square.completeOrthogonalDecomposition().solve(cross.transpose()).transpose();
  Eigen::MatrixX3d rest(n, 3);
  for (Index i = 0; i < n; ++i) rest.row(i) = to[i] - (b + map * (from[i] - a));
  const Eigen::MatrixX3d rest_inside = solver_.solve(Eigen::MatrixX3d(of_rim_ * rest));
  std::vector<Vec3> result(inner_.size());
  for (std::size_t i = 0; i < inner_.size(); ++i)
    result[i] = b + map * (from_inner[i] - a) + rest_inside.row(static_cast<Index>(i)).transpose();
  return result;
}

Vec3 Inside::vector_area(const std::vector<Vec3>& rim) const {
  Vec3 sum = Vec3::Zero();
  for (const auto& [a, b] : rim_) sum += rim[slot_.at(a)].cross(rim[slot_.at(b)]) / 2;
  return sum;
}

void Builder::check_room(std::size_t n_quads, std::size_t n_layers) const {
  const double n_hexes = static_cast<double>(n_quads) * static_cast<double>(n_layers);
  check_memory(static_cast<double>(hexes.size()) + n_hexes, static_cast<double>(points.size()) + n_hexes);
}

std::vector<Vec3> Builder::rim_of_level(const Inside& inside, const std::map<Index, std::vector<Index>>& columns,
                                        std::size_t k, std::map<Index, Index>& level) const {
  std::vector<Vec3> places;
  for (const Index node : inside.rim_nodes()) {
    level[node] = columns.at(node)[k];
    places.push_back(points[level[node]]);
  }
  return places;
}

void Builder::add_layers(const std::vector<Quad>& source, const std::vector<std::map<Index, Index>>& level,
                         int volume) {
  const std::size_t first = hexes.size();
  double sum = 0;
  for (std::size_t k = 0; k + 1 < level.size(); ++k)
    for (const Quad& quad : source) {
      constexpr std::array<int, 4> bits = {0, 1, 3, 2};
      Hex hex{};
      for (int c = 0; c < 4; ++c) {
        hex[bits[c]] = level[k].at(quad[c]);
        hex[bits[c] + 4] = level[k + 1].at(quad[c]);
      }
      const auto along = [&](int c) { return Vec3(points[hex[c]] - points[hex[0]]); };
      sum += along(1).cross(along(2)).dot(along(4));
      hexes.push_back(hex);
    }
  // The quads may turn either way, all of them alike.
  if (sum < 0)
    for (std::size_t h = first; h < hexes.size(); ++h)
      for (int c = 0; c < 4; ++c) std::swap(hexes[h][c], hexes[h][c + 4]);
  hex_volume.resize(hexes.size(), volume);
}

}  // namespace hextwist::fill
