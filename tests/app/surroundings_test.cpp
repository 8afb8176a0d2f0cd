// What the program does when its surroundings are not as they should be.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "support/grids.h"

namespace hextwist {
namespace {

std::string content(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

struct Outcome {
  int status;
  std::string out;
};

/// A line of shell in a folder of the test's own, with $H the program; out: what it prints and what is printed on
/// errors.
class Surroundings : public testing::Test {
 protected:
  const std::filesystem::path folder = test::output_folder();

  Outcome shell(const std::string& line) const {
    const std::string command = "cd '" + folder.string() + "' && H='" HEXTWIST_PROGRAM "' && exec > out 2>&1; " + line;
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), content(folder / "out")};
  }
  std::size_t n_files() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
  }
};

TEST_F(Surroundings, closed_standard_streams_do_not_become_files) {
  const std::string plain = "record stop\n";
  EXPECT_EQ(shell("$H -c 'record \"a.jou\"; create brick x 1; list hex all; record stop' >&-").status, 0);
  EXPECT_EQ(content(folder / "a.jou"), "create brick x 1\nlist hex all\n");
  EXPECT_EQ(shell("$H -c 'record \"b.jou\"; create brick x 1; wrong' 2>&-").status, 1);
  EXPECT_EQ(content(folder / "b.jou"), "create brick x 1\n");
  EXPECT_EQ(shell("$H -c 'create brick x 1' -o a.vtu <&- >&- 2>&-").status, 0);
  EXPECT_EQ(shell("$H a.vtu -c list").status, 0);
}

TEST_F(Surroundings, full_standard_output_is_an_error) {
  const Outcome full = shell("$H -c 'create brick x 1; list' -o a.vtu > /dev/full");
  EXPECT_EQ(full.status, 1);
  EXPECT_EQ(full.out, "error: standard output can't be written: No space left on device\n");
  EXPECT_EQ(shell("$H a.vtu -c list").status, 0) << "the work is done all the same";
}

TEST_F(Surroundings, full_standard_output_is_an_error_of_help_too) {
  for (const char* line : {"$H --help > /dev/full", "$H --version > /dev/full", "$H split --help > /dev/full"}) {
    const Outcome outcome = shell(line);
    EXPECT_EQ(outcome.status, 1) << line;
    EXPECT_EQ(outcome.out, "error: standard output can't be written: No space left on device\n") << line;
  }
  EXPECT_EQ(shell("$H --no-such-option > /dev/full").status, 2);
}

TEST_F(Surroundings, full_standard_output_is_an_error_of_meshes_in_parts_too) {
  ASSERT_EQ(shell("$H -c 'create brick x 1 interval 3' -o a.e").status, 0);
  const std::string full = "error: standard output can't be written: No space left on device\n";
  for (const char* line :
       {"$H split a.e 2 -o p.e > /dev/full", "$H refine-in-parts p.e.2.0 -c 'refine hex 1' -o q.e > /dev/full",
        "$H join q.e.2.0 -o b.e > /dev/full"}) {
    const Outcome outcome = shell(line);
    EXPECT_EQ(outcome.status, 1) << line;
    EXPECT_EQ(outcome.out, full) << line;
  }
  EXPECT_EQ(shell("$H b.e -c list").status, 0) << "the work is done all the same";
}

TEST_F(Surroundings, a_reader_that_goes_away_does_not_end_the_work) {
  shell("{ $H -c 'create brick x 1 interval 10; list hex all; export vtk \"a.vtu\"'; echo $? > status; } | true");
  EXPECT_EQ(content(folder / "status"), "1\n");
  EXPECT_EQ(shell("$H a.vtu -c list").status, 0);
}

TEST_F(Surroundings, a_full_journal_is_an_error_and_the_work_is_done) {
  const Outcome full =
      shell("ln -s /dev/full full.jou; $H -c 'record \"full.jou\" overwrite; create brick x 1; refine hex 1' -o a.vtu");
  EXPECT_EQ(full.status, 1);
  EXPECT_NE(full.out.find("error: full.jou: can't be written, recording has ended"), std::string::npos) << full.out;
  EXPECT_NE(full.out.find("refine hex 1"), 0U);
}

TEST_F(Surroundings, a_pipe_that_nobody_writes_is_not_waited_for) {
  for (const char* name : {"a.msh", "a.e", "a.inp", "a.vtu", "a.brep", "a.step"}) {
    const std::string word = std::string(name).find("ep") == std::string::npos ? "mesh" : "geometry";
    const Outcome refused =
        shell(std::string("mkfifo ") + name + "; timeout 20 $H -c 'import " + word + " \"" + name + "\"'");
    EXPECT_EQ(refused.status, 1) << name;
    EXPECT_NE(refused.out.find(std::string(name) + ": "), std::string::npos) << refused.out;
  }
}

TEST_F(Surroundings, leftovers_of_the_same_process_number_block_nothing) {
  // A shell that becomes the program: its number is known before.
  const Outcome done = shell(
      "sh -c 'for i in 1 2 3; do echo x > .hextwist-$$-$i.part; done; exec \"$0\" -c \"create brick x 1\" -o a.vtu' "
      "$H");
  EXPECT_EQ(done.status, 0) << done.out;
  EXPECT_EQ(shell("$H a.vtu -c list").status, 0);
  EXPECT_EQ(shell("cat .hextwist-*.part").out, "x\nx\nx\n") << "what somebody else left stays as it was";
}

TEST_F(Surroundings, links_to_nowhere_are_followed) {
  EXPECT_EQ(shell("mkdir there; ln -s there/b.vtu a.vtu; $H -c 'create brick x 1' -o a.vtu").status, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "a.vtu"));
  EXPECT_TRUE(std::filesystem::is_regular_file(folder / "there/b.vtu"));
  const Outcome circle = shell("ln -s c.vtu d.vtu; ln -s d.vtu c.vtu; $H -c 'create brick x 1' -o c.vtu");
  EXPECT_EQ(circle.status, 1);
  EXPECT_NE(circle.out.find("c.vtu: cannot be written: "), std::string::npos) << circle.out;
  EXPECT_EQ(shell("ln -s missing/e.vtu e.vtu; $H -c 'create brick x 1' -o e.vtu").status, 1);
}

TEST_F(Surroundings, termination_ends_after_the_command_and_leaves_nothing) {
  const std::string work = "create brick x 1 interval 30; refine volume all numsplit 2";
  const Outcome ended = shell("mkfifo go; $H -c '" + work +
                              "' -o a.vtu < /dev/null & p=$!; while [ ! -s out ]; do :; done; kill -TERM $p; wait $p");
  EXPECT_EQ(ended.status, 128 + 15) << ended.out;
  EXPECT_FALSE(std::filesystem::exists(folder / "a.vtu"));
  EXPECT_EQ(n_files(), 2U) << "out and go";
}

TEST_F(Surroundings, the_report_has_no_name_that_somebody_else_may_have) {
  EXPECT_EQ(shell("sh -c 'echo x > r.json.tmp$$; exec \"$0\" -c \"create brick x 1\" --json r.json' $H").status, 0);
  EXPECT_EQ(shell("cat r.json.tmp*").out, "x\n");
}

}  // namespace
}  // namespace hextwist
