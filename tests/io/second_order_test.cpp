// Meshes of second order in files: there and back, and as other programs see them.
#include <Eigen/Geometry>
#include <random>

#include "hextwist/mesh/second_order/second_order.h"
#include "io/io_support.h"
#include "support/meshed.h"

namespace hextwist {
namespace {

double volume_of(const SecondOrder& mesh) {
  constexpr std::array<double, 3> at = {0.1127016653792583, 0.5, 0.8872983346207417},
                                  weight = {5. / 18, 8. / 18, 5. / 18};
  double sum = 0;
  for (Index h = 0; h < mesh.mesh.n_hexes(); ++h) {
    const QuadraticHex hex = quadratic_hex(mesh, h);
    for (int i = 0; i < 27; ++i) {
      const auto j = jacobian(hex, Vec3(at[i % 3], at[i / 3 % 3], at[i / 9]));
      sum += weight[i % 3] * weight[i / 3 % 3] * weight[i / 9] * j[0].dot(j[1].cross(j[2]));
    }
  }
  return sum;
}

WriteOptions of_order_2(const MeshedModel& meshed, int n) {
  WriteOptions options;
  options.model = meshed.model.get();
  options.order = 2;
  options.nodes_per_hex = n;
  return options;
}

/// Its own nodes in another order, its hexes turned: nothing may depend on how they come.
MeshedModel shuffled(const MeshedModel& meshed) {
  std::mt19937 random(3);
  MeshedModel result;
  result.model = meshed.model;
  Mesh bare = meshed.mesh;
  bare.blocks.clear(), bare.node_sets.clear(), bare.side_sets.clear(), bare.fields.clear();
  result.mesh = test::shuffled(bare, random);
  result.association = associate(result.mesh, *meshed.model, nullptr).association;
  return result;
}

constexpr const char* files[] = {"a.msh", "b.msh", "c.msh", "a.vtu", "b.vtu", "a.e", "a.inp"};
WriteOptions options_of(const std::string& name, WriteOptions options) {
  options.binary = name[0] != 'b';
  options.gmsh_version = name[0] == 'c' ? 22 : 41;
  return options;
}

TEST(second_order_files, middle_nodes_sets_and_fields_come_back_in_every_format) {
  const auto folder = test::output_folder();
  MeshedModel meshed = test::shipped("bracket");
  Mesh& mesh = meshed.mesh;
  Field heat{"heat", Field::On::node, 1, {}}, flag{"flag", Field::On::hex, 1, {}};
  for (const Vec3& p : mesh.points) heat.values.push_back(p.x() - 2 * p.y());
  for (Index h = 0; h < mesh.n_hexes(); ++h) flag.values.push_back(h % 7);
  mesh.fields = {heat, flag};
  for (const int n : {20, 27}) {
    const SecondOrder second = second_order(mesh, meshed.association, meshed.model.get(), n);
    const MiddleNodes expected = middle_nodes(second);
    for (const std::string name : files) {
      SCOPED_TRACE(name + " " + std::to_string(n));
      const auto file = folder / name;
      write_mesh(file, mesh, &meshed.association, options_of(name, of_order_2(meshed, n)));
      const MeshFile back = read_mesh(file);
      EXPECT_EQ(back.middles.nodes_per_hex, n);
      EXPECT_EQ(back.extras.nodes_per_hex.at(0), n);
      ASSERT_EQ(back.mesh.points.size(), mesh.points.size());
      EXPECT_EQ(back.mesh.hexes, mesh.hexes);
      ASSERT_EQ(back.middles.edges, expected.edges);
      ASSERT_EQ(back.middles.faces, expected.faces);
      const double exact = name == "a.inp" ? 1e-12 : 0;
      for (std::size_t e = 0; e < expected.edges.size(); ++e)
        ASSERT_LE((back.middles.edge_points[e] - expected.edge_points[e]).norm(), exact * 100);
      for (std::size_t f = 0; f < expected.faces.size(); ++f)
        ASSERT_LE((back.middles.face_points[f] - expected.face_points[f]).norm(), exact * 100);
      EXPECT_TRUE(test::sets_valid(back.mesh));
      ASSERT_EQ(back.mesh.node_sets.size(), mesh.node_sets.size());
      for (std::size_t s = 0; s < mesh.node_sets.size(); ++s)
        EXPECT_EQ(back.mesh.node_sets[s].nodes, mesh.node_sets[s].nodes);
      ASSERT_EQ(back.mesh.side_sets.size(), mesh.side_sets.size());
      for (std::size_t s = 0; s < mesh.side_sets.size(); ++s)
        EXPECT_EQ(back.mesh.side_sets[s].sides, mesh.side_sets[s].sides);
      if (name == "a.inp") continue;  // has no fields
      ASSERT_EQ(back.mesh.fields.size(), 2U);
      EXPECT_EQ(back.mesh.fields[0].values, heat.values);
      EXPECT_EQ(back.mesh.fields[1].values, flag.values);
      // And again, by what the file says of itself.
      WriteOptions as_read = options_of(name, {});
      as_read.extras = &back.extras;
      write_mesh(folder / ("again" + name), back.mesh, nullptr, as_read);
      EXPECT_EQ(read_mesh(folder / ("again" + name)).middles.nodes_per_hex, n);
    }
  }
}

TEST(second_order_files, vtk_and_gmsh_find_the_volume_in_them) {
  for (const char* module : {"vtk", "gmsh"})
    if (std::system(("/usr/bin/python3 -c 'import numpy, " + std::string(module) + "' > /dev/null 2>&1").c_str()) != 0)
      GTEST_SKIP() << "no python3 with numpy, VTK and Gmsh";
  const auto folder = test::output_folder(), out = folder / "out.txt";
  struct Written {
    std::filesystem::path file;
    double volume;
    int n;
  };
  std::map<std::string, std::vector<Written>> by_program;
  for (const std::string model : {"sphere", "bracket"}) {
    const MeshedModel meshed = shuffled(test::shipped(model));
    for (const int n : {20, 27}) {
      const double volume = volume_of(second_order(meshed.mesh, meshed.association, meshed.model.get(), n));
      for (const std::string name : {"a.vtu", "b.vtu", "a.e", "a.msh", "b.msh", "c.msh"}) {
        const auto file = folder / (model + std::to_string(n) + name);
        write_mesh(file, meshed.mesh, &meshed.association, options_of(name, of_order_2(meshed, n)));
        by_program[file.extension() == ".msh" ? "gmsh" : "vtk"].push_back({file, volume, n});
      }
    }
  }
  for (const auto& [program, written] : by_program) {
    std::string command = "/usr/bin/python3 '" HEXTWIST_SOURCE_DIR "/tests/io/second_order_judge.py' " + program;
    for (const Written& one : written) command += " '" + one.file.string() + "'";
    ASSERT_EQ(std::system((command + " > '" + out.string() + "'").c_str()), 0);
    std::istringstream words(test::text_of(out));
    for (const Written& one : written) {
      SCOPED_TRACE(one.file);
      double found = 0, least = 0;
      int nodes = 0;
      ASSERT_TRUE(words >> found >> least >> nodes);
      // VTK keeps coordinates of Exodus files as floats.
      EXPECT_NEAR(found, one.volume, (one.file.extension() == ".e" ? 1e-6 : 1e-12) * one.volume);
      EXPECT_GT(least, 0);
      EXPECT_EQ(nodes, one.n);
    }
  }
}

/// As it integrates with its own element of 20 nodes.
TEST(second_order_files, calculix_finds_the_volume_in_them) {
  if (std::system("command -v ccx > /dev/null 2>&1") != 0) GTEST_SKIP() << "no CalculiX";
  const auto folder = test::output_folder();
  const MeshedModel meshed = test::shipped("bracket");
  const double volume = volume_of(second_order(meshed.mesh, meshed.association, meshed.model.get(), 20));
  MeshedModel with_foot = meshed;
  NodeSet foot{50, "HELD", {}};
  for (Index n = 0; n < meshed.mesh.n_nodes(); ++n)
    if (meshed.mesh.points[n].z() < 1e-6) foot.nodes.push_back(n);
  ASSERT_FALSE(foot.nodes.empty());
  with_foot.mesh.node_sets.push_back(foot);
  write_mesh(folder / "mesh.inp", with_foot.mesh, &meshed.association, of_order_2(meshed, 20));
  test::write_text(folder / "job.inp",
                   "*INCLUDE, INPUT=mesh.inp\n*MATERIAL, NAME=M\n*ELASTIC\n210000,0.3\n*DENSITY\n1.0\n*SOLID SECTION, "
                   "ELSET=EALL, MATERIAL=M\n*BOUNDARY\nHELD,1,3\n*STEP\n*STATIC\n*DLOAD\nEALL,GRAV,1.0,0,0,-1\n*EL "
                   "PRINT, ELSET=EALL, TOTALS=ONLY\nEVOL\n*END STEP\n");
  ASSERT_EQ(std::system(("cd " + folder.string() + " && ccx -i job > log.txt 2>&1").c_str()), 0)
      << test::text_of(folder / "log.txt");
  EXPECT_EQ(test::text_of(folder / "log.txt").find("nonpositive"), std::string::npos);
  std::istringstream words(test::text_of(folder / "job.dat"));
  std::string word, last;
  while (words >> word) last = word;
  EXPECT_NEAR(std::stod(last), volume, 1e-5 * volume) << test::text_of(folder / "job.dat");
}

TEST(second_order_files, lagrange_hexes_of_vtk_are_read_in_both_of_their_orders) {
  // One hex whose pillars are each bent by as much as their number says.
  const auto folder = test::output_folder();
  const auto text = [](const char* version, bool old) {
    std::string points, nodes;
    int n = 0;
    // Corners, edges, faces, centre, as VTK's manual has them, at (i, j, k) / 2.
    const std::vector<std::array<int, 3>> at = {
        {0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2}, {2, 0, 2}, {2, 2, 2}, {0, 2, 2}, {1, 0, 0},
        {2, 1, 0}, {1, 2, 0}, {0, 1, 0}, {1, 0, 2}, {2, 1, 2}, {1, 2, 2}, {0, 1, 2}, {0, 0, 1}, {2, 0, 1},
        {2, 2, 1}, {0, 2, 1}, {0, 1, 1}, {2, 1, 1}, {1, 0, 1}, {1, 2, 1}, {1, 1, 0}, {1, 1, 2}, {1, 1, 1}};
    for (std::size_t i = 0; i < at.size(); ++i) {
      const std::size_t k = old && i == 18 ? 19 : old && i == 19 ? 18 : i;
      points += std::to_string(at[k][0]) + " " + std::to_string(at[k][1]) + " " + std::to_string(at[k][2]) + "\n";
      nodes += std::to_string(n++) + " ";
    }
    return std::string("<VTKFile type=\"UnstructuredGrid\" version=\"") + version +
           "\" byte_order=\"LittleEndian\"><UnstructuredGrid><Piece NumberOfPoints=\"27\" NumberOfCells=\"1\"><Points>"
           "<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">" +
           points + "</DataArray></Points><Cells><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">" +
           nodes +
           "</DataArray><DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">27</DataArray><DataArray "
           "type=\"UInt8\" Name=\"types\" "
           "format=\"ascii\">72</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>\n";
  };
  for (const bool old : {false, true}) {
    const MeshFile read = read_mesh(test::write_text(folder / "a.vtu", text(old ? "0.1" : "2.2", old)));
    ASSERT_EQ(read.middles.edges.size(), 12U);
    for (std::size_t e = 0; e < 12; ++e) {
      const auto [a, b] = read.middles.edges[e];
      EXPECT_EQ(read.middles.edge_points[e], Vec3((read.mesh.points[a] + read.mesh.points[b]) / 2));
    }
  }
}

TEST(second_order_files, hexes_that_do_not_fit_together_are_refused) {
  const auto folder = test::output_folder();
  const std::string corners =
      "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n11,2,0,0\n12,2,1,0\n13,2,0,1\n"
      "14,2,1,1\n";
  std::string middles;
  for (int id = 20; id < 50; ++id) middles += std::to_string(id) + "," + std::to_string(id) + ",0,0\n";
  const auto says = [&](const std::string& elements, const std::string& expected) {
    const auto file = test::write_text(folder / "bad.inp", corners + middles + elements);
    EXPECT_NE(test::refusal(file).find(expected), std::string::npos) << test::refusal(file);
  };
  const std::string first = "*ELEMENT, TYPE=C3D20\n1, 1,2,3,4,5,6,7,8,20,21,22,23,24,25,26\n27,28,29,30,31\n";
  says(first + "2, 2,11,12,3,6,13,14,7,32,33,34,21,36,37,38\n25,29,40,41,42\n",
       "hexes 1 and 2 have different middle nodes on a common edge, 30 and 42");
  says(first + "2, 2,11,12,3,6,13,14,7,32,33,34,5,36,37,38\n25,29,40,41,30\n",
       "node 5 is a middle node of hex 2 and a corner of another hex: they do not fit together");
  const auto mixed = test::write_text(folder / "mixed.inp",
                                      corners + middles + first + "*ELEMENT, TYPE=C3D8\n2, 2,11,12,3,6,13,14,7\n");
  EXPECT_EQ(read_mesh(mixed).notices.back(),
            "1 hex without middle nodes beside others that have some: taken as straight where no neighbour bends it");
}

TEST(second_order_files, cards_that_name_middle_nodes_are_told_of) {
  const auto folder = test::output_folder();
  MeshedModel meshed = test::brick(1, 1, 1);
  write_mesh(folder / "a.inp", meshed.mesh, &meshed.association, of_order_2(meshed, 20));
  test::write_text(folder / "b.inp", test::text_of(folder / "a.inp") + "*BOUNDARY\n1, 1, 3\n9, 1, 3\n");
  const MeshFile read = read_mesh(folder / "b.inp");
  EXPECT_NE(std::ranges::find_if(read.notices,
                                 [](const std::string& line) {
                                   return line.ends_with(
                                       "lines of *BOUNDARY about '9' are left out: nothing of that is kept");
                                 }),
            read.notices.end());
}

TEST(second_order_files, types_of_calculix_follow_the_order) {
  const auto folder = test::output_folder();
  MeshedModel meshed = test::brick(1, 1, 1);
  FileExtras extras;
  for (const auto& [type, of_20, of_27] : {std::array{"C3D8R", "C3D20R", "C3D27R"},
                                           {"C3D20RH", "C3D20RH", "C3D27RH"},
                                           {"C3D8I", "C3D20", "C3D27"},
                                           {"AC3D8", "AC3D20", "AC3D27"},
                                           {"DC3D8", "DC3D20", "DC3D27"}}) {
    extras.element_types[0] = type;
    for (const int n : {20, 27}) {
      WriteOptions options = of_order_2(meshed, n);
      options.extras = &extras;
      write_mesh(folder / "a.inp", meshed.mesh, nullptr, options);
      EXPECT_NE(test::text_of(folder / "a.inp").find(std::string("TYPE=") + (n == 20 ? of_20 : of_27) + ","),
                std::string::npos)
          << type;
    }
  }
  extras.element_types[0] = "SC8R";
  WriteOptions options = of_order_2(meshed, 20);
  options.extras = &extras;
  try {
    write_mesh(folder / "a.inp", meshed.mesh, nullptr, options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("elements of type SC8R have no middle nodes: export with order 1"),
              std::string::npos);
  }
}

TEST(second_order_files, what_a_format_or_the_blocks_do_not_allow_is_said) {
  const auto folder = test::output_folder();
  MeshedModel meshed = test::brick(2, 1, 1);
  meshed.mesh.blocks = {{1, "a", {0}}, {2, "b", {1}}};
  const auto refusal = [&](const char* name, const WriteOptions& options) {
    try {
      write_mesh(folder / name, meshed.mesh, nullptr, options);
    } catch (const Error& error) {
      EXPECT_FALSE(std::filesystem::exists(folder / name));
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(refusal("a.foam", of_order_2(meshed, 0)),
            (folder / "a.foam").string() + ": .foam files have no middle nodes here: export with order 1");
  WriteOptions third;
  third.order = 3;
  EXPECT_EQ(refusal("a.vtu", third), (folder / "a.vtu").string() + ": order 3 is neither 1 nor 2");
  FileExtras extras;
  extras.nodes_per_hex = {{1, 20}};
  WriteOptions options;
  options.extras = &extras;
  EXPECT_EQ(refusal("b.vtu", options),
            (folder / "b.vtu").string() +
                ": hex 1 has 20 nodes and hex 2 8: all hexes of a file have as many here ('block all element type "
                "...', or an order for the file)");
  extras.nodes_per_hex[2] = 20;
  EXPECT_EQ(refusal("c.vtu", options), "no error");
  EXPECT_EQ(read_mesh(folder / "c.vtu").middles.nodes_per_hex, 20);
  EXPECT_EQ(write_mesh(folder / "a.foam", meshed.mesh, nullptr, options).front(),
            ".foam files have no middle nodes here: they are left out");
}

/// Never a crash: a message of one line, or a mesh whose parts fit together.
TEST(second_order_files, that_are_cut_short_are_refused) {
  const auto folder = test::output_folder();
  const MeshedModel meshed = test::brick(2, 1, 1);
  for (const std::string name : files) {
    const auto file = folder / name, cut = folder / ("cut" + name);
    write_mesh(file, meshed.mesh, &meshed.association, options_of(name, of_order_2(meshed, 27)));
    const std::string text = test::text_of(file);
    for (std::size_t n = 0; n < text.size(); n += 1 + text.size() / 200) {
      SCOPED_TRACE(name + " " + std::to_string(n));
      test::write_text(cut, text.substr(0, n));
      try {
        const MeshFile read = read_mesh(cut);
        EXPECT_TRUE(test::sets_valid(read.mesh));
      } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      }
    }
  }
}

}  // namespace
}  // namespace hextwist
