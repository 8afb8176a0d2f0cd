// Properties of the whole language, tried on random sentences made from its own tables.
#include <gtest/gtest.h>

#include <set>

#include "command/range_fixture.h"
#include "hextwist/command/braces.h"
#include "hextwist/command/command_error.h"
#include "hextwist/command/flow.h"
#include "hextwist/command/foreign.h"
#include "hextwist/command/pattern_internal.h"
#include "hextwist/command/reader.h"
#include "hextwist/mesh/association/association.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/mesh/validate/validate.h"
#include "session/sentences.h"
#include "session/session_fixture.h"
#include "support/association_checkers.h"
#include "support/checkers.h"
#include "support/seed.h"

namespace hextwist {
namespace {

unsigned new_seed() {
  const unsigned seed = test::random_seed();
  testing::Test::RecordProperty("seed", static_cast<int>(seed));
  return seed;
}

std::vector<const CommandSpec*> commands() {
  std::vector<const CommandSpec*> result;
  for (const CommandSpec& spec : language())
    if (!spec.syntax.empty()) result.push_back(&spec);
  return result;
}

Command parsed(std::string_view text) {
  const auto statements = split_statements(text);
  if (statements.size() != 1) throw Error("not one statement: " + std::string(text));
  return parse(statements[0]);
}

bool is_kind(std::string_view word) {
  for (int k = 0; k < n_entity_kinds; ++k)
    if (same_word(word, name(static_cast<EntityKind>(k)))) return true;
  return false;
}

bool goes_on_with_a_range(std::string_view word) {
  constexpr std::array words = {"in", "to", "by", "step", "except", "with", "common_to", "expand", "and", "or", "not"};
  return std::ranges::any_of(words, [&](const char* other) { return same_word(word, other); });
}

bool in_full_only(const Pattern& pattern, std::string_view word) {
  return std::ranges::any_of(pattern, [&](const PatternNode& node) {
    return (node.hidden && same_word(node.name, word)) ||
           std::ranges::any_of(node.choices, [&](const Pattern& choice) { return in_full_only(choice, word); });
  });
}

/// Every sentence parses, what is printed is a fixed point, and so are its words cut short.
void check_fixed_points(int n_per_command) {
  const unsigned seed = new_seed();
  test::Sentences sentences(seed);
  for (const CommandSpec* spec : commands())
    for (int i = 0; i < n_per_command; ++i) {
      const std::string text = sentences.sentence(*spec);
      SCOPED_TRACE("seed " + std::to_string(seed) + ": " + text);
      std::string once;
      try {
        once = to_string(parsed(text));
        ASSERT_EQ(to_string(parsed(once)), once);
      } catch (const Error& error) {
        FAIL() << once << "\n" << error.what();
      }
      // Some word of it in other letters; or shorter, which either means the same or is refused.
      const Statement statement = split_statements(text)[0];
      const auto word =
          statement.tokens[static_cast<std::size_t>(sentences.below(static_cast<int>(statement.tokens.size()) - 1))];
      const Command command = parse(statement);
      const bool of_grammar = std::ranges::any_of(
          command.items, [&](const Item& item) { return item.is_word && item.token.offset == word.offset; });
      // Within ranges any word can be a name. Words that are understood in full only begin like others.
      if (!of_grammar || in_full_only(compile_pattern(spec->syntax), word.text)) continue;
      std::string other = text;
      for (std::size_t k = 0; k < word.length; ++k)
        other[word.offset + k] = static_cast<char>(std::toupper(static_cast<unsigned char>(other[word.offset + k])));
      ASSERT_EQ(to_string(parsed(other)), once) << other;
      other.erase(word.offset + 1 + static_cast<std::size_t>(sentences.below(static_cast<int>(word.length))),
                  std::string::npos);
      const std::string cut = other.substr(word.offset);
      // node is another word than nodeset, and what goes on with a range can't be the beginning of an option.
      // So are med and vtk, formats, other ones than medit and vtkhdf.
      if (is_kind(cut) || goes_on_with_a_range(cut) || same_word(cut, "med") || same_word(cut, "vtk")) continue;
      other += text.substr(word.offset + word.length);
      try {
        ASSERT_EQ(to_string(parsed(other)), once) << other;
      } catch (const CommandError& error) {
        ASSERT_GE(error.column(), 1);
      }
    }
}

TEST(Properties, what_is_printed_is_a_fixed_point_for_every_command) {
  check_fixed_points(300);
}
TEST(SlowProperties, what_is_printed_is_a_fixed_point_for_every_command) {
  check_fixed_points(20000);
}

/// What a range chooses, or its error's message.
std::string chosen(const test::RangeFixture& f, DerivedTopology& topology, const std::string& text) {
  const Selector selector{f.meshed, topology, f.groups};
  const Command command = parsed("list " + text);
  const Item& item = *command.find("range");
  std::vector<std::string> notices;
  std::string result;
  try {
    for (const Index i : select(selector, command.statement, item.kind, item.range, notices))
      result += std::to_string(i) + " ";
  } catch (const CommandError& error) {
    EXPECT_GE(error.column(), 1);
    return error.message();
  }
  return result;
}

void check_meaning(int n) {
  const unsigned seed = new_seed();
  test::Sentences sentences(seed);
  sentences.max_id = 8;
  test::RangeFixture f;
  f.groups = {{1, "left", {}}, {4, "rim2", {}}};
  f.groups[0].members[static_cast<int>(EntityKind::curve)] = {{1}, {2}};
  f.groups[1].members[static_cast<int>(EntityKind::hex)] = {{3}, {70}};
  DerivedTopology topology(f.meshed.mesh);
  int n_good = 0;
  for (int i = 0; i < n; ++i) {
    const auto kind = static_cast<EntityKind>(sentences.below(n_entity_kinds));
    const std::string text = std::string(name(kind)) + " " + sentences.range(kind);
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + text);
    const std::string command = to_string(parsed("list " + text));
    const std::string first = chosen(f, topology, text);
    ASSERT_EQ(first, chosen(f, topology, command.substr(5))) << command;
    n_good += !first.empty() && first.find_first_not_of("0123456789 ") == std::string::npos;
  }
  EXPECT_GT(n_good, n / 10);
}

TEST(Properties, a_range_means_the_same_as_what_is_printed_of_it) {
  check_meaning(2000);
}
TEST(SlowProperties, a_range_means_the_same_as_what_is_printed_of_it) {
  check_meaning(100000);
}

/// Everything that a command may change.
struct Snapshot {
  std::shared_ptr<const MeshedModel> kept;
  Mesh mesh;
  Association association;
  const Model* model;

  explicit Snapshot(const Session& session)
      : mesh(session.meshed().mesh), association(session.meshed().association), model(session.meshed().model.get()) {}
  testing::AssertionResult same(const Session& session) const {
    if (session.meshed().model.get() != model) return testing::AssertionFailure() << "another model";
    if (!(session.meshed().mesh == mesh)) return testing::AssertionFailure() << "another mesh";
    return test::same_owners(association, session.meshed().association);
  }
};

testing::AssertionResult promises_kept(const Session& session) {
  const auto& [mesh, model, association] = session.meshed();
  if (mesh.n_hexes() == 0) return testing::AssertionSuccess();
  for (const auto& result :
       {test::conformal(mesh), test::uninverted(mesh), test::sets_valid(mesh),
        test::complete(mesh, association, *model), test::on_model(mesh, association, *model, 1e-7)})
    if (!result) return result;
  for (const Violation& violation : validate(mesh))
    if (!is_warning(violation.kind)) return testing::AssertionFailure() << violation.text;
  const auto wrong = check_association(mesh, association, *model);
  return wrong.empty() ? testing::AssertionSuccess() : testing::AssertionFailure() << wrong.front();
}

/// Values that keep commands small and files in one place.
test::Sentences::ValueText small_values(test::Sentences& sentences, const std::filesystem::path& folder,
                                        const Index& n_hexes) {
  return [&sentences, folder, &n_hexes](const CommandSpec&, const ArgumentSpec& argument) -> std::string {
    const auto upto = [&](int low, int high) { return std::to_string(low + sentences.below(high - low + 1)); };
    for (const std::string_view name : {"n", "n_y", "n_z"})
      if (argument.name == name) return upto(1, 3);
    for (const std::string_view name : {"width", "depth", "height", "radius"})
      if (argument.name == name) return upto(1, 3);
    if (argument.name == "splits") return upto(1, n_hexes < 10 ? 2 : 1);
    if (argument.name == "layers") return upto(0, 1);
    if (argument.name == "sweeps") return upto(0, 4);
    if (argument.name == "steps" || argument.name == "id" || argument.name == "count") return upto(1, 2);
    if (argument.name == "growth") return "1";
    if (argument.name == "limit") return "0.001";
    if (argument.name == "most") return upto(1000, 2000);
    if (argument.name == "gigabytes") return upto(3, 4);
    if (argument.kind == ArgumentSpec::Kind::file) {
      static const std::vector<std::string> files = {"a.msh", "b.e", "c.inp", "d.mesh", "e.vtu", "f.step", "g.brep"};
      return "\"" + (folder / files[static_cast<std::size_t>(sentences.below(7))]).string() + "\"";
    }
    return "";
  };
}

void check_sessions(int n_sessions, int n_commands) {
  const unsigned seed = new_seed();
  test::Sentences sentences(seed);
  sentences.max_id = 4;
  Index n_hexes = 0;
  sentences.value_text = small_values(sentences, test::folder(), n_hexes);
  const std::set<std::string_view> left_out = {"quit", "exit", "playback", "record", "help"};
  std::vector<const CommandSpec*> chosen;
  for (const CommandSpec* spec : commands()) {
    if (left_out.contains(spec->name)) continue;
    for (int weight = spec->name == "refine"                            ? 8
                      : spec->name == "reset" || spec->name == "create" ? 0
                                                                        : 1;
         weight > 0; --weight)
      chosen.push_back(spec);
  }
  int n_done = 0, n_refused = 0;
  for (int i = 0; i < n_sessions; ++i) {
    Session session;
    std::string journal;
    const auto run = [&](const std::string& text) {
      journal += text + "\n";
      test::written("journal.jou", journal);  // what there is to see after a crash
      SCOPED_TRACE("seed " + std::to_string(seed) + "\n" + journal);
      const Snapshot before(session);
      try {
        session.run(text);
        ++n_done;
        ASSERT_TRUE(promises_kept(session));
      } catch (const CommandError& error) {
        ++n_refused;
        ASSERT_GE(error.line(), 1);
        ASSERT_FALSE(error.message().empty());
        ASSERT_TRUE(before.same(session)) << error.what();
      }
    };
    static const std::vector<std::string> starts = {
        "create brick x 2 y 1 interval 3 2 2", "create brick x 1 interval 3",
        "create cylinder radius 1 height 2 interval 1", "create sphere radius 1 interval 1"};
    session.run("set max_hexes 20000; set max_memory 4");
    run(starts[static_cast<std::size_t>(sentences.below(static_cast<int>(starts.size())))]);
    n_hexes = session.meshed().mesh.n_hexes();
    if (sentences.one_in(3)) {  // the same mesh without its CAD
      const std::string file = (test::folder() / "start.msh").string();
      run("export mesh \"" + file + "\" overwrite");
      run("reset");
      run("import mesh \"" + file + "\"");
    }
    run("nodeset 1 surface 1; sideset 2 surface all name \"wall\"; block 2 hex 1 2 3; group left add surface 1; "
        "group rim2 add hex 1");
    for (int k = 0; k < n_commands && !testing::Test::HasFatalFailure(); ++k) {
      const CommandSpec& spec = *chosen[static_cast<std::size_t>(sentences.below(static_cast<int>(chosen.size())))];
      sentences.max_depth = sentences.one_in(2) ? 0 : 2;  // simple ranges choose something more often
      run(sentences.sentence(spec));
      n_hexes = session.meshed().mesh.n_hexes();
      if (n_hexes > 200 || n_hexes == 0) break;
    }
    if (testing::Test::HasFatalFailure()) return;
  }
  Session().run("set max_hexes 0; set max_memory 0");  // they hold for the process
  testing::Test::RecordProperty("commands done", n_done);
  testing::Test::RecordProperty("commands refused", n_refused);
  EXPECT_GT(n_done, (n_done + n_refused) / 5) << "most commands are refused";
}

TEST(Properties, random_commands_on_random_models_keep_every_promise) {
  check_sessions(40, 12);
}
TEST(SlowProperties, random_commands_on_random_models_keep_every_promise) {
  check_sessions(150, 15);
}

/// Every word and sign of the language.
std::vector<std::string> vocabulary() {
  std::set<std::string> words = {
      "to",   "by",      "step",  "all",   "except", "in",   "common_to", "with",
      "at",   "ordinal", "and",   "or",    "not",    "of",   "tolerance", "(",
      ")",    ",",       "<",     "<=",    "<>",     "=",    "*",         "+",
      "-",    "{",       "}",     "{1}",   "#{a=2}", "{a}",  "1",         "2.5",
      "-3",   "1e99",    "\"x\"", "'",     "\"",     ";",    "\n",        "\\",
      "\\\n", "#",       "$",     "a.msh", "\xff",   "\x01", "é",         std::string(1, '\0')};
  const std::function<void(const Pattern&)> collect = [&](const Pattern& pattern) {
    for (const PatternNode& node : pattern) {
      if (node.kind == PatternNode::Kind::word) words.insert(node.name);
      for (const Pattern& choice : node.choices) collect(choice);
    }
  };
  for (const CommandSpec* spec : commands()) collect(compile_pattern(spec->syntax));
  for (const AttributeSpec& spec : attributes()) words.insert(std::string(spec.word));
  return {words.begin(), words.end()};
}

std::string garbage(test::Sentences& sentences, const std::vector<std::string>& words) {
  std::string text;
  const auto specs = commands();
  if (sentences.one_in(2)) {
    text = sentences.sentence(*specs[static_cast<std::size_t>(sentences.below(static_cast<int>(specs.size())))]);
    for (int n = 1 + sentences.below(3); n > 0; --n) {
      const auto at = static_cast<std::size_t>(sentences.below(static_cast<int>(text.size()) + 1));
      switch (sentences.below(4)) {
        case 0:
          text.erase(at, 1 + static_cast<std::size_t>(sentences.below(4)));
          break;
        case 1:
          text.insert(at, 1, static_cast<char>(sentences.below(256)));
          break;
        case 2:
          text.insert(at, " " + words[static_cast<std::size_t>(sentences.below(static_cast<int>(words.size())))] + " ");
          break;
        default:
          text = text.substr(at) + " " + text.substr(0, at);
      }
      if (text.empty()) text = "x";
    }
    return text;
  }
  for (int n = 1 + sentences.below(14); n > 0; --n) {
    text += words[static_cast<std::size_t>(sentences.below(static_cast<int>(words.size())))];
    if (!sentences.one_in(4)) text += ' ';
  }
  return text;
}

void check_garbage(int n) {
  const unsigned seed = new_seed();
  test::Sentences sentences(seed);
  const auto words = vocabulary();
  Session session;
  session.run("create brick x 1 interval 2");
  const MeshedModel* meshed = &session.meshed();
  const Mesh mesh = meshed->mesh;
  int n_wrong = 0;
  for (int i = 0; i < n; ++i) {
    const std::string text = garbage(sentences, words);
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + testing::PrintToString(text));
    completions(text);
    for (const Statement& statement : split_statements(text)) {
      Variables variables;
      std::string once;
      try {
        Statement said = statement;
        if (has_braces(statement)) {
          Expanded expanded = expand(statement, variables);
          if (!expanded.statement) continue;
          said = std::move(*expanded.statement);
        }
        once = to_string(parse(said));
      } catch (const CommandError& error) {
        ++n_wrong;
        ASSERT_GE(error.line(), 1);
        ASSERT_GE(error.column(), 1);
        ASSERT_FALSE(error.message().empty());
        ASSERT_NE(std::string(error.what()).find('^'), std::string::npos);
        if (foreign_line(statement) || flow_of(statement).kind != Flow::none) continue;
        ASSERT_THROW(session.run(text_of(statement)), CommandError);
        ASSERT_EQ(&session.meshed(), meshed);
        continue;
      }
      ASSERT_EQ(to_string(parsed(once)), once);
    }
  }
  EXPECT_TRUE(session.meshed().mesh == mesh);
  EXPECT_GT(n_wrong, n / 2);
}

TEST(Properties, garbage_gets_an_error_with_a_place_and_changes_nothing) {
  check_garbage(8000);
}
TEST(SlowProperties, garbage_gets_an_error_with_a_place_and_changes_nothing) {
  check_garbage(200000);
}

}  // namespace
}  // namespace hextwist
