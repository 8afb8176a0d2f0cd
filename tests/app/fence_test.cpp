// Files of others are read in processes of their own: the same comes back, and whatever happens there is one line.
#include "hextwist/base/fence.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <random>

#include "hextwist/base/interrupt.h"
#include "hextwist/base/memory.h"
#include "hextwist/geom/occ/model.h"
#include "hextwist/io/io.h"
#include "hextwist/mesh/mesh.h"
#include "support/checkers.h"
#include "support/grids.h"

namespace hextwist {
namespace {

const std::filesystem::path readers = std::filesystem::path(HEXTWIST_PROGRAM).parent_path();
const std::filesystem::path models = std::filesystem::path(HEXTWIST_SOURCE_DIR) / "models";

std::string content(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// What reading says behind the file's name.
std::string refused(const std::filesystem::path& file, const Fence& fence) {
  try {
    if (file.extension() == ".brep" || file.extension() == ".step")
      read_cad(file, {.fence = fence});
    else
      read_mesh(file, {}, fence);
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.substr(0, file.string().size()), file.string());
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    return text.substr(file.string().size());
  }
  return "read";
}

/// A copy of a file in which the first `from` is `to`.
std::filesystem::path changed(const std::filesystem::path& of, const std::string& from, const std::string& to) {
  std::string text = content(of);
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  const auto file = test::output_folder() / of.filename();
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

/// A folder with a program in place of the reader of CAD.
Fence with_reader(const std::string& script) {
  const auto folder = test::output_folder() / "readers";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "hextwist_read_cad") << "#!/bin/sh\n" << script << "\n";
  std::filesystem::permissions(folder / "hextwist_read_cad", std::filesystem::perms::owner_all);
  return {folder};
}

TEST(fence, what_is_read_there_is_what_is_read_here_bit_by_bit) {
  int n = 0;
  for (const auto& entry : std::filesystem::directory_iterator(models)) {
    if (entry.path().extension() != ".brep" && entry.path().extension() != ".step") continue;
    SCOPED_TRACE(entry.path());
    ++n;
    const CadImport here = read_cad(entry.path()), there = read_cad(entry.path(), {.fence = {readers}});
    EXPECT_EQ(here.notices, there.notices);
    const Model &a = *here.model, &b = *there.model;
    for (int dim = 0; dim <= 3; ++dim) {
      ASSERT_EQ(a.count(dim), b.count(dim));
      for (int id = 1; id <= a.count(dim); ++id) {
        const Owner owner{dim, id};
        EXPECT_EQ(a.name(owner), b.name(owner));
        EXPECT_EQ(a.type(owner), b.type(owner));
        EXPECT_EQ(a.measure(owner), b.measure(owner));
        EXPECT_EQ(a.tolerance(owner), b.tolerance(owner));
        EXPECT_EQ(a.box(owner).min, b.box(owner).min);
        EXPECT_EQ(a.box(owner).max, b.box(owner).max);
        for (int other = 0; other <= 3; ++other) EXPECT_EQ(a.adjacent(owner, other), b.adjacent(owner, other));
        if (dim == 3) continue;
        const Vec3 near = a.box(owner).max + Vec3(0.1, 0.2, 0.3);
        EXPECT_EQ(a.project(owner, near).point, b.project(owner, near).point) << dim << ' ' << id;
      }
    }
  }
  EXPECT_GE(n, 30);
}

TEST(fence, glued_solids_come_back_glued) {
  const auto file = std::filesystem::path(HEXTWIST_SOURCE_DIR) / "models" / "inclusion.step";
  const CadImport apart = read_cad(file, {.fence = {readers}});
  const CadImport glued = read_cad(file, {.glue = true, .fence = {readers}});
  EXPECT_LT(glued.model->count(2), apart.model->count(2));
  EXPECT_EQ(glued.notices, read_cad(file, {.glue = true}).notices);
}

TEST(fence, a_step_file_that_crashes_opencascade_is_refused) {
  if (is_sanitized) GTEST_SKIP() << "sanitizers end a program that crashes in their own way";
  const auto file = changed(models / "cylinder.step", "= LINE(", "= LIN(");
  const std::string said = refused(file, {readers});
  EXPECT_TRUE(said == ": reading it crashed (segmentation fault): the file is damaged" ||
              said.starts_with(": the STEP file is damaged"))
      << said;
}

TEST(fence, a_letter_in_a_brep_file_is_refused_wherever_it_is_read) {
  // The last column of the first transformation or the first curve: OpenCASCADE reads on for ever.
  const auto file = changed(models / "bracket.brep", "\nCurves ", "\nCurves Q");
  EXPECT_EQ(refused(file, {}), ": the BREP file is damaged: a number or a word is missing or wrong");
  EXPECT_EQ(refused(file, {readers}), refused(file, {}));
}

TEST(fence, sizes_that_are_not_finite_are_refused) {
  std::string text = content(models / "cylinder.brep");
  const auto file = test::output_folder() / "tolerance.brep";
  const std::size_t vertex = text.find("\nVe\n");
  ASSERT_NE(vertex, std::string::npos);
  text.replace(vertex + 4, text.find('\n', vertex + 4) - vertex - 4, "inf");
  std::ofstream(file) << text;
  for (const Fence& fence : {Fence{}, Fence{readers}}) EXPECT_NE(refused(file, fence), "read");
}

TEST(fence, its_ends_are_told_apart) {
  const auto file = models / "bracket.brep";
  EXPECT_EQ(refused(file, with_reader("kill -SEGV $$")),
            ": reading it crashed (segmentation fault): the file is damaged");
  EXPECT_EQ(refused(file, with_reader("kill -ABRT $$")), ": reading it crashed (aborted): the file is damaged");
  EXPECT_EQ(refused(file, with_reader("kill -XCPU $$")),
            ": reading it takes more than 21 s of CPU time: the file is damaged, or 'set reading time' allows more");
  EXPECT_EQ(refused(file, with_reader("kill -KILL $$")), ": reading it was ended from outside (no memory left?)");
  Fence small = with_reader("exit 2");
  small.megabytes = 100;
  EXPECT_EQ(refused(file, small),
            ": reading it takes more than 100 MB of memory: the file is damaged, or 'set reading memory' allows more");
  EXPECT_EQ(refused(file, with_reader("printf %s \"$2: a reason\" > /proc/self/fd/3; exit 1")), ": a reason");
  EXPECT_EQ(refused(file, with_reader("exit 1")), ": cannot be read");
  EXPECT_NE(refused(file, with_reader("exit 3")).find("is of another version"), std::string::npos);
  EXPECT_NE(refused(file, {.required = true}).find("are not installed"), std::string::npos);
  EXPECT_NE(refused(file, with_reader("exit 9")).find("ended with status 9"), std::string::npos);
  EXPECT_NE(refused(file, with_reader("exit 0")).find("has left too little"), std::string::npos);
  EXPECT_NE(refused(file, {test::output_folder() / "nowhere"}).find("cannot be started"), std::string::npos);
}

TEST(fence, memory_has_a_limit) {
  if (is_sanitized) GTEST_SKIP() << "sanitizers need more than any limit";
  const std::string said = refused(models / "bracket.step", {.readers = readers, .megabytes = 1});
  EXPECT_EQ(said,
            ": reading it takes more than 1 MB of memory: the file is damaged, or 'set reading memory' allows more");
}

TEST(fence, who_waits_can_be_interrupted_and_leaves_nobody_behind) {
  struct Stop {};
  const auto mark = test::output_folder() / "pid";
  const Fence fence = with_reader("echo $$ > '" + mark.string() + "'; exec sleep 1000");
  const Interruptible interruptible([&] {
    if (!content(mark).empty()) throw Stop();
  });
  EXPECT_THROW(read_cad(models / "bracket.brep", {.fence = fence}), Stop);
  const std::string pid = content(mark);
  EXPECT_FALSE(std::filesystem::exists("/proc/" + pid.substr(0, pid.find('\n')))) << pid;
}

TEST(fence, hdf5_is_read_as_classic_files_are) {
  const auto folder = test::output_folder();
  Mesh mesh = test::grid(3, 4, 5);
  mesh.blocks.push_back({7, "steel", {0, 1, 2}});
  mesh.fields.push_back({"u", Field::On::node, 1, std::vector<double>(mesh.points.size(), 0.1)});
  write_mesh(folder / "a.e", mesh, nullptr);
  const std::string command =
      "nccopy -k nc4 -d 3 '" + (folder / "a.e").string() + "' '" + (folder / "b.e").string() + "' 2> /dev/null";
  if (std::system(command.c_str()) != 0) GTEST_SKIP() << "no nccopy";
  const MeshFile a = read_mesh(folder / "a.e"), b = read_mesh(folder / "b.e", {}, {readers});
  EXPECT_EQ(a.notices, b.notices);
  EXPECT_EQ(a.mesh.points, b.mesh.points);
  EXPECT_EQ(a.mesh.hexes, b.mesh.hexes);
  EXPECT_EQ(a.mesh.blocks.at(0).hexes, b.mesh.blocks.at(0).hexes);
  EXPECT_EQ(a.mesh.fields.at(0).values, b.mesh.fields.at(0).values);
  std::string bytes = content(folder / "b.e");
  for (std::size_t cut = 0; cut < bytes.size(); cut += bytes.size() / 9 + 1) {
    std::ofstream(folder / "c.e", std::ios::binary) << "\x89HDF" << bytes.substr(4, cut);
    EXPECT_NE(refused(folder / "c.e", {readers}), "read");
  }
}

/// Formats that hextwist_read_mesh reads; those that this build is without say so.
std::vector<std::string> mesh_formats() {
  std::vector<std::string> result;
  for (const char* extension : {".cgns", ".xdmf", ".vtkhdf", ".med"}) {
    const auto file = test::output_folder() / (std::string("none") + extension);
    if (refused(file, {}).find("built without") == std::string::npos) result.emplace_back(extension);
  }
  return result;
}

Mesh with_all() {
  Mesh mesh = test::grid(3, 4, 5);
  mesh.blocks = {{7, "steel", {0, 1, 2}}, {9, "", {2, 3}}};
  mesh.node_sets = {{3, "some", {1, 5}}};
  mesh.side_sets = {{4, "left", {{0, 0}, {3, 0}}}};
  mesh.fields.push_back({"u", Field::On::node, 3, std::vector<double>(3 * mesh.points.size(), 0.1)});
  mesh.fields.push_back({"v", Field::On::hex, 1, std::vector<double>(mesh.hexes.size(), 0.2)});
  return mesh;
}

TEST(fence, meshes_that_are_read_there_are_what_is_read_here) {
  const auto folder = test::output_folder();
  for (const std::string& extension : mesh_formats())
    for (const int order : {1, 2}) {
      SCOPED_TRACE(extension);
      WriteOptions options;
      options.order = order;
      write_mesh(folder / ("a" + extension), with_all(), nullptr, options);
      const MeshFile a = read_mesh(folder / ("a" + extension)),
                     b = read_mesh(folder / ("a" + extension), {}, {readers});
      EXPECT_EQ(a.notices, b.notices);
      EXPECT_EQ(a.mesh, b.mesh);
      EXPECT_EQ(a.middles.nodes_per_hex, b.middles.nodes_per_hex);
      EXPECT_EQ(a.middles.edges, b.middles.edges);
      EXPECT_EQ(a.middles.edge_points, b.middles.edge_points);
      EXPECT_EQ(a.extras.nodes_per_hex, b.extras.nodes_per_hex);
      EXPECT_EQ(a.tags.node_owner, b.tags.node_owner);
      EXPECT_EQ(b.mesh.hexes, with_all().hexes);
    }
}

TEST(fence, damaged_meshes_in_hdf5_are_one_line) {
  const auto folder = test::output_folder();
  std::mt19937 random(3);
  for (const std::string& extension : mesh_formats()) {
    write_mesh(folder / ("a" + extension), with_all(), nullptr);
    const auto data = folder / (extension == ".xdmf" ? "a.h5" : "a" + extension);
    const std::string bytes = content(data);
    for (int trial = 0; trial < 25; ++trial) {
      SCOPED_TRACE(extension + " " + std::to_string(trial));
      std::string changed = bytes;
      if (trial < 8)
        changed.resize(bytes.size() * static_cast<std::size_t>(trial) / 8 + 1);
      else
        for (int k = 0; k < 8; ++k)
          changed[random() % std::min<std::size_t>(changed.size(), 6000)] = static_cast<char>(random());
      std::ofstream(data, std::ios::binary) << changed;
      try {
        const Mesh mesh = read_mesh(folder / ("a" + extension), {}, {.readers = readers, .seconds = 20}).mesh;
        EXPECT_TRUE(test::sets_valid(mesh));
      } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      }
    }
  }
}

TEST(fence, data_outside_of_the_folder_are_refused) {
  const auto folder = test::output_folder();
  const auto formats = mesh_formats();
  if (std::ranges::find(formats, ".xdmf") == formats.end()) GTEST_SKIP() << "built without HDF5";
  std::filesystem::create_directories(folder / "in");
  write_mesh(folder / "in" / "a.xdmf", with_all(), nullptr);
  const Fence fence{.readers = readers, .folder = folder / "in"};
  EXPECT_EQ(refused(folder / "in" / "a.xdmf", fence), "read");
  std::filesystem::rename(folder / "in" / "a.h5", folder / "a.h5");
  std::string text = content(folder / "in" / "a.xdmf");
  for (std::size_t at = text.find("a.h5:"); at != std::string::npos; at = text.find("a.h5:", at + 8))
    text.insert(at, "../");
  std::ofstream(folder / "in" / "a.xdmf") << text;
  EXPECT_NE(refused(folder / "in" / "a.xdmf", fence).find("names '../a.h5', and files may be read below"),
            std::string::npos);
  EXPECT_EQ(refused(folder / "in" / "a.xdmf", {readers}), "read");
}

}  // namespace
}  // namespace hextwist
