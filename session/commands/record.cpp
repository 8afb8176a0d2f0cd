// record: the commands of a session as a journal.

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "hextwist/session/commands/commands.h"

namespace hextwist {

void do_record(Execution& run) {
  std::unique_ptr<Recording>& recording = run.core.recording;
  if (run.command.has("stop")) {
    if (!recording) throw error_at(run.command.statement, run.command.items.at(1).token, "nothing is being recorded");
    recording->stream.close();
    if (!recording->stream) {
      const std::string file = recording->file.string();
      recording = nullptr;
      throw Error(file + ": can't be written: " + std::strerror(errno ? errno : EIO));
    }
    run.say(recording->file.string() + ": " + counted(recording->n_commands, "command") + " recorded");
    recording = nullptr;
    return;
  }
  const Item& file = *run.command.find("file");
  if (recording)
    throw Error("the session is being recorded in " + recording->file.string() + " already; 'record stop' ends that");
  if (lower_extension(file.text) != ".jou")
    throw error_at(
        run.command.statement, file.token,
        "journals end in .jou, not in '" + printable(std::filesystem::path(file.text).extension().string()) + "'");
  check_file(run, file, ".jou");
  std::error_code ignored;
  const bool exists = std::filesystem::exists(file.text, ignored);
  if (exists && !run.command.has("overwrite") && !run.command.has("append"))
    throw error_at(run.command.statement, file.token,
                   "this file exists: say 'overwrite', or 'append' to go on at its end");
  auto next = std::make_unique<Recording>();
  next->file = file.text;
  errno = 0;
  next->stream.open(next->file, run.command.has("append") ? std::ios::app : std::ios::trunc);
  if (!next->stream) throw Error(file.text + ": can't be written: " + std::strerror(errno ? errno : EIO));
  recording = std::move(next);
}

}  // namespace hextwist
