#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>

#include "hextwist/mesh/quality/histogram.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/session/commands/commands.h"

namespace hextwist {
namespace {

template <class... Values>
std::string formatted(const char* format, Values... values) {
  std::array<char, 200> buffer;
  std::snprintf(buffer.data(), buffer.size(), format, values...);
  return buffer.data();
}

/// Nine places wide: four decimals where they say something.
std::string cell(double value) {
  const double size = std::abs(value);
  return formatted(size == 0 || (size >= 1e-3 && size < 999.99995) ? "%9.4f" : "%9.3g", value);
}

/// Ids as a range has them: 3, 5 to 9. Everything, however long: it was asked for.
std::string ids_text(const Mesh& mesh, std::span<const Index> hexes) {
  std::vector<std::int64_t> ids;
  for (const Index hex : hexes) ids.push_back(hex_id(mesh, hex));
  std::ranges::sort(ids);
  std::string result;
  for (std::size_t i = 0; i < ids.size();) {
    std::size_t last = i;
    while (last + 1 < ids.size() && ids[last + 1] == ids[last] + 1) ++last;
    result += (result.empty() ? "" : " ") + std::to_string(ids[i]);
    if (last > i) result += (last > i + 1 ? " to " : " ") + std::to_string(ids[last]);
    i = last + 1;
  }
  return result;
}

}  // namespace

std::vector<Metric> metrics_said(const Command& command, std::string_view option) {
  std::string words;
  bool all = false;
  for (const Item& item : command.items) {
    if (item.option != option || item.name == "quality") continue;
    words += item.name + " ";
    all |= item.name == "all" || item.name.starts_with("allmetric");
  }
  if (all) return {metrics().begin(), metrics().end()};
  // As other programs call them.
  if (words.starts_with("diagonal")) words = "diagonal";
  if (words.starts_with("condition")) words = "condition number";
  if (words.starts_with("element")) words = "volume";
  return {words.empty() ? Metric::shape : metric(words)};
}

void filter(const Command& command, std::vector<Index>& hexes, std::vector<double>& values) {
  const auto number = [&](const char* option, double otherwise) {
    for (std::size_t i = 0; i + 1 < command.items.size(); ++i)
      if (command.items[i].is_word && command.items[i].name == option) return command.items[i + 1].number;
    return otherwise;
  };
  const double low = number("low", -std::numeric_limits<double>::infinity());
  const double high = number("high", std::numeric_limits<double>::infinity());
  const double top = number("top", 0), bottom = number("bottom", 0);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < hexes.size(); ++i)
    if (values[i] >= low && values[i] <= high) order.push_back(i);
  if (top > 0 || bottom > 0) {
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return values[i]; });
    const auto n = static_cast<double>(order.size());
    std::vector<std::size_t> ends;
    for (std::size_t k = 0; k < order.size(); ++k)
      if (static_cast<double>(k) < bottom || static_cast<double>(k) >= n - top) ends.push_back(order[k]);
    order = std::move(ends);
    std::ranges::sort(order);
  }
  for (std::size_t k = 0; k < order.size(); ++k) {
    hexes[k] = hexes[order[k]];
    values[k] = values[order[k]];
  }
  hexes.resize(order.size());
  values.resize(order.size());
}

void do_quality(Execution& run) {
  const Item& range = *run.command.find("range");
  need_mesh(run, "to measure");
  const std::vector<Index> hexes = related(run.core.selector(), range.kind, run.chosen(range), EntityKind::hex);
  if (hexes.empty()) throw error_at(run.command.statement, range.range.token, "no hex lies there");

  const Mesh& mesh = run.meshed->mesh;
  run.say(formatted("%-16s %9s %9s %9s %9s %10s %9s %10s", "", "count", "average", "std. dev.", "min", "(hex)", "max",
                    "(hex)"));
  for (const Metric metric : metrics_said(run.command, "shape")) {
    std::vector<Index> kept = hexes;
    std::vector<double> values = quality(metric, mesh, hexes);
    filter(run.command, kept, values);
    if (kept.empty()) {
      run.say(formatted("%-16s %9d", name(metric), 0));
      continue;
    }
    Summary summary = summarize(values);
    summary.min_hex = kept[summary.min_hex];
    summary.max_hex = kept[summary.max_hex];
    const QualityRow row = quality_row(mesh, summary);
    run.say(formatted("%-16s %9lld %9s %9s %9s %10lld %9s %10lld", name(metric), static_cast<long long>(row.count),
                      cell(row.average).c_str(), cell(row.std_dev).c_str(), cell(row.min).c_str(),
                      static_cast<long long>(row.min_hex), cell(row.max).c_str(), static_cast<long long>(row.max_hex)));
    if (run.command.has("list")) run.say("  hex " + ids_text(mesh, kept));
    if (!run.command.has("histogram")) continue;
    std::istringstream lines(histogram(values));
    for (std::string line; std::getline(lines, line);) run.say("  " + line);
  }
}

}  // namespace hextwist
