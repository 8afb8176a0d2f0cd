// What files say of elements, through what changes the mesh: loads of .inp on their faces, materials.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <map>
#include <sstream>

#include "session_fixture.h"

namespace hextwist {
namespace {

std::string text_in(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// What *DLOAD lines of a file add up to, read anew: elements, sets and faces as Abaqus numbers them (Abaqus Elements
/// Guide, "Three-dimensional solid element library").
struct Pressure {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  double area = 0;
};
Pressure pressure_of(const std::filesystem::path& file) {
  constexpr int faces[6][4] = {{1, 2, 3, 4}, {5, 8, 7, 6}, {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 8, 4}, {4, 8, 5, 1}};
  std::map<int, Vec3> points;
  std::map<int, std::vector<int>> hexes;
  std::map<std::string, std::vector<int>> sets;
  Pressure sum;
  std::istringstream lines(text_in(file));
  std::string line, keyword, set;
  while (std::getline(lines, line)) {
    if (line.starts_with("**")) continue;
    std::vector<std::string> words;
    std::istringstream parts(line);
    for (std::string word; std::getline(parts, word, ',');) {
      std::erase(word, ' ');
      words.push_back(word);
    }
    if (line.starts_with("*")) {
      keyword = words[0];
      set.clear();
      for (const std::string& word : words)
        if (word.starts_with("ELSET=")) set = word.substr(6);
    } else if (keyword == "*NODE") {
      points[std::stoi(words[0])] = Vec3(std::stod(words[1]), std::stod(words[2]), std::stod(words[3]));
    } else if (keyword == "*ELEMENT") {
      auto& nodes = hexes[std::stoi(words[0])];
      for (std::size_t i = 1; i < words.size(); ++i) nodes.push_back(std::stoi(words[i]));
      sets[set].push_back(std::stoi(words[0]));
    } else if (keyword == "*ELSET") {
      for (const std::string& word : words)
        if (!word.empty()) sets[set].push_back(std::stoi(word));
    } else if (keyword == "*DLOAD") {
      for (const int element : sets.at(words[0])) {
        const int* face = faces[words.at(1).at(1) - '1'];
        const auto at = [&](int i) { return points.at(hexes.at(element)[static_cast<std::size_t>(face[i] - 1)]); };
        for (const auto& [i, k] : {std::pair(1, 2), {2, 3}}) {  // as triangles, of which the middle is where it acts
          const Vec3 inwards = (at(i) - at(0)).cross(at(k) - at(0)) / 2, middle = (at(0) + at(i) + at(k)) / 3;
          sum.force += std::stod(words.at(2)) * inwards;
          sum.moment += std::stod(words.at(2)) * middle.cross(inwards);
          sum.area += inwards.norm();
        }
      }
    }
  }
  return sum;
}

const char* const two_hexes =
    "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n9,2,0,0\n10,2,1,0\n11,2,0,1\n"
    "12,2,1,1\n*ELEMENT, TYPE=C3D8, ELSET=A\n1,1,2,3,4,5,6,7,8\n2,2,9,10,3,6,11,12,7\n*ELSET, ELSET=LAST\n2\n"
    "*MATERIAL, NAME=M\n*ELASTIC\n1000.,.3\n*SOLID SECTION, ELSET=A, MATERIAL=M\n*STEP\n*STATIC\n*DLOAD\n"
    "A, P2 , 1.5\nLAST,P4,0.25\nA,GRAV,0.,0.,0.,-1.\n*DLOAD, OP=NEW\nLAST, P4, 2.\n*END STEP\n";

TEST(FaceLoads, stay_on_their_faces) {
  const auto folder = test::folder();
  const auto first = test::written("a.inp", two_hexes);
  // Without the line of gravity, which the judge does not know.
  const auto judged = [&](const std::filesystem::path& file) {
    std::string text = text_in(file), kept;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
      if (line.find("GRAV") == std::string::npos) kept += line + "\n";
    return pressure_of(test::written("judged.inp", kept));
  };
  const Pressure before = judged(first);
  EXPECT_NEAR(before.area, 2 + 1 + 1, 1e-12);
  for (const std::string commands :
       {"refine hex (at 0.5 0.5 0.5)", "refine volume all", "refine node 9 numsplit 2", "refine surface 3 graded",
        "refine hex (at 1.5 0.5 0.5) numsplit 2; coarsen hex all"}) {
    SCOPED_TRACE(commands);
    std::filesystem::path from = first;
    for (int round = 0; round < 2; ++round) {  // what was written is read like any other
      Session session;
      session.import_mesh(from);
      session.run(commands);
      from = folder / ("fine" + std::to_string(round) + ".inp");
      session.export_mesh(from);
      const Pressure after = judged(from);
      EXPECT_NEAR((after.force - before.force).norm(), 0, 1e-9);
      EXPECT_NEAR((after.moment - before.moment).norm(), 0, 1e-9);
      EXPECT_NEAR(after.area, before.area, 1e-9);
      EXPECT_EQ(session.meshed().mesh.side_sets.size(), 2U);
      EXPECT_EQ(session.meshed().mesh.blocks.size(), 2U);
    }
  }
}

TEST(FaceLoads, go_along_where_a_mesh_is_reflected) {
  const auto folder = test::folder();
  const auto first =
      test::written("a.inp", std::string(two_hexes).replace(std::string(two_hexes).find("A,GRAV"), 20, ""));
  const Pressure before = pressure_of(first);
  Session session;
  session.import_mesh(first);
  session.run("reflect model x");
  session.export_mesh(folder / "b.inp");
  const Pressure after = pressure_of(folder / "b.inp");
  EXPECT_NEAR((after.force - Vec3(-before.force.x(), before.force.y(), before.force.z())).norm(), 0, 1e-12);
  EXPECT_NEAR(after.area, before.area, 1e-12);
}

TEST(FaceLoads, of_nodes_and_directions_in_cards_are_told) {
  const auto folder = test::folder();
  const auto file = test::written(
      "a.inp", std::string(two_hexes) + "*STEP\n*STATIC\n*NSET, NSET=TOP\n5,6\n*CLOAD\nTOP, 3, -1.\n*END STEP\n");
  Session session;
  std::string told;
  SessionCallbacks callbacks;
  callbacks.notice = [&](const std::string& line) { told += line + "\n"; };
  session.set_callbacks(callbacks);
  session.import_mesh(file);
  EXPECT_NE(told.find("*CLOAD: a load on a node set is the same at each node"), std::string::npos) << told;
  EXPECT_NE(told.find("loads on faces of elements are on side sets here: A_S2, LAST_S4"), std::string::npos) << told;
  told.clear();
  session.run("rotate model 90 about x");
  EXPECT_NE(told.find("cards of the .inp file stay as they were read"), std::string::npos) << told;
}

/// Where groups have hexes, materials are a field (io/hex_numbers.h).
TEST(HexNumbers, are_carried_by_refinement_into_the_file) {
  const auto folder = test::folder();
  Mesh two = test::grid(2, 1, 1);
  two.blocks = {{1, "CE", {1}}};
  two.fields = {{"material", Field::On::hex, 1, {3, 7}, true}};
  for (const std::string name : {".cdb", ".unv"}) {
    SCOPED_TRACE(name);
    Session session;
    session.take(two, nullptr);
    session.export_mesh(folder / ("a" + name));
    session.import_mesh(folder / ("a" + name));
    session.run("refine hex (at 0.5 0.5 0.5)");
    session.export_mesh(folder / ("b" + name));
    session.import_mesh(folder / ("b" + name));
    const Mesh& mesh = session.meshed().mesh;
    ASSERT_GT(mesh.n_hexes(), 27);
    const auto material = std::ranges::find(mesh.fields, "material", &Field::name);
    ASSERT_NE(material, mesh.fields.end());
    for (Index h = 0; h < mesh.n_hexes(); ++h) {
      double x = 0;
      for (const Index n : mesh.hexes[h]) x += mesh.points[n].x() / 8;
      EXPECT_EQ(material->values[static_cast<std::size_t>(h)], x > 1 ? 7 : 3);
    }
  }
}

}  // namespace
}  // namespace hextwist
