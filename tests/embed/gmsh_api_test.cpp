// Gmsh's current model through its C++ interface. What comes out is checked more closely from Python (gmsh_test.py);
// both stand on the same functions.
#include <gmsh.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "hextwist/embed/gmsh.h"
#include "support/checkers.h"

namespace hextwist::test {
namespace {

namespace model = gmsh::model;

class GmshModelInPlace : public testing::Test {
 protected:
  void SetUp() override {
    gmsh::initialize();
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::model::add("box");
    model::occ::addBox(0, 0, 0, 3, 2, 1);
    model::occ::synchronize();
    gmsh::vectorpair entities;
    model::getEntities(entities);
    for (const auto& [dim, tag] : entities) {
      if (dim == 1) model::mesh::setTransfiniteCurve(tag, 4);
      if (dim == 2) model::mesh::setTransfiniteSurface(tag), model::mesh::setRecombine(2, tag);
      if (dim == 3) model::mesh::setTransfiniteVolume(tag);
    }
    model::mesh::generate(3);
  }
  void TearDown() override { gmsh::finalize(); }

  using Entity =
      std::tuple<int, int, std::vector<std::size_t>, std::vector<double>, std::vector<double>, std::vector<int>,
                 std::vector<std::vector<std::size_t>>, std::vector<std::vector<std::size_t>>>;
  static std::vector<Entity> snapshot() {
    std::vector<Entity> result;
    gmsh::vectorpair entities;
    model::getEntities(entities);
    for (const auto& [dim, tag] : entities) {
      Entity entity;
      auto& [d, t, nodes, coord, parametric, types, tags, of] = entity;
      d = dim;
      t = tag;
      model::mesh::getNodes(nodes, coord, parametric, dim, tag, false, true);
      model::mesh::getElements(types, tags, of, dim, tag);
      result.push_back(std::move(entity));
    }
    return result;
  }
  static std::string error(const std::string& commands) {
    try {
      refine_gmsh(commands);
    } catch (const Error& thrown) {
      return thrown.what();
    }
    return "no error";
  }
};

TEST_F(GmshModelInPlace, is_refined_entity_by_entity) {
  refine_gmsh("refine curve 5 numsplit 2");
  std::set<std::size_t> seen;
  std::size_t n_hexes = 0;
  for (const auto& [dim, tag, nodes, coord, parametric, types, tags, of] : snapshot()) {
    for (const std::size_t node : nodes) EXPECT_TRUE(seen.insert(node).second) << node;
    ASSERT_EQ(types.size(), 1u) << dim << ' ' << tag;
    if (dim == 3) n_hexes = tags[0].size();
    if (dim == 0 || dim == 3 || nodes.empty()) continue;
    ASSERT_EQ(parametric.size(), nodes.size() * static_cast<std::size_t>(dim));
    std::vector<double> value;
    model::getValue(dim, tag, parametric, value);
    for (std::size_t i = 0; i < value.size(); ++i) EXPECT_NEAR(value[i], coord[i], 1e-9);
  }
  EXPECT_GT(n_hexes, 27u);
  std::vector<double> jacobians, determinants, coord, points, weights;
  model::mesh::getIntegrationPoints(5, "Gauss4", points, weights);
  model::mesh::getJacobians(5, points, jacobians, determinants, coord);
  EXPECT_GT(std::ranges::min(determinants), 0);
}

TEST_F(GmshModelInPlace, goes_out_and_in_unchanged) {
  const auto before = snapshot();
  Session session;
  const GmshLink link = take_from_gmsh(session);
  EXPECT_TRUE(link.on_cad);
  EXPECT_TRUE(session.has_cad());
  EXPECT_TRUE(conformal(session.meshed().mesh));
  put_into_gmsh(session, link);
  auto after = snapshot();
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    // The order within an entity is ours; what there is is the same.
    const auto elements = [](const Entity& entity) {
      std::set<std::pair<std::size_t, std::set<std::size_t>>> result;
      const auto& [d, t, nodes, coord, parametric, types, tags, of] = entity;
      for (std::size_t k = 0; k < tags.size(); ++k) {
        const std::size_t width = of[k].size() / tags[k].size();
        for (std::size_t e = 0; e < tags[k].size(); ++e)
          result.insert({tags[k][e],
                         {of[k].begin() + static_cast<std::ptrdiff_t>(width * e),
                          of[k].begin() + static_cast<std::ptrdiff_t>(width * (e + 1))}});
      }
      return result;
    };
    EXPECT_EQ(elements(after[i]), elements(before[i]));
    EXPECT_EQ(std::set(std::get<2>(after[i]).begin(), std::get<2>(after[i]).end()),
              std::set(std::get<2>(before[i]).begin(), std::get<2>(before[i]).end()));
  }
}

TEST_F(GmshModelInPlace, stays_as_it_was_when_refining_fails) {
  const auto before = snapshot();
  EXPECT_NE(error("refine curve 99").find("curve 99 does not exist"), std::string::npos);
  EXPECT_NE(error("refine hex 1; import mesh 'nowhere.msh'").find("nowhere.msh"), std::string::npos);
  EXPECT_EQ(error("reset"), "the session has no mesh to put back");
  EXPECT_EQ(error("reset; create brick x 1 y 1 z 1 interval 1 1 1"),
            "the session is on another model than Gmsh's by now: its mesh can't be put back");
  EXPECT_EQ(snapshot(), before);
  model::mesh::clear();
  EXPECT_EQ(error("refine hex 1"), "there are no hexes in Gmsh's model: generate the mesh first");
}

/// One hex with all its entities, as arrays.
GmshModel one_hex() {
  GmshModel result;
  GmshEntity volume;
  volume.dim = 3;
  volume.tag = 4;
  for (int i = 0; i < 8; ++i) {
    volume.node_tags.push_back(static_cast<std::size_t>(10 * i + 10));
    for (const int x : {i & 1, i >> 1 & 1, i >> 2}) volume.coord.push_back(x);
  }
  volume.element_types = {5};
  volume.element_tags = {{17}};
  volume.element_nodes = {{10, 20, 40, 30, 50, 60, 80, 70}};
  result.entities.push_back(volume);
  return result;
}

GmshEntity element(int dim, int tag, int type, std::vector<std::size_t> nodes) {
  GmshEntity entity;
  entity.dim = dim;
  entity.tag = tag;
  entity.element_types = {type};
  entity.element_tags = {{5}};
  entity.element_nodes = {std::move(nodes)};
  return entity;
}

std::string refusal(const GmshModel& gmsh) {
  Session session;
  try {
    take_gmsh(session, gmsh, "");
  } catch (const Error& error) {
    EXPECT_EQ(session.meshed().mesh.n_hexes(), 0);
    return error.what();
  }
  return "no error";
}

TEST(GmshExchange, names_what_it_refuses) {
  EXPECT_EQ(refusal({}), "there are no hexes in Gmsh's model: generate the mesh first");
  GmshModel gmsh = one_hex();
  EXPECT_EQ(refusal(gmsh), "no error");
  gmsh.entities.push_back(element(3, 5, 4, {10, 20, 30, 50}));
  EXPECT_EQ(refusal(gmsh), "element 5 of volume 5 is a tetrahedron; only 8-node hexes in volumes are accepted");
  gmsh.entities.back() = element(2, 6, 3, {10, 20, 40, 80});
  EXPECT_EQ(refusal(gmsh), "element 5 of surface 6 is not a side of a hex");
  gmsh.entities.back() = element(2, 6, 2, {10, 20, 40});
  EXPECT_EQ(refusal(gmsh), "element 5 of surface 6 is a triangle, which is not a side of a hex");
  gmsh.entities.back() = element(1, 7, 1, {10, 40});
  EXPECT_EQ(refusal(gmsh), "element 5 of curve 7 is not an edge of a hex");
  gmsh.entities.back() = element(1, 7, 1, {10, 99});
  EXPECT_EQ(refusal(gmsh), "element 5 of curve 7 is not an edge of a hex");
  gmsh.entities.back() = element(1, 7, 8, {10, 20, 30});
  EXPECT_EQ(refusal(gmsh), "element 5 of curve 7 is a 3-node line, which is not an edge of a hex");
  gmsh.entities.back() = element(2, 6, 2, {91, 92, 93});  // has nothing to do with the hex
  EXPECT_EQ(refusal(gmsh), "no error");
  gmsh = one_hex();
  gmsh.entities[0].node_tags.pop_back();
  EXPECT_EQ(refusal(gmsh), "node 80 of a hex is in no entity of Gmsh's model");
}

TEST(GmshExchange, new_nodes_and_elements_get_tags_above_all_that_are_in_use) {
  GmshModel gmsh = one_hex();
  GmshEntity lone;
  lone.dim = 0;
  lone.tag = 3;
  lone.node_tags = {85};
  lone.coord = {9, 9, 9};
  lone.element_types = {15};
  lone.element_tags = {{400}};
  lone.element_nodes = {{85}};
  gmsh.entities.push_back(lone);
  Session session;
  const GmshLink link = take_gmsh(session, gmsh, "");
  EXPECT_EQ(link.other_nodes, std::vector<std::size_t>{85});
  session.run("refine volume all");
  const auto fresh = put_gmsh(session, link);
  ASSERT_EQ(fresh.size(), 1u);  // the lone point is not touched
  EXPECT_EQ(std::pair(fresh[0].dim, fresh[0].tag), std::pair(3, 4));
  std::set<std::size_t> nodes(fresh[0].node_tags.begin(), fresh[0].node_tags.end());
  EXPECT_EQ(nodes.size(), 27u);
  for (std::size_t old = 10; old <= 80; old += 10) EXPECT_TRUE(nodes.contains(old));
  EXPECT_FALSE(nodes.contains(85));
  EXPECT_EQ(*nodes.rbegin(), 85u + 19);
  EXPECT_EQ(fresh[0].element_tags[0].front(), 401u);
  EXPECT_EQ(fresh[0].element_tags[0].size(), 8u);
}

}  // namespace
}  // namespace hextwist::test
