// Which lines a Gmsh file has: the edges on curves, and those of groups of lines.
#include <map>
#include <optional>
#include <utility>

#include "hextwist/io/gmsh/others.h"
#include "hextwist/io/gmsh/plan_internal.h"
#include "hextwist/mesh/others.h"
#include "hextwist/mesh/topology.h"

namespace hextwist::io {
namespace {

/// Lines of a set among candidates: those with both ends in it. Empty unless they have all of its nodes.
class Cover {
 public:
  /// Middle nodes, from n_corners on, come with the lines.
  Cover(const Mesh& mesh, const NodeSet& set, Index n_corners) : inside_(mesh.points.size(), 0) {
    for (const Index n : set.nodes)
      if (n < n_corners) inside_[n] = 1, ++n_left_;
  }
  bool has(const Edge& edge) const { return inside_[edge[0]] && inside_[edge[1]]; }
  void add(const Edge& edge) {
    for (const Index n : edge)
      if (std::exchange(inside_[n], 2) == 1) --n_left_;
  }
  bool is_complete() const { return n_left_ == 0; }

 private:
  std::vector<char> inside_;  // 1 in the set, 2 on one of its lines
  std::size_t n_left_ = 0;
};

std::vector<Index> lines_of_whole_curves(const Association& tags, Cover cover) {
  std::map<int, bool> whole;
  for (std::size_t i = 0; i < tags.curve_edges.size(); ++i) {
    const auto at = whole.try_emplace(tags.edge_curve[i], true).first;
    at->second = at->second && cover.has(tags.curve_edges[i]);
  }
  std::vector<Index> lines;
  for (std::size_t i = 0; i < tags.curve_edges.size(); ++i)
    if (whole[tags.edge_curve[i]]) {
      lines.push_back(static_cast<Index>(i));
      cover.add(tags.curve_edges[i]);
    }
  return cover.is_complete() ? lines : std::vector<Index>{};
}

std::vector<Index> lines_on_curves(const Association& tags, Cover cover) {
  std::vector<Index> lines;
  for (std::size_t i = 0; i < tags.curve_edges.size(); ++i)
    if (cover.has(tags.curve_edges[i])) {
      lines.push_back(static_cast<Index>(i));
      cover.add(tags.curve_edges[i]);
    }
  return cover.is_complete() ? lines : std::vector<Index>{};
}

/// More than this many lines per node are no line but a surface or a solid that the set has become since.
constexpr double most_lines_per_node = 1.5;

std::vector<Index> lines_anywhere(const NodeSet& set, const Edges& all, Cover cover, PlannedLines& plan,
                                  std::map<Edge, Index>& line_of) {
  std::vector<Edge> found;
  for (const Edge& edge : all.nodes)
    if (cover.has(edge)) found.push_back(edge);
  for (const Edge& edge : found) cover.add(edge);
  if (!cover.is_complete() ||
      static_cast<double>(found.size()) > most_lines_per_node * static_cast<double>(set.nodes.size()))
    return {};
  std::vector<Index> lines;
  for (const Edge& edge : found) {
    const auto [at, is_new] = line_of.try_emplace(edge, static_cast<Index>(plan.edges.size()));
    if (is_new) {
      plan.edges.push_back(edge);
      plan.curve.push_back(0);
    }
    lines.push_back(at->second);
  }
  return lines;
}

/// Lines beside the hexes that a group has, too.
void add_other_lines(const Mesh& mesh, int group, Cover& cover) {
  if (!mesh.others) return;
  for (Index e = 0; e < mesh.others->size(); ++e) {
    if (mesh.others->type_of(e).shape != OtherShape::line) continue;
    const std::vector<int> groups = gmsh_groups_of(*mesh.others, e);
    if (std::ranges::find(groups, group) == groups.end()) continue;
    const auto nodes = mesh.others->nodes_of(e);
    if (const Edge edge{nodes[0], nodes[1]}; cover.has(edge)) cover.add(edge);
  }
}

}  // namespace

PlannedLines plan_lines(const Mesh& mesh, const Association& association, const FileExtras* extras, Index n_corners) {
  const std::size_t n = mesh.node_sets.size();
  PlannedLines plan{association.curve_edges, association.edge_curve, std::vector<char>(n, 0), {}, {}};
  plan.members.resize(n);
  std::map<Edge, Index> line_of;
  std::optional<Edges> all;
  for (std::size_t s = 0; s < n; ++s) {
    const NodeSet& set = mesh.node_sets[s];
    plan.tag.push_back(group_tag(mesh.node_sets, set));
    const bool was_group = extras && extras->curve_groups.contains(set.id);
    if (set.nodes.empty()) {
      plan.is_group[s] = was_group;
      continue;
    }
    Cover cover(mesh, set, n_corners);
    if (was_group) add_other_lines(mesh, extras->curve_groups.at(set.id), cover);
    std::vector<Index>& lines = plan.members[s];
    lines = lines_of_whole_curves(association, cover);
    if (lines.empty() && was_group) {
      lines = lines_on_curves(association, cover);
      if (lines.empty()) {
        if (!all) {
          all = edges(mesh);
          for (std::size_t i = 0; i < association.curve_edges.size(); ++i)
            line_of.emplace(association.curve_edges[i], static_cast<Index>(i));
        }
        lines = lines_anywhere(set, *all, cover, plan, line_of);
        std::ranges::sort(lines);
      }
    }
    plan.is_group[s] = !lines.empty() || (was_group && cover.is_complete());
  }
  // Tags of the file, where no other group has them: points and curves are numbered apart there.
  for (std::size_t s = 0; s < n; ++s) {
    if (!extras || !plan.is_group[s]) continue;
    const auto was = extras->curve_groups.find(mesh.node_sets[s].id);
    if (was == extras->curve_groups.end()) continue;
    bool is_free = true;
    for (std::size_t other = 0; other < n; ++other)
      is_free = is_free && (other == s || !plan.is_group[other] || plan.tag[other] != was->second);
    if (is_free) plan.tag[s] = was->second;
  }
  return plan;
}

}  // namespace hextwist::io
