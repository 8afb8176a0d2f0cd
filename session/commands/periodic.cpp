// periodic: surfaces that repeat others, from commands and from files.

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

#include "hextwist/base/sorted.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/topology.h"
#include "hextwist/session/commands/commands.h"
#include "hextwist/session/periodic.h"
#include "hextwist/sizing/levelling.h"

namespace hextwist {
namespace {

std::string map_text(const PeriodicPair& pair) {
  if (pair.turn.isIdentity(0)) return "moved by " + point_text(pair.shift);
  const Eigen::AngleAxisd turn(pair.turn);
  // The point of the axis that is nearest to the origin.
  const Eigen::Matrix3d still = Eigen::Matrix3d::Identity() - pair.turn;
  const Vec3 about = still.completeOrthogonalDecomposition().solve(pair.shift);
  return "turned by " + short_number(turn.angle() * 180 / std::numbers::pi) + " degrees about " +
         point_text(turn.axis()) + " through " + point_text(about);
}

std::string text_of_pair(const MeshedModel& meshed, const PeriodicPair& pair) {
  const auto n = std::ssize(node_pairs(meshed.mesh, meshed.association, pair));
  return "surface " + std::to_string(pair.surface) + " repeats surface " + std::to_string(pair.of) + ", " +
         map_text(pair) + ": " + counted(n, "pair") + " of nodes";
}

int said_surface(const Execution& run, const char* name) {
  const Item& said = *run.command.find(name);
  const int most = run.meshed->model ? run.meshed->model->count(2) : 0;
  if (said.number < 1 || said.number > most)
    throw error_at(
        run.command.statement, said.token,
        "there is no surface " + short_number(said.number, 12) + " (there are " + std::to_string(most) + ")");
  return static_cast<int>(said.number);
}

}  // namespace

void add_periodic(Transaction& run, const PeriodicPair& pair) {
  PeriodicBoundary all = run.state.periodic ? *run.state.periodic : PeriodicBoundary();
  if (pair.of == pair.surface) throw Error("a surface does not repeat itself");
  for (const PeriodicPair& known : all.pairs)
    if (known.surface == pair.surface || known.of == pair.surface || known.surface == pair.of)
      throw Error("surface " + std::to_string(known.surface) + " repeats surface " + std::to_string(known.of) +
                  " already: a surface repeats one other, which repeats none");
  static_cast<void>(node_pairs(run.meshed->mesh, run.meshed->association, pair, periodic_tolerance(run.meshed->mesh)));
  all.pairs.push_back(pair);
  run.state.periodic = std::make_shared<const PeriodicBoundary>(std::move(all));
}

void do_periodic(Execution& run) {
  const Command& command = run.command;
  need_mesh(run, "with surfaces that repeat others");
  if (command.has("off")) {
    if (!run.state.periodic) return run.say("no surface is periodic");
    run.state.periodic = nullptr;
    return run.say("no surface is periodic any more");
  }
  const int of = said_surface(run, "first"), surface = said_surface(run, "second");
  PeriodicPair pair{.of = of, .surface = surface};
  if (of == surface)
    throw error_at(command.statement, command.find("second")->token, "a surface does not repeat itself");
  if (command.find("dx")) {
    pair.shift = {command.find("dx")->number, command.find("dy")->number, command.find("dz")->number};
  } else if (command.find("degrees")) {
    const Similarity turn = said_rotation(command);
    pair.turn = turn.turn;
    pair.shift = turn.shift;
  } else {
    pair = find_periodic_pair(run.meshed->mesh, run.meshed->association, of, surface);
  }
  add_periodic(run, pair);
  if (run.state.levelling && !run.state.levelling->forest.is_bare())
    run.note("levels end here: this mesh is the base of what is refined from now on");
  run.state.levelling = nullptr;
  run.say(text_of_pair(*run.meshed, pair));
}

void list_periodic(Execution& run) {
  if (!run.state.periodic) return run.say("no surface is periodic");
  for (const PeriodicPair& pair : run.state.periodic->pairs) run.say(text_of_pair(*run.meshed, pair));
}

namespace {

/// The surface on which most faces lie whose nodes are all among these (ascending); 0: none.
int surface_of_nodes(const MeshedModel& meshed, const std::vector<Index>& nodes) {
  std::vector<std::int64_t> n(static_cast<std::size_t>(meshed.model ? meshed.model->count(2) + 1 : 1), 0);
  const Association& association = meshed.association;
  for (std::size_t i = 0; i < association.surface_faces.size(); ++i) {
    const Side& side = association.surface_faces[i];
    const Quad quad = face_nodes(meshed.mesh.hexes[side.hex], side.face);
    if (std::ranges::all_of(quad, [&](Index node) { return std::ranges::binary_search(nodes, node); }))
      ++n[static_cast<std::size_t>(association.face_surface[i])];
  }
  const auto most = std::ranges::max_element(n);
  return *most == 0 ? 0 : static_cast<int>(most - n.begin());
}

}  // namespace

void take_periodic(Transaction& run, const FileExtras& extras) {
  const MeshedModel& meshed = *run.meshed;
  for (const PeriodicPairs& link : extras.periodic) {
    if (link.dim != 2) continue;
    std::vector<Index> images, nodes;
    for (const auto& [image, node] : link.nodes) {
      images.push_back(find_node(meshed.mesh, image));
      nodes.push_back(find_node(meshed.mesh, node));
    }
    sort_unique(images);
    sort_unique(nodes);
    try {
      const int surface = surface_of_nodes(meshed, images), of = surface_of_nodes(meshed, nodes);
      if (surface == 0 || of == 0) throw Error("their nodes are not all of one surface each");
      PeriodicPair pair{.of = of, .surface = surface};
      if (link.affine.size() == 16) {
        for (int row = 0; row < 3; ++row) {
          for (int column = 0; column < 3; ++column)
            pair.turn(row, column) = link.affine[static_cast<std::size_t>(4 * row + column)];
          pair.shift[row] = link.affine[static_cast<std::size_t>(4 * row + 3)];
        }
        if (!(pair.turn * pair.turn.transpose()).isIdentity(1e-6)) throw Error("their map is not rigid");
      } else {
        pair = find_periodic_pair(meshed.mesh, meshed.association, of, surface);
      }
      add_periodic(run, pair);
    } catch (const Error& error) {
      run.note("surfaces " + std::to_string(link.of) + " and " + std::to_string(link.entity) +
               " of the file are periodic there, but are not kept alike here: " + error.what());
    }
  }
  if (run.state.periodic)
    run.note(counted(std::ssize(run.state.periodic->pairs), "pair") +
             " of periodic surfaces: refinement keeps both sides alike ('list periodic'; 'periodic off' lets them go)");
}

FileExtras with_periodic(const FileExtras* extras, const MeshedModel& meshed, const PeriodicBoundary& periodic) {
  FileExtras result = extras ? *extras : FileExtras();
  std::vector<PeriodicPairs> said;
  const Mesh& mesh = meshed.mesh;
  std::vector<std::int64_t> images;  // ids
  for (const PeriodicPair& pair : periodic.pairs) {
    PeriodicPairs whole{.dim = 2, .entity = pair.surface, .of = pair.of, .affine = {}, .nodes = {}};
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) whole.affine.push_back(pair.turn(row, column));
      whole.affine.push_back(pair.shift[row]);
    }
    whole.affine.insert(whole.affine.end(), {0, 0, 0, 1});
    // Curves and vertices around them: by the owners of their nodes.
    std::vector<PeriodicPairs> around;
    for (const auto& [node, image] : node_pairs(mesh, meshed.association, pair)) {
      const std::array<std::int64_t, 2> ids = {node_id(mesh, image), node_id(mesh, node)};
      whole.nodes.push_back(ids);
      images.push_back(ids[0]);
      const Owner from = meshed.association.node_owner[node], to = meshed.association.node_owner[image];
      if (from.dim != to.dim || from.dim > 1 || from.dim < 0 || from == to) continue;
      const auto same = [&](const PeriodicPairs& p) { return p.dim == to.dim && p.entity == to.id && p.of == from.id; };
      auto at = std::ranges::find_if(around, same);
      if (at == around.end())
        at = around.insert(around.end(),
                           {.dim = to.dim, .entity = to.id, .of = from.id, .affine = whole.affine, .nodes = {}});
      at->nodes.push_back(ids);
    }
    said.push_back(std::move(whole));
    for (PeriodicPairs& more : around)
      if (std::ranges::none_of(said,
                               [&](const PeriodicPairs& p) { return p.dim == more.dim && p.entity == more.entity; }))
        said.push_back(std::move(more));
  }
  sort_unique(images);
  // What the file says of others stays.
  for (const PeriodicPairs& link : result.periodic)
    if (std::ranges::any_of(link.nodes, [&](const auto& ids) { return !std::ranges::binary_search(images, ids[0]); }))
      said.push_back(link);
  std::ranges::stable_sort(said, {}, &PeriodicPairs::dim);
  result.periodic = std::move(said);
  return result;
}

}  // namespace hextwist
