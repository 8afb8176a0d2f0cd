// draw: pictures and pages.
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>

#include "hextwist/session/view/page.h"
#include "hextwist/session/view/picture.h"
#include "session/session_fixture.h"

namespace hextwist {

using test::Fixture, test::folder, test::written;

namespace {

std::string content(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::uint32_t number_at(const std::string& bytes, std::size_t at) {
  std::uint32_t result = 0;
  for (std::size_t i = 0; i < 4; ++i) result = result << 8 | static_cast<unsigned char>(bytes.at(at + i));
  return result;
}

struct Pixels {
  int width = 0, height = 0;
  std::vector<Colour> colours;
  const Colour& at(int x, int y) const { return colours.at(static_cast<std::size_t>(y) * width + x); }
  std::ptrdiff_t n_drawn() const {
    return std::ranges::count_if(colours, [](const Colour& c) { return c != Colour{255, 255, 255}; });
  }
};

/// Reads the PNG files that are written here: one chunk of data, rows as differences from those above.
Pixels decoded(const std::string& file) {
  EXPECT_EQ(file.substr(0, 8), "\x89PNG\r\n\x1a\n");
  Pixels result;
  std::string packed;
  for (std::size_t at = 8; at < file.size();) {
    const std::size_t size = number_at(file, at);
    const std::string body = file.substr(at + 4, size + 4);
    EXPECT_EQ(number_at(file, at + 8 + size),
              crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size())));
    if (body.starts_with("IHDR")) {
      result.width = static_cast<int>(number_at(body, 4));
      result.height = static_cast<int>(number_at(body, 8));
      EXPECT_EQ(body.substr(12), std::string("\10\2\0\0\0", 5));
    }
    if (body.starts_with("IDAT")) packed += body.substr(4);
    at += size + 12;
  }
  const std::size_t row = static_cast<std::size_t>(result.width) * 3;
  std::string rows((row + 1) * static_cast<std::size_t>(result.height), '\0');
  uLongf n = static_cast<uLongf>(rows.size());
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(rows.data()), &n, reinterpret_cast<const Bytef*>(packed.data()),
                       static_cast<uLong>(packed.size())),
            Z_OK);
  EXPECT_EQ(n, rows.size());
  result.colours.resize(static_cast<std::size_t>(result.width) * result.height);
  for (int y = 0; y < result.height; ++y) {
    const std::size_t begin = static_cast<std::size_t>(y) * (row + 1);
    EXPECT_EQ(rows[begin], 2);
    for (int x = 0; x < result.width; ++x)
      for (int k = 0; k < 3; ++k) {
        const int above = y > 0 ? result.at(x, y - 1)[k] : 0;
        result.colours[static_cast<std::size_t>(y) * result.width + x][k] =
            static_cast<std::uint8_t>(above + static_cast<unsigned char>(rows[begin + 1 + 3 * x + k]));
      }
  }
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
  const Colour best = scale_colour(1), seen = cubes.at(80, 80);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(seen[k], best[k] * static_cast<double>(seen[0]) / best[0], 4);
  EXPECT_NE(cubes.at(10, 60), (Colour{255, 255, 255})) << "the scale";
  f.session.run("refine hex 1");
  EXPECT_NE(drawn(f, "quality shape from 0 -1 0 pixels 200 200").colours, cubes.colours);
  EXPECT_NE(scale_colour(0), scale_colour(1));
  EXPECT_EQ(scale_colour(-1), scale_colour(0));
  EXPECT_EQ(scale_colour(2), scale_colour(1));
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
