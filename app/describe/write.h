// The files that a system wants of a program, written from what the program itself reads.
#pragma once

#include <string>

namespace hextwist::app {

/// Manual pages, as man(7) has them.
std::string program_page();   ///< hextwist(1)
std::string mpi_page();       ///< hextwist-mpi(1)
std::string language_page();  ///< hextwist-commands(7): the whole language

/// Completion of hextwist's command line.
std::string bash_completion();
std::string zsh_completion();
std::string fish_completion();

}  // namespace hextwist::app
