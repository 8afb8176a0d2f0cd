#include "hextwist/session/session.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <new>

#include "hextwist/base/memory.h"
#include "hextwist/command/braces.h"
#include "hextwist/session/session_internal.h"
#include "hextwist/sizing/stages.h"

namespace hextwist {
namespace {

using Clock = std::chrono::steady_clock;
using Function = void (*)(Execution&);

Function function_of(std::string_view command) {
  static const std::map<std::string_view, Function> functions = {
      {"block", do_group},       {"check", do_check},    {"create", do_create},   {"curve", do_scheme},
      {"delete", do_delete},     {"draw", do_draw},      {"exit", do_quit},       {"export", do_export},
      {"group", do_named_group}, {"help", do_help},      {"import", do_import},   {"list", do_list},
      {"node", do_node},         {"nodeset", do_group},  {"quality", do_quality}, {"quit", do_quit},
      {"playback", do_playback}, {"record", do_record},  {"redo", do_redo},       {"refine", do_refine},
      {"reset", do_reset},       {"set", do_set},        {"sideset", do_group},   {"smooth", do_smooth},
      {"sizing", do_sizing},     {"surface", do_scheme}, {"undo", do_undo},       {"volume", do_scheme},
  };
  return functions.at(command);
}

/// Calls f and turns whatever it throws into an error of the command.
template <class F>
void with_place(const Statement& statement, F f) {
  try {
    f();
  } catch (const CommandError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw error_in(statement, "out of memory");
  } catch (const std::exception& error) {
    throw error_in(statement, error.what());
  }
}

/// What the state is like after the command, and what it took.
void close_record(CommandRecord& record, const SessionState& state, Clock::time_point start) {
  const MeshState planned = record.after;
  record.after = state.mesh_state;
  if (record.dry_run) {
    record.after.hexes = planned.hexes;
    record.after.nodes = planned.nodes;
  }
  record.off_cad = state.off_cad;
  record.off_cad_node = state.off_cad.node < 0 ? 0 : node_id(state.meshed->mesh, state.off_cad.node);
  record.cad_volume = state.cad_volume;
  record.has_cad = state.has_cad;
  record.total_seconds = std::chrono::duration<double>(Clock::now() - start).count();
  record.peak_memory_bytes = peak_memory();
}

}  // namespace

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
  return *core_->state.meshed;
}
const std::vector<CommandRecord>& Session::records() const {
  return core_->records;
}
bool Session::finished() const {
  return core_->state.finished;
}

int Session::run(std::string_view text, std::string_view source_name, int first_line) {
  return run_text(*core_, text, source_name, first_line);
}
void Session::import_cad(const std::filesystem::path& file) {
  run_command(*core_, made_command("import", "geometry", file));
}
void Session::import_mesh(const std::filesystem::path& file) {
  run_command(*core_, made_command("import", "mesh", file));
}
void Session::export_mesh(const std::filesystem::path& file) {
  run_command(*core_, made_command("export", "mesh", file, "overwrite"));
}
int Session::playback(const std::filesystem::path& file) {
  const std::size_t before = core_->records.size();
  run_command(*core_, made_command("playback", "", file));
  return static_cast<int>(std::count_if(core_->records.begin() + static_cast<std::ptrdiff_t>(before),
                                        core_->records.end(), [](const CommandRecord& record) { return !record.ok; }));
}

Selector Session::Core::selector() {
  if (topology_of != state.meshed) {
    topology_of = state.meshed;
    topology = std::make_shared<DerivedTopology>(topology_of->mesh);
  }
  return {*topology_of, *topology, state.groups ? std::span<const Group>(*state.groups) : std::span<const Group>()};
}

void Session::Core::say(const std::string& line) const {
  if (callbacks.output) callbacks.output(line);
}

void Execution::note(const std::string& line) const {
  record.notices.push_back(line);
  if (core.callbacks.notice) core.callbacks.notice(line);
}

void Execution::stage(const char* name) {
  close_stage();
  stage_ = name;
  since_ = Clock::now();
  if (core.callbacks.progress && !core.callbacks.progress(name, 0)) throw Cancelled();
}

void Execution::close_stage() {
  if (stage_) record.seconds.push_back({stage_, std::chrono::duration<double>(Clock::now() - since_).count()});
  stage_ = nullptr;
}

std::vector<Index> Execution::chosen(const Item& range) const {
  std::vector<std::string> notices;
  std::vector<Index> result = select(core.selector(), command.statement, range.kind, range.range, notices);
  for (const std::string& line : notices) note(line);
  if (result.empty())
    throw error_at(command.statement, range.range.token, "this names no " + std::string(name(range.kind)));
  return result;
}

void run_command(Session::Core& core, const Command& command) {
  const Clock::time_point start = Clock::now();
  const bool is_playback = command.spec->name == "playback";
  // What a playback did is not put back; and what holds a mesh keeps it from being changed in place.
  const SessionState before = is_playback ? SessionState() : core.state;
  // A playback appends records of its own, so this one is found by its place.
  const std::size_t place = core.records.size();
  core.records.emplace_back();
  CommandRecord record;
  record.command = text_of(command.statement);
  record.before = core.state.mesh_state;
  core.records[place] = record;
  const auto finish = [&] {
    close_record(record, core.state, start);
    core.records[place] = std::move(record);
  };
  try {
    with_place(command.statement, [&] {
      Execution run(core, command, record);
      core.history.undo.reserve(core.history.undo.size() + 1);
      function_of(command.spec->name)(run);
      run.close_stage();
      if (run.step)
        add_step(core, std::move(*run.step));
      else if (!run.is_history && !is_playback)  // whose commands left steps of their own
        remember(core, record.command, before);
    });
    record.ok = true;
    finish();
    keep_on_record(core, command);
  } catch (const CommandError& error) {
    // What the commands of a journal did before the one that failed stays done.
    if (!is_playback) core.state = before;
    record.error = error.message();
    record.line = error.line();
    record.column = error.column();
    finish();
    throw;
  }
}

namespace {

/// A command that never came to be: its words are wrong.
CommandRecord unread_record(const Session::Core& core, const Statement& statement, const CommandError& error) {
  CommandRecord record;
  record.command = text_of(statement);
  record.error = error.message();
  record.line = error.line();
  record.column = error.column();
  record.before = core.state.mesh_state;
  close_record(record, core.state, Clock::now());
  return record;
}

/// Expressions alone.
void run_expressions(Session::Core& core, const Statement& statement, const std::vector<std::string>& lines) {
  CommandRecord record;
  record.command = text_of(statement);
  record.ok = true;
  record.before = core.state.mesh_state;
  close_record(record, core.state, Clock::now());
  core.records.push_back(std::move(record));
  for (const std::string& line : lines) core.say(line);
  keep_on_record(core, statement);
}

void run_statement(Session::Core& core, const Statement& statement) {
  const Variables before = core.variables;
  bool is_playback = false;
  try {
    Command command;
    try {
      if (has_braces(statement)) {
        const Expanded expanded = expand(statement, core.variables);
        if (!expanded.statement) return run_expressions(core, statement, expanded.lines);
        for (const std::string& line : expanded.lines) core.say(line);
        command = parse(*expanded.statement);
      } else {
        command = parse(statement);
      }
    } catch (const CommandError& error) {
      core.records.push_back(unread_record(core, statement, error));
      throw;
    }
    is_playback = command.spec->name == "playback";
    run_command(core, command);
  } catch (...) {
    // What the commands of a journal did before the one that failed stays done.
    if (!is_playback) core.variables = before;
    throw;
  }
}

}  // namespace

int run_text(Session::Core& core, std::string_view text, std::string_view source_name, int first_line) {
  int n_failed = 0;
  for (const Statement& statement : split_statements(text, source_name, first_line)) {
    if (core.state.finished) break;
    try {
      run_statement(core, statement);
    } catch (const CommandError& error) {
      if (!core.keep_going || error.message() == Cancelled().what()) throw;
      ++n_failed;
      if (core.callbacks.error) core.callbacks.error(error);
    }
  }
  return n_failed;
}

Command made_command(std::string_view name, std::string_view word, const std::filesystem::path& file,
                     std::string_view last_word) {
  Command command;
  command.spec = &*std::ranges::find(language(), name, &CommandSpec::name);
  std::string text;
  std::vector<Token> tokens;
  const auto add = [&](Token::Kind kind, const std::string& written, const std::string& value) {
    if (!text.empty()) text += ' ';
    tokens.push_back({kind, value, 0, text.size(), written.size()});
    text += written;
  };
  const auto add_word = [&](std::string_view said) {
    if (said.empty()) return;
    add(Token::Kind::word, std::string(said), std::string(said));
    Item item;
    item.is_word = true;
    item.name = said;
    item.token = tokens.back();
    command.items.push_back(std::move(item));
  };
  add_word(name);
  add_word(word);
  add(Token::Kind::string, "\"" + file.string() + "\"", file.string());
  Item item;
  item.name = "file";
  item.token = tokens.back();
  item.text = file.string();
  command.items.push_back(std::move(item));
  add_word(last_word);
  tokens.push_back({Token::Kind::end, "", 0, text.size(), 0});
  command.statement = {std::make_shared<const Source>(Source{"", text}), std::move(tokens)};
  return command;
}

void do_playback(Execution& run) {
  const Item& file = *run.command.find("file");
  constexpr int max_nesting = 16;
  if (run.core.nesting >= max_nesting)
    throw error_at(run.command.statement, file.token, "journals play each other back without end");
  std::ifstream stream(file.text, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file.text)) throw Error(file.text + ": this journal can't be read");
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  struct Nested {
    int& level;
    explicit Nested(int& nesting) : level(++nesting) {}
    ~Nested() { --level; }
  } const nested(run.core.nesting);
  if (const int n_failed = run_text(run.core, text, file.text))
    throw Error(file.text + ": " + counted(n_failed, "command") + " failed");
}

void do_quit(Execution& run) {
  run.state.finished = true;
}

void do_help(Execution& run) {
  const Item* command = run.command.find("command");
  std::string text;
  try {
    text = command ? help(command->text) : help();
  } catch (const Error& error) {
    throw error_at(run.command.statement, command->token, error.what());
  }
  while (text.ends_with('\n')) text.pop_back();
  run.say(text);
}

}  // namespace hextwist
