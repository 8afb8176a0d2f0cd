#include <map>

#include "hextwist/mesh/others.h"
#include "io/io_support.h"

namespace hextwist {
namespace {

struct Mode {
  int version;
  bool binary;
};
constexpr Mode modes[] = {{22, false}, {22, true}, {41, false}, {41, true}};

MeshFile there_and_back(const Mesh& mesh, const Association* tags, Mode mode, const std::string& name = "mesh.msh") {
  const auto file = test::output_folder() / name;
  WriteOptions options;
  options.binary = mode.binary;
  options.gmsh_version = mode.version;
  write_mesh(file, mesh, tags, options);
  return read_mesh(file);
}

TEST(gmsh_files, a_mesh_with_everything_comes_back_bit_for_bit) {
  for (const Mode mode : modes)
    for (unsigned seed = 1; seed < 6; ++seed) {
      SCOPED_TRACE(testing::Message() << mode.version << (mode.binary ? " binary " : " text ") << seed);
      const Mesh mesh = test::rich_mesh(seed, seed % 2);
      const auto back = there_and_back(mesh, nullptr, mode);
      EXPECT_TRUE(test::same_mesh(mesh, back.mesh));
      EXPECT_TRUE(back.tags.empty());
      EXPECT_TRUE(back.notices.empty());
    }
}

TEST(gmsh_files, owners_come_back_though_sets_cut_across_entities) {
  for (const Mode mode : modes)
    for (unsigned seed = 1; seed < 4; ++seed) {
      SCOPED_TRACE(testing::Message() << mode.version << (mode.binary ? " binary " : " text ") << seed);
      const Mesh mesh = test::rich_mesh(seed, seed % 2);
      const auto tags = test::brick_association(mesh, Vec3(4, 3, 3));
      const auto back = there_and_back(mesh, &tags, mode);
      EXPECT_TRUE(test::same_mesh(mesh, back.mesh));
      EXPECT_TRUE(test::same_owners(tags, back.tags));
    }
}

TEST(gmsh_files, binary_files_of_the_other_byte_order_are_read) {
  std::string text = "$MeshFormat\n4.1 1 8\n";
  const auto put = [&](auto... values) {
    const auto one = [&](auto value) {
      auto bytes = std::bit_cast<std::array<char, sizeof value>>(value);
      std::ranges::reverse(bytes);
      text.append(bytes.data(), bytes.size());
    };
    (one(values), ...);
  };
  put(1);
  text += "\n$EndMeshFormat\n$Nodes\n";
  using Large = std::int64_t;
  put(Large{1}, Large{8}, Large{1}, Large{8}, 3, 1, 0, Large{8});
  for (Large id = 8; id > 0; --id) put(id);
  for (int i = 0; i < 8; ++i) put(i & 1 ? 1.5 : 0.0, i & 2 ? 1.25 : 0.0, i & 4 ? 1.125 : 0.0);
  text += "\n$EndNodes\n$Elements\n";
  put(Large{1}, Large{1}, Large{7}, Large{7}, 3, 1, 5, Large{1});
  for (const Large value : {7, 8, 7, 5, 6, 4, 3, 1, 2}) put(value);
  text += "\n$EndElements\n";
  const auto read = read_mesh(test::write_text(test::output_folder() / "other.msh", text));
  EXPECT_EQ(read.mesh.hexes, (std::vector<Hex>{{7, 6, 5, 4, 3, 2, 1, 0}}));
  EXPECT_EQ(read.mesh.points[0], Vec3(1.5, 1.25, 1.125));
  EXPECT_EQ(read.mesh.points[6], Vec3(1.5, 0, 0));
  EXPECT_EQ(read.tags.hex_volume, std::vector<int>{1});
}

TEST(gmsh_files, hexes_keep_their_tags_whatever_else_is_counted_with_them) {
  const std::string points = "1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n";
  const auto read = [](const std::string& text) {
    return read_mesh(test::write_text(test::output_folder() / "tags.msh", text)).mesh.hex_ids;
  };
  EXPECT_EQ(read("$NOD\n8\n" + points +
                 "$ENDNOD\n$ELM\n3\n1 3 5 5 4 1 2 3 4\n10 5 1 1 8 1 2 3 4 5 6 7 8\n"
                 "12 15 1 1 1 3\n$ENDELM\n"),
            (std::vector<std::int64_t>{10}));
  EXPECT_EQ(read("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n8\n" + points +
                 "$EndNodes\n$Elements\n3\n1 3 2 0 5 1 2 3 4\n10 5 2 0 1 1 2 3 4 5 6 7 8\n12 15 2 0 1 3\n"
                 "$EndElements\n"),
            (std::vector<std::int64_t>{10}));
  EXPECT_EQ(read("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 8 1 8\n3 1 0 8\n1\n2\n3\n4\n5\n6\n7\n8\n0 0 0\n"
                 "1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n$EndNodes\n$Elements\n2 2 1 10\n2 5 3 1\n"
                 "1 1 2 3 4\n3 1 5 1\n10 1 2 3 4 5 6 7 8\n$EndElements\n"),
            (std::vector<std::int64_t>{10}));
}

TEST(gmsh_files, nothing_but_names_and_entities_stands_before_the_elements) {
  // PETSc takes no other section there.
  const Mesh mesh = test::rich_mesh(2, true);
  const auto tags = test::brick_association(mesh, Vec3(4, 3, 3));
  for (const Mode mode : modes) {
    const auto file = test::output_folder() / "mesh.msh";
    write_mesh(file, mesh, &tags, {.binary = mode.binary, .gmsh_version = mode.version});
    const std::string text = test::text_of(file);
    const auto elements = text.find("$EndElements\n"), parts = text.find("$HextwistParts\n");
    ASSERT_NE(elements, std::string::npos);
    ASSERT_NE(parts, std::string::npos);
    EXPECT_LT(elements, parts);
  }
}

TEST(gmsh_files, groups_only_leaves_all_else_out) {
  Mesh mesh = test::grid(4, 3, 3);
  const auto tags = test::brick_association(mesh, Vec3(4, 3, 3));
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    if (mesh.hexes[h][0] % 5 < 2) {
      if (mesh.blocks.empty()) mesh.blocks.push_back({3, "half", {}});
      mesh.blocks[0].hexes.push_back(h);
    }
  mesh.side_sets = {{4, "one", {{mesh.blocks[0].hexes[0], 0}}}};
  mesh.fields = {{"t", Field::On::node, 1, {}}, {"e", Field::On::hex, 1, {}}};
  for (Index n = 0; n < mesh.n_nodes(); ++n) mesh.fields[0].values.push_back(n);
  for (Index h = 0; h < mesh.n_hexes(); ++h) mesh.fields[1].values.push_back(h);
  WriteOptions options;
  options.groups_only = true;
  for (const Mode mode : modes) {
    options.binary = mode.binary;
    options.gmsh_version = mode.version;
    const auto file = test::output_folder() / (std::to_string(mode.version) + (mode.binary ? "b.msh" : "t.msh"));
    EXPECT_EQ(write_mesh(file, mesh, &tags, options), (std::vector<std::string>{"18 hexes in no block left out"}));
    const auto back = read_mesh(file);
    ASSERT_EQ(back.mesh.n_hexes(), 18);
    EXPECT_EQ(back.mesh.n_nodes(), 48);
    EXPECT_EQ(back.mesh.blocks[0].hexes.size(), 18u);
    EXPECT_EQ(back.mesh.side_sets, (std::vector<SideSet>{{4, "one", {{0, 0}}}}));
    EXPECT_TRUE(back.tags.curve_edges.empty());
    for (Index h = 0; h < 18; ++h) {
      EXPECT_EQ(back.mesh.fields[1].values[static_cast<std::size_t>(h)], mesh.blocks[0].hexes[h]);
      EXPECT_EQ(hex_id(back.mesh, h), mesh.blocks[0].hexes[h] + 1);
    }
    for (Index n = 0; n < 48; ++n)
      EXPECT_EQ(back.mesh.fields[0].values[static_cast<std::size_t>(n)],
                static_cast<double>(node_id(back.mesh, n) - 1));
    // Of fields meshio wants values on elements of all kinds.
    Mesh bare = mesh;
    bare.fields.clear();
    write_mesh(file, bare, &tags, options);
    const std::string script = "/usr/bin/python3 -c \"import meshio; m = meshio.read('" + file.string() +
                               "'); assert sum(len(c.data) for c in m.cells if c.type == 'hexahedron') == 18\" ";
    // In binary files of version 2.2 it also wants node ids without gaps.
    if (mode.version == 22 && mode.binary) continue;
    if (std::system("/usr/bin/python3 -c 'import meshio' > /dev/null 2>&1") == 0) {
      EXPECT_EQ(std::system((script + "> /dev/null 2>&1").c_str()), 0) << file;
    }
  }
  mesh.blocks.clear();
  try {
    write_mesh(test::output_folder() / "none.msh", mesh, &tags, options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("there is no hex in a block"), std::string::npos);
  }
}

TEST(gmsh_files, periodic_pairs_are_carried_or_named) {
  // A brick of 4 x 3 x 3; x = 4 repeats x = 0.
  Mesh mesh = test::grid(4, 3, 3);
  const auto tags = test::brick_association(mesh, Vec3(4, 3, 3));
  const auto surface_at = [&](double x) {
    for (std::size_t n = 0; n < mesh.points.size(); ++n)
      if (mesh.points[n].x() == x && tags.node_owner[n].dim == 2) return tags.node_owner[n].id;
    return 0;
  };
  FileExtras extras;
  extras.periodic = {{2, 77, 78, {}, {}}};
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    if (mesh.points[n].x() == 4 && (n / 5) % 3 != 1)  // not all: the others are found
      extras.periodic[0].nodes.push_back({n + 1, n - 3});
  WriteOptions options;
  options.extras = &extras;
  for (const Mode mode : modes) {
    SCOPED_TRACE(testing::Message() << mode.version << mode.binary);
    options.binary = mode.binary;
    options.gmsh_version = mode.version;
    const auto file = test::output_folder() / "periodic.msh";
    EXPECT_EQ(write_mesh(file, mesh, &tags, options), std::vector<std::string>{});
    const auto back = read_mesh(file).extras.periodic;
    ASSERT_EQ(back.size(), 1u);
    EXPECT_EQ(back[0].entity, surface_at(4));
    EXPECT_EQ(back[0].of, surface_at(0));
    EXPECT_EQ(back[0].affine, (std::vector<double>{1, 0, 0, 4, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}));
    ASSERT_EQ(back[0].nodes.size(), 16u);
    for (const auto& [a, b] : back[0].nodes) EXPECT_EQ(mesh.points[a - 1] - mesh.points[b - 1], Vec3(4, 0, 0));
  }
  Mesh moved = mesh;
  moved.points[4].y() += 0.1;
  const auto said = write_mesh(test::output_folder() / "moved.msh", moved, &tags, options);
  EXPECT_EQ(said, (std::vector<std::string>{
                      "pairs of nodes of 1 periodic entity left out; the first are surfaces 77 and 78 of the "
                      "file: their nodes are not images of each other any more"}));
  EXPECT_EQ(write_mesh(test::output_folder() / "a.vtu", mesh, &tags, options),
            (std::vector<std::string>{"pairs of nodes of 1 periodic entity left out, which only .msh has"}));
}

TEST(gmsh_files, physical_group_0_gets_an_id) {
  const auto file = test::write_text(
      test::output_folder() / "zero.msh",
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n3 0 \"zero\"\n3 7 "
      "\"seven\"\n$EndPhysicalNames\n$Entities\n"
      "0 0 0 1\n1 0 0 0 1 1 1 2 0 7 0\n$EndEntities\n$Nodes\n1 8 1 8\n3 1 0 8\n1\n2\n3\n4\n5\n6\n7\n8\n0 0 0\n"
      "1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n$EndNodes\n$Elements\n1 1 1 1\n3 1 5 1\n1 1 2 3 4 5 6 7 8\n"
      "$EndElements\n");
  const auto read = read_mesh(file);
  EXPECT_EQ(read.mesh.blocks, (std::vector<Block>{{7, "seven", {0}}, {8, "zero", {0}}}));
  EXPECT_EQ(read.notices, (std::vector<std::string>{"physical group 0 of dimension 3 is 8 here"}));
}

TEST(gmsh_files, real_meshes_have_the_known_counts) {
  const auto data = test::data_folder();
  if (data.empty()) GTEST_SKIP() << "no folder of real meshes";
  const std::map<std::string, Index> n_hexes = {
      {"cad/bracket_fillet_1k.msh", 3123}, {"cad/cyl_ogrid_1k.msh", 975},        {"cad/plate_hole_1k.msh", 1404},
      {"cad/sphere7_1k.msh", 896},         {"cad/ring_twist90_1k.msh", 567},     {"cad/two_material_1k.msh", 1728},
      {"mesh/cad_component_hex.msh", 40},  {"mesh/pipe_junction_Y_r1.msh", 1920}};
  for (const auto& [name, n] : n_hexes) {
    SCOPED_TRACE(name);
    const auto file = read_mesh(data / name);
    EXPECT_EQ(file.mesh.n_hexes(), n);
    // deal.II writes format 1 with all hexes inside out; this CAD has a dangling face and point with nodes of no hex.
    const bool dangling = name == "mesh/cad_component_hex.msh", inside_out = name == "mesh/pipe_junction_Y_r1.msh";
    EXPECT_EQ(static_cast<bool>(test::conformal(file.mesh)), !dangling);
    EXPECT_EQ(static_cast<bool>(test::uninverted(file.mesh)), !inside_out);
    for (Index h = 0; inside_out && h < n; ++h) EXPECT_LT(volume(file.mesh, h), 0);
    EXPECT_TRUE(test::sets_valid(file.mesh));
    for (const Mode mode : modes) {
      auto back = there_and_back(file.mesh, &file.tags, mode);
      EXPECT_EQ(others_text(file.mesh), others_text(back.mesh));
      back.mesh.others = file.mesh.others;
      EXPECT_TRUE(test::same_mesh(file.mesh, back.mesh));
      // Format 2.2 says owners by elements only.
      if (dangling && mode.version == 22) continue;
      EXPECT_TRUE(test::same_owners(file.tags, back.tags)) << mode.version;
    }
  }
}

}  // namespace
}  // namespace hextwist
