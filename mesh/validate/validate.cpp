#include "hextwist/mesh/validate/validate.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>
#include <tuple>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/base/text.h"
#include "hextwist/base/union_find.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/loose_topology.h"
#include "hextwist/mesh/others.h"
#include "hextwist/mesh/quality/validity.h"
#include "hextwist/mesh/validate/validate_parts.h"

namespace hextwist {
namespace {

/// "hex 3", "hexes 3 and 5", "hexes 1, 2, 3, 4, 5 and 20 more".
template <class Id>
std::string list_ids(const char* one, const char* many, const std::vector<Index>& items, Id id) {
  constexpr std::size_t max_shown = 6;
  std::string text = items.size() == 1 ? one : many;
  const std::size_t n = items.size(), shown = n > max_shown ? max_shown - 1 : n;
  for (std::size_t i = 0; i < shown; ++i)
    text += (i == 0 ? " " : i + 1 == n ? " and " : ", ") + std::to_string(id(items[i]));
  if (shown < n) text += " and " + std::to_string(n - shown) + " more";
  return text;
}

class Report {
 public:
  Report(const Mesh& mesh, std::vector<Violation>& found) : mesh_(mesh), found_(found) {}

  std::string hexes(const std::vector<Index>& list) const {
    return list_ids("hex", "hexes", list, [&](Index h) { return hex_id(mesh_, h); });
  }
  std::string nodes(const std::vector<Index>& list) const {
    return list_ids("node", "nodes", list, [&](Index n) { return node_id(mesh_, n); });
  }
  void add(ViolationKind kind, std::vector<Index> hexes, std::vector<Index> nodes, std::string text) {
    found_.push_back({kind, std::move(hexes), std::move(nodes), std::move(text)});
  }

 private:
  const Mesh& mesh_;
  std::vector<Violation>& found_;
};

/// The mesh without some of its hexes. Only points and hexes; the mesh itself, not a copy, while none is left out.
struct Part {
  const Mesh* mesh;
  Mesh copy;
  std::vector<Index> original;  ///< per hex; empty: the same

  explicit Part(const Mesh& whole) : mesh(&whole) {}
  Part(const Part&) = delete;
  Part& operator=(const Part&) = delete;

  Index original_of(Index hex) const { return original.empty() ? hex : original[hex]; }
  std::vector<Index> originals_of(std::vector<Index> hexes) const {
    for (Index& h : hexes) h = original_of(h);
    return hexes;
  }
  /// Leaves out hexes, ascending.
  void drop(const std::vector<Index>& hexes) {
    if (hexes.empty()) return;
    std::vector<Hex> kept;
    std::vector<Index> kept_original;
    for (Index h = 0; h < mesh->n_hexes(); ++h)
      if (!std::ranges::binary_search(hexes, h)) {
        kept.push_back(mesh->hexes[h]);
        kept_original.push_back(original_of(h));
      }
    if (mesh != &copy) copy.points = mesh->points;
    mesh = &copy;
    copy.hexes = std::move(kept);
    original = std::move(kept_original);
  }
};

std::vector<Index> sorted_nodes(const Quad& quad) {
  return sorted_unique(std::vector(quad.begin(), quad.end()));
}

std::vector<Index> find_bad_indices(const Mesh& mesh, Report& report) {
  const auto missing = [&](Index node) { return node < 0 || node >= mesh.n_nodes(); };
  auto bad = indices_where(mesh.n_hexes(), [&](Index h) { return std::ranges::any_of(mesh.hexes[h], missing); });
  for (const Index h : bad) {
    const auto n = std::ranges::count_if(mesh.hexes[h], missing);
    report.add(ViolationKind::bad_index, {h}, {},
               report.hexes({h}) + " names " +
                   (n == 1 ? "a node that does not exist" : std::to_string(n) + " nodes that do not exist"));
  }
  return bad;
}

std::vector<char> find_not_finite(const Mesh& mesh, Report& report) {
  std::vector<char> bad(mesh.points.size(), 0);
  for (const Index n : indices_where(mesh.n_nodes(), [&](Index i) { return !mesh.points[i].allFinite(); })) {
    bad[n] = 1;
    report.add(ViolationKind::not_finite, {}, {n}, report.nodes({n}) + " has a coordinate that is not finite");
  }
  return bad;
}

std::vector<Index> find_repeated_nodes(const Mesh& mesh, Report& report) {
  auto bad = indices_where(mesh.n_hexes(), [&](Index h) {
    const Hex& hex = mesh.hexes[h];
    bool twice = false;
    for (int i = 0; i < 8; ++i)
      for (int j = 0; j < i; ++j) twice |= hex[i] == hex[j];
    return twice;
  });
  for (const Index h : bad) {
    std::vector<Index> repeated;
    for (const Index node : mesh.hexes[h])
      if (node >= 0 && node < mesh.n_nodes() && std::ranges::count(mesh.hexes[h], node) > 1) repeated.push_back(node);
    repeated = sorted_unique(repeated);
    if (repeated.empty()) continue;  // what it repeats does not exist: told already
    report.add(ViolationKind::repeated_node, {h}, repeated,
               report.hexes({h}) + " names " + report.nodes(repeated) + " more than once");
  }
  return bad;
}

/// Returns all but the first of each group, as indices of the part.
std::vector<Index> find_duplicate_hexes(const Part& part, const CompressedRows& corners, Report& report) {
  const Mesh& mesh = *part.mesh;
  std::vector<Index> first_copy(mesh.hexes.size(), -1);  // of hexes that have an earlier copy
  parallel_ranges(mesh.n_nodes(), [&](Index begin, Index end) {
    std::vector<std::pair<Hex, Index>> own;
    for (Index node = begin; node < end; ++node) {
      own.clear();
      for (const Index corner : corners[node])
        if (std::ranges::min(mesh.hexes[corner >> 3]) == node) own.emplace_back(mesh.hexes[corner >> 3], corner >> 3);
      if (own.size() < 2) continue;
      for (auto& [hex, h] : own) std::ranges::sort(hex);
      std::ranges::sort(own);
      for (std::size_t i = 1, first = 0; i < own.size(); ++i)
        if (own[i].first == own[first].first)
          first_copy[own[i].second] = own[first].second;
        else
          first = i;
    }
  });
  auto copies = indices_where(mesh.n_hexes(), [&](Index h) { return first_copy[h] >= 0; });
  std::map<Index, std::vector<Index>> groups;
  for (const Index h : copies) groups[first_copy[h]].push_back(part.original_of(h));
  for (auto& [first, group] : groups) {
    group.insert(group.begin(), part.original_of(first));
    const Hex& hex = mesh.hexes[first];
    const std::string text = report.hexes(group) + " are on the same eight nodes";
    report.add(ViolationKind::duplicate_hex, std::move(group), sorted_unique(std::vector(hex.begin(), hex.end())),
               text);
  }
  return copies;
}

void find_duplicate_nodes(const Mesh& mesh, double relative_tolerance, Report& report) {
  if (!(relative_tolerance > 0)) return;
  Box size;
  for (const Vec3& p : mesh.points)
    if (p.allFinite()) size.add(p);
  for (auto& group : near_points(mesh.points, relative_tolerance * size.diagonal())) {
    const std::string text = report.nodes(group) + " are at the same place";
    report.add(ViolationKind::duplicate_node, {}, std::move(group), text);
  }
}

void find_unused_nodes(const Mesh& mesh, Report& report) {
  std::vector<char> used(mesh.points.size(), 0);
  for (const Hex& hex : mesh.hexes)
    for (const Index node : hex)
      if (node >= 0 && node < mesh.n_nodes()) used[node] = 1;
  if (mesh.others)
    for (const Index node : mesh.others->nodes) used[node] = 1;
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    if (!used[n]) report.add(ViolationKind::unused_node, {}, {n}, report.nodes({n}) + " belongs to no hex");
}

std::vector<Index> hexes_at(const CompressedRows& corners, Index node) {
  std::vector<Index> hexes;
  for (const Index corner : corners[node]) hexes.push_back(corner >> 3);
  return hexes;
}
std::vector<Index> hexes_at(const CompressedRows& corners, const Edge& edge) {
  return intersection(hexes_at(corners, edge[0]), hexes_at(corners, edge[1]));
}

void find_hanging_nodes(const Part& part, const CompressedRows& corners, std::span<const Side> skin, Report& report) {
  const auto all = hanging_nodes(*part.mesh, skin);
  std::vector<std::span<const HangingNode>> of_node;
  for (std::size_t begin = 0, end; begin < all.size(); begin = end) {
    for (end = begin; end < all.size() && all[end].node == all[begin].node; ++end) {
    }
    of_node.push_back(std::span(all).subspan(begin, end - begin));
  }
  for (const bool is_joined : {true, false})
    for (const auto& places : of_node) {
      if (std::ranges::any_of(places, &HangingNode::is_joined) != is_joined) continue;
      std::vector<Index> hexes;
      bool on_edge = false;
      for (const HangingNode& place : places) {
        if (place.is_joined != is_joined) continue;
        on_edge |= place.edge[0] >= 0;
        // All around the edge, also those whose faces there are no skin.
        if (place.edge[0] >= 0)
          for (const Index h : hexes_at(corners, place.edge)) hexes.push_back(h);
        else
          hexes.push_back(place.hex);
      }
      hexes = part.originals_of(sorted_unique(std::move(hexes)));
      const Index node = places[0].node;
      std::string text = report.nodes({node}) + " lies inside " + (on_edge ? "an edge" : "a face") + " of " +
                         report.hexes(hexes) +
                         (is_joined ? " and is not a corner there" : ", which it is not joined to there");
      report.add(is_joined ? ViolationKind::hanging_node : ViolationKind::touching_part, std::move(hexes), {node},
                 std::move(text));
    }
}

void find_crowded_faces(const Part& part, const LooseFaces& loose, Report& report) {
  for (std::size_t begin = 0, end; begin < loose.more.size(); begin = end) {
    const Index face = loose.more[begin].first;
    std::vector<Index> hexes;
    for (const Side& side : loose.faces.sides[face]) hexes.push_back(part.original_of(side.hex));
    for (end = begin; end < loose.more.size() && loose.more[end].first == face; ++end)
      hexes.push_back(part.original_of(loose.more[end].second.hex));
    hexes = sorted_unique(hexes);
    const auto nodes = sorted_nodes(loose.faces.nodes[face]);
    const std::string text = report.hexes(hexes) + " share the face of " + report.nodes(nodes) + ": at most two can";
    report.add(ViolationKind::crowded_face, std::move(hexes), nodes, text);
  }
}

void find_folded_faces(const Part& part, const Faces& faces, Report& report) {
  const Mesh& mesh = *part.mesh;
  struct Folded {
    std::vector<Index> hexes, nodes;
    bool twisted;
  };
  std::vector<Folded> found;
  const auto pair = [&](Side a, Side b, bool twisted) {
    found.push_back({sorted_unique(std::vector{part.original_of(a.hex), part.original_of(b.hex)}),
                     sorted_nodes(face_nodes(mesh.hexes[a.hex], a.face)), twisted});
  };
  // Turning alike is in order when one of the two is mirrored: that one is inverted.
  for (const Index face : indices_where(static_cast<Index>(faces.nodes.size()), [&](Index i) {
         const auto& [a, b] = faces.sides[i];
         return b.hex >= 0 && turn_alike(mesh.hexes[a.hex], a.face, mesh.hexes[b.hex], b.face) &&
                (volume(mesh, a.hex) < 0) == (volume(mesh, b.hex) < 0);
       }))
    pair(faces.sides[face][0], faces.sides[face][1], false);
  // The same four nodes in another order are another face, with the same lowest node. Few buckets have two faces with
  // the same sum of nodes; long ones are looked into at once.
  const auto sum = [&](Index face) {
    return std::accumulate(faces.nodes[face].begin(), faces.nodes[face].end(), std::int64_t{0});
  };
  for (const Index node : indices_where(mesh.n_nodes(), [&](Index n) {
         const Index begin = faces.first_of_node[n], end = faces.first_of_node[n + 1];
         bool any = end - begin > 32;
         for (Index i = begin; i < end && !any; ++i)
           for (Index j = begin; j < i && !any; ++j) any = sum(i) == sum(j);
         return any;
       })) {
    std::vector<std::pair<Quad, Index>> quads;
    for (Index face = faces.first_of_node[node]; face < faces.first_of_node[node + 1]; ++face) {
      quads.emplace_back(faces.nodes[face], face);
      std::ranges::sort(quads.back().first);
    }
    std::ranges::sort(quads);
    for (std::size_t i = 1; i < quads.size(); ++i)
      if (quads[i].first == quads[i - 1].first)
        pair(faces.sides[quads[i - 1].second][0], faces.sides[quads[i].second][0], true);
  }
  std::ranges::sort(found, {}, [](const Folded& f) { return std::tie(f.hexes, f.nodes); });
  for (const auto& [hexes, nodes, twisted] : found)
    report.add(
        ViolationKind::folded_face, hexes, nodes,
        report.hexes(hexes) + (twisted ? " join the four " + report.nodes(nodes) + " of a face in different order"
                                       : " lie on the same side of their face of " + report.nodes(nodes)));
}

/// Groups of hexes around a node that are joined to each other through faces at the node.
int n_groups_around(const Mesh& mesh, std::span<const Index> corners) {
  struct FaceAt {
    Index diagonal, low, high, place;  // the other nodes of the face; place in corners
    auto key() const { return std::tie(diagonal, low, high); }
  };
  std::vector<FaceAt> at_face;  // three per hex
  const auto n = static_cast<Index>(corners.size());
  for (Index i = 0; i < n; ++i)
    for (int axis = 0; axis < 3; ++axis) {
      const Hex& hex = mesh.hexes[corners[i] >> 3];
      const int c = corners[i] & 7, u = 1 << (axis == 0), v = axis == 2 ? 2 : 4;
      const auto [low, high] = std::minmax(hex[c ^ u], hex[c ^ v]);
      at_face.push_back({hex[c ^ u ^ v], low, high, i});
    }
  std::ranges::sort(at_face, {}, [](const FaceAt& f) { return std::tie(f.diagonal, f.low, f.high, f.place); });
  std::vector<Index> group = singletons(n);
  for (std::size_t i = 1; i < at_face.size(); ++i)
    if (at_face[i].key() == at_face[i - 1].key()) join(group, at_face[i].place, at_face[i - 1].place);
  int n_groups = 0;
  for (Index i = 0; i < n; ++i) n_groups += group[i] == i;
  return n_groups;
}

void find_torn_edges(const Part& part, const CompressedRows& corners, std::span<const Side> skin, Report& report) {
  const Mesh& mesh = *part.mesh;
  // Hexes around an edge form fans between two quads of the skin each.
  std::vector<std::array<Index, 2>> rims(4 * skin.size());
  parallel_ranges(static_cast<Index>(skin.size()), [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      const auto cycle = face_node_cycle(mesh.hexes[skin[i].hex], skin[i].face);
      for (int k = 0; k < 4; ++k) {
        const auto [a, b] = std::minmax(cycle[k], cycle[(k + 1) & 3]);
        rims[4 * static_cast<std::size_t>(i) + k] = {a, b};
      }
    }
  });
  tbb::parallel_sort(rims.begin(), rims.end());
  std::vector<char> torn(mesh.points.size(), 0);
  for (std::size_t begin = 0, end; begin < rims.size(); begin = end) {
    for (end = begin; end < rims.size() && rims[end] == rims[begin]; ++end) {
    }
    if (end - begin <= 2) continue;
    const auto [a, b] = rims[begin];
    torn[a] = torn[b] = 1;
    std::vector<Index> hexes = part.originals_of(hexes_at(corners, {a, b}));
    const std::string text = report.hexes(hexes) + " meet at the edge of " + report.nodes({a, b}) + " in " +
                             std::to_string((end - begin) / 2) + " groups that share no face there";
    report.add(ViolationKind::torn_edge, std::move(hexes), {a, b}, text);
  }
  // Nodes not at such an edge.
  std::vector<char> on_skin(mesh.points.size(), 0);
  for (const auto& [a, b] : rims) on_skin[a] = on_skin[b] = 1;
  for (const Index node : indices_where(
           mesh.n_nodes(), [&](Index n) { return on_skin[n] && !torn[n] && n_groups_around(mesh, corners[n]) > 1; })) {
    std::vector<Index> hexes = part.originals_of(hexes_at(corners, node));
    const std::string text = report.hexes(hexes) + " meet at " + report.nodes({node}) + " in " +
                             std::to_string(n_groups_around(mesh, corners[node])) + " groups that share no face there";
    report.add(ViolationKind::torn_edge, std::move(hexes), {node}, text);
  }
}

std::string fault_text(const HexVerdict& verdict) {
  const std::string value = short_number(verdict.value, 6);
  switch (verdict.fault) {
    case HexFault::none:
      break;
    case HexFault::corner:
      return (verdict.value == 0 ? " is flat" : " is inverted") + (": its smallest corner Jacobian is " + value);
    case HexFault::inside:
      return " is inverted inside: its Jacobian is positive at the corners, but " + value + " at " +
             point_text(verdict.at, 3) + " of the unit cube";
    case HexFault::flat:
      return " is flat but for rounding: its scaled Jacobian is " + value;
  }
  return "";
}

void find_inverted(const Part& part, const std::vector<char>& not_finite, Report& report) {
  const Mesh& mesh = *part.mesh;
  for (const Index h : inverted_hexes(mesh)) {
    if (std::ranges::any_of(mesh.hexes[h], [&](Index node) { return not_finite[node]; })) continue;
    const Index original = part.original_of(h);
    report.add(ViolationKind::inverted, {original}, {}, report.hexes({original}) + fault_text(judge(mesh, h)));
  }
}

}  // namespace

const char* name(ViolationKind kind) {
  switch (kind) {
    case ViolationKind::bad_index:
      return "bad index";
    case ViolationKind::not_finite:
      return "not finite";
    case ViolationKind::repeated_node:
      return "repeated node";
    case ViolationKind::duplicate_hex:
      return "duplicate hex";
    case ViolationKind::duplicate_node:
      return "duplicate node";
    case ViolationKind::unused_node:
      return "unused node";
    case ViolationKind::hanging_node:
      return "hanging node";
    case ViolationKind::touching_part:
      return "touching part";
    case ViolationKind::crowded_face:
      return "crowded face";
    case ViolationKind::folded_face:
      return "folded face";
    case ViolationKind::torn_edge:
      return "torn edge";
    case ViolationKind::inverted:
      return "inverted";
    case ViolationKind::flattened:
      return "flattened";
    case ViolationKind::off_model:
      return "off model";
  }
  return "";
}

bool is_warning(ViolationKind kind) {
  return kind == ViolationKind::duplicate_node || kind == ViolationKind::unused_node ||
         kind == ViolationKind::touching_part || kind == ViolationKind::torn_edge;
}

std::vector<Violation> validate(const Mesh& mesh, const ValidateOptions& options) {
  std::vector<Violation> found;
  Report report(mesh, found);
  SoundTopology topology;
  if (std::vector<Side> skin; options.faces ? is_sound_without_skin(mesh, skin, topology)
                                            : is_sound_without_skin(mesh, skin)) {  // most are: only warnings are left
    const Part whole(mesh);
    const CompressedRows corners = options.faces ? std::move(topology.corners) : node_corners(mesh);
    find_duplicate_nodes(mesh, options.relative_tolerance, report);
    find_unused_nodes(mesh, report);
    find_hanging_nodes(whole, corners, skin, report);
    find_torn_edges(whole, corners, skin, report);
    if (options.faces && std::ranges::all_of(found, is_warning, &Violation::kind))
      *options.faces = std::move(topology.faces);
    return found;
  }
  std::vector<Index> unsound = find_bad_indices(mesh, report);
  const std::vector<char> not_finite = find_not_finite(mesh, report);
  const std::vector<Index> repeated = find_repeated_nodes(mesh, report);
  unsound.insert(unsound.end(), repeated.begin(), repeated.end());

  Part part(mesh);
  part.drop(sorted_unique(unsound));
  CompressedRows corners = node_corners(*part.mesh);
  if (const auto copies = find_duplicate_hexes(part, corners, report); !copies.empty()) {
    part.drop(copies);
    corners = node_corners(*part.mesh);
  }
  find_duplicate_nodes(mesh, options.relative_tolerance, report);
  find_unused_nodes(mesh, report);
  const LooseFaces loose = loose_faces(*part.mesh, corners);
  const std::vector<Side> skin = boundary_sides(loose.faces);
  find_hanging_nodes(part, corners, skin, report);
  find_crowded_faces(part, loose, report);
  find_folded_faces(part, loose.faces, report);
  find_torn_edges(part, corners, skin, report);
  find_inverted(part, not_finite, report);
  return found;
}

}  // namespace hextwist
