// draw: pictures and pages.
#include <gtest/gtest.h>
#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <set>

#include "hextwist/session/view/page.h"
#include "hextwist/session/view/picture.h"
#include "hextwist/session/view/text.h"
#include "session/session_fixture.h"

namespace hextwist {

using test::Fixture, test::folder, test::written;

namespace {

std::string content(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

struct Pixels {
  int width = 0, height = 0;
  std::vector<Colour> colours;
  const Colour& at(int x, int y) const { return colours.at(static_cast<std::size_t>(y) * width + x); }
  std::ptrdiff_t n_drawn() const {
    return std::ranges::count_if(colours, [](const Colour& c) { return c != Colour{255, 255, 255}; });
  }
};

Pixels decoded(const std::string& file) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_TRUE(png_image_begin_read_from_memory(&image, file.data(), file.size())) << image.message;
  EXPECT_EQ(image.format, static_cast<png_uint_32>(PNG_FORMAT_RGB));
  image.format = PNG_FORMAT_RGB;
  Pixels result{static_cast<int>(image.width), static_cast<int>(image.height), {}};
  result.colours.resize(static_cast<std::size_t>(result.width) * result.height);
  EXPECT_TRUE(png_image_finish_read(&image, nullptr, result.colours.data(), 0, nullptr)) << image.message;
  return result;
}

Pixels drawn(Fixture& f, const std::string& command) {
  const auto file = folder() / "a.png";
  f.session.run("draw " + command + " to '" + file.string() + "' overwrite");
  return decoded(content(file));
}

/// Which of the first row colours it is, whatever the light; -1: none.
int row_of(const Colour& colour) {
  for (int i = 0; i < 4; ++i) {
    const Colour full = row_colour(i);
    const double shade = static_cast<double>(colour[0]) / full[0];
    if (std::abs(colour[1] - shade * full[1]) < 4 && std::abs(colour[2] - shade * full[2]) < 4 && shade > 0.3) return i;
  }
  return -1;
}

TEST(Draw, a_picture_has_the_size_asked_and_shows_the_mesh) {
  Fixture f;
  f.session.run("create brick x 2 interval 1");
  const Pixels usual = drawn(f, "");
  EXPECT_EQ(usual.width, 1200);
  EXPECT_EQ(usual.height, 900);
  // Seen along an axis the cube is a square that fills 92% of the height.
  const Pixels front = drawn(f, "from 0 -1 0 pixels 400 300");
  EXPECT_EQ(front.width, 400);
  EXPECT_EQ(front.height, 300);
  EXPECT_NEAR(static_cast<double>(front.n_drawn()), 0.92 * 0.92 * 300 * 300, 1500);
  EXPECT_EQ(row_of(front.at(200, 150)), 0);
  EXPECT_EQ(front.at(5, 5), (Colour{255, 255, 255}));
}

TEST(Draw, what_is_nearer_hides_what_is_behind) {
  Fixture f;
  f.session.run("create brick x 2 interval 2; reset block");
  // Blocks below and above the middle; x runs to the right when seen from -y.
  f.session.run("block 1 hex with y_coord < 0; block 2 hex with y_coord > 0");
  const Pixels front = drawn(f, "from 0 -1 0 pixels 200 200"), back = drawn(f, "from 0 1 0 pixels 200 200");
  EXPECT_EQ(row_of(front.at(80, 80)), 0);
  EXPECT_EQ(row_of(back.at(80, 80)), 1);
  f.session.run("undo 2; block 1 hex with x_coord < 0; block 2 hex with x_coord > 0");
  const Pixels left_right = drawn(f, "from 0 -1 0 pixels 200 200");
  EXPECT_EQ(row_of(left_right.at(70, 80)), 0);
  EXPECT_EQ(row_of(left_right.at(130, 80)), 1);
  f.session.run("undo 2; block 1 hex with z_coord < 0; block 2 hex with z_coord > 0");
  const Pixels up_down = drawn(f, "from 0 -1 0 pixels 200 200");
  EXPECT_EQ(row_of(up_down.at(80, 130)), 0);
  EXPECT_EQ(row_of(up_down.at(80, 70)), 1);
  EXPECT_NE(f.all_output().find("  block 2: orange"), std::string::npos) << f.all_output();
}

TEST(Draw, every_kind_of_entity_can_be_drawn) {
  Fixture f;
  f.session.run("create brick x 3 interval 3; nodeset 1 curve 1; sideset 1 surface 1; block 2 hex 1 2 3");
  std::set<std::ptrdiff_t> areas;
  for (const char* what :
       {"mesh", "volume 1", "hex 1", "surface 1", "face 1 to 4", "curve 1", "edge 1 2", "vertex 1", "node 1", "block 2",
        "nodeset 1", "sideset 1", "sheet 1", "hex 1 quality skew", "quality volume", "quality edge hex 1 2",
        "quality volume volume 1", "volume 1 quality relative size pixels 200 150"}) {
    f.session.run("set undo on");
    const Pixels pixels = drawn(f, what);
    EXPECT_GT(pixels.n_drawn(), 100) << what;
    areas.insert(pixels.n_drawn());
  }
  EXPECT_GT(areas.size(), 8u);
}

TEST(Draw, quality_gives_the_colours) {
  Fixture f;
  f.session.run("create brick x 3 interval 3");
  const Pixels cubes = drawn(f, "quality shape from 0 -1 0 pixels 200 200");
  const Colour best = scale_colour(ScaleKind::good, 1), seen = cubes.at(80, 80);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(seen[k], best[k] * static_cast<double>(seen[0]) / best[0], 4);
  EXPECT_NE(cubes.at(10, 60), (Colour{255, 255, 255})) << "the scale";
  EXPECT_EQ(drawn(f, "quality shape legend off from 0 -1 0 pixels 200 200").at(5, 60), (Colour{255, 255, 255}));
  f.session.run("refine hex 1");
  EXPECT_NE(drawn(f, "quality shape from 0 -1 0 pixels 200 200").colours, cubes.colours);
  for (const ScaleKind kind : {ScaleKind::good, ScaleKind::bad, ScaleKind::plain}) {
    EXPECT_NE(scale_colour(kind, 0), scale_colour(kind, 1));
    EXPECT_EQ(scale_colour(kind, -1), scale_colour(kind, 0));
    EXPECT_EQ(scale_colour(kind, INFINITY), scale_colour(kind, 1));
  }
  EXPECT_EQ(scale_colour(ScaleKind::good, 0.3), scale_colour(ScaleKind::bad, 0.7));
}

/// How much of a picture has each of the first row colours.
std::array<std::ptrdiff_t, 4> of_rows(const Pixels& pixels) {
  std::array<std::ptrdiff_t, 4> n{};
  for (const Colour& c : pixels.colours)
    if (const int row = row_of(c); row >= 0) ++n[static_cast<std::size_t>(row)];
  return n;
}

TEST(Draw, a_plane_shows_what_is_inside) {
  Fixture f;
  // A core that is nowhere seen from outside.
  f.session.run("create brick x 5 interval 5; reset block; block 1 hex all; block 1 remove hex 63; block 2 hex 63");
  const std::string front = " from 0 -1 0 pixels 250 250 legend off";
  EXPECT_EQ(of_rows(drawn(f, front))[1], 0);
  for (const char* cut :
       {"clip y", "clip y at 0.1", "clip 0 1 0 at -0.2", "clip 0 -3 0", "clip y crinkle", "clip y at -0.4 crinkle"}) {
    const auto n = of_rows(drawn(f, cut + front));
    // One of 25 squares that fill 92% of the height, less its rim.
    EXPECT_NEAR(static_cast<double>(n[1]), 46 * 46, 500) << cut;
    EXPECT_GT(n[0], 15 * n[1]) << cut;
  }
  // Half of the height of the core.
  const auto slanted = of_rows(drawn(f, "clip 0 1 -1" + front));
  EXPECT_GT(slanted[1], 500);
  EXPECT_EQ(of_rows(drawn(f, "clip y at -1.2 crinkle" + front))[1], 0) << "the layer before the core is still there";
  EXPECT_EQ(of_rows(drawn(f, "clip y at -2.6" + front))[0], of_rows(drawn(f, front))[0]) << "nothing is cut off";
  // A section of a distorted mesh is as large as the solid: no gaps, no overlaps.
  f.session.run("create cylinder radius 1 height 4 interval 3; refine curve 1");
  const double scale = 0.92 * 200 / 4;
  const Pixels section = drawn(f, "clip y from 0 -1 0 pixels 300 200");
  EXPECT_NEAR(static_cast<double>(section.n_drawn()), 2 * scale * 4 * scale, 600);
  EXPECT_TRUE(f.error("draw clip 0 0 0 to 'a.png' overwrite").starts_with("this is not the normal of a plane"));
}

TEST(Draw, sets_levels_fields_and_owners_give_colours) {
  Fixture f;
  f.session.run(
      "create brick x 4 interval 4; sideset 5 surface 1 name 'left'; nodeset 6 curve 1 2; group 'some' add hex 1 to 4 "
      "curve 3");
  const std::string more = " pixels 300 300 legend off";
  const auto rows = [&](const std::string& what) { return of_rows(drawn(f, "color " + what + more)); };
  int n_sideset = 0;
  for (const char* from : {"from 0 0 1", "from 0 0 -1", "from 1 0 0", "from -1 0 0", "from 0 1 0", "from 0 -1 0"}) {
    const auto n = rows(std::string("sideset ") + from);
    if (n[0] == 0) continue;
    ++n_sideset;
    EXPECT_GT(n[0], 260 * 260) << from;
  }
  EXPECT_EQ(n_sideset, 1) << "one side of the brick has the colour of its side set";
  EXPECT_GT(rows("nodeset")[0], 40);
  EXPECT_LT(rows("nodeset")[0], 3000) << "dots";
  EXPECT_GT(rows("'group'")[0], 1000);
  const auto owners = rows("owner");
  for (int k = 1; k < 4; ++k) EXPECT_GT(owners[static_cast<std::size_t>(k)], 40);
  const auto surfaces = rows("surface");
  EXPECT_EQ(std::ranges::count_if(surfaces, [](auto n) { return n > 1000; }), 2)
      << "three of six are seen, two of them below 5";
  f.session.run("refine hex 22 graded; draw color level to '" + (folder() / "a.png").string() + "' overwrite");
  EXPECT_NE(f.all_output().find("  level 1"), std::string::npos) << f.all_output();
  f.session.run("draw color 'scaled jacobian' to '" + (folder() / "a.png").string() + "' overwrite");
  EXPECT_NE(f.all_output().find("scaled Jacobian: from "), std::string::npos) << f.all_output();
  EXPECT_NE(f.error("draw color temperature to 'a.png'")
                .find("nothing here is called 'temperature' that could give the colours: there are none, surface, "
                      "sheet, owner, "
                      "nodeset, sideset, group, volume,"),
            std::string::npos);
  EXPECT_EQ(f.error("draw quality shape color level to 'a.png'"),
            "'quality' gives the colours as well: say one of them");
}

TEST(Draw, sheets_wished_sizes_and_vectors_give_colours) {
  Fixture f;
  f.session.run("create brick x 4 interval 4");
  Mesh mesh = f.session.meshed().mesh;
  Field flow;
  flow.name = "flow", flow.components = 3, flow.on = Field::On::node;
  for (const Vec3& p : mesh.points) flow.values.insert(flow.values.end(), {p.x(), 0, 2 * p.z()});
  mesh.fields = {flow};
  f.session.take_mesh(mesh);
  f.session.run("list field");
  EXPECT_NE(f.all_output().find("'flow'  nodes  3           -4        4"), std::string::npos) << f.all_output();
  const auto said = [&](const std::string& colour) {
    f.output.clear();
    EXPECT_GT(drawn(f, "color '" + colour + "' pixels 200 150").n_drawn(), 5000) << colour;
    return f.all_output();
  };
  EXPECT_NE(said("flow magnitude").find("flow magnitude: from 0 to 4.47"), std::string::npos) << f.all_output();
  EXPECT_NE(said("flow x").find("flow x: from -2 to 2"), std::string::npos) << f.all_output();
  EXPECT_NE(said("flow z").find("flow z: from -4 to 4"), std::string::npos) << f.all_output();
  // Every hex is in three sheets of as many hexes: that with the lowest number gives the colour.
  const std::string sheets = said("sheet");
  EXPECT_GT(std::ranges::count(sheets, '\n'), 3) << sheets;
  EXPECT_NE(sheets.find("  sheet 1: "), std::string::npos) << sheets;
  f.session.run("sizing function half constant 0.5; refine volume all sizing_function");
  EXPECT_NE(said("actual / wished size").find("actual / wished size: from "), std::string::npos) << f.all_output();
}

TEST(Draw, a_picture_has_ids_a_title_and_a_legend) {
  Fixture f;
  f.session.run("create brick x 2 interval 2; reset block; block 1 hex 1 to 4 name 'under'; block 2 hex 5 to 8");
  const std::string bare = " legend off pixels 400 300";
  const Pixels without = drawn(f, bare);
  const auto differ = [&](const Pixels& other) {
    return std::ranges::mismatch(other.colours, without.colours).in1 != other.colours.end();
  };
  if (!has_text()) {
    EXPECT_FALSE(differ(drawn(f, "title 'some title'" + bare)));
    EXPECT_NE(f.all_output().find("without text"), std::string::npos);
    return;
  }
  for (const char* kind : {"node", "edge", "face", "hex", "vertex", "curve", "surface", "volume"})
    EXPECT_TRUE(differ(drawn(f, std::string("label ") + kind + bare))) << kind;
  EXPECT_TRUE(differ(drawn(f, "title 'some title'" + bare)));
  EXPECT_TRUE(differ(drawn(f, "pixels 400 300")));
  // Which ids, as the drawing of lines and areas has them in words: three of six surfaces are seen, and four of the
  // eight hexes from straight ahead.
  const auto texts = [&](const std::string& command) {
    const auto file = folder() / "b.svg";
    f.session.run("draw legend off " + command + " to '" + file.string() + "' overwrite");
    const std::string drawing = content(file);
    std::set<std::string> result;
    for (std::size_t at = drawing.find("<text "); at != std::string::npos; at = drawing.find("<text ", at + 1)) {
      const std::size_t begin = drawing.find('>', at) + 1;
      result.insert(drawing.substr(begin, drawing.find('<', begin) - begin));
    }
    return result;
  };
  EXPECT_EQ(texts("label surface").size(), 3u);
  EXPECT_EQ(texts("label vertex").size(), 7u);
  EXPECT_EQ(texts("label curve").size(), 9u);
  EXPECT_EQ(texts("label hex from 0 -1 0").size(), 4u);
  EXPECT_EQ(texts("label hex from 0 -1 0 clip y at 0.5"), texts("label hex from 0 1 0")) << "the hexes behind";
  for (const char* from : {"1 1 1", "-1 -1 -1"})
    EXPECT_EQ(texts(std::string("surface 2 label surface from ") + from), std::set<std::string>{"2"});
  EXPECT_EQ(texts("hex 3 label hex"), std::set<std::string>{"3"});
  EXPECT_EQ(texts("title 'a & b'"), std::set<std::string>{"a &amp; b"});
}

TEST(Draw, cad_is_drawn_without_a_mesh) {
  Fixture f;
  f.session.run("import geometry '" HEXTWIST_SOURCE_DIR "/models/pipe_tee.brep'");
  const Pixels cad = drawn(f, "from 1 -1 0.7 pixels 400 300");
  EXPECT_GT(cad.n_drawn(), 10000);
  const auto surfaces = of_rows(drawn(f, "color surface legend off pixels 400 300"));
  EXPECT_GT(surfaces[0] + surfaces[1] + surfaces[2] + surfaces[3], 5000);
  EXPECT_NE(f.error("draw color shape to 'a.png'").find("could give the colours: there are none, surface"),
            std::string::npos);
  // It looks as the mesh on it does.
  f.session.run("import mesh '" HEXTWIST_SOURCE_DIR "/models/pipe_tee.msh'");
  const Pixels mesh = drawn(f, "from 1 -1 0.7 pixels 400 300"),
               again = drawn(f, "geometry from 1 -1 0.7 pixels 400 300");
  const Colour none = {255, 255, 255};
  int differ = 0, changed = 0;
  for (std::size_t i = 0; i < mesh.colours.size(); ++i) {
    differ += (mesh.colours[i] == none) != (cad.colours[i] == none);
    changed += again.colours[i] != cad.colours[i];
  }
  EXPECT_LT(differ, 2000) << "of 120000 pixels, near the outline";
  EXPECT_EQ(changed, 0);
}

/// A block of a page: its header and what follows, inflated.
std::string block_of(const std::string& page, const std::string& id) {
  const std::string begin = "<script type=\"text/plain\" id=\"" + id + "\">";
  const std::size_t at = page.find(begin);
  if (at == std::string::npos) return "";
  const std::string text = page.substr(at + begin.size(), page.find('<', at + begin.size()) - at - begin.size());
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string packed;
  unsigned bits = 0;
  int n = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<unsigned>(digits.find(c));
    if ((n += 6) >= 8) packed += static_cast<char>(bits >> (n -= 8) & 0xff);
  }
  std::string raw(1 << 22, '\0');
  uLongf size = static_cast<uLongf>(raw.size());
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(raw.data()), &size, reinterpret_cast<const Bytef*>(packed.data()),
                       static_cast<uLong>(packed.size())),
            Z_OK)
      << id;
  raw.resize(size);
  return raw.substr(4);
}

TEST(Draw, a_page_stands_by_itself) {
  Fixture f;
  f.session.run("create brick x 2 interval 2; block 7 hex 1 name '</script><b>&'");
  const auto file = folder() / "a.html";
  if (!has_page()) {
    EXPECT_TRUE(f.error("draw to '" + file.string() + "'").starts_with("this program was built without its page"));
    EXPECT_FALSE(std::filesystem::exists(file));
    return;
  }
  f.session.run("draw to '" + file.string() + "'");
  const std::string page = content(file);
  EXPECT_TRUE(page.starts_with("<!DOCTYPE html>"));
  EXPECT_TRUE(page.ends_with("</html>\n"));
  EXPECT_NE(page.find("Content-Security-Policy\" content=\"default-src 'none'; script-src 'unsafe-inline'"),
            std::string::npos);
  for (const char* outside : {"src=\"http", "href=\"http", "@import", "</script><b>"})
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  // 24 faces on 26 nodes are seen at first; all 27 and the 8 hexes are in a block of their own.
  const std::string skin = block_of(page, "skin"), inside = block_of(page, "inside");
  for (const char* array : {"[\"node\",\"u32\",1,26]", "[\"quad\",\"u32\",4,24]", "[\"edge\",\"u32\",2,48]"})
    EXPECT_NE(skin.find(array), std::string::npos) << array << "\n" << skin.substr(0, 600);
  for (const char* array : {"[\"point\",\"f32\",3,27]", "[\"hex\",\"u32\",8,8]"})
    EXPECT_NE(inside.find(array), std::string::npos) << array << "\n" << inside.substr(0, 300);
  EXPECT_NE(block_of(page, "c2").find("[\"value\",\"f32\",1,8]"), std::string::npos);
  EXPECT_NE(f.all_output().find("8 hexes"), std::string::npos);
}

TEST(Draw, a_page_holds_cad_alone_groups_and_a_cut) {
  if (!has_page()) GTEST_SKIP() << "built without its page";
  Fixture f;
  const auto file = folder() / "a.html";
  f.session.run("import geometry '" HEXTWIST_SOURCE_DIR "/models/bracket.brep'; draw to '" + file.string() + "'");
  const MeshedModel& meshed = f.session.meshed();
  const std::string cad = block_of(content(file), "cad");
  EXPECT_NE(cad.find("[\"vertex\",\"f32\",3," + std::to_string(meshed.model->count(0)) + "]"), std::string::npos)
      << cad.substr(0, 600);
  f.session.run("import mesh '" HEXTWIST_SOURCE_DIR "/models/bracket.msh'");
  const auto drawn_page = [&](const std::string& how) {
    f.session.run("draw " + how + " to '" + file.string() + "' overwrite");
    return content(file);
  };
  f.session.run("group 'some' add hex 1 to 7 face 3 node 5 curve 2");
  const std::string page = drawn_page(""), cut = drawn_page("clip x at 0");
  const std::string sets = block_of(page, "sets");
  for (const char* array : {"[\"group 1 hexes\",\"u32\",1,7]", "[\"group 1 sides\",\"u32\",1,1]"})
    EXPECT_NE(sets.find(array), std::string::npos) << array << "\n" << sets.substr(0, 600);
  EXPECT_NE(block_of(cut, "skin"), block_of(page, "skin")) << "what is said of the start";
  EXPECT_EQ(block_of(cut, "inside"), block_of(page, "inside"));
}

TEST(Draw, a_drawing_has_an_area_for_each_face) {
  Fixture f;
  f.session.run("create brick x 2 interval 2; reset block; block 1 hex 1 2 name '<&>'; block 2 hex 3");
  const auto file = folder() / "a.svg";
  f.session.run("draw quality shape from 0 -1 0 pixels 300 200 to '" + file.string() + "'");
  const std::string drawing = content(file);
  const auto n = [&](const std::string& what) {
    int result = 0;
    for (std::size_t at = drawing.find(what); at != std::string::npos; at = drawing.find(what, at + 1)) ++result;
    return result;
  };
  EXPECT_TRUE(drawing.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"300\" height=\"200\""));
  EXPECT_TRUE(drawing.ends_with("</svg>\n"));
  EXPECT_EQ(n("<polygon "), 24);
  EXPECT_EQ(n(">shape</text>"), 1);
  // The front is drawn last: a square of 92% of the height in the middle.
  const std::size_t last = drawing.rfind("<polygon points=\"");
  EXPECT_NE(drawing.substr(last, 60).find("150.00,"), std::string::npos) << drawing.substr(last, 60);
  f.session.run("draw to '" + file.string() + "' overwrite");
  EXPECT_NE(content(file).find("block 1 '&lt;&amp;&gt;'"), std::string::npos);
  EXPECT_NE(f.error("create brick x 2 interval 60; draw to '" + (folder() / "b.svg").string() + "'")
                .find("a drawing of 21600 faces is too large for .svg, which takes 20000"),
            std::string::npos);
}

TEST(Draw, a_moving_picture_gets_one_more) {
  Fixture f;
  f.session.run("create brick x 2 interval 2");
  const auto file = folder() / "a.gif";
  const std::string draw = "draw pixels 60 40 to '" + file.string() + "'";
  if (const std::string said = f.error(draw); said != "no error") {
    EXPECT_TRUE(said.starts_with("this program was built without giflib")) << said;
    return;
  }
  EXPECT_NE(f.error(draw).find("exists already"), std::string::npos);
  const std::string one = content(file);
  EXPECT_EQ(one.substr(0, 3), "GIF");
  EXPECT_EQ(one.back(), ';');
  EXPECT_NE(one.find("NETSCAPE2.0"), std::string::npos);
  f.session.run("refine hex 1; " + draw + " append; undo; " + draw + " append");
  const std::string three = content(file);
  // The first picture is there as it was, and the third is the same but for its place.
  EXPECT_GT(three.size(), 2 * one.size());
  // Width and height, lowest byte first.
  EXPECT_EQ(three.substr(6, 4), std::string("\x3c\0\x28\0", 4));
  int n = 0;
  for (std::size_t at = three.find(std::string("\x21\xf9\x04", 3)); at != std::string::npos;
       at = three.find(std::string("\x21\xf9\x04", 3), at + 1))
    ++n;
  EXPECT_EQ(n, 3) << "graphic control extensions";
  EXPECT_EQ(f.error("draw pixels 50 40 to '" + file.string() + "' append"),
            "the pictures in this file have 60 by 40 pixels, not 50 by 40");
  EXPECT_EQ(content(file), three);
  const auto no_gif = written("no.gif", "no picture at all");
  EXPECT_EQ(f.error("draw to '" + no_gif.string() + "' append"), "this is not a GIF file to add a picture to");
  std::ofstream(folder() / "half.gif", std::ios::binary) << three.substr(0, three.size() / 2);
  EXPECT_EQ(f.error("draw pixels 60 40 to '" + (folder() / "half.gif").string() + "' append"),
            "this is not a whole GIF file to add a picture to");
  EXPECT_EQ(f.error("draw to 'a.png' append"), "only a .gif takes further pictures");
}

TEST(Draw, mistakes_leave_no_file) {
  Fixture f;
  EXPECT_TRUE(f.error("draw to 'a.png'").starts_with("there is no mesh to draw; read one"));
  f.session.run("create brick x 2 interval 2");
  EXPECT_EQ(f.error("draw to 'a.jpg'"), "pictures end in .png, .svg, .gif or .html, not in '.jpg'");
  const auto file = folder() / "a.png";
  EXPECT_EQ(f.error("draw from 0 0 0 to '" + file.string() + "'"), "this is not a direction to look from");
  EXPECT_FALSE(std::filesystem::exists(file));
  const auto old = written("old.png", "old");
  EXPECT_NE(f.error("draw to '" + old.string() + "'").find("exists already"), std::string::npos);
  EXPECT_EQ(content(old), "old");
  EXPECT_NE(f.error("draw to '/no/folder/a.png'").find("there is no folder"), std::string::npos);
}

TEST(Draw, the_number_of_threads_does_not_change_a_picture) {
  Fixture f;
  f.session.run("create sphere radius 1; refine surface 1; set threads 1");
  const std::vector<Colour> one = drawn(f, "quality shape").colours;
  f.session.run("set threads 2");
  EXPECT_EQ(drawn(f, "quality shape").colours, one);
  f.session.run("set threads 0");
}

}  // namespace
}  // namespace hextwist
