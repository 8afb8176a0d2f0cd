// Sizing functions by name: `sizing function ...`, `sizing field ...`.
#include "hextwist/io/io.h"
#include "hextwist/session/commands/commands.h"
#include "hextwist/session/load.h"
#include "hextwist/sizing/fields/growing.h"

namespace hextwist {
namespace {

/// How sizes grow from a source unless it is said, per unit of distance and plus one: the usual 1.5.
constexpr double default_growth = 1.5;

double growth_of(const Command& command) {
  const Item* growth = command.find("growth");
  return growth ? growth->number : default_growth;
}

/// CAD ids or mesh indices of a range, as requests want them.
std::vector<Index> targets_of(const Execution& run, const Item& range) {
  std::vector<Index> targets = run.chosen(range);
  if (is_cad(range.kind))
    for (Index& target : targets) ++target;
  return targets;
}

SizeFieldPtr from_field(const Execution& run) {
  const Command& command = run.command;
  const std::string& field = command.find("field")->text;
  try {
    if (const Item* file = command.find("file")) {
      check_file(run, *file, mesh_endings(false));
      auto mesh = std::make_shared<Mesh>(read_mesh(file->text, {}, fence_of(run)).mesh);
      return field_size(std::move(mesh), field);
    }
    if (run.meshed->mesh.hexes.empty()) throw Error("there is no mesh to take a field from");
    const std::shared_ptr<const MeshedModel> lent = run.meshed.lend();
    return field_size(std::shared_ptr<const Mesh>(lent, &lent->mesh), field);
  } catch (const CommandError&) {
    throw;
  } catch (const Error& error) {
    throw error_at(command.statement, command.find("field")->token, error.what());
  }
}

SizeFieldPtr from_curvature(const Execution& run) {
  const Command& command = run.command;
  const MeshedModel& meshed = *run.meshed;
  if (!meshed.model) throw Error("there is no CAD or mesh whose curvature could be asked for");
  std::vector<Owner> entities;
  if (const Item* range = command.find("range"))
    for (const Index id : targets_of(run, *range)) entities.push_back({dimension(range->kind), id});
  else
    for (int dim = 1; dim <= 2; ++dim)
      for (int id = 1; id <= meshed.model->count(dim); ++id) entities.push_back({dim, id});
  return curvature_size(meshed.model, entities, command.find("per_radian")->number, growth_of(command));
}

SizeFieldPtr from_sources(const Execution& run) {
  const Command& command = run.command;
  const Item& range = *command.find("range");
  const EntityKind kind = range.kind;
  return growing_size(command.find("size")->number, growth_of(command),
                      std::make_shared<TargetDistance>(*run.meshed, kind, targets_of(run, range)));
}

SizeFieldPtr from_others(const Execution& run) {
  std::vector<SizeFieldPtr> fields;
  for (const char* argument : {"first", "second", "third", "fourth"})
    if (const Item* name = run.command.find(argument)) fields.push_back(named_size(run, *name));
  return smallest_of(std::move(fields));
}

/// A name that `refine ... sizing_function` would take for one of its options.
bool is_ambiguous(const std::string& name) {
  try {
    return !parse(split_statements("refine hex 1 sizing_function " + name).front()).find("function");
  } catch (const CommandError&) {
    return true;
  }
}

SizeFieldPtr made(const Execution& run) {
  const Command& command = run.command;
  if (const Item* expression = command.find("expression")) return typed_size(command, *expression);
  if (command.find("field")) return from_field(run);
  if (command.has("curvature")) return from_curvature(run);
  if (command.has("interval"))
    return interval_size(*run.meshed, targets_of(run, *command.find("range")),
                         static_cast<int>(command.find("n")->number), growth_of(command));
  if (command.has("linear")) return from_sources(run);
  if (command.has("minimum")) return from_others(run);
  return constant_size(command.find("size")->number);
}

}  // namespace

SizeFieldPtr typed_size(const Command& command, const Item& expression) {
  try {
    return expression_size(expression.text);
  } catch (const SizeExpressionError& error) {
    Token place = expression.token;
    place.offset += 1 + error.position;  // behind the quote
    place.length = 1;
    throw error_at(command.statement, place, error.what());
  }
}

SizeFieldPtr named_size(const Execution& run, const Item& name) {
  const auto found = run.state.sizing.find(name.text);
  if (found != run.state.sizing.end()) return found->second.field;
  std::string known;
  for (const auto& each : run.state.sizing) known += (known.empty() ? "" : ", ") + each.first;
  throw error_at(run.command.statement, name.token,
                 "there is no sizing function '" + printable(name.text) + "'" +
                     (known.empty() ? "; define one with 'sizing function'" : "; there are: " + known));
}

void do_sizing(Execution& run) {
  const Command& command = run.command;
  if (command.has("list")) {
    if (run.state.sizing.empty()) run.say("no sizing functions");
    for (const auto& [name, sizing] : run.state.sizing)
      run.say(name + ": " + sizing.text + (name == run.state.last_sizing ? " (the last)" : ""));
    return;
  }
  const Item* name = command.find("name");
  if (name && is_ambiguous(name->text))
    throw error_at(
        command.statement, name->token,
        "'" + printable(name->text) + "' could be an option behind 'refine ... sizing_function': choose another name");
  SizeFieldPtr field = made(run);
  const std::string key = name ? name->text : command.find("field")->text;
  run.state.sizing[key] = {std::move(field), text_of(command.statement)};
  run.state.last_sizing = key;
}

}  // namespace hextwist
