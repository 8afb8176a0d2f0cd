// Nodal fields through whole requests: values of the old mesh at the places where nodes have ended up.
#include <gtest/gtest.h>

#include <algorithm>

#include "hextwist/io/io.h"
#include "hextwist/patch/adapt.h"
#include "hextwist/patch/refine_known.h"
#include "support/exodus_extras.h"
#include "support/meshed.h"

namespace hextwist {
namespace {

double linear(const Vec3& p) {
  return 1 + 2 * p.x() - 3 * p.y() + p.z() / 2;
}
void add_linear(Mesh& mesh) {
  Field field{"f", Field::On::node, 1, {}};
  for (const Vec3& p : mesh.points) field.values.push_back(linear(p));
  mesh.fields.push_back(std::move(field));
}
void expect_linear(const Mesh& mesh) {
  const auto [low, high] = std::ranges::minmax(mesh.fields[0].values);
  double worst = 0;
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    worst = std::max(worst, std::abs(mesh.fields[0].values[n] - linear(mesh.points[n])));
  EXPECT_LE(worst, 1e-9 * (high - low));
}

std::vector<std::pair<const char*, Request>> requests() {
  const Target vertex{.kind = EntityKind::vertex, .ids = {1}}, curve{.kind = EntityKind::curve, .ids = {1}};
  const Target surface{.kind = EntityKind::surface, .ids = {1}}, whole{.kind = EntityKind::volume, .ids = {1}};
  Target deep = vertex;
  deep.depth = 1;
  std::vector<std::pair<const char*, Request>> result = {
      {"whole hexes", {.target = deep}},
      {"combination", {.target = surface}},
      {"twice", {.target = curve, .how = Cuts{2}}},
      {"one into eight", {.target = whole, .method = Method::parallel}},
      {"uniform", {.target = whole}},
      {"layers", {.target = surface, .how = Layers{3, 1.5}}}};
  for (std::size_t i = 0, n = result.size(); i < n; ++i) {
    result.push_back(result[i]);
    result.back().second.finish.smooth = true;
  }
  return result;
}

TEST(Fields, linear_ones_stay_exact_on_every_model_by_every_technique) {
  for (const char* name : {"l_block", "inclusion", "cylinder", "ring_twist", "curved_plate"}) {
    MeshedModel input = test::shipped(name);
    add_linear(input.mesh);
    for (const auto& [how, request] : requests()) {
      SCOPED_TRACE(std::string(name) + ", " + how + (request.finish.smooth ? ", smooth" : ""));
      expect_linear(refine(input, request).refined.mesh);
    }
    const auto edge = static_cast<double>(std::cbrt(volume(input.mesh, 0)));
    for (const bool smooth : {false, true}) {
      SCOPED_TRACE(std::string(name) + ", size");
      const Request request{.target = {.kind = EntityKind::surface, .ids = {1}},
                            .how = Sizes{.size = edge / 2, .bias = 2},
                            .finish = {.smooth = smooth}};
      expect_linear(refine(input, request).refined.mesh);
      std::vector<std::uint8_t> flags(input.mesh.hexes.size(), 0);
      flags[3] = flags[17] = 1;
      expect_linear(adapt(input, flags, {.smooth = smooth}).refined.mesh);
    }
  }
}

TEST(Fields, others_are_interpolated_in_the_mesh_before) {
  // A quadratic field on the cylinder: off by no more than trilinear interpolation in hexes of this size is.
  MeshedModel input = test::shipped("cylinder");
  const auto square = [](const Vec3& p) { return p.x() * p.x() + p.z() * p.z() / 10; };
  Field field{"f", Field::On::node, 1, {}}, kind{"kind", Field::On::node, 1, {}, true};
  for (const Vec3& p : input.mesh.points) {
    field.values.push_back(square(p));
    kind.values.push_back(p.x() > 0 ? 3 : 8);
  }
  input.mesh.fields = {field, kind};
  const auto [low, high] = std::ranges::minmax(field.values);
  const Mesh mesh =
      refine(input, {.target = {.kind = EntityKind::volume, .ids = {1}}, .finish = {.smooth = true}}).refined.mesh;
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    EXPECT_NEAR(mesh.fields[0].values[n], square(mesh.points[n]), 0.03 * (high - low)) << n;
    EXPECT_TRUE(mesh.fields[1].values[n] == 3 || mesh.fields[1].values[n] == 8) << n;
  }
}

TEST(Fields, and_all_that_came_with_an_Exodus_file_are_carried) {
  const auto file = test::output_folder() / "all.e", out = file.parent_path() / "out.e";
  write_mesh(file, test::with_extras(), nullptr);
  MeshedModel input{read_mesh(file).mesh, nullptr, {}};
  FacetResult skin = associate_with_own_skin(input.mesh);
  input.model = skin.model;
  input.association = skin.association;
  const auto refined = refine(input, {.target = {.kind = EntityKind::hex, .ids = {0, 3}}, .finish = {.smooth = true}});
  EXPECT_TRUE(write_mesh(out, refined.refined.mesh, nullptr).empty());
  const MeshFile back = read_mesh(out);
  EXPECT_TRUE(back.notices.empty());
  const Mesh& mesh = back.mesh;
  ASSERT_TRUE(mesh.results);
  const FileResults& is = *mesh.results;
  EXPECT_EQ(is.times, (std::vector<double>{0, 1, 2.5}));
  for (std::size_t t = 0; t < 3; ++t) {
    for (Index n = 0; n < mesh.n_nodes(); ++n)
      ASSERT_NEAR((*is.on_nodes.at(0).at[t])[n], is.times[t] * mesh.points[n].x(), 1e-12);
    for (Index h = 0; h < mesh.n_hexes(); ++h) {
      double x = 0;
      for (const Index n : mesh.hexes[h]) x += mesh.points[n].x() / 8;
      ASSERT_EQ(std::isnan((*is.on_hexes.at(0).at[t])[h]), x > 2);
    }
    EXPECT_EQ(*is.of_all.at(0).at[t], std::vector<double>{is.times[t] * is.times[t]});
    const SetExtras& ends = is.node_sets.at(1);
    for (std::size_t i = 0; i < ends.nodes.size(); ++i)
      ASSERT_NEAR((*ends.variables.at(0).at[t])[i], is.times[t] * mesh.points[ends.nodes[i]].y(), 1e-12);
  }
  const SetExtras &ends = is.node_sets.at(1), &hot = is.side_sets.at(0);
  EXPECT_GT(ends.nodes.size(), 9u);
  for (std::size_t i = 0; i < ends.nodes.size(); ++i)
    ASSERT_NEAR(ends.factors[i], test::load(mesh.points[ends.nodes[i]]), 1e-12);
  ASSERT_EQ(hot.sides.size(), mesh.side_sets[0].sides.size());
  EXPECT_GT(hot.sides.size(), 8u);
  for (std::size_t i = 0; i < hot.sides.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k)
      ASSERT_NEAR(hot.factors[4 * i + k],
                  test::load(mesh.points[mesh.hexes[hot.sides[i].hex][io::exodus_cycle(hot.sides[i].face)[k]]]), 1e-12);
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    const bool right = std::ranges::binary_search(mesh.blocks[1].hexes, h);
    EXPECT_EQ(std::isnan((*is.attributes.at(0).at[0])[h]), !right);
  }
}

TEST(Fields, a_patch_gives_what_the_whole_gives) {
  MeshedModel input = test::brick(30, 30, 30);
  add_linear(input.mesh);
  for (double& value : input.mesh.fields[0].values) value = value * value;
  Request request{.target = {.kind = EntityKind::hex, .ids = {13000, 13001, 13900}}, .finish = {.smooth = true}};
  const Mesh by_patch = refine(input, measured(input), request).refined.mesh;
  EXPECT_TRUE(by_patch == refine(input, request).refined.mesh);
}

}  // namespace
}  // namespace hextwist
