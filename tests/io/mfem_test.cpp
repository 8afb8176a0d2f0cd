#include "io/hdf_support.h"
#include "support/meshed.h"

namespace hextwist {
namespace {

/// What the format can hold: no ids, no fields, no node sets.
Mesh of_mfem(Mesh mesh) {
  mesh.node_ids.clear();
  mesh.hex_ids.clear();
  mesh.fields.clear();
  mesh.node_sets.clear();
  return mesh;
}

TEST(mfem_files, blocks_and_side_sets_come_back) {
  const auto folder = test::output_folder();
  for (unsigned seed = 1; seed < 6; ++seed)
    for (const bool names : {false, true}) {
      SCOPED_TRACE(seed);
      Mesh mesh = of_mfem(test::rich_mesh(seed, false));
      if (!names) {
        for (Block& block : mesh.blocks) block.name.clear();
        for (SideSet& set : mesh.side_sets) set.name.clear();
      }
      write_mesh(folder / "a.mfem", mesh, nullptr);
      EXPECT_EQ(test::text_of(folder / "a.mfem").substr(0, 14), names ? "MFEM mesh v1.3" : "MFEM mesh v1.0");
      const MeshFile read = read_mesh(folder / "a.mfem");
      EXPECT_TRUE(test::same_mesh(mesh, read.mesh));
      EXPECT_TRUE(read.notices.empty()) << read.notices[0];
      // Its usual ending is MEDIT's: what it is shows at the beginning.
      WriteOptions options;
      options.format = "mfem";
      write_mesh(folder / "a.mesh", mesh, nullptr, options);
      EXPECT_TRUE(test::same_mesh(mesh, read_mesh(folder / "a.mesh").mesh));
    }
}

TEST(mfem_files, every_shipped_model_comes_back_with_its_middle_nodes) {
  const auto folder = test::output_folder();
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(HEXTWIST_SOURCE_DIR) / "models")) {
    if (entry.path().extension() != ".msh") continue;
    SCOPED_TRACE(entry.path());
    const MeshedModel meshed = test::shipped(entry.path().stem().string());
    write_mesh(folder / "a.mfem", meshed.mesh, nullptr);
    EXPECT_TRUE(test::same_mesh(of_mfem(meshed.mesh), read_mesh(folder / "a.mfem").mesh));
    WriteOptions options;
    options.order = 2, options.model = meshed.model.get();
    write_mesh(folder / "b.mfem", meshed.mesh, &meshed.association, options);
    const MeshFile read = read_mesh(folder / "b.mfem");
    const MiddleNodes expected = middle_nodes(second_order(meshed.mesh, meshed.association, meshed.model.get(), 27));
    EXPECT_TRUE(test::same_mesh(of_mfem(meshed.mesh), read.mesh));
    EXPECT_EQ(read.middles.edges, expected.edges);
    EXPECT_EQ(read.middles.edge_points, expected.edge_points);
    EXPECT_EQ(read.middles.faces, expected.faces);
    EXPECT_EQ(read.middles.face_points, expected.face_points);
  }
}

TEST(mfem_files, an_independent_reader_finds_all_in_them) {
  if (!test::has_judge("mfem")) GTEST_SKIP() << "no python3 with numpy";
  const auto folder = test::output_folder();
  MeshedModel meshed = test::shipped("bracket");
  Mesh& mesh = meshed.mesh;
  mesh.blocks = {{1, "all of it", {}}, {2, "odd \"ones\"", {}}};
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    mesh.blocks[0].hexes.push_back(h);
    if (h % 2 == 1) mesh.blocks[1].hexes.push_back(h);
  }
  for (const int n : {8, 27}) {
    WriteOptions options;
    options.order = n == 8 ? 1 : 2, options.model = meshed.model.get();
    write_mesh(folder / "a.mfem", mesh, &meshed.association, options);
    const auto said = test::judged("mfem", folder / "a.mfem");
    ASSERT_EQ(said.count("volume"), 1U);
    const double expected =
        n == 8 ? volume(mesh) : test::exact_volume(second_order(mesh, meshed.association, meshed.model.get(), 27));
    EXPECT_NEAR(std::stod(said.find("volume")->second), expected, 1e-9 * expected);
    EXPECT_EQ(said.find("hexes")->second, std::to_string(mesh.n_hexes()) + " " + std::to_string(n));
    EXPECT_TRUE(test::said(said, "set", "all_of_it " + std::to_string(mesh.n_hexes())));
    EXPECT_TRUE(test::said(said, "set", "odd_\\\"ones\\\" " + std::to_string(mesh.n_hexes() / 2)));
    for (const SideSet& set : mesh.side_sets)
      EXPECT_TRUE(test::said(said, "sides", set.name + " " + std::to_string(set.sides.size()))) << set.name;
    // All of the boundary is there, as MFEM wants it.
    EXPECT_EQ(said.find("quads")->second, std::to_string(boundary_sides(faces(mesh)).size()));
  }
}

constexpr const char* vertices = "vertices\n8\n3\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n";

TEST(mfem_files, other_peoples_files_are_understood) {
  const auto folder = test::output_folder();
  const MeshFile plain = read_mesh(test::write_text(
      folder / "a.mesh", std::string("MFEM mesh v1.0\n\n#\n# MFEM Geometry Types\n#\n\ndimension\n3\n\nelements\n1\n"
                                     "4 5 0 1 2 3 4 5 6 7\n\nboundary\n3\n2 3 0 3 2 1\n7 3 4 5 6 7\n7 2 0 1 2\n\n") +
                             vertices));
  EXPECT_EQ(plain.mesh.hexes, (std::vector<Hex>{{0, 1, 3, 2, 4, 5, 7, 6}}));
  EXPECT_EQ(plain.mesh.blocks, (std::vector<Block>{{4, "", {0}}}));
  EXPECT_EQ(plain.mesh.side_sets, (std::vector<SideSet>{{2, "", {{0, 4}}}, {7, "", {{0, 5}}}}));
  EXPECT_DOUBLE_EQ(volume(plain.mesh), 1);
  EXPECT_EQ(plain.notices, (std::vector<std::string>{"dropped 1 boundary element of geometry triangle"}));
  const MeshFile named = read_mesh(test::write_text(
      folder / "a.mesh",
      std::string("MFEM mesh v1.3\n\ndimension\n3\n\nelements\n1\n4 5 0 1 2 3 4 5 6 7\n\nattribute_sets\n2\n"
                  "\"hot steel\"\n1\n4\nnone 1 9\n\nboundary\n2\n2 3 0 3 2 1\n7 3 4 5 6 7\n\nbdr_attribute_sets\n1\n"
                  "\"both \\\"ends\\\"\" 2 2 7\n\n") +
          vertices + "\nmfem_mesh_end\n"));
  EXPECT_EQ(named.mesh.blocks, (std::vector<Block>{{4, "hot steel", {0}}, {5, "none", {}}}));
  EXPECT_EQ(named.mesh.side_sets,
            (std::vector<SideSet>{{2, "", {{0, 4}}}, {7, "", {{0, 5}}}, {8, "both \"ends\"", {{0, 4}, {0, 5}}}}));
  // Nodes by components, of degree 1; and of degree 3, of which the corners are taken.
  std::string nodes = "FiniteElementSpace\nFiniteElementCollection: H1_3D_P1\nVDim: 3\nOrdering: 0\n\n";
  for (const char* row : {"0 2 2 0 0 2 2 0", "0 0 1 1 0 0 1 1", "0 0 0 0 1 1 1 1"}) nodes += std::string(row) + "\n";
  const std::string head =
      "MFEM mesh v1.0\ndimension\n3\nelements\n1\n1 5 0 1 2 3 4 5 6 7\nboundary\n0\nvertices\n8\nnodes\n";
  EXPECT_DOUBLE_EQ(volume(read_mesh(test::write_text(folder / "a.mesh", head + nodes)).mesh), 2);
  std::string cubic = "FiniteElementSpace\nFiniteElementCollection: H1_3D_P3\nVDim: 3\nOrdering: 1\n";
  for (int i = 0; i < 64; ++i)
    cubic += i < 8 ? std::to_string(i % 2) + " " + std::to_string(i / 2 % 2) + " " + std::to_string(i / 4) + "\n"
                   : "5 5 5\n";
  const MeshFile straight = read_mesh(test::write_text(folder / "a.mesh", head + cubic));
  EXPECT_EQ(straight.mesh.n_nodes(), 8);
  EXPECT_EQ(straight.notices,
            (std::vector<std::string>{"nodes of degree 3 are left out but for the corners: hexes are straight"}));
}

TEST(mfem_files, what_is_wrong_is_said_with_its_line) {
  const auto file = test::output_folder() / "bad.mfem";
  const auto says = [&](const std::string& text, const std::string& expected) {
    test::write_text(file, text);
    EXPECT_EQ(test::refusal(file), file.string() + expected);
  };
  const std::string head = "MFEM mesh v1.0\ndimension\n3\nelements\n1\n", hex = "1 5 0 1 2 3 4 5 6 7\n",
                    sides = "boundary\n0\n";
  says("solid\n", ":1: not a mesh of MFEM: it does not begin with 'MFEM mesh v1.0'");
  says("MFEM mesh v1.9\n", ":1: 'MFEM mesh v1.9' is not read, but v1.0, v1.2 and v1.3");
  says("MFEM NC mesh v1.0\n", ":1: a non-conforming mesh ('MFEM NC mesh v1.0'): only conforming ones are read");
  says("MFEM NURBS mesh v1.0\n", ":1: a NURBS mesh: only plain ones are read");
  says("MFEM mesh v1.0\ndimension\n2\n", ":3: dimension 2 instead of 3");
  says("MFEM mesh v1.0\nelements\n", ":2: expected dimension, found 'elements'");
  says(head + "1 4 0 1 2 3\n", ":6: element 1 is a tetrahedron; only hexes of 8 or 27 nodes are accepted");
  says(head + "1 9 0 1 2 3\n", ":6: element 1 is of unknown geometry 9");
  says(head + "1 5 0 1 2 3 4 5 6 8\n" + sides + vertices, ":6: an element names vertex 8 of 8 (counted from 0)");
  says(head + "1 5 0 1 2 3 4 5 6 -1\n", ":6: element 1 names vertex -1");
  says("MFEM mesh v1.0\ndimension\n3\nelements\n0\nboundary\n0\nvertices\n0\n3\n", ":11: there is no hex in the file");
  says("MFEM mesh v1.0\ndimension\n3\nelements\n999999999\n", ":5: the file is too short for 999999999 elements");
  says(head + hex + sides + "vertices\n8\n2\n0 0 0 0 0 0 0 0\n", ":11: vertices have 2 coordinates instead of 3");
  says(head + hex + sides + "vertices\n8\n3\n0 0 x\n0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0\n",
       ":12: expected a coordinate, found 'x'");
  const std::string nodes = head + hex + sides + "vertices\n8\nnodes\nFiniteElementSpace\n";
  says(nodes + "FiniteElementCollection: L2_T1_3D_P1\nVDim: 3\nOrdering: 1\n",
       ":14: nodes of collection 'L2_T1_3D_P1' are not read, but of H1_3D_P1 and H1_3D_P2");
  says(nodes + "FiniteElementCollection: H1_3D_P2\nVDim: 3\nOrdering: 1\n0 0 0\n",
       ":16: the file is too short for 27 nodes");
  says(nodes + "FiniteElementCollection: H1_3D_P2\nVDim: 2\nOrdering: 1\n",
       ":14: nodes have 2 components instead of 3");
}

TEST(mfem_files, what_is_lost_is_told) {
  Mesh mesh = test::rich_mesh(1, true);
  const auto notices = write_mesh(test::output_folder() / "a.mfem", mesh, nullptr);
  const auto told = [&](const std::string& line) {
    return std::ranges::any_of(notices, [&](const std::string& one) { return one.find(line) != std::string::npos; });
  };
  EXPECT_TRUE(told("MFEM has no ids: nodes are counted from 0 in the file"));
  EXPECT_TRUE(told("MFEM has no node sets: nodeset 2 'Fixed Nodes' left out"));
  EXPECT_TRUE(told("MFEM's mesh file has no fields"));
  EXPECT_TRUE(told("an element of MFEM has one attribute, so that a block has others: "));
}

TEST(mfem_files, that_are_cut_short_or_changed_are_refused_or_sound) {
  const auto folder = test::output_folder();
  const MeshedModel meshed = test::shipped("l_block");
  std::mt19937 random(5);
  for (const int order : {1, 2}) {
    WriteOptions options;
    options.order = order;
    write_mesh(folder / "a.mfem", order == 1 ? test::rich_mesh(3, false) : meshed.mesh, nullptr, options);
    const std::string text = test::text_of(folder / "a.mfem");
    for (int trial = 0; trial < 200; ++trial) {
      SCOPED_TRACE(testing::Message() << order << " " << trial);
      std::string changed = text;
      if (trial % 2 == 0)
        changed.resize(random() % text.size());
      else
        for (int k = 0; k < 3; ++k)
          changed[random() % text.size()] = static_cast<char>(" -+0123456789.#\"\n"[random() % 17]);
      try {
        EXPECT_TRUE(test::sets_valid(read_mesh(test::write_text(folder / "b.mfem", changed)).mesh));
      } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      }
    }
  }
}

}  // namespace
}  // namespace hextwist
