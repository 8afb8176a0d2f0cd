// What holds for every format: sets survive all of them, nothing is half-written, broken files are refused.
#include <sys/mount.h>

#include "io/io_support.h"

namespace hextwist {
namespace {

constexpr const char* written[] = {"a.msh", "a.e", "a.vtu", "a.inp", "a.mesh"};

/// All that every format keeps.
Mesh plain(Mesh mesh) {
  mesh.node_ids.clear();
  mesh.hex_ids.clear();
  mesh.fields.clear();
  mesh.others = nullptr;  // tests/io/others_test.cpp
  return mesh;
}

TEST(mesh_files, real_meshes_keep_their_sets_in_every_format) {
  const auto data = test::data_folder();
  if (data.empty()) GTEST_SKIP() << "no folder of real meshes";
  const auto folder = test::output_folder();
  for (const char* sub : {"cad", "mesh"})
    for (const auto& entry : std::filesystem::directory_iterator(data / sub)) {
      const auto extension = entry.path().extension();
      if (extension == ".brep" || extension == ".step") continue;
      SCOPED_TRACE(entry.path().filename());
      const auto file = read_mesh(entry.path());
      EXPECT_GT(file.mesh.n_hexes(), 0);
      for (const char* name : written) {
        SCOPED_TRACE(name);
        write_mesh(folder / name, file.mesh, &file.tags);
        const auto back = read_mesh(folder / name);
        const bool exact = std::string_view(name) != "a.inp";
        const Mesh kept = exact ? back.mesh : test::with_exact_points(back.mesh, file.mesh);
        EXPECT_TRUE(test::same_mesh(plain(file.mesh), plain(kept)));
        EXPECT_TRUE(back.notices.empty()) << back.notices[0];
      }
    }
}

TEST(mesh_files, gmsh_sees_the_entities_that_we_write) {
  if (std::system("/usr/bin/python3 -c 'import gmsh' > /dev/null 2>&1") != 0) GTEST_SKIP() << "no python3 with Gmsh";
  const auto folder = test::output_folder();
  Mesh mesh = test::grid(4, 3, 3);
  const auto tags = test::brick_association(mesh, Vec3(4, 3, 3));
  mesh.blocks = {{3, "left", {}}, {4, "all", {}}};
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    if (tags.hex_volume[h] == 1) mesh.blocks[0].hexes.push_back(h);
    mesh.blocks[1].hexes.push_back(h);
  }
  for (std::size_t i = 0; i < tags.surface_faces.size(); ++i)
    if (tags.face_surface[i] == tags.face_surface[0]) {
      if (mesh.side_sets.empty()) mesh.side_sets.push_back({9, "side", {}});
      mesh.side_sets[0].sides.push_back(tags.surface_faces[i]);
    }
  std::string expected = "nodes = {";
  for (std::size_t n = 0; n < tags.node_owner.size(); ++n)
    expected += std::to_string(n + 1) + ": (" + std::to_string(tags.node_owner[n].dim) + ", " +
                std::to_string(tags.node_owner[n].id) + "), ";
  expected += "}\nvolumes = {";
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    expected += std::to_string(h + 1) + ": " + std::to_string(tags.hex_volume[h]) + ", ";
  expected += "}\nside = " + std::to_string(tags.face_surface[0]) +
              "\nn_faces = " + std::to_string(tags.surface_faces.size()) +
              "\nn_edges = " + std::to_string(tags.curve_edges.size());
  for (const int version : {22, 41})
    for (const bool binary : {false, true}) {
      SCOPED_TRACE(testing::Message() << version << binary);
      WriteOptions options;
      options.gmsh_version = version;
      options.binary = binary;
      const auto file = folder / ("m" + std::to_string(version) + (binary ? "b" : "t") + ".msh");
      write_mesh(file, mesh, &tags, options);
      const auto script = test::write_text(folder / "script.py", expected + "\nfile = '" + file.string() + R"('
import gmsh
gmsh.initialize()
gmsh.option.setNumber('General.Terminal', 0)
gmsh.open(file)
seen = {}
for dim, tag in gmsh.model.getEntities():
    for node in gmsh.model.mesh.getNodes(dim, tag)[0]: seen[int(node)] = (dim, tag)
assert seen == nodes, 'nodes'
seen = {}
for dim, tag in gmsh.model.getEntities(3):
    types, tags, _ = gmsh.model.mesh.getElements(3, tag)
    assert list(types) == [5]
    for hex in tags[0]: seen[int(hex)] = tag
assert seen == volumes, 'volumes'
assert sum(len(gmsh.model.mesh.getElements(2, t)[1][0]) for d, t in gmsh.model.getEntities(2)) == n_faces
assert sum(len(gmsh.model.mesh.getElements(1, t)[1][0]) for d, t in gmsh.model.getEntities(1)) == n_edges
groups = {gmsh.model.getPhysicalName(d, t): (d, t, list(gmsh.model.getEntitiesForPhysicalGroup(d, t)))
          for d, t in gmsh.model.getPhysicalGroups()}
assert groups['side'] == (2, 9, [side]), groups
assert groups['left'] == (3, 3, [1]), groups
assert groups['all'][2] == ([1, 2] if ')" + std::to_string(version) + R"(' == '41' else [2]), groups
)");
      EXPECT_EQ(std::system(("/usr/bin/python3 " + script.string()).c_str()), 0);
      const auto log = folder / "check.txt";
      EXPECT_EQ(std::system(("gmsh -check " + file.string() + " > " + log.string() + " 2>&1").c_str()), 0);
      EXPECT_EQ(test::text_of(log).find("Error"), std::string::npos) << test::text_of(log);
      EXPECT_EQ(test::text_of(log).find("Warning"), std::string::npos) << test::text_of(log);
    }
}

struct Variant {
  const char* name;
  bool binary;
  int gmsh;
};
constexpr Variant variants[] = {{"t41.msh", false, 41}, {"b41.msh", true, 41}, {"t22.msh", false, 22},
                                {"b22.msh", true, 22},  {"a.e", true, 41},     {"t.vtu", false, 41},
                                {"b.vtu", true, 41},    {"a.inp", true, 41},   {"a.mesh", true, 41}};

std::vector<std::filesystem::path> all_variants(const std::filesystem::path& folder) {
  const Mesh mesh = test::rich_mesh(4, true);
  const auto tags = test::brick_association(mesh, Vec3(4, 3, 3));
  std::vector<std::filesystem::path> files;
  for (const auto& [name, binary, gmsh] : variants) {
    WriteOptions options;
    options.binary = binary;
    options.gmsh_version = gmsh;
    files.push_back(folder / name);
    write_mesh(files.back(), mesh, &tags, options);
  }
  if (const auto data = test::data_folder(); !data.empty())
    for (const char* name : {"mesh/hyper_ball_balanced_r1.vtk", "mesh/cad_component_hex.msh", "mesh/hole_3d_cubit.inp",
                             "mesh/pipe_junction_Y_r1.msh"})
      files.push_back(data / name);
  return files;
}

TEST(mesh_files, a_mesh_of_many_pieces_comes_back_from_every_format) {
  // More than what is converted, buffered or handed to a library at a time.
  const Mesh mesh = test::rich_mesh(5, true, {25, 24, 23});
  const auto tags = test::brick_association(mesh, Vec3(25, 24, 23));
  for (const auto& [name, binary, gmsh] : variants) {
    SCOPED_TRACE(name);
    WriteOptions options;
    options.binary = binary;
    options.gmsh_version = gmsh;
    const auto file = test::output_folder() / name;
    write_mesh(file, mesh, &tags, options);
    auto back = read_mesh(file);
    if (file.extension() == ".inp") back.mesh = test::with_exact_points(back.mesh, mesh);
    const bool all = file.extension() != ".inp" && file.extension() != ".mesh";
    EXPECT_TRUE(all ? test::same_mesh(mesh, back.mesh) : test::same_mesh(plain(mesh), plain(back.mesh)));
    if (gmsh == 41 && (file.extension() == ".msh" || file.extension() == ".vtu")) {
      EXPECT_EQ(back.tags.node_owner, tags.node_owner);
      EXPECT_EQ(back.tags.surface_faces, tags.surface_faces);
      EXPECT_EQ(back.tags.face_surface, tags.face_surface);
      EXPECT_EQ(back.tags.curve_edges, tags.curve_edges);
      EXPECT_EQ(back.tags.hex_volume, tags.hex_volume);
    }
  }
}

TEST(mesh_files, groups_of_id_0_come_back_from_every_format) {
  Mesh mesh = test::grid(2, 1, 1);
  mesh.blocks = {{0, "left half", {0}}, {7, "", {1}}};
  mesh.node_sets = {{0, "n", {0, 1}}};
  mesh.side_sets = {{0, "x", {{0, 4}, {1, 2}}}};
  for (const char* name : {"a.vtu", "a.e", "a.inp", "a.mesh", "a.msh"}) {
    SCOPED_TRACE(name);
    const auto file = test::output_folder() / name;
    const auto notices = write_mesh(file, mesh, nullptr);
    const Mesh back = read_mesh(file).mesh;
    ASSERT_EQ(back.blocks.size(), 2u);
    if (std::string(name) == "a.msh") {  // 0 means no group there
      EXPECT_EQ(notices, (std::vector<std::string>{"block 0 is physical group 8 in the file: 0 is no group there",
                                                   "side set 0 is physical group 1 in the file: 0 is no group there",
                                                   "node set 0 is physical group 1 in the file: 0 is no group there"}));
      EXPECT_EQ(back.blocks, (std::vector<Block>{{7, "", {1}}, {8, "left half", {0}}}));
      EXPECT_EQ(back.node_sets, (std::vector<NodeSet>{{1, "n", {0, 1}}}));
      EXPECT_EQ(back.side_sets, (std::vector<SideSet>{{1, "x", {{0, 4}, {1, 2}}}}));
      continue;
    }
    EXPECT_EQ(back.blocks, mesh.blocks);
    EXPECT_EQ(back.node_sets, mesh.node_sets);
    EXPECT_EQ(back.side_sets, mesh.side_sets);
  }
}

TEST(mesh_files, files_cut_anywhere_are_refused_or_read) {
  const auto folder = test::output_folder();
  std::mt19937 random(11);
  for (const auto& file : all_variants(folder)) {
    SCOPED_TRACE(file.filename());
    const std::string text = test::text_of(file);
    const auto cut = folder / ("cut" + file.extension().string());
    for (int i = 0; i < 60; ++i) test::read_or_refuse(test::write_text(cut, text.substr(0, random() % text.size())));
    // A whole section missing is always noticed: half a file cannot be read.
    if (file.extension() != ".inp") {
      test::write_text(cut, text.substr(0, text.size() / 2));
      EXPECT_NE(test::refusal(cut), "no error");
    }
  }
}

TEST(mesh_files, files_with_wrong_bytes_are_refused_or_read) {
  const auto folder = test::output_folder();
  std::mt19937 random(12);
  for (const auto& file : all_variants(folder)) {
    if (file.extension() == ".e") continue;  // libraries below ours read those
    SCOPED_TRACE(file.filename());
    const std::string text = test::text_of(file);
    const auto bad = folder / ("bad" + file.extension().string());
    for (int i = 0; i < 100; ++i) {
      std::string wrong = text;
      for (unsigned k = 0; k <= random() % 4; ++k) {
        const std::size_t at = i % 2 ? random() % text.size() : random() % std::min<std::size_t>(text.size(), 1500);
        wrong[at] = static_cast<char>(i % 3 ? "0123456789-. \nAe"[random() % 16] : static_cast<char>(random()));
      }
      test::read_or_refuse(test::write_text(bad, wrong));
    }
  }
}

TEST(mesh_files, missing_empty_and_unknown_files_are_refused) {
  const auto folder = test::output_folder();
  for (const char* name : {"x.msh", "x.e", "x.vtu", "x.vtk", "x.inp", "x.mesh"}) {
    const auto file = folder / name;
    EXPECT_EQ(test::refusal(file), file.string() + ": cannot be opened: No such file or directory");
    test::write_text(file, "");
    EXPECT_EQ(test::refusal(file), file.string() + ": is empty");
    std::filesystem::remove(file);
    std::filesystem::create_directory(file);
    EXPECT_EQ(test::refusal(file), file.string() + ": is a folder");
  }
  EXPECT_EQ(test::refusal("a.stl"), "a.stl: meshes of this kind cannot be read; known are " + readable_extensions());
  // Also those whose library a build may be without: they are refused when asked for.
  EXPECT_EQ(
      readable_extensions(),
      ".msh .e .exo .g .gen .inp .mesh .mfem .med .cgns .bdf .nas .unv .foam .k .key .cdb .re2 .specfem .vtk .vtu "
      ".vtkhdf .xdmf .xmf");
  EXPECT_EQ(
      writable_extensions(),
      ".msh .e .exo .g .gen .inp .mesh .mfem .med .cgns .bdf .nas .unv .foam .k .key .cdb .re2 .specfem .vtu .vtkhdf "
      ".xdmf .xmf");
}

std::string write_refusal(const std::filesystem::path& file, const Mesh& mesh, const WriteOptions& options = {}) {
  return test::error_of([&] { write_mesh(file, mesh, nullptr, options); });
}

std::size_t n_entries(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(mesh_files, a_file_that_cannot_be_written_leaves_the_old_one) {
  const auto folder = test::output_folder();
  const Mesh mesh = test::grid(3, 3, 3);
  for (const char* name : written) {
    SCOPED_TRACE(name);
    const auto file = folder / name;
    test::write_text(file, "old");
    WriteOptions options;
    options.overwrite = false;
    EXPECT_EQ(write_refusal(file, mesh, options), file.string() + ": exists already and may not be overwritten");
    EXPECT_EQ(test::text_of(file), "old");
    const auto lost = folder / "absent" / name;
    EXPECT_EQ(write_refusal(lost, mesh),
              lost.string() + ": cannot be written: there is no folder " + (folder / "absent").string());
    EXPECT_EQ(write_refusal(folder / "x.stl", mesh).find((folder / "x.stl").string() + ": meshes of this kind"), 0);
    std::filesystem::remove(file);
    std::filesystem::create_directory(file);
    EXPECT_EQ(write_refusal(file, mesh), file.string() + ": is a folder");
    std::filesystem::remove(file);
  }
  EXPECT_EQ(n_entries(folder), 0u);
}

TEST(mesh_files, a_full_disk_leaves_the_old_file) {
  const auto folder = test::output_folder();
  const Mesh mesh = test::grid(20, 20, 20);
  // A device that is always full stands for the disk.
  if (std::filesystem::exists("/dev/full"))
    for (const char* name : {"a.msh", "a.vtu", "a.inp", "a.mesh"}) {
      const auto link = folder / name;
      std::filesystem::create_symlink("/dev/full", link);
      EXPECT_EQ(write_refusal(link, mesh), link.string() + ": cannot be written: No space left on device");
      EXPECT_TRUE(std::filesystem::is_symlink(link));
      std::filesystem::remove(link);
    }
  const auto disk = folder / "disk";
  std::filesystem::create_directory(disk);
  if (::mount("none", disk.c_str(), "tmpfs", 0, "size=128k") != 0) GTEST_SKIP() << "a small disk cannot be mounted";
  struct Mounted {
    std::filesystem::path at;
    // Lazily: netCDF keeps a file open that it could not close.
    ~Mounted() { ::umount2(at.c_str(), MNT_DETACH); }
  } const mounted{disk};
  for (const char* name : written) {
    SCOPED_TRACE(name);
    test::write_text(disk / name, "old");
    const std::string what = write_refusal(disk / name, mesh);
    EXPECT_EQ(what.find((disk / name).string() + ": cannot be written"), 0u) << what;
    EXPECT_EQ(test::text_of(disk / name), "old");
    EXPECT_EQ(n_entries(disk), 1u);
    std::filesystem::remove(disk / name);
  }
}

TEST(mesh_files, a_folder_without_permission_is_refused) {
  // Nobody may make files there, not even root.
  if (!std::filesystem::exists("/proc/self")) GTEST_SKIP() << "no /proc";
  for (const char* name : written) {
    const auto file = std::filesystem::path("/proc") / name;
    EXPECT_EQ(write_refusal(file, test::grid(1, 1, 1)).find(file.string() + ": cannot be written"), 0u);
  }
}

TEST(mesh_files, links_are_followed_and_permissions_kept) {
  const auto folder = test::output_folder();
  const auto file = test::write_text(folder / "real.msh", "old");
  std::filesystem::permissions(file, std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  std::filesystem::create_symlink(file, folder / "link.msh");
  write_mesh(folder / "link.msh", test::grid(1, 1, 1), nullptr);
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.msh"));
  EXPECT_EQ(read_mesh(file).mesh.n_hexes(), 1);
  EXPECT_EQ(std::filesystem::status(file).permissions(),
            std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  EXPECT_EQ(n_entries(folder), 2u);
}

}  // namespace
}  // namespace hextwist
