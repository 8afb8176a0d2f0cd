#include "hextwist/parts/size_tries.h"

#include <algorithm>

#include "hextwist/base/sorted.h"
#include "hextwist/parts/digest.h"
#include "hextwist/refine/levels/handed.h"

namespace hextwist {

SizeTries::SizeTries(const LocalMesh& local, const Asked& asked, const OfWhole& whole, const NumbersOfAll& numbers)
    : local_(local), numbers_(numbers) {
  if (!asked.is_here || !std::holds_alternative<Sizes>(asked.request.how)) return;
  is_for_sizes_ = true;
  may_ask_ = asked.approach == Approach::nearest_size;
  const Index n_hexes = local.meshed.mesh.n_hexes();
  diagonal = whole.box.diagonal();
  n_outside =
      static_cast<Index>(std::min<std::int64_t>(whole.n_hexes - n_hexes, std::numeric_limits<Index>::max() - n_hexes));
  region = asked.region;
  for (Index h = 0; h < n_hexes; ++h) own.push_back(local.is_own(h));
  digest_.resize(local.base.hex.size(), 0);
}

PassRecorder SizeTries::take_recorder() {
  return std::move(tries_[taken]->recorder);
}

void SizeTries::mix_into(std::vector<std::uint64_t>& digest) const {
  for (std::size_t i = 0; i < digest_.size(); ++i) mix(digest[i], digest_[i]);
}

PartNumbers SizeTries::all(const PartNumbers& mine) {
  bool has_failed = false;
  const PartNumbers numbers = numbers_(mine, has_failed);
  if (has_failed) {
    may_ask_ = false;
    throw OthersFailed();
  }
  return numbers;
}

void SizeTries::finish() {
  if (may_ask_) all({});
  may_ask_ = false;
}

void SizeTries::fail() {
  bool has_failed = true;
  if (may_ask_) numbers_({}, has_failed);
  may_ask_ = false;
}

int SizeTries::begin(State& tried) {
  tries_.push_back(std::make_unique<Try>(Try{PassRecorder(items_at(local_.base.ring, local_.base_of)), {}}));
  tried.watch = [&recorder = tries_.back()->recorder](const Lineage& lineage, const Mesh& before, const Cut& cut) {
    recorder.record(cut.turn, lineage, before.hexes, cut.filled);
  };
  wished_.clear();
  n_looks_ = 0;
  return static_cast<int>(tries_.size()) - 1;
}

void SizeTries::end(const RefineResult& made) {
  Try& last = *tries_.back();
  if (made.levelling) record_levels(*made.levelling, local_.meshed.mesh, last.recorder);
  const std::vector<std::uint64_t>& history = last.recorder.history();
  for (std::size_t h = 0; h < history.size(); ++h)
    if (own[made.origin[h]]) last.own_history.push_back(history[h]);
  const std::vector<std::uint64_t> digest =
      digests(made.refined, items_at(local_.base_of, made.origin), history, digest_.size());
  for (std::size_t i = 0; i < digest_.size(); ++i) mix(digest_[i], digest[i]);
}

bool SizeTries::is_same(int a, int b) const {
  return tries_[a]->own_history == tries_[b]->own_history;
}

/// Wishes on the way count, too: what was wished for where the mesh was not right yet stays.
void SizeTries::wished(const LevelMarks& marks) {
  const LevelMarks before = std::exchange(wished_, marks);
  for (std::size_t level = 0; level < marks.size(); ++level) {
    const CellMarks& now = marks[level];
    CellNumber cells_of_hex = 1;
    for (std::size_t k = 0; k < level; ++k) cells_of_hex *= n_cell_children;
    for (std::size_t i = 0; i < now.size(); ++i) {
      const Index at = level < before.size() ? position_in(before[level].cell, now.cell[i]) : -1;
      if (at >= 0 && before[level].corners[at] == now.corners[i]) continue;
      const Index hex = root_of({static_cast<int>(level), now.cell[i]});
      std::uint64_t& digest = digest_[local_.base_of[hex]];
      mix(digest, level);
      mix(digest, static_cast<std::uint64_t>(now.cell[i] - hex * cells_of_hex));
      mix(digest, now.corners[i]);
      mix(digest, static_cast<std::uint64_t>(n_looks_));
    }
  }
  ++n_looks_;
}

}  // namespace hextwist
