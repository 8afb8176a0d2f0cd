#include "hextwist/mesh/others.h"
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
  EXPECT_EQ(
      read.mesh.blocks,
      (std::vector<Block>{{1, "the brick", {0}}, {2, "lid", {}}, {3, "beams", {}}, {4, "ALL", {0}}, {5, "SAME", {0}}}));
  EXPECT_EQ(read.mesh.node_sets, (std::vector<NodeSet>{{1, "Corners", {0, 1, 2, 3, 4, 5, 6, 7}},
                                                       {2, "EVEN", {1, 3, 5, 7}},
                                                       {3, "Ends", {0, 7}},
                                                       {4, "POINTS", {1, 2, 3, 5, 7}}}));
  EXPECT_EQ(read.mesh.side_sets, (std::vector<SideSet>{{1, "LOAD", {{0, 0}, {0, 4}}},
                                                       {2, "SKIN", {{0, 0}, {0, 1}, {0, 2}, {0, 3}, {0, 4}, {0, 5}}}}));
  EXPECT_EQ(others_text(read.mesh), "1 quad (S4R), 1 line (B31)");
  EXPECT_EQ(read.mesh.others->heads->sets, (std::vector<OtherSet>{{2, {0}}, {3, {1}}}));
  EXPECT_EQ(read.notices, std::vector<std::string>{});
}

TEST(abaqus_files, surfaces_may_be_made_of_others) {
  const auto folder = test::output_folder();
  const std::string text = std::string(cube_nodes) +
                           "*ELEMENT, TYPE=C3D8, ELSET=A\n4, 1,2,3,4,5,6,7,8\n"
                           "*SURFACE, NAME=BOTH, COMBINE=UNION\ntwo, THREE\n"
                           "*SURFACE, NAME=TWO\nA, S1\nA, S2\nA, S1\n*SURFACE, NAME=THREE\nA, S2\n4, S3\n"
                           "*SURFACE, NAME=SHARED, COMBINE=INTERSECTION\nTWO, THREE\n"
                           "*SURFACE, NAME=REST, TYPE=ELEMENT, COMBINE=DIFFERENCE\nBOTH,\nSHARED\n";
  const auto read = read_mesh(test::write_text(folder / "a.inp", text));
  const auto sides = [&](const std::string& name) {
    const auto set = std::ranges::find(read.mesh.side_sets, name, &SideSet::name);
    return set == read.mesh.side_sets.end() ? std::vector<Side>{{-1, 0}} : set->sides;
  };
  const Side first = sides("TWO").at(0), second = sides("SHARED").at(0), third = sides("THREE").at(0);
  EXPECT_EQ(sides("TWO"), (std::vector<Side>{first, second}));
  EXPECT_EQ(sides("SHARED"), (std::vector<Side>{second}));
  auto both = sides("BOTH"), rest = sides("REST");
  EXPECT_EQ(both.size(), 3U);
  std::erase(both, second);
  EXPECT_EQ(rest, both);
  EXPECT_TRUE(std::ranges::find(rest, third) != rest.end());
  const auto says = [&](const std::string& more, const std::string& expected) {
    EXPECT_NE(test::refusal(test::write_text(folder / "bad.inp", text + more)).find(expected), std::string::npos)
        << more;
  };
  says("*SURFACE, NAME=X, COMBINE=UNION\nNO,\n", "there is no surface 'NO' of elements");
  says("*SURFACE, NAME=X, COMBINE=SUM\nTWO,\n", "COMBINE=SUM; known are UNION, INTERSECTION and DIFFERENCE");
  says("*SURFACE, NAME=X, COMBINE=DIFFERENCE\nTWO,\n", "COMBINE=DIFFERENCE of 1 surface");
  says("*SURFACE, NAME=X, COMBINE=UNION\nY,\n*SURFACE, NAME=Y, COMBINE=UNION\nX\n", "set 'X' contains itself");
}

TEST(abaqus_files, sets_named_again_and_again_take_the_time_of_one) {
  const auto folder = test::output_folder();
  std::string text =
      std::string(cube_nodes) + "*ELEMENT, TYPE=C3D8, ELSET=E0\n4, 1,2,3,4,5,6,7,8\n*SURFACE, NAME=S0\nE0\n";
  for (int i = 1; i < 45; ++i) {
    const std::string before = std::to_string(i - 1), name = std::to_string(i);
    text += "*ELSET, ELSET=E" + name + "\nE" + before + ", E" + before + "\n";
    text += "*SURFACE, NAME=S" + name + ", COMBINE=UNION\nS" + before + ", S" + before + "\n";
  }
  const auto read = read_mesh(test::write_text(folder / "a.inp", text));
  EXPECT_EQ(read.mesh.blocks.size(), 45U);
  EXPECT_EQ(read.mesh.side_sets.back().sides.size(), 6U);
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
  ASSERT_EQ(read.mesh.n_nodes(), 17);
  EXPECT_DOUBLE_EQ(volume(read.mesh, 0), 1);
  EXPECT_DOUBLE_EQ(volume(read.mesh, 1), 1);
  EXPECT_NEAR((read.mesh.points[9] - Vec3(2, 1, 0)).norm(), 0,
              1e-15);                              // (1 0 0) moved to (3 0 0), turned about (2 0 0)
  EXPECT_EQ(read.mesh.points[16], Vec3(5, 5, 5));  // of the assembly: in no hex, and not node 1 of a brick
  EXPECT_EQ(read.mesh.blocks, (std::vector<Block>{{1, "one.E", {0}}, {2, "two.E", {1}}, {3, "BOTH", {0, 1}}}));
  ASSERT_EQ(read.mesh.node_sets.size(), 3u);
  EXPECT_EQ(read.mesh.node_sets[0].name, "one.Corners");
  EXPECT_EQ(read.mesh.node_sets[2], (NodeSet{3, "TIP", {9}}));
  EXPECT_EQ(read.notices,
            (std::vector<std::string>{"ids that occur in several places of the file are moved: of instance 'two' "
                                      "nodes by 8 elements by 1, of the assembly nodes by 16"}));
}

/// A part of two unit cubes along x, nodes 1..12 and elements 1, 2, at height z; `more` stands in it as well.
std::string bar(const std::string& name, double z, const std::string& more = "") {
  std::ostringstream out;
  out << "*PART, NAME=" << name << "\n*NODE\n";
  for (int k = 0; k < 12; ++k) out << k + 1 << ", " << k % 3 << ", " << k / 3 % 2 << ", " << z + k / 6 << '\n';
  out << "*ELEMENT, TYPE=C3D8\n1, 1,2,5,4,7,8,11,10\n2, 2,3,6,5,8,9,12,11\n" << more << "*END PART\n";
  return out.str();
}
MeshFile read_text(const std::string& text) {
  return read_mesh(test::write_text(test::output_folder() / "a.inp", text));
}
std::vector<Index> nodes_of(const Mesh& mesh, const std::string& name) {
  const auto set = std::ranges::find(mesh.node_sets, name, &NodeSet::name);
  return set == mesh.node_sets.end() ? std::vector<Index>{-1} : set->nodes;
}

TEST(abaqus_files, each_part_instance_and_the_assembly_are_name_spaces) {
  const std::string sets = "*NSET, NSET=Set-1\n1\n*ELSET, ELSET=Set-1\n2\n*SURFACE, NAME=Set-1\nSet-1, S4\n";
  const auto read = read_text(
      bar("A", 0, sets) + bar("B", 5, sets) + bar("unused", 9) +
      "*ASSEMBLY, NAME=X\n*INSTANCE, NAME=a, PART=A\n*END INSTANCE\n*INSTANCE, NAME=b, PART=B\n*NSET, NSET=own\n3\n"
      "*END INSTANCE\n*NODE\n3, 9,9,9\n*NSET, NSET=Set-1, INSTANCE=b\n2\n*NSET, NSET=RP\n3\n*NSET, NSET=none\n1\n"
      "*NSET, NSET=mixed\na.3, b.Set-1, b.own\n*NSET, NSET=fromelements, ELSET=b.Set-1\n*ELEMENT, TYPE=CONN3D2\n"
      "1, a.1, b.1\n2, ,\n*SURFACE, NAME=s\na.Set-1, S4\nb.1, S6\n*END ASSEMBLY\n");
  EXPECT_EQ(nodes_of(read.mesh, "a.Set-1"), std::vector<Index>{0});
  EXPECT_EQ(nodes_of(read.mesh, "b.Set-1"), std::vector<Index>{12});
  EXPECT_EQ(nodes_of(read.mesh, "b.own"), std::vector<Index>{14});
  EXPECT_EQ(nodes_of(read.mesh, "Set-1"), std::vector<Index>{13});
  EXPECT_EQ(nodes_of(read.mesh, "RP"), std::vector<Index>{24});
  EXPECT_EQ(nodes_of(read.mesh, "none"), std::vector<Index>{});  // node 1 of the assembly is not there
  EXPECT_EQ(nodes_of(read.mesh, "mixed"), (std::vector<Index>{2, 12, 14}));
  EXPECT_EQ(nodes_of(read.mesh, "fromelements"), (std::vector<Index>{13, 14, 16, 17, 19, 20, 22, 23}));
  ASSERT_EQ(read.mesh.blocks.size(), 2u);
  EXPECT_EQ(read.mesh.blocks[1], (Block{2, "b.Set-1", {3}}));
  ASSERT_EQ(read.mesh.side_sets.size(), 3u);
  EXPECT_EQ(read.mesh.side_sets[2].sides, (std::vector<Side>{{1, 1}, {2, 0}}));
  EXPECT_EQ(read.notices, (std::vector<std::string>{
                              "part 'unused' has no instance: its 2 hexes are left out",
                              "ids that occur in several places of the file are moved: of instance 'b' nodes by 12 "
                              "elements by 2, of the assembly nodes by 24 elements by 4",
                              "dropped 1 element of type CONN3D2, which leaves a node out",
                              "sets name 1 nodes or elements that are not there; the first is node 1 in 'none'"}));
}

TEST(abaqus_files, a_mesh_in_a_part_and_again_in_its_instance_is_one) {
  std::string own = bar("A", 0);
  own = own.substr(own.find('\n') + 1, own.find("*END PART") - own.find('\n') - 1);
  const std::string start = "*ASSEMBLY, NAME=X\n*INSTANCE, NAME=a, PART=A\n", end = "*END INSTANCE\n*END ASSEMBLY\n";
  const auto both = read_text(bar("A", 0) + start + own + end);
  EXPECT_EQ(both.mesh.n_hexes(), 2);
  EXPECT_EQ(both.mesh.n_nodes(), 12);
  const auto only = read_text("*PART, NAME=A\n*END PART\n" + start + own + end);
  EXPECT_TRUE(test::same_mesh(both.mesh, only.mesh));
  const auto file = test::write_text(test::output_folder() / "b.inp", bar("A", 1) + start + own + end);
  EXPECT_EQ(test::refusal(file), file.string() + ":22: node id 1 occurs twice");
  for (const auto& [text, what] :
       {std::pair(bar("A", 0) + bar("a", 1), ":19: a second *PART 'a'"),
        {bar("A", 0) + start + "*END INSTANCE\n*INSTANCE, NAME=A, PART=A\n" + end, ":22: a second *INSTANCE 'A'"},
        {bar("A", 0) + start + end + "*ASSEMBLY, NAME=Y\n", ":23: a second *ASSEMBLY"}})
    EXPECT_EQ(test::refusal(test::write_text(file, text)), file.string() + what);
}

TEST(abaqus_files, element_types_are_kept_by_blocks) {
  Mesh mesh = test::grid(4, 1, 1);
  std::string text = "*NODE\n";
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    text += std::to_string(n + 1) + ", " + std::to_string(mesh.points[n].x()) + ", " +
            std::to_string(mesh.points[n].y()) + ", " + std::to_string(mesh.points[n].z()) + "\n";
  const std::array<const char*, 4> heads = {"C3D8R, ELSET=r", "C3D8I", "C3D8R", "SC8R, ELSET=shell"};
  for (Index h = 0; h < 4; ++h) {
    text += std::string("*ELEMENT, TYPE=") + heads[h] + "\n" + std::to_string(h + 1);
    for (const int c : file_corner) text += ", " + std::to_string(mesh.hexes[h][c] + 1);
    text += "\n";
  }
  const auto read = read_text(text);
  EXPECT_EQ(read.extras.element_types,
            (std::map<int, std::string>{{0, "C3D8R"}, {1, "C3D8R"}, {2, "SC8R"}, {3, "C3D8I"}}));
  ASSERT_EQ(read.mesh.blocks.size(), 3u);
  EXPECT_EQ(read.mesh.blocks[2], (Block{3, "C3D8I", {1}}));
  EXPECT_EQ(read.notices.size(), 2u);
  const auto file = test::output_folder() / "types.inp";
  WriteOptions options;
  options.extras = &read.extras;
  EXPECT_EQ(write_mesh(file, read.mesh, nullptr, options), std::vector<std::string>{});
  const auto back = read_mesh(file);
  EXPECT_TRUE(test::same_mesh(read.mesh, back.mesh));
  EXPECT_EQ(back.extras.element_types, read.extras.element_types);
  EXPECT_EQ(write_mesh(test::output_folder() / "types.mesh", read.mesh, nullptr, options),
            (std::vector<std::string>{"element types are left out, which only .inp has: C3D8R, SC8R, C3D8I",
                                      "MEDIT has no names: those of blocks are in comments"}));
  Mesh less = read.mesh;
  less.blocks.erase(less.blocks.begin() + 1);
  EXPECT_EQ(write_mesh(file, less, nullptr, options),
            (std::vector<std::string>{"block 2, of elements SC8R, is gone: its hexes are C3D8R"}));
}

TEST(abaqus_files, cards_that_are_no_mesh_stand_in_the_next_file) {
  const std::string hex =
      "*ELEMENT, TYPE=C3D8, ELSET=Solid\n1, 1,2,3,4,5,6,7,8\n*ELEMENT, TYPE=B31, ELSET=beams\n9, 1, 2\n";
  const std::string cards =
      "*MATERIAL, NAME=Steel\n*ELASTIC\n 210000., 0.3\n** a comment\n*SOLID SECTION, ELSET=solid, MATERIAL=Steel\n,\n";
  const std::string step =
      "*STEP, NLGEOM\n*STATIC\n1., 2.\n*BOUNDARY\nbase 1,1,3\n7, 1, 1\n*DSLOAD\nload, P, 1.\n*END STEP\n";
  const auto read =
      read_text("*HEADING\nmy job\n" + std::string(cube_nodes).substr(std::string(cube_nodes).find("*node")) + hex +
                "*NSET, NSET=\"base 1\"\n1,2,3,4\n*SURFACE, NAME=load\nSolid, S2\n" + cards +
                "*BEAM SECTION, ELSET=beams, MATERIAL=Steel\n1.,1.\n*EQUATION\n2\n1,1,1.,2,1,-1.\n" + step);
  const std::string name = (test::output_folder() / "a.inp").string();
  EXPECT_EQ(read.notices,
            (std::vector<std::string>{name + ":29: *EQUATION is left out: it speaks of single nodes or elements",
                                      "cards name nodes or elements by number, 1 times, first at " + name +
                                          ":35: what a refinement adds is not "
                                          "among them"}));
  const auto file = test::output_folder() / "cards.inp";
  WriteOptions options;
  options.extras = &read.extras;
  EXPECT_EQ(write_mesh(file, read.mesh, nullptr, options),
            (std::vector<std::string>{"names that Abaqus cannot have are others in the file: 'base 1' is base_1"}));
  const std::string text = test::text_of(file);
  EXPECT_EQ(text.find("*HEADING\nmy job\n"), 0u);
  std::string expected =
      "*MATERIAL, NAME=Steel\n*ELASTIC\n 210000., 0.3\n*SOLID SECTION, ELSET=Solid, MATERIAL=Steel\n,\n"
      "*BEAM SECTION, ELSET=beams, MATERIAL=Steel\n1.,1.\n*STEP, NLGEOM\n"
      "*STATIC\n1., 2.\n*BOUNDARY\nbase_1,1,3\n7, 1, 1\n*DSLOAD\nload, P, 1.\n*END STEP\n** hextwist end\n";
  EXPECT_EQ(text.substr(text.size() - expected.size()), expected);
  // Again, and without what they are about.
  EXPECT_EQ(read_mesh(file).extras.cards.size(), read.extras.cards.size());
  Mesh less = read.mesh;
  less.node_sets.clear();
  less.blocks.clear();
  EXPECT_EQ(
      write_mesh(file, less, nullptr, options),
      (std::vector<std::string>{name + ":25: *SOLID SECTION is left out: what it is about is gone, or was cut",
                                name + ":27: *BEAM SECTION is left out: what it is about is gone, or was cut",
                                name + ":35: 1 line of *BOUNDARY left out: what they are about is gone, or was cut"}));
  EXPECT_EQ(
      write_mesh(test::output_folder() / "cards.vtu", read.mesh, nullptr, options),
      (std::vector<std::string>{"9 cards left out, which only .inp has: *MATERIAL, *ELASTIC, *SOLID SECTION, *BEAM "
                                "SECTION, *STEP, ..."}));
}

TEST(abaqus_files, names_of_different_kinds_may_be_the_same) {
  Mesh mesh = test::grid(2, 1, 1);
  mesh.blocks = {{1, "Set-1", {0}}, {2, "Eall", {1}}};
  mesh.node_sets = {{1, "Set-1", {0}}, {2, "nall", {1}}};
  mesh.side_sets = {{1, "Set-1", {{0, 0}}}};
  const auto file = test::output_folder() / "names.inp";
  EXPECT_EQ(write_mesh(file, mesh, nullptr), std::vector<std::string>{});
  const std::string text = test::text_of(file);
  for (const char* line : {"*ELSET, ELSET=Set-1\n", "*NSET, NSET=Set-1\n", "NAME=Set-1\n", "*NODE\n", "TYPE=C3D8\n"})
    EXPECT_NE(text.find(line), std::string::npos) << line;
  EXPECT_TRUE(test::same_mesh(mesh, read_mesh(file).mesh));
}

TEST(abaqus_files, ranges_take_the_time_of_what_there_is) {
  const std::string hex = std::string(cube_nodes) + "*ELEMENT, TYPE=C3D8\n1, 1,2,3,4,5,6,7,8\n";
  const auto read = read_text(hex +
                              "*NSET, NSET=all, GENERATE\n1, 9223372036854775807, 1\n2, 4611686018427387904, 3\n"
                              "*NSET, NSET=far, GENERATE\n9223372036854775806, 9223372036854775807\n");
  EXPECT_EQ(nodes_of(read.mesh, "all"), (std::vector<Index>{0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(nodes_of(read.mesh, "far"), std::vector<Index>{});
  ASSERT_EQ(read.notices.size(), 1u);
  const auto file = test::output_folder() / "b.inp";
  for (const char* range : {"0, 5", "5, 4", "-9223372036854775808, 9223372036854775807", "1, 5, 0"})
    EXPECT_EQ(test::refusal(test::write_text(file, hex + "*NSET, NSET=a, GENERATE\n" + range + "\n")),
              file.string() + ":17: a range that cannot be generated");
  // Sparse ids.
  std::string sparse = hex + "*NODE\n4611686018427387904, 0,0,9\n*NSET, NSET=s, GENERATE\n2, 4611686018427387904, 2\n";
  EXPECT_EQ(nodes_of(read_text(sparse).mesh, "s"), (std::vector<Index>{1, 3, 5, 7, 8}));
  const auto moved = test::write_text(
      file, bar("A", 0, "*NODE\n4611686018427387904, 0,0,9\n") +
                "*INSTANCE, NAME=a, PART=A\n*END INSTANCE\n*INSTANCE, NAME=b, PART=A\n*END INSTANCE\n");
  EXPECT_EQ(test::refusal(moved), file.string() +
                                      ":1: id 4611686018427387904 of instance 'b' is too large to be counted on "
                                      "from 4611686018427387904");
}

TEST(abaqus_files, a_file_that_was_cut_is_not_read_in_silence) {
  const auto folder = test::output_folder();
  Mesh mesh = test::grid(2, 1, 1);
  mesh.blocks = {{1, "a", {0}}};
  mesh.node_sets = {{1, "b", {0, 3}}};
  write_mesh(folder / "whole.inp", mesh, nullptr);
  const std::string text = test::text_of(folder / "whole.inp");
  for (std::size_t n = 1; n + 1 < text.size(); ++n)
    EXPECT_NE(test::refusal(test::write_text(folder / "cut.inp", text.substr(0, n))), "no error") << n;
  // Other people's files say no end: what can be seen is a line without one.
  const auto foreign =
      test::write_text(folder / "a.inp", cube_nodes + std::string("*ELEMENT, TYPE=C3D8\n1, 1,2,3,4,5,6,7,8"));
  EXPECT_EQ(read_mesh(foreign).notices,
            (std::vector<std::string>{foreign.string() + ":15: the last line has no end; the file may be cut short"}));
  const auto few =
      test::write_text(folder / "few.inp", std::string(text).replace(text.find("mesh 12 2"), 9, "mesh 13 2"));
  EXPECT_EQ(test::refusal(few), few.string() + ": 12 of the 13 nodes that the file announces: it is cut short");
}

TEST(abaqus_files, comments_of_ours_with_impossible_ids_are_refused) {
  for (const char* id : {"-3", "3000000000", "x"}) {
    const auto file = test::write_text(test::output_folder() / "a.inp",
                                       std::string("** hextwist block ") + id + " L name\n" + cube_nodes);
    EXPECT_EQ(test::refusal(file), file.string() + ":1: block id '" + id + "' is not between 0 and 2147483647");
  }
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
  says("*ELEMENT, TYPE=C3D20R\n8, 1,2\n", ":15: element 8 has 2 of 20 nodes");
  says("*ELEMENT, TYPE=C3D20\n8, 1,2,3,4,5,6,7,8,1,2,3,4,5,6,7,\n8,1,2,3\n", ":15: element 8 has 19 of 20 nodes");
  says("*ELEMENT, TYPE=C3D4\n3, 1,2,3,5\n", ": there is no hex in the file, but 1 element C3D4");
  says("*ELEMENT, TYPE=C3D6\n3, 1,2,3,5,6,7\n", ": there is no hex in the file, but 1 element C3D6");
  says("*ELEMENT\n1,2\n", ":14: *ELEMENT without TYPE=");
  says("", ": there is no hex in the file");
  says(hex + "*NODE\n9, 0, 1, nan\n", ":17: a coordinate of node 9 is not finite");
  says(hex + "*NODE\n10, 0, 1, 2\n7, 0, 1, 1e999\n", ":18: a coordinate of node 7 is not finite");
  says(hex + "*NODE\n9, 0, 1, 2\n7, 0, 1, 2\n", ":18: node id 7 occurs twice");
  says(hex + "*NODE\n0, 0, 1, 2\n", ":17: node id 0 is not positive");
  says(hex + "1, 1,2,3,4,5,6,7,8\n", ":16: element id 1 occurs twice");
  says(hex + "*NODE\n9, 0, 1,\x01\n9, 2, 2, 2\n", ":18: node id 9 occurs twice");  // not that z is 9
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
  EXPECT_EQ(file.mesh.blocks[0].name, "Part-Default_1.EB1");
  EXPECT_EQ(file.mesh.blocks[0].hexes.size(), 1032);
  ASSERT_EQ(file.mesh.node_sets.size(), 1);
  EXPECT_EQ(file.mesh.node_sets[0].name, "Part-Default_1.ALLNODES");
  const auto copy = test::output_folder() / "copy.inp";
  write_mesh(copy, file.mesh, nullptr);
  EXPECT_TRUE(test::same_mesh(file.mesh, read_mesh(copy).mesh));
}

}  // namespace
}  // namespace hextwist
