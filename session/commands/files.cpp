// Which files commands may touch when the session is safe.

#include <algorithm>
#include <filesystem>

#include "hextwist/io/files_beside.h"
#include "hextwist/io/io.h"
#include "hextwist/session/commands/commands.h"

namespace hextwist {
namespace {

/// Why a file is not for a safe session, "" if it is.
std::string reason_against(const std::filesystem::path& only_below, const std::filesystem::path& file) {
  if (!is_below(only_below, file)) return "only files below " + only_below.string() + " are read and written";
  std::error_code ignored;
  const auto status = std::filesystem::status(file, ignored);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    return "this is not an ordinary file";
  return "";
}

void check(const Execution& run, const Item& file, std::string_view endings) {
  const auto refuse = [&](const std::string& why) { throw error_at(run.command.statement, file.token, why); };
  const std::string ending = lower_extension(file.text);
  if (ending.empty() || (" " + std::string(endings) + " ").find(" " + ending + " ") == std::string::npos)
    refuse("the session is safe: files for this end in " + std::string(endings));
  if (const std::string why = reason_against(run.core.only_below, file.text); !why.empty())
    refuse("the session is safe: " + why);
  for (const std::filesystem::path& other : files_beside(file.text)) {
    std::error_code ignored;
    const std::string why = std::filesystem::is_directory(other, ignored) && is_below(run.core.only_below, other)
                                ? ""
                                : reason_against(run.core.only_below, other);
    if (!why.empty()) refuse("the session is safe: " + why + ", and " + other.string() + " belongs to this one");
  }
}

}  // namespace

void check_file(const Execution& run, const Item& file, std::string_view endings) {
  if (run.core.only_below.empty() || run.by_caller) return;
  check(run, file, endings);
}

std::string mesh_endings(bool writing) {
  return (writing ? writable_extensions() : readable_extensions()) + " .levels";
}

void refuse_if_safe(const Execution& run, std::string_view what) {
  if (!run.core.only_below.empty() && !run.by_caller)
    throw error_at(run.command.statement, run.command.items.front().token,
                   "the session is safe: " + std::string(what) + " cannot be changed");
}

}  // namespace hextwist
