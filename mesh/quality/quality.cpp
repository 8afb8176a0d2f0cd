#include "hextwist/mesh/quality/quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "hextwist/base/parallel.h"
#include "hextwist/base/text.h"
#include "hextwist/mesh/quality/quality_internal.h"

namespace hextwist {
namespace {

struct Entry {
  Metric metric;
  const char* name;
  bool small_is_better;
  double ideal;
  const Kernel* kernel;
};
constexpr double none = std::numeric_limits<double>::infinity();
/// A new metric is a kernel in one of the files here, a line here and one in the enum, in the same order.
constexpr Entry table[] = {
    {Metric::shape, "shape", false, 1, &shape_kernel},
    {Metric::scaled_jacobian, "scaled Jacobian", false, 1, &scaled_jacobian_kernel},
    {Metric::mean_ratio, "mean ratio", false, 1, &mean_ratio_kernel},
    {Metric::condition_number, "condition number", true, 1, &condition_number_kernel},
    {Metric::skew, "skew", true, 0, &skew_kernel},
    {Metric::stretch, "stretch", false, 1, &stretch_kernel},
    {Metric::taper, "taper", true, 0, &taper_kernel},
    {Metric::aspect_ratio, "aspect ratio", true, 1, &aspect_ratio_kernel},
    {Metric::edge_ratio, "edge ratio", true, 1, &edge_ratio_kernel},
    {Metric::diagonal, "diagonal", false, 1, &diagonal_kernel},
    {Metric::relative_size, "relative size", false, 1, &relative_size_kernel},
    {Metric::shear, "shear", false, 1, &shear_kernel},
    {Metric::oddy, "oddy", true, 0, &oddy_kernel},
    {Metric::distortion, "distortion", false, 1, &distortion_kernel},
    {Metric::volume, "volume", false, none, &volume_kernel},
    {Metric::jacobian, "Jacobian", false, none, &jacobian_kernel},
    {Metric::dimension, "dimension", false, none, &dimension_kernel},
};
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

/// Of the hexes hex_of(0) to hex_of(n - 1).
template <class HexOf>
std::vector<double> evaluate(const Kernel& kernel, const Mesh& mesh, double average, std::size_t n,
                             const HexOf& hex_of) {
  std::vector<double> values;
  resize_for_overwrite(values, n);
  parallel_ranges(static_cast<Index>(n), [&](Index begin, Index end) {
    Index i = begin;
    for (; i + n_lanes <= end; i += n_lanes)
      kernel.some(load<n_lanes>(mesh, [&](int lane) { return hex_of(i + lane); }), average).store(values.data() + i);
    for (; i < end; ++i) values[i] = kernel.one(load<1>(mesh, hex_of(i)), average)[0];
  });
  return values;
}
std::vector<double> evaluate(const Kernel& kernel, const Mesh& mesh, double average) {
  return evaluate(kernel, mesh, average, mesh.hexes.size(), [](Index h) { return h; });
}

/// Lower-case words of a name.
std::vector<std::string> words(std::string_view text) {
  std::vector<std::string> list(1);
  for (const char c : text)
    if (c == ' ' || c == '_' || c == '-') {
      if (!list.back().empty()) list.emplace_back();
    } else {
      list.back() += lower_case(c);
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

}  // namespace

const char* name(Metric metric) {
  return entry(metric).name;
}
bool small_is_better(Metric metric) {
  return entry(metric).small_is_better;
}
double ideal(Metric metric) {
  return entry(metric).ideal;
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

double quality(Metric metric, std::span<const Vec3, 8> corners, double average) {
  return entry(metric).kernel->one(load(corners), average)[0];
}
double quality(Metric metric, const Mesh& mesh, Index hex, double average) {
  return quality(metric, corners_of(mesh, hex), average);
}
std::vector<double> quality(Metric metric, const Mesh& mesh, double average) {
  return evaluate(*entry(metric).kernel, mesh, average);
}
std::vector<double> quality(Metric metric, const Mesh& mesh) {
  return quality(metric, mesh, metric == Metric::relative_size ? average_volume(mesh) : 1);
}
std::vector<double> quality(Metric metric, const Mesh& mesh, std::span<const Index> hexes) {
  const double average = metric == Metric::relative_size ? average_volume(mesh, hexes) : 1;
  return evaluate(*entry(metric).kernel, mesh, average, hexes.size(), [&](Index i) { return hexes[i]; });
}

double average_volume(const Mesh& mesh) {
  return summarize(quality(Metric::volume, mesh)).average;
}
double average_volume(const Mesh& mesh, std::span<const Index> hexes) {
  return summarize(quality(Metric::volume, mesh, hexes)).average;
}

Summary summarize(std::span<const double> values) {
  return summarize_by(values, static_cast<Index>(values.size()), [](Index i) { return i; });
}
Summary summarize(std::span<const double> values, std::span<const Index> hexes) {
  return summarize_by(values, static_cast<Index>(hexes.size()), [&](Index i) { return hexes[i]; });
}

double min_corner_jacobian(std::span<const Vec3, 8> corners) {
  return corner_jacobian_kernel.one(load(corners), 1)[0];
}
double min_corner_jacobian(const Mesh& mesh, Index hex) {
  return min_corner_jacobian(corners_of(mesh, hex));
}
std::vector<double> min_corner_jacobian(const Mesh& mesh) {
  return evaluate(corner_jacobian_kernel, mesh, 1);
}

}  // namespace hextwist
