// CGNS as others write it, through the library itself; and what its own checker says of ours.
#include <cgnslib.h>

#include "io/hdf_support.h"
#include "support/meshed.h"

namespace hextwist {
namespace {

/// A file that is being written.
class Cgns {
 public:
  explicit Cgns(const std::filesystem::path& path) {
    cg_set_file_type(CG_FILE_HDF5);
    good(cg_open(path.c_str(), CG_MODE_WRITE, &file));
    int base = 0;
    good(cg_base_write(file, "Base", 3, 3, &base));
  }
  ~Cgns() { cg_close(file); }
  Cgns(const Cgns&) = delete;
  static void good(int status) { ASSERT_EQ(status, CG_OK) << cg_get_error(); }

  /// Points of a grid of nodes, moved along x.
  int structured(const char* name, std::array<cgsize_t, 3> nodes, double x0, bool turned = false) {
    const std::array<cgsize_t, 9> size = {nodes[0], nodes[1], nodes[2], nodes[0] - 1, nodes[1] - 1, nodes[2] - 1};
    int zone = 0;
    good(cg_zone_write(file, 1, name, size.data(), CGNS_ENUMV(Structured), &zone));
    std::array<std::vector<double>, 3> x;
    for (int k = 0; k < nodes[2]; ++k)
      for (int j = 0; j < nodes[1]; ++j)
        for (int i = 0; i < nodes[0]; ++i) {
          // turned: its j runs along x, its i against y.
          x[0].push_back(x0 + (turned ? j : i));
          x[1].push_back(turned ? nodes[0] - 1 - i : j);
          x[2].push_back(k);
        }
    coordinates(zone, x);
    return zone;
  }
  int unstructured(const char* name, const std::vector<Vec3>& points, cgsize_t n_cells) {
    const std::array<cgsize_t, 3> size = {static_cast<cgsize_t>(points.size()), n_cells, 0};
    int zone = 0;
    good(cg_zone_write(file, 1, name, size.data(), CGNS_ENUMV(Unstructured), &zone));
    std::array<std::vector<double>, 3> x;
    for (const Vec3& p : points)
      for (std::size_t axis = 0; axis < 3; ++axis) x[axis].push_back(p[static_cast<int>(axis)]);
    coordinates(zone, x);
    return zone;
  }
  void coordinates(int zone, const std::array<std::vector<double>, 3>& x) {
    int number = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      good(cg_coord_write(file, 1, zone, CGNS_ENUMV(RealDouble), (std::string("Coordinate") + "XYZ"[axis]).c_str(),
                          x[axis].data(), &number));
  }
  void section(int zone, const char* name, CGNS_ENUMT(ElementType_t) type, cgsize_t first, cgsize_t last,
               const std::vector<cgsize_t>& nodes) {
    int number = 0;
    good(cg_section_write(file, 1, zone, name, type, first, last, 0, nodes.data(), &number));
  }
  int condition(int zone, const char* name, CGNS_ENUMT(BCType_t) type, CGNS_ENUMT(PointSetType_t) points, int n,
                const std::vector<cgsize_t>& members, CGNS_ENUMT(GridLocation_t) location) {
    int number = 0;
    good(cg_boco_write(file, 1, zone, name, type, points, n, members.data(), &number));
    if (location != CGNS_ENUMV(Vertex)) good(cg_boco_gridlocation_write(file, 1, zone, number, location));
    return number;
  }

  int file = -1;
};

const std::vector<Vec3> two_cubes = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0},
                                     {0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {0, 1, 1}, {1, 1, 1}, {2, 1, 1}};
const std::vector<cgsize_t> left = {1, 2, 5, 4, 7, 8, 11, 10}, right = {2, 3, 6, 5, 8, 9, 12, 11};

std::vector<cgsize_t> operator+(std::vector<cgsize_t> a, const std::vector<cgsize_t>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST(cgns_files, structured_zones_are_joined_by_their_connectivity) {
  const auto path = test::output_folder() / "a.cgns";
  {
    Cgns out(path);
    // 3 x 3 x 2 nodes each; the second stands beside the first with i and j turned.
    const int a = out.structured("a", {3, 3, 2}, 0), b = out.structured("b", {3, 3, 2}, 2, true);
    int number = 0;
    const std::array<cgsize_t, 6> here = {3, 1, 1, 3, 3, 2}, there = {3, 1, 1, 1, 1, 2};
    const std::array<int, 3> transform = {2, -1, 3};
    Cgns::good(cg_1to1_write(out.file, 1, a, "ab", "b", here.data(), there.data(), transform.data(), &number));
    const int inlet = out.condition(a, "in", CGNS_ENUMV(FamilySpecified), CGNS_ENUMV(PointRange), 2, {1, 1, 1, 1, 3, 2},
                                    CGNS_ENUMV(Vertex));
    int family = 0;
    Cgns::good(cg_family_write(out.file, 1, "inlet", &family));
    Cgns::good(cg_fambc_write(out.file, 1, family, "FamBC", CGNS_ENUMV(BCInflow), &number));
    Cgns::good(cg_goto(out.file, 1, "Zone_t", a, "ZoneBC_t", 1, "BC_t", inlet, "end"));
    Cgns::good(cg_famname_write("inlet"));
    out.condition(b, "out", CGNS_ENUMV(BCOutflow), CGNS_ENUMV(PointRange), 2, {1, 3, 1, 2, 3, 1},
                  CGNS_ENUMV(JFaceCenter));
    for (const int zone : {a, b})
      out.condition(zone, "bottom", CGNS_ENUMV(BCWall), CGNS_ENUMV(PointRange), 2, {1, 1, 1, 3, 3, 1},
                    CGNS_ENUMV(Vertex));
    out.condition(b, "edge", CGNS_ENUMV(BCTypeUserDefined), CGNS_ENUMV(PointRange), 2, {1, 3, 1, 1, 3, 2},
                  CGNS_ENUMV(Vertex));
    for (const int zone : {a, b}) {
      int solution = 0;
      Cgns::good(cg_sol_write(out.file, 1, zone, "FlowSolution", CGNS_ENUMV(CellCenter), &solution));
      const std::array<double, 4> values = {zone + 0.1, zone + 0.2, zone + 0.3, zone + 0.4};
      for (const char* name : {"VelocityX", "VelocityY", "VelocityZ", "Pressure"})
        Cgns::good(cg_field_write(out.file, 1, zone, solution, CGNS_ENUMV(RealDouble), name, values.data(), &number));
    }
  }
  const MeshFile read = read_mesh(path);
  EXPECT_EQ(read.mesh.n_hexes(), 8);
  EXPECT_EQ(read.mesh.n_nodes(), 30);  // 36, of which 6 are the same
  EXPECT_TRUE(test::conformal(read.mesh));
  EXPECT_NEAR(volume(read.mesh), 8, 1e-12);
  EXPECT_EQ(read.mesh.blocks, (std::vector<Block>{{1, "a", {0, 1, 2, 3}}, {2, "b", {4, 5, 6, 7}}}));
  EXPECT_EQ(read.mesh.side_sets,
            (std::vector<SideSet>{{1, "inlet", {{0, 0}, {2, 0}}},
                                  {2, "bottom", {{0, 4}, {1, 4}, {2, 4}, {3, 4}, {4, 4}, {5, 4}, {6, 4}, {7, 4}}},
                                  {3, "out", {{6, 3}, {7, 3}}}}));
  ASSERT_EQ(read.mesh.node_sets.size(), 1U);
  EXPECT_EQ(read.mesh.node_sets[0].nodes.size(), 2U);
  EXPECT_EQ(read.extras.boundary_types, (std::map<int, std::string>{{1, "BCInflow"}, {2, "BCWall"}, {3, "BCOutflow"}}));
  ASSERT_EQ(read.mesh.fields.size(), 2U);
  EXPECT_EQ(read.mesh.fields[0].name, "Velocity");
  EXPECT_EQ(read.mesh.fields[0].components, 3);
  EXPECT_EQ(read.mesh.fields[1], (Field{"Pressure", Field::On::hex, 1, {1.1, 1.2, 1.3, 1.4, 2.1, 2.2, 2.3, 2.4}}));
  EXPECT_TRUE(read.notices.empty()) << read.notices[0];
  // Kinds of conditions are written again.
  WriteOptions options;
  options.extras = &read.extras;
  write_mesh(path, read.mesh, nullptr, options);
  EXPECT_EQ(read_mesh(path).extras.boundary_types, read.extras.boundary_types);
}

TEST(cgns_files, unstructured_zones_are_joined_where_the_file_says_so) {
  const auto path = test::output_folder() / "a.cgns";
  const std::vector<cgsize_t> cube = {1, 2, 4, 3, 5, 6, 8, 7}, near = {2, 4, 6, 8}, far = {1, 3, 5, 7};
  std::vector<Vec3> points;
  for (int n = 0; n < 8; ++n) points.emplace_back(n & 1, n >> 1 & 1, n >> 2);
  std::vector<Vec3> beside = points;
  for (Vec3& p : beside) p.x() += 1;
  const auto write = [&](bool joined, bool periodic, double gap) {
    Cgns out(path);
    const int a = out.unstructured("a", points, 1);
    std::vector<Vec3> moved = beside;
    for (Vec3& p : moved) p.x() += gap;
    const int b = out.unstructured("b", moved, 1);
    for (const int zone : {a, b}) out.section(zone, "Hexes", CGNS_ENUMV(HEXA_8), 1, 1, cube);
    out.section(a, "wall", CGNS_ENUMV(QUAD_4), 2, 2, {1, 5, 7, 3});
    int number = 0;
    if (joined)
      Cgns::good(cg_conn_write(out.file, 1, a, "ab", CGNS_ENUMV(Vertex), CGNS_ENUMV(Abutting1to1),
                               CGNS_ENUMV(PointList), 4, near.data(), "b", CGNS_ENUMV(Unstructured),
                               CGNS_ENUMV(PointListDonor), CGNS_ENUMV(Integer), 4, far.data(), &number));
    const std::array<float, 3> zero{}, along = {2, 0, 0};
    if (periodic) Cgns::good(cg_conn_periodic_write(out.file, 1, a, 1, zero.data(), zero.data(), along.data()));
  };
  write(true, false, 0);
  MeshFile read = read_mesh(path);
  EXPECT_EQ(read.mesh.n_nodes(), 12);
  EXPECT_TRUE(test::conformal(read.mesh));
  EXPECT_EQ(read.mesh.blocks, (std::vector<Block>{{1, "a", {0}}, {2, "b", {1}}}));
  EXPECT_EQ(read.mesh.side_sets, (std::vector<SideSet>{{1, "wall", {{0, 0}}}}));
  EXPECT_TRUE(read.notices.empty()) << read.notices[0];
  write(false, false, 0);
  read = read_mesh(path);
  EXPECT_EQ(read.mesh.n_nodes(), 16);
  EXPECT_EQ(read.notices,
            (std::vector<std::string>{"the 2 zones are not joined in the file: nodes at the same place stay apart"}));
  write(true, true, 0);
  EXPECT_EQ(read_mesh(path).mesh.n_nodes(), 16);
  EXPECT_EQ(read_mesh(path).notices.at(0), "zone 'a': connectivity 'ab' is periodic: nodes stay apart there");
  write(true, false, 0.25);
  EXPECT_EQ(test::refusal(path), path.string() + ": zone 'a' is joined to another by nodes that are 0.25 apart");
}

TEST(cgns_files, sections_of_all_kinds_are_understood) {
  const auto path = test::output_folder() / "a.cgns";
  {
    Cgns out(path);
    const int zone = out.unstructured("Zone", two_cubes, 2);
    // Quads first, so that hexes have other numbers; then all that a mixed section may have.
    out.section(zone, "ends", CGNS_ENUMV(QUAD_4), 1, 2, {1, 7, 10, 4, 3, 6, 12, 9});
    const std::vector<cgsize_t> mixed =
        std::vector<cgsize_t>{CGNS_ENUMV(HEXA_8)} + left + std::vector<cgsize_t>{CGNS_ENUMV(BAR_2), 1, 2} +
        std::vector<cgsize_t>{CGNS_ENUMV(HEXA_8)} + right + std::vector<cgsize_t>{CGNS_ENUMV(QUAD_4), 1, 4, 5, 2};
    const std::vector<cgsize_t> begins = {0, 9, 12, 21, 26};
    int mixed_section = 0;
    Cgns::good(cg_poly_section_write(out.file, 1, zone, "mixed", CGNS_ENUMV(MIXED), 3, 6, 0, mixed.data(),
                                     begins.data(), &mixed_section));
    out.condition(zone, "first end", CGNS_ENUMV(BCInflow), CGNS_ENUMV(PointList), 1, {1}, CGNS_ENUMV(FaceCenter));
    out.condition(zone, "corner", CGNS_ENUMV(BCWall), CGNS_ENUMV(PointList), 2, {12, 3}, CGNS_ENUMV(Vertex));
    int solution = 0, number = 0;
    Cgns::good(cg_sol_write(out.file, 1, zone, "one", CGNS_ENUMV(Vertex), &solution));
    std::vector<double> x(12, 1);
    Cgns::good(cg_field_write(out.file, 1, zone, solution, CGNS_ENUMV(RealDouble), "T", x.data(), &number));
    Cgns::good(cg_sol_write(out.file, 1, zone, "two", CGNS_ENUMV(Vertex), &solution));
    const std::vector<float> later(12, 2.5F);
    Cgns::good(cg_field_write(out.file, 1, zone, solution, CGNS_ENUMV(RealSingle), "T", later.data(), &number));
    Cgns::good(cg_sol_write(out.file, 1, zone, "cells", CGNS_ENUMV(CellCenter), &solution));
    const std::vector<int> parts = {7, 9};
    Cgns::good(cg_field_write(out.file, 1, zone, solution, CGNS_ENUMV(Integer), "part", parts.data(), &number));
  }
  const MeshFile read = read_mesh(path);
  EXPECT_EQ(read.mesh.hexes, test::grid(2, 1, 1).hexes);
  EXPECT_EQ(read.mesh.hex_ids, (std::vector<std::int64_t>{3, 5}));
  EXPECT_EQ(read.mesh.blocks, (std::vector<Block>{{1, "mixed", {0, 1}}}));
  EXPECT_EQ(read.mesh.side_sets,
            (std::vector<SideSet>{{1, "first end", {{0, 0}}}, {2, "ends", {{1, 1}}}, {3, "mixed", {{0, 4}}}}));
  EXPECT_EQ(read.mesh.node_sets, (std::vector<NodeSet>{{1, "corner", {2, 11}}}));
  EXPECT_EQ(read.mesh.fields, (std::vector<Field>{{"T", Field::On::node, 1, std::vector<double>(12, 2.5)},
                                                  {"part", Field::On::hex, 1, {7, 9}, true}}));
  EXPECT_EQ(read.notices, (std::vector<std::string>{
                              "dropped 1 element of type BAR_2",
                              "boundary condition 'corner' of nodes is a node set: its type BCWall is left out",
                              "zone 'Zone' has several solutions of nodes: of fields of one name the last is read"}));
}

TEST(cgns_files, what_is_wrong_is_said) {
  const auto path = test::output_folder() / "a.cgns";
  const auto says = [&](auto&& write, const std::string& expected) {
    {
      Cgns out(path);
      write(out);
    }
    EXPECT_EQ(test::refusal(path), path.string() + ": " + expected);
  };
  says([](Cgns&) {}, "there is no zone in the file");
  says([](Cgns& out) { out.unstructured("z", two_cubes, 2); }, "there is no hex in the file");
  says(
      [](Cgns& out) {
        out.section(out.unstructured("z", two_cubes, 1), "s", CGNS_ENUMV(TETRA_4), 5, 5, {1, 2, 4, 7});
      },
      "element 5 of section 's' is a tetrahedron; only hexes of 8, 20 or 27 nodes are accepted");
  says(
      [](Cgns& out) {
        out.section(out.unstructured("z", two_cubes, 1), "s", CGNS_ENUMV(HEXA_8), 1, 1, {1, 2, 5, 4, 7, 8, 11, 13});
      },
      "element 1 of section 's' names node 13 of 12");
  says(
      [](Cgns& out) {
        const int zone = out.unstructured("z", two_cubes, 2);
        out.section(zone, "s", CGNS_ENUMV(HEXA_8), 1, 2, left + right);
        out.condition(zone, "c", CGNS_ENUMV(BCWall), CGNS_ENUMV(PointList), 1, {3}, CGNS_ENUMV(FaceCenter));
      },
      "boundary condition 'c' names element 3 of 2");
  says(
      [](Cgns& out) {
        const int zone = out.unstructured("z", two_cubes, 2);
        out.section(zone, "s", CGNS_ENUMV(HEXA_8), 1, 2, left + right);
        int number = 0;
        const cgsize_t one = 1;
        Cgns::good(cg_conn_write(out.file, 1, zone, "j", CGNS_ENUMV(Vertex), CGNS_ENUMV(Abutting1to1),
                                 CGNS_ENUMV(PointList), 1, &one, "y", CGNS_ENUMV(Unstructured),
                                 CGNS_ENUMV(PointListDonor), CGNS_ENUMV(Integer), 1, &one, &number));
      },
      "connectivity cannot be read: cg_conn_info:donor zone y does not exist");
}

TEST(cgns_files, its_own_checker_has_no_complaint_about_ours) {
  if (std::system("command -v cgnscheck > /dev/null 2>&1") != 0) GTEST_SKIP() << "no cgnscheck (cgns-convert)";
  const auto folder = test::output_folder();
  MeshedModel meshed = test::shipped("bracket");
  meshed.mesh.node_sets.push_back({77, "tips", {0, 5, 9}});
  meshed.mesh.fields = {{"v", Field::On::node, 3, std::vector<double>(3 * meshed.mesh.points.size(), 1)},
                        {"s", Field::On::hex, 1, std::vector<double>(meshed.mesh.hexes.size(), 1)}};
  for (const int n : {8, 20, 27}) {
    WriteOptions options;
    options.order = n == 8 ? 1 : 2, options.nodes_per_hex = n == 8 ? 0 : n, options.model = meshed.model.get();
    write_mesh(folder / "a.cgns", meshed.mesh, &meshed.association, options);
    const auto log = folder / "log.txt";
    ASSERT_EQ(
        std::system(("cgnscheck -v '" + (folder / "a.cgns").string() + "' > '" + log.string() + "' 2>&1").c_str()), 0)
        << test::text_of(log);
    const std::string said = test::text_of(log);
    EXPECT_EQ(said.find("ERROR"), std::string::npos) << said;
    for (const SideSet& set : meshed.mesh.side_sets) EXPECT_NE(said.find(set.name), std::string::npos) << set.name;
    EXPECT_NE(said.find("tips"), std::string::npos);
  }
}

/// Damaged files: a message of one line, or a mesh whose parts fit together. Without a fence only the file's own data
/// are changed: the library's structures are for the tests of the fence.
TEST(cgns_files, with_changed_numbers_are_refused_or_sound) {
  const auto path = test::output_folder() / "a.cgns";
  std::mt19937 random(11);
  for (int trial = 0; trial < 60; ++trial) {
    SCOPED_TRACE(trial);
    {
      Cgns out(path);
      const int zone = out.unstructured("z", two_cubes, 2);
      std::vector<cgsize_t> nodes = left + right;
      for (int k = 0; k < 2; ++k) nodes[random() % nodes.size()] = static_cast<cgsize_t>(random() % 16) - 1;
      out.section(zone, "s", CGNS_ENUMV(HEXA_8), 1, 2, nodes);
      out.section(zone, "q", CGNS_ENUMV(QUAD_4), 3, 3, {1, 7, static_cast<cgsize_t>(random() % 14), 4});
      out.condition(zone, "c", CGNS_ENUMV(BCWall), CGNS_ENUMV(PointRange), 2,
                    {static_cast<cgsize_t>(random() % 4), static_cast<cgsize_t>(random() % 5)}, CGNS_ENUMV(FaceCenter));
    }
    try {
      EXPECT_TRUE(test::sets_valid(read_mesh(path).mesh));
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace hextwist
