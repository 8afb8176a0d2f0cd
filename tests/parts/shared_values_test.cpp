// Nodal values that parts say differently of the nodes between them.
#include <cmath>
#include <limits>

#include "hextwist/parts/files.h"
#include "hextwist/parts/on_disk.h"
#include "hextwist/parts/own_part.h"
#include "hextwist/parts/shared_values.h"
#include "hextwist/parts/split.h"
#include "hextwist/session/session.h"
#include "slices_support.h"

#ifdef HEXTWIST_MPI_PROGRAM
#include "ranks_support.h"
#endif

namespace hextwist {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

TEST(SharedValues, the_first_number_is_kept) {
  double kept = none;
  EXPECT_FALSE(settle_value(kept, none));
  EXPECT_TRUE(settle_value(kept, 2));
  EXPECT_FALSE(settle_value(kept, 2));
  EXPECT_TRUE(settle_value(kept, std::nextafter(2.0, 3.0)));
  EXPECT_TRUE(settle_value(kept, none));
  EXPECT_EQ(kept, 2);
  double zero = 0;
  EXPECT_TRUE(settle_value(zero, -0.0)) << "other bits make other digests";
}

/// A row of 6 x 2 x 2 hexes in three slabs of two; nodes 1 to 7 are along x. Parts say other things of nodes 3 and 5
/// (of the first two and the last two) and of node 10 above 3.
std::filesystem::path differing_parts(const std::filesystem::path& folder) {
  Mesh mesh = test::grid(6, 2, 2);
  Field field{"T", Field::On::node, 1, {}};
  for (const Vec3& p : mesh.points) field.values.push_back(1 + p.x());
  mesh.fields = {field, {"same", Field::On::node, 1, field.values}};
  const MeshedModel whole{mesh, nullptr, {}};
  const Splitting splitting(whole, partition(whole.mesh, 3, PartitionBy::slabs), 3);
  PartOutput files(folder / "parts.e", 3);
  std::vector<std::string> notices;
  for (int p = 0; p < 3; ++p) {
    MeshPart part = splitting.part(p);
    need_ids(part.mesh);
    const auto set = [&](std::int64_t id, double value) {
      if (const Index n = find_node(part.mesh, id); n >= 0) part.mesh.fields[0].values[n] = value;
    };
    set(3, p == 0 ? 3 : std::nextafter(3.0, 4.0));
    set(10, p == 0 ? none : 7);
    set(5, p == 1 ? 5 : none);
    files.write({std::move(part.mesh), {}, std::move(part.file), {}}, notices);
  }
  files.commit();
  return folder / "parts.e.3.0";
}
constexpr const char* note =
    "parts.e: parts have different values of field 'T' at 3 nodes, the first is node 3: the lowest part that has a "
    "number there is right";

TEST(SharedValues, of_joined_parts_are_those_of_the_lowest_that_has_numbers) {
  const auto folder = test::output_folder();
  const auto first = differing_parts(folder);
  for (const char* to : {"joined.e", "joined.vtu"}) {  // a part at a time, in memory
    const std::vector<std::string> lines = join_files(first, folder / to);
    EXPECT_EQ(std::ranges::count(lines, folder.string() + "/" + note), 1) << lines.front();
    const Mesh mesh = read_mesh(folder / to).mesh;
    const auto field = std::ranges::find(mesh.fields, "T", &Field::name);
    ASSERT_NE(field, mesh.fields.end());
    EXPECT_EQ(field->values[2], 3);
    EXPECT_EQ(field->values[9], 7);
    EXPECT_EQ(field->values[4], 5);
  }
}

/// What a single process makes of the joined file.
std::string refined_by_one(const std::filesystem::path& folder, const std::string& commands) {
  join_files(folder / "parts.e.3.0", folder / "joined.e");
  Session session;
  session.import_mesh(folder / "joined.e");
  session.run(commands);
  session.export_mesh(folder / "serial.e");
  return test::text_of(folder / "serial.e");
}

TEST(SharedValues, that_differ_stop_no_refinement_from_disk_to_disk) {
  const auto folder = test::output_folder();
  const auto first = differing_parts(folder);
  const std::string commands = "refine hex 2 3";
  std::vector<std::string> said;
  refine_on_disk(first, PartCommands(std::vector{commands}), folder / "fine.e", {},
                 [&](const std::string& line) { said.push_back(line); });
  EXPECT_EQ(std::ranges::count(said, folder.string() + "/" + note), 1);
  join_files(folder / "fine.e.3.0", folder / "again.e");
  EXPECT_TRUE(test::text_of(folder / "again.e") == refined_by_one(folder, commands));
}

#ifdef HEXTWIST_MPI_PROGRAM
TEST(SharedValues, that_differ_stop_no_refinement_in_ranks) {
  const auto folder = test::output_folder();
  const auto first = differing_parts(folder);
  const std::string commands = "refine hex 2 3", expected = refined_by_one(folder, commands);
  for (const int n : {1, 2, 3}) {
    const test::Outcome outcome =
        test::run_ranks(n, "'" + first.string() + "' -c '" + commands + "' -o '" + (folder / "fine.e").string() + "'");
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_NE(outcome.out.find(note), std::string::npos) << outcome.out;
    EXPECT_EQ(outcome.out.find(note), outcome.out.rfind(note)) << outcome.out;
    join_files(part_name(folder / "fine.e", n, 0), folder / "again.e");
    EXPECT_TRUE(test::text_of(folder / "again.e") == expected) << n;
  }
}
#endif

}  // namespace
}  // namespace hextwist
