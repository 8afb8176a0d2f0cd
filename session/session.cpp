#include "hextwist/session/session.h"

#include <algorithm>

#include "hextwist/command/error_at.h"
#include "hextwist/command/syntax.h"
#include "hextwist/io/field_names.h"
#include "hextwist/session/load.h"
#include "hextwist/session/refining.h"
#include "hextwist/session/run.h"
#include "hextwist/sizing/levelling.h"

namespace hextwist {

Session::Session() : core_(std::make_unique<Core>()) {}
Session::~Session() = default;
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;

void Session::set_callbacks(SessionCallbacks callbacks) {
  core_->callbacks = std::move(callbacks);
}
void Session::set_keep_going(bool keep_going) {
  core_->keep_going = keep_going;
}
const MeshedModel& Session::meshed() const {
  return *core_->meshed;
}
std::shared_ptr<const MeshedModel> Session::share() const {
  return core_->meshed.lend();
}
bool Session::has_cad() const {
  return core_->state.has_cad;
}
const std::vector<CommandRecord>& Session::records() const {
  return core_->records;
}
bool Session::finished() const {
  return core_->state.finished;
}

int Session::run(std::string_view text, std::string_view source_name, int first_line) {
  if (finished()) throw Error("this session has ended: 'quit' was run in it");
  return run_text(*core_, text, source_name, first_line);
}
void Session::import_cad(const std::filesystem::path& file) {
  run_with_file(*core_, "import", "geometry", file);
}
void Session::import_mesh(const std::filesystem::path& file) {
  run_with_file(*core_, "import", "mesh", file);
}
void Session::export_mesh(const std::filesystem::path& file) {
  run_with_file(*core_, "export", "mesh", file, "overwrite");
}
int Session::playback(const std::filesystem::path& file) {
  const std::size_t before = core_->records.size();
  run_with_file(*core_, "playback", "", file);
  return static_cast<int>(std::count_if(core_->records.begin() + static_cast<std::ptrdiff_t>(before),
                                        core_->records.end(), [](const CommandRecord& record) { return !record.ok; }));
}

void Session::take(Mesh mesh, std::shared_ptr<const Model> model, const Association* tags) {
  Transaction run(*core_, "take mesh");
  transact(run, [&] {
    forget_members(run.state, true);
    run.state.has_cad = model != nullptr;
    run.state.cad_file.clear();
    load_mesh(run, std::move(mesh), std::move(model), tags, "mesh");
    run.state.tags = tags ? std::make_shared<const Association>(*tags) : nullptr;
    run.state.extras = nullptr;
  });
}

void Session::take(MeshedModel meshed, bool has_cad, const std::vector<std::string>& notices) {
  Transaction run(*core_, "take mesh");
  transact(run, [&] {
    for (const std::string& line : notices) run.note(line);
    load_meshed(run, std::move(meshed));
    forget_members(run.state, true);
    run.state.has_cad = has_cad;
    run.state.cad_file.clear();
    run.state.tags = nullptr;
    run.state.extras = nullptr;
  });
}

void Session::take_mesh(Mesh mesh, const Association* tags) {
  Transaction run(*core_, "take mesh");
  transact(run, [&] {
    forget_members(run.state, !run.state.has_cad);
    load_mesh(run, std::move(mesh), run.state.has_cad ? run.meshed->model : nullptr, tags, "mesh");
    run.state.tags = tags ? std::make_shared<const Association>(*tags) : nullptr;
    run.state.extras = nullptr;
  });
}

void Session::set_field(Field field) {
  Transaction run(*core_, "set field");
  transact(run, [&] {
    const Mesh& mesh = run.meshed->mesh;
    if (mesh.n_hexes() == 0) throw Error("there is no mesh to set a field of");
    if (field.name.empty()) throw Error("a field needs a name");
    if (field.components < 1) throw Error("field '" + printable(field.name) + "' has no component");
    const std::size_t n = field.on == Field::On::hex ? mesh.hexes.size() : mesh.points.size();
    if (field.values.size() / static_cast<std::size_t>(field.components) != n ||
        field.values.size() % static_cast<std::size_t>(field.components) != 0)
      throw Error("field '" + printable(field.name) + "' has " + std::to_string(field.values.size()) +
                  " values: " + std::to_string(field.components) + " for each of " + std::to_string(n) + " are wanted");
    io::check_whole_numbers(field);
    if (field.on == Field::On::hex && field.name == "level")
      throw Error("the hex field 'level' says how hexes came about: it is not to be set");
    MeshedModel next = *run.meshed;
    const auto same = std::ranges::find_if(
        next.mesh.fields, [&](const Field& each) { return each.name == field.name && each.on == field.on; });
    if (same == next.mesh.fields.end())
      next.mesh.fields.push_back(std::move(field));
    else
      *same = std::move(field);
    run.replace_fields(std::move(next));
  });
}

namespace {

AdaptOutcome adapt_session(Session::Core& core, const char* by, const auto& values, AdaptOptions options) {
  AdaptOutcome outcome;
  Transaction run(core, std::string("adapt by ") + by);
  transact(run, [&] {
    if (run.meshed->mesh.n_hexes() == 0) throw Error("there is no mesh to adapt");
    if (const auto& fixed = run.state.fixed_nodes)
      options.fixed.insert(options.fixed.end(), fixed->begin(), fixed->end());
    options.keep_jumps.insert(options.keep_jumps.end(), run.state.keep_jumps.begin(), run.state.keep_jumps.end());
    if (!options.levelling) options.levelling = run.state.levelling;  // what there is to be coarsened
    Request request = adapt_request(run.meshed->mesh, values, options);
    if (request.target.ids.empty() && std::holds_alternative<Cuts>(request.how)) {  // no flag at all
      AdaptResult same = hextwist::adapt(*run.meshed, values, options);
      outcome = {std::move(same.origin), std::move(same.report), std::move(same.came_from)};
      return;
    }
    Refining refining = prepare_refining(run, std::move(request));
    const Report& report = refining.report();
    for (const std::string& line : report.notices) run.note(line);
    run.record().seconds = report.seconds;
    run.record().filled_hexes = report.filled_hexes;
    outcome = {origin_of(refining, *run.meshed), report, came_from(refining, *run.meshed)};
    // Nothing was cut, and then nothing was measured: the mesh stays, without a field of zeros.
    if (std::ranges::all_of(outcome.came_from.kind, [](HexOrigin kind) { return kind == HexOrigin::same; })) return;
    accept_refining(run, std::move(refining));
  });
  return outcome;
}

}  // namespace

AdaptOutcome Session::adapt(std::span<const std::uint8_t> flags, const AdaptOptions& options) {
  return adapt_session(*core_, "flags", flags, options);
}
AdaptOutcome Session::adapt(std::span<const std::int8_t> changes, const AdaptOptions& options) {
  return adapt_session(*core_, "levels", changes, options);
}
AdaptOutcome Session::adapt(std::span<const double> sizes, const AdaptOptions& options) {
  return adapt_session(*core_, "sizes", sizes, options);
}

std::vector<std::int64_t> Session::ids(std::string_view kind, std::string_view range) const {
  // The reader of commands reads it, as part of the command that is about entities of all kinds.
  const std::vector<Statement> statements = split_statements("list " + std::string(kind) + " " + std::string(range));
  if (statements.size() != 1) throw CommandError("this is not a range", "this is not a range", 0, 0);
  const Command command = parse(statements.front());
  const Item* said = command.find("range");
  if (!said) throw error_in(statements.front(), "'" + printable(kind) + "' is not a kind of entity");
  const Selector selector = core_->selector();
  std::vector<std::string> notices;
  std::vector<std::int64_t> result;
  for (const Index i : select(selector, command.statement, said->kind, said->range, notices))
    result.push_back(id_of(selector, said->kind, i));
  std::ranges::sort(result);
  return result;
}

}  // namespace hextwist
