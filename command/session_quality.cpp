#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>

#include "hextwist/command/session_internal.h"
#include "hextwist/mesh/histogram.h"
#include "hextwist/mesh/quality.h"

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

}  // namespace

std::vector<Metric> metrics_after(const Command& command, std::string_view place) {
  std::string words;
  bool behind = false, all = false;
  for (const Item& item : command.items) {
    constexpr std::array<std::string_view, 10> options = {"histogram",  "low",  "high",   "global", "draw",
                                                          "individual", "from", "pixels", "to",     "overwrite"};
    if (behind && item.is_word && std::ranges::find(options, item.name) != options.end()) break;
    if (behind && item.is_word) words += item.name + " ";
    all |= behind && item.is_word && item.name == "all";
    behind |= item.name == place;
  }
  if (all) return {metrics().begin(), metrics().end()};
  // As other programs call them.
  if (words.starts_with("diagonal")) words = "diagonal";
  if (words.starts_with("condition")) words = "condition number";
  return {words.empty() ? Metric::shape : metric(words)};
}

void do_quality(Execution& run) {
  const Item& range = *run.command.find("range");
  if (run.state.meshed->mesh.n_hexes() == 0)
    throw error_at(run.command.statement, run.command.items.front().token, "there is no mesh");
  const std::vector<Index> hexes = related(run.core.selector(), range.kind, run.chosen(range), EntityKind::hex);
  if (hexes.empty()) throw error_at(run.command.statement, range.range.token, "no hex lies there");

  const Mesh& mesh = run.state.meshed->mesh;
  const auto limit = [&](const char* name, double otherwise) {
    const Item* said = run.command.find(name);
    return said ? said->number : otherwise;
  };
  const double low = limit("lowest", -std::numeric_limits<double>::infinity());
  const double high = limit("highest", std::numeric_limits<double>::infinity());
  run.say(formatted("%-16s %9s %9s %9s %9s %10s %9s %10s", "", "count", "average", "std. dev.", "min", "(hex)", "max",
                    "(hex)"));
  for (const Metric metric : metrics_after(run.command, "range")) {
    std::vector<double> values;
    std::vector<Index> kept;
    const auto all = quality(metric, mesh, hexes);
    for (std::size_t i = 0; i < hexes.size(); ++i)
      if (all[i] >= low && all[i] <= high) {
        values.push_back(all[i]);
        kept.push_back(hexes[i]);
      }
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
    if (!run.command.has("histogram")) continue;
    std::istringstream lines(histogram(values));
    for (std::string line; std::getline(lines, line);) run.say("  " + line);
  }
}

}  // namespace hextwist
