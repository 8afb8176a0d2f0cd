// I-deas universal files as others write them: coordinate systems, fields that touch, names.
#include "io/hdf_support.h"
#include "io/io_support.h"

namespace hextwist {
namespace {

constexpr std::array<std::array<int, 3>, 8> corners = {
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};

std::string numbers(std::initializer_list<std::int64_t> all) {
  std::string line;
  for (const std::int64_t number : all) {
    const std::string text = std::to_string(number);
    line += std::string(10 - std::min<std::size_t>(10, text.size()), ' ') + text;
  }
  return line;
}
/// systems: of all nodes: their places, their displacements.
std::string unv_nodes(int system = 1, int displacements = 1, std::int64_t first = 1) {
  std::string text = "    -1\n  2411\n";
  for (std::size_t n = 0; n < 8; ++n) {
    text += numbers({first + static_cast<std::int64_t>(n), system, displacements, 11}) + "\n";
    for (const int x : corners[n]) text += "   " + std::to_string(x) + ".0000000000000000D+00";
    text += "\n";
  }
  return text + "    -1\n";
}
std::string unv_hex(std::int64_t first = 1) {
  std::string nodes;
  for (int n = 0; n < 8; ++n) nodes += numbers({first + n});
  return "    -1\n  2412\n" + numbers({1, 115, 1, 1, 7, 8}) + "\n" + nodes + "\n    -1\n";
}
std::string unv_system(int number, int type, const std::string& matrix, const std::string& name = "a system") {
  return "    -1\n  2420\n" + numbers({1}) + "\n\n" + numbers({number, type, 8}) + "\n" + name + "\n" + matrix +
         "    -1\n";
}
const std::string straight = " 1.0D+00 0.0D+00 0.0D+00\n 0.0D+00 1.0D+00 0.0D+00\n 0.0D+00 0.0D+00 1.0D+00\n";
const std::string turned = " 0.0D+00 1.0D+00 0.0D+00\n-1.0D+00 0.0D+00 0.0D+00\n 0.0D+00 0.0D+00 1.0D+00\n";
const std::string here = " 0.0D+00 0.0D+00 0.0D+00\n", apart = " 1.0D+01 -2.0D+00 5.0D-01\n";

TEST(unv_files, systems_that_move_nodes_do_so_and_others_are_refused) {
  const auto folder = test::output_folder();
  const auto read = [&](const std::string& text) {
    return read_mesh(test::write_text(folder / "a.unv", text + unv_hex()));
  };
  const auto says = [&](const std::string& text, const std::string& expected) {
    const auto file = test::write_text(folder / "a.unv", text + unv_hex());
    EXPECT_EQ(test::refusal(file), file.string() + expected);
  };
  const std::string only = "; only Cartesian ones that are not turned are read";
  const MeshFile plain = read(unv_nodes());
  EXPECT_DOUBLE_EQ(volume(plain.mesh), 1);
  MeshFile moved = read(unv_system(1, 0, straight + here) + unv_nodes());
  EXPECT_TRUE(test::same_mesh(moved.mesh, plain.mesh));
  EXPECT_TRUE(moved.notices.empty()) << moved.notices[0];
  moved = read(unv_nodes() + unv_system(1, 0, straight + here));
  EXPECT_TRUE(test::same_mesh(moved.mesh, plain.mesh));
  moved = read(unv_system(1, 0, " 1.0 1.0D-16 0.0\n-1.0D-16 1.0 0.0\n 0.0 0.0 1.0\n" + here) + unv_nodes());
  EXPECT_TRUE(test::same_mesh(moved.mesh, plain.mesh));
  moved = read(unv_system(3, 0, straight + apart, "") + unv_nodes(3, 1));
  for (std::size_t n = 0; n < 8; ++n) EXPECT_EQ(moved.mesh.points[n], plain.mesh.points[n] + Vec3(10, -2, 0.5));
  EXPECT_TRUE(moved.notices.empty()) << moved.notices[0];
  says(unv_system(3, 1, straight + here) + unv_nodes(3),
       ":14: node 1 is in coordinate system 3, which is cylindrical" + only);
  says(unv_system(1, 2, straight + here) + unv_nodes(),
       ":14: node 1 is in coordinate system 1, which is spherical" + only);
  says(unv_system(1, 0, turned + here) + unv_nodes(), ":14: node 1 is in coordinate system 1, which is turned" + only);
  says(unv_nodes() + unv_system(1, 1, straight + here),
       ":3: node 1 is in coordinate system 1, which is cylindrical" + only);
  says(unv_nodes() + unv_system(1, 0, straight + apart),
       ":3: node 1 is in coordinate system 1, which is defined behind it and has an origin of its own" + only);
  // One that no node is in says nothing of them.
  EXPECT_TRUE(read(unv_system(7, 1, straight + here) + unv_nodes()).notices.empty());
  EXPECT_EQ(read(unv_system(7, 1, straight + here) + unv_nodes(1, 7)).notices,
            (std::vector<std::string>{"coordinate systems of displacements of 8 nodes left out; the first is 1"}));
  EXPECT_EQ(read(unv_nodes(4, 1)).notices,
            (std::vector<std::string>{"node 1 is in coordinate system 4, which the file does not define: such nodes "
                                      "are read as they stand"}));
}

TEST(unv_files, old_systems_and_nodes_are_understood) {
  const auto folder = test::output_folder();
  std::string nodes = "    -1\n    15\n";
  for (std::size_t n = 0; n < 8; ++n) {
    nodes += numbers({static_cast<std::int64_t>(n) + 1, 2, 0, 11});
    for (const int x : corners[n]) nodes += x == 0 ? " -5.00000E-01" : "  5.00000E-01";
    nodes += "\n";
  }
  nodes += "    -1\n";
  const auto system = [&](int type, int reference, const char* points) {
    return "    -1\n    18\n" + numbers({2, type, reference, 8, 1}) + "\nold\n" + points + "    -1\n";
  };
  const char* const moved =
      "  1.00000E+00  2.00000E+00  3.00000E+00  4.00000E+00  2.00000E+00  3.00000E+00\n"
      "  1.00000E+00  2.00000E+00  8.00000E+00\n";
  const char* const turned_points =
      "  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00  1.00000E+00  0.00000E+00\n"
      "  0.00000E+00  0.00000E+00  8.00000E+00\n";
  const MeshFile read = read_mesh(test::write_text(folder / "a.unv", system(0, 0, moved) + nodes + unv_hex()));
  EXPECT_DOUBLE_EQ(volume(read.mesh), 1);
  EXPECT_EQ(read.mesh.points[0], Vec3(0.5, 1.5, 2.5));
  const auto says = [&](const std::string& text, const std::string& expected) {
    const auto file = test::write_text(folder / "a.unv", text + nodes + unv_hex());
    EXPECT_EQ(test::refusal(file), file.string() + ":10: node 1 is in coordinate system 2, which " + expected +
                                       "; only Cartesian ones that are not turned are read");
  };
  says(system(0, 0, turned_points), "is turned");
  says(system(1, 0, moved), "is cylindrical");
  says(system(0, 7, moved), "is defined in another");
}

TEST(unv_files, units_are_told) {
  const auto notices = [&](const std::string& row) {
    const std::string factors = "  1.0D+03  1.0D+00  1.0D+00\n  2.7315D+02\n";
    const std::string text = "    -1\n   164\n" + row + "\n" + factors + "    -1\n" + unv_nodes() + unv_hex();
    return read_mesh(test::write_text(test::output_folder() / "a.unv", text)).notices;
  };
  using Lines = std::vector<std::string>;
  EXPECT_EQ(notices("         1  SI: Meter (newton)         2"), Lines{});
  EXPECT_EQ(notices("         5  mm (milli-newton)          2"),
            Lines{"its units are mm (milli-newton) (dataset 164): lengths stay as they are"});
  EXPECT_EQ(notices("         9"), Lines{"its units are of code 9 (dataset 164): lengths stay as they are"});
}

TEST(unv_files, ids_of_ten_digits_touch) {
  const auto folder = test::output_folder();
  constexpr std::int64_t first = 1234567890;
  std::string text = unv_nodes(1, 1, first) + unv_hex(first);
  ASSERT_NE(text.find("12345678901234567891"), std::string::npos);
  // Elements and groups, too: four fields and eight of a line.
  text.replace(text.find(numbers({1, 115})), 10, numbers({2345678901}));
  text += "    -1\n  2467\n" + numbers({5, 0, 0, 0, 0, 0, 0, 3}) + "\nG\n" +
          numbers({7, first, 0, 0, 7, first + 7, 0, 0}) + "\n" + numbers({8, 2345678901, 0, 0}) + "\n    -1\n";
  const MeshFile read = read_mesh(test::write_text(folder / "a.unv", text));
  EXPECT_DOUBLE_EQ(volume(read.mesh), 1);
  EXPECT_EQ(read.mesh.node_ids.front(), first);
  EXPECT_EQ(read.mesh.node_ids.back(), first + 7);
  EXPECT_EQ(read.mesh.hex_ids, (std::vector<std::int64_t>{2345678901}));
  EXPECT_EQ(read.mesh.blocks, (std::vector<Block>{{5, "G", {0}}}));
  EXPECT_EQ(read.mesh.node_sets, (std::vector<NodeSet>{{5, "G", {0, 7}}}));
}

TEST(unv_files, sets_that_groups_name_are_told) {
  const MeshFile read =
      read_mesh(test::write_text(test::output_folder() / "a.unv",
                                 unv_nodes() + unv_hex() + "    -1\n  2467\n" + numbers({5, 0, 0, 3, 0, 0, 0, 1}) +
                                     "\nG\n" + numbers({7, 1, 0, 0}) + "\n" + numbers({6, 0, 0, 0, 0, 0, 0, 1}) +
                                     "\nH\n" + numbers({7, 2, 0, 0}) + "\n    -1\n"));
  EXPECT_EQ(test::names_and_members(read.mesh.node_sets), (std::set<std::string>{"G:0", "H:1"}));
  EXPECT_EQ(read.notices,
            (std::vector<std::string>{
                "numbers of constraint sets, load sets and the like of 1 group left out; the first is 5"}));
}

/// Names that are cut are so between letters, whatever a letter's length.
TEST(group_names, are_cut_between_letters) {
  const auto folder = test::output_folder();
  for (const std::string letter : {"\xE2\x82\xAC", "\xC3\xA9", "\xF0\x9F\x98\x80"})
    for (const std::string before : {"", "x", "xy", "xyz"})
      for (const std::string name : {"a.unv", "a.k", "a.med"}) {
        if (!test::has_format(std::filesystem::path(name).extension().string())) continue;
        SCOPED_TRACE(name + " " + before);
        Mesh mesh = test::grid(1, 1, 1);
        std::string text = before;
        for (int i = 0; i < 60; ++i) text += letter;
        mesh.node_sets = {{1, text, {0}}};
        mesh.blocks = {{2, text, {0}}};
        const auto notices = write_mesh(folder / name, mesh, nullptr);
        const Mesh read = read_mesh(folder / name).mesh;
        for (const std::string& found : {read.node_sets.at(0).name, read.blocks.at(0).name}) {
          EXPECT_TRUE(text.starts_with(found));
          EXPECT_EQ((found.size() - before.size()) % letter.size(), 0U) << found;
          EXPECT_GT(found.size(), 36U);
          EXPECT_TRUE(test::told(notices, "is called '" + found + "' in the file"));
        }
      }
}

}  // namespace
}  // namespace hextwist
