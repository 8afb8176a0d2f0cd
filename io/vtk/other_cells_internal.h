// Elements beside the hexes as cells of .vtu.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "hextwist/base/types.h"
#include "hextwist/io/others.h"
#include "hextwist/io/vtk/vtk_internal.h"

namespace hextwist::io {

/// Attributes of field data.
inline std::string tuples(std::size_t n) {
  return " NumberOfTuples=\"" + std::to_string(n) + "\"";
}

/// Of no value a number too.
inline std::int64_t whole_number(double value) {
  return std::isnan(value) ? 0 : static_cast<std::int64_t>(value);
}

/// Elements beside the hexes as cells, and what VTK has no place for: "hextwist:other_..." with their places.
struct OtherCells {
  std::vector<Index> nodes;                    ///< of all cells
  std::vector<std::int64_t> ends;              ///< per cell
  std::vector<std::uint8_t> types;             ///< likewise
  std::vector<std::int64_t> ids;               ///< likewise
  std::vector<const OtherField*> only_theirs;  ///< fields that hexes have not

  OtherCells(const Mesh& of, std::vector<std::string>& notices) : mesh(of) {
    if (!mesh.others) return;
    ids = other_ids_in_file(mesh, mesh.hex_ids, std::numeric_limits<std::int64_t>::max(), "is too large", notices);
    const OtherElements& others = *mesh.others;
    by_type.resize(others.heads->types.size());
    for (Index e = 0; e < others.size(); ++e) {
      const OtherType& type = others.type_of(e);
      const auto all = others.nodes_of(e);
      const std::size_t n = type.n_nodes > 0 ? static_cast<std::size_t>(type.n_nodes) : all.size();
      nodes.insert(nodes.end(), all.begin(), all.begin() + static_cast<std::ptrdiff_t>(n));
      ends.push_back(static_cast<std::int64_t>(nodes.size()));
      const int number = vtk_type_of(type.shape, n);
      if (number == 0) throw Error(other_text(mesh, e) + " has " + std::to_string(n) + " nodes: VTK has no such cell");
      types.push_back(static_cast<std::uint8_t>(number));
      by_type[others.heads->type[others.of[e]]].push_back(e);
      if (!others.heads->is_rigid.empty() && others.heads->is_rigid[others.of[e]]) rigid.push_back(e);
      for (const Index node : all.subspan(n)) more.push_back({e, node});
    }
    for (const OtherSet& set : others.heads->sets)
      if (std::ranges::find(mesh.blocks, set.id, &Block::id) != mesh.blocks.end())
        sets.emplace_back(set.id, others_of_block(mesh, set.id));
    for (const OtherSides& list : others.heads->sides)
      if (std::ranges::find(mesh.side_sets, list.id, &SideSet::id) != mesh.side_sets.end())
        for (const auto& [element, side] : other_sides_of(mesh, list.id)) sides[{list.id, side}].push_back(element);
    for (const OtherField& field : others.heads->fields)
      if (std::ranges::none_of(mesh.fields,
                               [&](const Field& f) { return f.name == field.name && f.on == Field::On::hex; }) &&
          std::ranges::none_of(only_theirs, [&](const OtherField* f) { return f->name == field.name; }))
        only_theirs.push_back(&field);
  }

  template <class Arrays>
  void add(Arrays& arrays) const {
    if (!mesh.others) return;
    const OtherHeads& heads = *mesh.others->heads;
    const auto list = [&](const std::string& name, const std::vector<Index>& items) {
      arrays.template add<Index>("hextwist:other_" + name, items, 1, tuples(items.size()));
    };
    const auto mark = [&](const std::string& name) {
      arrays.add_each(
          "hextwist:other_" + name, 1, 1, [](std::size_t) { return std::int32_t{1}; }, tuples(1));
    };
    mark("format " + heads.format);
    for (std::size_t t = 0; t < by_type.size(); ++t)
      list("type " + std::to_string(static_cast<int>(heads.types[t].shape)) + " " +
               std::to_string(heads.types[t].n_nodes) + " " + heads.types[t].name,
           by_type[t]);
    for (const auto& [id, items] : sets) list("block " + std::to_string(id), items);
    for (const auto& [which, items] : sides) list("sides " + std::to_string(which.first) + " " + which.second, items);
    if (!rigid.empty()) list("rigid", rigid);
    if (!more.empty())
      arrays.add_each(
          "hextwist:other_nodes", more.size(), 2, [this](std::size_t i) { return more[i]; }, tuples(more.size()));
    for (const OtherField* field : only_theirs) mark("field " + field->name);
  }

 private:
  const Mesh& mesh;
  std::vector<std::vector<Index>> by_type;
  std::vector<std::pair<int, std::vector<Index>>> sets;
  std::map<std::pair<int, std::string>, std::vector<Index>> sides;
  std::vector<Index> rigid;
  std::vector<std::array<Index, 2>> more;
};

}  // namespace hextwist::io
