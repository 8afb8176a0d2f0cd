// OpenFOAM's polyMesh, with checkMesh as the judge.
#include <Eigen/Geometry>

#include "hextwist/mesh/topology.h"
#include "io/io_support.h"
#include "support/meshed.h"

namespace hextwist {
namespace {

const std::string& openfoam() {
  static const std::string folder = "/usr/share/openfoam";  // as Debian has it
  return folder;
}
bool has_check_mesh() {
  return std::system("command -v checkMesh > /dev/null 2>&1") == 0 && std::filesystem::exists(openfoam());
}

/// What checkMesh says of a case.
std::string checked(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / "system");
  const std::string head = "FoamFile\n{\n version 2.0;\n format ascii;\n class dictionary;\n object ";
  test::write_text(folder / "system" / "controlDict",
                   head +
                       "controlDict;\n}\napplication none;\nstartFrom startTime;\nstartTime 0;\nstopAt endTime;\n"
                       "endTime 1;\ndeltaT 1;\nwriteControl timeStep;\nwriteInterval 1;\n");
  test::write_text(folder / "system" / "fvSchemes",
                   head +
                       "fvSchemes;\n}\nddtSchemes { default none; }\ngradSchemes { default none; }\ndivSchemes "
                       "{ default none; }\nlaplacianSchemes { default none; }\ninterpolationSchemes { default none; "
                       "}\nsnGradSchemes { default none; }\n");
  test::write_text(folder / "system" / "fvSolution", head + "fvSolution;\n}\n");
  const bool good = std::system(("WM_PROJECT_DIR=" + openfoam() + " checkMesh -allTopology -case '" + folder.string() +
                                 "' > '" + (folder / "log.txt").string() + "' 2>&1")
                                    .c_str()) == 0;
  EXPECT_TRUE(good);
  return test::text_of(folder / "log.txt");
}

TEST(openfoam, checks_ours) {
  if (!has_check_mesh()) GTEST_SKIP() << "no OpenFOAM";
  const auto folder = test::output_folder();
  const MeshedModel meshed = test::shipped("bracket");
  write_mesh(folder / "case.foam", meshed.mesh, &meshed.association);
  const std::string log = checked(folder);
  EXPECT_NE(log.find("Mesh OK."), std::string::npos) << log;
  EXPECT_NE(log.find("hexahedra:     488"), std::string::npos) << log;
}

/// What begins as a number does is no word there.
TEST(openfoam, names_that_look_like_numbers_become_words) {
  const auto folder = test::output_folder();
  Mesh mesh = test::grid(6, 1, 1);
  const std::vector<std::string> names = {"42", "-1", "1e5", ".5", "_42", "2nd wall"};
  for (int i = 0; i < 6; ++i) {
    const std::string& name = names[static_cast<std::size_t>(i)];
    mesh.blocks.push_back({i + 1, name, {i}});
    mesh.side_sets.push_back({i + 1, name, {{i, 2}}});
    mesh.side_sets.push_back({i + 11, name, {{i, i == 5 ? 0 : 1}}});  // inside: zones
    mesh.node_sets.push_back({i + 1, name, {i}});
  }
  const auto notices = write_mesh(folder / "case.foam", mesh, nullptr);
  const Mesh read = read_mesh(folder / "case.foam").mesh;
  const auto expect = [&](const char* kind, const auto& groups, const auto& found) {
    ASSERT_EQ(found.size(), groups.size()) << kind;
    std::set<std::string> written;
    for (const auto& group : found) {
      EXPECT_TRUE(std::isalpha(static_cast<unsigned char>(group.name[0])) || group.name[0] == '_') << group.name;
      EXPECT_TRUE(written.insert(group.name).second) << group.name << " twice";
    }
    for (const auto& group : groups)
      EXPECT_TRUE(test::told(notices, std::string(kind) + " " + std::to_string(group.id) + " '" + group.name +
                                          "' is called '_") ||
                  written.contains(group.name))
          << kind << " " << group.id;
  };
  expect("block", mesh.blocks, read.blocks);
  expect("sideset", mesh.side_sets, read.side_sets);
  expect("nodeset", mesh.node_sets, read.node_sets);
  if (!has_check_mesh()) GTEST_SKIP() << "no OpenFOAM";
  const std::string log = checked(folder);
  EXPECT_NE(log.find("Mesh OK."), std::string::npos) << log;
}

/// A brick with cyclic sides left and right, as entries of `left` and `right` say.
struct Cyclic {
  Mesh mesh;
  FileExtras extras;
};
Cyclic cyclic(Mesh mesh, const std::string& more_left = "", const std::string& more_right = "") {
  Cyclic result{std::move(mesh), {}};
  const Faces all = faces(result.mesh);
  std::array<double, 2> ends = {1e9, -1e9};
  for (const Vec3& p : result.mesh.points) ends = {std::min(ends[0], p.x()), std::max(ends[1], p.x())};
  SideSet left{3, "left", {}}, right{7, "2nd", {}};
  for (std::size_t f = 0; f < all.nodes.size(); ++f) {
    const auto at = [&](double x) {
      return std::ranges::all_of(all.nodes[f], [&](Index n) { return std::abs(result.mesh.points[n].x() - x) < 1e-3; });
    };
    if (at(ends[0])) left.sides.push_back(all.sides[f][0]);
    if (at(ends[1])) right.sides.push_back(all.sides[f][0]);
  }
  std::ranges::sort(left.sides), std::ranges::sort(right.sides);
  result.mesh.side_sets = {left, right};
  const std::string usual = "type cyclic;inGroups 1 ( cyclic );matchTolerance 0.0001;";
  result.extras.patches = {{3, usual + "neighbourPatch 2nd;" + more_left},
                           {7, usual + "neighbourPatch left;" + more_right}};
  return result;
}
std::vector<std::string> written(const Cyclic& of, const std::filesystem::path& file) {
  WriteOptions options;
  options.extras = &of.extras;
  return write_mesh(file, of.mesh, nullptr, options);
}

std::string boundary_of(const std::filesystem::path& file) {
  return test::text_of(file.parent_path() / "constant/polyMesh/boundary");
}

/// Sides that bend alike, and sectors; with hexes and nodes in any order.
TEST(openfoam, faces_of_cyclic_patches_are_in_paired_order) {
  const auto folder = test::output_folder();
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const bool turned = seed % 2 == 0;
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const std::string transform =
        turned ? "transform rotational;rotationAxis ( 0 0 1 );rotationCentre ( 0 0 0 );" : "transform translational;";
    Cyclic of =
        cyclic(test::shuffled(test::grid(3, 4, 3), random), transform + (turned ? "" : "separationVector ( 3 0 0 );"),
               transform + (turned ? "" : "separationVector ( -3 0 0 );"));
    for (Vec3& p : of.mesh.points)
      p = turned ? Vec3(Eigen::AngleAxisd(-0.25 * p.x(), Vec3::UnitZ()) * Vec3(0, 4 + p.y() + 0.1 * p.z(), p.z()))
                 : Vec3(p + Vec3(0.1 * std::sin(p.y() + p.z()), 0.07 * p.z(), 0.05 * p.y() * p.y()));
    const auto file = folder / std::to_string(seed) / "case.foam";
    std::filesystem::create_directories(file.parent_path());
    const auto notices = written(of, file);
    EXPECT_FALSE(test::told(notices, "ordinary") || test::told(notices, "separationVector"));
    const std::string boundary = boundary_of(file);
    EXPECT_NE(boundary.find("neighbourPatch _2nd;"), std::string::npos) << boundary;
    if (!has_check_mesh()) continue;
    const std::string log = checked(file.parent_path());
    EXPECT_NE(log.find("Mesh OK."), std::string::npos) << log;
  }
}

/// Also where the file says another vector, as after scaling.
TEST(openfoam, cyclic_patches_that_do_not_repeat_are_ordinary_and_told) {
  const auto folder = test::output_folder();
  const auto expect_ordinary = [&](const std::string& name, const Cyclic& of, const std::string& why) {
    SCOPED_TRACE(name);
    const auto file = folder / name / "case.foam";
    std::filesystem::create_directories(file.parent_path());
    EXPECT_TRUE(test::told(written(of, file),
                           "patches 'left' and '_2nd' are ordinary ones (type patch) in the file, not "
                           "cyclic: " +
                               why));
    EXPECT_EQ(boundary_of(file).find("cyclic"), std::string::npos) << boundary_of(file);
    if (!has_check_mesh()) return;
    const std::string log = checked(file.parent_path());
    EXPECT_NE(log.find("Mesh OK."), std::string::npos) << log;
  };
  Cyclic moved = cyclic(test::grid(3, 2, 2));
  for (Vec3& p : moved.mesh.points)
    if (p == Vec3(3, 1, 1)) p.y() += 0.05;
  expect_ordinary("moved", moved, "node ");
  Cyclic fewer = cyclic(test::grid(3, 2, 2));
  fewer.mesh.side_sets[0].sides.pop_back();
  expect_ordinary("fewer", fewer, "there are 3 faces on one and 4 on the other");
  expect_ordinary("rotational", cyclic(test::grid(3, 2, 2), "transform rotational;rotationAxis ( 0 0 1 );"),
                  "one is the other moved, and their transform is rotational");
  for (const auto& [more, why] : std::map<std::string, std::string>{
           {"transform translational;", "one is the other turned, and their transform is not rotational"},
           {"transform rotational;rotationAxis ( 0 1 0 );",
            "one is the other turned about another axis than their rotationAxis"},
           {"transform rotational;rotationAxis ( 0 0 2 );rotationCentre ( 1 0 0 );",
            "one is the other turned about another place than their rotationCentre"}}) {
    Cyclic turned = cyclic(test::grid(3, 2, 2), more, more);
    for (Vec3& p : turned.mesh.points) p = Eigen::AngleAxisd(-0.25 * p.x(), Vec3::UnitZ()) * Vec3(0, 4 + p.y(), p.z());
    expect_ordinary("turned", turned, why);
  }
  Cyclic alone = cyclic(test::grid(3, 2, 2));
  alone.mesh.side_sets[1].name = "new";
  EXPECT_TRUE(
      test::told(written(alone, folder / "case.foam"), "patch 'left' is an ordinary one (type patch) in the file"));
  EXPECT_EQ(boundary_of(folder / "case.foam").find("cyclic"), std::string::npos);
  const Cyclic other = cyclic(test::grid(3, 2, 2), "separationVector ( 1 0 0 );", "separationVector ( 3 0 0 );");
  EXPECT_TRUE(test::told(written(other, folder / "case.foam"),
                         "separationVector of patch 'left' is ( 3 0 0 ) in the file, as it lies to its neighbour"));
  for (const char* vector : {"separationVector ( 3 0 0 );", "separationVector ( -3 0 0 );"})
    EXPECT_NE(boundary_of(folder / "case.foam").find(vector), std::string::npos) << vector;
}

}  // namespace
}  // namespace hextwist
