#include "hextwist/io/others.h"

#include <algorithm>

#include "hextwist/base/sorted.h"

namespace hextwist::io {
namespace {

/// The elements that those of the file are now.
std::span<const Index> pieces_of(const OtherElements& others, Index element, Index& first) {
  const auto [begin, end] = std::ranges::equal_range(others.of, element);
  first = static_cast<Index>(begin - others.of.begin());
  return {begin, end};
}

}  // namespace

std::vector<std::int64_t> other_ids_in_file(const Mesh& mesh, std::span<const std::int64_t> hex_ids,
                                            std::int64_t highest, const char* limit,
                                            std::vector<std::string>& notices) {
  if (!mesh.others) return {};
  const OtherElements& others = *mesh.others;
  std::vector<std::int64_t> ids(static_cast<std::size_t>(others.size()));
  std::int64_t next = highest_element_id(mesh) + 1;
  for (Index e = 0; e < others.size(); ++e) ids[e] = others.is_whole(e) ? others.id(e) : next++;
  const std::int64_t last = std::max(next - 1, highest_element_id(mesh));
  if (last <= highest && (!hex_ids.empty() || mesh.hex_ids.empty())) return ids;
  const std::int64_t first = (hex_ids.empty() ? std::int64_t{mesh.n_hexes()} : hex_ids.back()) + 1;
  if (first + others.size() - 1 > highest)
    throw Error("there are no ids for " + std::to_string(others.size()) +
                " other elements: " + std::to_string(first + others.size() - 1) + " " + limit);
  for (Index e = 0; e < others.size(); ++e) ids[e] = first + e;
  notices.push_back("element id " + std::to_string(last) + " " + limit + ": other elements are counted from " +
                    std::to_string(first) + " in the file");
  return ids;
}

std::vector<Index> others_of_block(const Mesh& mesh, int block) {
  std::vector<Index> result;
  if (!mesh.others) return result;
  const Index at = position_in(mesh.others->heads->sets, block, &OtherSet::id);
  if (at < 0) return result;
  for (const Index element : mesh.others->heads->sets[at].elements) {
    Index first = 0;
    const std::size_t n = pieces_of(*mesh.others, element, first).size();
    for (std::size_t i = 0; i < n; ++i) result.push_back(first + static_cast<Index>(i));
  }
  return result;
}

std::vector<std::pair<Index, std::string>> other_sides_of(const Mesh& mesh, int side_set) {
  std::vector<std::pair<Index, std::string>> result;
  if (!mesh.others) return result;
  const Index at = position_in(mesh.others->heads->sides, side_set, &OtherSides::id);
  if (at < 0) return result;
  const OtherSides& sides = mesh.others->heads->sides[at];
  for (std::size_t i = 0; i < sides.elements.size(); ++i) {
    Index first = 0;
    const std::size_t n = pieces_of(*mesh.others, sides.elements[i], first).size();
    for (std::size_t k = 0; k < n; ++k) result.emplace_back(first + static_cast<Index>(k), sides.sides[i]);
  }
  return result;
}

}  // namespace hextwist::io
