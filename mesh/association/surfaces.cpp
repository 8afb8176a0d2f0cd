// Faces of the mesh to surfaces of the model.
//
// Each node of the skin is projected onto the surfaces near it; a quad can lie on a surface only if its four corners
// do. Where several remain (thin strips, sharp corners, sheets nearer than the tolerance), the one wins that is
// nearest to corners and centre and faces the same way.
#include <tbb/parallel_sort.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "hextwist/base/interrupt.h"
#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/association/association_internal.h"

namespace hextwist::detail {
namespace {

// A quad whose corners lie on a surface fits it when the centre is no farther off than this times its mean edge (a
// quad across 120 degrees of a circle: 0.29; straight through a cylinder: 0.5) ...
constexpr double max_surface_sagitta = 0.35;
// ... and the normals there are no farther apart than 60 degrees.
constexpr double min_cosine = 0.5;

/// Places of nodes on surfaces within tolerance: those of node n are first[n] .. first[n + 1], surfaces ascending.
struct Hits {
  std::vector<Index> first;
  std::vector<int> surface;
  std::vector<Projection> at;

  const Projection* find(Index node, int id) const {
    for (Index i = first[node]; i < first[node + 1]; ++i)
      if (surface[i] == id) return &at[i];
    return nullptr;
  }
};

/// Projects the nodes onto the given surfaces and drops what lies off.
Hits hits(const ModelFacts& facts, const Skin& skin, const CompressedRows& candidates) {
  std::vector<int> id(candidates.items.begin(), candidates.items.end());
  std::vector<Vec3> points(id.size());
  parallel_each(skin.nodes.size(), [&](std::size_t n) {
    for (Index i = candidates.first[n]; i < candidates.first[n + 1]; ++i) points[i] = skin.points[n];
  });
  const auto all = project_all(facts.model, 2, id, points);
  const std::vector<Index> on = indices_where(
      static_cast<Index>(id.size()), [&](Index i) { return all[i].distance <= facts.node_tolerance(2, id[i]); });
  Hits kept;
  kept.surface.resize(on.size());
  kept.at.resize(on.size());
  parallel_each(on.size(), [&](std::size_t i) {
    kept.surface[i] = id[on[i]];
    kept.at[i] = all[on[i]];
  });
  kept.first.resize(candidates.first.size());
  parallel_each(kept.first.size(), [&](std::size_t n) {
    kept.first[n] = static_cast<Index>(std::ranges::lower_bound(on, candidates.first[n]) - on.begin());
  });
  return kept;
}

/// Surfaces near the nodes of the quads for which `wanted` holds.
template <class Wanted>
CompressedRows near_surfaces(const ModelFacts& facts, const Skin& skin, Wanted wanted) {
  constexpr Index chunk_size = 512;
  double reach = 0;
  for (const double t : facts.entity_tolerance[2]) reach = std::max(reach, t);
  std::vector<char> needed(skin.nodes.size(), 0);
  for (Index q = 0; q < skin.n_quads(); ++q)
    if (wanted(q))
      for (const Index node : skin.quads[q]) needed[node] = 1;
  std::vector<std::vector<Index>> found(n_chunks(skin.n_nodes(), chunk_size));
  CompressedRows lists;
  lists.first.assign(skin.nodes.size() + 1, 0);
  parallel_chunks(skin.n_nodes(), chunk_size, [&](Index chunk, Index begin, Index end) {
    check_interrupt();
    for (Index n = begin; n < end; ++n) {
      if (!needed[n]) continue;
      const auto ids = facts.model.near(2, skin.points[n], reach);
      lists.first[n + 1] = static_cast<Index>(ids.size());
      found[chunk].insert(found[chunk].end(), ids.begin(), ids.end());
    }
  });
  for (Index n = 0; n < skin.n_nodes(); ++n) lists.first[n + 1] += lists.first[n];
  lists.items.reserve(lists.first.back());
  for (const auto& ids : found) lists.items.insert(lists.items.end(), ids.begin(), ids.end());
  return lists;
}

/// A quad all corners of which lie on a surface.
struct SurfaceCandidate {
  Index quad;
  int surface;
  double corner;  ///< largest distance of a corner
  Parameters seed;
  double score = 0;  ///< 0 is perfect
  bool fits = false;
};

void common_surfaces(const Skin& skin, const Hits& hits, Index q, std::vector<SurfaceCandidate>& common) {
  const Quad& quad = skin.quads[q];
  for (Index i = hits.first[quad[0]]; i < hits.first[quad[0] + 1]; ++i) {
    SurfaceCandidate candidate{q, hits.surface[i], hits.at[i].distance, hits.at[i].parameters};
    bool all = true;
    for (int c = 1; c < 4 && all; ++c) {
      const Projection* hit = hits.find(quad[c], candidate.surface);
      all = hit != nullptr;
      if (hit) candidate.corner = std::max(candidate.corner, hit->distance);
    }
    if (all) common.push_back(candidate);
  }
}
/// The same for the quads for which `wanted` holds, in their order.
template <class Wanted>
std::vector<SurfaceCandidate> common_surfaces(const Skin& skin, const Hits& hits, Wanted wanted) {
  constexpr Index size = 1024;
  std::vector<std::vector<SurfaceCandidate>> found(n_chunks(skin.n_quads(), size));
  parallel_chunks(skin.n_quads(), size, [&](Index chunk, Index begin, Index end) {
    found[chunk].reserve(size);
    for (Index q = begin; q < end; ++q)
      if (wanted(q)) common_surfaces(skin, hits, q, found[chunk]);
  });
  std::vector<SurfaceCandidate> all;
  std::size_t n = 0;
  for (const auto& list : found) n += list.size();
  all.reserve(n);
  for (const auto& list : found) all.insert(all.end(), list.begin(), list.end());
  return all;
}

void score(const ModelFacts& facts, const Skin& skin, std::vector<SurfaceCandidate>& candidates) {
  const auto n = static_cast<Index>(candidates.size());
  std::vector<int> id(n);
  std::vector<Vec3> centre(n);
  std::vector<Parameters> seed(n);
  std::vector<double> length(n);
  parallel_each(candidates.size(), [&](std::size_t i) {
    const Quad& quad = skin.quads[candidates[i].quad];
    id[i] = candidates[i].surface;
    centre[i] = Vec3::Zero();
    for (int c = 0; c < 4; ++c) {
      centre[i] += skin.points[quad[c]] / 4;
      length[i] += (skin.points[quad[c]] - skin.points[quad[(c + 1) % 4]]).norm() / 4;
    }
    seed[i] = candidates[i].seed;
  });
  auto at = project_all(facts.model, 2, id, centre, seed);
  // A projection from a seed is local: where it ended far away, look again without.
  std::vector<Index> far;
  for (Index i = 0; i < n; ++i)
    if (at[i].distance > 0.25 * length[i]) far.push_back(i);
  std::vector<int> far_id;
  std::vector<Vec3> far_centre;
  for (const Index i : far) {
    far_id.push_back(id[i]);
    far_centre.push_back(centre[i]);
  }
  const auto again = project_all(facts.model, 2, far_id, far_centre);
  for (std::size_t k = 0; k < far.size(); ++k)
    if (again[k].distance < at[far[k]].distance) at[far[k]] = again[k];
  parallel_ranges(n, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      SurfaceCandidate& c = candidates[i];
      const Quad& quad = skin.quads[c.quad];
      const Vec3 across =
          (skin.points[quad[2]] - skin.points[quad[0]]).cross(skin.points[quad[3]] - skin.points[quad[1]]).normalized();
      const Vec3 normal = facts.model.normal(c.surface, at[i].parameters);
      double cosine = normal.isZero() ? 1 : normal.dot(across);
      // Which side of a surface between two volumes the hex lies on is not known yet.
      if (facts.surface_volumes[c.surface - 1].size() != 1 || facts.is_embedded(c.surface)) cosine = std::abs(cosine);
      c.score = (c.corner + at[i].distance) / length[i] + 1 - cosine;
      c.fits = at[i].distance <= max_surface_sagitta * length[i] + facts.node_tolerance(2, c.surface) &&
               cosine >= min_cosine;
    }
  });
}

void accept(const Skin& skin, const Hits& hits, Index q, int surface, SurfaceMatch& match) {
  match.quad_surface[q] = surface;
  for (const Index node : skin.quads[q]) match.node_at[node] = *hits.find(node, surface);
}

}  // namespace

SurfaceMatch match_surfaces(const ModelFacts& facts, const Skin& skin, std::span<const int> tags) {
  SurfaceMatch match;
  match.quad_surface.assign(skin.quads.size(), 0);
  match.node_at.resize(skin.nodes.size());
  if (std::ranges::any_of(tags, [](int tag) { return tag != 0; })) {
    std::vector<std::pair<Index, Index>> pairs;
    for (Index q = 0; q < skin.n_quads(); ++q)
      if (tags[q])
        for (const Index node : skin.quads[q]) pairs.emplace_back(node, tags[q]);
    const Hits tagged = hits(facts, skin, group(skin.n_nodes(), pairs));
    std::vector<SurfaceCandidate> candidates = common_surfaces(skin, tagged, [&](Index q) { return tags[q] != 0; });
    std::erase_if(candidates,
                  [&](const SurfaceCandidate& candidate) { return candidate.surface != tags[candidate.quad]; });
    score(facts, skin, candidates);
    for (const SurfaceCandidate& candidate : candidates)
      if (candidate.fits) accept(skin, tagged, candidate.quad, candidate.surface, match);
  }
  const auto open = [&](Index q) { return match.quad_surface[q] == 0; };
  const Hits near = hits(facts, skin, near_surfaces(facts, skin, open));
  std::vector<SurfaceCandidate> candidates = common_surfaces(skin, near, open);
  // A datum plane or a sheet that was left over, of no volume, has only what no other surface has.
  const auto bounds_volume = [&](const SurfaceCandidate& candidate) {
    return !facts.surface_volumes[candidate.surface - 1].empty();
  };
  std::vector<std::uint8_t> has_better(skin.quads.size(), 0);
  for (const SurfaceCandidate& candidate : candidates)
    if (bounds_volume(candidate)) has_better[candidate.quad] = 1;
  std::erase_if(candidates, [&](const SurfaceCandidate& candidate) {
    return has_better[candidate.quad] && !bounds_volume(candidate);
  });
  // Most quads have one candidate and need no score.
  std::vector<SurfaceCandidate> several;
  for (std::size_t i = 0, end = 0; i < candidates.size(); i = end) {
    while (end < candidates.size() && candidates[end].quad == candidates[i].quad) ++end;
    if (end == i + 1)
      accept(skin, near, candidates[i].quad, candidates[i].surface, match);
    else
      several.insert(several.end(), candidates.begin() + i, candidates.begin() + end);
  }
  score(facts, skin, several);
  for (std::size_t i = 0, end = 0; i < several.size(); i = end) {
    std::size_t best = i;
    for (end = i; end < several.size() && several[end].quad == several[i].quad; ++end)
      if (several[end].score < several[best].score - 1e-9) best = end;
    accept(skin, near, several[best].quad, several[best].surface, match);
  }
  return match;
}

std::vector<Index> find_walls(const ModelFacts& facts, const Mesh& mesh, const Faces& faces) {
  double reach = 0;
  for (const double t : facts.entity_tolerance[2]) reach = std::max(reach, t);
  std::vector<char> between(facts.surface_volumes.size() + 1, 0);
  std::vector<Box> boxes;
  for (int s = 1; s <= static_cast<int>(facts.surface_volumes.size()); ++s)
    if (facts.is_inside(s)) {
      between[s] = 1;
      boxes.push_back(facts.model.box(Owner{2, s}));
      boxes.back().min.array() -= reach;
      boxes.back().max.array() += reach;
    }
  if (boxes.empty()) return {};
  // Asking the model is expensive, and most nodes are in no box.
  std::vector<char> near(mesh.points.size(), 0);
  parallel_ranges(mesh.n_nodes(), [&](Index begin, Index end) {
    for (Index n = begin; n < end; ++n) {
      const Vec3& p = mesh.points[n];
      if (std::ranges::any_of(boxes, [&](const Box& box) {
            return (p.array() >= box.min.array()).all() && (p.array() <= box.max.array()).all();
          }))
        for (const int s : facts.model.near(2, p, reach)) near[n] |= between[s];
    }
  });
  const std::vector<Index> candidate_faces = indices_where(static_cast<Index>(faces.nodes.size()), [&](Index f) {
    return faces.sides[f][1].hex >= 0 && std::ranges::all_of(faces.nodes[f], [&](Index n) { return near[n] != 0; });
  });
  const Skin skin = make_skin(mesh, faces, candidate_faces);
  const Hits on = hits(facts, skin, near_surfaces(facts, skin, [](Index) { return true; }));
  std::vector<SurfaceCandidate> candidates = common_surfaces(skin, on, [](Index) { return true; });
  std::erase_if(candidates, [&](const SurfaceCandidate& candidate) { return !between[candidate.surface]; });
  score(facts, skin, candidates);
  std::vector<Index> walls;
  for (const SurfaceCandidate& candidate : candidates)
    if (candidate.fits) walls.push_back(skin.faces[candidate.quad]);
  sort_unique(walls);
  return walls;
}

}  // namespace hextwist::detail
