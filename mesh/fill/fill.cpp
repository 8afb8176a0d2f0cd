#include "hextwist/mesh/fill/fill.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>
#include <numeric>
#include <typeinfo>

#include "hextwist/base/memory.h"
#include "hextwist/base/sorted.h"
#include "hextwist/base/union_find.h"
#include "hextwist/mesh/fill/builder_internal.h"

namespace hextwist {
namespace fill {

Builder::Builder(const Facts& of, std::vector<int> intervals_of_curves, double size_of_edges, QuadMesher paver)
    : facts(of),
      intervals(std::move(intervals_of_curves)),
      size(size_of_edges),
      quads(std::move(paver)),
      curve_nodes(of.curves.size()),
      surface_quads(of.surfaces.size()),
      vertex_nodes_(static_cast<std::size_t>(of.model.count(0)), -1) {
  const double n_on_curves = std::accumulate(intervals.begin(), intervals.end(), 0.0);
  check_memory(n_on_curves / 12, n_on_curves, "at least ");  // each interval is an edge of a hex
  for (std::size_t c = 0; c < intervals.size(); ++c) {
    if (intervals[c] == 0) continue;
    const int curve = static_cast<int>(c) + 1;
    curve_nodes[c].push_back(at_vertex(facts.curves[c].first));
    for (int i = 1; i < intervals[c]; ++i)
      curve_nodes[c].push_back(add(facts.point_at(curve, static_cast<double>(i) / intervals[c]), {1, curve}));
    curve_nodes[c].push_back(at_vertex(facts.curves[c].last));
  }
}

Index Builder::at_vertex(int vertex) {
  Index& node = vertex_nodes_[vertex - 1];
  if (node < 0) node = add(facts.model.point({0, vertex}, {}), {0, vertex});
  return node;
}

Index Builder::add(const Vec3& point, Owner owner) {
  points.push_back(point);
  owners.push_back(owner);
  return static_cast<Index>(points.size()) - 1;
}

std::vector<Index> Builder::nodes(const Chain& chain) const {
  std::vector<Index> result;
  for (const Step& step : chain) {
    std::vector<Index> own = curve_nodes[step.curve - 1];
    if (!step.forward) std::ranges::reverse(own);
    result.insert(result.end(), own.begin() + (result.empty() ? 0 : 1), own.end());
  }
  return result;
}

Vec3 Builder::vector_area(const std::vector<Index>& rim) const {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < rim.size(); ++i) sum += points[rim[i]].cross(points[rim[(i + 1) % rim.size()]]) / 2;
  return sum;
}

void Builder::drop_unused() {
  std::vector<Index> now(points.size(), -1);
  for (const Hex& hex : hexes)
    for (const Index n : hex) now[n] = 0;
  Index n_used = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (now[i] < 0) continue;
    points[n_used] = points[i];
    owners[n_used] = owners[i];
    now[i] = n_used++;
  }
  points.resize(n_used);
  owners.resize(n_used);
  for (Hex& hex : hexes)
    for (Index& n : hex) n = now[n];
  for (std::vector<Index>& nodes_of_curve : curve_nodes) {
    const bool is_used = std::ranges::all_of(nodes_of_curve, [&](Index n) { return now[n] >= 0; });
    if (!is_used) nodes_of_curve.clear();
    for (Index& n : nodes_of_curve) n = now[n];
  }
  for (std::vector<Quad>& own : surface_quads)
    for (Quad& quad : own)
      for (Index& n : quad) n = now[n];
}

std::vector<Index> Builder::rim_of(const Chain& loop) const {
  std::vector<Index> result = nodes(loop);
  result.pop_back();
  return result;
}

namespace {

/// Sweeps volume after volume, so that what several of them share is meshed before it is needed.
void sweep_all(Builder& builder, std::vector<Sweep> sweeps) {
  const Facts& facts = builder.facts;
  // Sides first: nothing else decides about them.
  for (const Sweep& sweep : sweeps)
    for (const int surface : sweep.sides)
      if (!builder.is_meshed(surface) && !(sweep.axis && sweep.axis->has_end(surface))) {
        if (sweep.is_turned && facts.surfaces[surface - 1].is_annulus)
          builder.ring(surface, true);
        else
          builder.mesh_surface(surface);
      }
  std::erase_if(sweeps, [&](const Sweep& sweep) {
    if (sweep.is_turned) builder.turn(sweep);
    return sweep.is_turned;
  });
  // From several caps to one there is but one way, after all that ends at those caps. Caps that are linked by volumes
  // with one at each end are alike.
  std::vector<Index> alike = singletons(static_cast<Index>(facts.surfaces.size()) + 1);
  const auto goes_one_way = [](const Sweep& sweep) { return sweep.caps[0].size() != sweep.caps[1].size(); };
  for (const Sweep& sweep : sweeps)
    if (sweep.caps[0].size() == 1 && sweep.caps[1].size() == 1) join(alike, sweep.caps[0][0], sweep.caps[1][0]);
  const auto start = [](const Sweep& sweep) { return sweep.caps[0].size() >= sweep.caps[1].size() ? 0 : 1; };
  const auto meshed = [&](const std::vector<int>& caps) {
    return std::ranges::all_of(caps, [&](int s) { return builder.is_meshed(s); });
  };
  const auto sweep_now = [&](std::size_t i, int from) {
    for (const int surface : sweeps[i].caps[from])
      if (!builder.is_meshed(surface)) {
        try {
          builder.mesh_surface(surface);
        } catch (const Error& error) {
          if (typeid(error) != typeid(Error)) throw;  // the user stopped it
          throw Error("volume " + std::to_string(sweeps[i].volume) + ": " + error.what());
        }
      }
    builder.sweep(sweeps[i], from);
    sweeps.erase(sweeps.begin() + static_cast<std::ptrdiff_t>(i));
  };
  while (!sweeps.empty()) {
    bool done = false;
    for (std::size_t i = 0; i < sweeps.size() && !done; ++i)
      for (const int from : {0, 1})
        if (!done && !goes_one_way(sweeps[i]) && meshed(sweeps[i].caps[from])) {
          sweep_now(i, from);
          done = true;
        }
    for (std::size_t i = 0; i < sweeps.size() && !done; ++i) {
      if (!goes_one_way(sweeps[i])) continue;
      const bool waits = std::ranges::any_of(sweeps, [&](const Sweep& other) {
        if (&other == &sweeps[i] || !goes_one_way(other)) return false;
        return std::ranges::any_of(other.caps[1 - start(other)], [&](int end) {
          return std::ranges::any_of(sweeps[i].caps[start(sweeps[i])],
                                     [&](int s) { return find_root(alike, s) == find_root(alike, end); });
        });
      });
      if (waits) continue;
      sweep_now(i, start(sweeps[i]));
      done = true;
    }
    if (done) continue;
    const auto next = std::ranges::find_if_not(sweeps, goes_one_way);
    if (next == sweeps.end())
      throw Error("volume " + std::to_string(sweeps.front().volume) +
                  ": its end and those of others depend on each other in a circle");
    // From the end that needs nobody else, if one does.
    const bool second = std::ranges::all_of(next->caps[1], [&](int s) { return is_regular(facts.surfaces[s - 1]); }) &&
                        !std::ranges::all_of(next->caps[0], [&](int s) { return is_regular(facts.surfaces[s - 1]); });
    sweep_now(static_cast<std::size_t>(next - sweeps.begin()), second ? 1 : 0);
  }
}

Association tags_of(const Builder& builder, const Mesh& mesh) {
  Association tags;
  tags.node_owner = builder.owners;
  tags.node_parameters.resize(mesh.points.size());
  tags.hex_volume = builder.hex_volume;
  std::vector<std::pair<Edge, int>> edges;
  for (std::size_t c = 0; c < builder.curve_nodes.size(); ++c) {
    const auto& nodes = builder.curve_nodes[c];
    for (std::size_t i = 1; i < nodes.size(); ++i)
      edges.push_back({{std::min(nodes[i - 1], nodes[i]), std::max(nodes[i - 1], nodes[i])}, static_cast<int>(c) + 1});
  }
  sort_unique(edges, [](const auto& edge) { return edge.first; });
  for (const auto& [edge, curve] : edges) {
    tags.curve_edges.push_back(edge);
    tags.edge_curve.push_back(curve);
  }
  std::vector<Quad> quads;
  std::vector<int> surface_of;
  for (std::size_t s = 0; s < builder.surface_quads.size(); ++s)
    for (const Quad& quad : builder.surface_quads[s]) {
      quads.push_back(quad);
      surface_of.push_back(static_cast<int>(s) + 1);
    }
  const std::vector<Side> sides = find_sides(mesh, quads);
  std::vector<std::pair<Side, int>> faces;
  for (std::size_t i = 0; i < sides.size(); ++i)
    if (sides[i].hex >= 0) faces.emplace_back(sides[i], surface_of[i]);
  sort_unique(faces, [](const auto& face) { return face.first; });
  for (const auto& [side, surface] : faces) {
    tags.surface_faces.push_back(side);
    tags.face_surface.push_back(surface);
  }
  return tags;
}

}  // namespace
}  // namespace fill

FillResult fill_volumes(const Model& model, const FillOptions& options) {
  std::vector<int> volumes = options.volumes;
  if (volumes.empty()) {
    volumes.resize(static_cast<std::size_t>(model.count(3)));
    std::iota(volumes.begin(), volumes.end(), 1);
  }
  if (volumes.empty()) throw Error("the CAD has no volumes, only surfaces: there is nothing to fill with hexes");
  Box box;
  for (const int volume : volumes) box.add(model.box({3, volume}));
  const double size = options.size > 0 ? options.size : box.diagonal() / 15;
  const fill::Facts facts(model, volumes);
  std::vector<fill::Sweep> sweeps = fill::find_sweeps(facts, volumes, options.quads != nullptr);
  // Bent curves need some intervals to look like it: the fewer the more was said.
  const double degrees = options.intervals > 0 ? 100 : options.size > 0 ? 61 : 31;
  std::vector<int> intervals =
      fill::find_intervals(facts, sweeps, size, options.intervals, degrees * std::numbers::pi / 180);

  FillResult result;
  fill::Builder builder(facts, std::move(intervals), options.intervals > 0 ? 0 : size, options.quads);
  std::erase_if(sweeps, [&](const fill::Sweep& sweep) {
    if (sweep.is_ball) builder.fill_ball(sweep.volume, options.intervals);
    return sweep.is_ball;
  });
  fill::sweep_all(builder, std::move(sweeps));

  builder.drop_unused();
  Mesh& mesh = result.mesh;
  mesh.points = builder.points;
  mesh.hexes = builder.hexes;
  for (const int volume : volumes) {
    Block block{volume, model.name({3, volume}), {}};
    for (Index h = 0; h < mesh.n_hexes(); ++h)
      if (builder.hex_volume[h] == volume) block.hexes.push_back(h);
    mesh.blocks.push_back(std::move(block));
  }
  result.tags = fill::tags_of(builder, mesh);
  return result;
}

}  // namespace hextwist
