// How good the children of flat and long boxes can be at all, and how good they are: the curve of docs/design.md.
//
//   free_optimum [table] > refine/templates/free_optimum.inc
//
// For boxes 1 x 1 x r and 1 x r x r: one box in the middle of 3 x 3 x 3 with some of its corners marked, edges cut at
// thirds, every other new node free in space. The smallest scaled Jacobian of all children is raised by minimising the
// soft maximum (1 / p) log sum q^-p, p rising, by L-BFGS with exact gradients, starting from where refinement itself
// puts the nodes and from the optimum of the r before, stretched. Angles alone would have nodes heaped upon each other
// (the best triangle fan has size 0), so no edge may come below a ninth of the shortest edge of the box, as if it had
// been cut twice.
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <deque>
#include <map>
#include <set>

#include "hextwist/mesh/quality/quality.h"
#include "hextwist/refine/carry.h"
#include "hextwist/refine/marks.h"
#include "hextwist/refine/place.h"
#include "hextwist/refine/templates/trisect.h"

namespace {

using namespace hextwist;
using Vectors = Eigen::Matrix3Xd;

constexpr double proportions[] = {1, 1.5, 2, 3, 4, 6, 10, 20};

Mesh block(const Vec3& size) {
  constexpr int n = 4;
  Mesh mesh;
  for (int i = 0; i < n * n * n; ++i) mesh.points.push_back(Vec3(i % n, i / n % n, i / (n * n)).cwiseProduct(size));
  for (int i = 0; i < 27; ++i) {
    Hex hex;
    for (int c = 0; c < 8; ++c)
      hex[c] = i % 3 + (c & 1) + n * (i / 3 % 3 + (c >> 1 & 1)) + n * n * (i / 9 + (c >> 2 & 1));
    mesh.hexes.push_back(hex);
  }
  return mesh;
}

/// The children of a block, and which nodes are free: all from first_free on.
struct Children {
  Mesh mesh;
  Index first_free = 0;
};
Children children(const Vec3& size, int corner_mask) {
  const Mesh coarse = block(size);
  std::vector<std::uint8_t> marked(coarse.points.size());
  for (int c = 0; c < 8; ++c) marked[coarse.hexes[13][c]] = corner_mask >> c & 1;
  Split parts = split(coarse.hexes, coarse.n_nodes(), trisect_table(), trisect_codes(coarse.hexes, marked));
  Children made{carry(coarse, {}, parts).mesh, parts.n_nodes};
  if (!parts.lineage.faces.empty()) made.first_free = parts.lineage.faces[0].first_node;
  Association none;
  fit_children(parts, nullptr, made.mesh, none);
  return made;
}

double worst(const Mesh& mesh) {
  return summarize(quality(Metric::scaled_jacobian, mesh)).min;
}

/// The soft maximum and its gradient.
class Energy {
 public:
  Energy(const Children& children, double shortest)
      : mesh_(children.mesh), first_(children.first_free), shortest_(shortest) {
    std::set<Edge> edges;
    for (const Hex& hex : mesh_.hexes) {
      if (*std::ranges::max_element(hex) < first_) continue;
      hexes_.push_back(hex);
      for (int e = 0; e < n_hex_edges; ++e) {
        const Index a = hex[edge_corner(e, 0)], b = hex[edge_corner(e, 1)];
        if (std::max(a, b) >= first_) edges.insert({std::min(a, b), std::max(a, b)});
      }
    }
    edges_.assign(edges.begin(), edges.end());
  }
  Index n_free() const { return mesh_.n_nodes() - first_; }
  Mesh& mesh() { return mesh_; }
  void move(const Vectors& x) {
    for (Index i = 0; i < n_free(); ++i) mesh_.points[first_ + i] = x.col(i);
  }
  Vectors places() const {
    Vectors x(3, n_free());
    for (Index i = 0; i < n_free(); ++i) x.col(i) = mesh_.points[first_ + i];
    return x;
  }
  /// Infinite where a hex is inverted. gradient may be null.
  double operator()(double p, Vectors* gradient) {
    logs_.clear();
    for (const Hex& hex : hexes_)
      for (int c = 0; c < 9; ++c) {
        const auto [a, b, d] = columns(hex, c);
        const double q = a.dot(b.cross(d)) / (a.norm() * b.norm() * d.norm());
        if (!(q > 1e-7)) return std::numeric_limits<double>::infinity();
        logs_.push_back(-p * std::log(q));
      }
    for (const Edge& edge : edges_) logs_.push_back(-p * steep * std::log(length(edge) / shortest_));
    const double most = *std::ranges::max_element(logs_);
    double sum = 0;
    for (const double each : logs_) sum += std::exp(each - most);
    if (gradient) {
      gradient->setZero(3, n_free());
      std::size_t i = 0;
      const auto add = [&](Index node, const Vec3& g) {
        if (node >= first_) gradient->col(node - first_) += g;
      };
      for (const Hex& hex : hexes_)
        for (int c = 0; c < 9; ++c, ++i) {
          const double weight = std::exp(logs_[i] - most) / sum;
          if (weight < 1e-12) continue;
          const auto [a, b, d] = columns(hex, c);
          const double determinant = a.dot(b.cross(d));
          const std::array<Vec3, 3> of = {weight * (a / a.squaredNorm() - b.cross(d) / determinant),
                                          weight * (b / b.squaredNorm() - d.cross(a) / determinant),
                                          weight * (d / d.squaredNorm() - a.cross(b) / determinant)};
          for (int axis = 0; axis < 3; ++axis)
            for (int k = 0; k < 8; ++k)
              if (c == 8 || (k | 1 << axis) == (c | 1 << axis)) add(hex[k], k >> axis & 1 ? of[axis] : Vec3(-of[axis]));
        }
      for (const Edge& edge : edges_) {
        const Vec3 g = std::exp(logs_[i++] - most) / sum * steep / (length(edge) * length(edge)) *
                       (mesh_.points[edge[1]] - mesh_.points[edge[0]]);
        add(edge[0], g);
        add(edge[1], -g);
      }
    }
    return (most + std::log(sum)) / p;
  }

 private:
  static constexpr double steep = 8;  // how soon a short edge counts as a bad corner

  double length(const Edge& edge) const { return (mesh_.points[edge[1]] - mesh_.points[edge[0]]).norm(); }
  std::array<Vec3, 3> columns(const Hex& hex, int c) const {
    std::array<Vec3, 3> of = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    for (int axis = 0; axis < 3; ++axis)
      for (int k = 0; k < 8; ++k)
        if (c == 8 || (k | 1 << axis) == (c | 1 << axis))
          of[axis] += k >> axis & 1 ? mesh_.points[hex[k]] : Vec3(-mesh_.points[hex[k]]);
    return of;
  }

  Mesh mesh_;
  Index first_;
  double shortest_;
  std::vector<Hex> hexes_;
  std::vector<Edge> edges_;
  std::vector<double> logs_;
};

void minimise(Energy& energy, double p) {
  struct Pair {
    Vectors s, y;
    double rho;
  };
  std::deque<Pair> memory;
  Vectors x = energy.places(), g;
  double f = energy(p, &g);
  if (!std::isfinite(f)) return;
  for (int step = 0; step < 400; ++step) {
    Vectors d = -g;
    std::vector<double> alpha(memory.size());
    for (std::size_t k = memory.size(); k-- > 0;) {
      alpha[k] = memory[k].rho * memory[k].s.cwiseProduct(d).sum();
      d -= alpha[k] * memory[k].y;
    }
    if (memory.empty())
      d *= 0.01 / std::max(g.colwise().norm().maxCoeff(), 1e-300);
    else
      d *= 1 / (memory.back().rho * memory.back().y.squaredNorm());
    for (std::size_t k = 0; k < memory.size(); ++k)
      d += (alpha[k] - memory[k].rho * memory[k].y.cwiseProduct(d).sum()) * memory[k].s;
    const double slope = d.cwiseProduct(g).sum();
    double t = 1, next = f;
    for (; t > 1e-9; t /= 2) {
      energy.move(x + t * d);
      next = energy(p, nullptr);
      if (next <= f + 1e-4 * t * slope) break;
    }
    if (!(t > 1e-9) || !(slope < 0)) {
      energy.move(x);
      if (memory.empty()) return;
      memory.clear();
      continue;
    }
    Vectors g_next;
    const double before = f;
    f = energy(p, &g_next);
    const Vectors s = t * d, y = g_next - g;
    x += s;
    g = g_next;
    if (const double sy = s.cwiseProduct(y).sum(); sy > 1e-14 * s.norm() * y.norm()) memory.push_back({s, y, 1 / sy});
    if (memory.size() > 15) memory.pop_front();
    if (before - f < 1e-8 && step > 20) return;
  }
}

/// Raises the worst of what it is given; returns the highest reached, the best places stay in the energy's mesh.
double optimise(Energy& energy) {
  double best = worst(energy.mesh());
  Vectors places = energy.places();
  for (const double p : {4.0, 16.0, 64.0, 256.0, 1000.0}) {
    minimise(energy, p);
    if (const double now = worst(energy.mesh()); now > best) {
      best = now;
      places = energy.places();
    }
  }
  energy.move(places);
  return best;
}

/// Markings of the corners that are different seen from a box with two equal sides along the axes other than `odd`.
std::vector<int> orbits(int odd) {
  const int a = odd == 0 ? 1 : 0, b = odd == 2 ? 1 : 2;
  std::vector<int> lowest;
  for (int mask = 0; mask < 256; ++mask) {
    int least = mask;
    for (int flip = 0; flip < 8; ++flip)
      for (const bool swap : {false, true}) {
        int image = 0;
        for (int c = 0; c < 8; ++c) {
          const int swapped = swap ? (c & ~(1 << a | 1 << b)) | (c >> a & 1) << b | (c >> b & 1) << a : c;
          image |= (mask >> c & 1) << (swapped ^ flip);
        }
        least = std::min(least, image);
      }
    if (least == mask && edge_mask_of_corners(mask) != 0) lowest.push_back(mask);
  }
  return lowest;
}

}  // namespace

int main(int argc, char** argv) {
  const bool quick = argc > 1 && std::strcmp(argv[1], "quick") == 0;  // what is reached alone
  for (const bool flat : {false, true}) {
    std::map<int, Vectors> last;  // optimum of the r before, in units of the box
    for (const double r : proportions) {
      const Vec3 size = flat ? Vec3(1, r, r) : Vec3(1, 1, r);
      double least_free = 1, least_reached = 1, least_ratio = 1;
      int worst_mask = 0;
      for (const int mask : orbits(flat ? 0 : 2)) {
        const Children made = children(size, mask);
        const double reached = worst(made.mesh);
        double best = reached;
        if (!quick) {
          Energy energy(made, 1.0 / 9);
          best = std::max(best, optimise(energy));
          if (const auto found = last.find(mask); found != last.end()) {
            Energy stretched(made, 1.0 / 9);
            stretched.move(size.asDiagonal() * found->second);
            if (const double other = optimise(stretched); other > best) {
              best = other;
              energy.move(stretched.places());
            }
          }
          last[mask] = size.cwiseInverse().asDiagonal() * energy.places();
        }
        if (reached < least_reached) worst_mask = mask;
        least_reached = std::min(least_reached, reached);
        least_free = std::min(least_free, best);
        least_ratio = std::min(least_ratio, reached / best);
        std::printf("{%d, %g, 0x%02x, %.3f},  // %.3f\n", flat, r, mask, best, reached);
        std::fflush(stdout);
      }
      std::fprintf(stderr, "1 x %g x %g: free %.3f, reached %.3f (%.0f%%, marking 0x%02x); one marking %.0f%%\n",
                   size.y(), r, least_free, least_reached, 100 * least_reached / least_free, worst_mask,
                   100 * least_ratio);
    }
  }
}
