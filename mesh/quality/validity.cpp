#include "hextwist/mesh/quality/validity.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

#include "hextwist/base/parallel.h"
#include "hextwist/mesh/quality/bernstein_internal.h"
#include "hextwist/mesh/quality/kernels_internal.h"
#include "hextwist/mesh/quality/quality.h"

namespace hextwist {
namespace {

constexpr double rounding = 1e-14;  // of the product above

HexVerdict judge(const LaneHex<1>& x) {
  const LaneEdges<1> edges(x);
  const Coefficients<1> all = coefficients(edges);
  BernsteinPiece<2> hex;
  for (int i = 0; i < 27; ++i) hex.coefficient[i] = all[i][0];
  HexVerdict worst{HexFault::corner, std::numeric_limits<double>::infinity(), Vec3::Zero()};
  for (int c = 0; c < 8; ++c)
    if (const double value = hex.coefficient[hex.at_corner(c)]; !(value >= worst.value))
      worst = {HexFault::corner, value, Vec3(c & 1, c >> 1 & 1, c >> 2 & 1)};
  if (!(worst.value > 0)) return worst;
  // The scaled Jacobian first: a corner that is flat by rounding is that, and not inverted nearby.
  const double scaled = scaled_jacobian_kernel.one(x, 1)[0];
  const auto inside = not_above(hex, rounding * longest_product(edges)[0]);
  if (inside && !(scaled > 0 && scaled < least_scaled_jacobian)) return {HexFault::inside, inside->value, inside->at};
  if (!(scaled >= least_scaled_jacobian)) return {HexFault::flat, scaled, worst.at};
  return {};
}

/// Valid by the quick test.
bool is_clear(const Mesh& mesh, Index hex) {
  return clearance(LaneEdges<1>(load<1>(mesh, hex)))[0] > 0;
}
bool is_valid(const Mesh& mesh, Index hex) {
  return is_clear(mesh, hex) || judge(mesh, hex).fault == HexFault::none;
}

/// f(hex) for those of begin .. end - 1 that are not valid, ascending.
template <class F>
void for_inverted(const Mesh& mesh, Index begin, Index end, F f) {
  for_lanes(begin, end, [&](auto lanes, Index h) HEXTWIST_LANE_LAMBDA {
    const LaneEdges<lanes> edges(load<lanes>(mesh, h));
    if ((affine_clearance(edges) > 0).all()) return;
    const Lanes<lanes> clear = clearance(edges);
    if ((clear > 0).all()) return;
    for (int lane = 0; lane < lanes; ++lane)
      if (!(clear[lane] > 0) && judge(mesh, h + lane).fault != HexFault::none) f(h + lane);
  });
}

/// What f(begin, end, list) puts into lists, for the hexes from `first` on, in order.
template <class F>
std::vector<Index> collect(const Mesh& mesh, Index first, F f) {
  constexpr Index size = 4096;
  const Index n = mesh.n_hexes() - first;
  std::vector<std::vector<Index>> of_chunk(n_chunks(n, size));
  parallel_chunks(n, size,
                  [&](Index chunk, Index begin, Index end) { f(first + begin, first + end, of_chunk[chunk]); });
  std::vector<Index> found;
  for (const auto& list : of_chunk) found.insert(found.end(), list.begin(), list.end());
  return found;
}

}  // namespace

HexVerdict judge(std::span<const Vec3, 8> corners) {
  return judge(load(corners));
}
HexVerdict judge(const Mesh& mesh, Index hex) {
  return judge(load<1>(mesh, hex));
}

std::vector<Index> inverted_hexes(const Mesh& mesh, Index first) {
  return collect(mesh, first, [&](Index begin, Index end, std::vector<Index>& found) {
    for_inverted(mesh, begin, end, [&](Index h) { found.push_back(h); });
  });
}

std::vector<Index> inverted_hexes(const Mesh& mesh, std::span<const Index> hexes) {
  std::vector<Index> found =
      indices_where(static_cast<Index>(hexes.size()), [&](Index i) { return !is_valid(mesh, hexes[i]); });
  for (Index& i : found) i = hexes[i];
  return found;
}

namespace {

/// Those of hex_of(0) .. hex_of(n - 1) that are below.
template <class HexOf>
std::vector<Index> below(const Mesh& mesh, double limit, Index n, const HexOf& hex_of) {
  constexpr Index size = 4096;
  std::vector<std::vector<Index>> of_chunk(n_chunks(n, size));
  parallel_chunks(n, size, [&](Index chunk, Index begin, Index end) {
    std::vector<Index>& found = of_chunk[chunk];
    for_lanes(begin, end, [&](auto lanes, Index i) HEXTWIST_LANE_LAMBDA {
      const auto x = load<lanes>(mesh, [&](int lane) { return hex_of(i + lane); });
      const Lanes<lanes> values = scaled_jacobian_of(HexCorners<lanes>(x));
      if ((values >= limit).all()) return;
      for (int lane = 0; lane < lanes; ++lane)
        if (!(values[lane] >= limit)) found.push_back(hex_of(i + lane));
    });
  });
  std::vector<Index> all;
  for (const auto& list : of_chunk) all.insert(all.end(), list.begin(), list.end());
  return all;
}

}  // namespace

std::vector<Index> hexes_below(const Mesh& mesh, double limit, Index first) {
  return below(mesh, limit, mesh.n_hexes() - first, [&](Index i) { return first + i; });
}
std::vector<Index> hexes_below(const Mesh& mesh, double limit, std::span<const Index> hexes) {
  return below(mesh, limit, static_cast<Index>(hexes.size()), [&](Index i) { return hexes[i]; });
}

bool all_valid(const Mesh& mesh) {
  std::atomic<bool> all = true;
  parallel_ranges(mesh.n_hexes(), [&](Index begin, Index end) {
    if (all.load(std::memory_order_relaxed)) for_inverted(mesh, begin, end, [&](Index) { all = false; });
  });
  return all;
}

}  // namespace hextwist
