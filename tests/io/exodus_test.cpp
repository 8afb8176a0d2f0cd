#include <netcdf.h>

#include <array>
#include <fstream>
#include <iterator>

#include "hextwist/base/memory.h"
#include "io/io_support.h"

namespace hextwist {
namespace {

TEST(exodus_files, a_mesh_with_everything_comes_back_bit_for_bit) {
  for (unsigned seed = 1; seed < 6; ++seed) {
    SCOPED_TRACE(seed);
    const Mesh mesh = test::rich_mesh(seed, seed % 2);
    const auto file = test::output_folder() / "mesh.e";
    write_mesh(file, mesh, nullptr);
    const auto back = read_mesh(file);
    EXPECT_TRUE(test::same_mesh(mesh, back.mesh));
    EXPECT_TRUE(back.notices.empty());
  }
}

/// What netCDF's buffers held before must not be behind names.
TEST(exodus_files, names_are_followed_by_zeros) {
  const auto file = test::output_folder() / "mesh.e";
  int n_texts = 0;
  for (int n = 1; n <= 500; ++n) {  // names at all places of a page
    Mesh mesh = n % 100 ? test::grid(n, 1, 1) : test::rich_mesh(1, true, {n / 10, 4, 3});
    for (Vec3& point : mesh.points) point += Vec3(1.1, 2.2, 3.3);
    write_mesh(file, mesh, nullptr);
    int id = -1, n_variables = 0;
    ASSERT_EQ(nc_open(file.c_str(), NC_NOWRITE, &id), NC_NOERR);
    nc_inq_nvars(id, &n_variables);
    for (int v = 0; v < n_variables; ++v) {
      nc_type type = NC_NAT;
      int n_dimensions = 0;
      std::array<int, NC_MAX_VAR_DIMS> dimensions;
      std::array<char, NC_MAX_NAME + 1> name;
      ASSERT_EQ(nc_inq_var(id, v, name.data(), &type, &n_dimensions, dimensions.data(), nullptr), NC_NOERR);
      if (type != NC_CHAR || n_dimensions != 2) continue;
      std::size_t rows = 0, length = 0;
      nc_inq_dimlen(id, dimensions[0], &rows);
      nc_inq_dimlen(id, dimensions[1], &length);
      std::string texts(rows * length, '\0');
      ASSERT_EQ(nc_get_var_text(id, v, texts.data()), NC_NOERR);
      for (std::size_t row = 0; row < rows; ++row) {
        const std::string text = texts.substr(row * length, length), said = text.c_str();
        EXPECT_EQ(text.find_first_not_of('\0', said.size()), std::string::npos) << name.data() << ", n = " << n;
        ++n_texts;
      }
    }
    nc_close(id);
  }
  EXPECT_GT(n_texts, 20);
}

TEST(exodus_files, blocks_that_divide_the_mesh_need_no_sets) {
  Mesh mesh = test::grid(3, 2, 2);
  mesh.blocks = {{4, "a", {0, 3, 6}}, {7, "", {1, 2, 4, 5, 7, 8, 9, 10, 11}}, {8, "none", {}}};
  mesh.hex_ids = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, std::int64_t{1} << 40};
  const auto file = test::output_folder() / "mesh.exo";
  write_mesh(file, mesh, nullptr);
  EXPECT_TRUE(test::same_mesh(mesh, read_mesh(file).mesh));
}

TEST(exodus_files, sides_lie_where_their_numbers_say) {
  // Sandia's figure: side 1 is at y = 0 (nodes 1 2 6 5), 2 at x = 1, 3 at y = 1, 4 at x = 0, 5 at z = 0, 6 at z = 1.
  Mesh mesh = test::grid(1, 1, 1);
  for (int f = 0; f < 6; ++f) mesh.side_sets.push_back({f + 1, "", {{0, f}}});
  const auto file = test::output_folder() / "mesh.e";
  write_mesh(file, mesh, nullptr);
  EXPECT_TRUE(test::same_mesh(mesh, read_mesh(file).mesh));
  if (std::system("command -v ncdump > /dev/null") != 0) GTEST_SKIP() << "no ncdump";
  const std::array<int, 6> side_of_face = {4, 2, 1, 3, 5, 6};  // x = 0, x = 1, y = 0, ...
  for (int f = 0; f < 6; ++f) {
    const auto text = file.parent_path() / "dump.txt";
    const std::string name = "side_ss" + std::to_string(f + 1);
    ASSERT_EQ(std::system(("ncdump -v " + name + " " + file.string() + " > " + text.string()).c_str()), 0);
    EXPECT_NE(test::text_of(text).find(" " + name + " = " + std::to_string(side_of_face[f]) + " ;"), std::string::npos);
  }
}

TEST(exodus_files, a_real_mesh_has_the_known_counts) {
  const auto data = test::data_folder();
  if (data.empty()) GTEST_SKIP() << "no folder of real meshes";
  const auto file = read_mesh(data / "mesh/mastodon_model_1.e");
  const Mesh& mesh = file.mesh;
  EXPECT_EQ(mesh.n_hexes(), 6456);
  EXPECT_EQ(mesh.n_nodes(), 7450);
  ASSERT_EQ(mesh.blocks.size(), 2);
  EXPECT_EQ(mesh.blocks[0].hexes.size(), 2424);
  EXPECT_EQ(mesh.blocks[1].hexes.size(), 4032);
  ASSERT_EQ(mesh.side_sets.size(), 2);
  EXPECT_EQ(mesh.side_sets[0].sides.size(), 324);
  EXPECT_EQ(mesh.side_sets[1].sides.size(), 224);
  EXPECT_TRUE(test::conformal(mesh));
  EXPECT_TRUE(test::uninverted(mesh));
  EXPECT_TRUE(test::sets_valid(mesh));
  // The sides of a side set of a good mesh are boundary faces of one plane or smooth surface; at least none is inside.
  const Faces all = faces(mesh);
  for (const SideSet& set : mesh.side_sets)
    for (const Side& side : set.sides) EXPECT_EQ(all.sides[all.of_hex[side.hex][side.face]][1].hex, -1);
  const auto copy = test::output_folder() / "copy.g";
  write_mesh(copy, mesh, nullptr);
  EXPECT_TRUE(test::same_mesh(mesh, read_mesh(copy).mesh));
}

TEST(exodus_files, no_byte_of_the_header_makes_it_ask_for_much_memory) {
  Mesh mesh = test::grid(2, 2, 2);
  mesh.blocks.push_back({1, "a", {0, 1}});
  mesh.fields.push_back({"u", Field::On::node, 1, std::vector<double>(mesh.points.size(), 1)});
  const auto file = test::output_folder() / "mesh.e", changed = test::output_folder() / "changed.e";
  write_mesh(file, mesh, nullptr);
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  const std::size_t before = peak_memory(), header = bytes.find("coordx");
  ASSERT_NE(header, std::string::npos);
  int n_damaged = 0;
  for (std::size_t at = 3; at < header; ++at)
    for (const char value : {'\xff', '\x7f', '\0'}) {
      std::string other = bytes;
      other[at] = value;
      std::ofstream(changed, std::ios::binary) << other;
      try {
        read_mesh(changed);
      } catch (const Error& error) {
        EXPECT_TRUE(std::string(error.what()).starts_with(changed.string() + ": ")) << error.what();
        n_damaged += std::string(error.what()).find("damaged NetCDF header at byte ") != std::string::npos;
      }
    }
  EXPECT_GT(n_damaged, 100);
  if (!is_sanitized) {  // else two thousand reads are some hundred megabytes
    EXPECT_LT(peak_memory() - before, std::size_t{100} << 20);
  }
}

}  // namespace
}  // namespace hextwist
