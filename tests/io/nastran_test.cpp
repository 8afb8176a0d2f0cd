// Nastran: what is told or refused because it would change what the file says.
#include "io/io_support.h"

namespace hextwist {
namespace {

/// Node n has these fields behind its coordinates.
std::string nastran_cube(const std::map<int, std::string>& behind = {}, const std::string& system = "") {
  std::string text;
  for (int n = 1; n <= 8; ++n) {
    const std::array<const char*, 8> at = {"0.,0.,0.", "1.,0.,0.", "1.,1.,0.", "0.,1.,0.",
                                           "0.,0.,1.", "1.,0.,1.", "1.,1.,1.", "0.,1.,1."};
    text += "GRID," + std::to_string(n) + "," + system + "," + at[static_cast<std::size_t>(n - 1)];
    if (behind.contains(n)) text += "," + behind.at(n);
    text += "\n";
  }
  return text;
}
const std::string nastran_hex = "CHEXA,1,1,1,2,3,4,5,6\n,7,8\n", ended = "ENDDATA\n";

std::vector<std::string> notices_of(const std::string& text) {
  const MeshFile read = read_mesh(test::write_text(test::output_folder() / "a.bdf", text));
  EXPECT_EQ(read.mesh.n_hexes(), 1);
  EXPECT_DOUBLE_EQ(volume(read.mesh), 1);
  return read.notices;
}
using Lines = std::vector<std::string>;

TEST(nastran_files, what_grid_cards_say_of_constraints_is_told) {
  EXPECT_EQ(notices_of(nastran_cube() + nastran_hex + ended), Lines());
  EXPECT_EQ(notices_of(nastran_cube({{2, "0,0,0"}}) + nastran_hex + ended), Lines());
  EXPECT_EQ(notices_of(nastran_cube({{3, "5"}, {4, ",123456"}, {7, "5,12"}, {8, ",,9"}}) + nastran_hex + ended),
            (Lines{"coordinate systems of displacements (CD) of 2 nodes left out; the first is 3",
                   "constraints (PS) of 2 nodes left out; the first is 4",
                   "superelements (SEID) of 1 node left out; the first is 8"}));
  // Those of GRDSET are of all that say nothing.
  EXPECT_EQ(notices_of(nastran_cube({{2, "5,0"}, {3, "0,12"}}) + nastran_hex + "GRDSET,,,,,,5,246\n" + ended),
            (Lines{"coordinate systems of displacements (CD) of 7 nodes left out; the first is 1",
                   "constraints (PS) of 7 nodes left out; the first is 1"}));
  EXPECT_EQ(notices_of("GRDSET,,0\n" + nastran_cube() + nastran_hex + ended), Lines());
}

TEST(nastran_files, systems_of_grdset_are_refused_as_those_of_grid) {
  const auto folder = test::output_folder();
  const auto says = [&](const std::string& text, const std::string& expected) {
    const auto file = test::write_text(folder / "a.bdf", text);
    EXPECT_EQ(test::refusal(file), file.string() + expected);
  };
  says("GRDSET,,5\n" + nastran_cube() + nastran_hex + ended,
       ":2: node 1 is in coordinate system 5 by GRDSET; only the basic one (0) is read");
  says("GRDSET                 5\n" + nastran_cube({}, "0") + "GRID,9,,0.,0.,0.\n" + nastran_hex + ended,
       ":10: node 9 is in coordinate system 5 by GRDSET; only the basic one (0) is read");
  says(nastran_cube() + nastran_hex + "GRDSET,,5\n" + ended,
       ":1: node 1 is in coordinate system 5 by GRDSET; only the basic one (0) is read");
  says("GRDSET,,x\n" + nastran_cube() + nastran_hex + ended,
       ":1: GRDSET has 'x' where a coordinate system should stand");
  EXPECT_EQ(notices_of("GRDSET,,5\n" + nastran_cube({}, "0") + nastran_hex + ended), Lines());
}

TEST(nastran_files, pressures_and_materials_that_become_others_are_told) {
  const std::string start = nastran_cube() + nastran_hex;
  EXPECT_EQ(notices_of(start + "PLOAD4,11,1,1.0,,,,5,7\nPLOAD4,12,1,1.,1.0,1.,1.,5,7\nPSOLID,1,1\n" + ended), Lines());
  const std::string kept = " with another pressure than 1 all over: the sides are kept, not the pressure (the first: ";
  EXPECT_EQ(notices_of(start + "PLOAD4,10,1,1.,,,,5,7\nPLOAD4,11,1,250.,,,,5,7\n" + ended),
            (Lines{"1 PLOAD4" + kept + "set 11, element 1, '250.')"}));
  EXPECT_EQ(notices_of(start + "PLOAD4,11,1,1.,2.,,,5,7\nPLOAD4,11,1,1.,,,,1,3\n,0,1.,0.,0.\n" + ended),
            (Lines{"2 PLOAD4s" + kept + "set 11, element 1, '1.')"}));
  const std::string alone = " with another material than 1, or more: the properties are kept alone (the first: ";
  EXPECT_EQ(notices_of(start + "PSOLID,1,4\n" + ended), (Lines{"1 PSOLID" + alone + "1)"}));
  EXPECT_EQ(notices_of(start + "PSOLID,1,1,,3\n" + ended), (Lines{"1 PSOLID" + alone + "1)"}));
  // What is written says nothing of the kind.
  Mesh mesh = test::grid(1, 1, 1);
  mesh.side_sets = {{3, "s", {{0, 1}}}};
  const auto file = test::output_folder() / "b.bdf";
  write_mesh(file, mesh, nullptr);
  EXPECT_EQ(read_mesh(file).notices, Lines());
}

TEST(nastran_files, executive_and_case_control_are_told) {
  EXPECT_EQ(notices_of("$ of somebody\nSOL 101\nCEND\n\nSUBCASE 1\n  LOAD = 11\nBEGIN BULK\n" + nastran_cube() +
                       nastran_hex + ended),
            (Lines{"4 lines of executive and case control left out (the first: 'SOL 101')"}));
}

TEST(nastran_files, comments_between_continuations_are_no_continuations) {
  const auto folder = test::output_folder();
  for (const std::string comment : {"    $ indented\n", "$ at the margin\n", "\t$ behind a tab\n", "        $\n"}) {
    const std::string text = nastran_cube() + "CHEXA,1,1,1,2,3,4,5,6\n" + comment + ",7,8\nSET1,7,1,2,3,4,5,6,7,\n" +
                             comment + ",8\nSET1    8       1       2       3\n" + comment + ended;
    const MeshFile read = read_mesh(test::write_text(folder / "a.bdf", text));
    EXPECT_DOUBLE_EQ(volume(read.mesh), 1);
    EXPECT_EQ(read.mesh.node_sets, (std::vector<NodeSet>{{7, "", {0, 1, 2, 3, 4, 5, 6, 7}}, {8, "", {0, 1, 2}}}));
    EXPECT_EQ(read.notices, Lines());
  }
  // Middle nodes in their places.
  Mesh mesh = test::grid(1, 1, 1);
  WriteOptions options;
  options.order = 2;
  write_mesh(folder / "b.bdf", mesh, nullptr, options);
  std::string text = test::text_of(folder / "b.bdf");
  text.insert(text.rfind("+    "), "       $ comment\n");
  EXPECT_EQ(read_mesh(test::write_text(folder / "c.bdf", text)).middles.edges,
            read_mesh(folder / "b.bdf").middles.edges);
}

TEST(nastran_files, what_stands_behind_the_last_free_field_is_told) {
  const auto folder = test::output_folder();
  const std::string start = nastran_cube() + nastran_hex;
  const auto told = [&](const std::string& text) {
    Lines notices = notices_of(start + text + ended);
    for (std::string& line : notices) line.erase(0, (folder / "a.bdf").string().size());
    return notices;
  };
  const std::string why = " behind its last field, where the mark of a continuation stands, and none follows: left out";
  EXPECT_EQ(told("SET1,5,1,2,3,4,5,6,7,8\n"), (Lines{":11: SET1 has '8'" + why}));
  EXPECT_EQ(told("SET1,5,1,2,3,4,5,6,7,8\nSET1,6,1,2,3,4,5,6,7,,9\n"),
            (Lines{":11: SET1 has '8'" + why + " (the first of 2 such cards)"}));
  EXPECT_EQ(told("SET1,5,1,2,3,4,5,6,7,+\n+,8\nSET1,6,1,2,3,4,5,6,7,8\n,8\nSET1,7,1,2,3,4,5,6,7,+A\n"), Lines());
}

TEST(listed_files, begin_with_a_byte_order_mark_as_without) {
  const auto folder = test::output_folder();
  const Mesh mesh = test::tidy_mesh(1, true);
  for (const std::string name : {"a.bdf", "a.unv", "a.k", "a.cdb"}) {
    SCOPED_TRACE(name);
    write_mesh(folder / name, mesh, nullptr);
    std::string text = test::text_of(folder / name);
    if (name == "a.bdf") text.erase(0, text.find("BEGIN BULK\n") + 11);  // a card stands first
    const Mesh expected = read_mesh(test::write_text(folder / ("b" + name), text)).mesh;
    const MeshFile read = read_mesh(test::write_text(folder / ("c" + name), "\xEF\xBB\xBF" + text));
    EXPECT_TRUE(test::same_mesh(read.mesh, expected));
  }
  const std::string text = "\xEF\xBB\xBF" + nastran_cube() + nastran_hex + ended;
  EXPECT_DOUBLE_EQ(volume(read_mesh(test::write_text(folder / "d.bdf", text)).mesh), 1);
}

TEST(nastran_files, connectors_go_with_their_nodes_where_these_count_anew) {
  const std::string connectors =
      "GRID,500,,0.5,0.5,2.\nGRID,501,,0.5,3.,2.\nRBE2,60,500,123,2,6\nCBUSH,61,3,8,500,501\nCBUSH,62,3,8,500,1.,0.,0."
      "\n"
      "CELAS2,63,100.,7,1,500,1\n";
  const auto file =
      test::write_text(test::output_folder() / "a.bdf", nastran_cube() + connectors + nastran_hex + ended);
  MeshFile read = read_mesh(file);
  EXPECT_EQ(read.notices, (Lines{"1 RBE2 with nodes named one by one: those that a refinement adds are not among them "
                                 "(the first: 60)"}));
  read.mesh.node_ids = {1, 2, 3, 4, 5, 6, 7, 8, 500, 1'000'000'000};
  const auto out = test::output_folder() / "b.bdf";
  EXPECT_EQ(write_mesh(out, read.mesh, nullptr, {.extras = &read.extras}).at(0),
            "node id 1000000000 has more than eight digits: nodes are counted from 1 in the file");
  const std::string text = test::text_of(out);
  for (const char* card : {"RBE2          60       9     123       2       6\n",
                           "CBUSH         61       3       8       9     501\n",  // that node is not there any more
                           "CBUSH         62       3       8       9      1.      0.      0.\n",
                           "CELAS2        63    100.       7       1       9       1\n"})
    EXPECT_NE(text.find(card), std::string::npos) << card << text;
}

TEST(nastran_files, angles_of_materials_that_count_from_an_edge_are_told) {
  for (const auto& [angle, is_told] :
       {std::pair("", false), {"0.", false}, {"7", false}, {"45.", true}, {"-30.0", true}})
    EXPECT_EQ(
        notices_of(nastran_cube() + nastran_hex + "CQUAD4,2,2,1,2,3,4," + angle + "\n" + ended),
        is_told ? Lines{"1 material angle counted from the first edge, which is another one in pieces of a transition "
                        "(the first: CQUAD4 2)"}
                : Lines())
        << angle;
}

}  // namespace
}  // namespace hextwist
