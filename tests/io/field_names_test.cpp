// Names of fields that a format can't have as they are: each field comes back by itself, and what is changed is told.
#include "hextwist/io/field_names.h"
#include "hextwist/io/group_names.h"

#include "io/hdf_support.h"

namespace hextwist {
namespace {

/// Scalars, vectors and others on nodes and hexes, each with values of its own.
Mesh with_fields(const std::vector<std::string>& names) {
  Mesh mesh = test::grid(2, 1, 1);
  double value = 0;
  for (const std::string& name : names)
    for (const int components : {1, 3, 2}) {
      const bool on_nodes = components != 3;
      Field field{name + (components == 1   ? ""
                          : components == 3 ? " vector"
                                            : " pair"),
                  on_nodes ? Field::On::node : Field::On::hex,
                  components,
                  {}};
      const std::size_t n = on_nodes ? mesh.points.size() : mesh.hexes.size();
      for (std::size_t i = 0; i < n * static_cast<std::size_t>(components); ++i) field.values.push_back(++value + 0.5);
      mesh.fields.push_back(std::move(field));
    }
  return mesh;
}

void expect_all_kept_or_told(const Mesh& mesh, const std::string& file) {
  SCOPED_TRACE(file);
  const auto path = test::output_folder() / file;
  const auto notices = write_mesh(path, mesh, nullptr);
  const MeshFile read = read_mesh(path);
  EXPECT_TRUE(read.notices.empty()) << read.notices[0];
  EXPECT_EQ(read.mesh.fields.size(), mesh.fields.size());
  std::set<std::pair<Field::On, std::string>> names;
  for (const Field& field : read.mesh.fields)
    EXPECT_TRUE(names.emplace(field.on, field.name).second) << field.name << " twice";
  for (const Field& field : mesh.fields) {
    const auto same = std::ranges::find(read.mesh.fields, field.values, &Field::values);
    if (same == read.mesh.fields.end()) {
      ADD_FAILURE() << "'" << field.name << "' is lost";
      continue;
    }
    EXPECT_EQ(same->components, field.components) << field.name;
    if (same->name != field.name) {
      EXPECT_TRUE(test::told(notices, "field '" + field.name + "' is called '" + same->name + "' in the file"))
          << "'" << field.name << "' is '" << same->name << "' and nobody told";
    }
  }
}

TEST(field_names, every_field_comes_back_and_what_changed_is_told) {
  const std::string long_name(40, 'a');
  // 31 and 32 bytes end within a character.
  std::string greek = "x";
  for (int i = 0; i < 40; ++i) greek += "\xce\xb1";
  const Mesh mesh = with_fields({"T", "dT/dx", "dT_dx", "T ", " T", ".", "..", "T.", "a\tb", "a b", "a\nb", "p:q", "/",
                                 "back\r", long_name + "1", long_name + "2", greek + "1", greek + "2"});
  for (const std::string extension : {".med", ".cgns", ".xdmf", ".vtkhdf", ".vtu"})
    if (test::has_format(extension)) expect_all_kept_or_told(mesh, "a" + extension);
}

TEST(field_names, xml_keeps_tabs_and_line_ends_and_tells_what_it_has_not) {
  Mesh mesh = test::grid(1, 1, 1);
  mesh.fields = {{"a\tb\nc\rd", Field::On::hex, 1, {7}}, {"e\x02", Field::On::hex, 1, {8}}};
  mesh.blocks = {{3, "x\ty", {0}}, {4, "z\x01", {0}}};
  for (const std::string file : {"a.vtu", "a.xdmf"}) {
    if (!test::has_format(std::filesystem::path(file).extension().string())) continue;
    SCOPED_TRACE(file);
    const auto path = test::output_folder() / file;
    const auto notices = write_mesh(path, mesh, nullptr);
    const Mesh read = read_mesh(path).mesh;
    ASSERT_EQ(read.fields.size(), 2U);
    EXPECT_EQ(read.fields[0].name, "a\tb\nc\rd");
    EXPECT_EQ(read.fields[1].name, "e ");
    EXPECT_TRUE(test::told(notices, "field 'e\x02' is called 'e ' in the file"));
    ASSERT_EQ(read.blocks.size(), 2U);
    EXPECT_EQ(read.blocks[0].name, "x\ty");
    const bool in_xml = file == "a.vtu";
    EXPECT_EQ(read.blocks[1].name, in_xml ? "z " : "z\x01");
    EXPECT_EQ(test::told(notices, "block 4 'z\x01' is called 'z ' in the file"), in_xml);
  }
}

TEST(field_names, numbers_of_characters_are_read) {
  Mesh mesh = test::grid(1, 1, 1);
  mesh.fields = {{"name", Field::On::hex, 1, {7}}};
  const auto file = test::output_folder() / "a.vtu";
  write_mesh(file, mesh, nullptr);
  const std::string text = test::text_of(file);
  for (const auto& [written, meant] : std::map<std::string, std::string>{
           {"&#65;&#x42;", "AB"},
           {"&#xe9;&#945;&#x20AC;&#x1F600;", "\xc3\xa9\xce\xb1\xe2\x82\xac\xf0\x9f\x98\x80"},
           {"&#;&#x;&#0;&#9", "&#;&#x;&#0;&#9"}}) {
    std::string changed = text;
    test::write_text(file, changed.replace(text.find("\"name\"") + 1, 4, written));
    EXPECT_EQ(read_mesh(file).mesh.fields.at(0).name, meant) << written;
  }
}

TEST(field_names, first_letters_end_between_two) {
  EXPECT_EQ(io::first_letters("abc", 5), "abc");
  EXPECT_EQ(io::first_letters("abc", 2), "ab");
  const std::string text = "a\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80";  // 1, 2, 3, 4 bytes
  const std::vector<std::size_t> ends = {0, 1, 1, 3, 3, 3, 6, 6, 6, 6, 10};
  for (std::size_t n = 0; n < ends.size(); ++n) EXPECT_EQ(io::first_letters(text, n).size(), ends[n]) << n;
  EXPECT_EQ(io::first_letters(std::string(9, '\x80'), 7).size(), 7U);  // not UTF-8
}

}  // namespace
}  // namespace hextwist
