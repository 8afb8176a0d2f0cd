#include "hextwist/mesh/others.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "hextwist/base/sorted.h"
#include "hextwist/base/text.h"

namespace hextwist {
namespace {

using Ends = std::array<std::int8_t, 2>;
using Cycle = std::array<std::int8_t, 4>;

struct ShapeFacts {
  const char* name;
  int n_corners;
  std::span<const Ends> edges;
  std::span<const Cycle> faces;
};

constexpr Ends line_edges[] = {{0, 1}};
constexpr Ends triangle_edges[] = {{0, 1}, {1, 2}, {2, 0}};
constexpr Ends quad_edges[] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
constexpr Ends tetrahedron_edges[] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
constexpr Ends pyramid_edges[] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}};
constexpr Ends wedge_edges[] = {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}};
constexpr Cycle triangle_faces[] = {{0, 1, 2, -1}};
constexpr Cycle quad_faces[] = {{0, 1, 2, 3}};
constexpr Cycle tetrahedron_faces[] = {{0, 1, 3, -1}, {1, 2, 3, -1}, {0, 3, 2, -1}, {0, 2, 1, -1}};
constexpr Cycle pyramid_faces[] = {{0, 1, 4, -1}, {1, 2, 4, -1}, {2, 3, 4, -1}, {3, 0, 4, -1}, {0, 3, 2, 1}};
constexpr Cycle wedge_faces[] = {{0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}, {0, 2, 1, -1}, {3, 4, 5, -1}};

constexpr ShapeFacts other_shapes[] = {
    {"point", 1, {}, {}},
    {"line", 2, line_edges, {}},
    {"triangle", 3, triangle_edges, triangle_faces},
    {"quad", 4, quad_edges, quad_faces},
    {"tetrahedron", 4, tetrahedron_edges, tetrahedron_faces},
    {"pyramid", 5, pyramid_edges, pyramid_faces},
    {"wedge", 6, wedge_edges, wedge_faces},
    {"connector", 0, {}, {}},
};

const ShapeFacts& facts_of(OtherShape shape) {
  return other_shapes[static_cast<std::size_t>(shape)];
}

std::string plural_of_shape(OtherShape shape) {
  return shape == OtherShape::tetrahedron ? "tetrahedra" : "";
}

}  // namespace

const char* name(OtherShape shape) {
  return facts_of(shape).name;
}
int n_corners(OtherShape shape) {
  return facts_of(shape).n_corners;
}
std::span<const std::array<std::int8_t, 2>> other_edges(OtherShape shape) {
  return facts_of(shape).edges;
}
std::span<const std::array<std::int8_t, 4>> other_faces(OtherShape shape) {
  return facts_of(shape).faces;
}

OtherElementsPtr other_elements(OtherHeads heads, std::vector<Index> first, std::vector<Index> nodes) {
  const std::size_t n = heads.ids.size();
  if (n == 0) return nullptr;
  if (heads.type.size() != n || first.size() != n + 1 || first.front() != 0 || first.back() != std::ssize(nodes))
    throw Error("other elements that do not fit together");
  auto others = std::make_shared<OtherElements>();
  others->of.resize(n);
  std::iota(others->of.begin(), others->of.end(), 0);
  for (std::size_t e = 0; e < n; ++e)
    if (first[e + 1] - first[e] < heads.types[heads.type[e]].n_nodes)
      throw Error("element " + std::to_string(heads.ids[e]) + " has " + std::to_string(first[e + 1] - first[e]) +
                  " of " + std::to_string(heads.types[heads.type[e]].n_nodes) + " nodes");
  std::ranges::sort(heads.sets, {}, &OtherSet::id);
  std::ranges::sort(heads.sides, {}, &OtherSides::id);
  others->heads = std::make_shared<const OtherHeads>(std::move(heads));
  others->first = std::move(first);
  others->nodes = std::move(nodes);
  return others;
}

Index n_others(const Mesh& mesh) {
  return mesh.others ? mesh.others->size() : 0;
}

std::string others_text(const Mesh& mesh) {
  if (!mesh.others) return "";
  const OtherHeads& heads = *mesh.others->heads;
  std::vector<std::int64_t> n(heads.types.size(), 0);
  for (const Index e : mesh.others->of) ++n[heads.type[e]];
  std::vector<std::string> parts;
  for (std::size_t t = 0; t < n.size(); ++t) {
    const OtherType& type = heads.types[t];
    if (n[t] == 0) continue;
    parts.push_back(counted(n[t], name(type.shape), plural_of_shape(type.shape)) +
                    (type.name.empty() ? "" : " (" + type.name + ")"));
  }
  constexpr std::size_t most = 8;
  if (parts.size() > most) {
    const std::size_t more = parts.size() - most;
    parts.resize(most);
    parts.push_back("and " + counted(static_cast<std::int64_t>(more), "more kind"));
  }
  return joined(parts, ", ");
}

std::string other_text(const Mesh& mesh, Index element) {
  const OtherElements& others = *mesh.others;
  const OtherType& type = others.type_of(element);
  const std::int64_t file_id = others.heads->ids[others.of[element]];
  std::string text =
      (others.is_whole(element) ? "" : "a piece of ") + std::string(name(type.shape)) + " " + std::to_string(file_id);
  std::vector<std::string> more;
  if (!type.name.empty()) more.push_back(type.name);
  for (const OtherSet& set : others.heads->sets)
    if (std::ranges::binary_search(set.elements, others.of[element])) {
      const Index block = position_in(mesh.blocks, set.id, &Block::id);
      if (block < 0) continue;
      const std::string& own = mesh.blocks[block].name;
      more.push_back(own.empty() ? "block " + std::to_string(set.id) : "block '" + own + "'");
      break;
    }
  return more.empty() ? text : text + " (" + joined(more, ", ") + ")";
}

std::int64_t highest_element_id(const Mesh& mesh) {
  std::int64_t highest = mesh.hexes.empty() ? 0 : hex_id(mesh, mesh.n_hexes() - 1);
  if (mesh.others)
    for (const std::int64_t id : mesh.others->heads->ids) highest = std::max(highest, id);
  return highest;
}

Index find_other(const Mesh& mesh, std::int64_t id) {
  if (!mesh.others) return -1;
  const auto at = std::ranges::find(mesh.others->heads->ids, id);
  if (at == mesh.others->heads->ids.end()) return -1;
  const Index e = position_in(mesh.others->of, static_cast<Index>(at - mesh.others->heads->ids.begin()));
  return e >= 0 && mesh.others->is_whole(e) ? e : -1;
}

std::vector<std::uint8_t> nodes_of_others(const Mesh& mesh) {
  if (!mesh.others) return {};
  std::vector<std::uint8_t> is_theirs(mesh.points.size(), 0);
  for (const Index n : mesh.others->nodes) is_theirs[n] = 1;
  return is_theirs;
}

std::vector<Index> with_nodes_of_others(const Mesh& mesh, std::vector<Index> nodes) {
  if (!mesh.others) return nodes;
  nodes.insert(nodes.end(), mesh.others->nodes.begin(), mesh.others->nodes.end());
  return sorted_unique(std::move(nodes));
}

OtherElementsPtr renumbered(const OtherElementsPtr& others, std::span<const Index> node_now) {
  if (!others || std::ranges::all_of(others->nodes, [&](Index n) { return node_now[n] == n; })) return others;
  auto result = std::make_shared<OtherElements>(*others);
  for (Index& n : result->nodes) n = node_now[n];
  return result;
}

}  // namespace hextwist
