// hextwist-mpi: the refinements of hextwist, by several processes with a part of the mesh each.
#include <CLI/CLI.hpp>
#include <iostream>

#include "exit_status.h"
#include "hextwist/base/memory.h"
#include "hextwist/command/braces.h"
#include "hextwist/parts/files.h"
#include "hextwist/parts/mpi/refine.h"
#include "hextwist/session/commands/request.h"
#include "hextwist/session/session.h"

namespace hextwist::app {
namespace {

struct MpiOptions {
  std::filesystem::path cad, mesh, output;
  std::vector<std::string> commands;
  std::string by;
  int threads = 1;
  int rings = 6;
};

/// Status to end with, -1 to go on.
int read_mpi_options(int argc, char** argv, bool is_first, MpiOptions& options) {
  CLI::App app(
      "Refines a mesh by several processes: mpirun -n 8 hextwist-mpi --cad part.step mesh.e -c 'refine curve 3' -o "
      "out.e\n"
      "writes out.e.8.0 .. out.e.8.7, whose join is what hextwist writes. Refinements only.",
      "hextwist-mpi");
  app.add_option("MESH", options.mesh, "mesh to start from; of a split one, any part: mesh.e.8.0")->required();
  app.add_option("-c,--commands", options.commands, "refinements, separated by ';'")
      ->allow_extra_args(false)
      ->take_all()
      ->required();
  app.add_option("--cad", options.cad, "CAD that the mesh lies on (.step, .brep, .iges)");
  app.add_option("-o,--output", options.output, "OUT: each process writes its part to OUT.n.i (Exodus)");
  app.add_option("--by", options.by,
                 "how hexes are shared out: scotch (default, where it was built in), slabs, ids or random")
      ->check(CLI::IsMember({"scotch", "slabs", "ids", "random"}));
  app.add_option("--rings", options.rings, "of hexes of others around a part, to begin with; default 6")
      ->check(CLI::Range(2, 250));
  app.add_option("--threads", options.threads, "threads of each process; default 1; 0: all")
      ->check(CLI::Range(0, 1024));
  app.set_version_flag("--version", "hextwist-mpi " HEXTWIST_VERSION);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::ostringstream out, err;
    const int status = app.exit(error, out, err);
    if (is_first) std::cout << out.str(), std::cerr << err.str();
    return status == 0 ? done : wrong_usage;
  }
  return -1;
}

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
