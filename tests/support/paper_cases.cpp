#include "support/paper_cases.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <stdexcept>

#include "hextwist/geom/occ/model.h"
#include "hextwist/io/io.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/mesh/smooth/smooth.h"

namespace hextwist::test {
namespace {

MeshedModel read(const std::string& name) {
  const std::filesystem::path folder = std::filesystem::path(HEXTWIST_SOURCE_DIR) / "models";
  MeshFile file = read_mesh(folder / (name + ".msh"));
  MeshedModel result;
  result.model = read_cad(folder / (name + ".brep"), {}).model;
  result.association = associate(file.mesh, *result.model, &file.tags).association;
  result.mesh = std::move(file.mesh);
  return result;
}

Vec3 centre(const Mesh& mesh, std::span<const Index> nodes) {
  Vec3 sum = Vec3::Zero();
  for (const Index n : nodes) sum += mesh.points[n];
  return sum / static_cast<double>(nodes.size());
}

/// Entities of a dimension whose box lies in the given one.
std::vector<Index> entities_in(const Model& model, int dim, const Vec3& low, const Vec3& high) {
  std::vector<Index> ids;
  for (int id = 1; id <= model.count(dim); ++id) {
    const Box box = model.box(Owner{dim, id});
    const Vec3 near = Vec3::Constant(1e-3);
    if ((box.min - low + near).minCoeff() >= 0 && (high - box.max + near).minCoeff() >= 0) ids.push_back(id);
  }
  if (ids.empty()) throw std::logic_error("the model has no such entity");
  return ids;
}

/// Mesh entities (anything with nodes) whose centre satisfies the condition.
template <typename Items, typename Condition>
std::vector<Index> items_where(const Mesh& mesh, const Items& items, const Condition& condition) {
  std::vector<Index> found;
  for (std::size_t i = 0; i < items.size(); ++i)
    if (condition(centre(mesh, items[i]))) found.push_back(static_cast<Index>(i));
  return found;
}

/// Cell of the bent bar along its radius, height and bend.
std::array<int, 3> bar_cell(const Vec3& p) {
  const double radius = std::hypot(p.x(), p.y()), angle = std::atan2(p.y(), p.x());
  constexpr double bend = 111 * std::numbers::pi / 180;
  return {static_cast<int>((radius - 20) / 5), static_cast<int>(p.z() / 5),
          static_cast<int>(16 * (1 - std::pow(1 - angle / bend, 1 / 1.2)))};
}

Request request_of(const std::string& figure, const MeshedModel& input) {
  const Mesh& mesh = input.mesh;
  const Model& model = *input.model;
  const double big = 1e3;
  if (figure == "7(b)")  // 5 x 5 cells of the outside of the bend, 3 deep
    return {.target = {.kind = EntityKind::hex, .ids = items_where(mesh, mesh.hexes, [](const Vec3& p) {
                                                  const auto [i, j, k] = bar_cell(p);
                                                  return i >= 3 && j >= 4 && j < 9 && k >= 5 && k < 10;
                                                })}};
  if (figure == "7(c)") {  // a long edge of the bar, on the outside of the bend
    std::vector<Index> arcs = entities_in(model, 1, {-big, -big, 0}, {big, big, 0});
    std::erase_if(arcs, [&](Index id) { return model.measure({1, id}) < 90; });
    return {.target = {.kind = EntityKind::curve, .ids = arcs, .depth = 1}};
  }
  if (figure == "7(d)")  // one end
    return {
        .target = {.kind = EntityKind::surface, .ids = entities_in(model, 2, {0, 0, 0}, {big, 0, big}), .depth = 1}};
  if (figure == "16(b)") {  // the upper rim of the hole, as mesh edges
    const Edges all = edges(mesh);
    return {.target = {.kind = EntityKind::edge, .ids = items_where(mesh, all.nodes, [](const Vec3& p) {
                                                   return p.z() > 15 - 1e-6 && std::hypot(p.x() - 40, p.y() - 18) < 10;
                                                 })}};
  }
  if (figure == "16(c)") {  // a patch of the upper side, beside the hole
    const Faces all = faces(mesh);
    return {.target = {.kind = EntityKind::face, .ids = items_where(mesh, all.nodes, [](const Vec3& p) {
                                                   return p.z() > 15 - 1e-6 && p.x() > 51 && p.x() < 61 && p.y() > 12 &&
                                                          p.y() < 24;
                                                 })}};
  }
  // 17: both rims of the rod.
  Request rims{.target = {.kind = EntityKind::curve}};
  for (int id = 1; id <= model.count(1); ++id)
    if (model.type({1, id}) == "circle") rims.target.ids.push_back(id);
  if (figure == "17(c)") {
    rims.method = Method::parallel;
    rims.target.depth = 1;
  }
  if (figure == "17(d)") rims.target.depth = 1;
  return rims;
}

PaperRow row_of(const Mesh& mesh) {
  const Summary shape = summarize(quality(Metric::shape, mesh));
  return {mesh.n_hexes(), shape.average, shape.std_dev, shape.min, shape.max};
}

}  // namespace

std::vector<PaperCase> paper_cases() {
  return {
      {"7(a)", "bent_bar", "nothing", 1248, {1248, 0.932, 0.070, 0.726, 0.999}, {}},
      {"7(b)", "bent_bar", "75 hexes", 4346, {4448, 0.789, 0.128, 0.294, 0.999}, {4448, 0.818, 0.184, 0.312, 0.999}},
      {"7(c)",
       "bent_bar",
       "a curve, depth 1",
       2112,
       {2112, 0.851, 0.190, 0.278, 0.999},
       {2112, 0.867, 0.161, 0.319, 0.999}},
      {"7(d)",
       "bent_bar",
       "a surface, depth 1",
       4212,
       {4212, 0.851, 0.205, 0.207, 0.999},
       {4212, 0.863, 0.180, 0.266, 0.999}},
      {"16(a)", "bearing_plate", "nothing", 0, {3093, 0.942, 0.061, 0.572, 0.997}, {}},
      {"16(b)", "bearing_plate", "edges", 0, {3333, 0.919, 0.113, 0.354, 0.997}, {3333, 0.925, 0.088, 0.535, 0.998}},
      {"16(c)", "bearing_plate", "faces", 0, {3940, 0.883, 0.163, 0.128, 0.997}, {3940, 0.895, 0.134, 0.163, 0.998}},
      {"17(a)", "graded_rod", "nothing", 1080, {1116, 0.844, 0.070, 0.612, 0.934}, {}},
      {"17(b)",
       "graded_rod",
       "two curves",
       1560,
       {1962, 0.721, 0.208, 0.306, 0.952},
       {1962, 0.775, 0.107, 0.447, 0.947}},
      {"17(c)",
       "graded_rod",
       "the same, parallel",
       0,
       {2135, 0.711, 0.174, 0.417, 0.954},
       {2135, 0.742, 0.128, 0.416, 0.955}},
      {"17(d)",
       "graded_rod",
       "the same, depth 1",
       3672,
       {5828, 0.715, 0.218, 0.166, 0.995},
       {5828, 0.754, 0.198, 0.257, 0.998}}};
}

PaperResult run(const PaperCase& paper_case) {
  PaperResult result;
  result.input = read(paper_case.model);
  if (paper_case.figure.ends_with("(a)")) {
    result.plain = row_of(result.input.mesh);
    return result;
  }
  result.refined = refine(result.input, request_of(paper_case.figure, result.input));
  result.plain = row_of(result.refined.refined.mesh);
  MeshedModel smoothed = result.refined.refined;
  SmoothOptions options;
  options.average_loss = -0.02;  // by default it may not fall; the paper's rises
  smooth(smoothed.mesh, smoothed.association, smoothed.model.get(), options);
  result.smoothed = row_of(smoothed.mesh);
  return result;
}

}  // namespace hextwist::test
