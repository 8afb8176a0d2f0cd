// block ... attribute: values per hex that only Exodus files have.

#include <algorithm>

#include "hextwist/io/results.h"
#include "hextwist/session/commands/commands.h"

namespace hextwist {
namespace {

using Values = std::vector<double>;

/// Attributes are kept beside the mesh of the file that the session began with; where there is none, beside this one.
std::shared_ptr<FileResults> results_of(Mesh& mesh) {
  auto results = mesh.results ? std::make_shared<FileResults>(*mesh.results) : std::make_shared<FileResults>();
  if (results->mesh && mesh.file_hexes.size() == mesh.hexes.size()) return results;
  if (results->has_places()) throw Error("it is no longer known where in their file the hexes lie");
  place_in_itself(mesh, *results);
  return results;
}

/// The attribute of that name, zero where it is new; its values may be changed.
std::shared_ptr<Values> values_of(FileResults& results, const std::string& name) {
  auto found = std::ranges::find(results.attributes, name, &TimedValues::name);
  if (found == results.attributes.end())
    found = results.attributes.insert(
        found, {name, {std::make_shared<const Values>(static_cast<std::size_t>(results.mesh->n_hexes()), 0.0)}});
  auto copy = std::make_shared<Values>(*found->at[0]);
  found->at[0] = copy;
  return copy;
}

std::string new_name(std::size_t position) {
  return "attribute_" + std::to_string(position + 1);
}

}  // namespace

void change_attributes(Execution& run) {
  const Command& command = run.command;
  MeshedModel meshed = *run.meshed;
  Mesh& mesh = meshed.mesh;
  const int id = static_cast<int>(command.find("id")->number);
  const auto block = std::ranges::find(mesh.blocks, id, &Block::id);
  if (block == mesh.blocks.end())
    throw error_at(command.statement, command.find("id")->token, "there is no block " + std::to_string(id));
  const std::shared_ptr<FileResults> results = results_of(mesh);
  auto of_block = std::ranges::find(results->blocks, id, &FileResults::OfBlock::id);
  if (of_block == results->blocks.end()) of_block = results->blocks.insert(of_block, {id, {}});
  std::vector<std::string>& names = of_block->attributes;
  const Item* const index = command.find("index");
  if (const Item* count = command.find("n")) {
    const auto n = static_cast<std::size_t>(count->number);
    const std::size_t before = names.size();
    names.resize(n);
    for (std::size_t i = before; i < n; ++i) {
      names[i] = new_name(i);
      values_of(*results, names[i]);
    }
  } else {
    const std::size_t at = index ? static_cast<std::size_t>(index->number) - 1 : 0;
    if (!index && names.empty()) names.push_back(new_name(0));
    if (at >= names.size())
      throw error_at(command.statement, index->token,
                     "block " + std::to_string(id) + " has " + counted(std::ssize(names), "attribute") + "; 'block " +
                         std::to_string(id) + " attribute count " + std::to_string(at + 1) + "' makes more");
    const std::shared_ptr<Values> values = values_of(*results, names[at]);
    if (const Item* text = command.find("text")) {
      if (text->text.empty()) throw error_at(command.statement, text->token, "this name is empty");
      const Values own = *values;
      names[at] = text->text;
      const std::shared_ptr<Values> named = values_of(*results, text->text);
      for (const Index h : block->hexes) (*named)[mesh.file_hexes[h]] = own[mesh.file_hexes[h]];
    } else {
      for (const Index h : block->hexes) (*values)[mesh.file_hexes[h]] = command.find("value")->number;
    }
  }
  // Names of no block any more.
  std::erase_if(results->attributes, [&](const TimedValues& attribute) {
    return std::ranges::none_of(results->blocks, [&](const FileResults::OfBlock& of) {
      return std::ranges::find(of.attributes, attribute.name) != of.attributes.end();
    });
  });
  std::string line = "block " + std::to_string(id) + ": " + counted(std::ssize(names), "attribute");
  for (const std::string& name : names) line += " '" + printable(name) + "'";
  mesh.results = results;
  run.replace(std::move(meshed));
  run.keep_levels();
  run.say(line);
}

}  // namespace hextwist
