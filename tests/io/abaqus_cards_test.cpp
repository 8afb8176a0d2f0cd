// What cards of an Abaqus file say of the mesh goes where the mesh goes: names, numbers, systems of coordinates.
#include "hextwist/mesh/others.h"
#include "io/io_support.h"

namespace hextwist {
namespace {

constexpr const char* bar =
    "*NODE\n1, 0,0,0\n2, 1,0,0\n3, 2,0,0\n4, 0,1,0\n5, 1,1,0\n6, 2,1,0\n7, 0,0,1\n8, 1,0,1\n9, 2,0,1\n10, 0,1,1\n"
    "11, 1,1,1\n12, 2,1,1\n*ELEMENT, TYPE=C3D8, ELSET=\"all of it\"\n1, 1,2,5,4,7,8,11,10\n2, 2,3,6,5,8,9,12,11\n"
    "*NSET, NSET=\"fix left\"\n1, 4\n*SURFACE, NAME=\"top face\"\n\"all of it\", S2\n*SURFACE, NAME=\"low face\"\n"
    "\"all of it\", S1\n";

MeshFile read_text(const std::string& text) {
  return read_mesh(test::write_text(test::output_folder() / "a.inp", text));
}
/// The cards as they are written with this mesh, behind its sets.
std::string written(const MeshFile& file, const Mesh& mesh, std::vector<std::string>* notices = nullptr) {
  WriteOptions options;
  options.extras = &file.extras;
  options.overwrite = true;
  const auto there = test::output_folder() / "b.inp";
  const auto said = write_mesh(there, mesh, nullptr, options);
  if (notices) *notices = said;
  const std::string text = test::text_of(there);
  const std::string mark = "** hextwist sideset 2";
  const std::size_t begin = text.find('*', text.find("*SURFACE", text.find(mark)) + 1);
  return begin == std::string::npos ? text : text.substr(begin, text.rfind("** hextwist end") - begin);
}

TEST(AbaqusCards, names_of_sets_follow_in_all_cards_that_have_them) {
  const std::array<const char*, 3> names = {"\"fix left\"", "\"top face\"", "\"all of it\""},
                                   now = {"fix_left", "top_face", "all_of_it"};
  // N, S, E: a node set, a surface, elements.
  for (const std::string card : {"*KINEMATIC COUPLING, REF NODE=3\nN, 1, 3",
                                 "*DISTRIBUTING COUPLING, ELSET=E\nN, 1.",
                                 "*EMBEDDED ELEMENT, HOST ELSET=E\nE, E",
                                 "*CONTACT PAIR, INTERACTION=I, ADJUST=N\nS, S",
                                 "*CLEARANCE, MASTER=S, SLAVE=S, VALUE=0.1",
                                 "*CONTACT PROPERTY ASSIGNMENT\nS, S, I\n, , I",
                                 "*SURFACE PROPERTY ASSIGNMENT, PROPERTY=THICKNESS\nS, 0.5",
                                 "*CONTACT INITIALIZATION ASSIGNMENT\nS, S, I",
                                 "*INITIAL CONDITIONS, TYPE=CONTACT\nS, S",
                                 "*INITIAL CONDITIONS, TYPE=STRESS\nE, 1., 2.",
                                 "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nN, 20.",
                                 "*SHELL TO SOLID COUPLING, CONSTRAINT NAME=C\nS, S",
                                 "*MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE\nS, S",
                                 "*MODEL CHANGE, TYPE=ELEMENT, REMOVE\nE",
                                 "*SUBMODEL\nN, N",
                                 "*SUBMODEL, TYPE=SURFACE\nS",
                                 "*CONTACT CONTROLS, MASTER=S, SLAVE=S",
                                 "*CONTACT PRINT, MASTER=S, SLAVE=S",
                                 "*CONTACT OUTPUT, NSET=N",
                                 "*CONTACT INTERFERENCE\nS, S, 0.1",
                                 "*RETAINED NODAL DOFS\nN, 1, 3",
                                 "*DESIGN VARIABLES, TYPE=COORDINATE\nN",
                                 "*MASS FLOW\nE, M1, 0.1",
                                 "*MASS ADJUST\nE, 3.",
                                 "*MONITOR, DOF=1, NODE=N",
                                 "*TIE, NAME=T, TIED NSET=N\nS, S",
                                 "*RELEASE\nE, S1, M1"}) {
    const auto with = [&](const std::array<const char*, 3>& called) {
      std::string text;
      for (std::size_t i = 0; i < card.size(); ++i) {
        const bool is_word = (i == 0 || !std::isalnum(static_cast<unsigned char>(card[i - 1]))) &&
                             (i + 1 == card.size() || !std::isalnum(static_cast<unsigned char>(card[i + 1])));
        const auto which = std::string_view("NSE").find(card[i]);
        const bool is_label = i + 1 < card.size() && card[i + 1] == '1';  // S1 of a release
        text += is_word && !is_label && which != std::string_view::npos ? called[which] : std::string(1, card[i]);
      }
      return text + "\n";
    };
    SCOPED_TRACE(card);
    const MeshFile read = read_text(bar + with(names));
    const std::string face_load = card.starts_with("*MASS FLOW") ? "all_of_it_S1_E1" : now[2];
    const std::string text = written(read, read.mesh), expected = with({now[0], now[1], face_load.c_str()});
    EXPECT_EQ(text.substr(text.size() - std::min(text.size(), expected.size())), expected);
    // What is about nothing any more is not there.
    Mesh less = read.mesh;
    less.blocks.clear();
    less.node_sets.clear();
    less.side_sets.clear();
    std::vector<std::string> notices;
    const std::string rest = written(read, less, &notices);
    for (const char* name : names) EXPECT_EQ(rest.find(name), std::string::npos) << rest;
    for (const char* name : now) EXPECT_EQ(rest.find(name), std::string::npos) << rest;
    EXPECT_TRUE(std::ranges::any_of(
        notices, [](const std::string& said) { return said.find("left out: what") != std::string::npos; }));
  }
}

TEST(AbaqusCards, numbers_that_are_no_nodes_stay) {
  const std::string card = "*CONTACT PAIR, INTERACTION=I, ADJUST=1\ntop_face, low_face\n";
  const MeshFile read = read_text(bar + card);
  EXPECT_EQ(read.extras.cards.at(0).references.size(), 0u);
}

TEST(AbaqusCards, numbers_are_those_of_the_file) {
  const MeshFile read = read_text(std::string(bar) + "*BOUNDARY\n3, 1, 3\n12, 2, 2\n*DLOAD\n2, GRAV, 9.8, 0, 0, -1\n");
  Mesh mesh = read.mesh;
  mesh.node_ids = {2, 3, 12};
  for (Index n = 3; n < mesh.n_nodes(); ++n) mesh.node_ids.push_back(2'000'000'000 + n);  // so nodes count from 1
  EXPECT_EQ(written(read, mesh), "*BOUNDARY\n2, 1, 3\n3, 2, 2\n*DLOAD\n2, GRAV, 9.8, 0, 0, -1\n");
}

std::string in_instances(const std::string& cards, const std::string& of_second = "") {
  return "*PART, NAME=P\n" + std::string(bar) + cards +
         "*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=I1, PART=P\n*END INSTANCE\n*INSTANCE, NAME=I2, PART=P\n" +
         of_second + "*END INSTANCE\n*END ASSEMBLY\n";
}
std::string cards_of(const MeshFile& file) {
  std::string text;
  for (const AbaqusCard& card : file.extras.cards) text += card.text;
  return text;
}

TEST(AbaqusCards, of_a_part_are_of_each_instance) {
  const MeshFile read =
      read_text(in_instances("*SOLID SECTION, ELSET=\"all of it\", MATERIAL=M\n,\n*HOURGLASS STIFFNESS\n5.\n*KINEMATIC "
                             "COUPLING, REF NODE=3\n4, 1, "
                             "3\n*COUPLING, CONSTRAINT NAME=C, REF NODE=3, SURFACE=\"top face\"\n*KINEMATIC\n1, 3\n",
                             "0., 0., 5.\n"));
  EXPECT_EQ(written(read, read.mesh).substr(written(read, read.mesh).find("*SOLID")),
            "*SOLID SECTION, ELSET=I1_all_of_it, MATERIAL=M\n,\n*HOURGLASS STIFFNESS\n5.\n"
            "*KINEMATIC COUPLING, REF NODE=3\n4, 1, 3\n"
            "*COUPLING, CONSTRAINT NAME=C, REF NODE=3, SURFACE=I1_top_face\n*KINEMATIC\n1, 3\n"
            "*SOLID SECTION, ELSET=I2_all_of_it, MATERIAL=M\n,\n*HOURGLASS STIFFNESS\n5.\n"
            "*KINEMATIC COUPLING, REF NODE=15\n16, 1, 3\n"
            "*COUPLING, CONSTRAINT NAME=C, REF NODE=15, SURFACE=I2_top_face\n*KINEMATIC\n1, 3\n");
}

TEST(AbaqusCards, systems_of_a_part_stand_where_the_instance_does) {
  const std::string cards =
      "*ORIENTATION, NAME=Ori-1\n1., 0., 0., 0., 1., 0.\n3, 20.\n*ORIENTATION, NAME=Axis, SYSTEM=CYLINDRICAL\n"
      "0., 0., 0., 0., 0., 1.\n*SOLID SECTION, ELSET=\"all of it\", ORIENTATION=ori-1, MATERIAL=M\n,\n"
      "*TRANSFORM, NSET=\"fix left\", TYPE=R\n1., 0., 0., 0., 1., 0.\n";
  // Without a turn there is one of each that says the same.
  const std::string moved = cards_of(read_text(in_instances(cards, "0., 0., 5.\n")));
  EXPECT_EQ(moved,
            "*ORIENTATION, NAME=Ori-1\n1., 0., 0., 0., 1., 0.\n3, 20.\n*ORIENTATION, NAME=Axis, SYSTEM=CYLINDRICAL\n"
            "0., 0., 0., 0., 0., 1.\n*SOLID SECTION, ELSET=\"all of it\", ORIENTATION=ori-1, MATERIAL=M\n,\n"
            "*TRANSFORM, NSET=\"fix left\", TYPE=R\n1., 0., 0., 0., 1., 0.\n"
            "*ORIENTATION, NAME=I2_AXIS, SYSTEM=CYLINDRICAL\n0, 0, 5, 0, 0, 6\n"
            "*SOLID SECTION, ELSET=\"all of it\", ORIENTATION=ori-1, MATERIAL=M\n,\n"
            "*TRANSFORM, NSET=\"fix left\", TYPE=R\n1., 0., 0., 0., 1., 0.\n");
  const MeshFile turned =
      read_text(in_instances(cards + "*BEAM SECTION, ELSET=\"all of it\", MATERIAL=M\n1., 1.\n0., 0., -1.\n",
                             "2., 0., 0.\n2., 0., 0., 2., 0., 1., 90.\n"));
  const std::string text = cards_of(turned);
  for (const char* card :
       {"*ORIENTATION, NAME=I2_ORI-1\n0, 1, 0, -1, 0, 0\n3, 20.\n",
        "*ORIENTATION, NAME=I2_AXIS, SYSTEM=CYLINDRICAL\n2, 0, 0, 2, 0, 1\n", "ORIENTATION=I2_ORI-1, MATERIAL=M",
        "*TRANSFORM, NSET=\"fix left\", TYPE=R\n0, 1, 0, -1, 0, 0\n"})
    EXPECT_NE(text.find(card), std::string::npos) << card << "in\n" << text;
  EXPECT_TRUE(std::ranges::any_of(turned.notices, [](const std::string& said) {
    return said.ends_with("*BEAM SECTION has directions of the part: they do not turn with instance 'I2'");
  }));
}

TEST(AbaqusCards, two_parts_may_call_a_system_alike) {
  const auto part = [](const std::string& name, const std::string& axes) {
    return "*PART, NAME=" + name + "\n" + bar + "*ORIENTATION, NAME=Ori-1\n" + axes +
           "\n*SHELL SECTION, COMPOSITE, ELSET=\"all of it\"\n0.1, 3, M, Ori-1\n*END PART\n";
  };
  const std::string text =
      cards_of(read_text(part("A", "1., 0., 0., 0., 1., 0.") + part("B", "0., 1., 0., 1., 0., 0.") +
                         "*ASSEMBLY, NAME=A\n*INSTANCE, NAME=a, PART=A\n*END INSTANCE\n*INSTANCE, NAME=b, PART=B\n"
                         "*END INSTANCE\n*END ASSEMBLY\n"));
  EXPECT_EQ(text,
            "*ORIENTATION, NAME=Ori-1\n1., 0., 0., 0., 1., 0.\n"
            "*SHELL SECTION, COMPOSITE, ELSET=\"all of it\"\n0.1, 3, M, Ori-1\n"
            "*ORIENTATION, NAME=b_ORI-1\n0., 1., 0., 1., 0., 0.\n"
            "*SHELL SECTION, COMPOSITE, ELSET=\"all of it\"\n0.1, 3, M, b_ORI-1\n");
}

TEST(AbaqusCards, what_is_said_of_edges_and_ends_keeps_elements_whole) {
  const std::string shells =
      std::string(bar) +
      "*ELEMENT, TYPE=S4, ELSET=SHX\n11, 1,2,5,4\n12, 2,3,6,5\n*ELEMENT, TYPE=B31, ELSET=BM\n21, 1,2\n"
      "22, 2,3\n";
  const auto rigid = [&](const std::string& cards) {
    const auto others = read_text(shells + cards).mesh.others;
    std::vector<int> result;
    for (Index e = 0; e < others->size(); ++e)
      if (!others->heads->is_rigid.empty() && others->heads->is_rigid[others->of[e]])
        result.push_back(static_cast<int>(others->heads->ids[others->of[e]]));
    return result;
  };
  EXPECT_EQ(rigid("*DLOAD\nSHX, P, 5.\nBM, PX, 1.\n"), std::vector<int>{});
  EXPECT_EQ(rigid("*DLOAD\nSHX, EDNOR2, 5.\n"), (std::vector<int>{11, 12}));
  EXPECT_EQ(rigid("*DLOAD\n12, EDSHR1, 5.\n"), std::vector<int>{12});
  EXPECT_EQ(rigid("*RELEASE\n21, S1, M1\n"), std::vector<int>{21});
  EXPECT_EQ(rigid("*RELEASE\nBM, S1, M1-M2\n"), (std::vector<int>{21, 22}));
}

TEST(AbaqusCards, what_does_not_follow_is_said) {
  for (const auto& [card, said] :
       {std::pair(
            "*SOLID SECTION, ELSET=\"all of it\", COMPOSITE, STACK DIRECTION=3\n0.1, 3, M\n",
            "*SOLID SECTION has layers along a direction of the elements; that of hexes that a refinement makes may "
            "be another one"),
        {"*ORIENTATION, NAME=O, DEFINITION=OFFSET TO NODES\n1, 2, 4\n",
         "*ORIENTATION counts from nodes of the elements; those of hexes that a refinement makes may be others"},
        {"*INITIAL CONDITIONS, TYPE=STRESS, INPUT=s.dat\n",
         "*INITIAL CONDITIONS reads S.DAT, which is not read here: numbers of nodes and elements in it stay as they "
         "are"}}) {
    const MeshFile read = read_text(bar + std::string(card));
    ASSERT_FALSE(read.notices.empty()) << card;
    EXPECT_TRUE(read.notices[0].ends_with(said)) << read.notices[0];
  }
  for (const char* card : {"*NSET, NSET=a, INPUT=f\n", "*ELSET, ELSET=a, INPUT=f\n", "*SURFACE, NAME=a, INPUT=f\n"}) {
    const auto file = test::write_text(test::output_folder() / "c.inp", bar + std::string(card));
    EXPECT_TRUE(test::refusal(file).ends_with("with INPUT= is not supported")) << test::refusal(file);
  }
}

TEST(AbaqusCards, loads_on_faces_of_all_kinds_are_on_side_sets) {
  for (const auto& [card, label] : {std::pair("*DLOAD", "P2"),
                                    {"*DLOAD", "P2NU"},
                                    {"*DLOAD", "HP2"},
                                    {"*DLOAD", "TRVEC2"},
                                    {"*DLOAD", "TRSHR2NU"},
                                    {"*DFLUX", "S2"},
                                    {"*FILM", "F2FC"},
                                    {"*RADIATE", "R2CR"},
                                    {"*FOUNDATION", "F2"},
                                    {"*MASSFLOW", "M2"},
                                    {"*BOUNDARYF", "F2"},
                                    {"*FLOW", "Q2"},
                                    {"*DECURRENT", "CS2"}}) {
    SCOPED_TRACE(label);
    const MeshFile read = read_text(bar + std::string(card) + "\n\"all of it\", " + label + ", 5.\n");
    const auto set = std::ranges::find(read.mesh.side_sets, "all of it_S2", &SideSet::name);
    ASSERT_NE(set, read.mesh.side_sets.end());
    EXPECT_EQ(set->sides.size(), 2u);
    const std::string text = written(read, read.mesh);
    EXPECT_TRUE(text.ends_with(std::string(card) + "\nall_of_it_S2_E2, " + label + ", 5.\n")) << text;
  }
}

TEST(AbaqusCards, edges_of_shells_keep_them_whole_with_CalculiX_too) {
  const std::string shells = std::string(bar) + "*ELEMENT, TYPE=S4, ELSET=SHX\n11, 1,2,5,4\n12, 2,3,6,5\n";
  const auto n_rigid = [&](const std::string& cards) {
    const auto others = read_text(shells + cards).mesh.others;
    return std::ranges::count(others->heads->is_rigid, 1);
  };
  EXPECT_EQ(n_rigid("*FILM\nSHX, F1, 20., 5.\n*DLOAD\nSHX, P2, 5.\n*SURFACE, NAME=e\nSHX, SPOS\n11, S1\n"), 0);
  EXPECT_EQ(n_rigid("*FILM\nSHX, F3, 20., 5.\n"), 2);
  EXPECT_EQ(n_rigid("*DFLUX\n11, S6, 20.\n"), 1);
  EXPECT_EQ(n_rigid("*SURFACE, NAME=e\n11, S3\n"), 1);
}

TEST(AbaqusCards, empty_lines_are_data_lines) {
  const std::string cards = "*SPRING, ELSET=\"all of it\"\n\n100.\n*STEP\n*STATIC\n\n*END STEP\n";
  const MeshFile read = read_text(bar + cards + "\n\n");
  EXPECT_EQ(cards_of(read), cards);
}

TEST(AbaqusCards, areas_of_nodes_and_ends_of_networks_are_told) {
  const MeshFile read = read_text(std::string(bar) +
                                  "*SURFACE, TYPE=NODE, NAME=N\n1, 0.25\n2, 1.\n*ELEMENT, TYPE=D\n"
                                  "31, 0, 1, 2\n");
  const auto has = [&](const std::string& end) {
    return std::ranges::any_of(read.notices, [&](const std::string& said) { return said.ends_with(end); });
  };
  EXPECT_TRUE(has("areas of the nodes of surface 'N' are left out: they are 1 in a file of ours"));
  EXPECT_TRUE(has("dropped 1 element of type D, which leaves a node out"));
}

}  // namespace
}  // namespace hextwist
