// Which way curves run and what bounds what, in the order and with the signs that Gmsh gives them.
//
// Gmsh places the middle nodes of second-order elements by the parameters of a curve. At the ends of closed curves and
// at seams it learns the parameter from the direction of a line element and from which bounding point comes first.
#include <map>

#include "hextwist/base/sorted.h"
#include "hextwist/io/gmsh/plan_internal.h"
#include "hextwist/mesh/corners.h"

namespace hextwist::io {
namespace {

class Directions {
 public:
  Directions(const Mesh& mesh, const Association& association, const Model* model)
      : mesh_(mesh), tags_(association), model_(model) {
    result_.reversed.assign(tags_.curve_edges.size(), 0);
  }

  CurveDirections result() {
    std::vector<std::pair<int, Index>> by_curve;
    for (std::size_t i = 0; i < tags_.edge_curve.size(); ++i)
      by_curve.emplace_back(tags_.edge_curve[i], static_cast<Index>(i));
    std::ranges::sort(by_curve);
    for (std::size_t i = 0, end = 0; i < by_curve.size(); i = end) {
      while (end < by_curve.size() && by_curve[end].first == by_curve[i].first) ++end;
      curve(by_curve[i].first, std::span(by_curve).subspan(i, end - i));
    }
    return std::move(result_);
  }

 private:
  /// An edge in a chain, from its first node or from its second.
  struct Step {
    Index edge;
    bool backwards;
  };
  Index start(Step step) const { return tags_.curve_edges[step.edge][step.backwards]; }
  Index end(Step step) const { return tags_.curve_edges[step.edge][!step.backwards]; }

  void curve(int id, std::span<const std::pair<int, Index>> edges) {
    std::vector<std::pair<Index, Index>> around;  // node, edge
    for (const auto& [unused, edge] : edges)
      for (const Index node : tags_.curve_edges[edge]) around.emplace_back(node, edge);
    std::ranges::sort(around);
    const auto at = [&](Index node) {
      const auto [first, last] = std::ranges::equal_range(around, node, {}, &std::pair<Index, Index>::first);
      return std::span(first, last);
    };
    std::vector<char> used(edges.size(), 0);
    const auto position = [&](Index edge) {
      return std::ranges::lower_bound(edges, edge, {}, &std::pair<int, Index>::second) - edges.begin();
    };
    // From ends and vertices first, then what is closed without one.
    std::vector<Step> chain;
    int n_chains = 0;
    for (const bool anywhere : {false, true})
      for (std::size_t k = 0; k < around.size(); ++k) {
        const auto [node, edge] = around[k];
        if (!anywhere && at(node).size() == 2 && owner(tags_, node).dim != 0) continue;
        if (used[position(edge)]) continue;
        chain.clear();
        for (Index from = node, next = edge; next >= 0;) {
          used[position(next)] = 1;
          chain.push_back({next, tags_.curve_edges[next][0] != from});
          from = end(chain.back());
          next = -1;
          if (at(from).size() == 2 && owner(tags_, from).dim != 0)
            for (const auto& [unused, other] : at(from))
              if (!used[position(other)]) next = other;
        }
        if (votes(id, chain) < 0) {
          std::ranges::reverse(chain);
          for (Step& step : chain) step.backwards = !step.backwards;
        }
        for (const Step step : chain) result_.reversed[step.edge] = step.backwards;
        ++n_chains;
        const Owner first = owner(tags_, start(chain.front())), last = owner(tags_, end(chain.back()));
        if (first.dim == 0 && last.dim == 0) result_.ends[id] = {first.id, last.id};
      }
    if (n_chains != 1) result_.ends.erase(id);
  }

  /// More than 0 if the chain runs as the curve does, less if against it.
  double votes(int id, const std::vector<Step>& chain) const {
    double sum = 0;
    if (model_ && id <= model_->count(1)) {
      for (const std::size_t k : {chain.size() / 2, chain.size() / 6, chain.size() * 5 / 6}) {
        const Vec3 a = mesh_.points[start(chain[k])], b = mesh_.points[end(chain[k])];
        const Projection middle = model_->project({1, id}, (a + b) / 2);
        sum += (b - a).normalized().dot(model_->tangent(id, middle.parameters.u));
      }
      return sum;
    }
    // Without a model, by parameters of nodes that have them; once around it jumps.
    for (const Step step : chain) {
      const Index a = start(step), b = end(step);
      if (owner(tags_, a) != Owner{1, id} || owner(tags_, b) != Owner{1, id} || tags_.node_parameters.empty()) continue;
      const double from = tags_.node_parameters[a].u, to = tags_.node_parameters[b].u;
      sum += from < to ? 1 : from > to ? -1 : 0;
    }
    return sum;
  }

  const Mesh& mesh_;
  const Association& tags_;
  const Model* model_;
  CurveDirections result_;
};

}  // namespace

CurveDirections curve_directions(const Mesh& mesh, const Association& association, const Model* model) {
  return Directions(mesh, association, model).result();
}

void SurfaceLoops::add(int surface, const Quad& cycle) {
  // Parameters of the surface say which way its loops run; the quads look out of the lower volume.
  double area = 0;
  for (int c = 0; c < 4 && !tags_.node_parameters.empty(); ++c) {
    const Index a = cycle[c], b = cycle[(c + 1) % 4];
    if (owner(tags_, a) != Owner{2, surface} || owner(tags_, b) != Owner{2, surface}) {
      area = 0;
      break;
    }
    const Parameters p = tags_.node_parameters[a], q = tags_.node_parameters[b];
    area += p.u * q.v - q.u * p.v;
  }
  turns_[surface] += area > 0 ? 1 : area < 0 ? -1 : 0;  // NaN: neither
  for (int c = 0; c < 4; ++c) {
    const auto [a, b] = std::minmax(cycle[c], cycle[(c + 1) % 4]);
    const Index at = position_in(tags_.curve_edges, Edge{a, b});
    if (at < 0) continue;
    const bool forward = (cycle[c] == a) != static_cast<bool>(directions_.reversed[at]);
    auto& curves = curves_[surface];
    const int curve = forward ? tags_.edge_curve[at] : -tags_.edge_curve[at];
    if (std::ranges::find(curves, curve) == curves.end()) curves.push_back(curve);
  }
}

std::vector<int> SurfaceLoops::of(int surface) const {
  const auto found = curves_.find(surface);
  if (found == curves_.end()) return {};
  std::vector<int> left = found->second, result;
  if (turns_.at(surface) < 0)
    for (int& curve : left) curve = -curve;
  std::ranges::sort(left, {}, [](int curve) { return std::pair(std::abs(curve), curve < 0); });
  // Each begins where the one before ends, as far as that goes.
  const auto vertex = [&](int curve, bool last) {
    const auto ends = directions_.ends.find(std::abs(curve));
    return ends == directions_.ends.end() ? 0 : ends->second[last == (curve > 0)];
  };
  while (!left.empty()) {
    auto next = left.begin();
    if (!result.empty()) {
      const int from = vertex(result.back(), true);
      const auto follows =
          std::ranges::find_if(left, [&](int curve) { return from > 0 && vertex(curve, false) == from; });
      if (follows != left.end()) next = follows;
    }
    result.push_back(*next);
    left.erase(next);
  }
  return result;
}

}  // namespace hextwist::io
