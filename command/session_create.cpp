#include "hextwist/command/session_internal.h"

namespace hextwist {

void do_create(Execution& run) {
  throw error_at(run.command.statement, run.command.items.front().token, "'create' is not supported yet");
}

}  // namespace hextwist
