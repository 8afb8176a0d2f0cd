#include "hextwist/session/load.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "hextwist/base/interrupt.h"
#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/base/union_find.h"
#include "hextwist/geom/occ/model.h"
#include "hextwist/mesh/association/check.h"
#include "hextwist/mesh/association/meant.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/mesh/nodal_fields.h"
#include "hextwist/mesh/others.h"
#include "hextwist/mesh/quality/validity.h"
#include "hextwist/mesh/validate/validate.h"
#include "hextwist/session/untangle.h"
#include "hextwist/sizing/levelling.h"
#include "hextwist/sizing/stages.h"

namespace hextwist {
namespace {

/// Pieces of a mesh that share no node.
int n_pieces(const Mesh& mesh) {
  const std::vector<Index> all = indices_where(mesh.n_hexes(), [](Index) { return true; });
  return static_cast<int>(connected_regions(mesh, all).size());
}

/// Pieces of a model whose volumes share no surface, curve or vertex.
int n_pieces(const Model& model) {
  std::vector<Index> parent = singletons(model.count(3) + 1);
  for (int dim = 0; dim < 3; ++dim)
    for (int id = 1; id <= model.count(dim); ++id) {
      const std::vector<int> volumes = model.adjacent({dim, id}, 3);
      for (const int volume : volumes) join(parent, volumes.front(), volume);
    }
  std::set<Index> roots;
  for (int id = 1; id <= model.count(3); ++id) roots.insert(find_root(parent, id));
  return static_cast<int>(roots.size());
}

/// Curves and surfaces of the model have other ids now.
void take_other_ids(Transaction& run) {
  if (run.state.groups) run.note("groups are empty now: curves and surfaces have other ids");
  forget_members(run.state, true);
}

/// The model with its solids glued where the mesh joins more of them than the CAD does. Gaps count as touching up to
/// the tolerance within which the mesh has to lie on it, by the smallest that does it.
std::shared_ptr<const Model> glued_as_mesh(Transaction& run, const Mesh& mesh, std::shared_ptr<const Model> model) {
  SessionState& state = run.state;
  const int in_mesh = n_pieces(mesh), in_model = n_pieces(*model);
  if (in_mesh >= in_model) return model;
  run.note("the mesh joins solids that are apart in " + state.cad_file.string() + " (" + counted(in_mesh, "piece") +
           " of mesh, " + std::to_string(in_model) + " of CAD): its touching solids are glued");
  run.stage("glue CAD");
  CadImport best = glued(*model);
  int least = n_pieces(*best.model);
  const double size = model->box().diagonal();
  for (double part = 1e-7; least > in_mesh && part <= state.tolerance * (1 + 1e-9); part *= 10) {
    const double gap = part * size;
    CadImport joined = glued(*model, gap);
    const int pieces = n_pieces(*joined.model);
    if (pieces >= least || joined.model->count(3) != model->count(3)) continue;
    joined.notices.push_back("gaps up to " + short_number(gap) + " between solids are closed");
    best = std::move(joined);
    least = pieces;
  }
  for (const std::string& line : best.notices) run.note(line);
  state.glued = true;
  take_other_ids(run);
  return std::move(best.model);
}

/// Puts nodes that the file has rounded on their vertices, curves and surfaces, but for those whose hexes that would
/// turn inside out. The parameters are those of the places already.
void snap(const Transaction& run, Mesh& mesh, const Association& association, const Model& model) {
  constexpr double exact = 1e-10;  // of the model size: nothing to do
  const double least = exact * model.box().diagonal();
  std::vector<Vec3> places(mesh.points.size());
  std::vector<std::uint8_t> moves(mesh.points.size(), 0);
  parallel_each(mesh.points.size(), [&](std::size_t n) {
    const Owner owner = association.node_owner[n];
    if (owner.dim < 0 || owner.dim > 2) return;
    const Parameters at = association.node_parameters[n];
    if (owner.dim > 0 && std::isnan(at.u)) return;
    places[n] = model.point(owner, at);
    moves[n] = (places[n] - mesh.points[n]).norm() > least;
  });
  std::vector<Index> moved = indices_where(mesh.n_nodes(), [&](Index n) { return moves[n] != 0; });
  if (moved.empty()) return;
  const std::vector<Vec3> before = items_at(mesh.points, moved);
  for (const Index n : moved) mesh.points[n] = places[n];
  const std::vector<Index> around = touching_hexes(mesh.hexes, moves);
  for (;;) {
    bool any = false;
    for (const Index h : inverted_hexes(mesh, around))
      for (const Index n : mesh.hexes[h])
        if (moves[n]) {
          mesh.points[n] = before[position_in(moved, n)];
          moves[n] = 0;
          any = true;
        }
    if (!any) break;
  }
  double farthest = 0;
  Index worst = -1;
  std::int64_t n_moved = 0;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    if (!moves[moved[i]]) continue;
    ++n_moved;
    const double way = (mesh.points[moved[i]] - before[i]).norm();
    if (way > farthest) worst = moved[i];
    farthest = std::max(farthest, way);
  }
  if (worst >= 0)
    run.note(counted(n_moved, EntityKind::node) + (n_moved == 1 ? " was" : " were") +
             " put on the CAD, moved by at most " + short_number(farthest) + " (node " +
             std::to_string(node_id(mesh, worst)) + "); 'import ... no_snap' leaves them");
}

/// By the smallest tolerance that works, up to the one that was asked for: what is more than the mesh needs only takes
/// nodes for those of other curves and surfaces. Throws what associate() has to say of the largest.
AssociateResult associated_within(const Mesh& mesh, const Model& model, const Association* tags, double most,
                                  const Faces* faces) {
  const Association* usable = tags && !tags->empty() ? tags : nullptr;
  for (double tolerance = std::min(most, AssociateOptions().relative_tolerance);;
       tolerance = std::min(most, 1.5 * tolerance)) {
    std::string wrong;
    try {
      AssociateResult result = associate(mesh, model, usable, {.relative_tolerance = tolerance, .faces = faces});
      const std::vector<std::string> broken = most > AssociateOptions().relative_tolerance
                                                  ? check_association(mesh, result.association, model, tolerance)
                                                  : std::vector<std::string>();
      if (broken.empty()) return result;
      wrong = broken.front();
    } catch (const Cancelled&) {
      throw;
    } catch (const Error& error) {
      if (tolerance >= most) throw;
    }
    if (tolerance >= most) throw Error("the mesh does not lie on the model: " + wrong);
  }
}

/// On the model as it is or, where the mesh does not follow curves and surfaces that are smaller than its tolerance, on
/// what that becomes without them.
AssociateResult associated_on(Transaction& run, const Mesh& mesh, std::shared_ptr<const Model>& model,
                              const Association* tags, const Faces* faces) {
  const double length = run.state.tolerance * model->box().diagonal();
  const auto is_short = [&](int id) {
    const double own = model->measure({1, id});
    return own > 0 && own <= length;
  };
  std::string why;
  try {
    return associated_within(mesh, *model, tags, run.state.tolerance, faces);
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    why = error.what();
  }
  bool any = false;
  for (int id = 1; id <= model->count(1) && !any; ++id) any = is_short(id);
  if (!any || run.state.cad_file.empty()) throw Error(why);
  run.stage("mend CAD");
  CadImport mended = without_slivers(*model, length);
  if (mended.notices.empty()) throw Error(why);
  try {
    AssociateResult result = associated_within(mesh, *mended.model, nullptr, run.state.tolerance, faces);
    for (const std::string& line : mended.notices) run.note(line + ", as the mesh does not have them");
    take_other_ids(run);
    model = std::move(mended.model);
    return result;
  } catch (const Cancelled&) {
    throw;
  } catch (const Error&) {
    throw Error(why);
  }
}

/// On the model, or on its own skin where that is null.
MeshedModel associated(Transaction& run, Mesh mesh, std::shared_ptr<const Model> model, const Association* tags,
                       const MiddleNodes* middles, const Faces* faces) {
  const Interruptible interruptible = interruptible_as(run, "associate");
  if (!model) {
    FacetResult result =
        associate_with_own_skin(mesh, {.feature_angle = run.state.feature_angle, .middles = middles, .faces = faces});
    return {std::move(mesh), std::move(result.model), std::move(result.association)};
  }
  AssociateResult result = associated_on(run, mesh, model, tags, faces);
  for (const std::string& line : result.notices) run.note(line);
  if (run.state.snap) snap(run, mesh, result.association, *model);
  return {std::move(mesh), std::move(model), std::move(result.association)};
}

/// What the node sets are meant to hold.
void find_meant(const Transaction& run, MeshedModel& meshed) {
  std::vector<std::string> notices;
  for (NodeSet& set : meshed.mesh.node_sets) set.meant.clear();  // of another model
  find_meant_entities(meshed.mesh, meshed.association, notices);
  for (const std::string& line : notices) run.note(line);
}

}  // namespace

Interruptible interruptible_as(const Transaction& run, const char* stage) {
  return Interruptible([&run, stage] {
    const auto& progress = run.core.callbacks.progress;
    if (progress && !progress(stage, 0)) throw Cancelled();
  });
}

Fence fence_of(const Transaction& run) {
  const SessionState& state = run.state;
  const bool safe = !run.core.only_below.empty();
  Fence fence{.required = safe || state.fenced == Fenced::on,
              .seconds = state.reading_seconds,
              .megabytes = state.reading_megabytes,
              .folder = run.core.only_below};
  if (state.fenced == Fenced::off && !safe) return fence;
  fence.readers = find_readers();
  return fence;
}

std::shared_ptr<const Model> read_model(Transaction& run, const std::filesystem::path& file, bool glue) {
  run.stage("read CAD");
  const Interruptible interruptible = interruptible_as(run, "read CAD");
  CadImport read = read_cad(file, {.glue = glue, .fence = fence_of(run)});
  for (const std::string& line : read.notices) run.note(line);
  return read.model;
}

void load_mesh(Transaction& run, Mesh mesh, std::shared_ptr<const Model> model, const Association* tags,
               const std::string& what, const MiddleNodes* middles) {
  SessionState& state = run.state;
  run.stage("check mesh");
  if (mesh.n_hexes() == 0) throw Error(what + ": there are no hexes");
  Faces faces;
  const std::vector<Violation> violations = [&] {
    // Indices first: nothing else may be asked of a mesh that names nodes it does not have.
    const bool sound = std::ranges::all_of(mesh.hexes, [&](const Hex& hex) {
      return std::ranges::all_of(hex, [&](Index node) { return node >= 0 && node < mesh.n_nodes(); });
    });
    if (sound) {
      const OrientationRepair repair = repair_orientation(mesh);
      if (!repair.notice.empty()) run.note(what + ": " + repair.notice);
    }
    return validate(mesh, {.faces = &faces});
  }();
  const std::vector<Index> inverted = inverted_among(violations);
  const Mesh before = inverted.empty() ? Mesh() : mesh;
  bool tangled = !inverted.empty();
  const auto is_flat = [&] {
    constexpr double no_volume = 1e-15;  // of a cube of the mesh's size
    const double size = box(mesh).diagonal();
    return !(std::abs(volume(mesh)) > no_volume * size * size * size);
  };
  if (tangled && state.untangle && is_flat())
    throw Error(what + ": " + record_violations(run.record(), mesh, violations) +
                "; the hexes have no volume together");
  if (tangled && state.untangle) {
    run.stage("untangle");
    Association nobody;
    tangled = !untangle_near(run, mesh, nobody, nullptr, inverted, false).empty();
  }
  const std::string wrong =
      record_violations(run.record(), mesh, inverted.empty() || tangled ? violations : validate(mesh));
  if (!wrong.empty() && !(tangled && state.untangle)) throw Error(what + ": " + wrong);
  if (!run.record().warnings.empty())
    run.note(what + ": " + counted(static_cast<std::int64_t>(run.record().warnings.size()), "warning") +
             ", the first: " + run.record().warnings.front().text);

  if (const Field* level = level_field(mesh);
      level && std::ranges::any_of(level->values, [](double x) { return x != 0; }))
    run.note(what +
             ": the hex field 'level' is how often hexes were cut: levels made from here on count from this mesh");

  if (model && !state.glued && state.glue == Glue::automatic && !state.cad_file.empty() && model->count(3) > 1)
    model = glued_as_mesh(run, mesh, std::move(model));
  run.stage("associate");
  const bool on_cad = model != nullptr;
  MeshedModel result;
  try {
    if (!inverted.empty() && middles && !middles->empty() && !model) {
      run.note(what + ": its middle nodes are left out, as hexes had to be untangled");
      middles = nullptr;
    }
    result = associated(run, std::move(mesh), std::move(model), tags, middles, faces.nodes.empty() ? nullptr : &faces);
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    if (!tangled) throw Error(what + ": " + error.what());
    throw Error(what + ": " + wrong + "; untangling did not help (" + error.what() + ")");
  }
  faces = {};
  if (tangled) {
    // Nodes inside volumes were not enough: those on curves and surfaces slide too, now that these are known.
    run.stage("untangle");
    const auto still = [&] { return inverted_hexes(result.mesh); };
    if (!untangle_near(run, result.mesh, result.association, result.model.get(), still(), true).empty() && !on_cad) {
      // A fold in the skin looks like a feature of it, along which nothing can slide.
      untangle_freely(run, result.mesh, still());
      result = associated(run, std::move(result.mesh), nullptr, tags, nullptr, nullptr);
    }
    if (!still().empty() && !untangle_far(run, result.mesh, result.association, result.model.get(), still()).empty())
      throw Error(what + ": " + wrong + "; untangling did not help");
    const std::string left = record_violations(run.record(), result.mesh, validate(result.mesh));
    if (!left.empty()) throw Error(what + ": " + left + " (after untangling)");
  }
  if (!inverted.empty()) {
    evaluate_where_moved(before, result.mesh);
    run.note(what + ": " + untangled_text(result.mesh, before.points, inverted));
  }
  find_meant(run, result);
  replace_and_measure(run, std::move(result));
}

void load_meshed(Transaction& run, MeshedModel meshed) {
  run.stage("check mesh");
  const std::vector<Violation> violations = validate(meshed.mesh);
  std::string wrong = record_violations(run.record(), meshed.mesh, violations);
  if (const auto inverted = inverted_among(violations); !inverted.empty() && run.state.untangle) {
    run.stage("untangle");
    const Mesh before = meshed.mesh;
    record_violations(run.record(), meshed.mesh, {});
    const std::vector<Index> left =
        untangle_near(run, meshed.mesh, meshed.association, meshed.model.get(), inverted, true);
    if (untangle_far(run, meshed.mesh, meshed.association, meshed.model.get(), left).empty()) {
      wrong = record_violations(run.record(), meshed.mesh, validate(meshed.mesh));
      evaluate_where_moved(before, meshed.mesh);
      run.note(untangled_text(meshed.mesh, before.points, inverted));
    } else {
      wrong += "; untangling did not help";
    }
  }
  if (!wrong.empty()) throw Error(wrong);
  if (const auto broken = check_association(meshed.mesh, meshed.association, *meshed.model,
                                            std::max(run.state.tolerance, AssociateOptions().relative_tolerance));
      !broken.empty())
    throw Error(broken.front());
  find_meant(run, meshed);
  replace_and_measure(run, std::move(meshed));
}

void replace_and_measure(Transaction& run, MeshedModel meshed) {
  run.state.measured = meshed.mesh.n_hexes() > 0 ? measured(meshed) : Measured();
  run.state.cad_volume = 0;
  if (meshed.model)
    for (int id = 1; id <= meshed.model->count(3); ++id) run.state.cad_volume += meshed.model->measure({3, id});
  run.state.levelling = nullptr;
  run.replace(std::move(meshed));
}

void take_measured(Transaction& run, const Report& report) {
  run.state.measured = measured_after(report);
  run.state.tags = nullptr;
  if (report.poor.count > 0) {
    const PoorHexes& poor = report.poor;
    std::string line = counted(poor.count, "new hex", "new hexes") + (poor.count == 1 ? " has" : " have") +
                       " a scaled Jacobian below " + short_number(poor.limit) + ", the smallest " +
                       short_number(poor.smallest) + " (hex";
    for (const Index h : poor.worst) line += " " + std::to_string(hex_id(run.meshed->mesh, h));
    run.note(line + (poor.count > std::ssize(poor.worst) ? " ...)" : ")") +
             ": 'smooth', fewer cuts at once or a coarser transition ('depth', 'bias') would help");
  }
  if (report.off_nodes.empty()) return;
  const auto worst = std::ranges::max_element(report.off_nodes, {}, &OffOwner::distance);
  run.note(counted(static_cast<std::int64_t>(report.off_nodes.size()), EntityKind::node) +
           " could not be put where they belong; the worst is node " +
           std::to_string(node_id(run.meshed->mesh, worst->node)) + ", " + short_number(worst->distance) + " from " +
           to_string(worst->owner));
}

void accept_refined(Transaction& run, MeshedModel refined, const Report& report) {
  const std::string wrong = record_violations(run.record(), refined.mesh, report.violations);
  if (!wrong.empty()) throw Error("the result is refused: " + wrong);
  run.replace(std::move(refined));
  take_measured(run, report);
}

void accept_refined(Transaction& run, RefineResult result) {
  accept_refined(run, std::move(result.refined), result.report);
  take_levelling(run, std::move(result.levelling));
  const auto& fixed = run.state.fixed_nodes;
  if (!fixed || result.old_node.empty()) return;  // else nodes may be gone
  std::vector<Index> still;
  for (Index n = 0; n < run.meshed->mesh.n_nodes(); ++n)
    if (result.old_node[n] >= 0 && std::ranges::binary_search(*fixed, result.old_node[n])) still.push_back(n);
  take_fixed(run, std::move(still));
}

void take_fixed(Transaction& run, std::vector<Index> still) {
  const std::size_t n_gone = run.state.fixed_nodes->size() - still.size();
  if (n_gone > 0)
    run.note(counted(static_cast<std::int64_t>(n_gone), "fixed node") + (n_gone == 1 ? " is" : " are") +
             " gone with the hexes around");
  run.state.fixed_nodes = still.empty() ? nullptr : std::make_shared<const std::vector<Index>>(std::move(still));
}

void take_levelling(Transaction& run, std::shared_ptr<const Levelling> levelling) {
  if (levelling && levelling->forest.is_bare()) {
    run.state.levelling = nullptr;  // back at the base
    return;
  }
  if (!levelling && run.state.levelling)
    run.note("levels end here: this mesh is the base of what is refined from now on");
  run.state.levelling = std::move(levelling);
  run.keep_levels();
}

void forget_members(ModelState& state, bool also_cad) {
  state.periodic = nullptr;
  if (!state.groups || also_cad) {
    state.groups = nullptr;
    return;
  }
  std::vector<Group> groups = *state.groups;
  for (Group& group : groups)
    for (int k = 0; k < n_entity_kinds; ++k)
      if (!is_cad(static_cast<EntityKind>(k))) group.members[k].clear();
  state.groups = std::make_shared<const std::vector<Group>>(std::move(groups));
}

void note_replaced(Transaction& run, Index n_before) {
  if (n_before > 0)
    run.note("this takes the place of the mesh of " + counted(n_before, EntityKind::hex) + " that was here");
}

void say_mesh(const Transaction& run, const std::string& what) {
  const Mesh& mesh = run.meshed->mesh;
  std::string line =
      what + ": " + counted(mesh.n_hexes(), EntityKind::hex) + ", " + counted(mesh.n_nodes(), EntityKind::node);
  if (!mesh.blocks.empty()) line += ", " + counted(static_cast<std::int64_t>(mesh.blocks.size()), EntityKind::block);
  if (!mesh.node_sets.empty())
    line += ", " + counted(static_cast<std::int64_t>(mesh.node_sets.size()), EntityKind::nodeset);
  if (!mesh.side_sets.empty())
    line += ", " + counted(static_cast<std::int64_t>(mesh.side_sets.size()), EntityKind::sideset);
  if (mesh.others) line += "; beside them " + others_text(mesh);
  const Summary& shape = run.state.measured.shape;
  line += "; smallest shape " + short_number(shape.min) + " (hex " + std::to_string(hex_id(mesh, shape.min_hex)) + ")";
  run.say(line + off_text("; ", run.state.measured.off_cad, run.state.has_cad));
}

}  // namespace hextwist
