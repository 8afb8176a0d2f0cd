// The hextwist program: reads options, runs a session, writes the result and the report.
#include <string.h>
#include <unistd.h>

#include <iostream>
#include <new>

#include "console.h"
#include "exit_status.h"
#include "hextwist/base/memory.h"
#include "hextwist/command/written.h"
#include "hextwist/session/session.h"
#include "interactive.h"
#include "options.h"
#include "parts.h"
#include "report.h"
#include "serve/server.h"
#include "view.h"

namespace hextwist::app {
namespace {

/// Runs one step of the batch; what it says goes to the console. Returns an error in one line, "" when all went well.
template <class F>
std::string attempt(Console& console, F step) {
  try {
    const int n_failed = step();
    return n_failed ? std::to_string(n_failed) + " of the commands failed" : "";
  } catch (const CommandError& error) {
    console.error(error.what());
    return error.message();
  } catch (const std::bad_alloc&) {
    console.error("out of memory");
    return "out of memory";
  } catch (const std::exception& error) {
    console.error(error.what());
    return error.what();
  } catch (...) {
    const char* const text = "an error of an unknown kind";
    console.error(text);
    return text;
  }
}

/// Everything up to the report. Returns the first error.
std::string run(const Options& options, Session& session, Console& console) {
  const auto once = [](auto&& step) {
    return [&] {
      step();
      return 0;
    };
  };
  std::string error;
  const auto attempt_step = [&](auto&& step) {
    const std::string problem = attempt(console, step);
    if (error.empty()) error = problem;
    return problem.empty();
  };
  if (options.threads > 0) attempt_step([&] { return session.run("set threads " + std::to_string(options.threads)); });
  // A mesh is to be checked, and converted, as it is.
  if (options.check || options.convert) attempt_step([&] { return session.run("set untangle off; set snap off"); });
  // Without its input there is nothing to go on with.
  if (!options.cad.empty() && !attempt_step(once([&] { session.import_cad(options.cad); }))) return error;
  if (!options.mesh.empty() && !attempt_step(once([&] { session.import_mesh(options.mesh); }))) return error;
  if (!options.levels.empty() &&
      !attempt_step([&] { return session.run("import levels " + quoted_text(options.levels.string())); }))
    return error;
  if (options.check) {
    attempt_step([&] { return session.run("check"); });
    return error;
  }
  if (options.view) {
    attempt_step(
        once([&] { write_view(options, session, [](const std::string& line) { std::cout << line << "\n"; }); }));
    return error;
  }
  if (options.convert) {
    if (options.order > 0) attempt_step([&] { return session.run("set order " + std::to_string(options.order)); });
    attempt_step(once([&] { session.export_mesh(options.output); }));
    return error;
  }
  if (options.safe && !attempt_step([&] { return session.run("set safe on"); })) return error;
  session.set_keep_going(options.keep_going);
  for (const Step& step : options.steps) {
    if (ending_signal()) break;
    const bool ok = attempt_step([&] { return step.is_file ? session.playback(step.text) : session.run(step.text); });
    if (!ok && !options.keep_going) return error;
  }
  if (options.steps.empty()) {
    if (isatty(STDIN_FILENO))
      run_interactive(session, console);
    else
      attempt_step([&] { return run_standard_input(session); });
  }
  session.set_keep_going(false);
  if (const int signal = ending_signal(); signal && error.empty()) error = std::string("ended by ") + strsignal(signal);
  if (error.empty() && !options.output.empty()) attempt_step(once([&] { session.export_mesh(options.output); }));
  return error;
}

int run_server(const Options& options) {
  std::string error;
#ifdef HEXTWIST_SERVE
  try {
    return serve(options);
  } catch (const std::exception& problem) {
    error = problem.what();
  }
#else
  error = "this program was built without 'serve', which needs cpp-httplib (Debian: libcpp-httplib-dev)";
  static_cast<void>(options);
#endif
  std::cerr << "error: " + error + "\n";  // at once: others may write there
  return command_failed;
}

int main(int argc, char** argv) {
  open_standard_streams();
  Options options;
  if (const int status = read_options(argc, argv, options); status >= 0)
    return status == done && !Console().problem().empty() ? command_failed : status;
  catch_interrupts();
  keep_freed_memory();
  limit_memory(available_memory());
  if (options.serve) return run_server(options);
  if (options.split || options.join || options.in_parts) return run_parts(options);
  Session session;
  Console console;
  session.set_callbacks(console.callbacks());
  std::string error = run(options, session, console);
  console.idle();
  if (const std::string problem = console.problem(); error.empty()) error = problem;
  if (!options.json.empty()) {
    const std::string problem = attempt(console, [&] {
      write_report(options.json, session.records(), error);
      return 0;
    });
    if (error.empty()) error = problem;
  }
  if (const int signal = ending_signal()) return 128 + signal;
  return error.empty() ? done : command_failed;
}

}  // namespace
}  // namespace hextwist::app

int main(int argc, char** argv) {
  return hextwist::app::main(argc, argv);
}
