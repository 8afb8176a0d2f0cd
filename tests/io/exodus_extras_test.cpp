// What Exodus files say beyond mesh and fields: times, factors, attributes, ids, records.
#include <exodusII.h>

#include <numeric>

#include "hextwist/io/results.h"
#include "io/io_support.h"
#include "support/exodus_extras.h"

namespace hextwist {
namespace {

using test::with_extras;

testing::AssertionResult same_values(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return testing::AssertionFailure() << a.size() << " values, not " << b.size();
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!(a[i] == b[i] || (std::isnan(a[i]) && std::isnan(b[i]))))
      return testing::AssertionFailure() << i << ": " << a[i] << ", not " << b[i];
  return testing::AssertionSuccess();
}
void expect_same(const std::vector<TimedValues>& a, const std::vector<TimedValues>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t v = 0; v < a.size(); ++v) {
    EXPECT_EQ(a[v].name, b[v].name);
    ASSERT_EQ(a[v].at.size(), b[v].at.size());
    for (std::size_t t = 0; t < a[v].at.size(); ++t) EXPECT_TRUE(same_values(*a[v].at[t], *b[v].at[t])) << a[v].name;
  }
}

TEST(ExodusExtras, everything_comes_back) {
  const Mesh mesh = with_extras();
  const auto file = test::output_folder() / "all.e";
  EXPECT_TRUE(write_mesh(file, mesh, nullptr).empty());
  const MeshFile read = read_mesh(file);
  EXPECT_TRUE(read.notices.empty());
  ASSERT_TRUE(read.mesh.results);
  const FileResults &was = *mesh.results, &is = *read.mesh.results;
  EXPECT_EQ(is.times, was.times);
  EXPECT_EQ(is.step, 2u);
  expect_same(is.on_nodes, was.on_nodes);
  expect_same(is.of_all, was.of_all);
  expect_same(is.attributes, was.attributes);
  ASSERT_EQ(is.node_sets.size(), 2u);
  EXPECT_EQ(is.node_sets[0].factors, std::vector<double>{3});
  EXPECT_EQ(is.node_sets[1].factors, was.node_sets[1].factors);
  expect_same(is.node_sets[1].variables, was.node_sets[1].variables);
  ASSERT_EQ(is.side_sets.size(), 1u);
  EXPECT_EQ(is.properties.size(), 1u);
  EXPECT_EQ(is.properties[0].values, was.properties[0].values);
  EXPECT_EQ(std::tie(is.title, is.coordinate_names, is.info, is.qa),
            std::tie(was.title, was.coordinate_names, was.info, was.qa));
  // The hexes are in the order of the blocks there; once more is the same file.
  const auto again = file.parent_path() / "again.e";
  EXPECT_TRUE(write_mesh(again, read.mesh, nullptr).empty());
  EXPECT_EQ(test::text_of(again), test::text_of(file));
}

TEST(ExodusExtras, factors_of_second_order_are_as_many_as_nodes_of_sides) {
  const Mesh mesh = with_extras();
  for (const int nodes_per_hex : {20, 27}) {
    SCOPED_TRACE(nodes_per_hex);
    const auto file = test::output_folder() / "second.e", again = test::output_folder() / "first.e";
    WriteOptions options;
    options.order = 2;
    options.nodes_per_hex = nodes_per_hex;
    options.overwrite = true;
    write_mesh(file, mesh, nullptr, options);
    float version = 0;
    int memory = 8, disk = 0, n = 0, n_factors = 0;
    const int id = ex_open(file.c_str(), EX_READ, &memory, &disk, &version);
    ASSERT_GE(ex_get_set_param(id, EX_SIDE_SET, 4, &n, &n_factors), 0);
    std::vector<int> counts(static_cast<std::size_t>(n));
    ASSERT_GE(ex_get_side_set_node_count(id, 4, counts.data()), 0);  // what the library says of each side
    EXPECT_EQ(n_factors, std::accumulate(counts.begin(), counts.end(), 0));
    ASSERT_GE(ex_get_set_param(id, EX_NODE_SET, 3, &n, &n_factors), 0);
    EXPECT_EQ(n_factors, n);
    ex_close(id);
    const MeshFile read = read_mesh(file);
    for (const std::string& said : read.notices) EXPECT_EQ(said.find("factors"), std::string::npos) << said;
    ASSERT_EQ(read.mesh.results->side_sets.size(), 1u);
    EXPECT_EQ(read.mesh.results->side_sets[0].factors, mesh.results->side_sets[0].factors);
  }
}

TEST(ExodusExtras, what_other_formats_have_no_place_for_is_said) {
  const Mesh mesh = with_extras();
  for (const char* name : {"a.msh", "a.vtu", "a.inp", "a.mesh"}) {
    const std::vector<std::string> notices = write_mesh(test::output_folder() / name, mesh, nullptr);
    ASSERT_FALSE(notices.empty()) << name;
    EXPECT_EQ(
        notices.back().substr(notices.back().find(' ')),
        " has no place for what came with 2 more time steps, global variable 'energy', attribute 'density' of hexes, "
        "distribution factors of nodeset 0, distribution factors of nodeset 3, variable 'reaction' of nodeset 3, "
        "distribution factors of sideset 4, variable 'flux' of sideset 4, property 'MATERIAL': left out");
  }
}

TEST(ExodusExtras, a_mesh_that_lost_its_places_says_what_it_lost) {
  Mesh mesh = with_extras();
  mesh.file_hexes.clear();
  const auto file = test::output_folder() / "lost.e";
  const auto notices = write_mesh(file, mesh, nullptr);
  ASSERT_EQ(notices.size(), 1u);
  EXPECT_EQ(notices[0].find("left out, as it is no longer known where in their file the hexes lie: 2 more time steps"),
            0u);
  const Mesh back = read_mesh(file).mesh;
  EXPECT_EQ(back.results->times, std::vector<double>{2.5});
  EXPECT_EQ(back.fields[0].values, mesh.fields[0].values);
}

TEST(ExodusExtras, ids_of_any_size_are_kept) {
  Mesh mesh = with_extras();
  mesh.blocks[1].id = 1;
  auto extras = std::make_shared<FileResults>(*mesh.results);
  extras->blocks[0].id = 1;
  extras->properties.clear();
  extras->wide_ids = {{FileResults::Of::block, 1, 5000000000},
                      {FileResults::Of::node_set, 3, 3000000000},
                      {FileResults::Of::side_set, 4, -2}};
  mesh.results = extras;
  const auto file = test::output_folder() / "wide.e";
  EXPECT_TRUE(write_mesh(file, mesh, nullptr).empty());
  const MeshFile read = read_mesh(file);
  EXPECT_EQ(read.notices.size(), 3u);
  EXPECT_EQ(read.notices[0],
            "element block 5000000000 has the id 1 here, where ids go from 0 to 2147483647; Exodus files are "
            "written with its own");
  EXPECT_EQ(read.mesh.blocks[0].id, 0);
  EXPECT_EQ(read.mesh.blocks[1].name, "right");
  EXPECT_EQ(read.mesh.node_sets[0].id, 0);
  const auto again = file.parent_path() / "again.e";
  EXPECT_TRUE(write_mesh(again, read.mesh, nullptr).empty());
  const MeshFile twice = read_mesh(again);
  EXPECT_EQ(twice.mesh.results->in_file(FileResults::Of::block, 1), 5000000000);
  EXPECT_EQ(twice.notices, read.notices);
}

TEST(ExodusExtras, a_block_over_all_others_leaves_them_their_hexes) {
  Mesh mesh = test::grid(4, 1, 1);
  mesh.blocks = {{1, "all", {0, 1, 2, 3}}, {2, "steel", {0, 1}}, {3, "wood", {2, 3}}, {9, "both", {1, 2}}};
  const auto file = test::output_folder() / "blocks.e";
  const auto notices = write_mesh(file, mesh, nullptr);
  ASSERT_EQ(notices.size(), 2u);
  EXPECT_EQ(notices[0],
            "block 1 'all' overlaps others, which element blocks can't: of its 4 hexes none is in an element block of "
            "its own, 2 in element block 2 'steel', 2 in element block 3 'wood'; all of it is element set 1 'all'");
  EXPECT_EQ(notices[1].find("block 9 'both' overlaps others"), 0u);
  EXPECT_TRUE(test::same_mesh(mesh, read_mesh(file).mesh));
  if (std::system("command -v ncdump > /dev/null") != 0) GTEST_SKIP() << "no ncdump";
  const auto text = file.parent_path() / "dump.txt";
  ASSERT_EQ(std::system(("ncdump -v eb_prop1,els_prop1 " + file.string() + " > " + text.string()).c_str()), 0);
  EXPECT_NE(test::text_of(text).find("eb_prop1 = 2, 3 ;"), std::string::npos);
  EXPECT_NE(test::text_of(text).find("els_prop1 = 1, 9 ;"), std::string::npos);
}

TEST(ExodusExtras, names_that_had_to_change_are_said) {
  Mesh mesh = test::grid(1, 1, 1);
  mesh.node_sets = {{5, std::string(300, 'n'), {0}}};
  mesh.fields = {{"v", Field::On::node, 3, std::vector<double>(24, 1)},
                 {"v_x", Field::On::node, 1, std::vector<double>(8, 2)}};
  const auto file = test::output_folder() / "names.e";
  const auto notices = write_mesh(file, mesh, nullptr);
  ASSERT_EQ(notices.size(), 2u);
  EXPECT_EQ(notices[0], "field of nodes 'v_x' is called 'v_x_2' in the file");
  EXPECT_NE(notices[1].find("' is called 'nnn"), std::string::npos);
  EXPECT_EQ(read_mesh(file).mesh.fields.size(), 2u);
}

TEST(ExodusExtras, names_that_had_to_change_are_said_of_other_formats_too) {
  Mesh mesh = test::grid(1, 1, 1);
  mesh.blocks = {{3, "a \"b\"", {0}}};
  mesh.node_sets = {{4, "fine", {0}}};
  const auto folder = test::output_folder();
  EXPECT_EQ(write_mesh(folder / "a.msh", mesh, nullptr),
            std::vector<std::string>{"physical group 3 'a \"b\"' is called 'a 'b'' in the file"});
  const auto notices = write_mesh(folder / "a.inp", mesh, nullptr);
  ASSERT_EQ(notices.size(), 1u);
  EXPECT_EQ(notices[0].find("names that Abaqus cannot have are others in the file: "), 0u);
}

TEST(ExodusExtras, files_of_any_name_are_read_by_word_and_by_content) {
  const Mesh mesh = test::grid(2, 1, 1);
  const auto folder = test::output_folder();
  write_mesh(folder / "a.e", mesh, nullptr);
  for (const char* name : {"out.e-s002", "mesh.e.4.0", "mesh.ex2", "mesh"}) {
    std::filesystem::copy_file(folder / "a.e", folder / name);
    EXPECT_TRUE(test::same_mesh(mesh, read_mesh(folder / name).mesh)) << name;
    EXPECT_TRUE(test::same_mesh(mesh, read_mesh(folder / name, "exodus").mesh)) << name;
  }
  write_mesh(folder / "b.e-s003", mesh, nullptr, {.format = "exodus"});
  EXPECT_TRUE(test::same_mesh(mesh, read_mesh(folder / "b.e-s003").mesh));
  write_mesh(folder / "c.dat", mesh, nullptr, {.format = "vtk"});
  EXPECT_TRUE(test::same_mesh(mesh, read_mesh(folder / "c.dat", "vtk").mesh));
  std::ofstream(folder / "d.txt") << "no mesh";
  EXPECT_THROW(read_mesh(folder / "d.txt"), Error);
}

}  // namespace
}  // namespace hextwist
