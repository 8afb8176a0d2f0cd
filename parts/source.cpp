#include "hextwist/parts/source.h"

#include <algorithm>
#include <numeric>

#include "hextwist/base/interrupt.h"
#include "hextwist/base/sorted.h"
#include "hextwist/io/results.h"
#include "hextwist/mesh/topology.h"
#include "hextwist/parts/join.h"
#include "hextwist/parts/pack.h"
#include "hextwist/patch/patch.h"

namespace hextwist {
namespace {

/// Hexes of a file, which need not be in the order of their ids.
std::vector<int> partition_by_ids(std::vector<Vec3> middles, std::span<const std::int64_t> ids, const Box& box,
                                  int n_parts, PartitionBy by) {
  if (std::ranges::is_sorted(ids)) return partition(middles, box, n_parts, by);
  std::vector<Index> order(ids.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](Index h) { return ids[h]; });
  middles = items_at(middles, order);
  const std::vector<int> sorted = partition(middles, box, n_parts, by);
  std::vector<int> part(ids.size());
  for (std::size_t i = 0; i < order.size(); ++i) part[order[i]] = sorted[i];
  return part;
}

std::filesystem::path piece(const Aside& aside, int slice, int part) {
  return aside.file(("slice." + std::to_string(slice)).c_str(), part);
}

}  // namespace

Index in_two_blocks(const Mesh& mesh) {
  std::vector<std::uint8_t> has(mesh.hexes.size(), 0);
  for (const Block& block : mesh.blocks)
    for (const Index h : block.hexes)
      if (has[h]++) return h;
  return -1;
}

std::string lost_text(const MeshSlice& slice, const std::filesystem::path& file) {
  return slice.left_out.empty() ? "" : file.string() + ": is read in slices without " + slice.left_out;
}

PartSource::PartSource(const std::filesystem::path& any_part, const Fence& fence) : fence_(fence) {
  const SplitName split = split_name(any_part);
  if (split.n_parts == 0)
    throw Error(any_part.string() +
                ": parts are called name.e.8.0, name.e.8.1, ..., or name_1.msh, ... as Gmsh splits meshes; "
                "'hextwist split' makes them");
  whole_ = split.name;
  n_parts_ = split.n_parts;
}

std::optional<PartSource> PartSource::divide(const std::filesystem::path& file, int n_parts, PartitionBy by,
                                             const Aside& aside, const Fence& fence, PartUse use, Unsliced& why) {
  const std::optional<SlicedFile> sliced = in_slices(file, fence, &why);
  if (!sliced) return std::nullopt;
  PartSource source;
  source.whole_ = file;
  source.n_parts_ = n_parts;
  source.fence_ = fence;
  source.aside_ = &aside;
  source.n_nodes_ = sliced->n_nodes;
  source.n_hexes_ = sliced->n_hexes;
  source.highest_node_ = sliced->highest_node;
  const int n_slices = source.n_slices_ =
      static_cast<int>(std::clamp<std::int64_t>(sliced->n_hexes / 100000, 1, n_parts));
  std::vector<Vec3> middles;
  std::vector<std::int64_t> ids;
  middles.reserve(static_cast<std::size_t>(sliced->n_hexes));
  ids.reserve(static_cast<std::size_t>(sliced->n_hexes));
  Box box;
  for (int s = 0; s < n_slices; ++s) {
    check_interrupt();
    MeshSlice slice = read_slice(*sliced, s, n_slices);
    Mesh& mesh = slice.file.mesh;
    if (const Index h = in_two_blocks(mesh); h >= 0)
      why = {"blocks that overlap (hex " + std::to_string(hex_id(mesh, h)) + " is in two)"};
    else if (use == PartUse::join)
      why = {slice.left_out, true};
    if (!why.what.empty()) return std::nullopt;
    if (use == PartUse::refine) refuse_more(mesh, &slice.file.extras, file.string());
    if (s == 0) {
      if (const std::string lost = lost_text(slice, file); !lost.empty()) slice.file.notices.push_back(lost);
      if (!slice.file.tags.empty()) slice.file.notices.emplace_back(without_owners);
      for (std::string& line : left_out_of_parts(slice.file.extras)) slice.file.notices.push_back(std::move(line));
      source.notices_ = std::move(slice.file.notices);
      source.results_ = mesh.results;
    }
    const std::vector<Vec3> more = middles_of(mesh);
    middles.insert(middles.end(), more.begin(), more.end());
    need_ids(mesh);
    ids.insert(ids.end(), mesh.hex_ids.begin(), mesh.hex_ids.end());
    box.add(hextwist::box(mesh));
  }
  const std::vector<int> part_of_hex = partition_by_ids(std::move(middles), ids, box, n_parts, by);
  ids = {};
  std::size_t first = 0;
  for (int s = 0; s < n_slices; ++s) {
    check_interrupt();
    MeshedModel mesh{read_slice(*sliced, s, n_slices).file.mesh, nullptr, {}};
    mesh.mesh.results = nullptr;
    need_ids(mesh.mesh);
    std::vector<std::vector<Index>> hexes(static_cast<std::size_t>(n_parts));
    for (Index h = 0; h < mesh.mesh.n_hexes(); ++h)
      hexes[part_of_hex[first + static_cast<std::size_t>(h)]].push_back(h);
    first += mesh.mesh.hexes.size();
    for (int p = 0; p < n_parts; ++p) {
      if (hexes[p].empty()) continue;
      Patch patch = make_patch(mesh, std::move(hexes[p]));
      set_ids(mesh.mesh, patch, patch.meshed.mesh);
      write_bytes(piece(aside, s, p), packed(patch.meshed));
    }
  }
  return source;
}

std::string PartSource::name(int part) const {
  if (is_divided()) return whole_.string() + ", part " + std::to_string(part + 1);
  return part_name(whole_, n_parts_, part).string();
}

Mesh PartSource::read(int part, PartHead& first, std::vector<std::string>& notices) const {
  if (!is_divided()) return read_one_part({whole_, n_parts_}, part, first, notices, fence_, PartUse::refine);
  if (first.n_parts == 0) notices.insert(notices.end(), notices_.begin(), notices_.end());
  first = {n_parts_, n_nodes_, n_hexes_};
  std::vector<MeshedModel> pieces;
  for (int s = 0; s < n_slices_; ++s)
    if (std::filesystem::exists(piece(*aside_, s, part)))
      pieces.push_back(unpacked(read_all_bytes(piece(*aside_, s, part))));
  return join(pieces, [&](std::size_t) { return whole_.string(); }).mesh;
}

}  // namespace hextwist
