#include "corpus/same.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace hextwist::corpus {
namespace {

constexpr FileKind kinds[] = {
    {.name = "a.msh", .options = "", .group_ids = false},
    {.name = "a.msh", .options = "text", .group_ids = false},
    {.name = "a.msh", .options = "version 2.2", .group_ids = false},
    {.name = "a.msh", .options = "text version 2.2", .group_ids = false},
    {.name = "a.vtu", .options = "", .fields = true},
    {.name = "a.vtu", .options = "text", .fields = true},
    {.name = "a.e", .options = "", .fields = true},
    {.name = "a.inp", .options = "", .bits = false, .highest_id = 999999999},
    {.name = "a.mesh", .options = "", .highest_id = 0},
};

/// Files have 20 characters for a number in .inp.
bool near(const Vec3& a, const Vec3& b) {
  for (int axis = 0; axis < 3; ++axis)
    if (!(std::abs(a[axis] - b[axis]) <= std::max(1e-13 * std::abs(a[axis]), 1e-99))) return false;
  return true;
}

template <class Group, class Members>
std::string groups_differ(const char* what, const std::vector<Group>& a, const std::vector<Group>& b,
                          Members Group::*members, bool ids) {
  for (const Group& group : a) {
    if ((group.*members).empty()) continue;
    const auto other = std::ranges::find_if(b, [&](const Group& one) {
      return ids ? one.id == group.id : one.name == group.name && one.*members == group.*members;
    });
    if (other == b.end()) return std::string(what) + " " + std::to_string(group.id) + " is lost";
    if ((*other).*members != group.*members) return std::string(what) + " " + std::to_string(group.id) + " differs";
    if (other->name != group.name) return std::string(what) + " " + std::to_string(group.id) + " has another name";
  }
  for (const Group& group : b)
    if (ids && !(group.*members).empty() && std::ranges::find(a, group.id, &Group::id) == a.end())
      return std::string(what) + " " + std::to_string(group.id) + " is new";
  return {};
}

}  // namespace

std::span<const FileKind> file_kinds() {
  return kinds;
}

std::string difference(const Mesh& written, const Mesh& back, const FileKind& kind) {
  if (written.points.size() != back.points.size()) return "another number of nodes";
  for (std::size_t n = 0; n < back.points.size(); ++n)
    if (kind.bits ? written.points[n] != back.points[n] : !near(written.points[n], back.points[n]))
      return "node " + std::to_string(n) + " lies elsewhere";
  if (written.hexes != back.hexes) return "other hexes";
  if (node_id(written, written.n_nodes() - 1) <= kind.highest_id)
    for (Index n = 0; n < back.n_nodes(); ++n)
      if (node_id(written, n) != node_id(back, n)) return "another id of node " + std::to_string(n);
  if (hex_id(written, written.n_hexes() - 1) <= kind.highest_id)
    for (Index h = 0; h < back.n_hexes(); ++h)
      if (hex_id(written, h) != hex_id(back, h)) return "another id of hex " + std::to_string(h);
  std::string result = groups_differ("block", written.blocks, back.blocks, &Block::hexes, kind.group_ids);
  if (result.empty())
    result = groups_differ("node set", written.node_sets, back.node_sets, &NodeSet::nodes, kind.group_ids);
  if (result.empty())
    result = groups_differ("side set", written.side_sets, back.side_sets, &SideSet::sides, kind.group_ids);
  for (const Field& field : written.fields) {
    if (!kind.fields || !result.empty()) break;
    const auto other = std::ranges::find_if(
        back.fields, [&](const Field& one) { return one.on == field.on && one.name == field.name; });
    if (other == back.fields.end())
      result = "field " + field.name + " is lost";
    else if (other->values != field.values)
      result = "field " + field.name + " differs";
  }
  return result;
}

bool has_doubled_nodes(const Mesh& mesh) {
  std::vector<Vec3> points = mesh.points;
  std::ranges::sort(points, [](const Vec3& a, const Vec3& b) {
    return std::tuple(a.x(), a.y(), a.z()) < std::tuple(b.x(), b.y(), b.z());
  });
  const double eps = 1e-9 * box(mesh).diagonal();
  for (std::size_t i = 1; i < points.size(); ++i)
    if ((points[i] - points[i - 1]).norm() <= eps) return true;
  return false;
}

}  // namespace hextwist::corpus
