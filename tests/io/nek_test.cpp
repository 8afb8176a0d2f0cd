// Nek5000's .re2 as others write them.
#include <cmath>
#include <cstdio>
#include <random>

#include "hextwist/mesh/topology.h"
#include "io/io_support.h"

namespace hextwist {
namespace {

std::string bytes_of(const auto& value, bool swapped) {
  std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
  if (swapped) std::ranges::reverse(bytes);
  return bytes;
}

/// Two unit cubes along x, as a program of Nek would write them: words of 4 or 8 bytes, in either byte order.
std::string nek_cubes(int version, bool swapped, int n_fluid = 2, const std::string& tail = "") {
  std::array<char, 40> counts{};
  std::snprintf(counts.data(), counts.size(), "%9d%3d%9d", 2, 3, n_fluid);
  std::string file = "#v00" + std::to_string(version) + counts.data() + " this is the hdr";
  file.resize(80, ' ');
  file += bytes_of(6.54321F, swapped);
  const auto word = [&](double value, bool integer = false) {
    if (version > 1) return bytes_of(value, swapped);
    return integer ? bytes_of(static_cast<std::int32_t>(value), swapped) : bytes_of(static_cast<float>(value), swapped);
  };
  for (int e = 0; e < 2; ++e) {
    file += word(e == 0 ? 0 : 4, true);
    for (const double x : {0, 1, 1, 0, 0, 1, 1, 0}) file += word(x + e);
    for (const double y : {0, 0, 1, 1, 0, 0, 1, 1}) file += word(y + 1e-6 * e);  // not quite the same
    for (const double z : {0, 0, 0, 0, 1, 1, 1, 1}) file += word(z);
  }
  const auto entry = [&](int element, int item, std::array<double, 5> numbers, std::string code) {
    file += word(element, true) + word(item, true);
    for (const double x : numbers) file += word(x);
    code.resize(version > 1 ? 8 : 4, ' ');
    file += code;
  };
  file += word(3, true);
  entry(1, 1, {0.5, -0.1, 0, 0, 0}, "m");
  entry(2, 12, {1.5, 1.25, 0.5, 0, 0}, "m");
  entry(2, 1, {3, 0, 0, 0, 0}, "C");
  file += word(6, true);
  entry(1, 4, {0, 0, 0, 0, 7}, "MSH");
  entry(2, 2, {0, 0, 0, 0, 0}, "O");
  entry(1, 2, {2, 4, 0, 0, 0}, "E");
  entry(1, 5, {0, 0, 0, 0, 0}, "W");
  entry(2, 5, {1, 5, 0, 0, 0}, "W");
  entry(2, 6, {0, 0, 2.5, 0, 0}, "V");
  return file + tail;
}

TEST(nek_files, of_all_versions_and_byte_orders_are_understood) {
  const auto folder = test::output_folder();
  for (const int version : {1, 2, 3})
    for (const bool swapped : {false, true}) {
      SCOPED_TRACE(testing::Message() << version << " " << swapped);
      const MeshFile read = read_mesh(test::write_text(folder / "a.re2", nek_cubes(version, swapped)));
      EXPECT_EQ(read.mesh.n_nodes(), 12);
      EXPECT_NEAR(volume(read.mesh), 2, 1e-5);
      EXPECT_EQ(read.mesh.blocks, (std::vector<Block>{{4, "", {1}}}));
      EXPECT_EQ(read.mesh.side_sets,
                (std::vector<SideSet>{
                    {7, "", {{0, 0}}}, {8, "O", {{1, 1}}}, {9, "V", {{1, 5}}}, {10, "W", {{0, 4}, {1, 4}}}}));
      EXPECT_EQ(read.middles.nodes_per_hex, 20);
      ASSERT_EQ(read.middles.edges.size(), 2U);
      EXPECT_NEAR((read.middles.edge_points[0] - Vec3(0.5, -0.1, 0)).norm(), 0, 1e-7);
      // Edge 12 is the pillar at the fourth corner.
      EXPECT_NEAR((read.middles.edge_points[1] - Vec3(1.5, 1.25, 0.5)).norm(), 0, 1e-7);
      const auto [a, b] = read.middles.edges[1];
      EXPECT_NEAR((read.mesh.points[a] + read.mesh.points[b] - Vec3(2, 2, 1)).norm(), 0, 1e-5);
      EXPECT_TRUE(test::told(read.notices, "corners of elements were merged by their places: 16 to 12 nodes"));
      EXPECT_TRUE(test::told(read.notices, "1 curved side of kind 'C' left out: it is straight here"));
      EXPECT_TRUE(test::told(read.notices, "values of 1 condition 'V' are left out"));
      EXPECT_FALSE(test::told(read.notices, "'W' are left out"));
    }
}

TEST(nek_files, solid_elements_come_last_and_back) {
  const auto folder = test::output_folder();
  const MeshFile read = read_mesh(test::write_text(folder / "a.re2", nek_cubes(2, false, 1)));
  EXPECT_EQ(read.mesh.blocks, (std::vector<Block>{{4, "", {1}}, {5, "fluid", {0}}, {6, "solid", {1}}}));
  Mesh mesh = read.mesh;
  std::swap(mesh.blocks[1].hexes, mesh.blocks[2].hexes);
  write_mesh(folder / "b.re2", mesh, nullptr);
  EXPECT_EQ(test::text_of(folder / "b.re2").substr(0, 26), "#v003        2  3        1");
  const Mesh back = read_mesh(folder / "b.re2").mesh;
  EXPECT_EQ(back.blocks, (std::vector<Block>{{4, "", {0}}, {5, "fluid", {0}}, {6, "solid", {1}}}));
  EXPECT_EQ(volume(back, 0), volume(mesh, 1));
  EXPECT_EQ(
      back.side_sets,
      (std::vector<SideSet>{{7, "", {{1, 0}}}, {8, "O", {{0, 1}}}, {9, "V", {{0, 5}}}, {10, "W", {{0, 4}, {1, 4}}}}));
}

/// A crack along a face, closed or nearly: readers know nodes by their places.
TEST(nek_files, nodes_at_one_place_are_told) {
  const auto folder = test::output_folder();
  for (const double opening : {0., 1e-4, 0.2}) {
    Mesh mesh = test::grid(2, 2, 1);
    for (Index& node : mesh.hexes[0])
      if (mesh.points[node].x() == 1 && mesh.points[node].y() == 0) {
        mesh.points.push_back(mesh.points[node] - Vec3(opening, 0, 0));
        node = mesh.n_nodes() - 1;
      }
    const auto notices = write_mesh(folder / "a.re2", mesh, nullptr);
    const bool joined = read_mesh(folder / "a.re2").mesh.n_nodes() != mesh.n_nodes();
    EXPECT_EQ(joined, opening < 0.1);
    EXPECT_EQ(test::told(notices, "2 nodes are joined with others when the file is read"), joined) << opening;
    EXPECT_EQ(test::told(notices, "joined"), joined) << opening;
  }
}

/// Three hundred unit cubes, each with corners of its own, all within a hundredth of an edge.
TEST(nek_files, corners_too_near_to_tell_apart_are_told) {
  const auto file = test::output_folder() / "a.re2";
  Mesh mesh;
  for (int h = 0; h < 300; ++h) {
    Hex& hex = mesh.hexes.emplace_back();
    for (int c = 0; c < 8; ++c) {
      hex[static_cast<std::size_t>(c)] = mesh.n_nodes();
      mesh.points.emplace_back((c & 1) + 1e-5 * h, c >> 1 & 1, c >> 2 & 1);
    }
  }
  EXPECT_TRUE(test::told(write_mesh(file, mesh, nullptr), "too many corners lie too near to one"));
  EXPECT_NE(test::refusal(file).find("too many corners lie too near to one of element"), std::string::npos);
}

TEST(nek_files, what_is_wrong_is_said_with_its_byte) {
  const auto folder = test::output_folder();
  const std::string good = nek_cubes(2, false);
  const auto says = [&](std::string text, const std::string& expected) {
    const auto file = test::write_text(folder / "a.re2", text);
    EXPECT_EQ(test::refusal(file), file.string() + expected);
  };
  const auto with = [&](std::size_t at, const std::string& bytes) {
    return std::string(good).replace(at, bytes.size(), bytes);
  };
  const auto number = [](double x) { return bytes_of(x, false); };
  says("#v002", ", byte 0: the file is too short for a header");
  says(with(0, "$"), ", byte 0: not an .re2 file: it does not begin with #v001, #v002 or #v003");
  says(with(4, "4"), ", byte 0: version '#v004' is none of #v001, #v002 and #v003");
  says(with(5, "        x"), ", byte 5: expected the number of elements, found '        x'");
  says(with(5, "999999999"), ", byte 84: the file is too short for 999999999 elements");
  says(with(14, "  2"), ", byte 0: a mesh of dimension 2 instead of 3");
  says(with(80, "abcd"), ", byte 80: the mark of the byte order is not 6.54321");
  says(with(92, number(std::nan(""))), ", byte 84: a coordinate of element 1 is not finite");
  says(with(84, number(0.5)), ", byte 84: expected the group of an element, found 0.5");
  const std::size_t curves = 84 + 2 * 200;
  says(with(curves, number(1e9)), ", byte 492: the file is too short for 1000000000 the number of curved sides");
  says(with(curves + 8, number(3)), ", byte 492: element 3 is not between 1 and 2");
  says(with(curves + 16, number(13)), ", byte 500: edge 13 is not between 1 and 12");
  const std::size_t conditions = curves + 8 + 3 * 64;
  says(with(conditions + 16, number(7)), ", byte 700: side 7 is not between 1 and 6");
  says(good.substr(0, good.size() - 8), ", byte 692: the file is too short for 6 the number of conditions");
  std::string flat = good;
  for (std::size_t c = 0; c < 8; ++c) flat.replace(92 + 64 + 8 * c, 8, number(0));
  says(flat, ": element 1 is a tetrahedron (a hex with repeated nodes); only hexes of 8, 20 or 27 nodes are accepted");
}

TEST(nek_files, what_can_not_be_kept_is_told) {
  const auto folder = test::output_folder();
  Mesh mesh = test::rich_mesh(2, true);
  const Side first = boundary_sides(faces(mesh)).front();
  for (SideSet& set : mesh.side_sets) {
    set.sides.push_back(first);
    std::ranges::sort(set.sides);
    set.sides.erase(std::ranges::unique(set.sides).begin(), set.sides.end());
  }
  const auto notices = write_mesh(folder / "a.re2", mesh, nullptr);
  EXPECT_TRUE(test::told(notices, "fields"));
  EXPECT_TRUE(test::told(notices, ".re2 has no ids: elements are counted from 1 in the file"));
  EXPECT_TRUE(test::told(notices, "3 node sets left out: .re2 has none"));
  EXPECT_TRUE(test::told(
      notices, ".re2 has numbers of groups, no names: 1 is block 2 'steel (hot)', 2 is block 5, 3 is block 70"));
  EXPECT_TRUE(test::told(notices, "blocks overlap, and a hex is in one group only in .re2"));
  EXPECT_TRUE(test::told(
      notices, ".re2 has numbers of side sets (the fifth of a condition), no names: 3 is side set 3 'pressure'"));
  EXPECT_TRUE(test::told(notices, "of side sets left out, which are not at the boundary"));
  EXPECT_TRUE(test::told(notices, "side sets overlap, and a side has one condition in .re2"));
}

/// Nodes far from the origin and elements of very different sizes: what is merged depends on the element alone.
TEST(nek_files, corners_are_merged_by_the_size_of_their_elements) {
  const auto folder = test::output_folder();
  for (unsigned seed = 1; seed < 9; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    Mesh mesh = test::shuffled(test::grid(6, 5, 4), random);
    std::uniform_real_distribution<double> factor(0.1, 10);
    std::array<std::vector<double>, 3> at;
    for (auto& axis : at) {
      axis = {1e3 * factor(random)};
      for (int i = 0; i < 6; ++i) axis.push_back(axis.back() + std::pow(10.0, -4 + 7 * factor(random) / 10));
    }
    for (Vec3& p : mesh.points)
      for (int axis = 0; axis < 3; ++axis) p[axis] = at[axis][static_cast<std::size_t>(std::lround(p[axis]))];
    write_mesh(folder / "a.re2", mesh, nullptr);
    const Mesh back = read_mesh(folder / "a.re2").mesh;
    EXPECT_EQ(back.n_nodes(), mesh.n_nodes());
    EXPECT_EQ(test::corners_of_hexes(back), test::corners_of_hexes(mesh));
  }
}

}  // namespace
}  // namespace hextwist
