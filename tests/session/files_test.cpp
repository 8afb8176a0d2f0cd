// What files say beyond the mesh goes through a session: refinement, undo, another file.
#include <gtest/gtest.h>

#include <map>
#include <sstream>

#include "hextwist/io/io.h"
#include "session/session_fixture.h"

namespace hextwist {
namespace {

using Fixture = test::Fixture;

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream out;
  out << std::ifstream(file).rdbuf();
  return out.str();
}

TEST(SessionFiles, groups_of_curves_stay_groups_of_curves_with_their_tags) {
  // Along half of an edge of a brick, across its inside, of nothing; and points of the same tag.
  const std::string head =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n0 1 \"p\"\n1 1 \"half\"\n1 2 "
      "\"across\"\n1 7 \"none\"\n$EndPhysicalNames\n$Nodes\n27\n";
  std::ostringstream text;
  text << head;
  for (int n = 0; n < 27; ++n) text << n + 1 << ' ' << n % 3 << ' ' << n / 3 % 3 << ' ' << n / 9 << '\n';
  text << "$EndNodes\n$Elements\n12\n1 15 2 1 1 3\n2 1 2 1 1 1 2\n3 1 2 2 50 5 14\n4 1 2 2 50 14 23\n";
  for (int h = 0; h < 8; ++h) {
    const int a = 1 + h % 2 + 3 * (h / 2 % 2) + 9 * (h / 4);
    text << 5 + h << " 5 2 0 1";
    for (const int step : {0, 1, 4, 3, 9, 10, 13, 12}) text << ' ' << a + step;
    text << '\n';
  }
  text << "$EndElements\n";
  const auto in = test::written("in.msh", text.str());
  for (const std::string version : {"2.2", "4.1"}) {
    Fixture f;
    const auto out = test::folder() / ("out" + version + ".msh");
    f.session.run("import mesh '" + in.string() + "'; refine hex all numsplit 1; export gmsh '" + out.string() +
                  "' text version " + version);
    const std::string written = text_of(out);
    EXPECT_NE(written.find("4\n0 1 \"p\"\n1 1 \"half\"\n1 2 \"across\"\n1 7 \"none\"\n"), std::string::npos)
        << written.substr(0, 200);
    Fixture again;
    again.session.import_mesh(out);
    std::map<std::string, std::size_t> size;
    for (const NodeSet& set : again.session.meshed().mesh.node_sets) size[set.name] = set.nodes.size();
    EXPECT_EQ(size, (std::map<std::string, std::size_t>{{"p", 1}, {"half", 4}, {"across", 7}, {"none", 0}})) << version;
  }
}

TEST(SessionFiles, a_node_of_no_hex_is_nothing_to_refine) {
  std::string text = "*NODE\n";
  for (int n = 0; n < 8; ++n)
    text += std::to_string(n + 1) + ", " + std::to_string(n % 2) + ", " + std::to_string(n / 2 % 2) + ", " +
            std::to_string(n / 4) + "\n";
  text += "18, 0.5, 0.5, 0.5\n*ELEMENT, TYPE=C3D8\n1, 1,2,4,3,5,6,8,7\n*NSET, NSET=loose\n18\n";
  Fixture f;
  f.session.import_mesh(test::written("in.inp", text));
  for (const char* range : {"node 18", "node 18 depth 1", "node in nodeset 1 numsplit 2", "node 18 size 0.1"})
    EXPECT_EQ(f.error(std::string("refine ") + range), "there is nothing to refine: node 18 belongs to no hex");
  f.session.run("refine node 1 18");
  EXPECT_EQ(f.notices.back(), "node 18 belongs to no hex: nothing is refined there");
  EXPECT_EQ(f.session.meshed().mesh.n_hexes(), 4);
}

TEST(SessionFiles, abaqus_types_and_cards_come_out_of_a_refinement) {
  std::string text = "*HEADING\nmine\n*NODE\n";
  for (int n = 0; n < 12; ++n)
    text += std::to_string(n + 1) + ", " + std::to_string(n % 3) + ", " + std::to_string(n / 3 % 2) + ", " +
            std::to_string(n / 6) + "\n";
  text +=
      "*ELEMENT, TYPE=C3D8R, ELSET=left\n1, 1,2,5,4,7,8,11,10\n*ELEMENT, TYPE=C3D8I, ELSET=right\n2, "
      "2,3,6,5,8,9,12,11\n"
      "*NSET, NSET=Base\n1, 4, 7, 10\n*MATERIAL, NAME=M\n*ELASTIC\n1., 0.3\n*SOLID SECTION, ELSET=left, MATERIAL=M\n,\n"
      "*SOLID SECTION, ELSET=right, MATERIAL=M\n,\n*STEP\n*STATIC\n*BOUNDARY\nbase, 1, 3\n*DLOAD\n1, P1, 1.\n*END "
      "STEP\n";
  const auto in = test::written("in.inp", text);
  const auto out = test::folder() / "out.inp";
  Fixture f;
  f.session.run("import mesh '" + in.string() + "'; refine hex 1; export mesh '" + out.string() + "'");
  EXPECT_EQ(f.notices.back(), in.string() + ":33: 1 line of *DLOAD left out: what they are about is gone, or was cut");
  const std::string written = text_of(out);
  for (const char* part :
       {"*HEADING\nmine\n", "*ELEMENT, TYPE=C3D8R,", "*ELEMENT, TYPE=C3D8I,", "*NSET, NSET=Base\n",
        "*SOLID SECTION, ELSET=right, MATERIAL=M\n,\n*STEP\n*STATIC\n*BOUNDARY\nBase, 1, 3\n*END STEP\n"})
    EXPECT_NE(written.find(part), std::string::npos) << part;
  const auto back = read_mesh(out);
  ASSERT_EQ(back.mesh.blocks.size(), 2u);
  EXPECT_EQ(back.extras.element_types.at(2), "C3D8I");
  EXPECT_EQ(back.mesh.blocks[1].hexes.size(), 13u);
  // Another mesh has nothing of it, and undo brings it back.
  f.session.run("create brick x 1 interval 1; export mesh '" + out.string() + "' overwrite");
  EXPECT_EQ(text_of(out).find("*MATERIAL"), std::string::npos);
  f.session.run("undo; undo; export mesh '" + out.string() + "' overwrite");
  EXPECT_NE(text_of(out).find("*MATERIAL"), std::string::npos);
  EXPECT_NE(text_of(out).find("1, P1, 1."), std::string::npos);
}

TEST(SessionFiles, export_options_are_for_the_formats_that_have_them) {
  Fixture f;
  const std::string file = (test::folder() / "a").string();
  f.session.run("create brick x 2 interval 2; export gmsh '" + file + ".msh' text version 2.2; export gmsh '" + file +
                ".msh' overwrite version 4.1 binary groups only");
  EXPECT_EQ(text_of(file + ".msh").find("$MeshFormat\n4.1 1 8\n"), 0u);
  EXPECT_EQ(f.error("export mesh '" + file + ".inp' text"), "'text' is for .msh and .vtu files, not for '.inp'");
  EXPECT_EQ(f.error("export mesh '" + file + ".vtu' groups only"), "'groups' is for .msh files, not for '.vtu'");
  EXPECT_EQ(f.error("export mesh '" + file + ".vtu' version 4.1"), "'version' is for .msh files, not for '.vtu'");
  EXPECT_EQ(f.error("export mesh '" + file + ".msh' version 3 overwrite"), "versions of .msh are 2.2 and 4.1");
}

TEST(SessionFiles, lines_of_a_msh_run_as_the_curves_of_the_cad) {
  // Gmsh's own file of the cylinder names bounding entities so; hexes are the same.
  const std::string models = (std::filesystem::path(HEXTWIST_SOURCE_DIR) / "models").string();
  Fixture f;
  for (const char* name : {"cylinder", "plate_hole", "bracket"}) {
    const std::string model = models + "/" + name, file = (test::folder() / (std::string(name) + ".msh")).string();
    f.session.run("reset; import brep '" + model + ".brep'; import mesh '" + model + ".msh'; export mesh '" + file +
                  "' text");
    const auto curves_in = [](const std::string& text) {
      // Tag and bounding points of curves: the lines of $Entities after those of the points.
      std::istringstream lines(text.substr(text.find("$Entities\n") + 10));
      std::size_t n_points = 0, n_curves = 0;
      std::string line, result;
      std::getline(lines, line);
      std::istringstream(line) >> n_points >> n_curves;
      for (std::size_t i = 0; i < n_points + n_curves; ++i) {
        std::getline(lines, line);
        std::istringstream words(line);
        std::vector<std::string> all;
        for (std::string word; words >> word;) all.push_back(word);
        if (i >= n_points && std::stoi(all[0]) > 0 && all.size() > 9 && all.end()[-3] == "2")
          result += all[0] + ": " + all.end()[-2] + " " + all.end()[-1] + "\n";
      }
      return result;
    };
    const std::string expected = curves_in(text_of(model + ".msh"));
    EXPECT_FALSE(expected.empty());
    EXPECT_EQ(curves_in(text_of(file)), expected) << name;
  }
}

}  // namespace
}  // namespace hextwist
