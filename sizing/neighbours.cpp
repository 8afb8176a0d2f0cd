#include <algorithm>
#include <iterator>
#include <numeric>

#include "hextwist/mesh/topology.h"
#include "hextwist/sizing/gaps_internal.h"
#include "hextwist/sizing/neighbours_internal.h"

namespace hextwist {

Neighbours::Neighbours(const Mesh& mesh) : n_serials_(mesh.n_hexes()) {
  Lists lists = node_hexes(mesh);
  of_node_.resize(mesh.points.size());
  for (std::size_t n = 0; n < of_node_.size(); ++n) of_node_[n] = {lists.first[n], lists.first[n + 1] - lists.first[n]};
  items_ = std::move(lists.items);
  n_first_items_ = items_.size();
}

void Neighbours::hexes_at(std::span<const Index> nodes, std::vector<Index>& hexes) const {
  for (const Index n : nodes) {
    const Range range = of_node_[n];
    for (Index i = range.first; i < range.first + range.count; ++i) hexes.push_back(after_gaps(gone_, items_[i]));
  }
}

bool Neighbours::apply(const Splice& splice, bool forward) {
  const auto n_nodes = static_cast<std::size_t>(splice.n_nodes(forward));
  const auto n_new = static_cast<Index>(splice.new_hexes().size());
  std::vector<Index> fresh(static_cast<std::size_t>(n_new)), others;
  if (forward) {
    std::vector<Index> gone;
    for (const Index h : splice.gone()) gone.push_back(before_gaps(gone_, h));
    std::iota(fresh.begin(), fresh.end(), n_serials_);
    of_node_.resize(n_nodes);
    exchange(splice.gone_hexes(), gone, splice.new_hexes(), fresh);
    std::ranges::set_union(gone_, gone, std::back_inserter(others));
    each_.push_back(std::move(gone));
    n_serials_ += n_new;
  } else {
    if (each_.empty()) return false;
    n_serials_ -= n_new;
    std::iota(fresh.begin(), fresh.end(), n_serials_);
    exchange(splice.new_hexes(), fresh, splice.gone_hexes(), each_.back());
    of_node_.resize(n_nodes);
    std::ranges::set_difference(gone_, each_.back(), std::back_inserter(others));
    each_.pop_back();
  }
  gone_ = std::move(others);
  constexpr std::size_t small_part = 4;
  return items_.size() - n_first_items_ < n_first_items_ / small_part + 100000;
}

void Neighbours::exchange(const std::vector<Hex>& out, const std::vector<Index>& out_serials,
                          const std::vector<Hex>& in, const std::vector<Index>& in_serials) {
  std::vector<Index> nodes;
  for (const auto* hexes : {&out, &in})
    for (const Hex& hex : *hexes) nodes.insert(nodes.end(), hex.begin(), hex.end());
  std::ranges::sort(nodes);
  nodes.erase(std::ranges::unique(nodes).begin(), nodes.end());
  std::vector<std::pair<Index, Index>> added;  // node, serial
  for (std::size_t i = 0; i < in.size(); ++i)
    for (const Index n : in[i]) added.emplace_back(n, in_serials[i]);
  std::ranges::sort(added);
  auto next = added.begin();
  for (const Index n : nodes) {
    const Range old = of_node_[n];
    const auto first = static_cast<Index>(items_.size());
    for (Index i = old.first; i < old.first + old.count; ++i)
      if (const Index serial = items_[i]; !std::ranges::binary_search(out_serials, serial)) items_.push_back(serial);
    for (; next != added.end() && next->first == n; ++next) items_.push_back(next->second);
    of_node_[n] = {first, static_cast<Index>(items_.size()) - first};
  }
}

}  // namespace hextwist
