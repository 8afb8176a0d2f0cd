// From text to commands that are carried out.
#pragma once

#include <filesystem>
#include <string_view>

#include "hextwist/session/core.h"

namespace hextwist {

/// Runs the commands of a text; see Session::run().
int run_text(Session::Core& core, std::string_view text, std::string_view source_name, int first_line = 1);

/// Runs a command with these words and this file as if they had been typed.
void run_with_file(Session::Core& core, std::string_view name, std::string_view word, const std::filesystem::path& file,
                   std::string_view last_word = "");

}  // namespace hextwist
