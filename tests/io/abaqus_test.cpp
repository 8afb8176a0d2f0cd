#include "io/io_support.h"

namespace hextwist {
namespace {

TEST(abaqus_files, a_mesh_with_sets_comes_back) {
  for (unsigned seed = 1; seed < 6; ++seed) {
    SCOPED_TRACE(seed);
    Mesh mesh = test::rich_mesh(seed, seed % 2);
    mesh.fields.clear();
    mesh.blocks.push_back({71, "STEEL (hot)", {0}});
    mesh.blocks.push_back({72, "eall", {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}});
    mesh.node_sets.push_back({10, "none", {}});
    const auto file = test::output_folder() / "mesh.inp";
    write_mesh(file, mesh, nullptr);
    const auto back = read_mesh(file);
    EXPECT_TRUE(test::same_mesh(mesh, test::with_exact_points(back.mesh, mesh)));
    EXPECT_TRUE(back.tags.empty());
    EXPECT_TRUE(back.notices.empty());
  }
}

/// The numbers of a file's *NODE lines as they stand there, ids left out.
std::vector<std::string> coordinates_in(const std::filesystem::path& file) {
  std::vector<std::string> result;
  std::istringstream lines(test::text_of(file));
  std::string line, word;
  bool nodes = false;
  while (std::getline(lines, line)) {
    if (line[0] == '*') nodes = line.starts_with("*NODE");
    std::istringstream words(line);
    for (int k = 0; nodes && line[0] != '*' && std::getline(words, word, ','); ++k)
      if (k > 0) result.push_back(word.substr(1));
  }
  return result;
}

TEST(abaqus_files, numbers_are_as_near_as_twenty_characters_can_be) {
  // CalculiX reads 2.449293598294707e-15 as 0.2449.
  const std::vector<std::pair<double, std::string>> known = {{2.449293598294707e-15, "2.44929359829471e-15"},
                                                             {-2.449293598294707e-15, "-2.4492935982947e-15"},
                                                             {0.1, "0.1"},
                                                             {-1.2345678901234567, "-1.2345678901234567"},
                                                             {0.012345678901234567, "0.012345678901234567"},
                                                             {-0.012345678901234567, "-0.01234567890123457"},
                                                             {9.99999999999999999e-10, "1e-09"},
                                                             {9.9999999999999988e-06, "1e-05"},
                                                             {-1.2345678901234567e+150, "-1.234567890123e+150"},
                                                             {4.9e-324, "0"},
                                                             {-9.99e-100, "0"},
                                                             {1e-99, "1e-99"},
                                                             {1e300, "1e+300"},
                                                             {123456789012345680000.0, "1.23456789012346e+20"}};
  std::mt19937_64 random(7);
  std::vector<double> values;
  for (const auto& [value, text] : known) values.push_back(value);
  std::uniform_real_distribution<double> mantissa(-10, 10);
  for (int i = 0; i < 30000; ++i)
    values.push_back(mantissa(random) * std::pow(10.0, static_cast<int>(random() % 240) - 120));
  Mesh mesh = test::grid(1, 1, 1);
  while (values.size() % 3) values.push_back(1);
  for (std::size_t i = 0; i < values.size(); i += 3) mesh.points.emplace_back(values[i], values[i + 1], values[i + 2]);
  const auto file = test::output_folder() / "mesh.inp";
  write_mesh(file, mesh, nullptr);
  const auto texts = coordinates_in(file);
  ASSERT_EQ(texts.size(), 24 + values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string& text = texts[24 + i];
    const double x = values[i], read = std::stod(text);
    ASSERT_LE(text.size(), 20u) << x;
    if (i < known.size()) {
      EXPECT_EQ(text, known[i].second);
    }
    const auto e = text.find('e');
    if (std::abs(x) < 1e99 && e != std::string::npos) {
      EXPECT_EQ(text.size(), e + 4) << text;
    }
    if (std::abs(x) < 1e-99) {
      EXPECT_EQ(text, "0");
      continue;
    }
    // Fourteen digits with an exponent, and as many as a double has where none is needed.
    ASSERT_LE(std::abs(read - x), (std::abs(x) < 1e99 ? 1 : 10) * 0.51e-13 * std::abs(x)) << text;
    if (std::abs(x) >= 0.1 && std::abs(x) < 1e17) {
      ASSERT_EQ(read, x) << text;
    }
  }
}

TEST(abaqus_files, ids_beyond_what_abaqus_takes_are_counted_anew_with_a_note) {
  Mesh mesh = test::grid(2, 1, 1);
  mesh.hex_ids = {999'999'999, 1'000'000'000};
  mesh.node_sets = {{1, "one", {11}}};
  const auto file = test::output_folder() / "mesh.inp";
  EXPECT_EQ(
      write_mesh(file, mesh, nullptr),
      (std::vector<std::string>{"hex id 1000000000 is more than Abaqus takes: hexes are counted from 1 in the file"}));
  EXPECT_EQ(read_mesh(file).mesh.hex_ids, std::vector<std::int64_t>{});
  mesh.hex_ids = {5, 999'999'999};
  EXPECT_EQ(write_mesh(file, mesh, nullptr), std::vector<std::string>{});
  EXPECT_EQ(read_mesh(file).mesh.hex_ids, mesh.hex_ids);
}

TEST(abaqus_files, calculix_has_every_node_where_it_is) {
  if (std::system("command -v ccx > /dev/null 2>&1") != 0) GTEST_SKIP() << "no CalculiX";
  const auto folder = test::output_folder();
  Mesh mesh = test::grid(2, 2, 2);
  for (Vec3& p : mesh.points)
    for (double& x : p) x = x == 0 ? 2.449293598294707e-15 : x == 1 ? 0.012345678901234567 : 2.0000000000000004e2;
  write_mesh(folder / "mesh.inp", mesh, nullptr);
  test::write_text(folder / "job.inp",
                   "*INCLUDE, INPUT=mesh.inp\n*MATERIAL, NAME=M\n*ELASTIC\n210000,0.3\n*SOLID SECTION, ELSET=EALL, "
                   "MATERIAL=M\n*BOUNDARY\nNALL,1,3\n*STEP\n*STATIC\n*NODE FILE\nU\n*END STEP\n");
  ASSERT_EQ(std::system(("cd " + folder.string() + " && ccx -i job > log.txt 2>&1").c_str()), 0)
      << test::text_of(folder / "log.txt");
  // Lines "    2C" and then " -1", the node in ten places and coordinates in twelve each.
  std::istringstream lines(test::text_of(folder / "job.frd"));
  std::string line;
  std::size_t n_seen = 0;
  while (std::getline(lines, line) && !line.starts_with("    2C")) {
  }
  while (std::getline(lines, line) && line.starts_with(" -1")) {
    const Vec3& p = mesh.points[std::stoul(line.substr(3, 10)) - 1];
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(std::stod(line.substr(13 + 12 * static_cast<std::size_t>(axis), 12)), p[axis],
                  1e-5 * std::abs(p[axis]) + 1e-20);
    ++n_seen;
  }
  EXPECT_EQ(n_seen, mesh.points.size());
}

TEST(abaqus_files, faces_lie_where_their_numbers_say) {
  // S1 is nodes 1 2 3 4 (z = 0), S2 5 8 7 6 (z = 1), S3 1 5 6 2 (y = 0), S4 2 6 7 3 (x = 1), S5 (y = 1), S6 (x = 0).
  Mesh mesh = test::grid(1, 1, 1);
  for (int f = 0; f < 6; ++f) mesh.side_sets.push_back({f + 1, "", {{0, f}}});
  const auto file = test::output_folder() / "mesh.inp";
  write_mesh(file, mesh, nullptr);
  const std::string text = test::text_of(file);
  const std::array<int, 6> number = {6, 4, 3, 5, 1, 2};  // x = 0, x = 1, y = 0, ...
  for (int f = 0; f < 6; ++f)
    EXPECT_NE(text.find("NAME=SIDESET_" + std::to_string(f + 1) + "\n1, S" + std::to_string(number[f]) + "\n"),
              std::string::npos);
  EXPECT_TRUE(test::same_mesh(mesh, read_mesh(file).mesh));
}

constexpr const char* cube_nodes =
    "*Heading\n some text\n** a comment\n*node, nset=Corners\n 1, 0, 0., 0\n 2, 1.,0,0\n*** odd\n3,1,1,0\n4,0,1,0\n"
    "5,0,0,1\n6,+1.0E0,0,1\n7,1,1,1.d0\n8,0,1,1,\n";

TEST(abaqus_files, other_peoples_files_are_understood) {
  const auto folder = test::output_folder();
  test::write_text(folder / "more.inc", "*nset, NSET=Ends\n 1,\n 8\n");
  const auto file = test::write_text(
      folder / "a.inp", std::string(cube_nodes) +
                            "*Element, type=C3D8R,\n elset=\"the brick\"\n 4, 1,2,3,4,\n 5,6,7,8\n"
                            "*Element, type=S4R, elset=lid\n7, 5,6,7,8\n*Element, type=B31, elset=beams\n9, 1, 2\n"
                            "*ELSET, ELSET=ALL, GENERATE\n4, 4, 1\n*ELSET, ELSET=SAME\nALL,\n"
                            "*NSET, NSET=EVEN, GENERATE\n2, 8, 2\n*Include, input=more.inc\n"
                            "*SURFACE, NAME=LOAD, TYPE=ELEMENT\nall, S1\n4, S6\n*SURFACE, NAME=SKIN\nALL,\n"
                            "*SURFACE, TYPE=NODE, NAME=POINTS\nEven, 1.\n3\n*STEP\n*STATIC\n1., 2.\n*END STEP\n");
  const auto read = read_mesh(file);
  EXPECT_EQ(read.mesh.hexes[0], (Hex{0, 1, 3, 2, 4, 5, 7, 6}));
  EXPECT_EQ(read.mesh.points[6], Vec3(1, 1, 1));
  EXPECT_EQ(read.mesh.hex_ids, (std::vector<std::int64_t>{4}));
  EXPECT_EQ(read.mesh.blocks, (std::vector<Block>{{1, "the brick", {0}}, {2, "ALL", {0}}, {3, "SAME", {0}}}));
  EXPECT_EQ(read.mesh.node_sets, (std::vector<NodeSet>{{1, "Corners", {0, 1, 2, 3, 4, 5, 6, 7}},
                                                       {2, "EVEN", {1, 3, 5, 7}},
                                                       {3, "Ends", {0, 7}},
                                                       {4, "POINTS", {1, 2, 3, 5, 7}}}));
  EXPECT_EQ(read.mesh.side_sets, (std::vector<SideSet>{{1, "lid", {{0, 5}}},
                                                       {2, "LOAD", {{0, 0}, {0, 4}}},
                                                       {3, "SKIN", {{0, 0}, {0, 1}, {0, 2}, {0, 3}, {0, 4}, {0, 5}}}}));
  EXPECT_EQ(read.notices, (std::vector<std::string>{"dropped 1 elements of type B31"}));
}

TEST(abaqus_files, instances_are_placed_side_by_side) {
  const auto file = test::write_text(
      test::output_folder() / "a.inp",
      "*PART, NAME=Brick\n" + std::string(cube_nodes) +
          "*ELEMENT, TYPE=C3D8, ELSET=E\n1, 1,2,3,4,5,6,7,8\n*END PART\n*ASSEMBLY, NAME=A\n"
          "*INSTANCE, NAME=one, PART=brick\n*END INSTANCE\n*INSTANCE, NAME=two, PART=Brick\n2., 0., 0.\n"
          "2., 0., 0., 2., 0., 1., 90.\n*END INSTANCE\n*NSET, NSET=TIP, INSTANCE=two\n2\n"
          "*ELSET, ELSET=BOTH\none.E, two.1\n*NODE\n1, 5., 5., 5.\n*END ASSEMBLY\n");
  const auto read = read_mesh(file);
  ASSERT_EQ(read.mesh.n_hexes(), 2);
  ASSERT_EQ(read.mesh.n_nodes(), 16);
  EXPECT_DOUBLE_EQ(volume(read.mesh, 0), 1);
  EXPECT_DOUBLE_EQ(volume(read.mesh, 1), 1);
  EXPECT_NEAR((read.mesh.points[9] - Vec3(2, 1, 0)).norm(), 0,
              1e-15);  // (1 0 0) moved to (3 0 0), turned about (2 0 0)
  EXPECT_EQ(read.mesh.blocks, (std::vector<Block>{{1, "one.E", {0}}, {2, "two.E", {1}}, {3, "BOTH", {0, 1}}}));
  ASSERT_EQ(read.mesh.node_sets.size(), 3u);
  EXPECT_EQ(read.mesh.node_sets[2], (NodeSet{3, "TIP", {9}}));
  EXPECT_EQ(read.notices, (std::vector<std::string>{"dropped 1 nodes of the assembly (reference points)"}));
}

TEST(abaqus_files, what_is_wrong_is_said_with_its_line) {
  const auto folder = test::output_folder();
  const auto says = [&](const std::string& rest, const std::string& expected) {
    const auto file = test::write_text(folder / "bad.inp", cube_nodes + rest);
    EXPECT_EQ(test::refusal(file), file.string() + expected);
  };
  const std::string hex = "*ELEMENT, TYPE=C3D8\n1, 1,2,3,4,5,6,7,8\n";
  says("*ELEMENT, TYPE=C3D8\n1, 1,2,3,4,5,6,7,9\n", ":15: element 1 names node 9, which is not there");
  says("*ELEMENT, TYPE=C3D8\n1, 1,2,3,4,5,6,7\n", ":15: element 1 has 7 of 8 nodes");
  says("*ELEMENT, TYPE=C3D8\n1, 1,2,3,4,5,6,7,8,9\n", ":15: element 1 has more nodes than a C3D8");
  says("*ELEMENT, TYPE=C3D20R\n8, 1,2\n", ":15: element 8 is of type C3D20R; only 8-node hexes are accepted");
  says("*ELEMENT, TYPE=C3D4\n3, 1,2,3,5\n", ":15: element 3 is of type C3D4; only 8-node hexes are accepted");
  says("*ELEMENT, TYPE=C3D6\n3, 1,2,3,5,6,7\n", ":15: element 3 is of type C3D6; only 8-node hexes are accepted");
  says("*ELEMENT\n1,2\n", ":14: *ELEMENT without TYPE=");
  says("", ": there is no hex in the file");
  says(hex + "*NODE\n9, 0, 1, nan\n", ":17: a coordinate of node 9 is not finite");
  says(hex + "*NODE\n10, 0, 1, 2\n7, 0, 1, 1e999\n", ":18: a coordinate of node 7 is not finite");
  says(hex + "*NODE\n9, 0, 1, 2\n7, 0, 1, 2\n", ":18: node id 7 occurs twice");
  says(hex + "*NODE\n0, 0, 1, 2\n", ":17: node id 0 is not positive");
  says(hex + "1, 1,2,3,4,5,6,7,8\n", ":16: element id 1 occurs twice");
  says(hex + "*NODE\n9, 0 1\n", ":17: expected a comma, found '1'");
  says(hex + "*ELSET, ELSET=A\nB\n", ":17: there is no set 'B'");
  says(hex + "*ELSET, ELSET=A\nA\n", ":16: set 'A' contains itself");
  says(hex + "*ELSET, ELSET=A, GENERATE\n1\n", ":17: GENERATE needs a first and a last id");
  says(hex + "*ELSET, ELSET=A, GENERATE\n1, 9, 0\n", ":17: a range that cannot be generated");
  says(hex + "*SURFACE, NAME=A\n1, S7\n", ":17: face 'S7' of a hex; known are S1 to S6");
  says(hex + "*NGEN\n1, 2\n", ":16: *NGEN is not supported: nodes or elements would be missing or misplaced");
  says(hex + "*INSTANCE, NAME=A, PART=B\n", ":16: there is no part 'B'");
  const auto other = test::write_text(folder / "other.inp", "solid\n");
  EXPECT_EQ(test::refusal(other), other.string() + ":1: not an Abaqus file: expected a keyword, found 'solid'");
}

TEST(abaqus_files, a_real_mesh_has_the_known_counts) {
  const auto data = test::data_folder();
  if (data.empty()) GTEST_SKIP() << "no folder of real meshes";
  const auto file = read_mesh(data / "mesh/hole_3d_cubit.inp");
  EXPECT_EQ(file.mesh.n_hexes(), 1032);
  EXPECT_EQ(file.mesh.n_nodes(), 1573);
  EXPECT_TRUE(test::conformal(file.mesh));
  EXPECT_TRUE(test::uninverted(file.mesh));
  ASSERT_EQ(file.mesh.blocks.size(), 1);
  EXPECT_EQ(file.mesh.blocks[0].name, "EB1");
  EXPECT_EQ(file.mesh.blocks[0].hexes.size(), 1032);
  ASSERT_EQ(file.mesh.node_sets.size(), 1);
  EXPECT_EQ(file.mesh.node_sets[0].name, "ALLNODES");
  const auto copy = test::output_folder() / "copy.inp";
  write_mesh(copy, file.mesh, nullptr);
  EXPECT_TRUE(test::same_mesh(file.mesh, read_mesh(copy).mesh));
}

}  // namespace
}  // namespace hextwist
