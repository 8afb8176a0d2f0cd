// Writes manual pages and completions below a folder, by the paths that they have below share: run by the build.
#include <filesystem>
#include <fstream>
#include <iostream>

#include "describe/write.h"

int main(int argc, char** argv) {
  using namespace hextwist::app;
  if (argc != 2) {
    std::cerr << "usage: hextwist_describe FOLDER\n";
    return 2;
  }
  const std::pair<const char*, std::string (*)()> files[] = {
      {"man/man1/hextwist.1", program_page},
      {"man/man1/hextwist-mpi.1", mpi_page},
      {"man/man7/hextwist-commands.7", language_page},
      {"bash-completion/completions/hextwist", bash_completion},
      {"zsh/vendor-completions/_hextwist", zsh_completion},
      {"fish/vendor_completions.d/hextwist.fish", fish_completion},
  };
  for (const auto& [name, text] : files) {
    const std::filesystem::path file = std::filesystem::path(argv[1]) / name;
    std::filesystem::create_directories(file.parent_path());
    if (!(std::ofstream(file) << text())) {
      std::cerr << file.string() << " could not be written\n";
      return 1;
    }
  }
}
