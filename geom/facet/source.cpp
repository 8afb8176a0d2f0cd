// What a skin was made of, and the same skin again.
#include <algorithm>

#include "hextwist/geom/facet/source_internal.h"

namespace hextwist {
namespace {

/// Lists of node positions as those among the nodes of the skin; what names others is left out.
class OnSkin {
 public:
  OnSkin(std::size_t n_nodes, std::span<const std::array<std::int32_t, 4>> quads) : place_(n_nodes, -1) {
    for (const auto& quad : quads)
      for (const std::int32_t n : quad) place_[n] = 0;
    for (std::size_t n = 0; n < n_nodes; ++n)
      if (place_[n] == 0) {
        place_[n] = static_cast<std::int32_t>(nodes_.size());
        nodes_.push_back(static_cast<std::int32_t>(n));
      }
  }
  const std::vector<std::int32_t>& nodes() const { return nodes_; }

  template <std::size_t n>
  bool renamed(std::array<std::int32_t, n>& item) const {
    for (std::int32_t& node : item) node = place_[node];
    return std::ranges::min(item) >= 0;
  }
  template <class Item, class Value>
  void keep(std::span<const Item> items, std::span<const Value> values, std::vector<Item>& to,
            std::vector<Value>& to_values) const {
    for (std::size_t i = 0; i < items.size(); ++i)
      if (Item item = items[i]; renamed(item)) {
        to.push_back(item);
        to_values.push_back(values[i]);
      }
  }

 private:
  std::vector<std::int32_t> place_, nodes_;
};

}  // namespace

FacetSource source_of(std::span<const Vec3> points, std::span<const std::array<std::int32_t, 4>> quads,
                      std::span<const std::array<int, 2>> quad_volumes, const FacetModelOptions& options) {
  const OnSkin skin(points.size(), quads);
  FacetSource source;
  for (const std::int32_t n : skin.nodes()) source.points.push_back(points[n]);
  source.quads.assign(quads.begin(), quads.end());
  for (auto& quad : source.quads) skin.renamed(quad);
  source.quad_volumes.assign(quad_volumes.begin(), quad_volumes.end());
  source.feature_angle = options.feature_angle;
  if (const FacetLabels* labels = options.labels) {
    source.has_labels = true;
    source.quad_labels.assign(labels->quads.begin(), labels->quads.end());
    skin.keep(labels->edges, labels->edge_labels, source.labelled_edges, source.edge_labels);
    for (const std::int32_t node : labels->vertices)
      if (std::array<std::int32_t, 1> one = {node}; skin.renamed(one)) source.labelled_vertices.push_back(one[0]);
  }
  if (const FacetMiddles* middles = options.middles) {
    source.has_middles = true;
    skin.keep(middles->edges, middles->edge_points, source.middle_edges, source.edge_points);
    skin.keep(middles->faces, middles->face_points, source.middle_faces, source.face_points);
  }
  return source;
}

namespace {

bool fits(const FacetSource& source) {
  const auto known = [&](const auto& items) {
    return std::ranges::all_of(items, [&](const auto& item) {
      return std::ranges::all_of(
          item, [&](std::int32_t n) { return n >= 0 && static_cast<std::size_t>(n) < source.points.size(); });
    });
  };
  int n_volumes = 0;
  for (const auto& volumes : source.quad_volumes) {
    if (volumes[0] < 1 || volumes[1] < 0) return false;
    n_volumes = std::max({n_volumes, volumes[0], volumes[1]});
  }
  return source.quads.size() == source.quad_volumes.size() && known(source.quads) && !source.quads.empty() &&
         static_cast<std::size_t>(n_volumes) <= source.quads.size() &&
         (!source.has_labels || source.quad_labels.size() == source.quads.size()) &&
         source.labelled_edges.size() == source.edge_labels.size() && known(source.labelled_edges) &&
         std::ranges::is_sorted(source.labelled_edges) &&
         known(std::vector<std::vector<std::int32_t>>{source.labelled_vertices}) &&
         std::ranges::is_sorted(source.labelled_vertices) && source.middle_edges.size() == source.edge_points.size() &&
         known(source.middle_edges) && std::ranges::is_sorted(source.middle_edges) &&
         source.middle_faces.size() == source.face_points.size() && known(source.middle_faces) &&
         std::ranges::is_sorted(source.middle_faces) &&
         std::ranges::all_of(source.points, [](const Vec3& p) { return p.allFinite(); }) &&
         std::ranges::all_of(source.edge_points, [](const Vec3& p) { return p.allFinite(); }) &&
         std::ranges::all_of(source.face_points, [](const Vec3& p) { return p.allFinite(); });
}

}  // namespace

const FacetSource* facet_source(const Model& model) {
  const auto* known = dynamic_cast<const KnowsSource*>(&model);
  return known ? known->source.get() : nullptr;
}

FacetImport facet_model(const FacetSource& source) {
  if (!fits(source)) throw Error("the skin has numbers that cannot be");
  const FacetLabels labels{source.quad_labels, source.labelled_edges, source.edge_labels, source.labelled_vertices};
  const FacetMiddles middles{source.middle_edges, source.edge_points, source.middle_faces, source.face_points};
  return facet_model(source.points, source.quads, source.quad_volumes,
                     {.feature_angle = source.feature_angle,
                      .labels = source.has_labels ? &labels : nullptr,
                      .middles = source.has_middles ? &middles : nullptr});
}

}  // namespace hextwist
