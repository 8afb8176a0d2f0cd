// Directional refinement: edges of chosen sheets, of the columns behind a surface, or of layers along it are cut; the
// other directions stay as they are.
#include <algorithm>
#include <cmath>
#include <limits>

#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/sheets.h"
#include "hextwist/refine/templates/trisect.h"
#include "hextwist/sizing/targets.h"
#include "hextwist/sizing/techniques/techniques_internal.h"

namespace hextwist {
namespace {

/// Marked edges in three. With Concave::fill a direction that is concave in a hex is cut whole, and so on.
Cut cut_edges(State& state, const Edges& edges, std::vector<std::uint8_t>& cut) {
  const Mesh& mesh = state.mesh();
  std::vector<std::uint16_t> codes(mesh.hexes.size(), 0);
  const auto code = [&](Index h) {
    int mask = 0;
    for (int e = 0; e < n_hex_edges; ++e) mask |= (cut[edges.of_hex[h][e]] != 0) << e;
    return mask;
  };
  bool changed = state.request.concave == Concave::fill;
  while (changed) {
    changed = false;
    for (Index h = 0; h < mesh.n_hexes(); ++h) {
      const int mask = code(h);
      for (int axis = 0; axis < 3; ++axis) {
        const int four = mask >> 4 * axis & 15;
        if (!is_concave_in_a_direction(four << 4 * axis) || four == 15) continue;
        for (int k = 0; k < 4; ++k) cut[edges.of_hex[h][4 * axis + k]] = 1;
        ++state.report.filled_hexes;
        changed = true;
      }
    }
  }
  for (Index h = 0; h < mesh.n_hexes(); ++h) codes[h] = static_cast<std::uint16_t>(code(h));
  return {trisect_table(), std::move(codes)};
}

double length_of(const Mesh& mesh, const Edge& edge) {
  return (mesh.points[edge[1]] - mesh.points[edge[0]]).norm();
}

/// Edges that leave the faces into the hexes behind them, and on from hex to hex to the other side of the mesh.
std::vector<std::uint8_t> edges_behind(const Mesh& mesh, const Edges& edges, const Faces& all,
                                       const CombinationTarget& target) {
  std::vector<std::uint8_t> cut(edges.nodes.size(), 0);
  for (const Quad& quad : target.faces) {
    const Index start = find_face(all, quad);
    for (const Side& first : all.sides[start]) {
      // A sheet that crosses itself brings a column back to where it has been: it ends there.
      Side at = first;
      for (Index steps = 0; at.hex >= 0 && steps < mesh.n_hexes(); ++steps) {
        const int axis = at.face >> 1;
        for (int k = 0; k < 4; ++k) cut[edges.of_hex[at.hex][4 * axis + k]] = 1;
        const Index opposite = all.of_hex[at.hex][at.face ^ 1];
        if (opposite == start) break;
        const auto& sides = all.sides[opposite];
        at = sides[0].hex == at.hex && sides[0].face == (at.face ^ 1) ? sides[1] : sides[0];
      }
    }
  }
  return cut;
}

/// Whether the faces are the whole skin of the mesh.
bool is_whole_skin(const Faces& all, const CombinationTarget& target) {
  std::vector<std::uint8_t> is_target(all.nodes.size(), 0);
  for (const Quad& quad : target.faces) is_target[find_face(all, quad)] = 1;
  for (std::size_t f = 0; f < all.nodes.size(); ++f)
    if (all.sides[f][1].hex < 0 && !is_target[f]) return false;
  return true;
}

/// Then no side is left for a transition to run out at, which would only make shapes worse: each sheet that is cut
/// anywhere is cut everywhere.
void cut_whole_sheets(const Mesh& mesh, const Edges& edges, std::vector<std::uint8_t>& cut) {
  const Sheets of = sheets(mesh, edges);
  std::vector<std::uint8_t> chosen(of.size(), 0);
  for (std::size_t e = 0; e < cut.size(); ++e) chosen[of.of_edge[e]] |= cut[e];
  for (std::size_t e = 0; e < cut.size(); ++e) cut[e] = chosen[of.of_edge[e]];
}

class AcrossTheSheets : public Technique {
 public:
  std::optional<Cut> next(State& state) override {
    if (is_done_) return std::nullopt;
    is_done_ = true;
    const AcrossSheets& request = std::get<AcrossSheets>(state.request.how);
    const Mesh& mesh = state.mesh();
    state.begin("sheets");
    const Edges all = edges(mesh);
    for (const Index e : request.edges)
      if (e < 0 || e >= static_cast<Index>(all.nodes.size()))
        throw Error("there is no edge " + std::to_string(e + 1) + ": edge ids go from 1 to " +
                    std::to_string(all.nodes.size()));
    const Sheets of = sheets(mesh, all);
    std::vector<std::uint8_t> chosen(of.size(), 0);
    if (!request.crossing) {
      for (const Index e : request.edges) chosen[of.of_edge[e]] = 1;
    } else {
      std::vector<std::uint8_t> wanted(all.nodes.size(), 0), along(of.size(), 0);
      for (const Index e : request.edges) wanted[e] = along[of.of_edge[e]] = 1;
      for (const auto& hex : all.of_hex)
        if (std::ranges::any_of(hex, [&](Index e) { return wanted[e] != 0; }))
          for (const Index e : hex)
            if (!along[of.of_edge[e]]) chosen[of.of_edge[e]] = 1;
    }
    double shortest = std::numeric_limits<double>::infinity();
    for (std::size_t e = 0; e < all.nodes.size(); ++e)
      if (chosen[of.of_edge[e]]) shortest = std::min(shortest, length_of(mesh, all.nodes[e]));
    const double above = std::max(request.greater_than.value_or(0), request.factor.value_or(0) * shortest);
    std::vector<std::uint8_t> cut(all.nodes.size(), 0);
    Index n_cut = 0, n_edges = 0;
    for (std::size_t e = 0; e < cut.size(); ++e) {
      if (!chosen[of.of_edge[e]]) continue;
      ++n_edges;
      cut[e] = length_of(mesh, all.nodes[e]) > above;
      n_cut += cut[e];
    }
    state.note("cut " + std::to_string(n_cut) + " of the " + std::to_string(n_edges) + " edges of " +
               std::to_string(std::ranges::count(chosen, 1)) + " sheets");
    if (n_cut == 0) return std::nullopt;
    return cut_edges(state, all, cut);
  }
  void follow(const Lineage&, const Mesh&, const Mesh&) override {}

 private:
  bool is_done_ = false;
};

class ThroughThickness : public Technique {
 public:
  explicit ThroughThickness(State& state)
      : target_(sub_element_target(state.input, state.request.target, state.report.notices)),
        n_left_(std::get<Thickness>(state.request.how).numsplit) {}

  std::optional<Cut> next(State& state) override {
    if (n_left_-- == 0) return std::nullopt;
    state.begin("close");
    const Edges all = edges(state.mesh());
    const Faces all_faces = faces(state.mesh());
    std::vector<std::uint8_t> cut = edges_behind(state.mesh(), all, all_faces, target_);
    if (is_whole_skin(all_faces, target_)) cut_whole_sheets(state.mesh(), all, cut);
    return cut_edges(state, all, cut);
  }
  void follow(const Lineage& lineage, const Mesh&, const Mesh& after) override {
    target_ = carried_target(target_, lineage, after);
  }

 private:
  CombinationTarget target_;
  int n_left_;
};

class AlongTarget : public Technique {
 public:
  explicit AlongTarget(State& state)
      : target_(sub_element_target(state.input, state.request.target, state.report.notices)),
        growth_(std::get<Layers>(state.request.how).growth),
        n_(std::get<Layers>(state.request.how).n_layers) {}

  /// The outermost layer is cut off first; what remains of the first layer is then divided in the same way.
  std::optional<Cut> next(State& state) override {
    if (n_ <= 1) return std::nullopt;
    state.begin("close");
    double inner = 0, last = 1;
    for (int i = 1; i < n_; ++i) {
      inner += last;
      last *= growth_;
    }
    --n_;
    const Mesh& mesh = state.mesh();
    std::vector<std::uint8_t> marked(mesh.points.size(), 0);
    for (const Index node : target_.nodes) marked[node] = 1;
    if (const Index n_added = close_enclosure(mesh.hexes, marked); n_added > 0)
      state.note("enclosed " + std::to_string(n_added) + " nodes more than the target has, for want of a template");
    return Cut{enclose_table(inner / (inner + last)), enclose_codes(mesh.hexes, marked)};
  }
  void follow(const Lineage& lineage, const Mesh&, const Mesh& after) override {
    target_ = carried_target(target_, lineage, after);
  }

 private:
  CombinationTarget target_;
  double growth_;
  int n_;
};

}  // namespace

std::unique_ptr<Technique> sheets_technique(State&) {
  return std::make_unique<AcrossTheSheets>();
}
std::unique_ptr<Technique> thickness_technique(State& state) {
  return std::make_unique<ThroughThickness>(state);
}
std::unique_ptr<Technique> layers_technique(State& state) {
  return std::make_unique<AlongTarget>(state);
}

}  // namespace hextwist
