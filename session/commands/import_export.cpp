// Everything that brings a mesh or a model into a session from a file, or out of it.

#include <algorithm>
#include <array>
#include <filesystem>

#include "hextwist/base/sorted.h"
#include "hextwist/geom/similarity.h"
#include "hextwist/io/io.h"
#include "hextwist/mesh/move.h"
#include "hextwist/mesh/others.h"
#include "hextwist/session/commands/commands.h"
#include "hextwist/session/levels_file.h"
#include "hextwist/session/load.h"
#include "hextwist/session/move.h"
#include "hextwist/session/periodic.h"
#include "hextwist/sizing/stages.h"

namespace hextwist {
namespace {

bool is_cad_word(std::string_view word) {
  constexpr std::array<std::string_view, 4> words = {"geometry", "step", "brep", "iges"};
  return std::ranges::find(words, word) != words.end();
}

/// What read_mesh() and write_mesh() call the format of a word.
std::string_view format_of(std::string_view word) {
  return word == "mesh" || word == "levels" ? "" : word;
}

/// Extensions that belong to a format's word; empty: any.
std::string_view extensions_of(std::string_view word, bool writing) {
  if (word == "exodus") return ".e .exo .g .gen";
  if (word == "genesis") return ".g .gen .e .exo";
  if (word == "gmsh") return ".msh";
  if (word == "vtk") return writing ? ".vtu" : ".vtk .vtu";
  if (word == "abaqus") return ".inp";
  if (word == "medit") return ".mesh";
  if (word == "mfem") return ".mesh .mfem";
  if (word == "med") return ".med";
  if (word == "cgns") return ".cgns";
  if (word == "vtkhdf") return ".vtkhdf";
  if (word == "xdmf") return ".xdmf .xmf";
  if (word == "nastran") return ".bdf .nas";
  if (word == "unv") return ".unv";
  if (word == "openfoam") return ".foam";
  if (word == "lsdyna") return ".k .key";
  if (word == "ansys") return ".cdb";
  if (word == "nek") return ".re2";
  if (word == "specfem") return ".specfem";
  if (word == "step") return ".step .stp";
  if (word == "brep") return ".brep";
  if (word == "iges") return ".iges .igs";
  return "";
}

/// A word decides, whatever the file is called; but an extension of another format is a mistake worth pointing out.
void check_extension(const Execution& run, const Item& word, const Item& file, bool writing) {
  const std::string_view known = extensions_of(word.name, writing);
  const std::string extension = lower_extension(file.text);
  if (known.empty()) return;
  const std::string padded = std::string(known) + " ";
  if (!extension.empty() && padded.find(extension + " ") != std::string::npos) return;
  const std::string all = readable_extensions() + " .step .stp .brep .iges .igs ";  // what is written is read, too
  if (!is_cad_word(word.name) && all.find(extension + " ") == std::string::npos) return;
  throw error_at(run.command.statement, file.token,
                 word.name + " files end in " + std::string(known) + " here, not in '" + printable(extension) + "'");
}

bool says_all(const Item& range) {
  const auto& [items, filters, token] = range.range;
  return items.size() == 1 && items[0].kind == RangeItem::Kind::all && filters.empty();
}

/// Only all blocks can be read.
void check_blocks(const Execution& run) {
  const Item* blocks = run.command.find("blocks");
  if (blocks && !says_all(*blocks))
    throw error_at(run.command.statement, blocks->range.token,
                   "all blocks are read together: say 'all', and 'export ... block 1' writes some");
}

std::string model_text(const Model& model) {
  std::string line;
  for (int dim = 3; dim >= 0; --dim)
    line += (dim == 3 ? "" : ", ") +
            counted(model.count(dim), static_cast<EntityKind>(static_cast<int>(EntityKind::vertex) + dim));
  return line;
}

void import_mesh(Execution& run, const std::filesystem::path& file, std::string_view word) {
  run.stage("read mesh");
  MeshFile read = read_mesh(file, format_of(word), fence_of(run));
  for (const std::string& line : read.notices) run.note(line);
  const Index n_before = run.meshed->mesh.n_hexes();
  if (const Item* factor = run.command.find("factor")) scale(read.mesh, factor->number);
  if (const std::string steps = steps_text(read.mesh); !steps.empty()) run.note(file.string() + ": " + steps);
  load_mesh(run, std::move(read.mesh), run.state.has_cad ? run.meshed->model : nullptr, &read.tags, file.string(),
            &read.middles);
  note_replaced(run, n_before);
  run.state.tags = std::make_shared<const Association>(std::move(read.tags));
  run.state.extras = read.extras.empty() ? nullptr : std::make_shared<const FileExtras>(std::move(read.extras));
  if (run.state.extras) take_periodic(run, *run.state.extras);
  say_mesh(run, file.string());
}

void import_cad(Execution& run, const std::filesystem::path& file) {
  SessionState& state = run.state;
  state.glued = state.glue == Glue::on;
  auto model = read_model(run, file, state.glued);
  if (const Item* factor = run.command.find("factor")) model = moved(*model, {.factor = factor->number});
  state.has_cad = true;
  state.cad_file = file;
  const std::string line = file.string() + ": " + model_text(*model);
  if (run.meshed->mesh.n_hexes() == 0) {
    replace_and_measure(run, {{}, std::move(model), {}});
    return run.say(line);
  }
  try {
    load_mesh(run, run.meshed->mesh, std::move(model), state.tags.get(), "the mesh");
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    throw Error(std::string(error.what()) + " ('reset' drops the mesh before other CAD is read)");
  }
  run.say(line);
  say_mesh(run, "the mesh on it");
}

/// What the words after the file ask for. Refuses what its format does not have.
WriteOptions write_options(const Execution& run, const std::string& extension) {
  WriteOptions options;
  options.overwrite = run.command.has("overwrite");
  options.extras = run.state.extras.get();
  options.format = format_of(run.command.items.at(1).name);
  if (run.state.has_cad) options.model = run.meshed->model.get();
  options.skin = run.meshed->model.get();
  options.order = run.state.order;
  if (const Item* order = run.command.find("order")) options.order = static_cast<int>(order->number);
  const bool gmsh = extension == ".msh", both = gmsh || extension == ".vtu";
  const Item& file = *run.command.find("file");
  const auto only = [&](std::string_view word, bool known, const char* formats) {
    const bool said = run.command.has(word) || run.command.find(word);
    if (said && !known)
      throw error_at(
          run.command.statement, file.token,
          "'" + std::string(word) + "' is for " + formats + " files, not for '" + printable(extension) + "'");
    return said;
  };
  only("binary", both, ".msh and .vtu");
  options.binary = !only("text", both, ".msh and .vtu");
  options.groups_only = only("groups", gmsh, ".msh");
  if (!only("version", gmsh, ".msh")) return options;
  const Item& version = *run.command.find("version");
  if (version.number != 2.2 && version.number != 4.1)
    throw error_at(run.command.statement, version.token, "versions of .msh are 2.2 and 4.1");
  options.gmsh_version = version.number == 2.2 ? 22 : 41;
  return options;
}

/// The blocks that the command names, and nothing else of the mesh.
MeshedModel chosen_blocks(Execution& run) {
  const Item& range = *run.command.find("blocks");
  const std::vector<Index> blocks = run.chosen(range);
  std::vector<Index> hexes;
  for (const Index b : blocks) {
    const std::vector<Index>& own = run.meshed->mesh.blocks[b].hexes;
    hexes.insert(hexes.end(), own.begin(), own.end());
  }
  sort_unique(hexes);
  MeshedModel part = part_of(*run.meshed, hexes);
  std::erase_if(part.mesh.blocks, [&](const Block& block) {
    return std::ranges::none_of(blocks, [&](Index b) { return run.meshed->mesh.blocks[b].id == block.id; });
  });
  const Mesh &whole = run.meshed->mesh, &mesh = part.mesh;
  const auto n_gone = std::ssize(whole.node_sets) + std::ssize(whole.side_sets) - std::ssize(mesh.node_sets) -
                      std::ssize(mesh.side_sets);
  if (whole.others) run.note("other elements are left out: " + others_text(whole));
  if (mesh.n_hexes() == whole.n_hexes() && mesh.blocks.size() == whole.blocks.size()) return part;
  std::string line = "only " + counted(std::ssize(mesh.blocks), EntityKind::block) + " of " +
                     std::to_string(whole.blocks.size()) + ": " + std::to_string(mesh.n_hexes()) + " of " +
                     counted(whole.n_hexes(), EntityKind::hex);
  if (n_gone > 0)
    line += "; " + counted(n_gone, "set") + " without members there " + (n_gone == 1 ? "is" : "are") + " left out";
  run.note(line);
  return part;
}

constexpr const char* pairs_go = "surfaces are periodic no longer: that was said of the mesh before";

}  // namespace

void do_import(Execution& run) {
  check_blocks(run);
  note_ignored(run,
               {"heal", "noheal", "no_heal", "no_geom", "attributes_on", "attributes_off", "separate_bodies", "use",
                "linear", "gradient", "quadratic", "spline", "merge", "no_merge", "merge_nodes", "unique", "start_id"});
  for (const char* word : {"no_nodeset", "no_sideset"})
    if (run.command.has(word))
      run.note("'" + std::string(word) +
               "': sets are read all the same; 'reset nodeset' or 'reset sideset' drops them");
  const double feature_angle = run.state.feature_angle;
  // Between the faces there, not by how much they turn.
  if (const Item* angle = run.command.find("angle")) run.state.feature_angle = 180 - angle->number;
  const bool snap = run.state.snap;
  if (run.command.has("snap") || run.command.has("no_snap")) run.state.snap = run.command.has("snap");
  const Item& word = run.command.items.at(1);
  const Item& file = *run.command.find("file");
  check_extension(run, word, file, false);
  check_file(run, file, is_cad_word(word.name) ? ".step .stp .brep .brp .iges .igs" : mesh_endings(false));
  if (word.name == "levels") {
    if (const Item* factor = run.command.find("factor"))
      throw error_at(run.command.statement, factor->token,
                     "levels have the size that they were written with: say 'scale' afterwards");
    run.stage("read levels");
    if (run.state.periodic) run.note(pairs_go);
    read_levels(run, file.text);
    return say_mesh(run, file.text);
  }
  const bool is_cad = is_cad_word(word.name);
  if (run.state.periodic) run.note(pairs_go);
  forget_members(run.state, is_cad || !run.state.has_cad);
  if (is_cad)
    import_cad(run, file.text);
  else
    import_mesh(run, file.text, word.name);
  run.state.feature_angle = feature_angle;
  run.state.snap = snap;
}

void do_export(Execution& run) {
  const Item& word = run.command.items.at(1);
  const Item& file = *run.command.find("file");
  check_extension(run, word, file, true);
  check_file(run, file, mesh_endings(true));
  need_mesh(run, "to export");
  const bool is_part = run.command.find("blocks") && !says_all(*run.command.find("blocks"));
  if (is_part && word.name == "levels")
    throw error_at(run.command.statement, run.command.find("blocks")->range.token,
                   "levels are written of the whole mesh");
  const MeshedModel part = is_part ? chosen_blocks(run) : MeshedModel();
  const MeshedModel& meshed = is_part ? part : *run.meshed;
  WriteOptions options = write_options(run, lower_extension(file.text));
  FileExtras extras;
  if (run.state.periodic && !is_part) {
    extras = with_periodic(options.extras, meshed, *run.state.periodic);
    options.extras = &extras;
  }
  if (run.state.periodic && word.name == "levels")
    throw Error(
        "levels of a mesh with periodic surfaces can't be written: 'periodic off' first, and then the mesh is a base");
  run.stage("write");
  if (word.name == "levels") {
    write_levels(run, file.text, run.command.has("overwrite"));
    return run.say(file.text + ": levels of " + counted(meshed.mesh.n_hexes(), EntityKind::hex) + " written");
  }
  for (const std::string& line :
       write_mesh(file.text, meshed.mesh, meshed.association.empty() ? nullptr : &meshed.association, options))
    run.note(line);
  run.say(file.text + ": " + counted(meshed.mesh.n_hexes(), EntityKind::hex) + " written");
}

}  // namespace hextwist
