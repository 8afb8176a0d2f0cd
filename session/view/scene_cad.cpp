// The true surfaces and curves of a scene: pieces of mesh faces and edges, finer than these, projected to where they
// belong. So every kind of model can be drawn, trimmed as the mesh is.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "hextwist/base/parallel.h"
#include "hextwist/geom/facets.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/session/view/scene.h"

namespace hextwist {
namespace {

constexpr std::size_t most_projected = 60000;  // points: what a page can wait for
constexpr int n_pieces_of_edge = 6;

bool is_flat(const std::string& type) {
  return type == "plane" || type == "facets" || type == "line" || type == "polyline";
}

struct Surfaces {
  std::vector<float> points, normals, at;  ///< at: where in the face of the mesh, 0..1 each
  std::vector<std::uint32_t> quads, surface;
};

/// Faces of one surface, each in n x n pieces.
void add_surface(const MeshedModel& meshed, int id, std::span<const Side> sides, int n, const Vec3& origin,
                 Surfaces& out) {
  const Owner owner{2, id};
  const bool project = meshed.model->type(owner) != "facets";
  std::vector<Vec3> points;
  for (const Side& side : sides) {
    const auto cycle = face_node_cycle(meshed.mesh.hexes[side.hex], side.face);
    std::array<Vec3, 4> p;
    for (int k = 0; k < 4; ++k) p[k] = meshed.mesh.points[cycle[k]];
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        const double u = static_cast<double>(i) / n, v = static_cast<double>(j) / n;
        points.emplace_back((1 - v) * ((1 - u) * p[0] + u * p[1]) + v * ((1 - u) * p[3] + u * p[2]));
      }
  }
  const std::size_t per_face = static_cast<std::size_t>((n + 1) * (n + 1));
  std::vector<Projection> projected(points.size());
  if (project) meshed.model->project(owner, points, {}, projected);
  const auto first = static_cast<std::uint32_t>(out.points.size() / 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t face = i / per_face * per_face;
    const Vec3 straight =
        (points[face + per_face - 1] - points[face]).cross(points[face + per_face - 1 - n] - points[face + n]);
    Vec3 normal = project ? meshed.model->normal(id, projected[i].parameters) : Vec3(Vec3::Zero());
    if (!(normal.norm() > 0.5)) normal = straight.normalized();
    // Outwards as the face of the mesh looks.
    if (normal.dot(straight) < 0) normal = -normal;
    const Vec3 place = project ? projected[i].point : points[i];
    for (int k = 0; k < 3; ++k) {
      out.points.push_back(static_cast<float>(place[k] - origin[k]));
      out.normals.push_back(static_cast<float>(normal[k]));
    }
    const auto step = static_cast<std::size_t>(n + 1);
    out.at.push_back(static_cast<float>(i % per_face % step) / static_cast<float>(n));
    out.at.push_back(static_cast<float>(i % per_face / step) / static_cast<float>(n));
  }
  for (std::uint32_t face = 0; face < sides.size(); ++face)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const std::uint32_t corner =
            first + face * static_cast<std::uint32_t>(per_face) + static_cast<std::uint32_t>(j * (n + 1) + i);
        const auto up = static_cast<std::uint32_t>(n + 1);
        for (const std::uint32_t at : {corner, corner + 1, corner + up + 1, corner + up}) out.quads.push_back(at);
        out.surface.push_back(static_cast<std::uint32_t>(id));
      }
}

/// The same where there is no mesh: triangles, as quads whose last corners are one.
void add_surface(const CadSurface& surface, int id, const Vec3& origin, Surfaces& out) {
  const auto first = static_cast<std::uint32_t>(out.points.size() / 3);
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    add_point(out.points, surface.points[i] - origin);
    add_point(out.normals, surface.normals[i]);
    for (int k = 0; k < 2; ++k) out.at.push_back(0.5F);  // far from the lines of a mesh
  }
  for (const auto& [a, b, c] : surface.triangles) {
    for (const std::int32_t corner : {a, b, c, c}) out.quads.push_back(first + static_cast<std::uint32_t>(corner));
    out.surface.push_back(static_cast<std::uint32_t>(id));
  }
}

PackedBlock cad_alone(const Model& model, const Vec3& origin) {
  Surfaces surfaces;
  std::vector<CadSurface> all(static_cast<std::size_t>(model.count(2)));
  parallel_each(
      all.size(), [&](std::size_t i) { all[i] = cad_surface(model, static_cast<int>(i) + 1); }, 1);
  for (std::size_t i = 0; i < all.size(); ++i) add_surface(all[i], static_cast<int>(i) + 1, origin, surfaces);
  std::vector<float> segments, vertices;
  std::vector<std::uint32_t> curves;
  for (int id = 1; id <= model.count(1); ++id) {
    const std::vector<Vec3> points = cad_curve(model, id);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      add_point(segments, points[i] - origin);
      add_point(segments, points[i + 1] - origin);
      curves.push_back(static_cast<std::uint32_t>(id));
    }
  }
  for (int id = 1; id <= model.count(0); ++id) add_point(vertices, model.point({0, id}, {}) - origin);
  return {"cad",
          {packed("point", surfaces.points, 3), packed("normal", surfaces.normals, 3), packed("at", surfaces.at, 2),
           packed("quad", surfaces.quads, 4), packed("quad_surface", surfaces.surface), packed("segment", segments, 6),
           packed("segment_curve", curves), packed("vertex", vertices, 3)}};
}

}  // namespace

CadSurface cad_surface(const Model& model, int surface) {
  const SurfaceFacets facets = facets_of(model, surface);
  CadSurface result;
  for (const Parameters& at : facets.points) {
    result.points.push_back(model.point({2, surface}, at));
    result.normals.push_back(model.normal(surface, at));
  }
  result.triangles = facets.triangles;
  for (const auto& [a, b, c] : result.triangles) {
    // Where a surface has no normal (the tip of a cone) that of a triangle does.
    const Vec3 flat = (result.points[b] - result.points[a]).cross(result.points[c] - result.points[a]).normalized();
    for (const std::int32_t corner : {a, b, c})
      if (!(result.normals[corner].norm() > 0.5)) result.normals[corner] = flat;
  }
  return result;
}

std::vector<Vec3> cad_curve(const Model& model, int curve) {
  constexpr int n_pieces = 64;
  const CurveRange range = model.range(curve);
  const int n = model.type({1, curve}) == "line" ? 1 : n_pieces;
  std::vector<Vec3> points;
  for (int i = 0; i <= n; ++i) {
    const double t = static_cast<double>(i) / n;
    points.push_back(model.point({1, curve}, {(1 - t) * range.first + t * range.last, 0}));
  }
  return points;
}

PackedBlock cad_block(const SceneSource& source) {
  const MeshedModel& meshed = source.selector.meshed;
  const Association& association = meshed.association;
  const Vec3 origin = scene_origin(source);
  PackedBlock block{"cad", {}};
  if (!meshed.model) return block;
  if (meshed.mesh.n_hexes() == 0) return cad_alone(*meshed.model, origin);

  std::map<int, std::vector<Side>> faces;
  std::size_t n_curved = 0;
  for (std::size_t i = 0; i < association.surface_faces.size(); ++i)
    faces[association.face_surface[i]].push_back(association.surface_faces[i]);
  for (const auto& [id, sides] : faces)
    if (!is_flat(meshed.model->type({2, id}))) n_curved += sides.size();
  // As fine as there is time for.
  int n = 4;
  while (n > 1 && n_curved * static_cast<std::size_t>((n + 1) * (n + 1)) > most_projected) --n;
  Surfaces surfaces;
  const bool too_many = n_curved * 4 > 10 * most_projected;
  for (const auto& [id, sides] : faces)
    if (!too_many || is_flat(meshed.model->type({2, id})))
      add_surface(meshed, id, sides, is_flat(meshed.model->type({2, id})) ? 1 : n, origin, surfaces);

  std::map<int, std::vector<Edge>> edges;
  for (std::size_t i = 0; i < association.curve_edges.size(); ++i)
    edges[association.edge_curve[i]].push_back(association.curve_edges[i]);
  std::vector<float> segments;
  std::vector<std::uint32_t> curves;
  for (const auto& [id, pairs] : edges) {
    const bool curved = !is_flat(meshed.model->type({1, id})) && pairs.size() * n_pieces_of_edge < most_projected;
    const int pieces = curved ? n_pieces_of_edge : 1;
    std::vector<Vec3> points;
    for (const auto& [a, b] : pairs)
      for (int i = 0; i <= pieces; ++i) {
        const double t = static_cast<double>(i) / pieces;
        points.emplace_back((1 - t) * meshed.mesh.points[a] + t * meshed.mesh.points[b]);
      }
    if (curved) {
      std::vector<Projection> projected(points.size());
      meshed.model->project({1, id}, points, {}, projected);
      for (std::size_t i = 0; i < points.size(); ++i) points[i] = projected[i].point;
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i % static_cast<std::size_t>(pieces + 1) == static_cast<std::size_t>(pieces)) continue;
      for (const Vec3& p : {points[i], points[i + 1]})
        for (int k = 0; k < 3; ++k) segments.push_back(static_cast<float>(p[k] - origin[k]));
      curves.push_back(static_cast<std::uint32_t>(id));
    }
  }
  std::vector<float> vertices;
  for (int id = 1; id <= meshed.model->count(0); ++id) {
    const Vec3 p = meshed.model->point({0, id}, {}) - origin;
    for (int k = 0; k < 3; ++k) vertices.push_back(static_cast<float>(p[k]));
  }
  block.arrays = {packed("point", surfaces.points, 3),
                  packed("normal", surfaces.normals, 3),
                  packed("at", surfaces.at, 2),
                  packed("quad", surfaces.quads, 4),
                  packed("quad_surface", surfaces.surface),
                  packed("segment", segments, 6),
                  packed("segment_curve", curves),
                  packed("vertex", vertices, 3)};
  return block;
}

}  // namespace hextwist
