// Layers of hexes from the one end of a volume to the other.
//
// The rim of every layer is known, as the side surfaces are meshed. Nodes inside of it go where the affine map takes
// them that moves the rim of the end best (least squares; Knupp, Next-generation sweep tool, 1998), and then as much
// farther as the rim itself is away from that, carried inwards by harmonic functions of the quads. Both ends are asked,
// in proportion to how near they are.
#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <set>

#include "hextwist/base/interrupt.h"
#include "hextwist/base/memory.h"
#include "hextwist/mesh/fill/builder_internal.h"
#include "hextwist/mesh/primitives.h"

namespace hextwist::fill {
namespace {

Edge edge_of(Index a, Index b) {
  return {std::min(a, b), std::max(a, b)};
}

using QuadsAtEdge = std::map<Edge, std::vector<Index>>;
QuadsAtEdge quads_at_edges(const std::vector<Quad>& quads) {
  QuadsAtEdge result;
  for (std::size_t q = 0; q < quads.size(); ++q)
    for (int k = 0; k < 4; ++k) result[edge_of(quads[q][k], quads[q][(k + 1) % 4])].push_back(static_cast<Index>(q));
  return result;
}

int place_in(const Quad& quad, Index node) {
  return static_cast<int>(std::ranges::find(quad, node) - quad.begin());
}
/// The node of the quad that an edge leads to from `node`, other than `but`.
Index other_neighbour(const Quad& quad, Index node, Index but) {
  const int k = place_in(quad, node);
  return quad[(k + 1) % 4] == but ? quad[(k + 3) % 4] : quad[(k + 1) % 4];
}

/// Positions of the inner nodes of a quad mesh for any places of its rim.
class Inside {
 public:
  Inside(const std::vector<Quad>& quads, const std::vector<Edge>& rim) : rim_(rim) {
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

  const std::vector<Index>& inner() const { return inner_; }
  const std::vector<Index>& rim_nodes() const { return rim_nodes_; }

  /// from, from_inner: the places in one layer; to: those of the rim in the other. Both of the rim as rim_nodes().
  std::vector<Vec3> moved(const std::vector<Vec3>& from, const std::vector<Vec3>& from_inner,
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

 private:
  std::vector<Edge> rim_;  // as the quads turn
  std::map<Index, std::ptrdiff_t> slot_;
  std::vector<Index> rim_nodes_, inner_;
  Eigen::SparseMatrix<double> of_rim_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;

  Vec3 vector_area(const std::vector<Vec3>& rim) const {
    Vec3 sum = Vec3::Zero();
    for (const auto& [a, b] : rim_) sum += rim[slot_.at(a)].cross(rim[slot_.at(b)]) / 2;
    return sum;
  }
};

}  // namespace

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

void Builder::sweep(const Sweep& sweep, int from) {
  check_interrupt();
  const std::string volume = "volume " + std::to_string(sweep.volume) + ": ";
  const auto quads_of = [&](const std::vector<int>& surfaces) {
    std::vector<Quad> result;
    for (const int s : surfaces) {
      result.insert(result.end(), surface_quads[s - 1].begin(), surface_quads[s - 1].end());
    }
    return result;
  };
  std::vector<Quad> source = quads_of(sweep.caps[from]);
  const std::vector<Quad> sides = quads_of(sweep.sides);
  orient_alike(source);
  const QuadsAtEdge at_source = quads_at_edges(source), at_side = quads_at_edges(sides);
  std::vector<Edge> rim;  // as the quads turn
  for (const Quad& quad : source)
    for (int k = 0; k < 4; ++k)
      if (at_source.at(edge_of(quad[k], quad[(k + 1) % 4])).size() == 1) rim.push_back({quad[k], quad[(k + 1) % 4]});

  // Up the sides.
  std::map<Index, std::vector<Index>> column;
  std::size_t n_passed = 0;
  for (auto [a, b] : rim) {
    std::vector<Index> up_a{a}, up_b{b};
    Index quad = -1;
    for (;;) {
      const auto found = at_side.find(edge_of(a, b));
      if (found == at_side.end()) throw Error(volume + "its sides do not begin where its ends end");
      Index next = -1;
      for (const Index q : found->second)
        if (q != quad) next = q;
      if (next < 0 || (quad < 0 && found->second.size() != 1)) break;
      quad = next;
      const Index a_up = other_neighbour(sides[quad], a, b), b_up = other_neighbour(sides[quad], b, a);
      a = a_up;
      b = b_up;
      up_a.push_back(a);
      up_b.push_back(b);
      if (++n_passed > sides.size()) break;
    }
    for (const auto* up : {&up_a, &up_b})
      if (const auto [at, is_new] = column.try_emplace(up->front(), *up); !is_new && at->second != *up)
        throw Error(volume + "its sides do not fit together");
  }
  const std::size_t n_levels = column.empty() ? 0 : column.begin()->second.size();
  if (n_levels < 2 || n_passed != sides.size() ||
      std::ranges::any_of(column, [&](const auto& entry) { return entry.second.size() != n_levels; }))
    throw Error(volume + "its sides have different numbers of layers");

  const double n_hexes = static_cast<double>(source.size()) * static_cast<double>(n_levels - 1);
  check_memory(static_cast<double>(hexes.size()) + n_hexes, static_cast<double>(points.size()) + n_hexes);

  // The other end: node by node what this end becomes.
  const std::vector<int>& far = sweep.caps[1 - from];
  std::map<Index, Index> image;
  for (const auto& [node, up] : column) image[node] = up.back();
  for (const Partner& partner : sweep.partners) {
    const int here = from == 0 ? partner.curve : partner.other, there = from == 0 ? partner.other : partner.curve;
    const std::vector<Index> a = nodes({{here, true}}), b = nodes({{there, partner.same_way}});
    for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) image.try_emplace(a[i], b[i]);
  }
  const Inside inside(source, rim);
  const bool is_meshed_there = is_meshed(far.front());
  if (std::ranges::any_of(far, [&](int s) { return is_meshed(s) != is_meshed_there; }))
    throw Error(volume + "the surfaces at its end are meshed in part, from volumes beside it");
  std::vector<Vec3> here, there, inner_here;
  for (const Index node : inside.rim_nodes()) {
    here.push_back(points[node]);
    there.push_back(points[image.at(node)]);
  }
  for (const Index node : inside.inner()) inner_here.push_back(points[node]);
  if (is_meshed_there) {
    const std::vector<Quad> target = quads_of(far);
    const QuadsAtEdge at_target = quads_at_edges(target);
    const auto differ = [&] {
      return Error(volume + "the surfaces at its two ends are meshed differently, from volumes beside it");
    };
    if (target.size() != source.size()) throw differ();
    // From the rim inwards, each quad fixes two more nodes.
    std::deque<std::pair<Edge, std::array<Index, 2>>> next;  // an edge here; the quads next to it that are known
    std::vector<char> seen(source.size());
    for (const auto& [a, b] : rim) next.push_back({{a, b}, {-1, -1}});
    while (!next.empty()) {
      const auto [edge, known] = next.front();
      next.pop_front();
      const auto [a, b] = edge;
      const auto at = at_target.find(edge_of(image.at(a), image.at(b)));
      if (at == at_target.end()) throw differ();
      for (const Index q : at_source.at(edge_of(a, b))) {
        if (q == known[0] || seen[q]++) continue;
        const auto other = std::ranges::find_if(at->second, [&](Index t) { return t != known[1]; });
        if (other == at->second.end()) throw differ();
        const Index c = other_neighbour(source[q], b, a), d = other_neighbour(source[q], a, b);
        const Index c_there = other_neighbour(target[*other], image.at(b), image.at(a)),
                    d_there = other_neighbour(target[*other], image.at(a), image.at(b));
        if (image.try_emplace(c, c_there).first->second != c_there ||
            image.try_emplace(d, d_there).first->second != d_there)
          throw differ();
        for (const Edge& on : {Edge{b, c}, Edge{c, d}, Edge{d, a}}) next.push_back({on, {q, *other}});
      }
    }
  } else {
    // On the CAD, each node on the surface that has what its quads become.
    const std::vector<Vec3> guess = inside.moved(here, inner_here, there);
    std::map<Index, int> surface_of;
    if (far.size() == 1)
      for (const Index node : inside.inner()) surface_of[node] = far.front();
    else {
      // A cap becomes the one that has the images of its rim.
      for (const int s : sweep.caps[from]) {
        std::set<Index> rim_images;
        for (const Chain& loop : facts.surfaces[s - 1].loops)
          for (const Index node : nodes(loop)) rim_images.insert(image.count(node) ? image.at(node) : -1);
        const auto becomes = std::ranges::find_if(far, [&](int t) {
          std::set<Index> own;
          for (const Chain& loop : facts.surfaces[t - 1].loops)
            for (const Index node : nodes(loop)) own.insert(node);
          return own == rim_images;
        });
        if (becomes == far.end()) throw Error(volume + "the surfaces at its two ends are divided differently");
        for (const Quad& quad : surface_quads[s - 1])
          for (const Index node : quad) surface_of.try_emplace(node, *becomes);
        for (const Quad& quad : surface_quads[s - 1])
          surface_quads[*becomes - 1].push_back(quad);  // by the nodes of this end, for now
      }
    }
    for (std::size_t i = 0; i < guess.size(); ++i) {
      const Index node = inside.inner()[i];
      if (image.contains(node)) continue;
      const Owner owner{2, surface_of.at(node)};
      image[node] = add(facts.model.project(owner, guess[i]).point, owner);
    }
    if (far.size() == 1) surface_quads[far.front() - 1] = source;
    for (const int s : far)
      for (Quad& quad : surface_quads[s - 1])
        for (Index& node : quad) node = image.at(node);
  }
  std::vector<Vec3> inner_there;
  for (const Index node : inside.inner()) inner_there.push_back(points[image.at(node)]);

  // Layers of nodes, then of hexes.
  std::vector<std::map<Index, Index>> level(n_levels);
  for (std::size_t k = 0; k < n_levels; ++k) {
    check_interrupt();
    std::vector<Vec3> rim_here;
    for (const Index node : inside.rim_nodes()) {
      level[k][node] = column.at(node)[k];
      rim_here.push_back(points[level[k][node]]);
    }
    if (k == 0 || k + 1 == n_levels) {
      for (const Index node : inside.inner()) level[k][node] = k == 0 ? node : image.at(node);
      continue;
    }
    const double t = static_cast<double>(k) / static_cast<double>(n_levels - 1);
    const std::vector<Vec3> up = inside.moved(here, inner_here, rim_here),
                            down = inside.moved(there, inner_there, rim_here);
    for (std::size_t i = 0; i < up.size(); ++i)
      level[k][inside.inner()[i]] = add((1 - t) * up[i] + t * down[i], {3, sweep.volume});
  }
  const std::size_t first = hexes.size();
  double sum = 0;
  for (std::size_t k = 0; k + 1 < n_levels; ++k)
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
  hex_volume.resize(hexes.size(), sweep.volume);
}

void Builder::fill_ball(int volume, int intervals_said) {
  const Model& model = facts.model;
  const int surface = model.adjacent({3, volume}, 2).front();
  const std::vector<int> poles = model.adjacent({3, volume}, 0);
  Vec3 south = model.point({0, poles[0]}, {}), north = model.point({0, poles[1]}, {});
  const double radius = (north - south).norm() / 2;
  const Vec3 center = (north + south) / 2, z = (north - south) / (2 * radius);
  // The seam, on which mesh/primitives.h has edges, lies at y = 0.
  Vec3 x = z.unitOrthogonal();
  for (const int curve : model.adjacent({3, volume}, 1))
    if (const CurveFacts& own = facts.curves[curve - 1]; !own.is_point) x = facts.point_at(curve, 0.5) - center;
  x = (x - z * z.dot(x)).normalized();
  Eigen::Matrix3d frame;
  frame << x, z.cross(x), z;
  const int n = intervals_said > 0 ? std::min(intervals_said, 1000)
                                   : std::max(1, static_cast<int>(std::round(std::numbers::pi / 4 * radius / size)));
  check_memory(56.0 * n * n * n, 56.0 * n * n * n);
  const Mesh ball = mesh_sphere({radius}, sphere_intervals(n));
  const auto first = static_cast<Index>(points.size());
  // Who owns them is found by where they are.
  for (const Vec3& p : ball.points) add(center + frame * p, {});
  for (Hex hex : ball.hexes) {
    for (Index& node : hex) node += first;
    hexes.push_back(hex);
  }
  hex_volume.resize(hexes.size(), volume);
  if (!(model.project({2, surface}, Vec3(center + radius * x)).distance < 1e-5 * radius))
    throw Error("volume " + std::to_string(volume) + ": it is called a sphere and is none");
}

}  // namespace hextwist::fill
