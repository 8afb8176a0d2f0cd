// Any text as commands: split, expanded and parsed, never carried out.
#include <cstdint>

#include "hextwist/command/braces.h"
#include "hextwist/command/command_error.h"
#include "hextwist/command/syntax.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace hextwist;
  const std::string text(reinterpret_cast<const char*>(data), size);
  Variables variables;
  for (const Statement& statement : split_statements(text, "input")) {
    try {
      if (!has_braces(statement)) {
        parse(statement);
        continue;
      }
      const Expanded expanded = expand(statement, variables);
      if (expanded.statement) parse(*expanded.statement);
    } catch (const CommandError& error) {
      if (error.line() < 1 || std::string(error.what()).empty()) __builtin_trap();
    }
  }
  completions(text);
  return 0;
}
