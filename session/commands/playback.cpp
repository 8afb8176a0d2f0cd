// playback, and quit, which ends what is played back too.

#include <fstream>
#include <iterator>

#include "hextwist/session/commands/commands.h"
#include "hextwist/session/run.h"

namespace hextwist {

void do_playback(Execution& run) {
  const Item& file = *run.command.find("file");
  constexpr int max_nesting = 16;
  if (run.core.nesting >= max_nesting)
    throw error_at(run.command.statement, file.token, "journals play each other back without end");
  check_file(run, file, ".jou");
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

}  // namespace hextwist
