// record: commands become a journal.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "session/session_fixture.h"

namespace hextwist {

using test::Fixture, test::folder, test::written;

namespace {

std::string content(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(Record, writes_commands_that_succeed_as_typed) {
  const auto file = folder() / "a.jou";
  const auto nested = written("nested.jou", "refine hex 2\nbogus\nrefine hex 3\n");
  Fixture f;
  f.session.run("create brick x 1 interval 2");
  f.session.run("record '" + file.string() + "'");
  EXPECT_NE(f.error("refine hex 99"), "no error");
  f.session.run("REF  hex 1 # a comment\nundo");
  EXPECT_NE(f.error("playback '" + nested.string() + "'"), "no error");
  f.session.run("list; record stop; list");
  EXPECT_EQ(content(file), "REF hex 1\nundo\nrefine hex 2\nlist\n");
  EXPECT_NE(f.all_output().find("4 commands recorded"), std::string::npos);
  // What was recorded does the same again.
  Fixture g;
  g.session.run("create brick x 1 interval 2; playback '" + file.string() + "'");
  EXPECT_EQ(g.session.meshed().mesh, f.session.meshed().mesh);
}

TEST(Record, keeps_files_unless_told_otherwise) {
  const auto file = written("a.jou", "list\n");
  const std::string record = "record '" + file.string() + "'";
  Fixture f;
  EXPECT_EQ(f.error("record stop"), "nothing is being recorded");
  EXPECT_EQ(f.error(record), "this file exists: say 'overwrite', or 'append' to go on at its end");
  EXPECT_EQ(f.error("record '/no/such/folder/a.jou'"),
            "/no/such/folder/a.jou: can't be written: No such file or directory");
  f.session.run(record + " append; reset");
  EXPECT_NE(f.error(record + " append").find("already; 'record stop' ends that"), std::string::npos);
  f.session.run("record stop");
  EXPECT_EQ(content(file), "list\nreset\n");
  f.session.run(record + " overwrite; help; record stop");
  EXPECT_EQ(content(file), "help\n");
}

}  // namespace
}  // namespace hextwist
