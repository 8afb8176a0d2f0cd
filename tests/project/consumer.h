// What a stranger does with an installed tree: builds the examples against it and runs them.
#pragma once

#include <filesystem>
#include <string>

#include "source_tree.h"

namespace hextwist::test {

/// Installs a build below a folder. Fails the test when that does not work.
void install(const std::filesystem::path& build, const std::filesystem::path& prefix);

/// Configures and builds a project against the installed tree.
Outcome build_with_cmake(const std::filesystem::path& prefix, const std::filesystem::path& project,
                         const std::filesystem::path& folder);

/// Compiles and links one source with what pkg-config says. compiler: with its flags.
Outcome build_with_pkg_config(const std::filesystem::path& prefix, const std::string& compiler,
                              const std::filesystem::path& source, const std::filesystem::path& program);

/// Runs examples/minimal, or examples/c, as built: it refines the bracket, and says what is wrong with its input.
void expect_minimal_refines(const std::filesystem::path& program);
void expect_c_adapts(const std::filesystem::path& program);

}  // namespace hextwist::test
