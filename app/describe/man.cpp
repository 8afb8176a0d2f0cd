#include <algorithm>
#include <sstream>

#include "describe/described.h"
#include "describe/write.h"
#include "hextwist/command/syntax.h"

namespace hextwist::app {
namespace {

/// Text as it is, in a paragraph: no character means anything to man.
std::string plain(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\')
      result += "\\e";
    else if (c == '-')
      result += "\\-";
    else if ((c == '.' || c == '\'') && (result.empty() || result.back() == '\n'))
      result += std::string("\\&") + c;
    else
      result += c;
  }
  return result;
}

/// Lines as they are.
std::string lines_kept(const std::string& text) {
  return ".nf\n" + plain(text) + (text.ends_with('\n') ? "" : "\n") + ".fi\n";
}

std::string title(const std::string& name, const char* section, const std::string& summary) {
  return ".\\\" Written by the build, from what the program reads.\n.TH \"" + name + "\" " + section +
         " \"\" \"hextwist " HEXTWIST_VERSION "\"\n.SH NAME\n" + plain(name) + " \\- " + plain(summary) + "\n";
}

std::string usage(const std::string& program, const DescribedMode& mode) {
  std::string line = ".B " + plain(program + (mode.word.empty() ? "" : " " + mode.word)) + "\n[options]";
  for (const DescribedOption& option : mode.options) {
    if (!option.is_positional) continue;
    const std::string name = "\\fI" + plain(option.names.front()) + "\\fR" + (option.is_many ? "..." : "");
    line += option.is_required ? " " + name : " [" + name + "]";
  }
  return line + "\n";
}

std::string options(const DescribedMode& mode) {
  std::string text;
  for (const DescribedOption& option : mode.options) {
    text += ".TP\n";
    for (std::size_t i = 0; i < option.names.size(); ++i)
      text += (i ? ", " : "") + std::string(option.is_positional ? "\\fI" : "\\fB") + plain(option.names[i]) + "\\fR";
    if (!option.is_positional && !option.value.empty()) text += " \\fI" + plain(option.value) + "\\fR";
    text += "\n" + plain(option.help) + (option.is_required && !option.is_positional ? " (required)" : "") + "\n";
  }
  return text;
}

const std::string ending =
    ".SH \"EXIT STATUS\"\n.TP\n0\nall is done\n.TP\n1\na command failed; nothing was written\n.TP\n2\nwrong usage\n";

}  // namespace

std::string program_page() {
  const std::vector<DescribedMode> modes = describe_program();
  std::string page = title("hextwist", "1", "local, conforming refinement of all-hex meshes on CAD") + ".SH SYNOPSIS\n";
  for (const DescribedMode& mode : modes) page += (&mode == &modes.front() ? "" : ".br\n") + usage("hextwist", mode);
  page += ".SH DESCRIPTION\n" + lines_kept(modes.front().help) + ".SH OPTIONS\n" + options(modes.front());
  for (auto mode = modes.begin() + 1; mode != modes.end(); ++mode)
    page += ".SH \"HEXTWIST " + plain(mode->word) + "\"\n" + plain(mode->help) + "\n" + options(*mode);
  page += ".SH COMMANDS\n.BR hextwist\\-commands (7)\nhas all of it.\n";
  for (const CommandSpec& command : language())
    if (!command.syntax.empty())
      page += ".TP\n.B " + plain(std::string(command.name)) + "\n" + plain(std::string(command.summary)) + "\n";
  return page + ending +
         ".SH ENVIRONMENT\n.TP\n.B HEXTWIST_READERS\nfolder of the programs that read files of others\n"
         ".SH \"SEE ALSO\"\n.BR hextwist\\-commands (7),\n.BR hextwist\\-mpi (1)\n";
}

std::string mpi_page() {
  const DescribedMode mode = describe_mpi();
  return title("hextwist-mpi", "1", "the refinements of hextwist, by several processes") + ".SH SYNOPSIS\n" +
         usage("mpirun -n N hextwist-mpi", mode) + ".SH DESCRIPTION\n" + lines_kept(mode.help) + ".SH OPTIONS\n" +
         options(mode) + ending + ".SH \"SEE ALSO\"\n.BR hextwist (1),\n.BR hextwist\\-commands (7)\n";
}

std::string language_page() {
  std::string page = title("hextwist-commands", "7", "the commands of hextwist") + ".SH DESCRIPTION\n" +
                     lines_kept(help()) + ".SH RANGES\n" + lines_kept(help("range")) + ".SH EXPRESSIONS\n" +
                     lines_kept(help("expressions"));
  for (const CommandSpec& command : language())
    if (!command.syntax.empty())
      page += ".SH " + plain(std::string(command.name)) + "\n" + lines_kept(help(command.name, "all"));
  return page + ".SH \"SEE ALSO\"\n.BR hextwist (1)\n";
}

}  // namespace hextwist::app
