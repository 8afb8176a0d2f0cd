// Meshes and comparisons for the tests of mesh files.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

#include "hextwist/base/text.h"
#include "hextwist/io/io.h"
#include "hextwist/mesh/corners.h"
#include "support/checkers.h"
#include "support/grids.h"

namespace hextwist::test {

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

inline std::filesystem::path write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

/// What the Error says that a call should throw, in one line.
template <class Does>
std::string error_of(const Does& does) {
  try {
    does();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  return "no error";
}
/// What read_mesh() says about a file that it should refuse.
inline std::string refusal(const std::filesystem::path& file) {
  return error_of([&] { read_mesh(file); });
}

/// A shuffled grid with awkward coordinates, overlapping blocks, hexes in no block, node sets, side sets with sides
/// between hexes from either one, names, fields, and gaps in the ids where asked.
inline Mesh rich_mesh(unsigned seed, bool gaps, const std::array<int, 3>& cells = {4, 3, 3}) {
  std::mt19937 random(seed);
  Mesh mesh = shuffled(grid(cells[0], cells[1], cells[2]), random);
  std::uniform_real_distribution<double> jitter(-0.1, 0.1);
  for (Vec3& p : mesh.points)
    for (double& x : p) x += jitter(random);
  mesh.points[0].x() = std::nextafter(mesh.points[0].x(), 10.0);
  for (Vec3& p : mesh.points)
    if (std::round(p.y()) == 0) p.y() *= 1e-300;
  const auto pick = [&](Index n, int one_in) {
    std::vector<Index> items;
    for (Index i = 0; i < n; ++i)
      if (random() % static_cast<unsigned>(one_in) == 0) items.push_back(i);
    return items;
  };
  mesh.blocks = {{2, "steel (hot)", pick(mesh.n_hexes(), 2)},
                 {5, "", pick(mesh.n_hexes(), 3)},
                 {70, "layer/all", pick(mesh.n_hexes(), 4)}};
  mesh.node_sets = {{1, "", pick(mesh.n_nodes(), 5)}, {2, "Fixed Nodes", pick(mesh.n_nodes(), 3)}, {9, "one", {17}}};
  const auto sides = [&](int one_in) {
    std::vector<Side> items;
    for (Index h = 0; h < mesh.n_hexes(); ++h)
      for (int f = 0; f < 6; ++f)
        if (random() % static_cast<unsigned>(one_in) == 0) items.push_back({h, f});
    return items;
  };
  mesh.side_sets = {{3, "pressure", sides(9)}, {4, "", sides(4)}};
  const auto values = [&](std::size_t n) {
    std::vector<double> result(n);
    for (double& x : result) x = jitter(random);
    return result;
  };
  mesh.fields = {{"temperature", Field::On::node, 1, values(mesh.points.size())},
                 {"velocity", Field::On::node, 3, values(3 * mesh.points.size())},
                 {"stress", Field::On::hex, 6, values(6 * mesh.hexes.size())},
                 {"density", Field::On::hex, 1, values(mesh.hexes.size())}};
  if (gaps) {
    std::int64_t id = 3;
    for (std::size_t i = 0; i < mesh.points.size(); ++i) mesh.node_ids.push_back(id += 1 + random() % 3);
    id = 10;
    for (std::size_t i = 0; i < mesh.hexes.size(); ++i) mesh.hex_ids.push_back(id += 1 + random() % 2);
  }
  return mesh;
}

/// Blocks that do not overlap, groups whose ids differ between kinds, and none with a name that a format can't have.
inline Mesh tidy_mesh(unsigned seed, bool gaps) {
  Mesh mesh = rich_mesh(seed, gaps);
  mesh.fields.clear();
  mesh.blocks = {{2, "steel", {}}, {5, "", {}}};
  for (Index h = 0; h < mesh.n_hexes(); ++h) mesh.blocks[h % 3 == 0].hexes.push_back(h);
  mesh.node_sets[0].id = 11, mesh.node_sets[1].id = 12, mesh.node_sets[2].id = 19;
  mesh.node_sets[1].name = "Fixed_Nodes";
  return mesh;
}

/// Groups whatever their ids are, where they have names.
template <class Groups>
std::set<std::string> names_and_members(const Groups& groups) {
  std::set<std::string> result;
  for (const auto& group : groups) {
    std::string text = group.name.empty() ? std::to_string(group.id) : group.name;
    if constexpr (requires { group.hexes; })
      text += ":" + joined(group.hexes);
    else if constexpr (requires { group.nodes; })
      text += ":" + joined(group.nodes);
    else
      for (const Side& side : group.sides) text += ":" + std::to_string(side.hex) + "/" + std::to_string(side.face);
    result.insert(text);
  }
  return result;
}

/// Coordinates of all corners of all hexes, which say the same however nodes are numbered.
inline std::vector<Vec3> corners_of_hexes(const Mesh& mesh) {
  std::vector<Vec3> result;
  for (const Hex& hex : mesh.hexes)
    for (const Index node : hex) result.push_back(mesh.points[node]);
  return result;
}

/// Is this in one of the lines?
inline bool told(const std::vector<std::string>& notices, const std::string& part) {
  return std::ranges::any_of(notices, [&](const std::string& line) { return line.find(part) != std::string::npos; });
}

/// Each coordinate as near as this part of it.
inline void expect_points_near(const std::vector<Vec3>& found, const std::vector<Vec3>& expected, double relative) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t n = 0; n < found.size(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      ASSERT_NEAR(found[n][axis], expected[n][axis], relative * std::abs(expected[n][axis]) + 1e-98);
}

/// Owners of a brick: 2 volumes divided at x = 2 if split, its surfaces, curves and vertices, complete.
Association brick_association(const Mesh& mesh, const Vec3& size);

/// But for what came with a file (exodus_extras_test.cpp).
inline testing::AssertionResult same_mesh(const Mesh& a, Mesh b) {
  b.results = a.results;
  b.file_hexes = a.file_hexes;
  const auto no = [](const std::string& what) { return testing::AssertionFailure() << what << " differ"; };
  if (a.points != b.points) return no("points");
  if (a.hexes != b.hexes) return no("hexes");
  if (a.node_ids != b.node_ids) return no("node ids");
  if (a.hex_ids != b.hex_ids) return no("hex ids");
  if (a.blocks.size() != b.blocks.size()) return no("numbers of blocks");
  for (std::size_t i = 0; i < a.blocks.size(); ++i)
    if (a.blocks[i] != b.blocks[i]) return no("blocks " + std::to_string(a.blocks[i].id) + " " + b.blocks[i].name);
  if (a.node_sets.size() != b.node_sets.size()) return no("numbers of node sets");
  for (std::size_t i = 0; i < a.node_sets.size(); ++i)
    if (a.node_sets[i] != b.node_sets[i]) return no("node sets " + std::to_string(a.node_sets[i].id));
  if (a.side_sets.size() != b.side_sets.size()) return no("numbers of side sets");
  for (std::size_t i = 0; i < a.side_sets.size(); ++i)
    if (a.side_sets[i] != b.side_sets[i]) return no("side sets " + std::to_string(a.side_sets[i].id));
  if (a.fields.size() != b.fields.size()) return no("numbers of fields");
  for (std::size_t i = 0; i < a.fields.size(); ++i)
    if (a.fields[i] != b.fields[i]) return no("fields " + a.fields[i].name + " and " + b.fields[i].name);
  if (!(a == b)) return no("the meshes");
  return testing::AssertionSuccess();
}

/// A mesh read from a file of numbers of 20 characters, with the points of the mesh that was written where these are as
/// near as they can be: such numbers have 14 digits at least, and are 0 below 1e-99.
inline Mesh with_exact_points(Mesh back, const Mesh& written) {
  if (back.points.size() != written.points.size()) return back;
  for (std::size_t n = 0; n < back.points.size(); ++n)
    for (int axis = 0; axis < 3; ++axis) {
      const double x = written.points[n][axis];
      if (std::abs(back.points[n][axis] - x) <= std::max(1e-13 * std::min(std::abs(x), 0.1), 1e-99))
        back.points[n][axis] = x;
    }
  return back;
}

/// Owners, curve edges, surface faces and volumes; not the parameters.
inline testing::AssertionResult same_owners(const Association& a, const Association& b) {
  const auto no = [](const char* what) { return testing::AssertionFailure() << what << " differ"; };
  if (a.node_owner.size() != b.node_owner.size()) return no("numbers of owners");
  for (std::size_t i = 0; i < a.node_owner.size(); ++i)
    if (a.node_owner[i] != b.node_owner[i])
      return no("owners") << " at " << i << ": " << to_string(a.node_owner[i]) << ", " << to_string(b.node_owner[i]);
  if (a.curve_edges != b.curve_edges || a.edge_curve != b.edge_curve) return no("curve edges");
  if (a.surface_faces != b.surface_faces || a.face_surface != b.face_surface) return no("surface faces");
  if (a.hex_volume != b.hex_volume) return no("volumes");
  return testing::AssertionSuccess();
}

/// Never a crash: a message of one line, or a mesh whose parts fit together. In slices, too.
void read_or_refuse(const std::filesystem::path& file);

/// Runs a Python script with the system's VTK; false where there is none. It may call write_all_ways(grid, name), which
/// writes .vtu files name + "Binary_1_64_0_1.vtu" ... in 48 ways: Ascii, Binary or Appended, compressed or not,
/// header, appended data encoded or not, byte order.
bool vtk_python(const std::filesystem::path& folder, const std::string& script);

}  // namespace hextwist::test
