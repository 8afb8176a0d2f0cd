#include "hextwist/session/commands/commands.h"

namespace hextwist {

void do_help(Execution& run) {
  const Item *command = run.command.find("command"), *option = run.command.find("option");
  std::string text;
  try {
    text = option ? help(command->text, option->text) : command ? help(command->text) : help();
  } catch (const Error& error) {
    throw error_at(run.command.statement, (option ? option : command)->token, error.what());
  }
  while (text.ends_with('\n')) text.pop_back();
  run.say(text);
}

}  // namespace hextwist
