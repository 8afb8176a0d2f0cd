// Surface meshes cut out of a mesh, and batches of projections, which association is built on.
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <numeric>

#include "hextwist/base/interrupt.h"
#include "hextwist/base/large_array.h"
#include "hextwist/base/parallel.h"
#include "hextwist/mesh/association/association_internal.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/loose_topology.h"

namespace hextwist::detail {
namespace {

constexpr double degenerate_length = 1e-9;  // of the model size

constexpr double largest_gap = 1e-3;  // of the model size: what is looser is wrong

/// How far a curve lies off the surfaces that it bounds: CAD files may say less than it is. A few samples see most of
/// it.
double gap(const Model& model, int curve) {
  constexpr int n_samples = 24;
  constexpr double between_samples = 1.5;
  const CurveRange range = model.range(curve);
  const std::vector<int> surfaces = model.adjacent({1, curve}, 2);
  double worst = 0;
  for (int i = 0; i < n_samples; ++i) {
    const double t = range.first + (i + 0.5) / n_samples * (range.last - range.first);
    const Vec3 place = model.point({1, curve}, {t, 0});
    for (const int surface : surfaces) worst = std::max(worst, model.project(Owner{2, surface}, place).distance);
  }
  return std::min(between_samples * worst, largest_gap * model.box().diagonal());
}

}  // namespace

ModelFacts::ModelFacts(const Model& m, double relative_tolerance)
    : model(m), size(m.box().diagonal()), tolerance(relative_tolerance * size) {
  const int n_vertices = m.count(0), n_curves = m.count(1), n_surfaces = m.count(2);
  std::vector<double> curve_gap(n_curves);
  parallel_each(
      curve_gap.size(), [&](std::size_t i) { curve_gap[i] = gap(m, static_cast<int>(i + 1)); }, 1);
  for (int dim = 0; dim < 3; ++dim)
    for (int id = 1; id <= m.count(dim); ++id) {
      // A node on the rim of an entity may lie as far off as the rim does.
      double own = std::max(tolerance, m.tolerance({dim, id}));
      if (dim == 1) own = std::max(own, curve_gap[id - 1]);
      for (int rim = 0; rim < dim; ++rim)
        for (const int bound : m.adjacent({dim, id}, rim))
          own = std::max({own, m.tolerance({rim, bound}), rim == 1 ? curve_gap[bound - 1] : 0});
      entity_tolerance[dim].push_back(own);
      if (dim == 1 && own > loosest) {
        loosest = own;
        loosest_curve = id;
      }
    }
  for (int id = 1; id <= n_vertices; ++id) {
    vertex_curves.push_back(m.adjacent({0, id}, 1));
    vertex_surfaces.push_back(m.adjacent({0, id}, 2));
  }
  for (int id = 1; id <= n_curves; ++id) {
    curve_surfaces.push_back(m.adjacent({1, id}, 2));
    curve_box.push_back(m.box(Owner{1, id}));
    degenerate.push_back(m.measure({1, id}) <= degenerate_length * size);
  }
  for (int id = 1; id <= n_surfaces; ++id) {
    surface_volumes.push_back(m.adjacent({2, id}, 3));
    surface_curves.push_back(m.adjacent({2, id}, 1));
    std::erase_if(surface_curves.back(), [&](int curve) { return degenerate[curve - 1]; });
    surface_seams.push_back(surface_curves.back());
    std::erase_if(surface_seams.back(), [&](int curve) { return curve_surfaces[curve - 1].size() != 1; });
  }
}

Skin make_skin(const Mesh& mesh, const Faces& faces, std::span<const Index> selected) {
  Skin skin;
  skin.faces.assign(selected.begin(), selected.end());
  tbb::parallel_sort(skin.faces.begin(), skin.faces.end(),
                     [&](Index a, Index b) { return faces.sides[a][0] < faces.sides[b][0]; });
  const auto n = static_cast<Index>(skin.faces.size());
  std::vector<Index> local;
  resize_large(local, mesh.points.size(), Index{-1});
  parallel_each(skin.faces.size(), [&](std::size_t q) {
    for (const Index node : faces.nodes[skin.faces[q]])
      std::atomic_ref(local[node]).store(0, std::memory_order_relaxed);
  });
  skin.nodes = indices_where(mesh.n_nodes(), [&](Index node) { return local[node] == 0; });
  skin.points.resize(skin.nodes.size());
  parallel_each(skin.nodes.size(), [&](std::size_t i) {
    local[skin.nodes[i]] = static_cast<Index>(i);
    skin.points[i] = mesh.points[skin.nodes[i]];
  });
  resize_for_overwrite(skin.sides, n);
  resize_for_overwrite(skin.quads, n);
  parallel_ranges(n, [&](Index begin, Index end) {
    for (Index q = begin; q < end; ++q) {
      skin.sides[q] = faces.sides[skin.faces[q]][0];
      skin.quads[q] = face_node_cycle(mesh.hexes[skin.sides[q].hex], skin.sides[q].face);
      for (Index& node : skin.quads[q]) node = local[node];
    }
  });
  return skin;
}

SkinEdges make_edges(const Skin& skin) {
  struct Use {
    std::uint64_t nodes;  // lower, higher
    Index quad;
    bool operator<(const Use& other) const { return nodes != other.nodes ? nodes < other.nodes : quad < other.quad; }
  };
  std::vector<Use> uses;
  resize_for_overwrite(uses, 4 * skin.quads.size());
  parallel_ranges(skin.n_quads(), [&](Index begin, Index end) {
    for (Index q = begin; q < end; ++q)
      for (int i = 0; i < 4; ++i) {
        const auto [a, b] = std::minmax(skin.quads[q][i], skin.quads[q][(i + 1) % 4]);
        uses[4 * q + i] = {static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint64_t>(b), q};
      }
  });
  tbb::parallel_sort(uses.begin(), uses.end());
  SkinEdges edges;
  edges.quads.first = indices_where(static_cast<Index>(uses.size()),
                                    [&](Index i) { return i == 0 || uses[i].nodes != uses[i - 1].nodes; });
  resize_for_overwrite(edges.nodes, edges.quads.first.size());
  parallel_each(edges.nodes.size(), [&](std::size_t e) {
    const std::uint64_t nodes = uses[edges.quads.first[e]].nodes;
    edges.nodes[e] = {static_cast<Index>(nodes >> 32), static_cast<Index>(nodes & 0xffffffff)};
  });
  edges.quads.first.push_back(static_cast<Index>(uses.size()));
  resize_for_overwrite(edges.quads.items, uses.size());
  parallel_each(uses.size(), [&](std::size_t i) { edges.quads.items[i] = uses[i].quad; });
  return edges;
}

CompressedRows group(Index n_nodes, std::span<const std::pair<Index, Index>> pairs) {
  CompressedRows all, lists;
  all.first.assign(n_nodes + 1, 0);
  for (const auto& [node, value] : pairs) ++all.first[node];
  std::partial_sum(all.first.begin(), all.first.end(), all.first.begin());
  resize_for_overwrite(all.items, pairs.size());
  for (const auto& [node, value] : pairs) all.items[--all.first[node]] = value;

  resize_large(lists.first, static_cast<std::size_t>(n_nodes) + 1);
  parallel_each(n_nodes, [&](std::size_t node) {
    const auto begin = all.items.begin() + all.first[node], end = all.items.begin() + all.first[node + 1];
    std::sort(begin, end);
    lists.first[node] = static_cast<Index>(std::unique(begin, end) - begin);
  });
  resize_for_overwrite(lists.items, static_cast<std::size_t>(counts_to_starts(lists.first)));
  parallel_each(n_nodes, [&](std::size_t node) {
    std::copy_n(all.items.begin() + all.first[node], lists.first[node + 1] - lists.first[node],
                lists.items.begin() + lists.first[node]);
  });
  return lists;
}

std::vector<Projection> project_all(const Model& model, int dim, std::span<const int> id, std::span<const Vec3> points,
                                    std::span<const Parameters> seeds) {
  constexpr Index batch = 256;
  std::vector<Index> order(id.size());
  std::vector<Index> start(model.count(dim) + 2, 0);
  for (const int i : id) ++start[i + 1];
  for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
  for (std::size_t i = 0; i < id.size(); ++i) order[start[id[i]]++] = static_cast<Index>(i);
  // Now start[i] is where entity i ends.
  struct Batch {
    int id;
    Index begin, end;
  };
  std::vector<Batch> batches;
  Index begin = 0;
  for (int entity = 1; entity <= model.count(dim); ++entity)
    for (; begin < start[entity]; begin = batches.back().end)
      batches.push_back({entity, begin, std::min(begin + batch, start[entity])});
  std::vector<Projection> result(id.size());
  parallel_ranges(
      static_cast<Index>(batches.size()),
      [&](Index from, Index to) {
        std::array<Vec3, batch> at;
        std::array<Parameters, batch> seed;
        std::array<Projection, batch> out;
        for (Index b = from; b < to; ++b) {
          check_interrupt();
          const std::size_t n = batches[b].end - batches[b].begin;
          for (std::size_t i = 0; i < n; ++i) {
            at[i] = points[order[batches[b].begin + i]];
            if (!seeds.empty()) seed[i] = seeds[order[batches[b].begin + i]];
          }
          model.project(Owner{dim, batches[b].id}, {at.data(), n}, {seed.data(), seeds.empty() ? 0 : n},
                        {out.data(), n});
          for (std::size_t i = 0; i < n; ++i) result[order[batches[b].begin + i]] = out[i];
        }
      },
      1);
  return result;
}

}  // namespace hextwist::detail
