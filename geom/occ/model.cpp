// Topology, measures and the Model interface over an OpenCASCADE shape.
#include "hextwist/geom/occ/model.h"

#include <BRepTools_WireExplorer.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Wire.hxx>
#include <algorithm>
#include <cmath>
#include <set>

#include "hextwist/base/parallel.h"
#include "hextwist/geom/occ/model_internal.h"

namespace hextwist::occ {
namespace {

constexpr std::array kinds{TopAbs_VERTEX, TopAbs_EDGE, TopAbs_FACE, TopAbs_SOLID};
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::size_t index(int id) {
  return static_cast<std::size_t>(id) - 1;
}
std::size_t slot(int dim) {
  return static_cast<std::size_t>(dim);
}

// The uses of edges that bound the face, wire by wire, each wire in its own sense.
std::vector<Boundary> boundaries(const TopoDS_Face& oriented, const TopTools_IndexedMapOfShape& edges) {
  const TopoDS_Face face = TopoDS::Face(oriented.Oriented(TopAbs_FORWARD));
  std::vector<Boundary> result;
  int n_wires = 0;
  for (TopExp_Explorer wires(face, TopAbs_WIRE); wires.More(); wires.Next(), ++n_wires) {
    const TopoDS_Wire wire = TopoDS::Wire(wires.Current());
    std::vector<TopoDS_Edge> order, unordered;
    for (BRepTools_WireExplorer walk(wire, face); walk.More(); walk.Next()) order.push_back(walk.Current());
    for (TopoDS_Iterator it(wire); it.More(); it.Next()) unordered.push_back(TopoDS::Edge(it.Value()));
    if (order.size() != unordered.size()) order = std::move(unordered);  // a broken wire: Trim copes
    for (const TopoDS_Edge& edge : order) {
      if (edge.Orientation() != TopAbs_FORWARD && edge.Orientation() != TopAbs_REVERSED) continue;
      Boundary b;
      b.curve = BRep_Tool::CurveOnSurface(edge, face, b.first, b.last);
      if (b.curve.IsNull()) continue;
      b.edge = edges.FindIndex(edge) - 1;
      b.wire = n_wires;
      b.reversed = edge.Orientation() == TopAbs_REVERSED;
      b.tolerance = BRep_Tool::Tolerance(edge);
      result.push_back(b);
    }
  }
  return result;
}

/// Calls f; what OpenCASCADE throws becomes an Error about the entity.
template <class F>
auto translated(const char* what, Owner owner, F&& f) {
  try {
    return f();
  } catch (const Standard_Failure& failure) {
    const char* message = failure.GetMessageString();
    throw Error(std::string(what) + " of " + to_string(owner) + " cannot be computed: the CAD is damaged there (" +
                (message && *message ? message : failure.DynamicType()->Name()) + ")");
  }
}

bool is_finite(const Box& box) {
  return box.min.allFinite() && box.max.allFinite();
}

}  // namespace

ShapeMaps entity_maps(const TopoDS_Shape& shape) {
  ShapeMaps maps;
  for (int dim = 0; dim <= 3; ++dim) TopExp::MapShapes(shape, kinds[slot(dim)], maps[slot(dim)]);
  return maps;
}

OccModel::OccModel(const TopoDS_Shape& shape, Names names, Known* known) : shape_(shape), names_(std::move(names)) {
  maps_ = entity_maps(shape);
  for (int id = 1; id <= count(0); ++id) vertices_.push_back(from_occ(BRep_Tool::Pnt(TopoDS::Vertex(maps_[0](id)))));
  for (int id = 1; id <= count(1); ++id)
    curves_.push_back(
        translated("the shape", {1, id}, [&] { return std::make_unique<Curve>(TopoDS::Edge(maps_[1](id))); }));
  for (int id = 1; id <= count(2); ++id) {
    const TopoDS_Face face = TopoDS::Face(maps_[2](id));
    surfaces_.push_back(translated(
        "the shape", {2, id}, [&] { return std::make_unique<Surface>(face, boundaries(face, maps_[1]), curves_); }));
  }
  for (int dim = 0; dim <= 3; ++dim) {
    measures_[slot(dim)] = std::vector<std::atomic<double>>(static_cast<std::size_t>(count(dim)));
    for (auto& m : measures_[slot(dim)]) m = nan;
  }
  classifiers_ = std::vector<Classifiers>(static_cast<std::size_t>(count(3)));
  build_adjacency();
  check_finite();
  if (!known) return;
  for (std::size_t i = 0; i < surfaces_.size(); ++i) surfaces_[i]->set_integrals(known->integrals.at(i));
  for (std::size_t i = 0; i < curves_.size(); ++i) measures_[1][i] = known->lengths.at(i);
  for (std::size_t dim = 0; dim <= 3; ++dim)
    std::call_once(boxes_made_[dim], [&] { boxes_[dim] = std::move(known->boxes[dim]); });
}

Known OccModel::known() const {
  Known known;
  for (int id = 1; id <= count(1); ++id) known.lengths.push_back(measure({1, id}));
  for (int id = 1; id <= count(2); ++id)
    known.integrals.push_back(
        translated("the area", {2, id}, [&]() -> const FaceIntegrals& { return surfaces_[index(id)]->integrals(); }));
  for (int dim = 0; dim <= 3; ++dim) known.boxes[slot(dim)] = boxes(dim);
  return known;
}

void OccModel::check_finite() const {
  const auto check = [&](Owner owner, bool finite) {
    if (!finite) throw Error("the CAD is damaged: " + to_string(owner) + " has no finite size or tolerance");
  };
  for (int id = 1; id <= count(0); ++id) check({0, id}, vertices_[index(id)].allFinite());
  for (int id = 1; id <= count(1); ++id) {
    const CurveRange range = curves_[index(id)]->range();
    constexpr double endless = 1e100;  // OpenCASCADE's unbounded lines and planes go to 2e100
    check({1, id}, std::abs(range.first) < endless && std::abs(range.last) < endless &&
                       curves_[index(id)]->point(range.first).allFinite() &&
                       curves_[index(id)]->point(range.last).allFinite());
  }
  for (int dim = 0; dim <= 2; ++dim)
    for (int id = 1; id <= count(dim); ++id) check({dim, id}, std::isfinite(tolerance({dim, id})));
}

void OccModel::build_adjacency() {
  for (int dim = 0; dim <= 3; ++dim) {
    for (int other = 0; other <= 3; ++other) {
      adjacent_[slot(dim)][slot(other)].resize(static_cast<std::size_t>(count(dim)));
    }
  }
  for (int dim = 1; dim <= 3; ++dim) {
    for (int id = 1; id <= count(dim); ++id) {
      for (int below = 0; below < dim; ++below) {
        TopTools_IndexedMapOfShape pieces;
        TopExp::MapShapes(maps_[slot(dim)](id), kinds[slot(below)], pieces);
        for (int i = 1; i <= pieces.Extent(); ++i) {
          const int piece = maps_[slot(below)].FindIndex(pieces(i));
          adjacent_[slot(dim)][slot(below)][index(id)].push_back(piece);
          adjacent_[slot(below)][slot(dim)][index(piece)].push_back(id);  // ascending, as id is
        }
        auto& list = adjacent_[slot(dim)][slot(below)][index(id)];
        std::sort(list.begin(), list.end());
      }
    }
  }
}

const TopoDS_Shape& OccModel::entity(Owner owner) const {
  if (owner.dim < 0 || owner.dim > 3 || owner.id < 1 || owner.id > count(owner.dim)) {
    throw Error("the model has no " + to_string(owner));
  }
  return maps_[slot(owner.dim)](owner.id);
}

int OccModel::count(int dim) const {
  return dim < 0 || dim > 3 ? 0 : maps_[slot(dim)].Extent();
}

std::string OccModel::name(Owner owner) const {
  entity(owner);
  const auto& names = names_[slot(owner.dim)];
  return static_cast<std::size_t>(owner.id) < names.size() ? names[static_cast<std::size_t>(owner.id)] : "";
}

std::string OccModel::type(Owner owner) const {
  entity(owner);
  switch (owner.dim) {
    case 0:
      return "point";
    case 1:
      return curves_[index(owner.id)]->type();
    case 2:
      return surfaces_[index(owner.id)]->type();
    default:
      return "solid";
  }
}

const std::vector<Box>& OccModel::boxes(int dim) const {
  std::call_once(boxes_made_[slot(dim)], [&] {
    std::vector<Box> boxes(static_cast<std::size_t>(count(dim)));
    for (int id = 1; id <= count(dim); ++id) {
      Box& box = boxes[index(id)];
      if (dim == 0) {
        box.add(vertices_[index(id)]);
      } else if (dim == 1) {
        box = translated("the box", {1, id}, [&] { return curves_[index(id)]->box(); });
      } else if (dim == 2) {
        box = translated("the box", {2, id}, [&] { return surfaces_[index(id)]->box(); });
      } else {
        for (const int surface : adjacent({3, id}, 2)) box.add(this->boxes(2)[index(surface)]);
      }
      if (!box.empty() && !is_finite(box))
        throw Error("the CAD is damaged: " + to_string(Owner{dim, id}) + " has no finite size");
    }
    boxes_[slot(dim)] = std::move(boxes);
  });
  return boxes_[slot(dim)];
}

Box OccModel::box(Owner owner) const {
  entity(owner);
  return boxes(owner.dim)[index(owner.id)];
}

Box OccModel::box() const {
  Box box;
  for (int dim = 0; dim <= 2; ++dim) {
    for (const Box& b : boxes(dim)) {
      if (!b.empty()) box.add(b);
    }
  }
  return box;
}

double OccModel::signed_volume(int volume) const {
  double sum = 0;
  const Vec3 origin = surfaces_.empty() ? Vec3::Zero() : surfaces_[0]->integrals().origin;
  for (TopExp_Explorer faces(maps_[3](volume), TopAbs_FACE); faces.More(); faces.Next()) {
    const TopAbs_Orientation sense = faces.Current().Orientation();
    if (sense != TopAbs_FORWARD && sense != TopAbs_REVERSED) continue;  // a face inside the solid bounds nothing
    const FaceIntegrals& face = surfaces_[index(maps_[2].FindIndex(faces.Current()))]->integrals();
    const double part = face.cone_volume + (face.origin - origin).dot(face.vector_area) / 3;
    sum += sense == TopAbs_FORWARD ? part : -part;
  }
  return sum;
}

double OccModel::compute_measure(Owner owner) const {
  switch (owner.dim) {
    case 1:
      return curves_[index(owner.id)]->length();
    case 2:
      return surfaces_[index(owner.id)]->integrals().area;
    case 3:
      return std::abs(signed_volume(owner.id));
    default:
      return 0;
  }
}

double OccModel::measure(Owner owner) const {
  entity(owner);
  std::atomic<double>& known = measures_[slot(owner.dim)][index(owner.id)];
  double value = known;
  if (std::isnan(value)) known = value = translated("the size", owner, [&] { return compute_measure(owner); });
  return value;
}

std::vector<int> OccModel::adjacent(Owner owner, int dim) const {
  entity(owner);
  if (dim < 0 || dim > 3 || dim == owner.dim) return {};
  return adjacent_[slot(owner.dim)][slot(dim)][index(owner.id)];
}

double OccModel::tolerance(Owner owner) const {
  entity(owner);
  switch (owner.dim) {
    case 0:
      return BRep_Tool::Tolerance(TopoDS::Vertex(entity(owner)));
    case 1:
      return curves_[index(owner.id)]->tolerance();
    case 2:
      return surfaces_[index(owner.id)]->tolerance();
    default: {
      double worst = 0;
      for (int dim = 0; dim < 3; ++dim) {
        for (const int id : adjacent(owner, dim)) worst = std::max(worst, tolerance({dim, id}));
      }
      return worst;
    }
  }
}

CurveRange OccModel::range(int curve) const {
  entity({1, curve});
  return curves_[index(curve)]->range();
}

Vec3 OccModel::point(Owner owner, Parameters at) const {
  entity(owner);
  switch (owner.dim) {
    case 0:
      return vertices_[index(owner.id)];
    case 1:
      return translated("a point", owner, [&] { return curves_[index(owner.id)]->point(at.u); });
    case 2:
      return translated("a point", owner, [&] { return surfaces_[index(owner.id)]->point(at.u, at.v); });
    default:
      throw Error("a " + std::string(dimension_name(owner.dim)) + " has no parameters");
  }
}

Vec3 OccModel::tangent(int curve, double t) const {
  entity({1, curve});
  const Vec3 d = translated("the tangent", {1, curve}, [&] { return curves_[index(curve)]->derivative(t); });
  const double length = d.norm();
  return length > 0 ? Vec3(d / length) : Vec3::Zero();
}

double OccModel::curvature(Owner owner, Parameters at) const {
  entity(owner);
  return translated("the curvature", owner, [&]() -> double {
    if (owner.dim == 1) return curves_[index(owner.id)]->curvature(at.u);
    if (owner.dim == 2) return surfaces_[index(owner.id)]->curvature(at.u, at.v);
    return 0;
  });
}

// A face's orientation says on which side its material is, provided that the solid is not inside out.
const OccModel::Sides& OccModel::sides() const {
  std::call_once(sides_made_, [this] {
    Sides sides;
    for (int id = 1; id <= count(2); ++id) sides.flipped.push_back(maps_[2](id).Orientation() == TopAbs_REVERSED);
    sides.inside_out.resize(static_cast<std::size_t>(count(3)));
    sides.within.resize(static_cast<std::size_t>(count(2)), 0);
    for (int volume = count(3); volume >= 1; --volume) {  // the lowest id has the last word
      const bool inside_out = translated("the volume", {3, volume}, [&] { return signed_volume(volume); }) < 0;
      sides.inside_out[index(volume)] = inside_out;
      std::set<int> seen;
      for (TopExp_Explorer faces(maps_[3](volume), TopAbs_FACE); faces.More(); faces.Next()) {
        const TopAbs_Orientation orientation = faces.Current().Orientation();
        const int surface = maps_[2].FindIndex(faces.Current());
        sides.flipped[index(surface)] = (orientation == TopAbs_REVERSED) != inside_out;
        if (!seen.insert(surface).second || orientation == TopAbs_INTERNAL) sides.within[index(surface)] = 1;
      }
    }
    sides_ = std::move(sides);
  });
  return sides_;
}

SurfaceFacets OccModel::facets(int surface) const {
  entity({2, surface});
  return translated("the triangles", {2, surface}, [&] { return surfaces_[index(surface)]->facets(); });
}

std::array<double, 2> OccModel::periods(int surface) const {
  entity({2, surface});
  return surfaces_[index(surface)]->periods();
}

Vec3 OccModel::normal(int surface, Parameters at) const {
  entity({2, surface});
  Vec3 n = Vec3::Zero();
  try {
    n = surfaces_[index(surface)]->normal(at.u, at.v);
  } catch (const Standard_Failure&) {
    return n;  // no derivatives there
  }
  return sides().flipped[index(surface)] ? Vec3(-n) : n;
}

void OccModel::project_some(Owner owner, std::span<const Vec3> points, std::span<const Parameters> seeds,
                            std::span<Projection> out) const {
  translated("a closest point", owner, [&] {
    switch (owner.dim) {
      case 0:
        for (std::size_t i = 0; i < points.size(); ++i) {
          const Vec3& vertex = vertices_[index(owner.id)];
          out[i] = {vertex, {}, (vertex - points[i]).norm()};
        }
        return;
      case 1:
        return curves_[index(owner.id)]->project(points, seeds, out);
      case 2:
        return surfaces_[index(owner.id)]->project(points, seeds, out);
      default:
        throw Error("cannot project onto " + to_string(owner));
    }
  });
}

void OccModel::project(Owner owner, std::span<const Vec3> points, std::span<const Parameters> seeds,
                       std::span<Projection> out) const {
  entity(owner);
  constexpr std::size_t grain = 512;
  if (points.size() <= grain) return project_some(owner, points, seeds, out);
  parallel_ranges(
      static_cast<Index>(points.size()),
      [&](Index begin, Index end) {
        const auto part = [&](const auto& all) {
          return all.empty() ? all
                             : all.subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin));
        };
        project_some(owner, part(points), part(seeds), part(out));
      },
      grain);
}

bool OccModel::contains(int volume, const Vec3& p) const {
  entity({3, volume});
  const Box& box = boxes(3)[index(volume)];
  const double slack = tolerance({3, volume});
  if (((p - box.min).array() < -slack).any() || ((box.max - p).array() < -slack).any()) return false;
  const Side side = side_of_nearest(volume, p, slack);
  if (side != Side::unknown) return side == Side::inside;
  return translated("the inside", {3, volume}, [&] { return classify(volume, p, slack); });
}

/// On which side of the nearest surface of the volume a point lies; unknown where the nearest point is on an edge.
OccModel::Side OccModel::side_of_nearest(int volume, const Vec3& p, double slack) const {
  // OpenCASCADE's classifier shoots a line and now and then miscounts its crossings with spline faces; a foot point
  // inside a face can't be misread.
  int nearest = 0;
  Projection foot;
  double second = std::numeric_limits<double>::infinity();
  for (const int s : adjacent({3, volume}, 2)) {
    const Projection at = project({2, s}, p);
    if (at.distance <= slack) return Side::inside;
    if (sides().within[index(s)]) continue;
    if (nearest == 0 || at.distance < foot.distance) {
      second = nearest == 0 ? second : foot.distance;
      nearest = s;
      foot = at;
    } else {
      second = std::min(second, at.distance);
    }
  }
  if (nearest == 0 || second < foot.distance * (1 + 1e-6)) return Side::unknown;
  const std::vector<int> volumes = adjacent({2, nearest}, 3);
  const double out = volumes.front() == volume ? 1 : -1;
  const double height = out * (p - foot.point).dot(normal(nearest, foot.parameters)) / foot.distance;
  // A foot on an edge may be seen from anywhere.
  if (std::abs(height) < 0.99) return Side::unknown;
  return height < 0 ? Side::inside : Side::outside;
}

/// The volume as its boundary alone: the classifier takes a face inside it for an end of it.
TopoDS_Shape OccModel::without_faces_inside(int volume) const {
  const TopoDS_Shape& whole = maps_[3](volume);
  bool any = false;
  const BRep_Builder builder;
  TopoDS_Solid solid;
  TopoDS_Shell shell;
  builder.MakeSolid(solid);
  builder.MakeShell(shell);
  for (TopExp_Explorer faces(whole, TopAbs_FACE); faces.More(); faces.Next()) {
    const bool within = sides().within[index(maps_[2].FindIndex(faces.Current()))];
    any = any || within;
    if (!within) builder.Add(shell, faces.Current());
  }
  builder.Add(solid, shell);
  return any ? TopoDS_Shape(solid) : whole;
}

bool OccModel::classify(int volume, const Vec3& p, double slack) const {
  Classifiers& pool = classifiers_[index(volume)];
  std::unique_ptr<BRepClass3d_SolidClassifier> classifier;
  {
    const std::lock_guard lock(pool.mutex);
    if (!pool.idle.empty()) {
      classifier = std::move(pool.idle.back());
      pool.idle.pop_back();
    }
  }
  if (!classifier) {
    const TopoDS_Shape solid = without_faces_inside(volume);
    const bool reverse = sides().inside_out[index(volume)];
    classifier = std::make_unique<BRepClass3d_SolidClassifier>(reverse ? solid.Reversed() : solid);
  }
  classifier->Perform(to_occ(p), slack);
  const bool inside = classifier->State() == TopAbs_IN || classifier->State() == TopAbs_ON;
  const std::lock_guard lock(pool.mutex);
  pool.idle.push_back(std::move(classifier));
  return inside;
}

std::vector<int> OccModel::near(int dim, const Vec3& p, double distance) const {
  std::vector<int> result;
  if (dim < 0 || dim > 2) return result;
  const std::vector<Box>& all = boxes(dim);
  for (int id = 1; id <= count(dim); ++id) {
    const Box& box = all[index(id)];
    const Owner owner{dim, id};
    const double reach = distance + tolerance(owner) + 1e-9 * box.diagonal();
    const Vec3 outside = (box.min - p).cwiseMax(p - box.max).cwiseMax(0.0);
    if (!(outside.squaredNorm() <= reach * reach)) continue;
    if (dim > 0) {
      const double slack = dim == 1 ? curves_[index(id)]->slack() : surfaces_[index(id)]->slack();
      if (project(owner, p).distance > reach + slack) continue;
    }
    result.push_back(id);
  }
  return result;
}

}  // namespace hextwist::occ
