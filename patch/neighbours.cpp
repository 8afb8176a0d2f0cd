#include <algorithm>
#include <iterator>
#include <numeric>

#include "hextwist/base/sorted.h"
#include "hextwist/mesh/loose_topology.h"
#include "hextwist/mesh/topology.h"
#include "hextwist/patch/neighbours.h"

namespace hextwist {

Neighbours::Neighbours(const Mesh& mesh) : n_serials_(mesh.n_hexes()) {
  CompressedRows lists = node_hexes(mesh);
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
  if (!splice.only_appends()) return false;
  const auto n_nodes = static_cast<std::size_t>(splice.n_nodes(forward));
  const auto n_new = static_cast<Index>(splice.new_hexes().size());
  std::vector<Index> fresh(static_cast<std::size_t>(n_new));
  if (forward) {
    std::vector<Index> gone;
    for (const Index h : splice.hexes().gone) gone.push_back(before_gaps(gone_, h));
    std::iota(fresh.begin(), fresh.end(), n_serials_);
    of_node_.resize(n_nodes);
    exchange(splice.gone_hexes(), gone, splice.new_hexes(), fresh);
    gone_ = union_of(gone_, gone);
    each_.push_back(std::move(gone));
    n_serials_ += n_new;
  } else {
    if (each_.empty()) return false;
    n_serials_ -= n_new;
    std::iota(fresh.begin(), fresh.end(), n_serials_);
    exchange(splice.new_hexes(), fresh, splice.gone_hexes(), each_.back());
    of_node_.resize(n_nodes);
    gone_ = difference(gone_, each_.back());
    each_.pop_back();
  }
  constexpr std::size_t small_part = 4;
  return items_.size() - n_first_items_ < n_first_items_ / small_part + 100000;
}

void Neighbours::exchange(const std::vector<Hex>& out, const std::vector<Index>& out_serials,
                          const std::vector<Hex>& in, const std::vector<Index>& in_serials) {
  // The nodes that these hexes have, each once, and where the lists of those that come in begin.
  place_.resize(std::max(place_.size(), of_node_.size()), -1);
  std::vector<Index> nodes, first_in;
  const auto count = [&](const std::vector<Hex>& hexes, Index n_each) {
    for (const Hex& hex : hexes)
      for (const Index n : hex) {
        if (place_[n] < 0) {
          place_[n] = static_cast<Index>(nodes.size());
          nodes.push_back(n);
          first_in.push_back(0);
        }
        first_in[place_[n]] += n_each;
      }
  };
  count(out, 0);
  count(in, 1);
  first_in.push_back(0);
  const std::int64_t n_in = counts_to_starts(first_in);
  std::vector<Index> serials(static_cast<std::size_t>(n_in)), next(first_in);
  for (std::size_t i = 0; i < in.size(); ++i)
    for (const Index n : in[i]) serials[next[place_[n]]++] = in_serials[i];
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    Range& range = of_node_[nodes[k]];
    const Range old = range;
    range.first = static_cast<Index>(items_.size());
    for (Index i = old.first; i < old.first + old.count; ++i)
      if (const Index serial = items_[i]; !std::ranges::binary_search(out_serials, serial)) items_.push_back(serial);
    items_.insert(items_.end(), serials.begin() + first_in[k], serials.begin() + first_in[k + 1]);
    range.count = static_cast<Index>(items_.size()) - range.first;
    place_[nodes[k]] = -1;
  }
}

}  // namespace hextwist
