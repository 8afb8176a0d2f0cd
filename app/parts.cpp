#include "parts.h"

#include <tbb/global_control.h>

#include <chrono>
#include <functional>
#include <iostream>
#include <new>
#include <optional>

#include "console.h"
#include "exit_status.h"
#include "hextwist/base/fence.h"
#include "hextwist/base/interrupt.h"
#include "hextwist/base/memory.h"
#include "hextwist/base/text.h"
#include "hextwist/command/error_at.h"
#include "hextwist/parts/files.h"
#include "hextwist/parts/on_disk.h"
#include "hextwist/sizing/report.h"

namespace hextwist::app {

namespace {

using Say = std::function<void(const std::string&)>;

void refine_in_parts(const Options& options, const Fence& fence, const Say& say) {
  const auto begin = std::chrono::steady_clock::now();
  std::vector<std::string> texts;
  for (const Step& step : options.steps) texts.push_back(step.text);
  std::optional<PartCommands> commands;
  try {
    commands.emplace(texts);
  } catch (const CommandError& error) {
    throw Error(error.message());
  }
  OnDiskOptions on_disk;
  on_disk.n_rings = options.rings;
  on_disk.fence = fence;
  on_disk.n_parts = options.n_parts;
  if (!options.split_by.empty()) on_disk.by = partition_by(options.split_by);
  refine_on_disk(options.mesh, *commands, options.output, on_disk, say);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  say("at most " + std::to_string(peak_memory() >> 20) + " MiB, " + short_number(seconds.count()) + " s");
}

}  // namespace

int run_parts(const Options& options) {
  Fence fence;
  fence.readers = find_readers();
  std::string error;
  Console console;
  const Say say = console.callbacks().output;
  std::optional<tbb::global_control> limit;
  if (options.threads > 0)
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(options.threads));
  bool stops = false;  // from then on whatever is asked
  const Interruptible interruptible([&] {
    stops = stops || take_interrupt() || ending_signal();
    if (stops) throw Cancelled();
  });
  try {
    std::vector<std::string> lines;
    if (options.in_parts)
      refine_in_parts(options, fence, say);
    else if (options.join)
      lines = join_files(options.mesh, options.output, fence);
    else
      lines = split_file(options.mesh, options.output, options.split, partition_by(options.split_by), fence);
    for (const std::string& line : lines) say(line);
    return console.problem().empty() ? done : command_failed;
  } catch (const std::bad_alloc&) {
    error = "out of memory";
  } catch (const std::exception& problem) {
    error = problem.what();
  }
  std::cerr << "error: " + error + "\n";  // at once: others may write there
  if (const int signal = ending_signal()) return 128 + signal;
  return command_failed;
}

}  // namespace hextwist::app
