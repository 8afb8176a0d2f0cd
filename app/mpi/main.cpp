// hextwist-mpi: the refinements of hextwist, by several processes with a part of the mesh each.
#include <tbb/global_control.h>

#include <iostream>
#include <optional>
#include <sstream>

#include "exit_status.h"
#include "hextwist/base/memory.h"
#include "hextwist/command/error_at.h"
#include "hextwist/parts/mpi/refine.h"
#include "mpi/options.h"

namespace hextwist::app {
namespace {

/// The most that any rank takes of memory, over the arrays of its part before and after, and its halo; empty: unknown.
std::string over_arrays(Ranks& ranks, std::size_t at_start, std::size_t array_bytes) {
  const double times =
      array_bytes > 0 ? static_cast<double>(peak_memory() - at_start) / static_cast<double>(array_bytes) : 0;
  const double most = ranks.largest(std::vector{times})[0];
  std::ostringstream text;
  text.precision(2);
  if (most > 0) text << ", " << most << " times its arrays beside the program";
  return text.str();
}

void run(Ranks& ranks, const MpiOptions& options) {
  const std::size_t at_start = peak_memory();
  const auto say = [&](const std::string& line) {
    if (ranks.is_first()) std::cout << line + "\n" << std::flush;
  };
  std::optional<tbb::global_control> limit;
  if (options.threads > 0)
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(options.threads));
  if (!options.output.empty()) check_output_name(options.output);
  std::optional<PartCommands> commands;
  try {
    commands.emplace(options.commands);
  } catch (const CommandError& error) {
    throw Error(error.message());
  }
  std::optional<PartitionBy> by;
  if (!options.by.empty()) by = partition_by(options.by);
  RankPart part = read_in_ranks(ranks, options.mesh, options.cad, by, say);
  InRanks made = refine_in_ranks(ranks, part, *commands, {options.rings, !options.fixed}, say);
  part = {};
  const std::size_t array_bytes = made.array_bytes;
  if (!options.output.empty())
    for (const std::string& line : write_in_ranks(ranks, std::move(made), options.output)) say(line);
  const std::int64_t peak = ranks.largest(static_cast<std::int64_t>(peak_memory()));
  say("at most " + std::to_string(peak >> 20) + " MiB a process" + over_arrays(ranks, at_start, array_bytes) +
      "; sent " + std::to_string(ranks.sum(ranks.n_messages())) + " messages, " +
      std::to_string(ranks.sum(ranks.n_bytes())) + " bytes");
}

int main(int argc, char** argv) {
  Ranks ranks(argc, argv);
  MpiOptions options;
  if (const int status = read_mpi_options(argc, argv, ranks.is_first(), options); status >= 0) return status;
  keep_freed_memory();
  try {
    run(ranks, options);
    return done;
  } catch (const Error& error) {
    // At once: mpirun and other processes write there as well.
    if (ranks.is_first()) std::cerr << "error: " + std::string(error.what()) + "\n";
    return command_failed;
  }
}

}  // namespace
}  // namespace hextwist::app

int main(int argc, char** argv) {
  return hextwist::app::main(argc, argv);
}
