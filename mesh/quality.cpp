#include "hextwist/mesh/quality.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "hextwist/mesh/hex_lanes_internal.h"
#include "hextwist/mesh/parallel_internal.h"

namespace hextwist {
namespace {

// Roots are monotone, so each metric compares powers at the corners and takes one root at the end.

template <int N>
Lanes<N> shape(const LaneHex<N>& x) {
  const LaneEdges<N> edges(x);
  std::array<std::array<Lanes<N>, 4>, 3> squares;
  for (int axis = 0; axis < 3; ++axis)
    for (int k = 0; k < 4; ++k) squares[axis][k] = edges.along[axis][k].squared();
  Lanes<N> worst = Lanes<N>::Ones();  // (shape / 3)^3, with the sign of the determinant; nothing is better than 1/27
  for (int c = 0; c < 8; ++c) {
    const Lanes<N> det = determinant(edges.at(0, c), edges.at(1, c), edges.at(2, c));
    const Lanes<N> frobenius =
        squares[0][gather_bits(0, c)] + squares[1][gather_bits(1, c)] + squares[2][gather_bits(2, c)];
    const Lanes<N> power = det * det.abs() / (frobenius * frobenius * frobenius);
    worst = worst.min((frobenius > 0).select(power, Lanes<N>::Zero()));
  }
  for (int lane = 0; lane < N; ++lane) worst[lane] = worst[lane] > 0 ? 3 * std::cbrt(worst[lane]) : 0;
  return worst;
}

template <int N>
Lanes<N> scaled_jacobian(const LaneHex<N>& x) {
  const LaneEdges<N> edges(x);
  std::array<std::array<Lanes<N>, 4>, 3> squares;
  for (int axis = 0; axis < 3; ++axis)
    for (int k = 0; k < 4; ++k) squares[axis][k] = edges.along[axis][k].squared();
  // The square of the metric, with its sign.
  const auto signed_square = [](const auto& a, const auto& b, const auto& c, const Lanes<N>& product) {
    const Lanes<N> det = determinant(a, b, c);
    return Lanes<N>((product > 0).select(det * det.abs() / product, Lanes<N>::Zero()));
  };
  std::array<LaneVec<N>, 3> centre;
  for (int axis = 0; axis < 3; ++axis) {
    const auto& e = edges.along[axis];
    centre[axis] = e[0] + e[1] + (e[2] + e[3]);
  }
  Lanes<N> worst =
      signed_square(centre[0], centre[1], centre[2], centre[0].squared() * centre[1].squared() * centre[2].squared());
  for (int c = 0; c < 8; ++c)
    worst = worst.min(
        signed_square(edges.at(0, c), edges.at(1, c), edges.at(2, c),
                      squares[0][gather_bits(0, c)] * squares[1][gather_bits(1, c)] * squares[2][gather_bits(2, c)]));
  for (int lane = 0; lane < N; ++lane)
    worst[lane] = std::copysign(std::sqrt(std::abs(worst[lane])), worst[lane]) + 0.0;  // no -0
  return worst;
}

template <int N>
Lanes<N> corner_jacobian(const LaneHex<N>& x) {
  const LaneEdges<N> edges(x);
  Lanes<N> worst = determinant(edges.at(0, 0), edges.at(1, 0), edges.at(2, 0));
  for (int c = 1; c < 8; ++c) worst = worst.min(determinant(edges.at(0, c), edges.at(1, c), edges.at(2, c)));
  return worst;
}

constexpr int n_lanes = 4;
struct Kernel {
  Lanes<1> (*one)(const LaneHex<1>&);
  Lanes<n_lanes> (*some)(const LaneHex<n_lanes>&);
};

/// A new metric is a kernel above, a line here and one in the enum, in the same order.
struct Entry {
  Metric metric;
  const char* name;
  Kernel kernel;
};
constexpr Entry table[] = {
    {Metric::shape, "shape", {shape<1>, shape<n_lanes>}},
    {Metric::scaled_jacobian, "scaled Jacobian", {scaled_jacobian<1>, scaled_jacobian<n_lanes>}},
};
constexpr Kernel corner_jacobian_kernel = {corner_jacobian<1>, corner_jacobian<n_lanes>};
constexpr std::size_t n_metrics = std::size(table);

constexpr auto metric_list = [] {
  std::array<Metric, n_metrics> list{};
  for (std::size_t i = 0; i < n_metrics; ++i) list[i] = table[i].metric;
  return list;
}();
static_assert([] {
  for (std::size_t i = 0; i < n_metrics; ++i)
    if (static_cast<std::size_t>(metric_list[i]) != i) return false;
  return true;
}());

const Entry& entry(Metric metric) {
  return table[static_cast<std::size_t>(metric)];
}

std::vector<double> evaluate(const Kernel& kernel, const Mesh& mesh) {
  std::vector<double> values(mesh.hexes.size());
  parallel_ranges(mesh.n_hexes(), [&](Index begin, Index end) {
    Index h = begin;
    for (; h + n_lanes <= end; h += n_lanes)
      Eigen::Map<Lanes<n_lanes>>(values.data() + h) = kernel.some(load<n_lanes>(mesh, h));
    for (; h < end; ++h) values[h] = kernel.one(load<1>(mesh, h))[0];
  });
  return values;
}

/// Lower-case words of a name.
std::vector<std::string> words(std::string_view text) {
  std::vector<std::string> list(1);
  for (const char c : text)
    if (c == ' ' || c == '_' || c == '-') {
      if (!list.back().empty()) list.emplace_back();
    } else {
      list.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  if (list.back().empty()) list.pop_back();
  return list;
}

/// Each word a beginning of its counterpart, trailing words left out; or all in one word.
bool is_short_for(const std::vector<std::string>& brief, const std::vector<std::string>& full) {
  if (brief.empty()) return false;
  if (brief.size() <= full.size() && std::ranges::equal(brief, std::span(full).first(brief.size()),
                                                        [](const auto& a, const auto& b) { return b.starts_with(a); }))
    return true;
  std::string joined;
  for (const std::string& word : full) joined += word;
  return brief.size() == 1 && joined.starts_with(brief[0]);
}

constexpr Index chunk_size = 4096;

/// Sum of f(i) for i in 0..n, in an order that does not depend on threads.
template <class F>
double fixed_sum(Index n, F f) {
  std::vector<double> sums(n_chunks(n, chunk_size), 0);
  parallel_chunks(n, chunk_size, [&](Index chunk, Index begin, Index end) {
    double sum = 0;
    for (Index i = begin; i < end; ++i) sum += f(i);
    sums[chunk] = sum;
  });
  double sum = 0;
  for (const double s : sums) sum += s;
  return sum;
}

template <class HexOf>
Summary summarize_by(std::span<const double> values, Index count, HexOf hex_of) {
  Summary summary;
  summary.count = count;
  if (count == 0) return summary;
  summary.average = fixed_sum(count, [&](Index i) { return values[hex_of(i)]; }) / count;
  const double squares = fixed_sum(count, [&](Index i) {
    const double d = values[hex_of(i)] - summary.average;
    return d * d;
  });
  summary.std_dev = std::sqrt(squares / count);
  summary.min_hex = summary.max_hex = hex_of(0);
  for (Index i = 1; i < count; ++i) {
    const Index h = hex_of(i);
    const double value = values[h], min = values[summary.min_hex], max = values[summary.max_hex];
    if (value < min || (value == min && h < summary.min_hex)) summary.min_hex = h;
    if (value > max || (value == max && h < summary.max_hex)) summary.max_hex = h;
  }
  summary.min = values[summary.min_hex];
  summary.max = values[summary.max_hex];
  return summary;
}

std::array<Vec3, 8> corners_of(const Mesh& mesh, Index hex) {
  std::array<Vec3, 8> corners;
  for (int c = 0; c < 8; ++c) corners[c] = mesh.points[mesh.hexes[hex][c]];
  return corners;
}

}  // namespace

const char* name(Metric metric) {
  return entry(metric).name;
}
std::span<const Metric> metrics() {
  return metric_list;
}

Metric metric(std::string_view name) {
  const auto wanted = words(name);
  std::vector<const Entry*> fitting;
  for (const Entry& e : table) {
    if (words(e.name) == wanted) return e.metric;
    if (is_short_for(wanted, words(e.name))) fitting.push_back(&e);
  }
  if (fitting.size() == 1) return fitting[0]->metric;
  std::string known;
  for (const Entry& e : table)
    if (fitting.empty() || std::ranges::count(fitting, &e)) known += (known.empty() ? "" : ", ") + std::string(e.name);
  throw Error((fitting.empty() ? "unknown" : "ambiguous") + std::string(" quality metric '") + std::string(name) +
              "': " + (fitting.empty() ? "known are " : "could be ") + known);
}

double quality(Metric metric, std::span<const Vec3, 8> corners) {
  return entry(metric).kernel.one(load(corners))[0];
}
double quality(Metric metric, const Mesh& mesh, Index hex) {
  return quality(metric, corners_of(mesh, hex));
}
std::vector<double> quality(Metric metric, const Mesh& mesh) {
  return evaluate(entry(metric).kernel, mesh);
}

Summary summarize(std::span<const double> values) {
  return summarize_by(values, static_cast<Index>(values.size()), [](Index i) { return i; });
}
Summary summarize(std::span<const double> values, std::span<const Index> hexes) {
  return summarize_by(values, static_cast<Index>(hexes.size()), [&](Index i) { return hexes[i]; });
}

double min_corner_jacobian(std::span<const Vec3, 8> corners) {
  return corner_jacobian(load(corners))[0];
}
double min_corner_jacobian(const Mesh& mesh, Index hex) {
  return min_corner_jacobian(corners_of(mesh, hex));
}
std::vector<double> min_corner_jacobian(const Mesh& mesh) {
  return evaluate(corner_jacobian_kernel, mesh);
}

}  // namespace hextwist
