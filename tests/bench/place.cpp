// Goals 4 and 6: new boundary nodes, from their parents' parameters.
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>

#include "groups.h"
#include "hextwist/geom/occ/model.h"
#include "hextwist/mesh/primitives.h"
#include "hextwist/refine/carry.h"
#include "hextwist/refine/place.h"
#include "hextwist/refine/templates/uniform.h"
#include "measure.h"
#include "meshes.h"

#include <map>
#include <random>

namespace hextwist::bench {
namespace {

constexpr int n_points = 200000;

/// Points a third of the way from one point of a surface to another near it, and the parameters of the first.
struct Children {
  std::shared_ptr<const Model> model;
  int surface = 0;
  std::vector<Vec3> points;
  std::vector<Parameters> seeds;
};

Children children(const TopoDS_Shape& shape, const std::string& type) {
  Children made;
  made.model = cad_from_shape(shape).model;
  for (int id = 1; id <= made.model->count(2); ++id)
    if (made.model->type({2, id}) == type) made.surface = id;
  if (made.surface == 0) throw Error("no " + type);
  const Owner surface{2, made.surface};
  const Box box = made.model->box(surface);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto anywhere = [&] { return Vec3(unit(random), unit(random), unit(random)); };
  for (int base = 0; base < n_points / 100; ++base) {
    const Vec3 p = box.min + anywhere().cwiseProduct(box.max - box.min);
    const Projection parent = made.model->project(surface, p);
    for (int i = 0; i < 100; ++i) {
      const Vec3 near = parent.point + 0.02 * box.diagonal() * (anywhere() - Vec3::Constant(0.5));
      made.points.push_back((2 * parent.point + made.model->project(surface, near).point) / 3);
      made.seeds.push_back(parent.parameters);
    }
  }
  return made;
}

std::vector<Projection> placed(const Children& all) {
  std::vector<Projection> out(all.points.size());
  all.model->project({2, all.surface}, all.points, all.seeds, out);
  return out;
}

template <class Shape>
void add_surface(const char* name, const char* type, Shape shape) {
  add_rate(
      std::string("place/") + name,
      [=] {
        static const Children all = children(shape(), type);
        return placed(all);
      },
      [](const auto& out) { return out.size(); });
}

/// A ball, every edge of 100 thousand hexes in three, straight places; then placed.
struct Ball {
  MeshedModel coarse;
  Split parts;
  Carried carried;
};
const Ball& ball() {
  static const Ball made = [] {
    Ball b;
    b.coarse.mesh = mesh_sphere({10}, {8, 12});
    b.coarse.model = cad_sphere({10}).model;
    b.coarse.association = associate(b.coarse.mesh, *b.coarse.model).association;
    const Mesh& mesh = b.coarse.mesh;
    b.parts = split(mesh.hexes, mesh.n_nodes(), uniform_table(3), std::vector<std::uint16_t>(mesh.hexes.size(), 1));
    b.carried = carry(mesh, b.coarse.association, b.parts);
    return b;
  }();
  return made;
}
Carried straight_ball() {
  return ball().carried;
}
Carried place_ball(Carried result) {
  place(ball().coarse.mesh, ball().coarse.association, ball().parts, *ball().coarse.model, result.mesh,
        result.association);
  return result;
}
constexpr auto new_nodes = [](const Carried& c) { return c.mesh.n_nodes() - ball().coarse.mesh.n_nodes(); };

}  // namespace

void add_place() {
  add_surface("plane", "plane", [] { return BRepPrimAPI_MakeCylinder(3, 5).Shape(); });
  add_surface("cylinder", "cylinder", [] { return BRepPrimAPI_MakeCylinder(3, 5).Shape(); });
  add_surface("cone", "cone", [] { return BRepPrimAPI_MakeCone(3, 1, 5).Shape(); });
  add_surface("sphere", "sphere", [] { return BRepPrimAPI_MakeSphere(3).Shape(); });
  add_surface("torus", "torus", [] { return BRepPrimAPI_MakeTorus(5, 2).Shape(); });
  add_surface("bspline", "bspline surface",
              [] { return BRepBuilderAPI_NurbsConvert(BRepPrimAPI_MakeTorus(5, 2).Shape()).Shape(); });
  add_prepared_rate("place/ball", straight_ball, place_ball, new_nodes);
}

void add_place_threads() {
  add_on_two_threads("threads/place_ball", straight_ball, place_ball, new_nodes);
}

}  // namespace hextwist::bench
