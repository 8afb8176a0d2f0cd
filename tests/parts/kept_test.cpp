// What files of the whole say beside their mesh: kept by parts and by what they are joined to, told, or refused.
#include <cstdlib>
#include <numeric>

#include "hextwist/command/error_at.h"
#include "hextwist/io/results.h"
#include "hextwist/io/slice.h"
#include "hextwist/parts/files.h"
#include "hextwist/parts/on_disk.h"
#include "hextwist/session/session.h"
#include "slices_support.h"
#include "support/exodus_extras.h"

namespace hextwist {
namespace {

std::string refined_on_disk(const std::filesystem::path& whole, int n_parts, const std::string& commands,
                            const std::filesystem::path& to, PartitionBy by = PartitionBy::slabs) {
  OnDiskOptions options;
  options.n_parts = n_parts;
  options.by = by;
  std::string lines;
  refine_on_disk(whole, PartCommands(std::vector{commands}), to, options,
                 [&](const std::string& line) { lines += line + "\n"; });
  return lines;
}
std::string text_of_lines(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}
std::string split_by(const std::filesystem::path& whole, const std::filesystem::path& to, PartitionBy by) {
  return text_of_lines(split_file(whole, to, 2, by));
}
bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Blocks and sets of two kinds of ids, a moment, records, a property, a value of the whole.
Mesh with_all_of_the_whole() {
  Mesh mesh = test::grid(6, 3, 2);
  mesh.blocks = {{2, "left", {}}, {7, "right", {}}};
  for (Index h = 0; h < mesh.n_hexes(); ++h) mesh.blocks[h % 6 > 2].hexes.push_back(h);
  mesh.node_sets = {{3, "end", {}}};
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    if (mesh.points[n].x() == 0) mesh.node_sets[0].nodes.push_back(n);
  mesh.side_sets = {{4, "hot", {{0, 0}, {6, 0}}}};
  Field field{"T", Field::On::node, 1, {}};
  for (const Vec3& p : mesh.points) field.values.push_back(p.x());
  mesh.fields = {field};
  FileResults results;
  results.times = {2.5};
  results.of_all = {{"energy", {test::list({6.25})}}};
  results.properties = {{FileResults::Of::block, "MATERIAL", {{2, 11}, {7, 12}}}};
  results.title = "a bar under load";
  results.coordinate_names = {"r", "s", "t"};
  results.info = {"first line", "second line"};
  results.qa = {{"MESHER", "1.2", "01/02/2026", "10:20:30"}};
  mesh.results = std::make_shared<const FileResults>(results);
  return mesh;
}
Mesh with_wide_ids() {
  Mesh mesh = with_all_of_the_whole();
  FileResults results = *mesh.results;
  using Of = FileResults::Of;
  results.wide_ids = {
      {Of::block, 2, 5'000'000'000}, {Of::node_set, 3, 3'000'000'007}, {Of::side_set, 4, 4'000'000'009}};
  mesh.results = std::make_shared<const FileResults>(results);
  return mesh;
}

/// Files of wide ids are in the form of HDF5, whose bytes depend on the order in which they were written.
void expect_alike(const std::filesystem::path& a, const std::filesystem::path& b) {
  const Mesh mesh = read_mesh(a).mesh, other = read_mesh(b).mesh;
  EXPECT_TRUE(test::same_mesh(mesh, other));
  ASSERT_TRUE(mesh.results && other.results);
  EXPECT_EQ(mesh.results->title, other.results->title);
  EXPECT_EQ(mesh.results->qa, other.results->qa);
  EXPECT_EQ(mesh.results->info, other.results->info);
  EXPECT_EQ(mesh.results->times, other.results->times);
  ASSERT_EQ(mesh.results->properties.size(), other.results->properties.size());
  for (std::size_t i = 0; i < mesh.results->properties.size(); ++i)
    EXPECT_EQ(mesh.results->properties[i].values, other.results->properties[i].values);
  ASSERT_EQ(mesh.results->wide_ids.size(), other.results->wide_ids.size());
  for (std::size_t i = 0; i < mesh.results->wide_ids.size(); ++i)
    EXPECT_EQ(mesh.results->wide_ids[i].in_file, other.results->wide_ids[i].in_file);
  const bool is_classic = mesh.results->wide_ids.empty();
  EXPECT_TRUE(!is_classic || test::text_of(a) == test::text_of(b)) << "byte for byte";
}

TEST(Kept, what_is_of_the_whole_is_in_the_joined_file) {
  const auto folder = test::output_folder();
  for (const Mesh& mesh : {with_all_of_the_whole(), with_wide_ids()})
    for (const PartitionBy by : {PartitionBy::ids, PartitionBy::random, PartitionBy::slabs}) {  // blocks in one part
      write_mesh(folder / "whole.e", mesh, nullptr);
      write_mesh(folder / "again.e", read_mesh(folder / "whole.e").mesh, nullptr);
      split_by(folder / "whole.e", folder / "parts.e", by);
      const auto part = folder / "parts.e.2.1";
      const std::string said = text_of_lines(join_files(part, folder / "joined.e"));
      EXPECT_FALSE(has(said, "without")) << said;
      expect_alike(folder / "joined.e", folder / "again.e");
      write_mesh(folder / "at_once.e", read_parts(part).mesh, nullptr);
      expect_alike(folder / "at_once.e", folder / "again.e");
    }
}

TEST(Kept, what_is_of_the_whole_is_refined_along) {
  const auto folder = test::output_folder();
  const std::string commands = "refine hex 1 2";
  for (const Mesh& mesh : {with_all_of_the_whole(), with_wide_ids()}) {
    write_mesh(folder / "whole.e", mesh, nullptr);
    Session session;
    session.import_mesh(folder / "whole.e");
    session.run(commands);
    session.export_mesh(folder / "serial.e");
    split_by(folder / "whole.e", folder / "parts.e", PartitionBy::random);
    refined_on_disk(folder / "parts.e.2.0", 0, commands, folder / "fine.e");
    join_files(folder / "fine.e.2.0", folder / "joined.e");
    expect_alike(folder / "joined.e", folder / "serial.e");
    if (!mesh.results->wide_ids.empty()) continue;
    EXPECT_FALSE(has(refined_on_disk(folder / "whole.e", 2, commands, folder / "fine.e"), "without"));
    join_files(folder / "fine.e.2.0", folder / "joined.e");
    expect_alike(folder / "joined.e", folder / "serial.e");
  }
}

/// A set may have all its members in one part.
TEST(Kept, factors_that_are_alike_are_in_parts_and_joining_says_that_they_go) {
  const auto folder = test::output_folder();
  Mesh mesh = with_all_of_the_whole();
  FileResults results = *mesh.results;
  results.node_sets = {{3, {}, {}, {1}, {}}};
  results.side_sets = {{4, {}, {}, {1}, {}}};
  mesh.results = std::make_shared<const FileResults>(results);
  write_mesh(folder / "whole.e", mesh, nullptr);
  EXPECT_FALSE(has(split_by(folder / "whole.e", folder / "parts.e", PartitionBy::slabs), "without"));
  EXPECT_EQ(read_mesh(folder / "parts.e.2.0", "exodus").mesh.results->node_sets.size(), 1u);
  const std::string said = text_of_lines(join_files(folder / "parts.e.2.0", folder / "joined.e"));
  EXPECT_TRUE(has(said, "without distribution factors of nodeset 3, distribution factors of sideset 4")) << said;
}

TEST(Kept, periodic_surfaces_are_refused_where_parts_are_refined_and_told_where_a_mesh_is_split) {
  const auto folder = test::output_folder();
  Session session;
  session.run("create brick x 3 y 2 z 2 interval 3 2 2");
  write_mesh(folder / "plain.msh", session.meshed().mesh, &session.meshed().association, {.binary = false});
  const auto file =
      test::write_text(folder / "a.msh", test::text_of(folder / "plain.msh") +
                                             "$Periodic\n2\n1 1 2\n0\n1\n1 2\n2 1 2\n0\n1\n1 4\n$EndPeriodic\n");
  ASSERT_EQ(read_mesh(file).extras.periodic.size(), 2u);
  ASSERT_TRUE(in_slices(file));
  const std::string refused = file.string() + ": periodic surfaces are not kept alike in parts; run it with hextwist";
  EXPECT_EQ(test::error_of([&] { refined_on_disk(file, 2, "refine hex 1", folder / "fine.e"); }), refused);
  EXPECT_FALSE(std::filesystem::exists(folder / "fine.e.2.0"));
  for (const PartitionBy by : {PartitionBy::ids, PartitionBy::random})
    for (const char* to : {"p.e", "p.msh"})
      EXPECT_TRUE(has(split_by(file, folder / to, by),
                      "pairs of nodes of 2 periodic entities left out, which parts have no place for"))
          << to;
  // Of curves alone: they are no more than told.
  const auto curves = test::write_text(
      folder / "b.msh", test::text_of(folder / "plain.msh") + "$Periodic\n1\n1 1 2\n0\n1\n1 2\n$EndPeriodic\n");
  EXPECT_TRUE(has(refined_on_disk(curves, 2, "refine hex 1", folder / "fine.e"), "1 periodic entity left out"));
}

/// Gmsh leaves them in its parts.
TEST(Kept, parts_that_say_their_surfaces_are_periodic_are_not_refined) {
  const auto folder = test::output_folder();
  write_mesh(folder / "whole.e", test::grid(4, 2, 2), nullptr);
  split_by(folder / "whole.e", folder / "p.msh", PartitionBy::slabs);
  for (const char* part : {"p_1.msh", "p_2.msh"}) {
    const MeshFile read = read_mesh(folder / part);
    FilePart of;
    of.number = part[2] - '1';
    of.n_parts = 2;
    WriteOptions options;
    options.binary = false;
    options.part = &of;
    write_mesh(folder / part, read.mesh, nullptr, options);
    test::write_text(folder / part, test::text_of(folder / part) + "$Periodic\n1\n2 1 2\n0\n0\n$EndPeriodic\n");
  }
  const std::string error =
      test::error_of([&] { refined_on_disk(folder / "p_1.msh", 0, "refine hex 1", folder / "fine.e"); });
  EXPECT_TRUE(has(error, "p_1.msh: periodic surfaces are not kept alike in parts")) << error;
  const std::string said = text_of_lines(join_files(folder / "p_1.msh", folder / "joined.e"));
  EXPECT_TRUE(has(said, "1 periodic entity left out")) << said;
}

TEST(Kept, splitting_says_what_else_it_leaves_out) {
  const auto folder = test::output_folder();
  write_mesh(folder / "plain.inp", test::grid(4, 2, 2), nullptr);
  const auto file = test::write_text(
      folder / "a.inp", test::text_of(folder / "plain.inp") + "*MATERIAL, NAME=steel\n*ELASTIC\n210000., 0.3\n");
  const std::string said = split_by(file, folder / "p.e", PartitionBy::ids);
  EXPECT_TRUE(has(said, "cards left out, which parts have no place for: *MATERIAL, *ELASTIC")) << said;
}

/// Of an Exodus file with properties, which parts have.
TEST(Kept, what_slices_keep_is_not_said_to_be_lost) {
  const auto folder = test::output_folder();
  write_mesh(folder / "whole.e", with_all_of_the_whole(), nullptr);
  EXPECT_FALSE(has(split_by(folder / "whole.e", folder / "p.e", PartitionBy::ids), "without"));
  EXPECT_EQ(read_mesh(folder / "p.e.2.1", "exodus").mesh.results->properties.size(), 1u);
}

TEST(Kept, slices_keep_the_moment_of_their_fields_and_what_the_whole_has_then) {
  const auto folder = test::output_folder();
  const Mesh mesh = test::with_extras();
  write_mesh(folder / "whole.e", mesh, nullptr);
  const std::string said = refined_on_disk(folder / "whole.e", 2, "refine hex 1", folder / "fine.e");
  EXPECT_TRUE(has(said, "whole.e: is read in slices without 2 more time steps, ")) << said;
  EXPECT_FALSE(has(said, "global variable")) << said;
  for (const char* part : {"fine.e.2.0", "fine.e.2.1"}) {
    const MeshFile read = read_mesh(folder / part, "exodus");
    ASSERT_TRUE(read.mesh.results);
    EXPECT_EQ(read.mesh.results->times, std::vector{2.5});
    ASSERT_EQ(read.mesh.results->of_all.size(), 1u);
    EXPECT_EQ(read.mesh.results->of_all[0].name, "energy");
    EXPECT_EQ(*read.mesh.results->of_all[0].at[0], std::vector{6.25});
  }
}

TEST(Kept, joining_parts_of_gmsh_says_that_owners_go) {
  const auto folder = test::output_folder();
  write_mesh(folder / "whole.e", test::grid(4, 2, 2), nullptr);
  refined_on_disk(folder / "whole.e", 2, "refine hex 1", folder / "fine.msh");
  ASSERT_FALSE(read_mesh(folder / "fine_1.msh").tags.empty());
  for (const char* to : {"joined.msh", "joined.e"}) {
    const std::string said = text_of_lines(join_files(folder / "fine_1.msh", folder / to));
    const std::string told = "parts are joined without the owners that they name: left out";
    const std::size_t at = said.find(told);
    ASSERT_NE(at, std::string::npos) << said;
    EXPECT_FALSE(has(said.substr(at + told.size()), "without the owners")) << "once for all parts";
  }
}

TEST(Kept, parts_do_not_get_the_names_of_other_formats) {
  const auto folder = test::output_folder();
  write_mesh(folder / "whole.e", test::grid(4, 2, 2), nullptr);
  for (const std::string name : {"o.vtu", "o.inp", "o.MED", "o.vtk"}) {
    const std::string refused = (folder / name).string() + ": parts are not written as " +
                                (name == "o.MED" ? ".med" : name.substr(1)) +
                                " files; their names end in .e .exo .g .gen (Exodus), .msh or .pvtu";
    for (const PartitionBy by : {PartitionBy::ids, PartitionBy::random})
      EXPECT_EQ(test::error_of([&] { split_by(folder / "whole.e", folder / name, by); }), refused);
    EXPECT_EQ(test::error_of([&] { refined_on_disk(folder / "none.e", 2, "refine hex 1", folder / name); }), refused)
        << "before anything is read";
  }
  // Files of Nemesis have all kinds of names.
  for (const char* name : {"o.par", "o", "o.exo", "o.GEN"}) {
    split_by(folder / "whole.e", folder / name, PartitionBy::ids);
    EXPECT_TRUE(std::filesystem::exists(folder / (std::string(name) + ".2.0"))) << name;
  }
}

TEST(Kept, a_mesh_of_one_part_is_read_again) {
  const auto folder = test::output_folder();
  const Mesh mesh = test::grid(4, 2, 2);
  write_mesh(folder / "whole.e", mesh, nullptr);
  for (const std::string name : {"x.msh", "x.e"}) {
    split_file(folder / "whole.e", folder / name, 1, PartitionBy::ids);
    const auto part = part_name(folder / name, 1, 0);
    EXPECT_EQ(split_name(part).n_parts, 1) << part;
    join_files(part, folder / "joined.e");
    EXPECT_TRUE(test::same_mesh(read_mesh(folder / "whole.e").mesh, read_mesh(folder / "joined.e").mesh)) << part;
  }
}

/// They are left out, but new nodes have the ids that one process gives them.
TEST(Kept, nodes_of_no_hex_have_their_ids) {
  const auto folder = test::output_folder();
  Mesh mesh = test::grid(5, 2, 2);
  mesh.points.insert(mesh.points.end(), 3, Vec3(9, 9, 9));
  mesh.node_ids.resize(mesh.points.size());
  std::iota(mesh.node_ids.begin(), mesh.node_ids.end(), 1);
  mesh.node_ids.back() += 100;
  for (const std::string extension : {".e", ".vtu", ".msh"}) {
    SCOPED_TRACE(extension);
    const auto file = folder / ("loose" + extension);
    write_mesh(file, mesh, nullptr);
    std::int64_t highest = 0;
    Session session;
    session.import_mesh(file);
    session.run("refine hex 1");
    highest = session.meshed().mesh.node_ids.back();
    refined_on_disk(file, 2, "refine hex 1", folder / "fine.e");
    EXPECT_EQ(read_parts(folder / "fine.e.2.0").mesh.node_ids.back(), highest);
  }
}

TEST(Kept, why_a_file_is_not_read_in_slices_is_said) {
  const auto folder = test::output_folder();
  const Mesh grid = test::grid(4, 2, 2);
  const auto refusal = [&](const std::string& name) {
    const std::string error =
        test::error_of([&] { refined_on_disk(folder / name, 2, "refine hex 1", folder / "fine.e"); });
    const std::string begin = (folder / name).string() + ": is not read in slices, as it has ";
    EXPECT_EQ(error.substr(0, begin.size()), begin);
    return error.substr(std::min(begin.size(), error.size()));
  };
  const std::string hint = "; 'hextwist split' makes parts of it";
  write_mesh(folder / "text.vtu", grid, nullptr, {.binary = false});
  EXPECT_TRUE(has(refusal("text.vtu"), "arrays as text")) << refusal("text.vtu");
  EXPECT_TRUE(has(refusal("text.vtu"), hint));
  WriteOptions second;
  second.order = 2;
  write_mesh(folder / "second.e", grid, nullptr, second);
  EXPECT_EQ(refusal("second.e"), "hexes of 20 nodes (element block 1)") << "which are not split either";
  test::write_text(
      folder / "old.msh",
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n"
      "7 1 1 1\n8 0 1 1\n$EndNodes\n$Elements\n2\n1 5 2 1 1 1 2 3 4 5 6 7 8\n2 5 2 2 1 1 2 3 4 5 6 7 8\n"
      "$EndElements\n");
  EXPECT_EQ(refusal("old.msh"), "a volume in several physical groups (element 2)" + hint);
  write_mesh(folder / "grid.bdf", grid, nullptr);
  EXPECT_EQ(refusal("grid.bdf"), "another format than Exodus, .vtu and .msh" + hint);
  write_mesh(folder / "second.msh", grid, nullptr, second);
  EXPECT_TRUE(has(refusal("second.msh"), "elements other than hexes of 8 nodes"));
  EXPECT_FALSE(has(refusal("second.msh"), hint));
  Mesh overlaps = grid;
  overlaps.blocks = {{1, "all", {}}, {2, "some", {1, 2}}};
  for (Index h = 0; h < grid.n_hexes(); ++h) overlaps.blocks[0].hexes.push_back(h);
  for (const char* name : {"overlaps.e", "overlaps.vtu"}) {
    write_mesh(folder / name, overlaps, nullptr);
    EXPECT_TRUE(has(refusal(name), "blocks that overlap (")) << refusal(name);
    EXPECT_FALSE(has(refusal(name), hint)) << "such parts are not refined from disk to disk";
  }
  write_mesh(folder / "wide.e", with_wide_ids(), nullptr);
  EXPECT_EQ(refusal("wide.e"), "a block or set of the id 5000000000" + hint);
  OnDiskOptions fenced;
  fenced.n_parts = 2;
  fenced.fence.readers = folder;
  EXPECT_EQ(test::error_of([&] {
              refine_on_disk(folder / "wide.e", PartCommands(std::vector<std::string>{"refine hex 1"}),
                             folder / "fine.e", fenced, [](const std::string&) {});
            }),
            (folder / "wide.e").string() +
                ": is not read in slices, as it has the form of HDF5 (NetCDF-4), which is read behind a fence" + hint);
}

TEST(Kept, parts_that_overlap_are_named_by_their_files) {
  const auto folder = test::output_folder();
  write_mesh(folder / "whole.e", test::grid(4, 2, 2), nullptr);
  split_by(folder / "whole.e", folder / "p.msh", PartitionBy::slabs);
  split_file(folder / "whole.e", folder / "q.msh", 2, PartitionBy::ids);
  std::filesystem::copy_file(folder / "q_2.msh", folder / "p_2.msh", std::filesystem::copy_options::overwrite_existing);
  const std::string error =
      test::error_of([&] { refined_on_disk(folder / "p_1.msh", 0, "refine hex 1", folder / "fine.e"); });
  EXPECT_TRUE(has(error, "is in " + (folder / "p_1.msh").string() + " and in " + (folder / "p_2.msh").string()))
      << error;
}

TEST(Kept, lists_of_pieces_are_written_under_any_name) {
  const auto folder = test::output_folder();
  write_mesh(folder / "whole.e", test::grid(4, 2, 2), nullptr);
  split_by(folder / "whole.e", folder / "a&b<c\".pvtu", PartitionBy::ids);
  EXPECT_TRUE(has(test::text_of(folder / "a&b<c\".pvtu"), "<Piece Source=\"a&amp;b&lt;c&quot;_1.vtu\"/>"));
  EXPECT_TRUE(std::filesystem::exists(folder / "a&b<c\"_1.vtu"));
  split_by(folder / "whole.e", folder / "big.PVTU", PartitionBy::ids);
  EXPECT_TRUE(std::filesystem::exists(folder / "big_1.vtu"));
  EXPECT_FALSE(std::filesystem::exists(folder / "big.PVTU.2.0"));
}

std::string refusal_of(const std::string& commands) {
  try {
    PartCommands{std::vector{commands}};
  } catch (const CommandError& error) {
    return error.message();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(PartCommands, lines_of_other_programs_are_skipped_as_in_a_session) {
  const PartCommands some(std::vector<std::string>{"graphics off; refine hex 1"});
  EXPECT_EQ(some.size(), 1u);
  EXPECT_EQ(some.by_whole(), "");
  ASSERT_EQ(some.notices().size(), 1u);
  EXPECT_TRUE(some.notices()[0].starts_with("'graphics' is skipped")) << some.notices()[0];
  EXPECT_TRUE(has(refusal_of("unite volume all"), "geometry is not edited here")) << refusal_of("unite volume all");
  EXPECT_EQ(refusal_of("graphics off"), "no refinement was asked for");
}

TEST(PartCommands, all_blocks_or_sets_are_forgotten_by_the_first_process) {
  for (const char* text : {"reset nodeset", "reset sideset", "reset block", "reset genesis"})
    EXPECT_EQ(PartCommands(std::vector<std::string>{text}).by_whole(), "'reset': only refinements are done in parts")
        << text;
  for (const char* text : {"reset", "reset mesh"})
    EXPECT_EQ(refusal_of(text),
              "'reset' is for sessions of hextwist: here the mesh is read first and written in the end");
}

TEST(PartCommands, those_that_put_the_mesh_on_another_model_are_refused_by_name) {
  for (const auto& [text, named] : {std::pair{"move x 1", "move"},
                                    {"refine hex 1; scale 2", "scale"},
                                    {"rotate model 90 about z", "rotate"},
                                    {"reflect model x", "reflect"},
                                    {"volume all move x 1", "move"},
                                    {"volume all scale 2", "scale"},
                                    {"volume all rotate 90 about z", "rotate"},
                                    {"volume all reflect x", "reflect"},
                                    {"project to geometry \"a.step\"", "project to geometry"}})
    EXPECT_EQ(refusal_of(text),
              "'" + std::string(named) + "' puts the mesh on another model: parts stay on theirs; run it with hextwist")
        << text;
  for (const char* stays : {"volume all smooth scheme laplacian", "surface 1 name \"a\"", "project to geometry"})
    EXPECT_NE(PartCommands(std::vector<std::string>{stays}).by_whole(), "") << stays;
}

}  // namespace
}  // namespace hextwist
