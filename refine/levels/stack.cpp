#include "hextwist/refine/levels/stack.h"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "hextwist/base/interrupt.h"
#include "hextwist/base/parallel.h"
#include "hextwist/refine/carry.h"
#include "hextwist/refine/marks.h"
#include "hextwist/refine/others.h"
#include "hextwist/refine/templates/trisect.h"

namespace hextwist {
namespace {

MeshedModel without_fields(const MeshedModel& base) {
  MeshedModel bare{{}, base.model, base.association};
  bare.mesh.points = base.mesh.points;
  bare.mesh.hexes = base.mesh.hexes;
  bare.mesh.node_ids = base.mesh.node_ids;
  bare.mesh.hex_ids = base.mesh.hex_ids;
  bare.mesh.blocks = base.mesh.blocks;
  bare.mesh.node_sets = base.mesh.node_sets;
  bare.mesh.side_sets = base.mesh.side_sets;
  bare.mesh.others = base.mesh.others;
  return bare;
}

/// Marked nodes of the mesh after `last` (null: the base).
std::vector<std::uint8_t> marked_nodes(const Mesh& mesh, const LevelPass* last, const CellMarks& marks) {
  std::vector<std::uint8_t> marked(mesh.points.size(), 0);
  std::size_t parent = 0;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    auto hex = static_cast<Index>(marks.cell[i]);
    if (last) {
      while (last->cell[parent] != cell_parent(marks.cell[i])) ++parent;
      assert(last->lineage.hexes[parent].code == trisect_all);
      hex = last->lineage.hexes[parent].first_child + static_cast<Index>(marks.cell[i] % n_cell_children);
    }
    for (int c = 0; c < 8; ++c)
      if (marks.corners[i] >> c & 1) marked[mesh.hexes[hex][c]] = 1;
  }
  return marked;
}

/// Which cells the cut hexes are.
std::vector<CellNumber> cut_cells(const std::vector<CutHex>& cut, const LevelPass* last) {
  std::vector<CellNumber> cell(cut.size());
  std::size_t parent = 0;
  for (std::size_t i = 0; i < cut.size(); ++i) {
    cell[i] = cut[i].hex;
    if (!last) continue;
    const std::vector<CutHex>& before = last->lineage.hexes;
    assert(cut[i].hex >= last->n_kept);
    while (parent + 1 < before.size() && before[parent + 1].first_child <= cut[i].hex) ++parent;
    assert(before[parent].code == trisect_all);  // the rule: no piece of a closure is cut
    cell[i] = first_cell_child(last->cell[parent]) + (cut[i].hex - before[parent].first_child);
  }
  return cell;
}

struct Made {
  MeshedModel mesh;
  LevelPass pass;
};

Made make_pass(const MeshedModel& from, const LevelPass* last, const CellMarks& marks, const StackOptions& options) {
  Made made;
  LevelPass& pass = made.pass;
  const std::vector<std::uint16_t> codes = trisect_codes(from.mesh.hexes, marked_nodes(from.mesh, last, marks));
  check_others(from.mesh, *trisect_table(), codes);
  Split parts = split(from.mesh.hexes, from.mesh.n_nodes(), trisect_table(), codes);
  check_interrupt();
  Carried carried = carry(from.mesh, from.association, parts);
  made.mesh = {std::move(carried.mesh), from.model, std::move(carried.association)};
  check_interrupt();
  if (made.mesh.model && !made.mesh.association.empty() && !options.topology_only)
    place(from.mesh, from.association, parts, *made.mesh.model, made.mesh.mesh, made.mesh.association);
  check_interrupt();
  const std::vector<Index> fixed = with_inner_nodes(made.mesh.mesh, made.mesh.association,
                                                    std::vector<Index>(options.fixed.begin(), options.fixed.end()));
  if (!options.topology_only)
    pass.off_nodes =
        repair_children(from.mesh, parts, made.mesh.model.get(), made.mesh.mesh, made.mesh.association,
                        {fixed, options.keep_jumps, options.repeated_surfaces, options.progress}, &pass.is_repaired);
  pass.marks = marks;
  pass.n_kept = parts.n_kept();
  pass.n_hexes = made.mesh.mesh.n_hexes();
  pass.n_nodes = made.mesh.mesh.n_nodes();
  pass.lineage = std::move(parts.lineage);
  pass.lineage.parent = {};
  pass.cell = cut_cells(pass.lineage.hexes, last);
  pass.corners.resize(pass.cell.size());
  parallel_each(pass.cell.size(), [&](std::size_t i) { pass.corners[i] = from.mesh.hexes[pass.lineage.hexes[i].hex]; });
  return made;
}

}  // namespace

LevelledMesh build_levels(const MeshedModel& base, const LevelMarks& marks, const LevelStack& previous,
                          const StackOptions& options) {
  LevelledMesh result;
  // As far as an earlier stack has the same marks: from the last mesh there that was kept.
  std::size_t n_same = 0;
  while (n_same < marks.size() && n_same < previous.size() && previous[n_same]->marks == marks[n_same]) ++n_same;
  while (n_same > 0 && !previous[n_same - 1]->mesh) --n_same;
  result.stack.assign(previous.begin(), previous.begin() + static_cast<std::ptrdiff_t>(n_same));

  const MeshedModel* from = &base;
  MeshedModel current;  // unless it is in the stack
  if (n_same > 0) {
    from = result.stack.back()->mesh.get();
  } else if (!base.mesh.fields.empty()) {
    current = without_fields(base);
    from = &current;
  }
  for (std::size_t k = n_same; k < marks.size(); ++k) {
    Made made = make_pass(*from, k == 0 ? nullptr : result.stack.back().get(), marks[k], options);
    if (options.keep_meshes) {
      made.pass.mesh = std::make_shared<const MeshedModel>(std::move(made.mesh));
      from = made.pass.mesh.get();
    } else {
      current = std::move(made.mesh);
      from = &current;
    }
    result.stack.push_back(std::make_shared<const LevelPass>(std::move(made.pass)));
  }
  if (from == &current)
    result.mesh = std::move(current);
  else
    result.mesh = *from;
  return result;
}

LevelPieces::Leaf LevelPieces::leaf(int block, Index hex) const {
  if (block == 0) return {0, cell[hex]};
  if (at[hex] >> 16 == trisect_all) return {block, first_cell_child(cell[hex]) + (at[hex] & 0xffff)};
  return {block - 1, cell[hex]};
}

LevelPieces level_pieces(const LevelStack& stack, Index n_base_hexes) {
  LevelPieces pieces;
  const auto n_cut_by = [&](std::size_t pass) {
    return pass < stack.size() ? static_cast<Index>(stack[pass]->cell.size()) : 0;
  };
  pieces.first = {0, n_base_hexes - n_cut_by(0)};
  for (std::size_t k = 0; k < stack.size(); ++k)
    pieces.first.push_back(pieces.first.back() + stack[k]->n_hexes - stack[k]->n_kept - n_cut_by(k + 1));
  resize_for_overwrite(pieces.cell, static_cast<std::size_t>(pieces.first.back()));
  resize_for_overwrite(pieces.at, pieces.cell.size());

  Index next = 0;
  // What is before a pass and after the last one, without what the next one cuts.
  const auto take = [&](std::size_t next_pass, Index hex, std::size_t& cut, CellNumber cell, std::uint32_t at) {
    if (cut < static_cast<std::size_t>(n_cut_by(next_pass)) && stack[next_pass]->lineage.hexes[cut].hex == hex) {
      ++cut;
      return;
    }
    pieces.cell[next] = cell;
    pieces.at[next++] = at;
  };
  std::size_t cut = 0;
  for (Index h = 0; h < n_base_hexes; ++h) take(0, h, cut, h, 0);
  for (std::size_t k = 0; k < stack.size(); ++k) {
    const LevelPass& pass = *stack[k];
    cut = 0;
    for (std::size_t i = 0; i < pass.cell.size(); ++i) {
      const Index begin = pass.lineage.hexes[i].first_child;
      const Index end = i + 1 < pass.cell.size() ? pass.lineage.hexes[i + 1].first_child : pass.n_hexes;
      const std::uint32_t code = std::uint32_t{pass.lineage.hexes[i].code} << 16;
      for (Index h = begin; h < end; ++h)
        take(k + 1, h, cut, pass.cell[i], code | static_cast<std::uint32_t>(h - begin));
    }
  }
  assert(next == pieces.first.back());
  return pieces;
}

}  // namespace hextwist
