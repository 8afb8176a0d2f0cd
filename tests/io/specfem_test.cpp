// SPECFEM3D's mesh folders.
#include "io/io_support.h"

namespace hextwist {
namespace {

TEST(specfem_folders, materials_keep_their_properties) {
  const auto folder = test::output_folder();
  Mesh mesh = test::grid(3, 1, 1);
  mesh.blocks = {{3, "upper crust", {1}}, {8, "", {2}}};
  mesh.side_sets = {{2, "absorbing_surface_file_xmin", {{0, 0}}}, {5, "inlet", {{2, 1}}}};
  mesh.node_sets = {{1, "", {0}}};
  const auto notices = write_mesh(folder / "MESH" / "a.specfem", mesh, nullptr);
  EXPECT_TRUE(test::told(notices, "1 node set left out: SPECFEM3D has none"));
  EXPECT_TRUE(test::told(notices, "hexes in no block are of material 3"));
  EXPECT_TRUE(test::told(notices, "materials are counted in SPECFEM3D: 1 is block 3, 2 is block 8"));
  EXPECT_TRUE(test::told(notices, "no properties of 3 materials: put density and speeds in place of the zeros"));
  EXPECT_TRUE(test::told(notices, "only: 5 'inlet'"));
  const auto list = folder / "MESH" / "nummaterial_velocity_file";
  EXPECT_EQ(test::text_of(list),
            "2 1 0 0 0 9999 9999 0 ! hextwist block 3 upper crust\n2 2 0 0 0 9999 9999 0 ! hextwist block 8 \n"
            "2 3 0 0 0 9999 9999 0\n");
  EXPECT_EQ(test::text_of(folder / "MESH" / "materials_file"), "1 3\n2 1\n3 2\n");
  EXPECT_EQ(test::text_of(folder / "MESH" / "absorbing_surface_file_xmin"), "1\n1 1 9 13 5\n");
  EXPECT_EQ(test::text_of(folder / "MESH" / "absorbing_surface_file_ymin"), "0\n");
  // Others fill in what a material is.
  test::write_text(list,
                   "# domain, number, ...\n2 1 2300 2800.5 1500 9999. 9999. 0 ! hextwist block 3 upper crust\n"
                   "2 -1 tomography elastic tomo.xyz 1\n\n1 2 1020 1500 0 9999 9999 0\n");
  test::write_text(folder / "MESH" / "materials_file", "1 2\n3 1\n2 -1\n");
  const MeshFile read = read_mesh(folder / "MESH" / "any.specfem");
  EXPECT_EQ(read.mesh.blocks, (std::vector<Block>{{2, "", {0}}, {3, "upper crust", {2}}, {4, "", {1}}}));
  EXPECT_EQ(read.extras.materials, (std::map<int, std::string>{{2, "1 1020 1500 0 9999 9999 0"},
                                                               {3, "2 2300 2800.5 1500 9999. 9999. 0"},
                                                               {4, "2 tomography elastic tomo.xyz 1"}}));
  EXPECT_EQ(read.mesh.side_sets[1], (SideSet{2, "absorbing_surface_file_xmin", {{0, 0}}}));
  WriteOptions options;
  options.extras = &read.extras;
  EXPECT_FALSE(test::told(write_mesh(folder / "b" / "a.specfem", read.mesh, nullptr, options), "no properties"));
  EXPECT_EQ(test::text_of(folder / "b" / "nummaterial_velocity_file"),
            "1 1 1020 1500 0 9999 9999 0 ! hextwist block 2 \n"
            "2 2 2300 2800.5 1500 9999. 9999. 0 ! hextwist block 3 upper crust\n"
            "2 -1 tomography elastic tomo.xyz 1 ! hextwist block 4 \n");
  const MeshFile again = read_mesh(folder / "b" / "a.specfem");
  EXPECT_EQ(again.mesh.blocks, read.mesh.blocks);
  EXPECT_EQ(again.extras.materials, read.extras.materials);
  EXPECT_TRUE(test::told(write_mesh(folder / "a.msh", read.mesh, nullptr, options),
                         "properties of 3 materials left out, which only .specfem has"));
}

TEST(specfem_folders, what_is_wrong_is_said_with_file_and_line) {
  const auto folder = test::output_folder();
  const Mesh mesh = test::grid(2, 1, 1);
  const auto says = [&](const char* name, const std::string& text, const std::string& expected) {
    write_mesh(folder / "a.specfem", mesh, nullptr);
    test::write_text(folder / name, text);
    EXPECT_EQ(test::refusal(folder / "a.specfem"), (folder / name).string() + expected);
  };
  says("nodes_coords_file", "", ": is empty");
  says("nodes_coords_file", "99999999\n1 0 0 0\n", ":1: the file is too short for 99999999 nodes");
  says("nodes_coords_file", "2\n1 0 0 0\n1 0 0 0\n", ":3: node 1 occurs twice");
  says("nodes_coords_file", "2\n1 0 0 0\n3 0 0 0\n", ":3: node 3 is not between 1 and 2");
  says("nodes_coords_file", "2\n1 0 0 0\n2 0 x 0\n", ":3: expected a coordinate, found 'x'");
  says("nodes_coords_file", "1\n1 0 0 0\n2 0 0 0\n", ":3: there is more than the nodes");
  says("mesh_file", "1\n1 1 2 5 4 7 8 11 99\n", ":2: element 1 names node 99, which is not there");
  says("mesh_file", "1\n1 1 2 5 4\n", ":2: an element of 4 nodes; only hexes of 8 or 27 nodes are accepted");
  says("mesh_file", "0\n", ":1: there is no hex in the file");
  says("mesh_file", "1\n1 1 2 5 5 7 8 11 11\n",
       ":2: element 1 is a wedge (a hex with repeated nodes); only hexes of 8, 20 or 27 nodes are accepted");
  says("materials_file", "1 1\n", ":2: the file ends where element should stand");
  says("materials_file", "1 1\n1 1\n", ":2: element 1 occurs twice");
  says("nummaterial_velocity_file", "2 x 0\n",
       ":1: expected a domain, the number of a material and its properties, found '2 x 0'");
  says("absorbing_surface_file_xmin", "1\n3 1 7 10 4\n", ":2: element 3 is not there");
  says("absorbing_surface_file_xmin", "1\n2 1 7 10 4\n", ":2: these are no corners of a side of element 2");
  std::filesystem::remove(folder / "mesh_file");
  EXPECT_EQ(test::refusal(folder / "a.specfem"),
            (folder / "mesh_file").string() + ": cannot be opened: No such file or directory");
}

}  // namespace
}  // namespace hextwist
