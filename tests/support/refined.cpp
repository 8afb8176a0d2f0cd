#include "support/refined.h"

#include "hextwist/refine/templates/trisect.h"
#include "support/meshed.h"

namespace hextwist::test {

// Here, and not with the meshes: those are also for tests of rooms that know nothing of refining.
std::string refusal(const MeshedModel& input, const Request& request) {
  try {
    refine(input, request);
  } catch (const Error& error) {
    return error.what();
  }
  return "not refused";
}

Mesh refined(const Mesh& mesh, const Split& split) {
  Mesh result;
  result.hexes = split.hexes;
  result.points.assign(split.n_nodes, Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  std::copy(mesh.points.begin(), mesh.points.end(), result.points.begin());
  const Lineage& lineage = split.lineage;
  for (const CutEdge& edge : lineage.edges) {
    const auto& at = lineage.table->edge[edge.code].at;
    for (std::size_t s = 0; s < at.size(); ++s)
      result.points[edge.first_node + s] = (1 - at[s]) * mesh.points[edge.a] + at[s] * mesh.points[edge.b];
  }
  for (const CutFace& face : lineage.faces) {
    const auto& at = lineage.table->face[face.code].at;
    for (std::size_t s = 0; s < at.size(); ++s) {
      const auto [u, v] = at[s];
      const auto p = [&](int k) { return mesh.points[face.corners[k]]; };
      result.points[face.first_node + s] = (1 - v) * ((1 - u) * p(0) + u * p(1)) + v * ((1 - u) * p(2) + u * p(3));
    }
  }
  for (const CutHex& hex : lineage.hexes) {
    const auto& inside = lineage.table->hex(hex.code).inside;
    for (std::size_t s = 0; s < inside.size(); ++s) {
      Vec3 sum = Vec3::Zero();
      for (int c = 0; c < 8; ++c) {
        double weight = 1;
        for (int axis = 0; axis < 3; ++axis) weight *= c >> axis & 1 ? inside[s][axis] : 1 - inside[s][axis];
        sum += weight * mesh.points[mesh.hexes[hex.hex][c]];
      }
      result.points[hex.first_node + s] = sum;
    }
  }
  return result;
}

std::vector<std::uint16_t> codes_of_nodes(const Mesh& mesh, const std::vector<char>& marked) {
  std::vector<std::uint16_t> codes(mesh.hexes.size());
  for (std::size_t h = 0; h < codes.size(); ++h) {
    int corners = 0;
    for (int c = 0; c < 8; ++c) corners |= (marked[mesh.hexes[h][c]] != 0) << c;
    codes[h] = static_cast<std::uint16_t>(edge_mask_of_corners(corners));
  }
  return codes;
}

}  // namespace hextwist::test
