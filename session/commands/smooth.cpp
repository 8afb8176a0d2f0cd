// smooth, and the schemes that CAD entities remember.

#include <algorithm>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/mesh/nodal_fields.h"
#include "hextwist/mesh/others.h"
#include "hextwist/mesh/periodic.h"
#include "hextwist/mesh/smooth/smooth.h"
#include "hextwist/session/commands/commands.h"
#include "hextwist/session/load.h"
#include "hextwist/sizing/levelling.h"

namespace hextwist {
namespace {

/// The scheme named in the command; nullopt: none was.
std::optional<SmoothScheme> said_scheme(const Execution& run) {
  const Command& command = run.command;
  if (!command.has("scheme")) return std::nullopt;
  for (const auto& [word, scheme] : {std::pair{"mean", SmoothScheme::mean_ratio},
                                     {"mean_ratio", SmoothScheme::mean_ratio},
                                     {"condition", SmoothScheme::condition_number},
                                     {"condition_number", SmoothScheme::condition_number},
                                     {"laplacian", SmoothScheme::laplacian},
                                     {"untangle", SmoothScheme::untangle}})
    if (command.has(word)) return scheme;
  for (const char* word : {"equipotential", "optimize", "winslow"})
    if (command.has(word)) run.note("there is no scheme '" + std::string(word) + "' here: mean ratio takes its place");
  return SmoothScheme::mean_ratio;
}

SmoothScheme scheme_of(const ModelState& state, Owner owner) {
  if (state.schemes)
    for (const auto& [of, scheme] : *state.schemes)
      if (of == owner) return scheme;
  return SmoothScheme::mean_ratio;
}

/// Positions of the targets by scheme, in the order of the schemes.
std::vector<std::pair<SmoothScheme, std::vector<Index>>> by_scheme(const Execution& run, EntityKind kind,
                                                                   const std::vector<Index>& positions) {
  const std::optional<SmoothScheme> said = said_scheme(run);
  std::vector<std::pair<SmoothScheme, std::vector<Index>>> result;
  for (const SmoothScheme scheme :
       {SmoothScheme::untangle, SmoothScheme::laplacian, SmoothScheme::condition_number, SmoothScheme::mean_ratio}) {
    std::vector<Index> own;
    for (const Index i : positions)
      if ((said           ? *said
           : is_cad(kind) ? scheme_of(run.state, {dimension(kind), i + 1})
                          : SmoothScheme::mean_ratio) == scheme)
        own.push_back(i);
    if (!own.empty()) result.emplace_back(scheme, std::move(own));
  }
  return result;
}

std::string arrow(double before, double after) {
  return short_number(before) + " -> " + short_number(after);
}

}  // namespace

void do_smooth(Execution& run) {
  const Command& command = run.command;
  SessionState& state = run.state;
  need_mesh(run, "to smooth");
  run.stage("select");
  const Item& range = *command.find("range");
  const auto targets = by_scheme(run, range.kind, run.chosen(range));
  MeshedModel meshed = *run.meshed;
  const std::shared_ptr<const Levelling> levelling = state.levelling;
  const Summary was = state.measured.shape;
  Index n_nodes = 0;
  int sweeps = 0;
  bool at_rest = true;
  run.stage("smooth");
  for (const auto& [scheme, positions] : targets) {
    SmoothOptions options;
    options.scheme = scheme;
    options.nodes = related(run.core.selector(), range.kind, positions, EntityKind::node);
    if (state.fixed_nodes) options.fixed = *state.fixed_nodes;
    if (state.periodic)
      options.fixed = union_of(sorted_unique(options.fixed),
                               periodic_nodes(meshed.mesh, meshed.association, state.periodic->pairs));
    options.fixed = with_nodes_of_others(meshed.mesh, std::move(options.fixed));
    options.keep_jumps = state.keep_jumps;
    options.fix_boundary = command.has("fixed");
    if (const Item* limit = command.find("sweeps")) options.iterations = static_cast<int>(limit->number);
    const SmoothReport report =
        smooth(meshed.mesh, meshed.association, meshed.model.get(), options, [&](const char* stage, double fraction) {
          return !run.core.callbacks.progress || run.core.callbacks.progress(stage, fraction);
        });
    if (report.stopped) throw Cancelled();
    if (report.n_nodes == 0)
      run.note("no node can move there: all are fixed or on vertices");
    else if (scheme == SmoothScheme::untangle)
      run.note("no hex is inverted: there is nothing to untangle");
    n_nodes += report.n_nodes;
    sweeps += report.sweeps;
    at_rest = at_rest && report.converged;
  }
  evaluate_where_moved(run.meshed->mesh, meshed.mesh);
  run.close_stage();
  const std::vector<Index> moved = indices_where(
      meshed.mesh.n_nodes(), [&](Index n) { return meshed.mesh.points[n] != run.meshed->mesh.points[n]; });
  replace_and_measure(run, std::move(meshed));
  state.levelling = levelling_after_move(levelling, moved, *run.meshed);
  const Summary& is = state.measured.shape;
  std::string line = text_of(command.statement) + ": " + counted(n_nodes, EntityKind::node) + ", " +
                     counted(sweeps, "sweep") + ", smallest shape " + arrow(was.min, is.min) + ", average " +
                     arrow(was.average, is.average);
  line += off_text(", ", state.measured.off_cad, state.has_cad);
  if (sweeps > 0 && !at_rest) line += "; more sweeps could still improve it";
  run.say(line + ", " + short_number(run.record().seconds.back().seconds) + " s");
}

void do_scheme(Execution& run) {
  const Item& range = *run.command.find("range");
  const SmoothScheme scheme = *said_scheme(run);
  note_ignored(run, {"free", "fixed", "beta", "cpu"});
  auto schemes = run.state.schemes ? *run.state.schemes : std::vector<std::pair<Owner, SmoothScheme>>();
  const std::vector<Index> positions = run.chosen(range);
  for (const Index i : positions) {
    const Owner owner{dimension(range.kind), i + 1};
    std::erase_if(schemes, [&](const auto& entry) { return entry.first == owner; });
    schemes.emplace_back(owner, scheme);
  }
  run.state.schemes = std::make_shared<const std::vector<std::pair<Owner, SmoothScheme>>>(std::move(schemes));
  run.say(counted(static_cast<std::int64_t>(positions.size()), range.kind) + ": 'smooth' uses " + name(scheme));
}

}  // namespace hextwist
