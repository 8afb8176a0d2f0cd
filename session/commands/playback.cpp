// playback, and quit, which ends what is played back too.

#include <algorithm>
#include <fstream>
#include <iterator>

#include "hextwist/command/foreign.h"
#include "hextwist/command/reader.h"
#include "hextwist/session/commands/commands.h"
#include "hextwist/session/run.h"

namespace hextwist {

namespace {

/// A text of something else: of its first lines hardly any begins as a command does.
bool is_journal(std::string_view text) {
  if (text.find('\0') != std::string_view::npos) return false;
  constexpr std::size_t first_bytes = 5000, least = 5;
  const std::vector<Statement> statements = split_statements(text.substr(0, first_bytes));
  const auto known = std::ranges::count_if(statements, [](const Statement& statement) {
    const Token& first = statement.tokens.front();
    if (first.kind == Token::Kind::braces || foreign_line(statement)) return true;
    return first.kind == Token::Kind::word &&
           std::ranges::any_of(language(), [&](const CommandSpec& spec) { return begins_word(first.text, spec.name); });
  });
  return statements.size() < least || known * 10 >= std::ssize(statements);
}

}  // namespace

void play(Execution& run, const Item& file, std::string_view endings) {
  constexpr int max_nesting = 16;
  if (run.core.nesting >= max_nesting)
    throw error_at(run.command.statement, file.token, "journals play each other back without end");
  check_file(run, file, endings);
  std::ifstream stream(file.text, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file.text)) throw Error(file.text + ": this journal can't be read");
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!is_journal(text)) throw Error(file.text + ": this is not a journal: its lines are not commands");
  struct Nested {
    int& level;
    explicit Nested(int& nesting) : level(++nesting) {}
    ~Nested() { --level; }
  } const nested(run.core.nesting);
  const int n_failed = run_text(run.core, text, file.text);
  // 'exit', with which journals of other programs end, ends the journal and not who plays it.
  run.state.finished = false;
  if (n_failed) throw Error(file.text + ": " + counted(n_failed, "command") + " failed");
}

void do_playback(Execution& run) {
  play(run, *run.command.find("file"), ".jou");
}

void do_quit(Execution& run) {
  run.state.finished = true;
}

}  // namespace hextwist
