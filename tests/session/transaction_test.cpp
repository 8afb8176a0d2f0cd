// Commands and calls that fail: all of them leave the same, nothing but a row of the record.
#include <gtest/gtest.h>

#include <functional>

#include "hextwist/patch/patch.h"
#include "session/session_fixture.h"
#include "support/same_meshed.h"

namespace hextwist::test {
namespace {

/// A session that has a bit of everything, and what can be seen of it.
struct Subject : Fixture {
  Subject() {
    session.run("{n = 3}; create brick x 6 interval 6; refine hex 1; nodeset 1 curve 1; group \"g\" add hex 40");
    session.run("node 1 position fixed; refine hex 100; sizing function wish constant 1; undo");
  }
  std::vector<std::string> said(const std::string& command) {
    output.clear();
    session.run(command);
    return output;
  }
  std::vector<std::string> seen() {
    std::vector<std::string> all;
    // The expression at the end says what n is.
    for (const char* command : {"list undo", "list", "list group all", "list node 1", "sizing list",
                                "nodeset 9 node {n}", "undo; redo; undo"})
      for (const std::string& line : said(command)) all.push_back(line);
    return all;
  }
};

struct Failing {
  std::string what, message;
  std::function<void(Subject&)> run;
};

/// Each comes in the middle of a change.
std::vector<Failing> failures() {
  const auto command = [](const std::string& text, const std::string& message) {
    return Failing{text, message, [text](Subject& s) { s.session.run(text); }};
  };
  // Whoever is told of what was done throws: after all is done.
  const auto untold = [](const std::string& text) {
    return Failing{text + ", told", "no paper", [text](Subject& s) {
                     s.session.set_callbacks({.output = [](const std::string&) { throw Error("no paper"); },
                                              .notice = {},
                                              .error = {},
                                              .progress = {}});
                     s.session.run(text);
                   }};
  };
  const auto cancelled = [](const std::string& what, const std::function<void(Session&)>& f) {
    return Failing{
        what + ", cancelled", "cancelled", [f](Subject& s) {
          int n_calls = 0;
          s.session.set_callbacks({.output = {}, .notice = {}, .error = {}, .progress = [&](const char*, double) {
                                     return ++n_calls < 3;
                                   }});
          f(s.session);
        }};
  };
  const auto call = [](const std::string& what, const std::string& message, const std::function<void(Session&)>& f) {
    return Failing{what, message, [f](Subject& s) { f(s.session); }};
  };
  const auto adapt_one = [](Session& s) {
    std::vector<std::uint8_t> flags(s.meshed().mesh.hexes.size(), 0);
    flags[5] = 1;
    s.adapt(flags);
  };
  return {command("nodeset {n = 7} remove node 1", "there is no nodeset 7"),
          command("refine hex {n = 9999}", "hex 9999 does not exist; hexes are 3 to 297"),
          command("refine {n = 5} hex", ""),
          command("import mesh 'none{n = 4}.msh'", ""),
          untold("refine hex 20"),
          untold("refine hex {n = 20}"),
          untold("nodeset 1 add node 5"),
          untold("nodeset 2 node {n = 5}"),
          untold("delete nodeset 1"),
          untold("smooth volume all iterations 1"),
          untold("create sphere radius 2"),
          untold("node 2 position fixed"),
          untold("undo"),
          untold("undo 2"),
          untold("undo 4"),
          untold("redo"),
          cancelled("undo 4", [](Session& s) { s.run("undo 4"); }),
          cancelled("refine volume all", [](Session& s) { s.run("refine volume all"); }),
          cancelled("adapt", adapt_one),
          call("adapt without flags", "",
               [](Session& s) {
                 s.adapt(std::vector<std::uint8_t>{1, 2});
               }),
          call("take a mesh of nothing", "mesh: there are no hexes", [](Session& s) { s.take(Mesh(), nullptr); }),
          call("take a broken mesh", "",
               [](Session& s) {
                 Mesh broken = s.meshed().mesh;
                 broken.hexes[3][0] = broken.hexes[3][1];
                 s.take_mesh(std::move(broken));
               }),
          call("take a mesh on no CAD it fits", "", [](Session& s) {
            MeshedModel other = s.meshed();
            other.association.node_owner[0] = {3, 1};
            s.take(std::move(other), true);
          })};
}

TEST(Transaction, a_failing_command_and_a_failing_call_leave_nothing_but_a_record) {
  const PatchRule rule_before = patch_rule;
  for (const PatchRule& rule : {PatchRule{0, 1}, rule_before})
    for (const bool is_looked_at : {false, true})
      for (const Failing& failing : failures()) {
        SCOPED_TRACE(failing.what + (is_looked_at ? " while the mesh is looked at" : ""));
        patch_rule = rule;
        Subject subject, untouched;
        const std::shared_ptr<const MeshedModel> lent = is_looked_at ? subject.session.share() : nullptr;
        const MeshedModel* const place = &subject.session.meshed();
        const MeshedModel before = *place;
        const std::size_t n_records = subject.session.records().size();
        const SessionCallbacks callbacks = subject.callbacks();
        std::string message = "no error";
        try {
          failing.run(subject);
        } catch (const CommandError& error) {
          message = error.message();
        }
        subject.session.set_callbacks(callbacks);
        EXPECT_NE(message, "no error");
        EXPECT_TRUE(failing.message.empty() || message == failing.message) << message;
        EXPECT_EQ(&subject.session.meshed(), place);
        EXPECT_TRUE(same_bits(subject.session.meshed(), before));
        EXPECT_EQ(subject.session.records().size(), n_records + 1);
        EXPECT_FALSE(subject.last().ok);
        EXPECT_EQ(subject.last().error, message);
        EXPECT_EQ(subject.last().after.nodes, subject.last().before.nodes);
        EXPECT_EQ(subject.last().after.shape.min_hex, subject.last().before.shape.min_hex);
        EXPECT_EQ(subject.seen(), untouched.seen());
        patch_rule = rule_before;
        if (testing::Test::HasFailure()) return;
      }
}

}  // namespace
}  // namespace hextwist::test
