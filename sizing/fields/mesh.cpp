// Sizes from a field of a mesh, interpolated.
#include <algorithm>
#include <cmath>
#include <limits>

#include "hextwist/base/parallel.h"
#include "hextwist/base/text.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/locate.h"
#include "hextwist/sizing/fields/gradation.h"
#include "hextwist/sizing/fields/size_field.h"
#include "hextwist/sizing/targets.h"

namespace hextwist {
namespace {

const Field& find_field(const Mesh& mesh, const std::string& name) {
  const auto found = std::ranges::find(mesh.fields, name, &Field::name);
  if (found == mesh.fields.end()) {
    std::string known;
    for (const Field& field : mesh.fields) known += (known.empty() ? "" : ", ") + field.name;
    throw Error("the mesh has no field \"" + name + "\"" + (known.empty() ? "; it has none" : "; it has " + known));
  }
  if (found->components != 1)
    throw Error("field \"" + name + "\" has " + std::to_string(found->components) +
                " components: a size is a single number");
  return *found;
}

class MeshField final : public SizeField {
 public:
  MeshField(std::shared_ptr<const Mesh> mesh, const Field& field)
      : mesh_(std::move(mesh)), field_(field), locator_(*mesh_) {
    const auto& values = field_.values;
    const auto bad = std::ranges::find_if(values, [](double value) { return !(value > 0); });
    if (bad != values.end()) {
      const auto i = static_cast<Index>(bad - values.begin());
      throw Error("field \"" + field_.name + "\" is " + std::to_string(*bad) + " at " +
                  (field_.on == Field::On::node ? "node " + std::to_string(node_id(*mesh_, i))
                                                : "hex " + std::to_string(hex_id(*mesh_, i))) +
                  ": sizes must be positive");
    }
    least_ = values.empty() ? 0 : *std::ranges::min_element(values);
  }

  void evaluate(std::span<const Vec3> points, std::span<double> out) const override {
    if (!jumps()) {
      parallel_each(points.size(), [&](std::size_t i) { out[i] = value(locator_.locate(points[i])); });
      return;
    }
    // Mostly asked at the centroids of these hexes, one after the other, or of pieces of them.
    constexpr Index size = 1024;
    parallel_chunks(static_cast<Index>(points.size()), size, [&](Index, Index begin, Index end) {
      Index last = begin;
      for (Index i = begin; i < end; ++i) {
        if (is_well_inside(last + 1, points[i]))
          ++last;
        else if (!is_well_inside(last, points[i]))
          last = locator_.locate(points[i]).hex;
        out[i] = last < 0 ? std::numeric_limits<double>::infinity() : field_.values[last];
      }
    });
  }
  double least() const override { return least_; }
  bool jumps() const override { return field_.on == Field::On::hex; }

 private:
  /// So that no other hex has the point.
  bool is_well_inside(Index hex, const Vec3& point) const {
    constexpr double margin = 1e-3;
    Vec3 at;
    return hex >= 0 && hex < mesh_->n_hexes() && find_natural_coordinates(corners_of(*mesh_, hex), point, at) &&
           (at.array() > margin).all() && (at.array() < 1 - margin).all();
  }
  /// Of a nodal field.
  double value(const HexPlace& place) const {
    if (place.hex < 0) return std::numeric_limits<double>::infinity();
    double sum = 0;
    for (int c = 0; c < n_hex_corners; ++c) {
      double weight = 1;
      for (int axis = 0; axis < 3; ++axis) weight *= c >> axis & 1 ? place.at[axis] : 1 - place.at[axis];
      sum += weight * field_.values[mesh_->hexes[place.hex][c]];
    }
    return std::max(sum, least_);  // rounding must not go below the values that it lies between
  }

  std::shared_ptr<const Mesh> mesh_;
  const Field& field_;
  HexLocator locator_;
  double least_ = 0;
};

}  // namespace

SizeFieldPtr limited_growth(const Mesh& mesh, const SizeFieldPtr& field, double growth) {
  auto background = std::make_shared<Mesh>();
  background->points = mesh.points;
  background->hexes = mesh.hexes;
  constexpr double none = std::numeric_limits<double>::infinity();
  Field sizes{"size", Field::On::node, 1, std::vector<double>(mesh.points.size(), none)};
  // One value per hex is a sample at its centroid: at its nodes, it says no more than how fast sizes grow from there.
  if (!field->jumps()) field->evaluate(mesh.points, sizes.values);
  const std::vector<Vec3> centres = centroids(mesh);
  std::vector<double> inside(centres.size());
  field->evaluate(centres, inside);
  for (std::size_t h = 0; h < inside.size(); ++h)
    for (const Index n : mesh.hexes[h])
      sizes.values[n] = std::min(sizes.values[n], inside[h] + (growth - 1) * (mesh.points[n] - centres[h]).norm());
  limit_gradation(edges(mesh), mesh.points, growth - 1, sizes.values);
  for (const Hex& hex : mesh.hexes)
    if (std::ranges::any_of(hex, [&](Index n) { return sizes.values[n] == none; })) return field;
  background->fields.push_back(std::move(sizes));
  return field_size(std::move(background), "size");
}

SizeFieldPtr field_size(std::shared_ptr<const Mesh> mesh, const std::string& field) {
  const Field& found = find_field(*mesh, field);
  return std::make_shared<MeshField>(std::move(mesh), found);
}

}  // namespace hextwist
