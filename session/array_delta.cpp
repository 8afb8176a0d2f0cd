#include "hextwist/session/array_delta_internal.h"

#include "hextwist/mesh/arrays.h"

namespace hextwist {
namespace {

constexpr std::size_t head_bytes = 128;  // what a group or field takes beside its items: about, and everywhere the same

/// Compares arrays: those of `to` first, whose groups count.
auto comparing(ArraysDelta& delta) {
  return lists_apart([&delta](const ArrayTag& tag, const auto& to, const auto& from) {
    const ArrayDelta& array = delta.each.emplace_back(from, to);
    delta.bytes += array.bytes() + (tag.is_one_of_several() && !array.empty() ? head_bytes + tag.field.size() : 0);
  });
}
/// Makes arrays of others, with one delta after the other.
auto applying(const ArrayDelta*& next) {
  return lists_apart([&next](const ArrayTag&, auto& to, const auto& from) { to = (next++)->apply(from); });
}

}  // namespace

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
  MeshedDelta delta{{}, to.model};
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
