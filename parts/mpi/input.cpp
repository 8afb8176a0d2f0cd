#include "hextwist/parts/mpi/input.h"

#include <algorithm>
#include <utility>

#include "hextwist/base/text.h"
#include "hextwist/geom/occ/model.h"
#include "hextwist/io/file_part.h"
#include "hextwist/io/io.h"
#include "hextwist/io/results.h"
#include "hextwist/mesh/association/meant.h"
#include "hextwist/mesh/nodal_fields.h"
#include "hextwist/parts/files.h"
#include "hextwist/parts/join.h"
#include "hextwist/parts/mpi/directory.h"
#include "hextwist/parts/mpi/share_out.h"
#include "hextwist/parts/own_skin.h"
#include "hextwist/parts/pack.h"
#include "hextwist/parts/shared_values.h"
#include "hextwist/parts/source.h"
#include "hextwist/session/core.h"
#include "hextwist/session/session.h"

namespace hextwist {
namespace {

/// What most files say of the whole; of what equally many say, what the first of them does.
PartHead head_of_most(Ranks& ranks, const std::vector<PartHead>& mine) {
  std::vector<std::pair<PartHead, int>> all;  // how many say so
  for (const PartHead& head : ranks.joined_everywhere(mine)) {
    const auto same = std::ranges::find(all, head, &std::pair<PartHead, int>::first);
    if (same == all.end())
      all.emplace_back(head, 1);
    else
      ++same->second;
  }
  return all.empty() ? PartHead() : std::ranges::max_element(all, {}, &std::pair<PartHead, int>::second)->first;
}

/// What the files of this split mesh say of the whole. Throws Error naming one that belongs to another mesh than most.
PartHead agreed_head(Ranks& ranks, const SplitName& split, int first, int last) {
  std::vector<PartHead> heads;
  const auto file = [&](int p) { return part_name(split.name, split.n_parts, p); };
  // Who reads all of a file says what else is wrong with it.
  const auto is_there = [&](int p) { return std::filesystem::exists(file(p)); };
  const auto is_part = [&](const PartHead& head) { return head.n_parts == split.n_parts; };
  ranks.together([&] {
    for (int p = first; p < last; ++p)
      if (is_there(p))
        if (const PartHead head = read_part_head(file(p)); is_part(head)) heads.push_back(head);
  });
  const PartHead most = head_of_most(ranks, heads);
  ranks.together([&] {
    if (std::ranges::all_of(heads, [&](const PartHead& head) { return head == most; })) return;
    for (int p = first; p < last; ++p)
      if (const PartHead head = is_there(p) ? read_part_head(file(p)) : most; is_part(head) && head != most)
        throw Error(file(p).string() + ": is part of a mesh of " + std::to_string(head.n_hexes) + " hexes and " +
                    std::to_string(head.n_nodes) + " nodes, others of one of " + std::to_string(most.n_hexes) +
                    " and " + std::to_string(most.n_nodes));
  });
  return most;
}

/// Gives nodes of several ranks the values of the lowest rank that has a number there. All have the same fields.
void settle_values_in_ranks(Ranks& ranks, Mesh& own, Disagreements& differ) {
  if (!has_nodal_fields(own)) return;
  std::vector<std::int64_t> skin;
  ranks.together([&] { skin = skin_nodes(own); });
  const std::vector<NodeAtOthers> shared = at_others(ranks, own, skin);
  const auto for_each_value = [&](Index node, const auto& use) {
    for (Field& field : own.fields) {
      if (field.on != Field::On::node) continue;
      const auto n = static_cast<std::size_t>(field.components);
      for (std::size_t c = 0; c < n; ++c) use(field, field.values[static_cast<std::size_t>(node) * n + c]);
    }
  };
  std::vector<std::vector<double>> to(static_cast<std::size_t>(ranks.size()));
  for (const NodeAtOthers& at : shared)
    for (const int other : at.parts)
      for_each_value(at.node, [&](const Field&, double value) { to[other].push_back(value); });
  const std::vector<std::vector<double>> from = ranks.exchange(to);
  std::vector<std::size_t> next(from.size(), 0);
  for (const NodeAtOthers& at : shared)
    for_each_value(at.node, [&](const Field& field, double& value) {
      bool differs = false, has_first = false;
      double kept = 0;
      const auto take = [&](double said) {
        if (has_first)
          differs = settle_value(kept, said) || differs;
        else
          kept = said;
        has_first = true;
      };
      bool is_own_taken = false;
      for (const int other : at.parts) {
        if (other > ranks.rank() && !std::exchange(is_own_taken, true)) take(value);
        take(from[other][next[other]++]);
      }
      if (!is_own_taken) take(value);
      value = kept;
      if (differs) differ[field.name].push_back(node_id(own, at.node));
    });
}

/// Of all ranks, in one line for each field.
void say_disagreements(Ranks& ranks, const Mesh& own, Disagreements mine, const std::string& name, const Say& say) {
  Disagreements all;
  for (const Field& field : own.fields)
    if (field.on == Field::On::node) all[field.name] = ranks.joined_everywhere(mine[field.name]);
  for (const std::string& line : disagreement_lines(std::move(all), name)) say(line);
}

/// The files of a split mesh that fall to this rank.
MeshedModel read_own_files(Ranks& ranks, const SplitName& split, Disagreements& differ, const Say& say) {
  MeshedModel own;
  PartHead head;
  std::vector<std::string> notices;
  const auto begin = [&](int rank) { return static_cast<int>(std::int64_t{split.n_parts} * rank / ranks.size()); };
  const std::int64_t n_hexes = agreed_head(ranks, split, begin(ranks.rank()), begin(ranks.rank() + 1)).n_hexes;
  ranks.together([&] {
    std::vector<MeshedModel> pieces;
    for (int p = begin(ranks.rank()); p < begin(ranks.rank() + 1); ++p) {
      pieces.push_back({read_one_part(split, p, head, notices, {}, PartUse::refine), nullptr, {}});
      check_part(pieces.back().mesh, part_name(split.name, split.n_parts, p).string());
    }
    std::shared_ptr<const FileResults> results;
    for (const MeshedModel& piece : pieces) join_results(results, piece.mesh.results);
    differ = settle_values(pieces);
    if (pieces.size() == 1)
      own = std::move(pieces[0]);
    else if (!pieces.empty())
      own = join(pieces, [&](std::size_t i) {
        return part_name(split.name, split.n_parts, begin(ranks.rank()) + static_cast<int>(i)).string();
      });
    need_ids(own.mesh);
    own.mesh.results = results;
  });
  if (const std::int64_t n = ranks.sum(own.mesh.n_hexes()); n_hexes > 0 && n != n_hexes)
    throw Error(split.name.string() + ": its parts have " + std::to_string(n) + " hexes together, and say " +
                std::to_string(n_hexes));
  for (const std::string& line : ranks.lines_of_all(notices)) say(line);
  return own;
}

/// What the whole has, as far as it is known; parts may not have it all.
struct OfFile {
  std::int64_t n_nodes = 0, highest_node = 0;
};

/// This rank's slice of a file. Nothing, on all ranks, where it is not read so.
std::optional<MeshedModel> read_own_slice(Ranks& ranks, const std::filesystem::path& mesh, OfFile& of_file,
                                          const Say& say) {
  std::optional<SlicedFile> file;
  MeshSlice slice;
  std::string lost;
  ranks.together([&] {
    file = in_slices(mesh);
    if (!file) return;
    slice = read_slice(*file, ranks.rank(), ranks.size());
    refuse_more(slice.file.mesh, &slice.file.extras, mesh.string());
    need_ids(slice.file.mesh);
    lost = lost_text(slice, mesh);
  });
  if (ranks.largest(!file) != 0) return std::nullopt;
  of_file = {file->n_nodes, file->highest_node};
  std::vector<std::string> notices = std::move(slice.file.notices);
  for (std::string& line : left_out_of_parts(slice.file.extras)) notices.push_back(std::move(line));
  if (!lost.empty()) notices.push_back(std::move(lost));
  for (const std::string& line : ranks.lines_of_all(notices)) say(line);
  return MeshedModel{std::move(slice.file.mesh), nullptr, {}};
}

/// Nodes of the whole that no rank's part has.
void say_loose_nodes(Ranks& ranks, const Mesh& own, std::int64_t n_nodes, const Say& say) {
  std::vector<std::int64_t> skin;
  ranks.together([&] { skin = skin_nodes(own); });
  std::int64_t n_here = own.n_nodes();
  for (const NodeAtOthers& node : at_others(ranks, own, skin))
    if (node.parts.front() < ranks.rank()) --n_here;
  if (const std::int64_t n = n_nodes - ranks.sum(n_here); n > 0) say("left out " + counted(n, "node") + " of no hex");
}

/// What takes a mesh makes of it on its CAD. glued: the CAD had to be.
MeshedModel on_cad(const std::filesystem::path& cad, const std::function<void(Session&)>& take, const std::string& name,
                   bool& glued, const Say& say) {
  Session session;
  Session::Core& core = session.core();
  core.history.on = false;
  SessionCallbacks callbacks;
  callbacks.notice = say;
  session.set_callbacks(callbacks);
  session.import_cad(cad);
  take(session);
  refuse_more(core.meshed->mesh, core.state.extras.get(), name);
  if (core.state.extras)
    for (const std::string& line : left_out_of_parts(*core.state.extras)) say(line);
  glued = core.state.glued;
  return std::move(core.meshed.to_change());
}

/// What the first rank reads by itself, on CAD where there is any.
MeshedModel read_by_first(const std::filesystem::path& mesh, const std::filesystem::path& cad, bool& glued, Say say) {
  MeshFile file;
  if (split_name(mesh).n_parts > 0) file = read_parts(mesh);
  if (!cad.empty()) {
    for (const std::string& line : file.notices) say(line);  // of parts; the session says those of other files
    const auto take = [&](Session& session) {
      if (file.mesh.hexes.empty())
        session.import_mesh(mesh);
      else
        session.take_mesh(std::move(file.mesh));
    };
    return on_cad(cad, take, mesh.string(), glued, say);
  }
  if (file.mesh.hexes.empty()) file = read_mesh(mesh);
  if (!file.middles.empty())
    throw Error(mesh.string() + ": hexes of " + std::to_string(file.middles.nodes_per_hex) +
                " nodes bend their skin, which is not done in parts; write it with 'set order 1' first");
  refuse_more(file.mesh, &file.extras, mesh.string());
  for (const std::string& line : file.notices) say(line);
  for (const std::string& line : left_out_of_parts(file.extras)) say(line);
  if (file.mesh.hexes.empty()) throw Error(mesh.string() + ": there are no hexes");
  return {std::move(file.mesh), nullptr, {}};
}

/// What came with a mesh that is read at once, as far as parts have it.
void keep_results(Mesh& mesh, const std::string& name, const Say& say) {
  if (!mesh.results) return;
  std::string lost;
  mesh.results = results_of_parts(*mesh.results, lost);
  mesh.file_hexes.clear();
  if (!lost.empty()) say(name + ": is refined in parts without " + lost);
}

/// From the meshes of the ranks.
void share_results(Ranks& ranks, RankPart& part) {
  for (const std::vector<std::byte>& bytes : ranks.everywhere(packed_results(part.own.mesh.results.get())))
    if (!bytes.empty()) join_results(part.results, unpacked_results(bytes));
  part.own.mesh.results = nullptr;
}

/// The model of a mesh without CAD, and what that says of node sets.
void put_on_own_skin(Ranks& ranks, MeshedModel& own) {
  const Mesh& mesh = own.mesh;
  std::vector<std::int64_t> block_sizes;
  for (const Block& block : mesh.blocks) block_sizes.push_back(std::ssize(block.hexes));
  block_sizes = ranks.sum(std::move(block_sizes));
  if (ranks.least(has_block_each(mesh)) == 0) block_sizes.clear();
  std::vector<int> volume = volumes_of_blocks(mesh, block_sizes);
  std::vector<SkinFace> open, walls;
  ranks.together([&] { find_faces(mesh, volume, open, walls); });
  std::vector<SkinFace> all = skin_of_all(ranks, std::move(open), std::move(walls));
  WholeSkin skin;
  ranks.together([&] {
    skin = make_skin_model(std::move(all));
    put_on_skin(skin, std::move(volume), own);
  });
  for (NodeSet& set : own.mesh.node_sets) {
    std::vector<std::int64_t> inner = inner_members(own, set, skin.model->count(3));
    for (std::int64_t& flags : inner) flags = (flags & 1) | (flags & 2) << 30;  // bits that sums keep apart
    inner = ranks.sum(std::move(inner));
    for (std::int64_t& flags : inner)
      flags = ((flags & ((std::int64_t{1} << 31) - 1)) != 0 ? 1 : 0) | (flags >> 31 != 0 ? 2 : 0);
    std::vector<std::int64_t> mine;
    for (const Index n : set.nodes)
      if (own.association.node_owner[n].dim < 3) mine.push_back(node_id(own.mesh, n));
    std::vector<std::int64_t> members = ranks.joined_everywhere(mine);
    std::ranges::sort(members);
    set.meant = members.empty() && std::ranges::all_of(inner, [](std::int64_t f) { return !(f & 1); })
                    ? std::vector<Owner>()
                    : meant_on_skin(skin, members, inner);
  }
}

/// The first rank has its model; all others read the CAD as well.
void share_model(Ranks& ranks, MeshedModel& own, const std::filesystem::path& cad, bool glued) {
  glued = ranks.largest(glued) != 0;
  ranks.together([&] {
    if (cad.empty() || ranks.is_first()) return;
    own.model = read_cad(cad, {}).model;
    if (glued) own.model = hextwist::glued(*own.model).model;
  });
}

}  // namespace

void count_whole(Ranks& ranks, RankPart& part) {
  const Mesh& mesh = part.own.mesh;
  part.n_hexes = ranks.sum(mesh.n_hexes());
  part.highest_node = std::max(part.highest_node, ranks.largest(mesh.node_ids.empty() ? 0 : mesh.node_ids.back()));
  part.highest_hex = ranks.largest(mesh.hex_ids.empty() ? 0 : mesh.hex_ids.back());
}

RankPart read_in_ranks(Ranks& ranks, const std::filesystem::path& mesh, const std::filesystem::path& cad,
                       std::optional<PartitionBy> by, const Say& say) {
  const SplitName split = split_name(mesh);
  RankPart part;
  part.has_cad = !cad.empty();
  std::vector<int> rank_of_hex;
  OfFile of_file;
  std::optional<MeshedModel> slice;
  if (split.n_parts == 0 && cad.empty() && by != PartitionBy::scotch) slice = read_own_slice(ranks, mesh, of_file, say);
  if (slice) {
    part.own = std::move(*slice);
    share_heads(ranks, part.own.mesh);
    rank_of_hex = share_out(ranks, part.own.mesh, by.value_or(PartitionBy::boxes));
  } else if (split.n_parts > 0 && cad.empty()) {
    Disagreements differ;
    part.own = read_own_files(ranks, split, differ, say);
    share_heads(ranks, part.own.mesh);
    settle_values_in_ranks(ranks, part.own.mesh, differ);
    say_disagreements(ranks, part.own.mesh, std::move(differ), split.name.string(), say);
    if (by == PartitionBy::scotch) {
      say("parts that are split already are shared out again by boxes, not by SCOTCH, which would need them all");
      by = PartitionBy::boxes;
    }
    if (by || split.n_parts != ranks.size())
      rank_of_hex = share_out(ranks, part.own.mesh, by.value_or(PartitionBy::boxes));
  } else {
    bool glued = false;
    ranks.together([&] {
      if (!ranks.is_first()) return;
      part.own = read_by_first(mesh, cad, glued, say);
      of_file = {part.own.mesh.n_nodes(),
                 part.own.mesh.points.empty() ? 0 : node_id(part.own.mesh, part.own.mesh.n_nodes() - 1)};
      keep_results(part.own.mesh, mesh.string(), say);
      rank_of_hex = partition(part.own.mesh, ranks.size(), by.value_or(partition_by("")));
      need_ids(part.own.mesh);
    });
    share_model(ranks, part.own, cad, glued);
    share_heads(ranks, part.own.mesh);
  }
  share_results(ranks, part);
  const bool is_moved = ranks.largest(!rank_of_hex.empty()) != 0;
  if (is_moved) part.own = moved(ranks, std::move(part.own), rank_of_hex);
  const std::int64_t n_nodes = ranks.largest(of_file.n_nodes);
  if (n_nodes > 0) say_loose_nodes(ranks, part.own.mesh, n_nodes, say);
  part.highest_node = ranks.largest(of_file.highest_node);
  if (!part.has_cad) {
    // Parts that stay have been checked file by file.
    if (split.n_parts == 0 || is_moved)
      ranks.together([&] { check_part(part.own.mesh, (split.n_parts > 0 ? split.name : mesh).string()); });
    put_on_own_skin(ranks, part.own);
  }
  count_whole(ranks, part);
  return part;
}

RankPart take_in_ranks(Ranks& ranks, Mesh own, const std::filesystem::path& cad, const Say& say) {
  RankPart part;
  part.has_cad = !cad.empty();
  part.own.mesh = std::move(own);
  const std::string name = "the part";
  ranks.together([&] {
    refuse_more(part.own.mesh, nullptr, name);
    if (part.own.mesh.node_ids.size() != part.own.mesh.points.size() ||
        part.own.mesh.hex_ids.size() != part.own.mesh.hexes.size())
      throw Error("a part needs the ids that its nodes and hexes have in the whole mesh");
    check_part(part.own.mesh, name);
  });
  if (ranks.sum(part.own.mesh.n_hexes()) == 0) throw Error("there are no hexes");
  share_heads(ranks, part.own.mesh);
  Disagreements differ;
  settle_values_in_ranks(ranks, part.own.mesh, differ);
  say_disagreements(ranks, part.own.mesh, std::move(differ), "the mesh", say);
  if (cad.empty()) {
    put_on_own_skin(ranks, part.own);
  } else {
    // Who owns what of the CAD is found by looking at all of the mesh.
    std::vector<int> home;
    part.own = at_first(ranks, std::move(part.own), home);
    bool glued = false;
    ranks.together([&] {
      if (!ranks.is_first()) return;
      const auto take = [&](Session& session) { session.take_mesh(std::move(part.own.mesh)); };
      part.own = on_cad(cad, take, name, glued, say);
    });
    share_model(ranks, part.own, cad, glued);
    part.own = moved(ranks, std::move(part.own), home);
  }
  count_whole(ranks, part);
  return part;
}

}  // namespace hextwist
