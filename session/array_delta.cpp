#include "hextwist/session/array_delta_internal.h"

#include "hextwist/mesh/arrays.h"

namespace hextwist {
namespace {

/// Compares arrays: those of `to` first, whose groups count.
auto comparing(ArraysDelta& delta) {
  return lists_apart(
      [&delta](const ArrayTag&, const auto& to, const auto& from) { delta.each.emplace_back(from, to); });
}
/// Makes arrays of others, with one delta after the other.
auto applying(const ArrayDelta*& next) {
  return lists_apart([&next](const ArrayTag&, auto& to, const auto& from) { to = (next++)->apply(from); });
}

}  // namespace

std::size_t bytes_of(const ArraysDelta& delta) {
  std::size_t bytes = delta.each.capacity() * sizeof(ArrayDelta);
  for (const ArrayDelta& array : delta.each) bytes += array.bytes();
  const auto add = [&](const auto& heads) {
    for (const auto& head : heads) bytes += sizeof head + head.name.size();
  };
  add(delta.heads.blocks);
  add(delta.heads.node_sets);
  add(delta.heads.side_sets);
  add(delta.heads.fields);
  return bytes;
}

SetsDelta sets_delta(const Mesh& from, const Mesh& to) {
  SetsDelta delta;
  copy_heads(to, delta.heads);
  delta.heads.fields.clear();
  for_each_set(comparing(delta), to, from);
  return delta;
}

Mesh sets_after(const SetsDelta& delta, const Mesh& from) {
  Mesh result = delta.heads;
  const ArrayDelta* next = delta.each.data();
  for_each_set(applying(next), result, from);
  return result;
}

MeshedDelta MeshedDelta::between(const MeshedModel& from, const MeshedModel& to) {
  MeshedDelta delta;
  delta.model = to.model;
  copy_heads(to.mesh, delta.arrays.heads);
  for_each_array(comparing(delta.arrays), to, from);
  return delta;
}

MeshedModel MeshedDelta::apply(const MeshedModel& from) const {
  MeshedModel result{arrays.heads, model, {}};
  const ArrayDelta* next = arrays.each.data();
  for_each_array(applying(next), result, from);
  return result;
}

std::size_t bytes_of(const MeshedModel& meshed) {
  return bytes_of_arrays(meshed);
}
std::size_t bytes_of(const Association& association) {
  return bytes_of_arrays(association);
}

}  // namespace hextwist
