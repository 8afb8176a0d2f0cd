// Materials, sections and the like of hexes whose blocks are others: ANSYS and I-deas universal files.
#include "io/io_support.h"

namespace hextwist {
namespace {

/// Two cubes side by side: corners of hexes 7 and 5.
constexpr std::array<std::array<int, 3>, 12> places = {{{0, 0, 0},
                                                        {1, 0, 0},
                                                        {1, 1, 0},
                                                        {0, 1, 0},
                                                        {0, 0, 1},
                                                        {1, 0, 1},
                                                        {1, 1, 1},
                                                        {0, 1, 1},
                                                        {2, 0, 0},
                                                        {2, 1, 0},
                                                        {2, 0, 1},
                                                        {2, 1, 1}}};
constexpr std::array<std::array<int, 8>, 2> hexes = {{{1, 2, 3, 4, 5, 6, 7, 8}, {2, 9, 10, 3, 6, 11, 12, 7}}};

std::string right(double number, int width, const char* format) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), format, width, number);
  return text.data();
}
std::string integers(std::initializer_list<int> numbers, int width) {
  std::string line;
  for (const int number : numbers) line += right(number, width, "%*.0f");
  return line;
}

/// numbers: of hex 7, of hex 5: material, type, real constants, section, coordinate system.
std::string ansys(const std::array<std::array<int, 5>, 2>& numbers, const std::string& components) {
  std::string text = "/PREP7\nET,1,185\nET,2,45\nNBLOCK,6,SOLID,12,12\n(3i9,6e21.13e3)\n";
  for (std::size_t n = 0; n < places.size(); ++n) {
    text += integers({static_cast<int>(n) + 1, 0, 0}, 9);
    for (const int x : places[n]) text += right(x, 21, "%*.13E");
    text += "\n";
  }
  text += "N,R5.3,LOC,       -1,\nEBLOCK,19,SOLID,2,2\n(19i9)\n";
  for (std::size_t h = 0; h < 2; ++h) {
    for (const int number : numbers[h]) text += integers({number}, 9);
    text += integers({0, 0, 0, 8, 0, h == 0 ? 7 : 5}, 9);
    for (const int node : hexes[h]) text += integers({node}, 9);
    text += "\n";
  }
  return text + "       -1\n" + components + "FINISH\n";
}
constexpr const char* one_component = "CMBLOCK,CE,ELEM,       1\n(8i10)\n         5\n";

/// numbers: of hex 7, of hex 5: property and material.
std::string unv(const std::array<std::array<int, 2>, 2>& numbers, bool group) {
  std::string text = "    -1\n  2411\n";
  for (std::size_t n = 0; n < places.size(); ++n) {
    text += integers({static_cast<int>(n) + 1, 1, 1, 11}, 10) + "\n";
    for (const int x : places[n]) text += right(x, 25, "%*.16E");
    text += "\n";
  }
  text += "    -1\n    -1\n  2412\n";
  for (std::size_t h = 0; h < 2; ++h) {
    text += integers({h == 0 ? 7 : 5, 115, numbers[h][0], numbers[h][1], 7, 8}, 10) + "\n";
    for (const int node : hexes[h]) text += integers({node}, 10);
    text += "\n";
  }
  text += "    -1\n";
  if (!group) return text;
  return text + "    -1\n  2467\n" + integers({1, 0, 0, 0, 0, 0, 0, 1}, 10) + "\nGRP\n" + integers({8, 5, 0, 0}, 10) +
         "\n    -1\n";
}

/// Per column of EBLOCK or 2412 those of all hexes, by their place along x: without the reader.
std::map<std::string, std::vector<int>> columns_in(const std::filesystem::path& file) {
  std::map<std::string, std::vector<int>> result;
  std::istringstream lines(test::text_of(file));
  const bool is_ansys = file.extension() == ".cdb";
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("EBLOCK") || line == "  2412") inside = true;
    if (line.starts_with("       -1") || line == "    -1") inside = false;
    std::istringstream words(line);
    std::vector<int> numbers;
    for (int n = 0; words >> n;) numbers.push_back(n);
    if (!inside || numbers.size() < 3) continue;
    if (is_ansys && numbers.size() == 19 && numbers[1] == 1) {
      result["material"].push_back(numbers[0]), result["real"].push_back(numbers[2]);
      result["section"].push_back(numbers[3]), result["esys"].push_back(numbers[4]);
      result["id"].push_back(numbers[10]);
    }
    if (!is_ansys && numbers.size() == 6 && numbers[1] == 115) {
      result["property"].push_back(numbers[2]), result["material"].push_back(numbers[3]);
      result["id"].push_back(numbers[0]);
    }
  }
  return result;
}

std::map<std::string, std::vector<double>> fields_of(const Mesh& mesh) {
  std::map<std::string, std::vector<double>> result;
  for (const Field& field : mesh.fields) {
    EXPECT_TRUE(field.integer && field.on == Field::On::hex && field.components == 1) << field.name;
    result[field.name] = field.values;
  }
  return result;
}
using Fields = std::map<std::string, std::vector<double>>;
using Columns = std::map<std::string, std::vector<int>>;

TEST(hex_numbers, of_ansys_come_back_where_components_are_blocks) {
  const auto folder = test::output_folder();
  const auto read = [&](const std::array<std::array<int, 5>, 2>& numbers, const std::string& components) {
    const MeshFile file = read_mesh(test::write_text(folder / "a.cdb", ansys(numbers, components)));
    const auto notices = write_mesh(folder / "b.cdb", file.mesh, nullptr);
    EXPECT_TRUE(notices.empty()) << notices[0];
    EXPECT_TRUE(test::same_mesh(file.mesh, read_mesh(folder / "b.cdb").mesh));
    return file.mesh;
  };
  // Hexes are by ascending id: 5, 7.
  Mesh mesh = read({{{1, 1, 1, 1, 0}, {2, 1, 1, 1, 0}}}, one_component);
  EXPECT_EQ(mesh.blocks, (std::vector<Block>{{1, "CE", {0}}}));
  EXPECT_EQ(fields_of(mesh), (Fields{{"material", {2, 1}}}));
  const Columns usual = {{"real", {1, 1}}, {"section", {1, 1}}, {"esys", {0, 0}}, {"id", {5, 7}}};
  Columns expected = usual;
  expected["material"] = {2, 1};
  EXPECT_EQ(columns_in(folder / "b.cdb"), expected);
  mesh = read({{{1, 1, 3, 4, 11}, {2, 1, 3, 5, 12}}}, one_component);
  EXPECT_EQ(fields_of(mesh), (Fields{{"material", {2, 1}}, {"real", {3, 3}}, {"section", {5, 4}}, {"esys", {12, 11}}}));
  EXPECT_EQ(columns_in(folder / "b.cdb"),
            (Columns{{"material", {2, 1}}, {"real", {3, 3}}, {"section", {5, 4}}, {"esys", {12, 11}}, {"id", {5, 7}}}));
  // All of one material, which is no block's id.
  mesh = read({{{6, 1, 1, 1, 0}, {6, 1, 1, 1, 0}}}, one_component);
  EXPECT_EQ(fields_of(mesh), (Fields{{"material", {6, 6}}}));
  // Where no component has hexes materials are blocks, and where there is one, types.
  mesh = read({{{1, 1, 1, 1, 0}, {2, 1, 1, 7, 0}}}, "");
  EXPECT_EQ(mesh.blocks, (std::vector<Block>{{1, "", {1}}, {2, "", {0}}}));
  EXPECT_EQ(fields_of(mesh), (Fields{{"section", {7, 1}}}));
  mesh = read({{{3, 1, 1, 1, 0}, {3, 2, 1, 1, 0}}}, "");
  EXPECT_EQ(mesh.blocks, (std::vector<Block>{{1, "", {1}}, {2, "", {0}}}));
  EXPECT_EQ(fields_of(mesh), (Fields{{"material", {3, 3}}}));
  expected["material"] = {3, 3};
  EXPECT_EQ(columns_in(folder / "b.cdb"), expected);
}

TEST(hex_numbers, of_universal_files_come_back_where_groups_are_blocks) {
  const auto folder = test::output_folder();
  const auto read = [&](const std::array<std::array<int, 2>, 2>& numbers, bool group) {
    const MeshFile file = read_mesh(test::write_text(folder / "a.unv", unv(numbers, group)));
    const auto notices = write_mesh(folder / "b.unv", file.mesh, nullptr);
    EXPECT_TRUE(notices.empty()) << notices[0];
    EXPECT_TRUE(test::same_mesh(file.mesh, read_mesh(folder / "b.unv").mesh));
    return file.mesh;
  };
  Mesh mesh = read({{{1, 1}, {2, 3}}}, true);
  EXPECT_EQ(mesh.blocks, (std::vector<Block>{{1, "GRP", {0}}}));
  EXPECT_EQ(fields_of(mesh), (Fields{{"property", {2, 1}}, {"material", {3, 1}}}));
  EXPECT_EQ(columns_in(folder / "b.unv"), (Columns{{"property", {2, 1}}, {"material", {3, 1}}, {"id", {5, 7}}}));
  EXPECT_TRUE(read({{{1, 1}, {1, 1}}}, true).fields.empty());
  mesh = read({{{4, 1}, {2, 3}}}, false);
  EXPECT_EQ(mesh.blocks, (std::vector<Block>{{2, "", {0}}, {4, "", {1}}}));
  EXPECT_EQ(fields_of(mesh), (Fields{{"material", {3, 1}}}));
}

TEST(hex_numbers, are_taken_from_fields_of_whole_numbers_alone) {
  const auto folder = test::output_folder();
  Mesh mesh = test::grid(2, 1, 1);
  mesh.blocks = {{4, "b", {0, 1}}};
  const auto expect = [&](const Field& field, const std::vector<int>& ansys_materials,
                          const std::vector<int>& unv_materials, bool told) {
    mesh.fields = {field};
    for (const std::string name : {"a.cdb", "a.unv"}) {
      EXPECT_EQ(test::told(write_mesh(folder / name, mesh, nullptr), "no fields: '" + field.name + "' left out"), told);
      EXPECT_EQ(columns_in(folder / name)["material"], name == "a.cdb" ? ansys_materials : unv_materials);
    }
  };
  expect({"material", Field::On::hex, 1, {7, 0}, true}, {7, 0}, {7, 0}, false);
  expect({"material", Field::On::hex, 1, {7, 8}, false}, {7, 8}, {7, 8}, false);
  expect({"material", Field::On::hex, 1, {7, 8.5}, false}, {4, 4}, {1, 1}, true);
  expect({"material", Field::On::hex, 1, {7, -1}, true}, {4, 4}, {1, 1}, true);
  expect({"material", Field::On::hex, 1, {7, std::nan("")}, true}, {4, 4}, {1, 1}, true);
  expect({"material", Field::On::hex, 1, {7, 1e12}, true}, {4, 4}, {1, 1}, true);
  expect({"material", Field::On::hex, 2, {1, 2, 3, 4}, true}, {4, 4}, {1, 1}, true);
  expect({"material", Field::On::node, 1, std::vector<double>(12, 3), true}, {4, 4}, {1, 1}, true);
  expect({"heat", Field::On::hex, 1, {7, 8}, true}, {4, 4}, {1, 1}, true);
}

}  // namespace
}  // namespace hextwist
