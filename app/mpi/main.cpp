// hextwist-mpi: the refinements of hextwist, by several processes with a part of the mesh each.
#include <iostream>

#include "exit_status.h"
#include "hextwist/base/memory.h"
#include "hextwist/command/braces.h"
#include "hextwist/parts/files.h"
#include "hextwist/parts/mpi/refine.h"
#include "hextwist/session/commands/request.h"
#include "hextwist/session/session.h"
#include "mpi/options.h"

namespace hextwist::app {
namespace {

/// Adds the refinements of a text. Other commands would look at a mesh that is in parts by then.
void asked_by(Session& session, const std::string& text, std::vector<Asked>& asked) {
  for (const Statement& statement : split_statements(text, "", 1)) {
    if (has_braces(statement))
      throw error_at(statement, statement.tokens.front(), "braces are not known to hextwist-mpi");
    const Command command = parse(statement);
    if (command.spec->name != "refine")
      throw error_at(
          statement, statement.tokens.front(),
          "'" + std::string(command.spec->name) + "' is not done in parts: join them and run it with hextwist");
    Execution run(session.core(), command);
    transact(run, [&] { asked.push_back(asked_in_parts(session.meshed(), request_of(run), asked)); });
  }
}

/// What a command says with a picture of its text, in a line.
template <class F>
void in_one_line(const F& f) {
  try {
    f();
  } catch (const CommandError& error) {
    throw Error(error.message());
  }
}

void run(Ranks& ranks, const MpiOptions& options) {
  const auto say = [&](const std::string& line) {
    if (ranks.is_first()) std::cout << line << "\n" << std::flush;
  };
  Session session;
  std::vector<Asked> asked;
  std::vector<int> part_of_hex;
  // Every rank has the input as a whole until it has taken its part.
  ranks.together([&] {
    in_one_line([&] {
      SessionCallbacks callbacks;
      callbacks.notice = say;
      session.set_callbacks(callbacks);
      session.run("set threads " + std::to_string(options.threads));
      if (!options.cad.empty()) session.import_cad(options.cad);
      if (split_name(options.mesh).n_parts > 0) {
        MeshFile read = read_parts(options.mesh);
        for (const std::string& line : read.notices) say(line);
        session.take_mesh(std::move(read.mesh));
      } else {
        session.import_mesh(options.mesh);
      }
      for (const std::string& text : options.commands) asked_by(session, text, asked);
      part_of_hex.resize(session.meshed().mesh.hexes.size());
      if (ranks.is_first()) part_of_hex = partition(session.meshed().mesh, ranks.size(), partition_by(options.by));
    });
  });
  // Of two runs SCOTCH need not make the same.
  ranks.share(part_of_hex);
  const InRanks made = refine_in_ranks(ranks, session.meshed(), part_of_hex, asked, options.rings, say);
  if (!options.output.empty())
    for (const std::string& line : write_in_ranks(ranks, made, options.output)) say(line);
  const std::int64_t peak = ranks.largest(static_cast<std::int64_t>(peak_memory()));
  say("at most " + std::to_string(peak >> 20) + " MiB a process; sent " +
      std::to_string(ranks.sum(ranks.n_messages())) + " messages, " + std::to_string(ranks.sum(ranks.n_bytes())) +
      " bytes");
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
    if (ranks.is_first()) std::cerr << "error: " << error.what() << "\n";
    return command_failed;
  }
}

}  // namespace
}  // namespace hextwist::app

int main(int argc, char** argv) {
  return hextwist::app::main(argc, argv);
}
