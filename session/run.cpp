#include "hextwist/session/run.h"

#include <algorithm>

#include "hextwist/command/braces.h"
#include "hextwist/session/commands/commands.h"
#include "hextwist/sizing/stages.h"

namespace hextwist {
namespace {

/// Expressions in braces first; they may be all there is.
void run_statement(Session::Core& core, const Statement& statement) {
  Command command;
  command.statement = statement;
  Execution run(core, command);
  transact(run, [&] {
    if (!has_braces(statement)) {
      command = parse(statement);
      return execute(run);
    }
    const Expanded expanded = expand(statement, core.variables);
    for (const std::string& line : expanded.lines) run.say(line);
    run.is_journaled = true;
    if (!expanded.statement) return;
    command = parse(*expanded.statement);
    execute(run);
  });
}

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

void run_with_file(Session::Core& core, std::string_view name, std::string_view word, const std::filesystem::path& file,
                   std::string_view last_word) {
  const Command command = command_with_file(name, word, file, last_word);
  Execution run(core, command);
  run.by_caller = true;
  transact(run, [&] { execute(run); });
}

}  // namespace hextwist
