// A model under other ids: those of another program's numbering of the same entities.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "hextwist/geom/model.h"

namespace hextwist {

/// Per dimension, for the entity of each id (at id - 1): the id that it gets, and the name, "" to keep its own. Ids are
/// a permutation of 1 .. count.
struct Renumbering {
  std::array<std::vector<int>, 4> id;
  std::array<std::vector<std::string>, 4> name;

  Owner of(Owner entity) const {
    return entity ? Owner{entity.dim, id[entity.dim][static_cast<std::size_t>(entity.id - 1)]} : entity;
  }
};

/// The same model; every guarantee of Model holds for the new ids. Asks the model given for everything, which stays
/// alive. It knows curvatures if that does. Throws Error when the ids are no permutation.
std::shared_ptr<const Model> renumbered(std::shared_ptr<const Model> model, Renumbering renumbering);

/// The same model with the names of some entities, under its own ids; further ones may be given later.
std::shared_ptr<const Model> renamed(std::shared_ptr<const Model> model,
                                     std::span<const std::pair<Owner, std::string>> names);

/// What a model made by renumbered() or renamed() is made of; nullopt: it is no such model.
struct RenumberingOf {
  std::shared_ptr<const Model> model;
  const Renumbering& renumbering;
};
std::optional<RenumberingOf> renumbering_of(const Model& model);

}  // namespace hextwist
