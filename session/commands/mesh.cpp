// mesh volume: hexes where there is only CAD.

#include <algorithm>
#include <map>

#include "hextwist/base/sorted.h"
#include "hextwist/geom/occ/model.h"
#include "hextwist/io/gmsh/pave.h"
#include "hextwist/mesh/fill/fill.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/mesh/quality/validity.h"
#include "hextwist/mesh/smooth/smooth.h"
#include "hextwist/session/commands/commands.h"
#include "hextwist/session/commands/mesh.h"
#include "hextwist/session/load.h"

namespace hextwist {
namespace {

/// Touching solids share their surfaces, else their meshes would not fit together.
std::shared_ptr<const Model> with_shared_surfaces(Execution& run) {
  SessionState& state = run.state;
  const std::shared_ptr<const Model>& model = run.meshed->model;
  if (state.glue != Glue::automatic || state.glued || state.cad_file.empty() || model->count(3) < 2) return model;
  run.stage("glue CAD");
  CadImport joined = glued(*model);
  const auto n_uses = [](const Model& of) {
    std::size_t n = 0;
    for (int dim = 0; dim < 3; ++dim)
      for (int id = 1; id <= of.count(dim); ++id)
        if (const std::size_t volumes = of.adjacent({dim, id}, 3).size()) n += volumes - 1;
    return n;
  };
  if (n_uses(*joined.model) == n_uses(*model)) return model;
  for (const std::string& line : joined.notices) run.note(line);
  run.note("touching solids are glued, so that their meshes fit together: ids of curves and surfaces are others now");
  state.glued = true;
  return joined.model;
}

/// The volumes of the range, by what they are called after the solids were glued.
std::vector<int> volumes_of(const Execution& run, const Model& model) {
  std::vector<int> ids;
  const Model& before = *run.meshed->model;
  for (const Index position : run.chosen(*run.command.find("range"))) {
    const int id = position + 1;
    if (&model == &before) {
      ids.push_back(id);
      continue;
    }
    const Box box = before.box({3, id});
    int found = 0;
    double least = 1e-3 * box.diagonal();
    for (int candidate = 1; candidate <= model.count(3); ++candidate) {
      const Box other = model.box({3, candidate});
      const double away =
          (box.min - other.min).norm() + (box.max - other.max).norm() +
          std::abs(before.measure({3, id}) - model.measure({3, candidate})) / (box.diagonal() * box.diagonal());
      if (away < least) found = candidate;
      if (away < least) least = away;
    }
    if (found == 0)
      throw Error("volume " + std::to_string(id) +
                  " is another one once touching solids are glued: say 'set glue on' before 'import'");
    ids.push_back(found);
  }
  return sorted_unique(ids);
}

/// Better shapes for the poor hexes of what was just filled.
void improve(Execution& run, MeshedModel& meshed) {
  constexpr double poor = 0.5;
  constexpr int layers = 2;
  const Mesh& mesh = meshed.mesh;
  std::vector<Index> low = hexes_below(mesh, poor);
  if (low.empty()) return;
  run.stage("smooth");
  SmoothOptions options;
  options.nodes = nodes_of_hexes(mesh, with_layers(mesh, std::move(low), layers));
  options.iterations = 50;
  if (smooth(meshed.mesh, meshed.association, meshed.model.get(), options, [&](const char* stage, double fraction) {
        return !run.core.callbacks.progress || run.core.callbacks.progress(stage, fraction);
      }).stopped)
    throw Cancelled();
}

void refuse_inverted(const MeshedModel& meshed) {
  std::map<int, Index> of_volume;
  for (const Index h : inverted_hexes(meshed.mesh)) ++of_volume[meshed.association.hex_volume[h]];
  if (of_volume.empty()) return;
  std::string text;
  for (const auto& [volume, n] : of_volume)
    text += (text.empty() ? "" : "; ") + ("volume " + std::to_string(volume)) + ": " + counted(n, EntityKind::hex) +
            " would be inverted";
  throw Error(text +
              ". Try another 'size' or 'interval', cut it in the CAD program into simpler pieces, or mesh it elsewhere "
              "and say 'import mesh'");
}

AssociateResult on_model(const Execution& run, const FillResult& filled, const Model& model,
                         std::span<const int> volumes) {
  try {
    return associate(filled.mesh, model, &filled.tags,
                     {.relative_tolerance = std::max(run.state.tolerance, AssociateOptions().relative_tolerance)});
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    std::string text;
    for (const int volume : volumes) text += (text.empty() ? "" : ", ") + std::to_string(volume);
    throw Error((volumes.size() == 1 ? "volume " : "volumes ") + text +
                ": filled as coarsely as this the mesh leaves the CAD (" + error.what() +
                "). Try a smaller 'size' or a larger 'interval', or mesh it elsewhere and say 'import mesh'");
  }
}

}  // namespace

void do_mesh(Execution& run) {
  SessionState& state = run.state;
  if (const Index n = run.meshed->mesh.n_hexes())
    throw Error("there is a mesh of " + counted(n, EntityKind::hex) + " already: " +
                (state.has_cad ? "'reset mesh' forgets it and leaves the CAD, 'refine' makes it finer"
                               : "volumes are filled where there is only CAD"));
  if (!state.has_cad)
    throw Error(
        "there is no CAD to mesh: read it ('import step \"part.step\"'), or make a solid with its mesh ('create brick "
        "x 10')");
  const std::shared_ptr<const Model> model = with_shared_surfaces(run);
  FillOptions options;
  options.volumes = volumes_of(run, *model);
  if (const Item* size = run.command.find("size")) options.size = size->number;
  if (const Item* n = run.command.find("n")) options.intervals = static_cast<int>(n->number);
  options.quads = paver_by_gmsh(find_gmsh());
  run.stage("fill volumes");
  const Interruptible interruptible = interruptible_as(run, "fill volumes");
  FillResult filled = fill_volumes(*model, options);
  for (const std::string& line : filled.notices) run.note(line);
  run.stage("associate");
  AssociateResult associated = on_model(run, filled, *model, options.volumes);
  for (const std::string& line : associated.notices) run.note(line);
  MeshedModel meshed{std::move(filled.mesh), model, std::move(associated.association)};
  improve(run, meshed);
  refuse_inverted(meshed);
  forget_members(state, model != run.meshed->model);
  state.tags = nullptr;
  state.extras = nullptr;
  load_meshed(run, std::move(meshed));
  say_mesh(run, text_of(run.command.statement));
}

}  // namespace hextwist
