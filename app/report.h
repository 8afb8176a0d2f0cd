// The JSON report: one row per command. Fields are described in docs/commands.md.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "hextwist/session/session.h"

namespace hextwist::app {

/// Writes the report to a temporary name and renames it. `error`: what made the run fail, "" when all went well.
/// Throws Error naming the file when it can't be written.
void write_report(const std::filesystem::path& file, std::span<const CommandRecord> records, const std::string& error);

}  // namespace hextwist::app
