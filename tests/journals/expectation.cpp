#include "expectation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "hextwist/io/io.h"
#include "hextwist/mesh/corners.h"
#include "support/association_checkers.h"
#include "support/checkers.h"

namespace hextwist::test {
namespace {

using nlohmann::json;

bool occurs(const std::string& text, const std::vector<std::string>& lines) {
  return std::ranges::any_of(lines, [&](const std::string& line) { return line.find(text) != std::string::npos; });
}

void expect_texts(const json& expected, const std::vector<std::string>& lines) {
  for (const json& text : expected) {
    std::string all;
    for (const std::string& line : lines) all += "\n  " + line;
    EXPECT_TRUE(occurs(text.get<std::string>(), lines))
        << "'" << text.get<std::string>() << "' does not occur in" << all;
  }
}

/// "nodeset 3" -> number of its members, -1 if there is no such set.
std::int64_t members(const Mesh& mesh, const std::string& set) {
  std::istringstream stream(set);
  std::string kind;
  int id = 0;
  stream >> kind >> id;
  const auto size_of = [&](const auto& groups, const auto& list) -> std::int64_t {
    const auto found = std::ranges::find(groups, id, [](const auto& group) { return group.id; });
    return found == groups.end() ? -1 : static_cast<std::int64_t>(((*found).*list).size());
  };
  if (kind == "block") return size_of(mesh.blocks, &Block::hexes);
  if (kind == "nodeset") return size_of(mesh.node_sets, &NodeSet::nodes);
  if (kind == "sideset") return size_of(mesh.side_sets, &SideSet::sides);
  ADD_FAILURE() << "'" << set << "': say block, nodeset or sideset and an id";
  return -1;
}

/// Edge lengths on a curve or surface, cube roots of the volumes of the hexes in a volume.
std::vector<double> sizes_on(const MeshedModel& meshed, const std::string& entity) {
  std::istringstream stream(entity);
  std::string kind;
  int id = 0;
  stream >> kind >> id;
  const auto& [mesh, model, association] = meshed;
  std::vector<double> sizes;
  const auto add_edge = [&](Index a, Index b) { sizes.push_back((mesh.points[a] - mesh.points[b]).norm()); };
  if (kind == "curve") {
    for (std::size_t i = 0; i < association.curve_edges.size(); ++i)
      if (association.edge_curve[i] == id) add_edge(association.curve_edges[i][0], association.curve_edges[i][1]);
  } else if (kind == "surface") {
    std::set<Edge> edges;
    for (std::size_t i = 0; i < association.surface_faces.size(); ++i) {
      if (association.face_surface[i] != id) continue;
      const Side side = association.surface_faces[i];
      const Quad nodes = face_nodes(mesh.hexes[side.hex], side.face);
      for (const auto& [a, b] : {std::pair{0, 1}, {0, 2}, {1, 3}, {2, 3}})
        edges.insert({std::min(nodes[a], nodes[b]), std::max(nodes[a], nodes[b])});
    }
    for (const Edge& edge : edges) add_edge(edge[0], edge[1]);
  } else if (kind == "volume") {
    for (Index h = 0; h < mesh.n_hexes(); ++h)
      if (association.hex_volume[h] == id) sizes.push_back(std::cbrt(volume(mesh, h)));
  } else {
    ADD_FAILURE() << "'" << entity << "': sizes are those on a curve, a surface or in a volume";
  }
  EXPECT_FALSE(sizes.empty()) << entity << " has no elements";
  return sizes;
}

void expect_sizes(const MeshedModel& meshed, const json& expected) {
  const std::string on = expected.at("on");
  const double wished = expected.at("wished"), factor = expected.value("within", std::sqrt(3.0));
  const auto sizes = sizes_on(meshed, on);
  const auto n_good = std::ranges::count_if(
      sizes, [&](double size) { return size <= wished * factor * (1 + 1e-9) && size * factor * (1 + 1e-9) >= wished; });
  EXPECT_GE(static_cast<double>(n_good), expected.value("share", 1.0) * static_cast<double>(sizes.size()))
      << n_good << " of " << sizes.size() << " sizes on " << on << " are near " << wished;
  EXPECT_GE(std::ranges::min(sizes) * expected.value("finer", 3.0), wished) << "finest on " << on;
}

void expect_files(const Mesh& mesh, const json& expected) {
  for (const auto& [file, hexes] : expected.items()) {
    const MeshFile read = read_mesh(file);
    EXPECT_EQ(read.mesh.n_hexes(), hexes.is_null() ? mesh.n_hexes() : hexes.get<Index>()) << file;
    EXPECT_TRUE(uninverted(read.mesh)) << file;
  }
}

}  // namespace

void expect_number(double value, const json& expected, const std::string& what) {
  if (!expected.is_array()) {
    EXPECT_EQ(value, expected.get<double>()) << what;
    return;
  }
  EXPECT_GE(value, expected.at(0).get<double>()) << what;
  EXPECT_LE(value, expected.at(1).get<double>()) << what;
}

void expect_promises(const MeshedModel& meshed, const json& expected) {
  if (meshed.mesh.n_hexes() == 0) return;
  EXPECT_TRUE(conformal(meshed.mesh, UnusedNodes::allowed));
  EXPECT_TRUE(uninverted(meshed.mesh));
  EXPECT_TRUE(sets_valid(meshed.mesh));
  EXPECT_TRUE(on_model(meshed.mesh, meshed.association, *meshed.model, expected.value("off_cad", 1e-9)));
  EXPECT_TRUE(complete(meshed.mesh, meshed.association, *meshed.model));
}

void expect_outcome(const Outcome& outcome, const json& expected) {
  const MeshedModel& meshed = outcome.session.meshed();
  const Mesh& mesh = meshed.mesh;
  expect_promises(meshed, expected);
  const auto lowest = [&](Metric metric, const json& limit) {
    EXPECT_GE(summarize(quality(metric, mesh)).min, limit.get<double>()) << "smallest " << name(metric);
  };
  EXPECT_TRUE(expected.contains("about")) << "say what the case is for";
  if (!expected.contains("error")) {
    EXPECT_EQ(outcome.error, "");
  }
  for (const auto& [key, value] : expected.items()) {
    if (key == "about" || key == "model" || key == "off_cad" || key == "after") continue;
    if (key == "hexes") {
      expect_number(mesh.n_hexes(), value, key);
    } else if (key == "nodes") {
      expect_number(mesh.n_nodes(), value, key);
    } else if (key == "min_shape") {
      lowest(Metric::shape, value);
    } else if (key == "min_scaled_jacobian") {
      lowest(Metric::scaled_jacobian, value);
    } else if (key == "average_shape") {
      EXPECT_GE(summarize(quality(Metric::shape, mesh)).average, value.get<double>());
    } else if (key == "volume") {
      const double exact = value.at(0);
      EXPECT_NEAR(volume(mesh), exact, value.at(1).get<double>() * exact);
    } else if (key == "sets") {
      for (const auto& [set, n] : value.items()) expect_number(static_cast<double>(members(mesh, set)), n, set);
    } else if (key == "sizes") {
      for (const json& each : value) expect_sizes(meshed, each);
    } else if (key == "files") {
      expect_files(mesh, value);
    } else if (key == "prints") {
      expect_texts(value, outcome.printed);
    } else if (key == "notes") {
      expect_texts(value, outcome.notes);
    } else if (key == "error") {
      EXPECT_NE(outcome.error.find(value.at("text").get<std::string>()), std::string::npos)
          << (outcome.error.empty() ? "no error" : outcome.error);
      if (value.contains("line")) {
        EXPECT_EQ(outcome.error_line, value.at("line").get<int>()) << outcome.error;
      }
      EXPECT_EQ(mesh.n_hexes(), outcome.hexes_at_error) << "the failed command changed the mesh";
    } else {
      ADD_FAILURE() << "unknown key '" << key << "' in expect.json";
    }
  }
}

}  // namespace hextwist::test
