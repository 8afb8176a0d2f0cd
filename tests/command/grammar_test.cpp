// What commands look like: what is accepted, and where errors point.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <random>

#include "hextwist/command/command_error.h"
#include "hextwist/command/syntax.h"
#include "support/seed.h"

namespace hextwist {
namespace {

Command parsed(std::string_view text) {
  const auto statements = split_statements(text);
  EXPECT_EQ(statements.size(), 1u);
  return parse(statements.at(0));
}

/// The error of a text, or one with an empty message.
CommandError error_of(std::string_view text, std::string_view source = "") {
  try {
    for (const Statement& statement : split_statements(text, source)) parse(statement);
  } catch (const CommandError& error) {
    return error;
  }
  return {"", "", 0, 0};
}

struct Row {
  const char* said;
  const char* means;
};

TEST(Grammar, words_may_be_short_and_in_any_case) {
  for (const auto& [said, means] : std::vector<Row>{
           {"refine curve 3", "refine curve 3"},
           {"REF Cur 3 NUMSPL 2", "refine curve 3 numsplit 2"},
           {"refine vol all depth 1 numsplit 2", "refine volume all depth 1 numsplit 2"},
           {"refine hex 1,2, 3 to 7 by 2", "refine hex 1 2 3 to 7 by 2"},
           {"refine hex 3 to 7 step 2", "refine hex 3 to 7 by 2"},
           {"refine hex 3 to 7 by 1", "refine hex 3 to 7"},
           {"refine hex all exc 3", "refine hex all except 3"},
           {"refine hex in volume 2", "refine hex in volume 2"},
           {"refine node in face in surf 7 curve 1 2", "refine node in face in surface 7 curve 1 2"},
           {"refine surface inlet 3", "refine surface \"inlet\" 3"},
           {"refine surface 'a \"b\"'", "refine surface 'a \"b\"'"},
           {"refine volume all numsplit 1 bias 1.0 depth 1 smooth",
            "refine volume all numsplit 1 bias 1 depth 1 smooth"},
           {"refine hex 1 concave fill dry no_smooth", "refine hex 1 concave fill dry_run no_smooth"},
           {"import mesh part.msh", "import mesh \"part.msh\""},
           {"export gene \"a b.g\" over", "export genesis \"a b.g\" overwrite"},
           {"quality hex all scaled jac", "quality hex all scaled jacobian"},
           {"quality hex all scaled_jacobian", "quality hex all scaled_jacobian"},
           {"quality hex all edge rat low 2 hist", "quality hex all edge ratio low 2 histogram"},
           {"quality hex in volume 1 edge_ratio", "quality hex in volume 1 edge_ratio"},
           {"quality volume 1 volume high -0.5", "quality volume 1 volume high -0.5"},
           {"list", "list"},
           {"list mod", "list model"},
           {"list sheet in hex 3", "list sheet in hex 3"},
           {"create cyl height 2 radius 1 int 3", "create cylinder height 2 radius 1 interval 3"},
           {"set gl on", "set glue on"},
           {"h", "help"},
           {"nodes 3 cur 4", "nodeset 3 curve 4"},
           {"block 1 vol 2 name 'a'", "block 1 volume 2 name \"a\""},
           {"sideset 5 face in surface 6 wrt volume 1", "sideset 5 face in surface 6 wrt volume 1"},
           {"block 1 vol 1 2 hex 5 to 9 volume 4", "block 1 volume 1 2 hex 5 to 9 volume 4"},
           {"sides 3 sur 1 2 fac 7 n 'w'", "sideset 3 surface 1 2 face 7 name \"w\""},
           {"nodeset 2 curve all except 4 vertex 3 curve in surface 1 face 2 name 'n'",
            "nodeset 2 curve all except 4 vertex 3 curve in surface 1 face 2 name \"n\""},
           {"block 1 hex with x_min > 1 vol 2 hex in block 2", "block 1 hex with x_min > 1 volume 2 hex in block 2"},
           {"group \"g\" add surf 1 cur 2 surf 4", "group \"g\" add surface 1 curve 2 surface 4"},
           {"vol 1 smooth scheme mean", "volume 1 smooth scheme mean"},
           {"smo vol 1 sch cond num", "smooth volume 1 scheme condition number"},
           {"block all element type HEX8", "block all element type HEX8"},
           {"exit", "exit"},
       }) {
    EXPECT_EQ(to_string(parsed(said)), means) << said;
    EXPECT_EQ(to_string(parsed(means)), means) << "not a fixed point";
  }
}

TEST(Grammar, a_metric_that_is_a_kind_of_entity_is_not_cut_short_where_the_kind_could_stand) {
  EXPECT_EQ(to_string(parsed("quality hex 9 volum histogram")), "quality hex 9 volume histogram");
  EXPECT_EQ(error_of("quality hex in hex 9 volum histogram").column(), 22);
}

TEST(Grammar, values_arrive_with_their_names) {
  const Command command = parsed("refine curve 3 to 9 by 2 except 5 in surface 1 numsplit 2");
  EXPECT_TRUE(command.has("numsplit"));
  EXPECT_EQ(command.find("splits")->number, 2);
  EXPECT_FALSE(command.has("depth"));
  const Item& item = *command.find("range");
  EXPECT_EQ(item.kind, EntityKind::curve);
  ASSERT_EQ(item.range.items.size(), 1u);
  EXPECT_EQ(item.range.items[0].step, 2);
  ASSERT_EQ(item.range.filters.size(), 2u);
  EXPECT_EQ(item.range.filters[0].kind, RangeFilter::Kind::except);
  EXPECT_EQ(item.range.filters[0].terms.at(0).range.items.at(0).first, 5);
  EXPECT_EQ(item.range.filters[1].kind, RangeFilter::Kind::in);
  EXPECT_EQ(item.range.filters[1].terms.at(0).kind, EntityKind::surface);
}

struct Wrong {
  const char* text;
  int column;
  const char* message;  // part of it
};

TEST(Grammar, errors_point_at_the_wrong_word_and_say_what_could_stand_there) {
  for (const auto& [text, column, message] : std::vector<Wrong>{
           {"foo", 1, "there is no command 'foo'; 'help' lists them"},
           {"refne curve 3", 1, "there is no command 'refne': did you mean refine"},
           {"qualty volume 1", 1, "did you mean quality? 'help' lists all"},
           {"refine crve 3", 8,
            "expected node, edge, face, hex, vertex, curve, surface, volume, location or sheet, found 'crve' (did you "
            "mean "
            "'curve'?)"},
           {"refine", 7, "expected node, edge, face"},
           {"refine curve", 13,
            "expected an id, a name, all, except, in, common_to or with, found the end of the command"},
           {"refine curve ; reset", 13, "expected an id"},
           {"refine hex bogus", 12, "expected an id, all, except, in, common_to or with, found 'bogus'"},
           {"refine hex \"a\"", 12, "found \"a\""},
           {"refine hex 0", 12, "ids start at 1"},
           {"refine hex -3", 12, "ids start at 1"},
           {"refine hex 1.5", 12, "ids are whole numbers"},
           {"refine hex 99999999999999999", 12, "out of range"},
           {"refine hex 1e999", 12, "out of range"},
           {"refine hex 5 to 3", 17, "this range runs backwards: 5 to 3"},
           {"refine hex 5 to", 16, "expected an id"},
           {"refine hex 5 to 9 by 0", 22, "steps start at 1"},
           {"refine hex 5 to 9 by x", 22, "expected a step"},
           {"refine hex 1,", 14, "expected an id"},
           {"refine hex except 3", 12, "'except' needs something to take away from"},
           {"refine hex all except", 22, "expected an id"},
           {"refine hex in", 14,
            "expected node, edge, face, hex, vertex, curve, surface, volume, block, nodeset, sideset, sheet, group or "
            "a name"},
           {"refine hex in volume", 21, "expected an id"},
           {"refine hex with", 16, "expected not, id, x_coord, y_coord, z_coord"},
           {"refine hex with bogus > 3", 17, "volume, quality, element_count or block_assigned, found 'bogus'"},
           {"refine hex with x_cord > 3", 17, "(did you mean 'x_coord'?)"},
           {"refine hex with length > 3", 17, "hexes have no length; they have id, x_coord"},
           {"refine hex with volume > length of surface 3", 26, "surfaces have no length"},
           {"refine hex with x_coord", 17, "'x_coord' is a number: compare it with something (x_coord > ...)"},
           {"refine hex with x_coord + 1", 25, "this is a number; a condition was expected, such as x_coord > 1"},
           {"refine hex with x_coord > block_assigned", 27, "this is true or false; a number was expected"},
           {"refine hex with (x_coord > 1) + 1 > 2", 26, "this is true or false; a number was expected"},
           {"refine hex with x_coord >", 26, "expected id, x_coord"},
           {"refine hex with (x_coord > 3", 29, "expected"},
           {"refine hex with x_coord = 3 tolerance x", 39, "expected a number"},
           {"refine hex with x_coord = 3 tolerance -1", 39, "a tolerance can't be negative"},
           {"refine hex with quality shap2 > 3", 25, "did you mean shape? See 'help refine'"},
           {"refine hex with x", 17, "'x' may be x_coord, x_min or x_max"},
           {"refine hex with name 'a'", 17, "hexes have no name"},
           {"refine curve with name 3", 24, "expected a name in quotes"},
           {"refine curve with length > length of curve all", 44, "expected an id or a name"},
           {"refine hex 3 common_to", 23, "expected node, edge"},
           {"refine hex in surfce 3", 15, "(did you mean 'surface'?)"},
           {"refine hex in (surface 3", 25, "expected"},
           {"refine hex in ()", 16, "expected node, edge"},
           {"refine vertex (at 1 2)", 22, "expected a number"},
           {"refine vertex (at 1 2 3", 24, "expected ordinal or )"},
           {"refine vertex (at 1 2 3 ordinal 0)", 33, "ordinals start at 1"},
           {"refine hex all except surface 2", 23, "only hexes can be taken from a list of hexes"},
           {"refine hex {n}", 12, "expressions in braces need a session that knows their values"},
           {"{n = 3}", 1, "expressions in braces need a session that knows their values"},
           {"refine curve 3 nunsplit 2", 16, "did you mean numsplit? See 'help refine'"},
           {"refine curve 3 numsplit", 24, "expected a whole number, found the end"},
           {"refine curve 3 numsplit x", 25, "expected a whole number, found 'x'"},
           {"refine curve 3 numsplit 0", 25, "numsplit must be a whole number from 1 to 29"},
           {"refine curve 3 numsplit 1.5", 25, "numsplit must be a whole number from 1 to 29"},
           {"refine curve 3 numsplit 1 numsplit 2", 27, "this option was given already"},
           {"refine curve 3 smooth no_smooth", 23, "this option was given already"},
           {"refine curve 3 depth -1", 22, "depth must be a whole number"},
           {"refine curve 3 bias 0.5", 21, "bias must be a number of at least 1"},
           {"refine curve 3 concave", 23, "expected template or fill"},
           {"refine curve 3 s", 16, "'s' may be size, smooth, sizing_function, sum or stop_at"},
           {"refine curve 3 size 0", 21, "size must be a number above 0"},
           {"refine curve 3 size 1e300", 21, "size must be a number above 0, at most 1e+100"},
           {"refine curve 3 size", 20, "expected a number"},
           {"refine curve 3 radius -2", 23, "radius must be a number of at least 0"},
           {"refine curve 3 method fast", 23, "expected auto, single, parallel or combination"},
           {"refine sheet 3", 14, "expected edge, node or intersect"},
           {"refine sheet edge 3 greater_than 1 factor 2", 36, "this option was given already"},
           {"refine hex in field \"error\" over 3", 29, "expected above, below, top or bottom"},
           {"refine hex in field \"error\" top 101 %", 33, "a part of the whole is above 0 and at most 100 %"},
           {"smooth volume", 14, "expected an id"},
           {"smooth volume all scheme fast", 26, "expected mean, condition, laplacian or untangle"},
           {"smooth volume all iterations -1", 30, "iterations must be a whole number"},
           {"volume 1 smooth", 16, "expected scheme"},
           {"volume 1 mesh", 10, "with, smooth, name, move, scale, rotate or reflect, found 'mesh'"},
           {"node 1 position", 16, "expected fixed or free"},
           {"undo 0", 6, "undo must be a whole number"},
           {"redo all", 6, "expected a whole number or the end of the command"},
           {"block volume 1", 7, "expected all or a whole number, found 'volume'"},
           {"block 1 surface 2", 9,
            "expected hex, volume, group, add, remove, name, element or attribute, found 'surface'"},
           {"block 1 volume 2 hax 3", 18, "hex, volume, group, name or the end of the command, found 'hax'"},
           {"block 1 volume 2 v 3", 18, "hex, volume, group, name or the end of the command, found 'v'"},
           {"block 1 volume 2 hex", 21, "expected an id"},
           {"block 1 hex in volume 2 vol 3", 25, "found 'vol'"},
           {"block 1 volume 2 name 'a' hex 3", 27, "expected the end of the command, found 'hex'"},
           {"nodeset 1 curve 1 nod 3", 19, "'nod' may be node or nodeset"},
           {"sideset 1 surface 2 curve 3", 21, "expected"},
           {"group g add curve 1 crve 2", 21, "did you mean curve? See 'help group'"},
           {"block -1 hex 1", 7, "block must be a whole number"},
           {"nodeset 1 node", 15, "expected an id"},
           {"sideset 1 surface 2 wrt surface 1", 25, "expected volume, block or hex"},
           {"delete mesh", 8, "expected block, nodeset, sideset or group"},
           {"record", 7, "expected stop or a file name in quotes"},
           {"set undo maybe", 10, "expected on, off or limit"},
           {"q volume 1", 1, "'q' may be quality or quit"},
           {"quality volume 1 shap all", 23, "this option was given already"},
           {"quality volume 1 surface", 18, "cannot stand here"},
           {"quality volume 1 low", 21, "expected a number"},
           {"quality volume 1 di", 18, "'di' may be diagonal, distortion or dimension"},
           {"import step foo", 13, "expected a file name in quotes, found 'foo'"},
           {"import step \"\"", 13, "this file name is empty"},
           {"import step \"foo", 13, "this quote is not closed"},
           {"import \"foo.step\"", 8, "expected mesh, exodus"},
           {"import mesh \"a.msh\" \"b\"", 21, "expected snap, no_snap, scale or the end of the command, found \"b\""},
           {"reset all", 7, "expected mesh, block, nodeset, sideset or the end of the command, found 'all'"},
           {"create sphere radius 0", 22, "radius must be a number above 0"},
           {"create cylinder radius 1", 25, "expected height"},
           {"set glue maybe", 10, "expected auto, on or off"},
           {"refine hex 1 \\ x", 14, "a backslash must be the last of its line"},
           {"refine hex 1 \x01", 14, "this character has no meaning here"},
       }) {
    const CommandError error = error_of(text);
    EXPECT_EQ(error.column(), column) << text << "\n" << error.what();
    EXPECT_EQ(error.line(), 1) << text;
    EXPECT_NE(error.message().find(message), std::string::npos) << text << "\n" << error.what();
  }
}

TEST(Grammar, the_caret_stands_under_the_word) {
  EXPECT_STREQ(error_of("reset\nrefine crve 3\n", "part.jou").what(),
               "part.jou:2:8: expected node, edge, face, hex, vertex, curve, surface, volume, location or sheet, found "
               "'crve' (did you "
               "mean 'curve'?)\n  refine crve 3\n         ^~~~");
  EXPECT_STREQ(error_of("import\tmésh 3").what(),
               "'mésh' cannot stand here: did you mean mesh? See 'help import'\n  import mésh 3\n         ^~~~");
  // The line of a joined command on which the word stands, not the first.
  EXPECT_STREQ(error_of("refine \\\n  hex x").what(),
               "expected an id, all, except, in, common_to or with, found 'x'\n    hex x\n        ^");
}

TEST(Grammar, a_very_long_line_shows_the_environs_of_the_word) {
  std::string text = "refine hex";
  for (int i = 1; i < 5000; ++i) text += " " + std::to_string(i);
  const CommandError error = error_of(text + " bogus 1 2 3");
  EXPECT_EQ(error.column(), static_cast<int>(text.size()) + 2);
  EXPECT_LT(std::string(error.what()).size(), 600u);
}

TEST(Grammar, ranges_cannot_be_nested_without_end) {
  std::string text = "refine hex in";
  for (int i = 0; i < 100000; ++i) text += " hex in";
  EXPECT_NE(error_of(text).message().find("nested too deeply"), std::string::npos);
}

TEST(Grammar, completion_offers_what_could_stand_there) {
  using List = std::vector<std::string>;
  EXPECT_EQ(completions("re"), (List{"record", "redo", "refine", "reflect", "reset"}));
  EXPECT_EQ(completions("reset; qu"), (List{"quality", "quit"}));
  EXPECT_EQ(completions("refine cu"), (List{"curve"}));
  EXPECT_EQ(completions("refine curve 3 nu"), (List{"numsplit"}));
  EXPECT_EQ(completions("refine curve 3 size 0.5 nu"), List{});
  EXPECT_EQ(completions("refine curve 3 size 0.5 b"), (List{"bias"}));
  EXPECT_EQ(completions("refine curve 3 numsplit 2 siz"), List{});
  EXPECT_EQ(completions("refine curve 3 depth 2 rad"), List{});
  EXPECT_EQ(completions("refine lo"), (List{"location"}));
  EXPECT_EQ(completions("refine curve 3 concave "), (List{"fill", "template"}));
  EXPECT_EQ(completions("refine curve 3 numsplit "), List{});
  EXPECT_EQ(completions("refine bogus 3 "), List{});
  EXPECT_EQ(completions("block 1 volume 2 "),
            (List{"common_to", "except", "group", "hex", "in", "name", "to", "volume", "with"}));
  EXPECT_EQ(completions("sideset 1 surface 2 fac"), (List{"face"}));
  EXPECT_EQ(completions("").size(), completions("  ").size());
  EXPECT_GT(completions("").size(), 10u);
  EXPECT_EQ(completions("import mesh \"a"), List{});
}

TEST(Grammar, every_command_has_help_and_its_examples_parse) {
  for (const CommandSpec& spec : language()) {
    if (spec.syntax.empty()) continue;
    EXPECT_FALSE(spec.summary.empty()) << spec.name;
    EXPECT_FALSE(spec.examples.empty()) << spec.name;
    for (const auto example : spec.examples) EXPECT_EQ(to_string(parsed(example)), example);
    EXPECT_NE(help().find(spec.summary), std::string::npos);
    EXPECT_NE(help(spec.name).find(spec.examples.front()), std::string::npos);
    EXPECT_EQ(help(spec.name).find('~'), std::string::npos) << "shows what is not supported yet";
  }
  EXPECT_NE(help("range").find("except"), std::string::npos);
  EXPECT_NE(help("expressions").find("atan2d"), std::string::npos);
  EXPECT_THROW(help("bogus"), Error);
}

TEST(Grammar, help_is_short_first_and_tells_of_one_option) {
  EXPECT_EQ(help("refine").find("combination technique"), std::string::npos);
  EXPECT_NE(help("refine").find("'help refine all' tells more"), std::string::npos);
  EXPECT_LT(help("refine").size(), 2 * help("refine", "all").size() / 3);
  EXPECT_NE(help("refine").find("location <x> <y> <z>"), std::string::npos);
  const std::string size = help("ref", "size");
  EXPECT_NE(size.find("  size <size>\n"), std::string::npos) << size;
  EXPECT_NE(size.find("wished size of elements at the target"), std::string::npos) << size;
  EXPECT_NE(size.find("'size' cuts until"), std::string::npos) << size;
  EXPECT_NE(size.find("refine curve 3 size 0.5 bias 1.5"), std::string::npos) << size;
  EXPECT_EQ(size.find("refine curve 7 smooth"), std::string::npos) << size;
  EXPECT_NE(help("refine", "direction").find("thickness|layers <n>"), std::string::npos);
  EXPECT_NE(help("refine", "no_smooth").find("no_smooth"), std::string::npos);
  EXPECT_THROW(help("refine", "colour"), Error);
  for (const CommandSpec& spec : language()) {
    if (spec.syntax.empty()) continue;
    EXPECT_FALSE(help(spec.name, "all").empty()) << spec.name;
  }
}

TEST(Grammar, the_manual_has_every_command_and_example) {
  std::ifstream file(std::string(HEXTWIST_SOURCE_DIR) + "/docs/commands.md");
  const std::string manual{std::istreambuf_iterator<char>(file), {}};
  for (const CommandSpec& spec : language()) {
    if (spec.syntax.empty()) continue;
    for (const auto example : spec.examples) {
      EXPECT_NE(manual.find(example), std::string::npos) << example;
    }
    for (const ArgumentSpec& argument : spec.arguments) {
      EXPECT_NE(manual.find("<" + std::string(argument.name) + ">"), std::string::npos) << argument.name;
    }
  }
}

TEST(Grammar, garbage_gives_an_error_with_a_place_or_parses_and_never_crashes) {
  const unsigned seed = test::random_seed();
  RecordProperty("seed", static_cast<int>(seed));
  std::mt19937 random(seed);
  const std::vector<std::string> pieces = {
      "refine", "curve",  "hex",    "3",    "to",    "by",       "all",   "except", "in",
      "volume", "\"x\"",  "'",      "\"",   ",",     "numsplit", "depth", "-1",     "1e9",
      "0",      "{",      "}",      "(",    ")",     "\\",       "\\\n",  "\n",     ";",
      "#",      "\t",     "import", "mesh", "a.msh", "quality",  "list",  "set",    "glue",
      "help",   "create", "brick",  "x",    "\xff",  "\x01",     "é",     "<=",     std::string(1, '\0')};
  int n_errors = 0;
  for (int run = 0; run < 20000; ++run) {
    std::string text;
    const int n = 1 + static_cast<int>(random() % 12);
    for (int i = 0; i < n; ++i) {
      if (random() % 8 == 0)
        text += static_cast<char>(random() % 256);
      else
        text += pieces[random() % pieces.size()];
      if (random() % 4) text += ' ';
    }
    for (const Statement& statement : split_statements(text)) {
      try {
        const std::string once = to_string(parse(statement));
        EXPECT_EQ(to_string(parsed(once)), once) << "seed " << seed;
      } catch (const CommandError& error) {
        ++n_errors;
        EXPECT_GE(error.column(), 1) << "seed " << seed;
        EXPECT_GE(error.line(), 1) << "seed " << seed;
        EXPECT_FALSE(error.message().empty());
      }
    }
    completions(text);
  }
  EXPECT_GT(n_errors, 1000);
}

}  // namespace
}  // namespace hextwist
