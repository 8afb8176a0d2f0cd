#include "hextwist/refine/templates/split_table.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hextwist {
namespace {

constexpr double same = 1e-9;  // in the unit cube; nodes of a template are at least a hundredth apart

bool near(const std::array<double, 2>& a, const std::array<double, 2>& b) {
  return std::abs(a[0] - b[0]) < same && std::abs(a[1] - b[1]) < same;
}

/// Point of the unit cube at (u, v) of a face.
Vec3 on_face(int face, const std::array<double, 2>& at) {
  const int axis = face >> 1;
  Vec3 p;
  p[axis] = face & 1;
  p[axis == 0 ? 1 : 0] = at[0];
  p[axis == 2 ? 1 : 2] = at[1];
  return p;
}

Vec3 on_edge(int e, double t) {
  const int c = edge_corner(e, 0);
  Vec3 p(c & 1, c >> 1 & 1, c >> 2 & 1);
  p[e >> 2] = t;
  return p;
}

/// Faces of the cube that all four nodes of a child's face lie on, -1 if none.
int face_of(const std::vector<Vec3>& points, const std::array<Index, 4>& nodes) {
  for (int f = 0; f < n_hex_faces; ++f)
    if (std::ranges::all_of(nodes, [&](Index n) { return std::abs(points[n][f >> 1] - (f & 1)) < same; })) return f;
  return -1;
}

}  // namespace

SplitTable::SplitTable(int n_codes, std::function<HexTemplate(const SplitTable&, int)> make)
    : make_(std::move(make)), entries_(n_codes), made_(n_codes) {}

const HexTemplate& SplitTable::hex(int code) const {
  if (const HexTemplate* entry = entries_[code].load(std::memory_order_acquire)) return *entry;
  const std::lock_guard lock(making_);
  if (!made_[code]) {
    made_[code] = std::make_unique<const HexTemplate>(make_(*this, code));
    entries_[code].store(made_[code].get(), std::memory_order_release);
  }
  return *made_[code];
}

std::vector<Vec3> SplitTable::positions(int code) const {
  const HexTemplate& hex_template = hex(code);
  std::vector<Vec3> result(inside_node(static_cast<int>(hex_template.inside.size())),
                           Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  for (int c = 0; c < 8; ++c) result[c] = Vec3(c & 1, c >> 1 & 1, c >> 2 & 1);
  for (int e = 0; e < n_hex_edges; ++e) {
    const auto& at = edge[hex_template.edge_code[e]].at;
    for (std::size_t s = 0; s < at.size(); ++s) result[edge_node(e, static_cast<int>(s))] = on_edge(e, at[s]);
  }
  for (int f = 0; f < n_hex_faces; ++f) {
    const auto& at = face[hex_template.face_code[f]].at;
    for (std::size_t s = 0; s < at.size(); ++s) result[face_node(f, static_cast<int>(s))] = on_face(f, at[s]);
  }
  for (std::size_t i = 0; i < hex_template.inside.size(); ++i)
    result[inside_node(static_cast<int>(i))] = hex_template.inside[i];
  return result;
}

void complete_face_patterns(SplitTable& table) {
  for (FacePattern& pattern : table.face) {
    table.max_face_nodes = std::max(table.max_face_nodes, static_cast<int>(pattern.at.size()));
    for (int symmetry = 0; symmetry < n_face_symmetries; ++symmetry) {
      const FacePattern& turned = table.face[pattern.turned[symmetry]];
      auto& slots = pattern.turned_slot[symmetry];
      slots.clear();
      for (const auto& at : pattern.at) {
        const auto image = turned_point(symmetry, at);
        const auto found = std::ranges::find_if(turned.at, [&](const auto& other) { return near(other, image); });
        if (found == turned.at.end()) throw std::logic_error("face pattern is not symmetric");
        slots.push_back(static_cast<LocalNode>(found - turned.at.begin()));
      }
    }
  }
  for (const EdgePattern& pattern : table.edge)
    table.max_edge_nodes = std::max(table.max_edge_nodes, static_cast<int>(pattern.at.size()));
}

void follow_faces(const SplitTable& table, HexTemplate& of) {
  for (const Vec3& p : of.inside) {
    const std::size_t first = of.follow.size();
    Vec3 sum = Vec3::Zero();
    for (int f = 0; f < n_hex_faces; ++f)
      for (const auto& at : table.face[of.face_code[f]].at) {
        Vec3 weight = Vec3::Constant(1 / std::pow((on_face(f, at) - p).squaredNorm(), 2));
        weight[f >> 1] = 0;  // no node leaves its face
        sum += weight;
        of.follow.push_back(weight);
      }
    for (std::size_t j = first; j < of.follow.size(); ++j)
      for (int axis = 0; axis < 3; ++axis)
        if (sum[axis] > 0) of.follow[j][axis] /= sum[axis];
  }
}

HexTemplate make_template(const SplitTable& table, const std::array<std::uint8_t, n_hex_edges>& edge_code,
                          const std::array<std::uint16_t, n_hex_faces>& face_code, const std::vector<Vec3>& points,
                          const std::vector<Hex>& hexes) {
  HexTemplate result;
  result.edge_code = edge_code;
  result.face_code = face_code;

  // Name the nodes: corner, slot of an edge, slot of a face, or inside.
  std::vector<std::pair<Vec3, LocalNode>> known;
  for (int c = 0; c < 8; ++c) known.emplace_back(Vec3(c & 1, c >> 1 & 1, c >> 2 & 1), static_cast<LocalNode>(c));
  for (int e = 0; e < n_hex_edges; ++e) {
    const auto& at = table.edge[edge_code[e]].at;
    for (std::size_t s = 0; s < at.size(); ++s)
      known.emplace_back(on_edge(e, at[s]), table.edge_node(e, static_cast<int>(s)));
  }
  for (int f = 0; f < n_hex_faces; ++f) {
    const auto& at = table.face[face_code[f]].at;
    for (std::size_t s = 0; s < at.size(); ++s)
      known.emplace_back(on_face(f, at[s]), table.face_node(f, static_cast<int>(s)));
  }
  std::vector<LocalNode> local(points.size());
  std::size_t n_named = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto found = std::ranges::find_if(known, [&](const auto& k) { return (k.first - points[i]).norm() < same; });
    if (found != known.end()) {
      local[i] = found->second;
      ++n_named;
      continue;
    }
    if (points[i].minCoeff() < same || points[i].maxCoeff() > 1 - same)
      throw std::logic_error("a template has a node on its skin that no pattern has");
    local[i] = table.inside_node(static_cast<int>(result.inside.size()));
    result.inside.push_back(points[i]);
  }
  if (n_named != known.size()) throw std::logic_error("a template lacks a node that its patterns have");

  for (const Hex& hex : hexes) {
    const auto child = static_cast<LocalNode>(result.children.size());
    auto& nodes = result.children.emplace_back();
    for (int c = 0; c < 8; ++c) nodes[c] = local[hex[c]];
    for (int f = 0; f < n_hex_faces; ++f)
      if (const int parent = face_of(points, face_nodes(hex, f)); parent >= 0)
        result.side[parent].push_back({child, static_cast<std::uint8_t>(f)});
  }
  return result;
}

}  // namespace hextwist
