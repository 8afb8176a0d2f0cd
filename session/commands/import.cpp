// Everything that brings a mesh or a model into a session, or out of it.

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>

#include "hextwist/base/interrupt.h"
#include "hextwist/base/text.h"
#include "hextwist/base/union_find.h"
#include "hextwist/geom/occ/model.h"
#include "hextwist/io/io.h"
#include "hextwist/mesh/association/association.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/mesh/validate/validate.h"
#include "hextwist/session/session_internal.h"

namespace hextwist {
namespace {

/// Extensions that belong to a format's word; empty: any.
std::string_view extensions_of(std::string_view word, bool writing) {
  if (word == "exodus") return ".e .exo .g .gen";
  if (word == "genesis") return ".g .gen .e .exo";
  if (word == "gmsh") return ".msh";
  if (word == "vtk") return writing ? ".vtu" : ".vtk .vtu";
  if (word == "abaqus") return ".inp";
  if (word == "medit") return ".mesh";
  if (word == "step") return ".step .stp";
  if (word == "brep") return ".brep";
  if (word == "iges") return ".iges .igs";
  return "";
}

/// The format goes by the extension; a word that says otherwise is a mistake worth pointing out.
void check_extension(const Execution& run, const Item& word, const Item& file, bool writing) {
  const std::string_view known = extensions_of(word.name, writing);
  const std::string extension = lower_extension(file.text);
  if (known.empty()) return;
  const std::string padded = std::string(known) + " ";
  if (!extension.empty() && padded.find(extension + " ") != std::string::npos) return;
  throw error_at(run.command.statement, file.token,
                 word.name + " files end in " + std::string(known) + " here, not in '" + printable(extension) + "'");
}

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

std::shared_ptr<const Model> read_model(Execution& run, const std::filesystem::path& file, bool glue) {
  run.stage("read CAD");
  CadImport read = read_cad(file, {.glue = glue});
  for (const std::string& line : read.notices) run.note(line);
  return read.model;
}

std::string model_text(const Model& model) {
  std::string line;
  for (int dim = 3; dim >= 0; --dim)
    line += (dim == 3 ? "" : ", ") +
            counted(model.count(dim), static_cast<EntityKind>(static_cast<int>(EntityKind::vertex) + dim));
  return line;
}

void import_mesh(Execution& run, const std::filesystem::path& file) {
  run.stage("read mesh");
  MeshFile read = read_mesh(file);
  for (const std::string& line : read.notices) run.note(line);
  load_mesh(run, std::move(read.mesh), &read.tags, file.string());
  run.state.tags = std::make_shared<const Association>(std::move(read.tags));
  say_mesh(run, file.string());
}

void import_cad(Execution& run, const std::filesystem::path& file) {
  SessionState& state = run.state;
  const Mesh mesh = state.meshed->mesh;
  state.glued = state.glue == Glue::on;
  auto model = read_model(run, file, state.glued);
  state.has_cad = true;
  state.cad_file = file;
  const std::string line = file.string() + ": " + model_text(*model);
  take_meshed(state, {{}, std::move(model), {}});
  if (mesh.n_hexes() == 0) return run.say(line);
  try {
    load_mesh(run, mesh, state.tags.get(), "the mesh");
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    throw Error(std::string(error.what()) + " ('reset' drops the mesh before other CAD is read)");
  }
  run.say(line);
  say_mesh(run, "the mesh on it");
}

/// On the model, or on its own skin where that is null.
MeshedModel associated(const Execution& run, Mesh mesh, std::shared_ptr<const Model> model, const Association* tags) {
  const Interruptible interruptible([&] {
    const auto& progress = run.core.callbacks.progress;
    if (progress && !progress("associate", 0)) throw Cancelled();
  });
  if (!model) {
    FacetResult result = associate_with_own_skin(mesh, {.feature_angle = run.state.feature_angle});
    return {std::move(mesh), std::move(result.model), std::move(result.association)};
  }
  const Association* usable = tags && !tags->empty() ? tags : nullptr;
  AssociateResult result = associate(mesh, *model, usable, {.relative_tolerance = run.state.tolerance});
  for (const std::string& line : result.notices) run.note(line);
  return {std::move(mesh), std::move(model), std::move(result.association)};
}

}  // namespace

void load_mesh(Execution& run, Mesh mesh, const Association* tags, const std::string& what) {
  SessionState& state = run.state;
  run.stage("check mesh");
  if (mesh.n_hexes() == 0) throw Error(what + ": there are no hexes");
  const std::vector<Violation> violations = [&] {
    // Indices first: nothing else may be asked of a mesh that names nodes it does not have.
    const bool sound = std::ranges::all_of(mesh.hexes, [&](const Hex& hex) {
      return std::ranges::all_of(hex, [&](Index node) { return node >= 0 && node < mesh.n_nodes(); });
    });
    if (sound) {
      const OrientationRepair repair = repair_orientation(mesh);
      if (!repair.notice.empty()) run.note(what + ": " + repair.notice);
    }
    return validate(mesh);
  }();
  const std::vector<Index> inverted = inverted_among(violations);
  const std::vector<Vec3> points_before = inverted.empty() ? std::vector<Vec3>() : mesh.points;
  bool tangled = !inverted.empty();
  if (tangled && state.untangle) {
    run.stage("untangle");
    Association nobody;
    tangled = !untangle_mesh(run, mesh, nobody, nullptr, inverted, false);
  }
  const std::string wrong =
      record_violations(run.record, mesh, inverted.empty() || tangled ? violations : validate(mesh));
  if (!wrong.empty() && !(tangled && state.untangle)) throw Error(what + ": " + wrong);
  if (!run.record.warnings.empty())
    run.note(what + ": " + counted(static_cast<std::int64_t>(run.record.warnings.size()), "warning") +
             ", the first: " + run.record.warnings.front().text);

  std::shared_ptr<const Model> model = state.has_cad ? state.meshed->model : nullptr;
  if (model && !state.glued && state.glue == Glue::automatic && !state.cad_file.empty() && model->count(3) > 1) {
    const int in_mesh = n_pieces(mesh), in_model = n_pieces(*model);
    if (in_mesh < in_model) {
      run.note("the mesh joins solids that are apart in " + state.cad_file.string() + " (" + counted(in_mesh, "piece") +
               " of mesh, " + std::to_string(in_model) + " of CAD): reading it again with touching solids glued");
      model = read_model(run, state.cad_file, true);
      state.glued = true;
    }
  }
  run.stage("associate");
  MeshedModel result;
  try {
    result = associated(run, std::move(mesh), std::move(model), tags);
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    if (!tangled) throw;
    throw Error(what + ": " + wrong + "; untangling did not help (" + error.what() + ")");
  }
  if (tangled) {
    // Nodes inside volumes were not enough: those on curves and surfaces slide too, now that these are known.
    run.stage("untangle");
    if (!untangle_mesh(run, result.mesh, result.association, result.model.get(), inverted, true))
      throw Error(what + ": " + wrong + "; untangling did not help");
    run.record.violations.clear();
    run.record.warnings.clear();
    run.record.n_violations = 0;
    const std::string left = record_violations(run.record, result.mesh, validate(result.mesh));
    if (!left.empty()) throw Error(what + ": " + left + " (after untangling)");
  }
  if (!inverted.empty()) run.note(what + ": " + untangled_text(result.mesh, points_before, inverted));
  take_meshed(state, std::move(result));
}

void note_ignored(const Execution& run, std::initializer_list<const char*> words) {
  for (const char* word : words)
    if (run.command.has(word)) run.note("'" + std::string(word) + "' changes nothing here");
}

namespace {

/// Only all blocks can be read or written.
void check_blocks(const Execution& run) {
  const Item* blocks = run.command.find("blocks");
  if (!blocks) return;
  const auto& [items, filters, token] = blocks->range;
  if (items.size() != 1 || items[0].kind != RangeItem::Kind::all || !filters.empty())
    throw error_at(run.command.statement, token, "all blocks are read and written together: say 'all'");
}

}  // namespace

void do_import(Execution& run) {
  check_blocks(run);
  note_ignored(run, {"heal", "noheal", "no_heal", "no_geom", "attributes_on", "attributes_off", "separate_bodies"});
  const double feature_angle = run.state.feature_angle;
  // Between the faces there, not by how much they turn.
  if (const Item* angle = run.command.find("angle")) run.state.feature_angle = 180 - angle->number;
  const Item& word = run.command.items.at(1);
  const Item& file = *run.command.find("file");
  check_extension(run, word, file, false);
  constexpr std::array<std::string_view, 4> cad = {"geometry", "step", "brep", "iges"};
  const bool is_cad = std::ranges::find(cad, word.name) != cad.end();
  forget_members(run.state, is_cad || !run.state.has_cad);
  if (is_cad)
    import_cad(run, file.text);
  else
    import_mesh(run, file.text);
  run.state.feature_angle = feature_angle;
}

void do_export(Execution& run) {
  check_blocks(run);
  const Item& word = run.command.items.at(1);
  const Item& file = *run.command.find("file");
  check_extension(run, word, file, true);
  const MeshedModel& meshed = *run.state.meshed;
  if (meshed.mesh.n_hexes() == 0) throw Error("there is no mesh to export");
  run.stage("write");
  write_mesh(file.text, meshed.mesh, meshed.association.empty() ? nullptr : &meshed.association,
             {.overwrite = run.command.has("overwrite")});
  run.say(file.text + ": " + counted(meshed.mesh.n_hexes(), EntityKind::hex) + " written");
}

}  // namespace hextwist
