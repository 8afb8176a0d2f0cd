#include "hextwist/sizing/levels.h"

#include <algorithm>
#include <cmath>

#include "hextwist/base/parallel.h"
#include "hextwist/base/text.h"
#include "hextwist/mesh/neighbourhood.h"
#include "hextwist/refine/marks.h"

namespace hextwist {

namespace {

bool is_level_field(const Field& field) {
  return field.name == level_field && field.on == Field::On::hex && field.components == 1;
}

}  // namespace

Field& level_field_of(Mesh& mesh) {
  const auto found = std::ranges::find_if(mesh.fields, is_level_field);
  if (found != mesh.fields.end()) return *found;
  return mesh.fields.emplace_back(Field{level_field, Field::On::hex, 1, std::vector<double>(mesh.hexes.size())});
}

std::vector<int> levels(const Mesh& mesh) {
  std::vector<int> result(mesh.hexes.size(), 0);
  const auto found = std::ranges::find_if(mesh.fields, is_level_field);
  if (found != mesh.fields.end())
    for (std::size_t h = 0; h < result.size(); ++h) result[h] = static_cast<int>(std::lround(found->values[h]));
  return result;
}

Index close_flags(const Mesh& mesh, std::span<const int> level, std::span<std::uint8_t> flags) {
  // From the finest down: the highest level of a flagged hex at each node flags all lower ones there.
  Index n_added = 0;
  std::vector<int> highest(mesh.points.size(), -1);
  std::vector<Index> fresh = indices_where(mesh.n_hexes(), [&](Index h) { return flags[h] != 0; });
  while (!fresh.empty()) {
    for (const Index h : fresh)
      for (const Index n : mesh.hexes[h]) highest[n] = std::max(highest[n], level[h]);
    fresh = indices_where(mesh.n_hexes(), [&](Index h) {
      return !flags[h] && std::ranges::any_of(mesh.hexes[h], [&](Index n) { return highest[n] > level[h]; });
    });
    for (const Index h : fresh) flags[h] = 1;
    n_added += static_cast<Index>(fresh.size());
  }
  return n_added;
}

Index grade_marks(const Mesh& mesh, Concave concave, std::span<std::uint8_t> marked) {
  const std::vector<int> level = levels(mesh);
  // A hex between flagged ones has all its nodes marked too, and is cut as they are.
  const auto whole = [&] {
    std::vector<std::uint8_t> flags(mesh.hexes.size());
    parallel_each(flags.size(), [&](std::size_t h) { flags[h] = corner_mask(mesh.hexes[h], marked) == 0xff; });
    return flags;
  };
  std::vector<std::uint8_t> flags = whole();
  const auto n_before = std::ranges::count(flags, 1);
  while (close_flags(mesh, level, flags) > 0) {
    mark_nodes(mesh.hexes, indices_where(mesh.n_hexes(), [&](Index h) { return flags[h] != 0; }), marked);
    if (concave == Concave::fill) fill_concave(mesh, marked);
    flags = whole();
  }
  return static_cast<Index>(std::ranges::count(flags, 1) - n_before);
}

void say_graded(Index n_hexes, std::vector<std::string>& notices) {
  if (n_hexes > 0)
    notices.push_back("cut " + counted(n_hexes, "hex") + " more than asked for, to keep neighbours within one level");
}

}  // namespace hextwist
