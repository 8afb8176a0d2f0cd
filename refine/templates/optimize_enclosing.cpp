// Optimises where the new nodes of the enclosing templates lie, once and for all, and prints what the engine includes:
//
//   optimize_enclosing third > refine/templates/enclose_places_third.inc
//   optimize_enclosing half  > refine/templates/enclose_places_half.inc
//
// The templates are judged by what they are for: refinements of grids of unit cubes before any smoothing. For "third"
// the whole combination, trisecting included, of a node, an edge, a face, a path that turns, a whole side, and two and
// three sides that meet; for "half" the enclosing alone of the same. A pattern search maximises the product of the
// smallest shapes of all cases, none of which may fall. Edges are cut where the technique says, so two numbers are free
// on the marked side (in faces and in hexes) and two on the unmarked side. At half, nodes inside faces stay in the
// middle: one-into-eight encloses in one direction after the other, and moving them (to 0.537, which lifts single nodes
// from 0.60 to 0.66) lowers the smallest shape around a block of hexes from 0.414 to 0.397.
#include <algorithm>
#include <cstdio>
#include <cstring>

#include "hextwist/base/sorted.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/refine/origin.h"
#include "hextwist/refine/plans/combine.h"
#include "hextwist/refine/split.h"
#include "hextwist/refine/templates/enclose.h"
#include "hextwist/refine/templates/enclose_internal.h"
#include "hextwist/refine/templates/trisect.h"

namespace {

using namespace hextwist;

constexpr int n = 4;  // hexes per direction
constexpr double least_reach = 0.25;
constexpr double least_shape = 0.45;  // of a template in the unit cube: 0.45 at the start
Index node(int i, int j, int k) {
  return i + (n + 1) * (j + (n + 1) * k);
}

Mesh unit_grid() {
  Mesh mesh;
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) mesh.points.emplace_back(i, j, k);
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        Hex& hex = mesh.hexes.emplace_back();
        for (int c = 0; c < 8; ++c) hex[c] = node(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2 & 1));
      }
  return mesh;
}

Mesh refined(const Mesh& mesh, const std::shared_ptr<const SplitTable>& table, std::span<const std::uint16_t> codes) {
  Split parts = split(mesh.hexes, mesh.n_nodes(), table, codes);
  Mesh result;
  result.points = mesh.points;
  result.points.resize(parts.n_nodes);
  const auto put = [&](Index at, const Origin& origin) {
    result.points[at].setZero();
    for (int i = 0; i < origin.n; ++i) result.points[at] += origin.weight[i] * mesh.points[origin.node[i]];
  };
  for (const CutEdge& edge : parts.lineage.edges) for_each_node(parts.lineage, edge, put);
  for (const CutFace& face : parts.lineage.faces) for_each_node(parts.lineage, face, put);
  for (const CutHex& hex : parts.lineage.hexes) for_each_node(parts.lineage, hex, mesh.hexes, put);
  result.hexes = std::move(parts.hexes);
  return result;
}

struct Case {
  const char* name;
  CombinationTarget target;
};

void add_edge(CombinationTarget& target, Index a, Index b) {
  target.edges.push_back({std::min(a, b), std::max(a, b)});
}

/// The face with lowest corner (i, j, k) across `axis`.
void add_face(CombinationTarget& target, int axis, int i, int j, int k) {
  const int u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
  Quad quad;
  for (int c = 0; c < 4; ++c) {
    std::array at = {i, j, k};
    at[u] += c & 1;
    at[v] += c >> 1;
    quad[c] = node(at[0], at[1], at[2]);
  }
  target.faces.push_back(quad);
}

std::vector<Case> cases() {
  std::vector<Case> all = {{"node", {{node(2, 2, 2)}, {}, {}}},
                           {"edge", {}},
                           {"face", {}},
                           {"turning path", {}},
                           {"side", {}},
                           {"two sides", {}},
                           {"three sides", {}}};
  add_edge(all[1].target, node(1, 2, 2), node(2, 2, 2));
  add_face(all[2].target, 2, 1, 1, 2);
  add_edge(all[3].target, node(1, 2, 0), node(2, 2, 0));
  add_edge(all[3].target, node(2, 2, 0), node(2, 3, 0));
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      for (int sides = 1; sides <= 3; ++sides) {
        add_face(all[3 + sides].target, 2, i, j, 0);
        if (sides >= 2) add_face(all[3 + sides].target, 1, i, 0, j);
        if (sides >= 3) add_face(all[3 + sides].target, 0, 0, i, j);
      }
    }
  for (Case& one : all) {
    for (const Edge& edge : target_edges(one.target))
      one.target.nodes.insert(one.target.nodes.end(), edge.begin(), edge.end());
    sort_unique(one.target.nodes);
    std::ranges::sort(one.target.edges);
  }
  return all;
}

Mesh result_of(const Case& one, const std::shared_ptr<const SplitTable>& table, bool combination) {
  const Mesh mesh = unit_grid();
  std::vector<std::uint8_t> marked(mesh.points.size(), 0);
  for (const Index i : one.target.nodes) marked[i] = 1;
  close_enclosure(mesh.hexes, marked);
  const Mesh enclosed = refined(mesh, table, enclose_codes(mesh.hexes, marked));
  if (!combination) return enclosed;
  // No target edge of these cases is cut by the enclosing, and faces and edges keep their nodes.
  return refined(enclosed, trisect_table(), combination_codes(enclosed, one.target, target_edges(one.target)));
}

double smallest_shape(const Case& one, const std::shared_ptr<const SplitTable>& table, bool combination) {
  return summarize(quality(Metric::shape, result_of(one, table, combination))).min;
}

/// The smallest shape of all hexes of all templates in the unit cube.
double smallest_shape(const SplitTable& table) {
  double smallest = 1;
  for (int mask = 1; mask < 255; ++mask) {
    if (!has_enclosing_template(mask)) continue;
    const std::vector<Vec3> places = table.positions(mask);
    for (const auto& child : table.hex(mask).children) {
      std::array<Vec3, 8> corners;
      for (int c = 0; c < 8; ++c) corners[c] = places[child[c]];
      smallest = std::min(smallest, quality(Metric::shape, corners));
    }
  }
  return smallest;
}

/// The smallest shapes of all cases, multiplied; 0 where one is below its start, a node too near to the skin of its
/// hex, or a template bad by itself.
double worth(const EnclosePlaces& places, const std::vector<Case>& all, const std::vector<double>& start,
             bool combination) {
  for (const double reach : {places.marked.face, places.marked.inside, places.unmarked.face, places.unmarked.inside})
    if (reach < least_reach || reach > 1 - least_reach) return 0;
  const auto table = make_enclose_table(places);
  if (smallest_shape(*table) < least_shape) return 0;
  double product = 1;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double smallest = smallest_shape(all[i], table, combination);
    if (smallest < start[i] - 1e-6) return 0;
    product *= smallest;
  }
  return product;
}

}  // namespace

int main(int argc, char** argv) {
  const bool combination = argc < 2 || std::strcmp(argv[1], "half") != 0;
  const std::vector<Case> all = cases();
  EnclosePlaces places = combination ? EnclosePlaces{{1.0 / 3, 0.4, 0.42}, {2.0 / 3, 0.6, 0.58}}
                                     : EnclosePlaces{{0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}};
  std::vector<double*> free = {&places.marked.inside, &places.unmarked.inside};
  if (combination) free.insert(free.end(), {&places.marked.face, &places.unmarked.face});
  const auto n_free = static_cast<int>(free.size());
  const auto print = [&](const char* when) {
    const auto table = make_enclose_table(places);
    std::fprintf(stderr, "%s:", when);
    for (const Case& one : all) std::fprintf(stderr, "  %s %.4f", one.name, smallest_shape(one, table, combination));
    std::fprintf(stderr, "\n");
  };
  print("before");
  std::vector<double> start;
  for (const Case& one : all) start.push_back(smallest_shape(one, make_enclose_table(places), combination));
  double best = worth(places, all, start, combination);
  for (double step = 0.08; step > 1e-4;) {
    bool better = false;
    // Along each number, and along pairs of them: the smallest of several shapes has ridges.
    for (int i = 0; i < n_free * n_free; ++i)
      for (const double move : {-step, step})
        for (const double other : {-move, 0.0, move}) {
          const EnclosePlaces before = places;
          *free[i / n_free] += move;
          if (i / n_free != i % n_free) *free[i % n_free] += other;
          const double now = worth(places, all, start, combination);
          better |= now > best;
          if (now > best)
            best = now;
          else
            places = before;
        }
    if (!better) step /= 2;
  }
  print("after");
  std::printf("{{%.17g, %.4f, %.4f}, {%.17g, %.4f, %.4f}}\n", places.marked.edge, places.marked.face,
              places.marked.inside, places.unmarked.edge, places.unmarked.face, places.unmarked.inside);
}
