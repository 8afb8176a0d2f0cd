// Layers of hexes from the one end of a volume to the other.
//
// The rim of every layer is known, as the side surfaces are meshed. Nodes inside of it go where the affine map takes
// them that moves the rim of the end best (least squares; Knupp, Next-generation sweep tool, 1998), and then as much
// farther as the rim itself is away from that, carried inwards by harmonic functions of the quads. Both ends are asked,
// in proportion to how near they are.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <set>

#include "hextwist/base/interrupt.h"
#include "hextwist/base/memory.h"
#include "hextwist/mesh/fill/layers_internal.h"
#include "hextwist/mesh/primitives.h"

namespace hextwist::fill {

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
  const std::vector<Edge> rim = rim_edges(source, at_source);

  // Up the sides.
  Columns column;
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
    add_column(column, up_a, volume);
    add_column(column, up_b, volume);
  }
  const std::size_t n_levels = height_of(column);
  if (n_levels < 2 || n_passed != sides.size()) throw Error(volume + "its sides have different numbers of layers");
  check_room(source.size(), n_levels - 1);

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
    const std::vector<Vec3> rim_here = rim_of_level(inside, column, k, level[k]);
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
  add_layers(source, level, sweep.volume);
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
  const double wished = intervals_said > 0 ? intervals_said : std::round(std::numbers::pi / 4 * radius / size);
  const auto n = static_cast<int>(std::clamp(wished, 1.0, intervals_said > 0 ? 1000.0 : 1e6));
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
    throw Error("volume " + std::to_string(volume) + ": it is called a sphere but is not one");
}

}  // namespace hextwist::fill
