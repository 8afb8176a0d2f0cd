// The exchange with Gmsh for Python: entities as tuples of arrays, as the module gmsh gives and takes them.
#pragma once

#include <algorithm>

#include "hextwist/embed/gmsh_exchange.h"
#include "hextwist/embed/python/convert_internal.h"

namespace hextwist::python {

template <class T>
std::vector<T> plain(const py::handle& given) {
  const auto array = py::array_t<T, py::array::c_style | py::array::forcecast>::ensure(given);
  if (!array) throw py::error_already_set();
  return {array.data(), array.data() + array.size()};
}

/// (dim, tag, node tags, coord, parametric, element types, [element tags], [element nodes])
inline GmshEntity entity_of_tuple(const py::tuple& given) {
  GmshEntity entity;
  entity.dim = given[0].cast<int>();
  entity.tag = given[1].cast<int>();
  entity.node_tags = plain<std::size_t>(given[2]);
  entity.coord = plain<double>(given[3]);
  entity.parametric = plain<double>(given[4]);
  entity.element_types = plain<int>(given[5]);
  for (const py::handle tags : given[6]) entity.element_tags.push_back(plain<std::size_t>(tags));
  for (const py::handle nodes : given[7]) entity.element_nodes.push_back(plain<std::size_t>(nodes));
  return entity;
}

inline py::tuple tuple_of_entity(GmshEntity entity) {
  const auto arrays = [](std::vector<std::vector<std::size_t>>& lists) {
    py::list result;
    for (auto& list : lists) result.append(array_of(std::move(list)));
    return result;
  };
  return py::make_tuple(entity.dim, entity.tag, array_of(std::move(entity.node_tags)),
                        array_of(std::move(entity.coord)), array_of(std::move(entity.parametric)),
                        array_of(std::move(entity.element_types)), arrays(entity.element_tags),
                        arrays(entity.element_nodes));
}

/// groups: (dim, tag, name, [tags of entities])
inline GmshModel gmsh_model_of(const py::list& entities, const py::list& groups) {
  GmshModel model;
  for (const py::handle entity : entities)
    model.entities.push_back(entity_of_tuple(py::reinterpret_borrow<py::tuple>(entity)));
  for (const py::handle each : groups) {
    const auto group = py::reinterpret_borrow<py::tuple>(each);
    model.groups.push_back(
        {group[0].cast<int>(), group[1].cast<int>(), group[2].cast<std::string>(), plain<int>(group[3])});
  }
  return model;
}

}  // namespace hextwist::python
