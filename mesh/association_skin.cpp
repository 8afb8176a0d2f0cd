// Surface meshes cut out of a mesh, and batches of projections: the ground that association stands on.
#include <tbb/parallel_sort.h>

#include <algorithm>

#include "hextwist/mesh/association_internal.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/geom/interrupt.h"
#include "hextwist/mesh/parallel_internal.h"

namespace hextwist::detail {
namespace {

constexpr double degenerate_length = 1e-9;  // of the model size

}  // namespace

ModelFacts::ModelFacts(const Model& m, double relative_tolerance)
    : model(m), size(m.box().diagonal()), tolerance(relative_tolerance * size) {
  const int n_vertices = m.count(0), n_curves = m.count(1), n_surfaces = m.count(2);
  for (int dim = 0; dim < 3; ++dim)
    for (int id = 1; id <= m.count(dim); ++id) {
      // A node on the rim of an entity may lie as far off as the rim does.
      double own = std::max(tolerance, m.tolerance({dim, id}));
      for (int rim = 0; rim < dim; ++rim)
        for (const int bound : m.adjacent({dim, id}, rim)) own = std::max(own, m.tolerance({rim, bound}));
      entity_tolerance[dim].push_back(own);
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
  std::vector<Index> local(mesh.points.size(), -1);
  for (const Index face : skin.faces)
    for (const Index node : faces.nodes[face]) local[node] = 0;
  for (Index node = 0; node < mesh.n_nodes(); ++node)
    if (local[node] == 0) {
      local[node] = static_cast<Index>(skin.nodes.size());
      skin.nodes.push_back(node);
      skin.points.push_back(mesh.points[node]);
    }
  skin.sides.resize(n);
  skin.quads.resize(n);
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
  std::vector<Use> uses(4 * skin.quads.size());
  parallel_ranges(skin.n_quads(), [&](Index begin, Index end) {
    for (Index q = begin; q < end; ++q)
      for (int i = 0; i < 4; ++i) {
        const auto [a, b] = std::minmax(skin.quads[q][i], skin.quads[q][(i + 1) % 4]);
        uses[4 * q + i] = {static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint64_t>(b), q};
      }
  });
  tbb::parallel_sort(uses.begin(), uses.end());
  SkinEdges edges;
  edges.quads.items.reserve(uses.size());
  for (const Use& use : uses) {
    const Edge nodes = {static_cast<Index>(use.nodes >> 32), static_cast<Index>(use.nodes & 0xffffffff)};
    if (edges.nodes.empty() || edges.nodes.back() != nodes) {
      edges.nodes.push_back(nodes);
      edges.quads.first.push_back(static_cast<Index>(edges.quads.items.size()));
    }
    edges.quads.items.push_back(use.quad);
  }
  edges.quads.first.push_back(static_cast<Index>(edges.quads.items.size()));
  return edges;
}

Lists group(Index n_nodes, std::vector<std::pair<Index, Index>> pairs) {
  tbb::parallel_sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  Lists lists;
  lists.first.assign(n_nodes + 1, 0);
  lists.items.reserve(pairs.size());
  for (const auto& [node, value] : pairs) {
    ++lists.first[node + 1];
    lists.items.push_back(value);
  }
  for (Index i = 0; i < n_nodes; ++i) lists.first[i + 1] += lists.first[i];
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
          may_go_on();
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
