// Which nodes can be enclosed together: closing a marking, and taking it apart.
#include <algorithm>
#include <bit>

#include "hextwist/base/union_find.h"
#include "hextwist/refine/marks.h"
#include "hextwist/refine/templates/enclose.h"

namespace hextwist {
namespace {

int n_bits(int mask) {
  return std::popcount(static_cast<unsigned>(mask));
}

/// The smallest superset with a template. Among several the unmarked nodes (compared from the highest down) decide.
int smallest_superset(const Hex& hex, int mask) {
  int best = 255;
  const auto unmarked_nodes = [&](int m) {
    std::vector<Index> nodes;
    for (int c = 0; c < 8; ++c)
      if (!(m >> c & 1)) nodes.push_back(hex[c]);
    std::ranges::sort(nodes, std::greater{});
    return nodes;
  };
  for (int m = mask; m < 256; ++m) {
    if ((m & mask) != mask || !has_enclosing_template(m)) continue;
    if (n_bits(m) < n_bits(best) || (n_bits(m) == n_bits(best) && unmarked_nodes(m) > unmarked_nodes(best))) best = m;
  }
  return best;
}

/// Corners of a mask that are joined to corner c by one of the hex's edges.
int marked_neighbours(int mask, int c) {
  return mask & (1 << (c ^ 1) | 1 << (c ^ 2) | 1 << (c ^ 4));
}

std::vector<Index> hexes_without_template(std::span<const Hex> hexes, std::span<const std::uint8_t> marked) {
  std::vector<Index> found;
  for (std::size_t h = 0; h < hexes.size(); ++h)
    if (!has_enclosing_template(corner_mask(hexes[h], marked))) found.push_back(static_cast<Index>(h));
  return found;
}

/// For each marked node the lowest node of its component, connected by edges with both ends marked.
std::vector<Index> marked_components(std::span<const Hex> hexes, std::span<const std::uint8_t> marked) {
  std::vector<Index> root = singletons(static_cast<Index>(marked.size()));
  for (const Hex& hex : hexes) {
    const int mask = corner_mask(hex, marked);
    for (int c = 0; c < 8; ++c)
      for (int axis = 0; axis < 3; ++axis)
        if (mask >> c & 1 && mask >> (c ^ 1 << axis) & 1) join(root, hex[c], hex[c ^ 1 << axis]);
  }
  for (Index n = 0; n < static_cast<Index>(root.size()); ++n) root[n] = find_root(root, n);
  return root;
}

/// The corners of a hex without a template that should go before the others: those where most marked edges meet; the
/// lowest node of them alone where they have no template together.
int meeting_corners(const Hex& hex, int mask) {
  int best = 0, most = -1;
  for (int c = 0; c < 8; ++c) {
    if (!(mask >> c & 1)) continue;
    const int n = n_bits(marked_neighbours(mask, c));
    if (n > most) best = 0;
    if (n >= most) best |= 1 << c;
    most = std::max(most, n);
  }
  if (best != mask && has_enclosing_template(best)) return best;
  int lowest = -1;
  for (int c = 0; c < 8; ++c)
    if (best >> c & 1 && (lowest < 0 || hex[c] < hex[lowest])) lowest = c;
  return 1 << lowest;
}

/// Marked nodes no two of which are in one hex.
std::vector<std::uint8_t> scattered_nodes(std::span<const Hex> hexes, std::span<const std::uint8_t> marked) {
  std::vector<std::uint8_t> part(marked.begin(), marked.end());
  for (const Hex& hex : hexes) {
    Index lowest = -1;
    for (const Index n : hex)
      if (marked[n] && (lowest < 0 || n < lowest)) lowest = n;
    for (const Index n : hex)
      if (n != lowest) part[n] = 0;
  }
  return part;
}

/// Corners that are marked with all three of their neighbours: of six or seven marked corners those on the ridges.
int ridge_corners(int mask) {
  int ridge = 0;
  for (int c = 0; c < 8; ++c)
    if (mask >> c & 1 && n_bits(marked_neighbours(mask, c)) == 3) ridge |= 1 << c;
  return ridge;
}

/// A smaller part of a marking, nearer to having templates everywhere. Where a hex has no template, the ridges between
/// marked faces go with the corners in which they end; one by one they would take a pass for every node.
std::vector<std::uint8_t> part_to_go_first(std::span<const Hex> hexes, std::span<const std::uint8_t> marked,
                                           std::span<const Index> without) {
  const std::vector<Index> component = marked_components(hexes, marked);
  std::vector<std::uint8_t> part(marked.size(), 0), whole(marked.size(), 0), has_meeting(marked.size(), 0);
  for (const Index h : without) {
    const Hex& hex = hexes[h];
    const int mask = corner_mask(hex, marked);
    Index lowest = -1, highest = -1;
    for (int c = 0; c < 8; ++c) {
      if (!(mask >> c & 1)) continue;
      lowest = lowest < 0 ? component[hex[c]] : std::min(lowest, component[hex[c]]);
      highest = std::max(highest, component[hex[c]]);
    }
    if (lowest != highest) {
      whole[lowest] = 1;
      continue;
    }
    const int first = meeting_corners(hex, mask);
    has_meeting[lowest] = 1;
    for (int c = 0; c < 8; ++c)
      if (first >> c & 1) part[hex[c]] = 1;
  }
  for (const Hex& hex : hexes) {
    const int mask = corner_mask(hex, marked);
    if (mask == 255 || n_bits(mask) < 6 || !has_enclosing_template(mask)) continue;
    const int ridge = ridge_corners(mask);
    for (int c = 0; c < 8; ++c)
      if (ridge >> c & 1 && has_meeting[component[hex[c]]]) part[hex[c]] = 1;
  }
  for (std::size_t n = 0; n < part.size(); ++n)
    if (marked[n] && whole[component[n]]) part[n] = 1;
  return part;
}

/// Grows the marks around one hex until all have templates, or undoes that where it takes more than `limit` nodes.
Index close_around(std::span<const Hex> hexes, const CompressedRows& hexes_of_node, Index start, Index limit,
                   std::span<std::uint8_t> marked) {
  std::vector<Index> added, waiting = {start};
  while (!waiting.empty()) {
    const Hex& hex = hexes[waiting.back()];
    waiting.pop_back();
    const int mask = corner_mask(hex, marked);
    if (has_enclosing_template(mask)) continue;
    const int grown = smallest_superset(hex, mask) & ~mask;
    for (int c = 0; c < 8; ++c) {
      if (!(grown >> c & 1)) continue;
      marked[hex[c]] = 1;
      added.push_back(hex[c]);
      const auto around = hexes_of_node[hex[c]];
      waiting.insert(waiting.end(), around.begin(), around.end());
    }
    if (static_cast<Index>(added.size()) > limit) {
      for (const Index n : added) marked[n] = 0;
      return 0;
    }
  }
  return static_cast<Index>(added.size());
}

}  // namespace

Index close_enclosure(std::span<const Hex> hexes, std::span<std::uint8_t> marked) {
  Index n_added = 0;
  while (true) {
    std::vector<Index> added;
    for (const Index h : hexes_without_template(hexes, marked)) {
      const int grown = smallest_superset(hexes[h], corner_mask(hexes[h], marked));
      for (int c = 0; c < 8; ++c)
        if (grown >> c & 1 && !marked[hexes[h][c]]) added.push_back(hexes[h][c]);
    }
    if (added.empty()) return n_added;
    for (const Index n : added) {
      n_added += marked[n] == 0;
      marked[n] = 1;
    }
  }
}

Index close_enclosure_nearby(const Mesh& mesh, std::span<std::uint8_t> marked, Index limit) {
  const std::vector<Index> without = hexes_without_template(mesh.hexes, marked);
  if (without.empty()) return 0;
  const CompressedRows hexes_of_node = node_hexes(mesh);
  Index n_added = 0;
  for (const Index h : without) n_added += close_around(mesh.hexes, hexes_of_node, h, limit, marked);
  return n_added;
}

std::vector<std::uint8_t> enclosable_part(std::span<const Hex> hexes, std::span<const std::uint8_t> marked) {
  std::vector<std::uint8_t> part(marked.begin(), marked.end());
  while (true) {
    const std::vector<Index> without = hexes_without_template(hexes, part);
    if (without.empty()) return part;
    std::vector<std::uint8_t> smaller = part_to_go_first(hexes, part, without);
    if (smaller == part) smaller = scattered_nodes(hexes, part);
    part = std::move(smaller);
  }
}

}  // namespace hextwist
