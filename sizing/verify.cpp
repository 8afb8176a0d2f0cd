#include "hextwist/sizing/verify.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <ranges>

#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/off_model_internal.h"
#include "hextwist/mesh/parallel_internal.h"
#include "hextwist/mesh/topology.h"

namespace hextwist {
namespace {

/// How a refined mesh differs from its input, all lists ascending.
struct Change {
  Index n_kept = 0;            ///< refined hexes 0 .. n_kept - 1 are hexes of the input
  std::vector<Index> gone;     ///< input hexes that were cut
  std::vector<Index> moved;    ///< old nodes that lie elsewhere now
  std::vector<Index> touched;  ///< kept hexes, in refined numbers, with a node that moved
};

/// Index in the input of a refined hex that was kept: ids tell.
Index old_index(const Mesh& input, const Mesh& refined, Index kept) {
  return find_hex(input, hex_id(refined, kept));
}

/// Kept hexes follow each other as before with gaps where hexes are gone; each gap is found by bisection.
void find_gone(const Mesh& input, const Mesh& refined, Change& change) {
  for (Index i = 0, n_gone = 0; i < change.n_kept || n_gone < input.n_hexes() - change.n_kept;) {
    const auto rest = std::views::iota(i, change.n_kept);
    const auto next =
        std::ranges::partition_point(rest, [&](Index k) { return old_index(input, refined, k) - k == n_gone; });
    i += static_cast<Index>(next - rest.begin());
    const Index gap_end = i < change.n_kept ? old_index(input, refined, i) : input.n_hexes();
    for (Index h = i + n_gone; h < gap_end; ++h) change.gone.push_back(h);
    n_gone = gap_end - i;
  }
}

std::vector<Index> moved_nodes(const Mesh& input, const Mesh& refined) {
  constexpr Index size = 4096;
  std::vector<std::vector<Index>> of_chunk(n_chunks(input.n_nodes(), size));
  parallel_chunks(input.n_nodes(), size, [&](Index chunk, Index begin, Index end) {
    const Vec3 *before = input.points.data(), *after = refined.points.data();
    if (std::memcmp(before + begin, after + begin, static_cast<std::size_t>(end - begin) * sizeof(Vec3)) == 0) return;
    for (Index n = begin; n < end; ++n)
      if (before[n] != after[n]) of_chunk[chunk].push_back(n);
  });
  std::vector<Index> moved;
  for (const auto& list : of_chunk) moved.insert(moved.end(), list.begin(), list.end());
  return moved;
}

Change find_change(const Mesh& input, const Mesh& refined) {
  Change change;
  const std::int64_t last_old = hex_id(input, input.n_hexes() - 1);
  const auto all = std::views::iota(Index{0}, refined.n_hexes());
  change.n_kept = static_cast<Index>(
      std::ranges::partition_point(all, [&](Index h) { return hex_id(refined, h) <= last_old; }) - all.begin());
  find_gone(input, refined, change);
  change.moved = moved_nodes(input, refined);
  if (change.moved.empty()) return change;
  std::vector<char> moved(refined.points.size(), 0);
  for (const Index n : change.moved) moved[n] = 1;
  change.touched = where(change.n_kept, [&](Index h) {
    return std::ranges::any_of(refined.hexes[h], [&](Index n) { return moved[n] != 0; });
  });
  return change;
}

/// What two meshes have in common, and where they differ, for summaries.
struct Difference {
  const MeshedModel& input;
  const MeshedModel& refined;
  std::vector<Index> taken;  ///< input hexes that were cut or have a node that moved, ascending
  std::vector<Index> added;  ///< refined hexes likewise, ascending
};

/// A hex with its value; the lowest hex of those with the best value.
struct Extreme {
  double value;
  Index hex;

  void offer(double other, Index at, bool largest) {
    const bool better = largest ? other > value : other < value;
    if (better || (other == value && at < hex) || hex < 0) *this = {other, at};
  }
};

/// Smallest or largest value of the hexes that both meshes have. Only if the one known is gone they are searched, until
/// one is as good; none is better.
Extreme common_extreme(Extreme known, bool largest, Metric metric, const Difference& difference) {
  const Mesh& mesh = difference.refined.mesh;
  if (!std::ranges::binary_search(difference.taken, known.hex))
    return {known.value, find_hex(mesh, hex_id(difference.input.mesh, known.hex))};
  constexpr Index block = 4096;
  Extreme best{known.value, -1};
  std::vector<Index> hexes;
  for (Index begin = 0; begin < mesh.n_hexes(); begin += block) {
    const auto all = std::views::iota(begin, std::min(mesh.n_hexes(), begin + block));
    hexes.clear();
    std::ranges::set_difference(all, difference.added, std::back_inserter(hexes));
    const std::vector<double> values = quality(metric, mesh, hexes);
    for (std::size_t i = 0; i < hexes.size(); ++i) best.offer(values[i], hexes[i], largest);
    if (best.hex >= 0 && best.value == known.value) break;
  }
  return best;
}

/// Summary after some hexes were taken away and others added.
Summary updated(const Summary& before, Metric metric, const Difference& difference) {
  Extreme smallest = common_extreme({before.min, before.min_hex}, false, metric, difference);
  Extreme largest = common_extreme({before.max, before.max_hex}, true, metric, difference);
  // Deviations from the old average keep sums small.
  double sum = 0, squares = before.std_dev * before.std_dev * before.count;
  for (const double value : quality(metric, difference.input.mesh, difference.taken)) {
    sum -= value - before.average;
    squares -= (value - before.average) * (value - before.average);
  }
  const std::vector<double> values = quality(metric, difference.refined.mesh, difference.added);
  for (std::size_t i = 0; i < values.size(); ++i) {
    sum += values[i] - before.average;
    squares += (values[i] - before.average) * (values[i] - before.average);
    smallest.offer(values[i], difference.added[i], false);
    largest.offer(values[i], difference.added[i], true);
  }
  const Index n = difference.refined.mesh.n_hexes();
  const double shift = sum / n;
  return {.count = n,
          .average = before.average + shift,
          .std_dev = std::sqrt(std::max(0.0, squares / n - shift * shift)),
          .min = smallest.value,
          .max = largest.value,
          .min_hex = smallest.hex,
          .max_hex = largest.hex};
}

Box box_of(const Mesh& mesh, const Quad& nodes) {
  Box box;
  for (const Index n : nodes) box.add(mesh.points[n]);
  return box;
}
bool overlap(const Box& a, const Box& b, double margin) {
  return !a.empty() && !b.empty() && (a.min.array() <= b.max.array() + margin).all() &&
         (b.min.array() <= a.max.array() + margin).all();
}

/// The hexes that are validated: changed ones, all that share a node with them, and others near the new boundary.
std::vector<Index> hexes_to_validate(const MeshedModel& refined, const Change& change) {
  const Mesh& mesh = refined.mesh;
  const Association& association = refined.association;
  std::vector<char> near(mesh.points.size(), 0);
  for (const Index h : change.touched)
    for (const Index n : mesh.hexes[h]) near[n] = 1;
  for (Index h = change.n_kept; h < mesh.n_hexes(); ++h)
    for (const Index n : mesh.hexes[h]) near[n] = 1;
  std::vector<Index> part = where(change.n_kept, [&](Index h) {
    return std::ranges::any_of(mesh.hexes[h], [&](Index n) { return near[n] != 0; });
  });
  Box fresh;
  double longest = 0;
  for (const Side side : association.surface_faces)
    if (side.hex >= change.n_kept) {
      const Box face = box_of(mesh, face_nodes(mesh.hexes[side.hex], side.face));
      longest = std::max(longest, face.diagonal());
      fresh.add(face);
    }
  for (const Side side : association.surface_faces)
    if (side.hex < change.n_kept && overlap(fresh, box_of(mesh, face_nodes(mesh.hexes[side.hex], side.face)), longest))
      part.push_back(side.hex);
  for (Index h = change.n_kept; h < mesh.n_hexes(); ++h) part.push_back(h);
  std::ranges::sort(part);
  part.erase(std::ranges::unique(part).begin(), part.end());
  return part;
}

/// Some hexes as a mesh of their own.
Mesh part_of(const Mesh& mesh, std::span<const Index> hexes) {
  Mesh part;
  std::vector<Index> nodes;
  for (const Index h : hexes) nodes.insert(nodes.end(), mesh.hexes[h].begin(), mesh.hexes[h].end());
  std::ranges::sort(nodes);
  nodes.erase(std::ranges::unique(nodes).begin(), nodes.end());
  for (const Index n : nodes) part.points.push_back(mesh.points[n]);
  for (const Index h : hexes) {
    Hex& hex = part.hexes.emplace_back();
    for (int c = 0; c < 8; ++c)
      hex[c] = static_cast<Index>(std::ranges::lower_bound(nodes, mesh.hexes[h][c]) - nodes.begin());
  }
  return part;
}

bool is_sound(const MeshedModel& refined, const Change& change) {
  const std::vector<Index> hexes = hexes_to_validate(refined, change);
  const Mesh part = part_of(refined.mesh, hexes);
  for (const Violation& violation : validate(part))
    if (!is_warning(violation.kind) || violation.kind == ViolationKind::touching_part) return false;
  return std::ranges::all_of(boundary_sides(faces(part)), [&](Side side) {
    side.hex = hexes[side.hex];
    return side.hex < change.n_kept || std::ranges::binary_search(refined.association.surface_faces, side);
  });
}

OffModel off_after(const OffModel& before, const MeshedModel& input, const MeshedModel& refined, const Change& change) {
  std::vector<Index> nodes = change.moved;
  for (Index n = input.mesh.n_nodes(); n < refined.mesh.n_nodes(); ++n) nodes.push_back(n);
  const OffModel fresh = detail::off_model(refined.mesh, refined.association, *refined.model, nodes);
  return fresh.node >= 0 && (before.node < 0 || fresh.max > before.max) ? fresh : before;
}

/// False when only doing everything from scratch will do; the report is then as it was.
bool verify_change(const MeshedModel& input, const Measured& known, const MeshedModel& refined, Report& report) {
  if (!refined.model || refined.association.empty()) return false;  // the boundary is known from it
  const Change change = find_change(input.mesh, refined.mesh);
  const Index n_new = refined.mesh.n_hexes() - change.n_kept;
  constexpr Index small_part = 8;
  if ((n_new + std::ssize(change.gone) + std::ssize(change.touched)) > refined.mesh.n_hexes() / small_part)
    return false;
  if (std::ranges::binary_search(change.moved, known.off_cad.node)) return false;

  if (!is_sound(refined, change)) return false;

  Difference difference{input, refined, change.gone, change.touched};
  for (const Index h : change.touched) difference.taken.push_back(old_index(input.mesh, refined.mesh, h));
  std::ranges::sort(difference.taken);
  for (Index h = change.n_kept; h < refined.mesh.n_hexes(); ++h) difference.added.push_back(h);
  report.shape_after = updated(known.shape, Metric::shape, difference);
  report.scaled_jacobian_after = updated(known.scaled_jacobian, Metric::scaled_jacobian, difference);
  report.volume_after = report.volume_before;
  for (const double v : quality(Metric::volume, input.mesh, difference.taken)) report.volume_after -= v;
  for (const double v : quality(Metric::volume, refined.mesh, difference.added)) report.volume_after += v;
  report.off_cad = off_after(known.off_cad, input, refined, change);
  return true;
}

}  // namespace

Measured measured(const MeshedModel& meshed) {
  Measured result;
  result.shape = summarize(quality(Metric::shape, meshed.mesh));
  result.scaled_jacobian = summarize(quality(Metric::scaled_jacobian, meshed.mesh));
  result.volume = volume(meshed.mesh);
  if (meshed.model && !meshed.association.empty())
    result.off_cad = off_model(meshed.mesh, meshed.association, *meshed.model);
  return result;
}

Measured measured_after(const Report& report) {
  return {report.shape_after, report.scaled_jacobian_after, report.volume_after, report.off_cad};
}

void verify(const MeshedModel& input, const Measured* known, const MeshedModel& refined, Report& report) {
  report.shape_before = known ? known->shape : summarize(quality(Metric::shape, input.mesh));
  report.scaled_jacobian_before =
      known ? known->scaled_jacobian : summarize(quality(Metric::scaled_jacobian, input.mesh));
  report.volume_before = known ? known->volume : volume(input.mesh);
  if (known && verify_change(input, *known, refined, report)) return;
  const Measured after = measured(refined);
  report.shape_after = after.shape;
  report.scaled_jacobian_after = after.scaled_jacobian;
  report.volume_after = after.volume;
  report.off_cad = after.off_cad;
  for (Violation& violation : validate(refined.mesh))
    if (!is_warning(violation.kind)) report.violations.push_back(std::move(violation));
}

}  // namespace hextwist
