#include "hextwist/session/run.h"

#include <algorithm>

#include "hextwist/base/fence.h"
#include "hextwist/command/braces.h"
#include "hextwist/command/flow.h"
#include "hextwist/command/foreign.h"
#include "hextwist/session/commands/commands.h"
#include "hextwist/sizing/stages.h"

namespace hextwist {
namespace {

/// False for a line of another program that is skipped.
bool parse_into(Execution& run, Command& command, const Statement& statement) {
  const std::optional<Foreign> foreign = parse_or_skip(statement, command);
  if (foreign && run.core.skipped.insert(foreign->said).second) run.note(skipped_text(*foreign));
  return !foreign;
}

/// Expressions in braces first; they may be all there is.
void run_statement(Session::Core& core, const Statement& statement) {
  Command command;
  command.statement = statement;
  Execution run(core, command);
  transact(run, [&] {
    if (!has_braces(statement)) {
      if (parse_into(run, command, statement)) execute(run);
      return;
    }
    const Expanded expanded = expand(statement, core.variables);
    for (const std::string& line : expanded.lines) run.say(line);
    run.is_journaled = true;
    if (!expanded.statement) return;
    if (parse_into(run, command, *expanded.statement)) execute(run);
  });
}

/// Statements in the order that loops and conditions ask for.
class Script {
 public:
  Script(Session::Core& core, std::span<const Statement> statements)
      : core_(core), statements_(statements), ends_(flow_ends(statements)) {}

  int run() {
    lines(0, statements_.size());
    return n_failed_;
  }

 private:
  Session::Core& core_;
  std::span<const Statement> statements_;
  std::vector<std::size_t> ends_;
  int n_failed_ = 0;
  std::int64_t n_rounds_ = 0;

  void lines(std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to && !core_.state.finished; ++i) {
      const FlowLine flow = flow_of(statements_[i]);
      if (flow.kind != Flow::none && statements_[i].tokens.size() > 2)
        throw error_at(statements_[i], statements_[i].tokens[1],
                       "nothing may stand behind '" + text_of(only_first(statements_[i])) + "' on its line");
      switch (flow.kind) {
        case Flow::none:
          attempt([&] { run_statement(core_, statements_[i]); });
          break;
        case Flow::loop:
          loop(i, flow);
          i = ends_[i];
          break;
        case Flow::when:
        case Flow::when_defined:
        case Flow::when_undefined:
          i = condition(i);
          break;
        case Flow::include:
        case Flow::include_if_there:
          attempt([&] { include(statements_[i], flow); });
          break;
        case Flow::ignored:
          break;
        default:
          throw error_at(statements_[i], statements_[i].tokens[0],
                         "this is not known here: say it with {if(...)}, {elseif(...)}, {else} and {endif}");
      }
      if (core_.state.finished && i + 1 < to && core_.callbacks.notice)
        core_.callbacks.notice("what stands behind '" + text_of(statements_[i]) + "' is left out");
    }
  }

  static Statement only_first(const Statement& statement) {
    return {statement.source, {statement.tokens.front()}, statement.begin, statement.line};
  }

  template <class F>
  void attempt(F f) {
    try {
      f();
    } catch (const CommandError& error) {
      if (!core_.keep_going || error.message() == Cancelled().what()) throw;
      ++n_failed_;
      if (core_.callbacks.error) core_.callbacks.error(error);
    }
  }

  /// What stands between the parentheses, worked out; a mistake there goes on record.
  Value value(const Statement& statement, const FlowLine& flow) {
    Value result;
    Transaction run(core_, text_of(statement), &statement);
    transact(run, [&] { result = value_within(statement, flow.offset, flow.length, core_.variables); });
    return result;
  }
  double number(const Statement& statement, const FlowLine& flow) {
    const Value result = value(statement, flow);
    if (const double* number = std::get_if<double>(&result)) return *number;
    throw error_at(statement, statement.tokens.front(), "a number was expected here, not a text");
  }

  void loop(std::size_t at, const FlowLine& flow) {
    constexpr std::int64_t most = 10'000'000;  // of one text: nobody means more
    const double n = number(statements_[at], flow);
    if (!(n <= static_cast<double>(most)))
      throw error_at(statements_[at], statements_[at].tokens.front(), "this loop has too many rounds");
    for (double round = 0; round < n && !core_.state.finished; ++round) {
      if (core_.callbacks.progress && !core_.callbacks.progress("loop", round / n)) throw error_of(at, Cancelled());
      if (++n_rounds_ > most) throw error_of(at, Error("the loops of this text have too many rounds together"));
      lines(at + 1, ends_[at]);
    }
  }
  CommandError error_of(std::size_t at, const Error& error) { return error_in(statements_[at], error.what()); }

  bool holds(std::size_t at) {
    const FlowLine flow = flow_of(statements_[at]);
    if (flow.kind == Flow::otherwise) return true;
    if (flow.kind == Flow::when || flow.kind == Flow::otherwise_when) return number(statements_[at], flow) != 0;
    std::string_view name = std::string_view(statements_[at].source->text).substr(flow.offset, flow.length);
    while (name.ends_with(' ')) name.remove_suffix(1);
    while (name.starts_with(' ')) name.remove_prefix(1);
    const auto found = core_.variables.find(name);
    const bool is_defined = found != core_.variables.end() &&
                            (!std::holds_alternative<double>(found->second) || std::get<double>(found->second) != 0);
    return is_defined == (flow.kind == Flow::when_defined);
  }

  /// The position of its {endif}.
  std::size_t condition(std::size_t at) {
    bool done = false;
    for (; flow_of(statements_[at]).kind != Flow::endif; at = ends_[at])
      if (!done && holds(at)) {
        done = true;
        lines(at + 1, ends_[at]);
      }
    return at;
  }

  void include(const Statement& statement, const FlowLine& flow) {
    const Value name = value(statement, flow);
    Command command;
    command.statement = statement;
    Execution run(core_, command);
    run.is_playback = true;
    transact(run, [&] {
      const auto* file = std::get_if<std::string>(&name);
      const Token& token = statement.tokens.front();
      if (!file) throw error_at(statement, token, "include takes the name of a file in quotes");
      if (flow.kind == Flow::include_if_there && !std::filesystem::exists(*file))
        return run.note("there is no file '" + printable(*file) + "': nothing was included");
      if (!is_below(std::filesystem::current_path(), *file))
        throw error_at(statement, token, "only files below the working folder are included; 'playback' runs others");
      Item item;
      item.token = token;
      item.text = *file;
      play(run, item, ".jou .inc .txt");
    });
  }
};

Command command_with_file(std::string_view name, std::string_view word, const std::filesystem::path& file,
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

}  // namespace

int run_text(Session::Core& core, std::string_view text, std::string_view source_name, int first_line) {
  return Script(core, split_statements(text, source_name, first_line)).run();
}

void run_with_file(Session::Core& core, std::string_view name, std::string_view word, const std::filesystem::path& file,
                   std::string_view last_word) {
  const Command command = command_with_file(name, word, file, last_word);
  Execution run(core, command);
  run.by_caller = true;
  transact(run, [&] { execute(run); });
}

}  // namespace hextwist
