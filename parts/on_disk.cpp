#include "hextwist/parts/on_disk.h"

#include <algorithm>
#include <optional>

#include "hextwist/base/interrupt.h"
#include "hextwist/base/sorted.h"
#include "hextwist/base/text.h"
#include "hextwist/mesh/nodal_fields.h"
#include "hextwist/parts/agree.h"
#include "hextwist/parts/halo.h"
#include "hextwist/parts/join.h"
#include "hextwist/parts/on_disk_internal.h"
#include "hextwist/parts/own_part.h"
#include "hextwist/parts/own_skin.h"
#include "hextwist/parts/pack.h"
#include "hextwist/parts/shared_values.h"
#include "hextwist/parts/source.h"
#include "hextwist/patch/patch.h"

namespace hextwist {
namespace {

/// What one part's passes of a command brought, turn by turn.
struct Brought {
  Turn turn;
  RunLists runs;
  PassSums sums;
};
struct Numbered {
  std::vector<Brought> turns;
  bool by_levels = false;
  std::int64_t before = 0, n_survivors = 0;
  std::vector<Run> survivors;
  std::vector<Counts> starts;
};

/// A command that all parts have done.
struct Done {
  OfWhole whole;               ///< before it
  int n_rings = 0;             ///< that stay
  std::vector<Bounds> bounds;  ///< of all parts, by freedom of lifting
  Approach approach = Approach::trisect;
  std::vector<Numbered> of_part;
};

/// What is decided together is not known before all parts are done.
PartNumbers not_part_after_part(const PartNumbers&, bool&) {
  throw NeedsWhole("a size: which technique comes nearer is found out by all parts together");
}

class OnDisk {
 public:
  OnDisk(PartSource source, const Aside& aside, const PartCommands& commands, int n_rings,
         const std::function<void(const std::string&)>& say)
      : source_(std::move(source)), aside_(aside), commands_(commands), say_(say) {
    // What parts share is known with a ring of others.
    n_rings_ = is_split_only() ? 1 : first_rings(n_rings, commands.depth(), commands.size());
  }

  void run(const std::filesystem::path& output) {
    look_at_all();
    for (bool is_done = false; !is_done;) {
      if (n_parts() > 1) put_shells_aside();
      done_.clear();
      lines_.clear();
      is_done = refine_all();
      if (!is_done) {
        if (n_rings_ == most_rings) throw NeedsWhole(depends_on_far(most_rings));
        n_rings_ = std::min(2 * n_rings_, most_rings);
        say_("what is made depends on places far away: halos of " + counted(n_rings_, "ring") + " are needed");
      }
    }
    write_all(output);
  }

 private:
  int n_parts() const { return source_.n_parts(); }
  std::string name(int p) const { return source_.name(p); }
  bool is_split_only() const { return commands_.size() == 0; }

  /// Reads every part once: is it sound, what has it in common with others, what is its skin?
  void look_at_all() {
    PartHead head;
    std::vector<std::string> notices;
    std::vector<SkinFace> open, walls;
    std::vector<std::int64_t> block_sizes;
    bool is_by_blocks = true;
    std::int64_t n_nodes = 0, n_hexes = 0;
    Mesh heads;
    highest_node_ = source_.highest_node();
    for (int p = 0; p < n_parts(); ++p) {
      check_interrupt();
      MeshedModel part{source_.read(p, head, notices), nullptr, {}};
      Mesh& mesh = part.mesh;
      if (mesh.hexes.empty()) throw Error(name(p) + ": there are no hexes");
      need_ids(mesh);
      if (!is_split_only()) check_part(mesh, name(p));
      join_results(results_, source_.is_divided() ? source_.results() : mesh.results);
      check_groups(mesh, p, heads);
      block_sizes.resize(mesh.blocks.size(), 0);
      // Until it is known whether blocks are volumes, they are.
      std::vector<int> volume(mesh.hexes.size(), 1);
      for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
        block_sizes[b] += std::ssize(mesh.blocks[b].hexes);
        for (const Index h : mesh.blocks[b].hexes) volume[h] = static_cast<int>(b) + 1;
      }
      is_by_blocks = is_by_blocks && has_block_each(mesh);
      if (!is_split_only()) find_faces(mesh, volume, open, walls);
      box_.add(hextwist::box(mesh));
      n_nodes += mesh.n_nodes();
      n_hexes += mesh.n_hexes();
      highest_node_ = std::max(highest_node_, mesh.node_ids.back());
      highest_hex_ = std::max(highest_hex_, mesh.hex_ids.back());
      shared_.add(skin_nodes(mesh), p);
      write_bytes(aside_.file("own", p), packed(part));
    }
    for (const std::string& line : commands_.notices()) say_(line);
    for (const std::string& line : notices) say_(line);
    n_nodes_ = n_nodes - shared_.finish();
    n_hexes_ = n_hexes;
    if (source_.is_divided() && n_nodes_ < head.n_nodes)
      say_("left out " + counted(head.n_nodes - n_nodes_, "node") + " of no hex");
    else if (head.n_hexes > 0 && (n_nodes_ != head.n_nodes || n_hexes_ != head.n_hexes))
      throw Error(source_.whole().string() + ": its parts have " + std::to_string(n_hexes_) + " hexes and " +
                  std::to_string(n_nodes_) + " nodes together, and say " + std::to_string(head.n_hexes) + " and " +
                  std::to_string(head.n_nodes));
    // Slices of one file say the same.
    if (!source_.is_divided() && has_nodal_fields(heads)) settle_values_aside();
    if (!is_by_blocks) block_sizes.clear();
    if (!is_split_only()) put_on_own_skin(std::move(open), std::move(walls), block_sizes);
  }

  /// Of nodes that several parts have.
  void settle_values_aside() const {
    SharedValues values(shared_.ids());
    while (values.begins_turn())
      for (int p = 0; p < n_parts(); ++p) {
        MeshedModel part = unpacked(read_all_bytes(aside_.file("own", p)));
        values.settle(part.mesh);
        write_bytes(aside_.file("own", p), packed(part));
      }
    for (const std::string& line : disagreement_lines(values.differ(), source_.whole().string())) say_(line);
  }

  /// Parts have the same groups and fields, as split files do, and blocks that do not overlap.
  void check_groups(const Mesh& mesh, int p, Mesh& heads) const {
    Mesh mine = heads_of(mesh);
    if (p == 0) heads = mine;
    if (mine != heads)
      throw Error(name(p) + ": has other blocks, sets or variables than " + name(0) +
                  "; 'hextwist join' and 'hextwist split' make them the same");
    if (const Index h = in_two_blocks(mesh); h >= 0)
      throw Error(name(p) + ": hex " + std::to_string(hex_id(mesh, h)) +
                  " is in two blocks; blocks that overlap are not refined from disk to disk");
  }

  void put_on_own_skin(std::vector<SkinFace> open, std::vector<SkinFace> walls,
                       std::span<const std::int64_t> block_sizes) {
    std::vector<int> volume_of_block;
    int n_volumes = 0;
    for (const std::int64_t size : block_sizes) volume_of_block.push_back(size > 0 ? ++n_volumes : 0);
    const auto volume = [&](int block) { return block_sizes.empty() ? 1 : volume_of_block[block - 1]; };
    std::vector<SkinFace> all = skin_among(std::move(open));
    all.insert(all.end(), walls.begin(), walls.end());
    walls = {};
    for (SkinFace& face : all) {
      face.volume = volume(face.volume);
      if (face.front > 0) face.front = volume(face.front);
    }
    std::erase_if(all, [](const SkinFace& face) { return face.volume == face.front; });
    const WholeSkin skin = make_skin_model(std::move(all));
    model_ = skin.model;
    std::vector<std::vector<std::int64_t>> members, inner;
    for (int p = 0; p < n_parts(); ++p) {
      MeshedModel part = unpacked(read_all_bytes(aside_.file("own", p)));
      put_on_skin(skin, volumes_of_blocks(part.mesh, block_sizes), part);
      const auto& sets = part.mesh.node_sets;
      members.resize(sets.size());
      inner.resize(sets.size());
      for (std::size_t s = 0; s < sets.size(); ++s) {
        for (const Index n : sets[s].nodes)
          if (part.association.node_owner[n].dim < 3) members[s].push_back(node_id(part.mesh, n));
        const std::vector<std::int64_t> flags = inner_members(part, sets[s], model_->count(3));
        inner[s].resize(flags.size(), 0);
        for (std::size_t v = 0; v < flags.size(); ++v) inner[s][v] |= flags[v];
      }
      write_bytes(aside_.file("own", p), packed(part));
    }
    for (std::size_t s = 0; s < members.size(); ++s) {
      sort_unique(members[s]);
      const bool is_empty = members[s].empty() && std::ranges::none_of(inner[s], [](auto flags) { return flags & 1; });
      meant_.push_back(is_empty ? std::vector<Owner>() : meant_on_skin(skin, members[s], inner[s]));
    }
  }

  MeshedModel own(int p) const {
    check_interrupt();
    MeshedModel part = unpacked(read_all_bytes(aside_.file("own", p)));
    for (std::size_t s = 0; s < meant_.size(); ++s) part.mesh.node_sets[s].meant = meant_[s];
    part.model = model_;
    return part;
  }

  /// Of each part the hexes that may lie in the halo of another.
  void put_shells_aside() const {
    for (int p = 0; p < n_parts(); ++p) {
      const MeshedModel part = own(p);
      const Mesh& mesh = part.mesh;
      std::vector<std::uint8_t> reached(mesh.points.size(), 0), is_in(mesh.hexes.size(), 0);
      for (Index n = 0; n < mesh.n_nodes(); ++n) reached[n] = shared_.has(node_id(mesh, n));
      for (int ring = 1; ring <= n_rings_; ++ring) {
        std::vector<Index> next;
        for (Index h = 0; h < mesh.n_hexes(); ++h)
          if (!is_in[h] && std::ranges::any_of(mesh.hexes[h], [&](Index n) { return reached[n] != 0; }))
            next.push_back(h);
        for (const Index h : next) {
          is_in[h] = 1;
          for (const Index n : mesh.hexes[h]) reached[n] = 1;
        }
      }
      std::vector<Index> hexes;
      for (Index h = 0; h < mesh.n_hexes(); ++h)
        if (is_in[h]) hexes.push_back(h);
      Patch patch = make_patch(part, std::move(hexes));
      set_ids(mesh, patch, patch.meshed.mesh);
      write_bytes(aside_.file("shell", p), packed(patch.meshed));
    }
  }

  /// A shell of another part on the way to the halo.
  struct Shell {
    MeshedModel meshed;
    int owner = 0;
    std::vector<std::uint8_t> is_reached, is_taken;  // nodes, hexes
  };

  /// The part with its halo, which may come from parts beyond its neighbours.
  LocalMesh with_halo(int p) const {
    const MeshedModel part = own(p);
    std::vector<Shell> shells;
    const auto shell_of = [&](int q) -> Shell& {
      for (Shell& shell : shells)
        if (shell.owner == q) return shell;
      shells.push_back({unpacked(read_all_bytes(aside_.file("shell", q))), q, {}, {}});
      Shell& shell = shells.back();
      shell.meshed.model = model_;
      shell.is_reached.resize(shell.meshed.mesh.points.size(), 0);
      shell.is_taken.resize(shell.meshed.mesh.hexes.size(), 0);
      return shell;
    };
    std::vector<std::int64_t> reached;  // that other parts may have
    for (const std::int64_t id : part.mesh.node_ids)
      if (n_parts() > 1 && shared_.has(id)) reached.push_back(id);
    for (int ring = 1; ring <= n_rings_; ++ring) {
      for (const std::int64_t id : reached)
        shared_.for_each_part(id, [&](int q) {
          if (q == p) return;
          Shell& shell = shell_of(q);
          shell.is_reached[find_node(shell.meshed.mesh, id)] = 1;
        });
      reached.clear();
      for (Shell& shell : shells) {
        const Mesh& mesh = shell.meshed.mesh;
        std::vector<Index> next;
        for (Index h = 0; h < mesh.n_hexes(); ++h)
          if (!shell.is_taken[h] &&
              std::ranges::any_of(mesh.hexes[h], [&](Index n) { return shell.is_reached[n] != 0; }))
            next.push_back(h);
        for (const Index h : next) {
          shell.is_taken[h] = 1;
          for (const Index n : mesh.hexes[h]) {
            if (shell.is_reached[n]) continue;
            shell.is_reached[n] = 1;
            if (shared_.has(node_id(mesh, n))) reached.push_back(node_id(mesh, n));
          }
        }
      }
    }
    std::vector<HaloPiece> pieces;
    for (Shell& shell : shells) {
      std::vector<Index> hexes;
      for (std::size_t h = 0; h < shell.is_taken.size(); ++h)
        if (shell.is_taken[h]) hexes.push_back(static_cast<Index>(h));
      if (hexes.empty()) continue;
      Patch patch = make_patch(shell.meshed, std::move(hexes));
      set_ids(shell.meshed.mesh, patch, patch.meshed.mesh);
      pieces.push_back({std::move(patch.meshed), shell.owner});
      shell = {};
    }
    shells.clear();
    return local_mesh(part, p, pieces, n_rings_, n_hexes_, [this](int q) { return name(q); });
  }

  /// The part after the first commands.
  LocalMesh after(int p, std::size_t n_commands, GlobalIds& ids) const {
    LocalMesh local = with_halo(p);
    ids = {local.base.node, local.base.hex, highest_node_, highest_hex_};
    for (std::size_t i = 0; i < n_commands; ++i) {
      const Done& done = done_[i];
      PartAsked mine = commands_.asked(i, local, ids, false);
      mine.asked.approach = done.approach;
      const LeastOfAll least = [&](int freedom, const Bounds& none) {
        return freedom < std::ssize(done.bounds) ? done.bounds[freedom] : none;
      };
      LocalRun run = run_locally(local, mine.asked, done.whole, {least, not_part_after_part});
      for (PassRecord& record : run.records) keep_rings(record, done.n_rings);
      const Numbered& numbered = done.of_part[p];
      for (const Brought& brought : numbered.turns)
        number_pass(pass_at(run.records, brought.turn), brought.runs, brought.sums, ids);
      if (numbered.by_levels)
        number_survivors(numbered.before, numbered.survivors, numbered.starts, numbered.n_survivors, ids);
      trim(local, done.n_rings, ids);
    }
    return local;
  }

  /// What all parts have to say of a command.
  struct Collected {
    std::vector<HaloMade> halo;
    std::vector<std::vector<Made>> made;
    std::vector<Turn> turns;
    Objections said;
    std::string by_whole, fault;
    std::vector<std::int64_t> has_id;
    bool is_hopeless() const { return !said.wrong.empty() || !said.by_whole.empty(); }
    bool is_anywhere = false, by_levels = false, is_all = true;
    int n_rings = most_rings;
    SizeCounts sizes;
    Box box;  ///< afterwards
    std::int64_t n_before = 0, n_after = 0, largest = 0;
    std::vector<Bounds> next = std::vector<Bounds>(n_freedoms, no_bounds);  ///< of lifting, beyond those that are known
  };

  void refine_part(int p, std::size_t i, Done& done, Collected& all) {
    GlobalIds ids;
    LocalMesh local = after(p, i, ids);
    all.n_before += n_own_hexes(local);
    all.n_rings = std::min(all.n_rings, local.n_rings);
    all.is_all = all.is_all && local.is_all;
    PartAsked mine = commands_.asked(i, local, ids, false);
    if (all.said.wrong.empty()) all.said.wrong = mine.wrong;
    if (all.said.by_whole.empty()) all.said.by_whole = mine.by_whole;
    if (all.said.nothing.empty()) all.said.nothing = mine.nothing;
    all.has_id.resize(mine.has_id.size(), 0);
    for (std::size_t k = 0; k < all.has_id.size(); ++k) all.has_id[k] += mine.has_id[k];
    if (all.is_hopeless()) return;
    if (mine.has_target) {
      all.is_anywhere = true;
      done.approach = mine.asked.approach;
    }
    LocalRun run;
    try {
      const LeastOfAll least_so_far = [&](int freedom, const Bounds& bounds) {
        if (freedom < std::ssize(done.bounds)) return done.bounds[freedom];
        all.next[freedom] = least(all.next[freedom], bounds);
        return bounds;
      };
      run = run_locally(local, mine.asked, done.whole, {least_so_far, not_part_after_part});
    } catch (const NeedsWhole&) {
      throw;
    } catch (const Error& error) {
      throw Error(name(p) + ": " + error.what());
    }
    all.by_levels = all.by_levels || run.by_levels;
    all.sizes.add(run.sizes);
    all.box.add(own_box(local));
    for (const PassRecord& record : run.records) all.turns.push_back(record.turn);
    if (all.by_whole.empty()) all.by_whole = run.by_whole;
    if (all.fault.empty() && !run.wrong.empty()) all.fault = name(p) + ": " + run.wrong;
    all.halo.push_back(made_of_halo(local, run.digest, n_parts()));
    all.made.emplace_back();
    for (std::size_t b = 0; b < local.base.hex.size() && n_parts() > 1; ++b)
      if (local.base.ring[b] == 0) all.made.back().push_back({local.base.hex[b], run.digest[b]});
    const std::int64_t n = n_own_hexes(local);
    all.n_after += n;
    all.largest = std::max(all.largest, n);
    write_bytes(aside_.file("state", p), packed_state(ids, run.records));
    if (i + 1 == commands_.size()) count(std::move(local), p);
  }

  /// All commands; false: halos were too narrow.
  bool refine_all() {
    std::vector<Approach> approaches;
    OfWhole whole{box_, n_hexes_};
    for (std::size_t i = 0; i < commands_.size(); ++i) {
      Done done;
      done.whole = whole;
      done.of_part.resize(static_cast<std::size_t>(n_parts()));
      Collected all;
      for (;;) {
        all = {};
        counts_.clear();
        for (int p = 0; p < n_parts() && !all.is_hopeless(); ++p) refine_part(p, i, done, all);
        // Low hexes are lifted by what all parts have at the least: once more with that of the first step that is not
        // known and lifts any. What is said of the steps behind it may change for it.
        const auto known = all.next.begin() + std::ssize(done.bounds);
        const auto lifts =
            std::find_if(known, all.next.end(), [](const Bounds& of) { return of.shape != no_bounds.shape; });
        if (lifts == all.next.end()) break;
        done.bounds.insert(done.bounds.end(), known, lifts + 1);
      }
      commands_.check(i, all.is_anywhere, all.said, all.has_id, done.approach, approaches);
      approaches.push_back(done.approach);
      const int alike = rings_alike(all.halo, all.made, all.n_rings);
      switch (verdict_of(alike, all.n_rings, all.by_whole, all.is_all)) {
        case Verdict::right:
          break;
        case Verdict::needs_all:
          throw NeedsWhole(all.by_whole);
        case Verdict::too_narrow:
          return false;
      }
      if (!all.fault.empty()) throw Error(all.fault);
      all.halo.clear();
      all.made.clear();
      done.n_rings = rings_to_keep(alike, all.is_all);
      number(done, sorted_unique(std::move(all.turns)), all.by_levels);
      done_.push_back(std::move(done));
      whole = {all.box, all.n_after};
      if (const std::string met = text_of(all.sizes); !met.empty()) lines_.push_back(met);
      lines_.push_back(std::to_string(all.n_before) + " -> " + std::to_string(all.n_after) + " hexes in " +
                       counted(n_parts(), "part") + " of at most " + std::to_string(all.largest));
    }
    if (is_split_only())
      for (int p = 0; p < n_parts(); ++p) count(with_halo(p), p);
    for (const std::string& line : lines_) say_(line);
    return true;
  }

  static int rings_alike(const std::vector<HaloMade>& halo, const std::vector<std::vector<Made>>& made, int n_rings) {
    int alike = n_rings;
    for (const HaloMade& of : halo)
      for (std::size_t q = 0; q < of.of.size(); ++q)
        for (std::size_t k = 0; k < of.of[q].size(); ++k) {
          const Index at = position_in(made[q], of.of[q][k].hex, &Made::hex);
          if (at < 0 || made[q][at].digest != of.of[q][k].digest) alike = std::min(alike, of.ring[q][k] - 1);
        }
    return alike;
  }

  /// Sums of all parts at once.
  static void sum(std::vector<RunLists> lists, std::vector<PassSums>& sums) {
    sums.assign(lists.size(), {});
    for (std::size_t k = 0; k < n_bringers; ++k) {
      std::vector<Run> runs;
      for (const RunLists& of : lists) runs.insert(runs.end(), of[k].begin(), of[k].end());
      const RunStarts starts = starts_of(runs);
      if (starts.differs_at >= 0)
        throw Error(std::string("parts disagree about what is new at ") + (k == 2 ? "hex " : "node ") +
                    std::to_string(starts.differs_at));
      auto at = starts.before.begin();
      for (std::size_t p = 0; p < lists.size(); ++p) {
        sums[p].before[k].assign(at, at + std::ssize(lists[p][k]));
        at += std::ssize(lists[p][k]);
        sums[p].total[k] = starts.total;
      }
    }
  }

  void number(Done& done, const std::vector<Turn>& turns, bool by_levels) {
    const auto n = static_cast<std::size_t>(n_parts());
    const auto with_state = [&](std::size_t p, const auto& use, bool keep) {
      GlobalIds ids;
      std::vector<PassRecord> records;
      const auto file = aside_.file("state", static_cast<int>(p));
      unpack_state(read_all_bytes(file), ids, records);
      for (PassRecord& record : records) keep_rings(record, done.n_rings);
      use(ids, records);
      if (keep) write_bytes(file, packed_state(ids, records));
    };
    std::int64_t before = 0;
    for (std::size_t t = 0; t <= turns.size(); ++t) {
      const bool is_last = t == turns.size();
      if (is_last && !by_levels) break;
      std::vector<RunLists> runs(n);
      for (std::size_t p = 0; p < n; ++p)
        with_state(
            p,
            [&](GlobalIds& ids, const std::vector<PassRecord>& records) {
              if (t == 0) before = ids.highest_hex;
              if (t > 0) {
                const Brought& last = done.of_part[p].turns.back();
                number_pass(pass_at(records, last.turn), last.runs, last.sums, ids);
              }
              if (is_last) {
                runs[p][2] = survivors(before, ids);
                return;
              }
              Brought brought{turns[t], {}, {}};
              if (const PassRecord* record = pass_at(records, turns[t])) brought.runs = brought_by(*record, ids);
              runs[p] = brought.runs;
              done.of_part[p].turns.push_back(std::move(brought));
            },
            t > 0 && !is_last);
      std::vector<PassSums> sums;
      sum(runs, sums);
      for (std::size_t p = 0; p < n; ++p) {
        Numbered& of = done.of_part[p];
        if (!is_last) {
          of.turns.back().sums = std::move(sums[p]);
          continue;
        }
        of.by_levels = true;
        of.before = before;
        of.n_survivors = sums[p].total[2][0];
        of.survivors = std::move(runs[p][2]);
        of.starts = std::move(sums[p].before[2]);
      }
    }
  }

  /// What the files have to say of the whole.
  void count(LocalMesh local, int p) {
    GlobalIds names;  // of no interest here
    names.node.resize(local.meshed.mesh.points.size());
    names.hex.resize(local.meshed.mesh.hexes.size());
    const OwnPart part = take_own(std::move(local), std::move(names), p, n_parts());
    counts_.resize(part.counts.size(), 0);
    for (std::size_t k = 0; k < part.counts.size(); ++k) counts_[k] += part.counts[k];
  }

  void write_all(const std::filesystem::path& output) {
    PartOutput files(output, n_parts());
    std::vector<std::string> notices;
    std::int64_t largest = 0, n_shared = 0;
    for (int p = 0; p < n_parts(); ++p) {
      GlobalIds ids;
      LocalMesh local = after(p, commands_.size(), ids);
      const std::int64_t highest = std::max(ids.highest_node, ids.highest_hex);
      OwnPart part = take_own(std::move(local), std::move(ids), p, n_parts());
      // Blocks do not overlap: each has all its hexes in its element block.
      const std::size_t n_blocks = part.mesh.blocks.size();
      std::vector<std::int64_t> shares(counts_.end() - static_cast<std::ptrdiff_t>(n_blocks), counts_.end());
      std::int64_t rest = counts_[0];
      for (const std::int64_t n : shares) rest -= n;
      shares.push_back(rest);
      fill_in_whole(part, counts_, shares, highest);
      part.mesh.results = results_;
      files.write(part, notices);
      largest = std::max<std::int64_t>(largest, part.mesh.n_hexes());
      for (const auto& shared : part.file.sides) n_shared += std::ssize(shared.sides);
    }
    check_interrupt();
    files.commit();
    for (const std::string& line : notices) say_(line);
    if (is_split_only()) say_(split_text(n_hexes_, n_parts(), largest, n_shared / 2));
  }

  PartSource source_;
  const Aside& aside_;
  const PartCommands& commands_;
  const std::function<void(const std::string&)>& say_;
  int n_rings_ = 0;
  SharedNodes shared_;
  std::shared_ptr<const Model> model_;
  std::shared_ptr<const FileResults> results_;  // of the whole
  std::vector<std::vector<Owner>> meant_;       // per node set
  Box box_;
  std::int64_t n_nodes_ = 0, n_hexes_ = 0, highest_node_ = 0, highest_hex_ = 0;
  std::vector<Done> done_;
  std::vector<std::string> lines_;  // of commands
  std::vector<std::int64_t> counts_;
};

}  // namespace

void refine_on_disk(const std::filesystem::path& input, const PartCommands& commands,
                    const std::filesystem::path& output, const OnDiskOptions& options,
                    const std::function<void(const std::string&)>& say) {
  check_output_name(output);
  if (!commands.by_whole().empty()) throw NeedsWhole(commands.by_whole());
  std::optional<PartSource> source;
  if (options.n_parts == 0) source.emplace(input, options.fence);
  const Aside aside(options.folder.empty() ? output.parent_path() : options.folder);
  Unsliced why;
  if (!source)
    source = PartSource::divide(input, options.n_parts, options.by, aside, options.fence, PartUse::refine, why);
  if (!source)
    throw Error(input.string() + ": is not read in slices, as it has " + why.what +
                (why.may_be_split ? "; 'hextwist split' makes parts of it" : ""));
  OnDisk(std::move(*source), aside, commands, options.n_rings, say).run(output);
}

bool split_on_disk(const std::filesystem::path& file, const std::filesystem::path& output, const OnDiskOptions& options,
                   const std::function<void(const std::string&)>& say) {
  const Aside aside(options.folder.empty() ? output.parent_path() : options.folder);
  Unsliced why;
  std::optional<PartSource> source =
      PartSource::divide(file, options.n_parts, options.by, aside, options.fence, PartUse::join, why);
  if (!source) return false;
  OnDisk(std::move(*source), aside, PartCommands(), options.n_rings, say).run(output);
  return true;
}

}  // namespace hextwist
