// What `with` can ask of entities, as numbers.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "hextwist/command/error_at.h"
#include "hextwist/command/select/selection.h"
#include "hextwist/command/select/shapes.h"
#include "hextwist/geom/facet/bilinear.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/quality/quality.h"

namespace hextwist {
namespace {

using Op = Criterion::Op;
using Values = std::vector<double>;

constexpr double rounding = 1e-9;  // of `=`, relative to the values, for lengths to the size of everything

/// Nodes of a mesh entity.
template <class F>
void for_each_node(const Selector& selector, EntityKind kind, Index i, F f) {
  const auto all = [&](const auto& nodes) {
    for (const Index node : nodes) f(node);
  };
  switch (kind) {
    case EntityKind::node:
      return f(i);
    case EntityKind::edge:
      return all(selector.topology.edges().nodes[i]);
    case EntityKind::face:
      return all(selector.topology.faces().nodes[i]);
    default:
      return all(selector.meshed.mesh.hexes[i]);
  }
}

BilinearPatch patch_of(const Selector& selector, Index face) {
  const auto& p = selector.meshed.mesh.points;
  const Quad& quad = selector.topology.faces().nodes[face];
  return {p[quad[0]], p[quad[1]], p[quad[3]], p[quad[2]]};
}

}  // namespace

/// Of arcs: the chord between two points over that between their normals, which is the radius whatever the angle.
double radius(const Model& model, Owner entity) {
  const int id = entity.id;
  const std::string type = model.type(entity);
  if (entity.dim == 1) {
    if (type != "circle") return 0;
    const CurveRange range = model.range(id);  // of angles
    return model.measure(entity) / (range.last - range.first);
  }
  if (type != "cylinder" && type != "sphere" && type != "torus") return 0;
  // A corner of the box: its middle may be the centre or on the axis.
  const Parameters at = model.project({2, id}, model.box({2, id}).max).parameters;
  // Around the cylinder, around the tube of the torus, away from the nearer pole of the sphere.
  constexpr double step = 0.25;
  const Parameters beside =
      type == "cylinder" ? Parameters{at.u + step, at.v} : Parameters{at.u, at.v + (at.v > 0 ? -step : step)};
  const Vec3 turn = model.normal(id, beside) - model.normal(id, at);
  return (model.point({2, id}, beside) - model.point({2, id}, at)).norm() / turn.norm();
}

namespace {

class AttributeEvaluation {
 public:
  AttributeEvaluation(const Selector& selector, const Statement& statement, EntityKind kind,
                      std::span<const Index> positions)
      : selector_(selector), statement_(statement), kind_(kind), positions_(positions) {}

  Values values(const Criterion& c) {
    switch (c.op) {
      case Op::number:
      case Op::truth:
        return Values(positions_.size(), c.value);
      case Op::attribute:
        return c.of.empty() ? attribute(kind_, c, positions_) : of(c);
      case Op::named:
        return each([&](Index i) { return matches(name_of(selector_, kind_, i), c.text) ? 1.0 : 0.0; });
      case Op::negate:
        return combined(c, [](double a, double) { return -a; });
      case Op::add:
        return combined(c, [](double a, double b) { return a + b; });
      case Op::subtract:
        return combined(c, [](double a, double b) { return a - b; });
      case Op::multiply:
        return combined(c, [](double a, double b) { return a * b; });
      case Op::divide:
        return combined(c, [](double a, double b) { return a / b; });
      case Op::less:
        return combined(c, [](double a, double b) { return a < b; });
      case Op::less_equal:
        return combined(c, [](double a, double b) { return a <= b; });
      case Op::greater:
        return combined(c, [](double a, double b) { return a > b; });
      case Op::greater_equal:
        return combined(c, [](double a, double b) { return a >= b; });
      case Op::equal:
      case Op::not_equal: {
        const bool wanted = c.op == Op::equal;
        const double least = speaks_of_length(c) ? rounding * size() : 0;
        return combined(c, [&](double a, double b) {
          const double tolerance =
              std::isnan(c.tolerance) ? std::max(least, rounding * std::max(std::abs(a), std::abs(b))) : c.tolerance;
          return (a == b || std::abs(a - b) <= tolerance) == wanted;
        });
      }
      case Op::not_:
        return combined(c, [](double a, double) { return a == 0; });
      case Op::and_:
        return combined(c, [](double a, double b) { return a != 0 && b != 0; });
      case Op::or_:
        return combined(c, [](double a, double b) { return a != 0 || b != 0; });
    }
    return {};
  }

 private:
  const Selector& selector_;
  const Statement& statement_;
  EntityKind kind_;
  std::span<const Index> positions_;

  const Mesh& mesh() const { return selector_.meshed.mesh; }
  const Model& model() const { return *selector_.meshed.model; }

  double size() const { return selector_.meshed.model ? model().box().diagonal() : hextwist::box(mesh()).diagonal(); }

  template <class F>
  Values each(F f) const {
    Values result(positions_.size());
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = f(positions_[i]);
    return result;
  }

  template <class F>
  Values combined(const Criterion& c, F f) {
    Values left = values(c.operands[0]);
    if (c.operands.size() < 2) {
      for (double& a : left) a = f(a, 0.0);
      return left;
    }
    const Values right = values(c.operands[1]);
    for (std::size_t i = 0; i < left.size(); ++i) left[i] = f(left[i], right[i]);
    return left;
  }

  static bool speaks_of_length(const Criterion& c) {
    if (c.op == Op::attribute)
      return std::ranges::find(attributes(), c.attribute, &AttributeSpec::attribute)->is_length;
    return std::ranges::any_of(c.operands, speaks_of_length);
  }

  Values of(const Criterion& c) {
    std::vector<std::string> notices;
    const RangeTerm& term = c.of[0];
    const std::vector<Index> one = select(selector_, statement_, term.kind, term.range, notices);
    if (one.size() != 1)
      throw error_at(statement_, term.range.token,
                     "'of' takes a single entity; these are " + std::to_string(one.size()));
    return Values(positions_.size(), attribute(term.kind, c, one)[0]);
  }

  Values attribute(EntityKind kind, const Criterion& c, std::span<const Index> positions) {
    if (c.attribute == Attribute::quality) return quality(metric(c.text), mesh(), positions);
    std::vector<char> flags;  // per mesh entity
    if (c.attribute == Attribute::block_assigned) {
      flags.assign(mesh().hexes.size(), 0);
      for (const Block& block : mesh().blocks)
        for (const Index hex : block.hexes) flags[hex] = 1;
    }
    Values result;
    for (const Index i : positions)
      result.push_back(flags.empty() ? value(kind, c.attribute, i) : static_cast<double>(flags[i]));
    return result;
  }

  double value(EntityKind kind, Attribute attribute, Index i) {
    const Owner owner = is_cad(kind) ? Owner{dimension(kind), i + 1} : Owner{};
    switch (attribute) {
      case Attribute::id:
        return static_cast<double>(id_of(selector_, kind, i));
      case Attribute::x_coord:
      case Attribute::y_coord:
      case Attribute::z_coord:
        return middle(selector_, kind, i)[static_cast<int>(attribute) - static_cast<int>(Attribute::x_coord)];
      case Attribute::x_min:
      case Attribute::y_min:
      case Attribute::z_min:
        return box(selector_, kind, i).min[static_cast<int>(attribute) - static_cast<int>(Attribute::x_min)];
      case Attribute::x_max:
      case Attribute::y_max:
      case Attribute::z_max:
        return box(selector_, kind, i).max[static_cast<int>(attribute) - static_cast<int>(Attribute::x_max)];
      case Attribute::length:
      case Attribute::area:
      case Attribute::volume:
        return owner ? model().measure(owner) : mesh_measure(kind, i);
      case Attribute::radius:
        return radius(model(), owner);
      case Attribute::is_planar:
        return is_planar(owner.id);
      case Attribute::is_spline: {
        const std::string type = model().type(owner);
        return type.starts_with("bspline") || type.starts_with("bezier");
      }
      case Attribute::is_hole:
        return is_hole(model(), owner.id);
      case Attribute::is_meshed:
        return n_elements(kind, i) > 0;
      case Attribute::element_count:
        return n_elements(kind, i);
      case Attribute::num_parents:
        return static_cast<double>(model().adjacent(owner, owner.dim + 1).size());
      default:
        return 0;  // quality, block_assigned and name are above
    }
  }

  double mesh_measure(EntityKind kind, Index i) {
    double sum = 0;
    switch (kind) {
      case EntityKind::edge: {
        const Edge edge = selector_.topology.edges().nodes[i];
        return (mesh().points[edge[1]] - mesh().points[edge[0]]).norm();
      }
      case EntityKind::face:
        return area(patch_of(selector_, i));
      case EntityKind::sideset:
        for (const Side side : mesh().side_sets[i].sides)
          sum += area(patch_of(selector_, selector_.topology.faces().of_hex[side.hex][side.face]));
        return sum;
      case EntityKind::block:
        for (const Index hex : mesh().blocks[i].hexes) sum += volume(mesh(), hex);
        return sum;
      default:
        return volume(mesh(), i);
    }
  }

  /// A surface of facets is what the mesh faces on it are.
  bool is_planar(int id) {
    const std::string type = model().type({2, id});
    if (type != "facets") return type == "plane";
    const Association& association = selector_.meshed.association;
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < association.surface_faces.size(); ++i) {
      if (association.face_surface[i] != id) continue;
      const Side side = association.surface_faces[i];
      for (const Index node : face_node_cycle(mesh().hexes[side.hex], side.face)) points.push_back(mesh().points[node]);
    }
    if (points.empty()) return false;
    Vec3 normal = Vec3::Zero();  // the vector area: quads need not be turned the same way, so the largest is taken
    for (std::size_t i = 0; i < points.size(); i += 4) {
      const Vec3 of_quad = (points[i + 2] - points[i]).cross(points[i + 3] - points[i + 1]);
      if (of_quad.norm() > normal.norm()) normal = of_quad;
    }
    normal.normalize();
    return std::ranges::all_of(points, [&](const Vec3& p) {
      return std::abs(normal.dot(p - points[0])) <= 1e-6 * model().box({2, id}).diagonal();
    });
  }

  double n_elements(EntityKind kind, Index i) {
    const Association& a = selector_.meshed.association;
    const auto n = [](auto count) { return static_cast<double>(count); };
    switch (kind) {
      case EntityKind::vertex:
        return n(std::ranges::count(a.node_owner, Owner{0, i + 1}));
      case EntityKind::curve:
        return n(std::ranges::count(a.edge_curve, i + 1));
      case EntityKind::surface:
        return n(std::ranges::count(a.face_surface, i + 1));
      case EntityKind::volume:
        return n(std::ranges::count(a.hex_volume, i + 1));
      case EntityKind::block:
        return n(mesh().blocks[i].hexes.size());
      case EntityKind::nodeset:
        return n(mesh().node_sets[i].nodes.size());
      case EntityKind::sideset:
        return n(mesh().side_sets[i].sides.size());
      case EntityKind::sheet:
        return n(selector_.topology.sheets().hexes[i].size());
      default:
        return 1;
    }
  }
};

}  // namespace

Box box(const Selector& selector, EntityKind kind, Index i) {
  if (is_cad(kind)) return selector.meshed.model->box({dimension(kind), i + 1});
  const Mesh& mesh = selector.meshed.mesh;
  Box result;
  const auto add = [&](EntityKind of, Index entity) {
    for_each_node(selector, of, entity, [&](Index node) { result.add(mesh.points[node]); });
  };
  switch (kind) {
    case EntityKind::block:
      for (const Index hex : mesh.blocks[i].hexes) add(EntityKind::hex, hex);
      break;
    case EntityKind::nodeset:
      for (const Index node : mesh.node_sets[i].nodes) add(EntityKind::node, node);
      break;
    case EntityKind::sideset:
      for (const Side side : mesh.side_sets[i].sides)
        add(EntityKind::face, selector.topology.faces().of_hex[side.hex][side.face]);
      break;
    case EntityKind::sheet:
      for (const Index hex : selector.topology.sheets().hexes[i]) add(EntityKind::hex, hex);
      break;
    case EntityKind::group:
      for (int k = 0; k < n_entity_kinds; ++k) {
        const auto of = static_cast<EntityKind>(k);
        if (of == EntityKind::group) continue;
        for (const Index member : members(selector, selector.groups[i], of)) result.add(box(selector, of, member));
      }
      break;
    default:
      add(kind, i);
  }
  return result;
}

Vec3 middle(const Selector& selector, EntityKind kind, Index i) {
  if (is_mesh(kind)) {
    Vec3 sum = Vec3::Zero();
    int n = 0;
    for_each_node(selector, kind, i, [&](Index node) {
      sum += selector.meshed.mesh.points[node];
      ++n;
    });
    return sum / n;
  }
  const Box box = hextwist::box(selector, kind, i);
  Vec3 centre = (box.min + box.max) / 2;  // NaN where there is nothing
  if (kind != EntityKind::curve && kind != EntityKind::surface) return centre;
  return selector.meshed.model->project({dimension(kind), i + 1}, centre).point;
}

std::vector<double> values_of(const Selector& selector, const Statement& statement, EntityKind kind,
                              const Criterion& measure, std::span<const Index> positions) {
  return AttributeEvaluation(selector, statement, kind, positions).values(measure);
}

std::vector<char> meets(const Selector& selector, const Statement& statement, EntityKind kind,
                        const Criterion& criterion, std::span<const Index> positions) {
  const Values values = AttributeEvaluation(selector, statement, kind, positions).values(criterion);
  std::vector<char> result(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) result[i] = values[i] != 0;
  return result;
}

}  // namespace hextwist
