#include "hextwist/refine/place.h"

#include <algorithm>
#include <cmath>

#include "hextwist/base/interrupt.h"
#include "hextwist/base/large_array.h"
#include "hextwist/base/parallel.h"
#include "hextwist/base/ranked_bits.h"
#include "hextwist/base/sorted.h"
#include "hextwist/refine/origin.h"

namespace hextwist {
namespace {

constexpr std::size_t grain = 256;

/// Indices sorted by owner, with the runs of equal owners.
struct ByOwner {
  std::vector<Index> items;
  std::vector<std::size_t> run;  // starts of the runs, and the end

  std::span<const Index> operator[](std::size_t g) const {
    return std::span(items).subspan(run[g], run[g + 1] - run[g]);
  }
};

template <typename OwnerOf>
ByOwner group_by_owner(std::size_t n, int dim, const OwnerOf& owner_of) {
  ByOwner groups;
  groups.items =
      indices_where(static_cast<Index>(n), [&](Index i) { return owner_of(static_cast<std::size_t>(i)).dim == dim; });
  std::ranges::stable_sort(groups.items, {}, [&](Index i) { return owner_of(i).id; });
  for (std::size_t i = 0; i < groups.items.size(); ++i)
    if (i == 0 || owner_of(groups.items[i]).id != owner_of(groups.items[i - 1]).id) groups.run.push_back(i);
  groups.run.push_back(groups.items.size());
  return groups;
}

/// Of curves and surfaces, counted from the first new one.
RankedBits new_nodes_on_cad(const Association& association, Index n_old_nodes) {
  const Index n = static_cast<Index>(association.node_owner.size()) - n_old_nodes;
  RankedBits on_cad(static_cast<std::size_t>(n));
  parallel_chunks(n, 1024 * RankedBits::width, [&](Index, Index begin, Index end) {
    for (Index i = begin; i < end; ++i)
      if (const int dim = association.node_owner[n_old_nodes + i].dim; dim == 1 || dim == 2) on_cad.set(i);
  });
  on_cad.finish();
  return on_cad;
}

/// Everything that placing works on.
struct Work {
  const Mesh& old_mesh;
  const Association& old;
  const Split& split;
  const Lineage& lineage;
  const SplitTable& table;
  const Model& model;
  Mesh& mesh;
  Association& association;
  RankedBits on_cad;                     // new nodes on curves and surfaces, counted from the first new one
  std::vector<Vec3> moved;               // of each of these: displacement from the straight place
  std::vector<std::uint8_t> edge_moved;  // per cut edge: any of its nodes displaced

  Vec3 displacement(Index node) const {
    const Index at = on_cad.find(node - lineage.n_old_nodes);
    return at < 0 ? Vec3(Vec3::Zero()) : moved[at];
  }
  void move(Index node, const Vec3& to, Parameters parameters) {
    moved[on_cad[node - lineage.n_old_nodes]] = to - mesh.points[node];
    mesh.points[node] = to;
    association.node_parameters[node] = parameters;
  }
};

// --- curves ---

/// Parameters of both ends of an edge on a curve, the second shifted by a period where that is the way the edge goes.
std::array<double, 2> curve_interval(const Work& work, const CutEdge& edge, int curve) {
  const auto parameter = [&](Index node) {
    if (work.old.node_owner[node] == Owner{1, curve} && !std::isnan(work.old.node_parameters[node].u))
      return work.old.node_parameters[node].u;
    return work.model.project({1, curve}, work.old_mesh.points[node]).parameters.u;
  };
  const double a = parameter(edge.a), b = parameter(edge.b);
  const double period = work.model.range(curve).period;
  if (period == 0) return {a, b};
  // A closed curve can be followed both ways round, and its seam vertex has two parameters: of all readings take the
  // one whose middle is nearest to the middle of the edge.
  const Vec3 middle = (work.old_mesh.points[edge.a] + work.old_mesh.points[edge.b]) / 2;
  double best = b, best_distance = std::numeric_limits<double>::infinity();
  for (const double candidate : {b, b - period, b + period}) {
    if (std::abs(candidate - a) > period) continue;  // more than once round has the same middle
    const double distance = (work.model.point({1, curve}, {(a + candidate) / 2, 0}) - middle).norm();
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return {a, best};
}

/// Parameter between a and b at which a point divides the way between the ends as 1 - at : at. Parameters that run
/// evenly along the curve (lines, circles) are taken as they are; others are corrected by the chords.
double divide_curve(const Model& model, int curve, double a, double b, double at) {
  const Vec3 start = model.point({1, curve}, {a, 0}), end = model.point({1, curve}, {b, 0});
  double low = 0, high = 1, s = at;
  for (int step = 0; step < 30; ++step) {
    const Vec3 p = model.point({1, curve}, {a + s * (b - a), 0});
    const double before = (p - start).norm(), after = (end - p).norm();
    if (!(before + after > 0)) return a + at * (b - a);
    const double error = before / (before + after) - at;
    if (std::abs(error) < (step == 0 ? 0.02 : 1e-3)) break;
    (error > 0 ? high : low) = s;
    // A secant through the nearer end, kept inside the bracket.
    const double guess = error > 0 ? s * at / (at + error) : 1 - (1 - s) * (1 - at) / (1 - at - error);
    s = guess > low && guess < high ? guess : (low + high) / 2;
  }
  return a + s * (b - a);
}

void place_on_curves(Work& work) {
  const auto& edges = work.lineage.edges;
  const auto owner = [&](std::size_t i) { return work.association.node_owner[edges[i].first_node]; };
  parallel_each(edges.size(), [&](std::size_t i) {
    if (i % grain == 0) check_interrupt();
    if (owner(i).dim != 1) return;
    const int curve = owner(i).id;
    const auto [a, b] = curve_interval(work, edges[i], curve);
    const CurveRange range = work.model.range(curve);
    Index node = edges[i].first_node;
    for (const double at : work.table.edge[edges[i].code].at) {
      double t = divide_curve(work.model, curve, a, b, at);
      if (range.period > 0) {
        if (t < range.first) t += range.period;
        if (t > range.last) t -= range.period;
      }
      work.move(node++, work.model.point({1, curve}, {t, 0}), {t, std::numeric_limits<double>::quiet_NaN()});
    }
  });
}

// --- surfaces ---

/// Parameters of old nodes on surfaces that they lie on but do not belong to (nodes of curves and vertices).
class RimParameters {
 public:
  explicit RimParameters(const Work& work) : work_(work) {
    const auto& old = work.old;
    for (std::size_t i = 0; i < old.surface_faces.size(); ++i) {
      const Side side = old.surface_faces[i];
      if (!work.split.is_cut(side.hex)) continue;
      for (const Index node : face_nodes(work.old_mesh.hexes[side.hex], side.face))
        if (old.node_owner[node] != Owner{2, old.face_surface[i]}) entries_.push_back({old.face_surface[i], node, {}});
    }
    sort_unique(entries_, &Entry::key);
    parallel_each(entries_.size(), [&](std::size_t i) {
      entries_[i].parameters =
          work.model.project({2, entries_[i].surface}, work.old_mesh.points[entries_[i].node]).parameters;
    });
  }

  Parameters operator()(int surface, Index node) const {
    if (work_.old.node_owner[node] == Owner{2, surface}) return work_.old.node_parameters[node];
    const Index at = position_in(entries_, std::pair{surface, node}, &Entry::key);
    return at >= 0 ? entries_[at].parameters : Parameters{};
  }

 private:
  struct Entry {
    int surface;
    Index node;
    Parameters parameters;
    std::pair<int, Index> key() const { return {surface, node}; }
  };
  const Work& work_;
  std::vector<Entry> entries_;
};

/// New nodes to be projected to one surface.
struct Batch {
  std::vector<Index> nodes;
  std::vector<Vec3> points;
  std::vector<Parameters> seeds;
  std::vector<double> reach;  // size of the parent edge or face: a projection does not move a node by much of it

  explicit Batch(std::size_t n) : nodes(n), points(n), seeds(n), reach(n) {}
  void set(std::size_t at, Index node, const Vec3& point, Parameters seed, double size) {
    nodes[at] = node;
    points[at] = point;
    seeds[at] = seed;
    reach[at] = size;
  }
};

/// Where the nodes of each item of a group begin in its batch, and the end.
template <class NodesOf>
std::vector<std::size_t> batch_starts(std::span<const Index> items, const NodesOf& n_nodes_of) {
  std::vector<std::size_t> starts{0};
  starts.reserve(items.size() + 1);
  for (const Index item : items) starts.push_back(starts.back() + n_nodes_of(item));
  return starts;
}

void project_batch(Work& work, int surface, const Batch& batch) {
  std::vector<Projection> result(batch.nodes.size());
  parallel_ranges(
      static_cast<Index>(result.size()),
      [&](Index begin, Index end) {
        check_interrupt();
        const auto first = static_cast<std::size_t>(begin), n = static_cast<std::size_t>(end - begin);
        work.model.project({2, surface}, std::span(batch.points).subspan(first, n),
                           std::span(batch.seeds).subspan(first, n), std::span(result).subspan(first, n));
      },
      grain);
  parallel_each(result.size(), [&](std::size_t i) {
    // A seeded search is local; one that went far may have found another sheet of the surface.
    if (!(result[i].distance < 0.1 * batch.reach[i])) {
      const Projection global = work.model.project({2, surface}, batch.points[i]);
      if (!(global.distance >= result[i].distance)) result[i] = global;
    }
    work.move(batch.nodes[i], result[i].point, result[i].parameters);
  });
}

void place_edges_on_surfaces(Work& work, const RimParameters& parameters_of) {
  const auto& edges = work.lineage.edges;
  const ByOwner groups = group_by_owner(edges.size(), 2, [&](std::size_t i) {
    const CutEdge& edge = edges[i];
    return work.table.edge[edge.code].at.empty() ? Owner{} : work.association.node_owner[edge.first_node];
  });
  for (std::size_t g = 0; g + 1 < groups.run.size(); ++g) {
    const int surface = work.association.node_owner[edges[groups[g].front()].first_node].id;
    const std::span<const Index> items = groups[g];
    const auto starts = batch_starts(items, [&](Index i) { return work.table.edge[edges[i].code].at.size(); });
    Batch batch(starts.back());
    parallel_each(items.size(), [&](std::size_t i) {
      const CutEdge& edge = edges[items[i]];
      const double size = (work.old_mesh.points[edge.a] - work.old_mesh.points[edge.b]).norm();
      Index node = edge.first_node;
      std::size_t next = starts[i];
      for (const double at : work.table.edge[edge.code].at) {
        Parameters seed = parameters_of(surface, at < 0.5 ? edge.a : edge.b);
        if (std::isnan(seed.u)) seed = parameters_of(surface, at < 0.5 ? edge.b : edge.a);
        batch.set(next++, node, work.mesh.points[node], seed, size);
        ++node;
      }
    });
    project_batch(work, surface, batch);
  }
}

// --- blending ---

/// Displacement of an old edge at parameter t along it: through its new nodes, zero at its ends.
Vec3 edge_displacement(const Work& work, Index number, bool backwards, double t) {
  if (number < 0 || !work.edge_moved[number]) return Vec3::Zero();
  const CutEdge& edge = work.lineage.edges[number];
  const auto& at = work.table.edge[edge.code].at;
  if (backwards) t = 1 - t;
  const int n = static_cast<int>(at.size());
  if (n <= 2) {  // the polynomial through the nodes and both ends
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < n; ++i) {
      double weight = t * (1 - t) / (at[i] * (1 - at[i]));
      for (int j = 0; j < n; ++j)
        if (j != i) weight *= (t - at[j]) / (at[i] - at[j]);
      sum += weight * work.displacement(edge.first_node + i);
    }
    return sum;
  }
  int i = 0;
  while (i < n && at[i] < t) ++i;
  const double t0 = i == 0 ? 0 : at[i - 1], t1 = i == n ? 1 : at[i];
  const Vec3 d0 = i == 0 ? Vec3::Zero() : work.displacement(edge.first_node + i - 1);
  const Vec3 d1 = i == n ? Vec3::Zero() : work.displacement(edge.first_node + i);
  return d0 + (t - t0) / (t1 - t0) * (d1 - d0);
}

/// A cut hex as the blending sees it.
struct Cell {
  const Work& work;
  Index cut;
  const Hex& hex;

  Vec3 edge(int e, double t) const {
    return edge_displacement(work, work.split.hex_edges[cut][e], hex[edge_corner(e, 0)] > hex[edge_corner(e, 1)], t);
  }
  bool edge_has_moved(int e) const {
    const Index number = work.split.hex_edges[cut][e];
    return number >= 0 && work.edge_moved[number];
  }
  bool face_rim_has_moved(int f) const {
    return edge_has_moved(face_edge(f, 0)) || edge_has_moved(face_edge(f, 1)) || edge_has_moved(face_edge(f, 2)) ||
           edge_has_moved(face_edge(f, 3));
  }
  /// Blend of the four edges of a face (Coons).
  Vec3 rim(int f, double u, double v) const {
    return (1 - v) * edge(face_edge(f, 0), u) + v * edge(face_edge(f, 1), u) + (1 - u) * edge(face_edge(f, 2), v) +
           u * edge(face_edge(f, 3), v);
  }
  /// Calls body(node, u, v) for the new nodes inside a face, in this hex's frame.
  template <typename Body>
  void for_each_face_node(int f, const Body& body) const {
    const Index number = work.split.hex_faces[cut][f];
    if (number < 0) return;
    const CutFace& face = work.lineage.faces[number];
    const int symmetry = face_symmetry(face_nodes(hex, f));
    const FacePattern& pattern = work.table.face[work.table.hex(work.lineage.hexes[cut].code).face_code[f]];
    for (std::size_t s = 0; s < pattern.at.size(); ++s)
      body(face.first_node + pattern.turned_slot[symmetry][s], pattern.at[s][0], pattern.at[s][1]);
  }
  bool on_surface(int f) const {
    const Index number = work.split.hex_faces[cut][f];
    return number >= 0 && work.association.node_owner[work.lineage.faces[number].first_node].dim == 2;
  }
  /// How far the nodes inside a face bulge beyond the blend of its edges, as the height of 16 u (1-u) v (1-v).
  Vec3 bulge(int f) const {
    Vec3 sum = Vec3::Zero();
    int n = 0;
    if (on_surface(f))
      for_each_face_node(f, [&](Index node, double u, double v) {
        sum += (work.displacement(node) - rim(f, u, v)) / (16 * u * (1 - u) * v * (1 - v));
        ++n;
      });
    return n ? Vec3(sum / n) : sum;
  }
};

void place_faces_on_surfaces(Work& work, const RimParameters& parameters_of) {
  const auto& faces = work.lineage.faces;
  const ByOwner groups =
      group_by_owner(faces.size(), 2, [&](std::size_t i) { return work.association.node_owner[faces[i].first_node]; });
  for (std::size_t g = 0; g + 1 < groups.run.size(); ++g) {
    const int surface = work.association.node_owner[faces[groups[g].front()].first_node].id;
    const std::span<const Index> items = groups[g];
    const auto starts = batch_starts(items, [&](Index i) { return work.table.face[faces[i].code].at.size(); });
    Batch batch(starts.back());
    parallel_each(items.size(), [&](std::size_t i) {
      const Side side = faces[items[i]].side;
      std::size_t next = starts[i];
      const Cell cell{work, work.split.cut_index(side.hex), work.old_mesh.hexes[side.hex]};
      const auto corners = face_nodes(cell.hex, side.face);
      const double size = std::max((work.old_mesh.points[corners[0]] - work.old_mesh.points[corners[3]]).norm(),
                                   (work.old_mesh.points[corners[1]] - work.old_mesh.points[corners[2]]).norm());
      cell.for_each_face_node(side.face, [&](Index node, double u, double v) {
        const Index nearest = corners[(u > 0.5) | (v > 0.5) << 1];
        Parameters seed = parameters_of(surface, nearest);
        for (int k = 0; k < 4 && std::isnan(seed.u); ++k) seed = parameters_of(surface, corners[k]);
        batch.set(next++, node, work.mesh.points[node] + cell.rim(side.face, u, v), seed, size);
      });
    });
    project_batch(work, surface, batch);
  }
}

void place_inner_faces(Work& work) {
  parallel_each(work.lineage.faces.size(), [&](std::size_t i) {
    if (i % grain == 0) check_interrupt();
    const CutFace& face = work.lineage.faces[i];
    if (work.association.node_owner[face.first_node].dim != 3) return;
    const Cell cell{work, work.split.cut_index(face.side.hex), work.old_mesh.hexes[face.side.hex]};
    if (!cell.face_rim_has_moved(face.side.face)) return;
    cell.for_each_face_node(face.side.face, [&](Index node, double u, double v) {
      work.mesh.points[node] += cell.rim(face.side.face, u, v);
    });
  });
}

void place_inside_hexes(Work& work) {
  parallel_each(work.lineage.hexes.size(), [&](std::size_t i) {
    if (i % grain == 0) check_interrupt();
    const CutHex& hex = work.lineage.hexes[i];
    const auto& inside = work.table.hex(hex.code).inside;
    if (inside.empty()) return;
    const Cell cell{work, static_cast<Index>(i), work.old_mesh.hexes[hex.hex]};
    std::array<Vec3, n_hex_faces> bulge;
    bool any = false;
    for (int f = 0; f < n_hex_faces; ++f) {
      bulge[f] = cell.bulge(f);
      any |= cell.face_rim_has_moved(f) || !bulge[f].isZero(0);
    }
    if (!any) return;
    for (std::size_t s = 0; s < inside.size(); ++s) {
      const Vec3& at = inside[s];
      Vec3 sum = Vec3::Zero();
      for (int f = 0; f < n_hex_faces; ++f) {
        const int axis = f >> 1;
        const double u = at[axis == 0 ? 1 : 0], v = at[axis == 2 ? 1 : 2];
        const double weight = f & 1 ? at[axis] : 1 - at[axis];
        sum += weight * (cell.rim(f, u, v) + 16 * u * (1 - u) * v * (1 - v) * bulge[f]);
      }
      for (int e = 0; e < n_hex_edges; ++e) {  // each edge has been counted in both its faces
        const int axis = e >> 2;
        const int low = axis == 0 ? 1 : 0, high = axis == 2 ? 1 : 2;
        const double weight = (e & 1 ? at[low] : 1 - at[low]) * (e & 2 ? at[high] : 1 - at[high]);
        sum -= weight * cell.edge(e, at[axis]);
      }
      work.mesh.points[hex.first_node + static_cast<Index>(s)] += sum;
    }
  });
}

}  // namespace

void place(const Mesh& old_mesh, const Association& old_association, const Split& split, const Model& model, Mesh& mesh,
           Association& association) {
  const Lineage& lineage = split.lineage;
  Work work{old_mesh,
            old_association,
            split,
            lineage,
            *lineage.table,
            model,
            mesh,
            association,
            new_nodes_on_cad(association, lineage.n_old_nodes),
            {},
            std::vector<std::uint8_t>(lineage.edges.size(), 0)};
  work.moved.resize(work.on_cad.size(), Vec3::Zero());
  const RimParameters parameters_of(work);
  place_on_curves(work);
  place_edges_on_surfaces(work, parameters_of);
  parallel_each(lineage.edges.size(), [&](std::size_t i) {
    const std::size_t n = work.table.edge[lineage.edges[i].code].at.size();
    for (std::size_t s = 0; s < n; ++s)
      work.edge_moved[i] |= !work.displacement(lineage.edges[i].first_node + static_cast<Index>(s)).isZero(0);
  });
  place_faces_on_surfaces(work, parameters_of);
  place_inner_faces(work);
  place_inside_hexes(work);
}

}  // namespace hextwist
