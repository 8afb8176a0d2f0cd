#include "hextwist/patch/splice.h"

#include <numeric>
#include <optional>

#include "hextwist/base/large_array.h"
#include "hextwist/base/same_bits.h"
#include "hextwist/patch/splice_lists_internal.h"
#include "hextwist/refine/split.h"

namespace hextwist {
namespace {

template <class T>
std::vector<T> tail(const std::vector<T>& array, Index first, std::size_t width = 1) {
  return {array.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(first) * width), array.end()};
}

}  // namespace

PatchNumbers::PatchNumbers(const Patch& of, const MeshedModel& whole, const Mesh& refined_patch)
    : patch(of), n_nodes(whole.mesh.n_nodes()), n_hexes(whole.mesh.n_hexes()) {
  const Index n_before = patch.meshed.mesh.n_hexes();
  // The ids of a patch are its indices, and stay.
  Index next = 0;
  for (; n_kept < refined_patch.n_hexes() && hex_id(refined_patch, n_kept) <= n_before; ++n_kept) {
    const Index local = static_cast<Index>(hex_id(refined_patch, n_kept) - 1);
    for (; next < local; ++next) local_gone.push_back(next);
    ++next;
  }
  for (; next < n_before; ++next) local_gone.push_back(next);
  for (const Index local : local_gone) gone.push_back(patch.hexes[local]);
}

Index PatchNumbers::refined_hex(Index local) const {
  if (local >= n_kept) return local - n_kept + n_hexes - static_cast<Index>(gone.size());
  return after_gaps(gone, patch.hexes[before_gaps(local_gone, local)]);
}

Splice::Splice(const MeshedModel& whole, const PatchNumbers& numbers, const MeshedModel& refined)
    : n_nodes_(numbers.n_nodes), n_hexes_(numbers.n_hexes), gone_(numbers.gone) {
  const Patch& patch = numbers.patch;
  const Mesh &old_mesh = whole.mesh, &mesh = refined.mesh, &part = patch.meshed.mesh;
  const Index n_old = numbers.n_patch_nodes(), n_kept = numbers.n_kept;
  const bool has_owners = !whole.association.empty();
  checked_count(std::int64_t{n_nodes_} + mesh.n_nodes() - n_old);
  checked_count(std::int64_t{n_hexes_} + mesh.n_hexes() - part.n_hexes());

  for (Index n = 0; n < n_old; ++n) {
    const auto same = [&](const auto& before, const auto& after) { return same_bits(before[n], after[n]); };
    if (same(part.points, mesh.points) &&
        (!has_owners || same(patch.meshed.association.node_parameters, refined.association.node_parameters)))
      continue;
    moved_.push_back(patch.nodes[n]);
    before_.points.push_back(part.points[n]);
    after_.points.push_back(mesh.points[n]);
    if (!has_owners) continue;
    before_.parameters.push_back(patch.meshed.association.node_parameters[n]);
    after_.parameters.push_back(refined.association.node_parameters[n]);
  }

  new_points_ = tail(mesh.points, n_old);
  if (!old_mesh.node_ids.empty()) {
    new_node_ids_.resize(new_points_.size());
    std::iota(new_node_ids_.begin(), new_node_ids_.end(), old_mesh.node_ids.back() + 1);
  }
  new_hexes_ = tail(mesh.hexes, n_kept);
  for (Hex& hex : new_hexes_)
    for (Index& n : hex) n = numbers.node(n);
  gone_hexes_ = items_at(old_mesh.hexes, gone_);
  if (!gone_.empty()) {
    makes_hex_ids_ = old_mesh.hex_ids.empty();
    const std::int64_t last = hex_id(old_mesh, n_hexes_ - 1);
    for (Index h = n_kept; h < mesh.n_hexes(); ++h) new_hex_ids_.push_back(last + hex_id(mesh, h) - part.n_hexes());
    for (const Index h : gone_) gone_hex_ids_.push_back(hex_id(old_mesh, h));
  }
  for (std::size_t f = 0; f < old_mesh.fields.size(); ++f) {
    const bool on_nodes = old_mesh.fields[f].on == Field::On::node;
    const auto width = static_cast<std::size_t>(old_mesh.fields[f].components);
    new_values_.push_back(tail(mesh.fields[f].values, on_nodes ? n_old : n_kept, width));
    gone_values_.push_back(on_nodes ? std::vector<double>() : items_at(old_mesh.fields[f].values, gone_, width));
  }

  const auto old_hex = [&](Index local) { return patch.hexes[local]; };
  const auto new_hex = [&](Index local) { return numbers.refined_hex(local); };
  const auto mapped = [](auto list, const auto& number) {
    for (auto& item : list) hex_of(item) = number(hex_of(item));
    return list;
  };
  const auto is_gone = [&](Index hex) { return std::ranges::binary_search(gone_, hex); };
  const auto carried_hex = [&](Index hex) {
    return is_gone(hex) ? std::nullopt : std::optional(after_gaps(gone_, hex));
  };
  const auto carried_side = [&](Side side) {
    return is_gone(side.hex) ? std::nullopt : std::optional(Side{after_gaps(gone_, side.hex), side.face});
  };
  const std::vector<int> none;
  for (std::size_t b = 0; b < part.blocks.size(); ++b)
    blocks_.push_back(list_edit(mapped(part.blocks[b].hexes, old_hex), none, mapped(mesh.blocks[b].hexes, new_hex),
                                none, carried_hex));
  for (std::size_t s = 0; s < part.side_sets.size(); ++s)
    side_sets_.push_back(list_edit(mapped(part.side_sets[s].sides, old_hex), none,
                                   mapped(mesh.side_sets[s].sides, new_hex), none, carried_side));
  const auto node = [&](Index local) { return numbers.node(local); };
  for (std::size_t s = 0; s < part.node_sets.size(); ++s)
    node_sets_.push_back(list_edit(mapped(part.node_sets[s].nodes, node), none, mapped(mesh.node_sets[s].nodes, node),
                                   none, [](Index n) { return std::optional(n); }));
  if (!has_owners) return;

  const Association &before = patch.meshed.association, &after = refined.association;
  new_owners_ = tail(after.node_owner, n_old);
  new_parameters_ = tail(after.node_parameters, n_old);
  new_volumes_ = tail(after.hex_volume, n_kept);
  gone_volumes_ = items_at(whole.association.hex_volume, gone_);
  surface_faces_ = list_edit(mapped(before.surface_faces, old_hex), before.face_surface,
                             mapped(after.surface_faces, new_hex), after.face_surface, carried_side);
  const auto with_nodes = [&](std::vector<Edge> edges) {
    for (Edge& edge : edges) edge = {numbers.node(edge[0]), numbers.node(edge[1])};
    return edges;
  };
  curve_edges_ = list_edit(with_nodes(before.curve_edges), before.edge_curve, with_nodes(after.curve_edges),
                           after.edge_curve, [](const Edge& edge) { return std::optional(edge); });
}

namespace {

template <class T>
void reserve_more(std::vector<T>& array, std::size_t n) {
  if (array.capacity() < n) array.reserve(n + n / 16 + 1024);
}

template <class T>
void append(std::vector<T>& array, const std::vector<T>& items, bool forward, std::size_t n_before) {
  if (forward)
    array.insert(array.end(), items.begin(), items.end());
  else
    array.resize(n_before);
}

template <class T>
void exchange(std::vector<T>& array, std::span<const Index> gone, const std::vector<T>& gone_items,
              const std::vector<T>& new_items, bool forward, std::size_t width = 1) {
  if (forward) {
    take_out(array, gone, width);
    array.insert(array.end(), new_items.begin(), new_items.end());
  } else {
    array.resize(array.size() - new_items.size());
    put_in(array, gone, gone_items, width);
  }
}

template <class Item>
void reserve_for(std::vector<Item>& list, const ListEdit<Item>& edit) {
  reserve_more(list, list.size() + std::max(edit.in.size(), edit.out.size()));
}

template <class Item>
std::size_t bytes_of(const ListEdit<Item>& edit) {
  return (edit.in.capacity() + edit.out.capacity()) * sizeof(Item) +
         (edit.in_values.capacity() + edit.out_values.capacity()) * sizeof(int);
}
template <class T>
std::size_t bytes_of(const std::vector<T>& array) {
  return array.capacity() * sizeof(T);
}

}  // namespace

void Splice::make_room(MeshedModel& whole, bool forward) const {
  Mesh& mesh = whole.mesh;
  Association& association = whole.association;
  const auto n_nodes = static_cast<std::size_t>(this->n_nodes(forward));
  const auto n_hexes = static_cast<std::size_t>(std::max(this->n_hexes(false), this->n_hexes(true)));
  reserve_more(mesh.points, n_nodes);
  reserve_more(mesh.hexes, n_hexes);
  if (!mesh.node_ids.empty()) reserve_more(mesh.node_ids, n_nodes);
  if (!mesh.hex_ids.empty() || makes_hex_ids_) reserve_more(mesh.hex_ids, n_hexes);
  for (Field& field : mesh.fields)
    reserve_more(field.values,
                 (field.on == Field::On::node ? n_nodes : n_hexes) * static_cast<std::size_t>(field.components));
  for (std::size_t b = 0; b < blocks_.size(); ++b) reserve_for(mesh.blocks[b].hexes, blocks_[b]);
  for (std::size_t s = 0; s < node_sets_.size(); ++s) reserve_for(mesh.node_sets[s].nodes, node_sets_[s]);
  for (std::size_t s = 0; s < side_sets_.size(); ++s) reserve_for(mesh.side_sets[s].sides, side_sets_[s]);
  if (association.empty()) return;
  reserve_more(association.node_owner, n_nodes);
  reserve_more(association.node_parameters, n_nodes);
  reserve_more(association.hex_volume, n_hexes);
  reserve_for(association.curve_edges, curve_edges_);
  reserve_more(association.edge_curve, association.curve_edges.capacity());
  reserve_for(association.surface_faces, surface_faces_);
  reserve_more(association.face_surface, association.surface_faces.capacity());
}

void Splice::apply(MeshedModel& whole, bool forward) const noexcept {
  Mesh& mesh = whole.mesh;
  Association& association = whole.association;
  const auto n_before = static_cast<std::size_t>(n_nodes_);
  const bool has_owners = !association.empty();

  const Moved& moved = forward ? after_ : before_;
  for (std::size_t i = 0; i < moved_.size(); ++i) {
    mesh.points[moved_[i]] = moved.points[i];
    if (has_owners) association.node_parameters[moved_[i]] = moved.parameters[i];
  }
  append(mesh.points, new_points_, forward, n_before);
  if (!mesh.node_ids.empty()) append(mesh.node_ids, new_node_ids_, forward, n_before);
  if (has_owners) {
    append(association.node_owner, new_owners_, forward, n_before);
    append(association.node_parameters, new_parameters_, forward, n_before);
    exchange(association.hex_volume, gone_, gone_volumes_, new_volumes_, forward);
    apply_edit(association.curve_edges, &association.edge_curve, curve_edges_, nullptr, forward);
    apply_edit(association.surface_faces, &association.face_surface, surface_faces_, &gone_, forward);
  }
  exchange(mesh.hexes, gone_, gone_hexes_, new_hexes_, forward);
  if (forward && makes_hex_ids_) {
    mesh.hex_ids.resize(static_cast<std::size_t>(n_hexes_));
    std::iota(mesh.hex_ids.begin(), mesh.hex_ids.end(), std::int64_t{1});
  }
  if (!mesh.hex_ids.empty()) exchange(mesh.hex_ids, gone_, gone_hex_ids_, new_hex_ids_, forward);
  if (!forward && makes_hex_ids_) mesh.hex_ids.clear();  // it has room for coming back
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
    Field& field = mesh.fields[f];
    const auto width = static_cast<std::size_t>(field.components);
    if (field.on == Field::On::node)
      append(field.values, new_values_[f], forward, n_before * width);
    else
      exchange(field.values, gone_, gone_values_[f], new_values_[f], forward, width);
  }
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    apply_edit(mesh.blocks[b].hexes, nullptr, blocks_[b], &gone_, forward);
  for (std::size_t s = 0; s < node_sets_.size(); ++s)
    apply_edit(mesh.node_sets[s].nodes, nullptr, node_sets_[s], nullptr, forward);
  for (std::size_t s = 0; s < side_sets_.size(); ++s)
    apply_edit(mesh.side_sets[s].sides, nullptr, side_sets_[s], &gone_, forward);
}

std::size_t Splice::bytes() const {
  std::size_t sum = sizeof(Splice) + bytes_of(moved_) + bytes_of(gone_) + bytes_of(new_points_) +
                    bytes_of(new_node_ids_) + bytes_of(new_hex_ids_) + bytes_of(gone_hex_ids_) + bytes_of(new_owners_) +
                    bytes_of(new_parameters_) + bytes_of(new_hexes_) + bytes_of(gone_hexes_) + bytes_of(new_volumes_) +
                    bytes_of(gone_volumes_) + bytes_of(curve_edges_) + bytes_of(surface_faces_);
  for (const Moved* moved : {&before_, &after_}) sum += bytes_of(moved->points) + bytes_of(moved->parameters);
  for (const auto* values : {&new_values_, &gone_values_})
    for (const auto& of_field : *values) sum += sizeof of_field + bytes_of(of_field);
  for (const auto* edits : {&blocks_, &node_sets_})
    for (const auto& edit : *edits) sum += sizeof edit + bytes_of(edit);
  for (const auto& edit : side_sets_) sum += sizeof edit + bytes_of(edit);
  return sum;
}

MeshedModel spliced(const MeshedModel& whole, const Splice& splice, bool forward) {
  const auto n_nodes = static_cast<std::size_t>(splice.n_nodes(true));
  const auto n_hexes = static_cast<std::size_t>(std::max(splice.n_hexes(false), splice.n_hexes(true)));
  const Mesh& mesh = whole.mesh;
  const Association& association = whole.association;
  MeshedModel result;
  result.model = whole.model;
  result.mesh.points = copy_large(mesh.points, n_nodes);
  result.mesh.hexes = copy_large(mesh.hexes, n_hexes);
  if (!mesh.node_ids.empty()) result.mesh.node_ids = copy_large(mesh.node_ids, n_nodes);
  if (!mesh.hex_ids.empty()) result.mesh.hex_ids = copy_large(mesh.hex_ids, n_hexes);
  result.mesh.blocks = mesh.blocks;
  result.mesh.node_sets = mesh.node_sets;
  result.mesh.side_sets = mesh.side_sets;
  result.mesh.fields = mesh.fields;
  if (!association.empty()) {
    result.association = {copy_large(association.node_owner, n_nodes),
                          copy_large(association.node_parameters, n_nodes),
                          association.curve_edges,
                          association.edge_curve,
                          association.surface_faces,
                          association.face_surface,
                          copy_large(association.hex_volume, n_hexes)};
  }
  splice.make_room(result, forward);
  splice.apply(result, forward);
  return result;
}

}  // namespace hextwist
