#include <array>
#include <cstdio>

#include "hextwist/command/session_internal.h"
#include "hextwist/mesh/quality.h"

namespace hextwist {
namespace {

template <class... Values>
std::string formatted(const char* format, Values... values) {
  std::array<char, 200> buffer;
  std::snprintf(buffer.data(), buffer.size(), format, values...);
  return buffer.data();
}

}  // namespace

void do_quality(Execution& run) {
  const Item& range = *run.command.find("range");
  if (run.state.meshed->mesh.n_hexes() == 0)
    throw error_at(run.command.statement, run.command.items.front().token, "there is no mesh");
  const std::vector<Index> hexes = related(run.core.selector(), range.kind, run.chosen(range), EntityKind::hex);
  if (hexes.empty()) throw error_at(run.command.statement, range.range.token, "no hex lies there");

  const Mesh& mesh = run.state.meshed->mesh;
  std::vector<Metric> metrics;
  const bool scaled = run.command.has("scaled") || run.command.has("scaled_jacobian");
  const bool all = run.command.has("all");
  if (all || !scaled) metrics.push_back(Metric::shape);
  if (all || scaled) metrics.push_back(Metric::scaled_jacobian);
  run.say(formatted("%-16s %9s %9s %9s %9s %10s %9s %10s", "", "count", "average", "std. dev.", "min", "(hex)", "max",
                    "(hex)"));
  for (const Metric metric : metrics) {
    const QualityRow row = quality_row(mesh, summarize(quality(metric, mesh), hexes));
    run.say(formatted("%-16s %9lld %9.4f %9.4f %9.4f %10lld %9.4f %10lld", name(metric),
                      static_cast<long long>(row.count), row.average, row.std_dev, row.min,
                      static_cast<long long>(row.min_hex), row.max, static_cast<long long>(row.max_hex)));
  }
}

}  // namespace hextwist
