#include "options.h"

#include <arpa/inet.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <sstream>
#include <string_view>

#include "exit_status.h"
#include "hextwist/base/text.h"
#include "hextwist/io/io.h"

namespace hextwist::app {
namespace {

/// Would who listens there be reached at all addresses of this machine, however that is written?
bool is_every_address(const std::string& address) {
  if (address.empty() || address == "*") return true;
  in_addr v4{};
  if (inet_aton(address.c_str(), &v4) != 0) return v4.s_addr == INADDR_ANY;
  in6_addr v6{};
  if (inet_pton(AF_INET6, address.c_str(), &v6) != 1) return false;
  const bool is_mapped = IN6_IS_ADDR_V4MAPPED(&v6) && std::all_of(v6.s6_addr + 12, v6.s6_addr + 16, std::logical_not());
  return IN6_IS_ADDR_UNSPECIFIED(&v6) || is_mapped;
}

constexpr const char* description =
    "Local, conforming refinement of all-hex meshes on CAD.\n\n"
    "Reads the CAD and the mesh, runs the commands of every -c and every journal (.jou) in their order, and writes "
    "the\n"
    "result to OUT when all of them succeeded. Without commands it is interactive; when standard input is not a\n"
    "terminal, commands are read from there. 'hextwist check MESH [--cad FILE]' verifies a mesh,\n"
    "'hextwist view MESH [--cad FILE]' makes a page that shows it, 'hextwist serve [FILES]' is a page with a prompt,\n"
    "'hextwist convert MESH OUT [--order 2]' writes it in another format,\n"
    "'hextwist split MESH N' and 'hextwist join PART' divide a mesh in files and make it one again,\n"
    "'hextwist refine-in-parts PART' refines such files one after the other.\n";

bool is_journal(const std::string& name) {
  return lower_extension(name) == ".jou";
}

bool is_cad(const std::filesystem::path& file) {
  constexpr const char* endings[] = {".step", ".stp", ".brep", ".brp", ".iges", ".igs"};
  const std::string extension = lower_extension(file);
  return std::ranges::any_of(endings, [&](const char* ending) { return extension == ending; });
}

/// Parses, prints help, version or the error; status to end with, -1 to go on. Where the options are only to be
/// described, that is all.
int parsed(CLI::App& app, const Options& options, int argc, char** argv) {
  if (options.describe) {
    options.describe(app);
    return done;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::ostringstream said;
    const int status = app.exit(error, said, std::cerr);
    std::fputs(said.str().c_str(), stdout);  // whoever flushes it learns why that fails
    return status == 0 ? status : wrong_usage;
  }
  return -1;
}

int wrong(const std::string& message) {
  std::cerr << message + "\nRun with --help for more information.\n";
  return wrong_usage;
}

int read_check(int argc, char** argv, Options& options) {
  CLI::App app("Verifies a mesh: conformity, orientation, quality, ownership, distance from the CAD, volume.",
               "hextwist check");
  app.add_option("MESH", options.mesh, "mesh to verify")->required();
  app.add_option("--cad", options.cad, "CAD that the mesh lies on (.step, .brep, .iges)");
  app.add_option("--json", options.json, "write a report to this file");
  app.add_option("--threads", options.threads, "number of threads; 0: all")->check(CLI::Range(0, 1024));
  options.check = true;
  return parsed(app, options, argc - 1, argv + 1);
}

int read_view(int argc, char** argv, Options& options) {
  CLI::App app("Writes a page of HTML that shows a mesh, or a CAD file, for any browser.", "hextwist view");
  app.add_option("MESH", options.mesh, "mesh to look at");
  app.add_option("--cad", options.cad, "CAD that the mesh lies on (.step, .brep, .iges), or that is looked at alone");
  app.add_option("--levels", options.levels, "levels of that mesh, as 'export levels' wrote them");
  app.add_option("--before", options.before, "another mesh, on the same CAD, to show beside it");
  app.add_option("-o,--output", options.output, "the page; default: MESH with .html, in this folder");
  app.add_option("--threads", options.threads, "number of threads; 0: all")->check(CLI::Range(0, 1024));
  options.view = true;
  if (const int status = parsed(app, options, argc - 1, argv + 1); status >= 0) return status;
  if (options.cad.empty() && is_cad(options.mesh)) options.cad.swap(options.mesh);
  const std::filesystem::path& first = !options.mesh.empty()    ? options.mesh
                                       : options.levels.empty() ? options.cad
                                                                : options.levels;
  if (first.empty()) return wrong("MESH or --cad is required");
  if (options.mesh.empty() && options.levels.empty() && !options.before.empty()) return wrong("--before needs a MESH");
  if (options.output.empty()) options.output = first.filename().replace_extension(".html");
  const std::string extension = lower_extension(options.output);
  if (extension != ".html" && extension != ".htm") return wrong(options.output.string() + ": a page ends in .html");
  return -1;
}

int read_split(int argc, char** argv, Options& options) {
  CLI::App app(
      "Divides a mesh in parts: Exodus files NAME.N.0, NAME.N.1, ... with the communication maps of Nemesis; where "
      "NAME ends in .msh, NAME_1.msh, NAME_2.msh, ... as Gmsh splits meshes; in .pvtu, .vtu files.",
      "hextwist split");
  app.add_option("MESH", options.mesh, "mesh to divide")->required();
  app.add_option("N", options.split, "number of parts")->required()->check(CLI::Range(1, 1000000));
  app.add_option("-o,--output", options.output, "NAME; default: MESH with .e, in this folder");
  app.add_option("--by", options.split_by, "scotch (default, where it was built in), boxes, slabs or ids")
      ->check(CLI::IsMember({"scotch", "boxes", "slabs", "ids"}));
  if (const int status = parsed(app, options, argc - 1, argv + 1); status >= 0) return status;
  if (options.output.empty()) options.output = options.mesh.filename().replace_extension(".e");
  return -1;
}

int read_join(int argc, char** argv, Options& options) {
  CLI::App app("Makes one mesh of its parts.", "hextwist join");
  app.add_option("PART", options.mesh, "any of the parts: NAME.N.0, or NAME_1.msh of a mesh that Gmsh has split")
      ->required();
  app.add_option("-o,--output", options.output, "the mesh; format by extension")->required();
  options.join = true;
  return parsed(app, options, argc - 1, argv + 1);
}

int read_in_parts(int argc, char** argv, Options& options) {
  CLI::App app(
      "Refines a mesh in parts, part after part, from disk to disk: with one part in memory at a time. Refinements "
      "only. With --parts an Exodus, .msh or .vtu file of the whole, read in slices.",
      "hextwist refine-in-parts");
  std::vector<std::string> commands;
  app.add_option("PART", options.mesh,
                 "any of the parts, NAME.N.0 or NAME_1.msh ('hextwist split' makes them); with --parts a mesh file")
      ->required();
  auto* parts = app.add_option("--parts", options.n_parts, "divide a mesh file into so many parts first")
                    ->check(CLI::Range(1, 1000000));
  app.add_option("--by", options.split_by, "how: boxes (default), slabs or ids")
      ->check(CLI::IsMember({"boxes", "slabs", "ids"}))
      ->needs(parts);
  app.add_option("-c,--commands", commands, "refinements, separated by ';'")
      ->type_name("COMMANDS")
      ->allow_extra_args(false)
      ->take_all()
      ->required();
  app.add_option("-o,--output", options.output,
                 "OUT: parts are written to OUT.N.i (Exodus); where it ends in .msh, to OUT_i.msh as Gmsh splits "
                 "meshes; in .pvtu, to .vtu files")
      ->required();
  app.add_option("--rings", options.rings,
                 "of hexes of others around a part, to begin with; default 6, fewer than 4 are 4")
      ->check(CLI::Range(1, 250));
  app.add_option("--threads", options.threads, "number of threads; 0: all")->check(CLI::Range(0, 1024));
  options.in_parts = true;
  if (const int status = parsed(app, options, argc - 1, argv + 1); status >= 0) return status;
  for (const std::string& text : commands) options.steps.push_back({false, text});
  return -1;
}

int read_serve(int argc, char** argv, Options& options) {
  CLI::App app(
      "Serves pages for browsers on this machine: the mesh, and a prompt. Every tab has a session of its own, which "
      "touches\nonly files below this folder. Prints the address to open; Ctrl-C ends.",
      "hextwist serve");
  std::vector<std::string> files;
  app.add_option("FILES", files, "a mesh to start from and journals (.jou) to run");
  app.add_option("--cad", options.cad, "CAD that the mesh lies on (.step, .brep, .iges)");
  app.add_option("--address", options.address, "address of this machine to listen on; default: itself alone")
      ->type_name("ADDRESS");
  app.add_option("--port", options.port, "port to listen on; default: any")->check(CLI::Range(0, 65535));
  app.add_option("--time-limit", options.most_seconds, "seconds that a command may take; 0: no limit; default: 3600")
      ->check([](const std::string& text) {  // NaN is in every range of CLI11
        const double seconds = std::strtod(text.c_str(), nullptr);
        return seconds >= 0 && seconds <= 1e9 ? "" : text + " is not a number from 0 to 1e9";
      });
  app.add_option("--threads", options.threads, "number of threads; 0: all")->check(CLI::Range(0, 1024));
  options.serve = true;
  if (const int status = parsed(app, options, argc - 1, argv + 1); status >= 0) return status;
  // Pages are answered at one address, so that no name of another site can be given to it.
  if (is_every_address(options.address))
    return wrong("--address " + options.address + ": name the address of this machine that it is to be reached at");
  for (const std::string& file : files) {
    if (is_journal(file))
      options.steps.push_back({true, file});
    else if (options.mesh.empty())
      options.mesh = file;
    else
      return wrong("two meshes: " + options.mesh.string() + " and " + file + " (journals end in .jou)");
  }
  return -1;
}

/// Better now than after an hour of work.
int check_output(const Options& options) {
  const std::string extension = lower_extension(options.output);
  if (extension.empty() || (" " + writable_extensions() + " ").find(" " + extension + " ") == std::string::npos)
    return wrong(options.output.string() + ": unknown format to write; extensions are " + writable_extensions());
  return -1;
}

int read_convert(int argc, char** argv, Options& options) {
  CLI::App app("Writes a mesh in another format, by the extensions of the files: " + writable_extensions() +
                   ". What the format can't say is told.",
               "hextwist convert");
  app.add_option("MESH", options.mesh, "mesh to read: " + readable_extensions())->required();
  app.add_option("OUT", options.output, "file to write")->required();
  app.add_option("--cad", options.cad, "CAD that the mesh lies on (.step, .brep, .iges)");
  app.add_option("--order", options.order, "of the hexes: 2 with middle nodes; default: as in MESH")
      ->check(CLI::Range(1, 2));
  app.add_option("--json", options.json, "write a report to this file");
  options.convert = true;
  const int status = parsed(app, options, argc - 1, argv + 1);
  return status >= 0 ? status : check_output(options);
}

/// First words that make the program do something else, with options of their own.
struct Mode {
  std::string_view word;
  int (*read)(int argc, char** argv, Options& options);
};
constexpr Mode modes[] = {{"check", read_check},
                          {"convert", read_convert},
                          {"view", read_view},
                          {"serve", read_serve},
                          {"split", read_split},
                          {"join", read_join},
                          {"refine-in-parts", read_in_parts}};

}  // namespace

std::vector<std::string> mode_words() {
  std::vector<std::string> words;
  for (const Mode& mode : modes) words.emplace_back(mode.word);
  return words;
}

int read_options(int argc, char** argv, Options& options) {
  for (const Mode& mode : modes)
    if (argc > 1 && argv[1] == mode.word) return mode.read(argc, argv, options);
  CLI::App app(description, "hextwist");
  std::vector<std::string> files, commands;
  CLI::Option* file_option = app.add_option("FILES", files, "a mesh to start from and journals (.jou) to run");
  CLI::Option* command_option = app.add_option("-c,--commands", commands, "commands to run, separated by ';'")
                                    ->type_name("COMMANDS")
                                    ->allow_extra_args(false)
                                    ->take_all();
  app.add_option("--cad", options.cad, "CAD that the mesh lies on (.step, .brep, .iges)");
  app.add_option("-o,--output", options.output,
                 "write the mesh here when every command succeeded; format by extension: " + writable_extensions());
  app.add_option("--json", options.json, "write a report on every command to this file, also when one failed");
  app.add_flag("--keep-going", options.keep_going, "go on after a command that failed");
  app.add_flag("--safe", options.safe,
               "for journals of others: commands read and write only files below this folder, by known endings");
  app.add_option("--threads", options.threads, "number of threads; 0: all")->check(CLI::Range(0, 1024));
  app.set_version_flag("--version", "hextwist " HEXTWIST_VERSION "\nbuilt with " HEXTWIST_LIBRARIES);
  if (const int status = parsed(app, options, argc, argv); status >= 0) return status;

  // CLI11 keeps the values of an option together; the order between options is in parse_order().
  auto file = files.begin();
  auto command = commands.begin();
  for (const CLI::Option* option : app.parse_order()) {
    if (option == command_option && command != commands.end()) {
      options.steps.push_back({false, *command++});
    } else if (option == file_option && file != files.end()) {
      if (is_journal(*file))
        options.steps.push_back({true, *file});
      else if (options.mesh.empty())
        options.mesh = *file;
      else
        return wrong("two meshes: " + options.mesh.string() + " and " + *file + " (journals end in .jou)");
      ++file;
    }
  }
  return options.output.empty() ? -1 : check_output(options);
}

}  // namespace hextwist::app
